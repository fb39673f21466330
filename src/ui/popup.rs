//! The popups.

pub(super) mod action_menu;
pub(super) mod command_line;
pub(super) mod diff_view;
pub(super) mod flights_list;
pub(super) mod frame;
pub(super) mod go_to;
pub(super) mod guards;
pub(super) mod help;
pub(super) mod layout_bar;
pub(super) mod map_menu;
pub(super) mod palette;
pub(super) mod signal_list;
pub(super) mod what_if;

use crate::ui::acts::diff::Against;
use crate::ui::model::message::NewPopup;
pub(super) use action_menu::ActionMenu;
pub use command_line::CommandLine;
pub(super) use diff_view::DiffView;
pub use flights_list::FlightsList;
pub(super) use go_to::GoTo;
pub(super) use help::Help;
pub(super) use map_menu::MapMenu;
pub use palette::Palette;
pub use signal_list::SignalList;

/// The result of a key in a popup.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome<T> {
    /// It stays open.
    Open,
    /// It was left without a choice.
    Left,
    Chosen(T),
}

/// A popup over the panels. The last one opened gets the keys first.
#[derive(Debug, Clone, PartialEq, Eq, strum::VariantNames)]
pub enum Popup {
    /// The keys and their effects.
    Help(Help),
    /// Two versions beside each other.
    Diff(DiffView),
    /// The choice of a waypoint to go to.
    GoTo(GoTo),
    /// The menu of a place on the map.
    MapMenu(MapMenu),
    /// The list of what-ifs to fly ahead with.
    WhatIf {
        /// The selected row.
        selected: usize,
    },
    /// The explanations of guards and abbreviations.
    Guards {
        /// The explained row.
        selected: usize,
    },
    /// A menu of actions at the mouse.
    Actions(ActionMenu),
    /// "The craft is armed. Quit?"
    Quit,
    /// "Give all changed settings their defaults?"
    ResetSettings,
    /// "This changes the flight controller. Go on?"
    Permission,
    /// The choice of plots for the graphs.
    Plots {
        /// The index of the selected plot.
        selected: usize,
    },
    /// The keys that arrange the panels.
    Layout,
    /// The search of the signals.
    Signals(SignalList),
    /// The `:` line.
    CommandLine,
    /// The library of recorded flights.
    Flights(FlightsList),
    /// The search of all commands.
    Palette(Palette),
}

impl From<NewPopup> for Popup {
    fn from(popup: NewPopup) -> Self {
        match popup {
            NewPopup::Guards => Self::Guards { selected: 0 },
            NewPopup::Plots => Self::Plots { selected: 0 },
            NewPopup::Signals => Self::Signals(SignalList::default()),
            NewPopup::ResetSettings => Self::ResetSettings,
            NewPopup::Settings(comparison) => Self::Diff(DiffView::new(Against::Settings(comparison))),
        }
    }
}
