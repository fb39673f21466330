//! The table of the panels: their names, keys and places.

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::EnumIter)]
pub enum Panel {
    #[default]
    Map,
    Plan,
    State,
    Rc,
    /// The firmware's command line.
    Cli,
    Graphs,
    /// The air and the faults.
    World,
    Log,
    /// All settings of the craft.
    Settings,
}

/// The place of a panel on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum Place {
    /// Top left, large.
    Main,
    /// Beside it, on every screen with room for two panels.
    Beside,
    /// Below it: the place at the bottom left, and on a small screen below the map.
    Below,
    /// The place at the bottom left, and on a small screen the whole left.
    Left,
    /// The place at the right, and on a small screen the whole left.
    Right,
}

/// A row of the table of panels.
#[derive(Debug)]
pub(in crate::ui) struct Row {
    pub(in crate::ui) panel: Panel,
    pub(in crate::ui) name: &'static str,
    /// Name, title and help of the action that shows it.
    pub(in crate::ui) action: (&'static str, &'static str, &'static str),
    /// The keys that show it.
    pub(in crate::ui) keys: &'static [&'static str],
    pub(in crate::ui) place: Place,
    /// `true` if the keys of lists scroll it.
    pub(in crate::ui) is_list: bool,
}

const fn row_of(
    panel: Panel,
    name: &'static str,
    action: (&'static str, &'static str, &'static str),
    keys: &'static [&'static str],
    place: Place,
    is_list: bool,
) -> Row {
    Row { panel, name, action, keys, place, is_list }
}

/// All panels in the order of their numbers.
pub(in crate::ui) const ROWS: [Row; 9] = [
    row_of(Panel::Map, "Map", ("view.map", "map", "Map panel"), &["1", "f1"], Place::Main, false),
    row_of(Panel::Plan, "Plan", ("view.plan", "plan", "Plan panel"), &["2", "f2"], Place::Right, true),
    row_of(Panel::State, "State", ("view.state", "state", "State panel"), &["3", "f3"], Place::Beside, true),
    row_of(Panel::Rc, "RC", ("view.rc", "RC", "RC panel"), &["4", "f4"], Place::Right, false),
    row_of(Panel::Cli, "CLI", ("view.cli", "CLI", "CLI panel"), &["5", "f5"], Place::Left, false),
    row_of(
        Panel::Graphs,
        "Graphs",
        ("view.graphs", "graphs", "Graphs panel"),
        &["6", "f6"],
        Place::Left,
        false,
    ),
    row_of(Panel::World, "World", ("view.world", "world", "World panel"), &["7", "f7"], Place::Right, false),
    row_of(Panel::Log, "Log", ("view.log", "log", "Log panel"), &["8", "f8"], Place::Below, true),
    row_of(
        Panel::Settings,
        "Settings",
        ("view.settings", "settings", "Settings panel"),
        &["9", "f9"],
        Place::Right,
        true,
    ),
];

impl Panel {
    /// All panels in the order of their numbers.
    pub const ALL: [Self; ROWS.len()] = {
        let mut all = [Self::Map; ROWS.len()];
        let mut at = 0;
        while at < ROWS.len() {
            all[at] = ROWS[at].panel;
            at += 1;
        }
        all
    };

    /// Returns its row. The table has one for each panel.
    fn row(self) -> &'static Row {
        ROWS.iter().find(|row| row.panel == self).unwrap_or(&ROWS[0])
    }

    pub fn name(self) -> &'static str {
        self.row().name
    }

    pub(in crate::ui) fn place(self) -> Place {
        self.row().place
    }

    /// Returns `true` if the keys of lists scroll it.
    pub(in crate::ui) fn is_list(self) -> bool {
        self.row().is_list
    }

    /// Returns `true` if letters are text in this panel.
    pub fn takes_text(self) -> bool {
        self == Self::Cli
    }
}
