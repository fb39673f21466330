//! The panels by their numbers, and what lies over them.

/// A panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::EnumIter)]
pub enum Pane {
    /// The map.
    #[default]
    Map,
    /// The waypoint table.
    Plan,
    /// The state machine.
    State,
    /// The channels.
    Rc,
    /// The firmware's command line.
    Cli,
    /// Events and notices.
    Log,
}

impl Pane {
    /// All panels in the order of their numbers.
    pub const ALL: [Self; 6] = [Self::Map, Self::Plan, Self::State, Self::Rc, Self::Cli, Self::Log];

    /// Number and name.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Map => "1 Map",
            Self::Plan => "2 Plan",
            Self::State => "3 State",
            Self::Rc => "4 RC",
            Self::Cli => "5 CLI",
            Self::Log => "8 Log",
        }
    }

    /// Whether letters are text there.
    #[must_use]
    pub fn takes_text(self) -> bool {
        self == Self::Cli
    }
}

/// What lies over the panels; the last one gets keys first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layer {
    /// The keys, scrolled down by this many lines.
    Help {
        /// First line shown.
        scroll: usize,
    },
    /// "The craft is armed. Quit?"
    Quit,
}
