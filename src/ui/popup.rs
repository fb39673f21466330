//! The popups.

pub(super) mod command_line;
pub(super) mod go_to;
pub(super) mod guards;
pub(super) mod map_menu;
pub(super) mod palette;
pub(super) mod what_if;

pub use command_line::CommandLine;
pub(super) use go_to::GoTo;
pub(super) use map_menu::MapMenu;
pub use palette::Palette;

/// What lies over the panels; the last one opened gets the keys first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Popup {
    /// The keys, scrolled down by this many lines.
    Help { scroll: usize },
    /// Which waypoint to go to.
    GoTo(GoTo),
    /// What can be done at a place of the map.
    MapMenu(MapMenu),
    /// What may go wrong now, to fly ahead with it.
    WhatIf {
        /// The row that Enter takes.
        selected: usize,
    },
    /// What the guards and abbreviations mean.
    Guards {
        /// The row that is explained.
        selected: usize,
    },
    /// "The craft is armed. Quit?"
    Quit,
    /// "This changes the flight controller. Go on?"
    Permission,
    /// The plots that can be shown.
    Plots {
        /// Index of the selected one.
        selected: usize,
    },
    /// The `:` line.
    CommandLine,
    /// All commands, to be searched.
    Palette(Palette),
}
