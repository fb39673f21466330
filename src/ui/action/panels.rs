//! The actions of single panels: their names, keys and meanings.

use super::table::spec;
use crate::ui::action::Context::In;
use crate::ui::action::{Action, Spec};
use crate::ui::panel::Panel;

/// An action of one panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::EnumIter)]
pub enum PanelAction {
    /// Pan the map up.
    #[default]
    PanUp,
    /// Pan the map down.
    PanDown,
    /// Pan the map left.
    PanLeft,
    /// Pan the map right.
    PanRight,
    /// Zoom the map in.
    ZoomIn,
    /// Zoom the map out.
    ZoomOut,
    /// Keep the craft in the middle of the map.
    Follow,
    /// Show the whole plan on the map.
    Fit,
    /// Select the channel above.
    ChannelUp,
    /// Select the channel below.
    ChannelDown,
    /// Lower the selected channel.
    Lower,
    /// Raise the selected channel.
    Raise,
    /// Lower the selected channel a lot.
    LowerMuch,
    /// Raise the selected channel a lot.
    RaiseMuch,
    /// Centre a stick or flip a switch.
    Flip,
    /// Move the cursor of the graphs to an earlier instant.
    CursorBack,
    /// Move the cursor of the graphs to a later instant.
    CursorOn,
    /// Show a shorter time span in the graphs.
    SpanLess,
    /// Show a longer time span in the graphs.
    SpanMore,
    /// Choose the signals of the graphs.
    ChoosePlots,
    /// Show the newest instant in the graphs.
    CursorOff,
    /// Record the sticks, or end that.
    Record,
    /// Play the recorded sticks, or stop.
    Play,
    /// Select the knob above.
    KnobUp,
    /// Select the knob below.
    KnobDown,
    /// Lower the selected knob.
    KnobLess,
    /// Raise the selected knob.
    KnobMore,
    /// Change the selected knob, or type its value.
    KnobEnter,
    /// Type the value of the selected knob.
    KnobEdit,
    /// Set the selected knob to its default.
    KnobDefault,
    /// Explain the guards and abbreviations.
    ExplainGuards,
    /// Search in the log.
    Search,
    /// Go to the next older match.
    NextMatch,
    /// Go to the next newer match.
    PreviousMatch,
    /// Show only serious lines.
    Filter,
}

const fn own(
    action: PanelAction,
    panel: Panel,
    name: &'static str,
    title: &'static str,
    help: &'static str,
    keys: &'static [&'static str],
) -> Spec {
    spec(Action::Panel(action), name, title, help, keys, In(panel))
}

pub(super) const MAP: &[Spec] = &[
    own(PanelAction::PanUp, Panel::Map, "map.up", "up", "Pan up", &["up", "k"]),
    own(PanelAction::PanDown, Panel::Map, "map.down", "down", "Pan down", &["down", "j"]),
    own(PanelAction::PanLeft, Panel::Map, "map.left", "left", "Pan left", &["left", "h"]),
    own(PanelAction::PanRight, Panel::Map, "map.right", "right", "Pan right", &["right", "l"]),
    own(
        PanelAction::ZoomIn,
        Panel::Map,
        "map.zoom-in",
        "zoom in",
        "Zoom in (or the mouse wheel)",
        &["+", "="],
    ),
    own(PanelAction::ZoomOut, Panel::Map, "map.zoom-out", "zoom out", "Zoom out", &["-"]),
    own(PanelAction::Follow, Panel::Map, "map.follow", "follow", "Keep the craft in the middle", &["f"]),
    own(PanelAction::Fit, Panel::Map, "map.fit", "fit", "Show the whole plan", &["0"]),
];

/// All other rows, in the order help shows them.
pub(super) const OTHERS: &[Spec] = &[
    own(
        PanelAction::ChannelUp,
        Panel::Rc,
        "rc.up",
        "channel above",
        "Select the channel above",
        &["up", "k"],
    ),
    own(
        PanelAction::ChannelDown,
        Panel::Rc,
        "rc.down",
        "channel below",
        "Select the channel below",
        &["down", "j"],
    ),
    own(
        PanelAction::Lower,
        Panel::Rc,
        "rc.lower",
        "lower",
        "Lower the channel by 10 µs",
        &["left", "h", "-"],
    ),
    own(
        PanelAction::Raise,
        Panel::Rc,
        "rc.raise",
        "raise",
        "Raise the channel by 10 µs",
        &["right", "l", "+"],
    ),
    own(
        PanelAction::LowerMuch,
        Panel::Rc,
        "rc.lower-much",
        "lower much",
        "Lower the channel by 100 µs",
        &["pagedown", "shift-left"],
    ),
    own(
        PanelAction::RaiseMuch,
        Panel::Rc,
        "rc.raise-much",
        "raise much",
        "Raise the channel by 100 µs",
        &["pageup", "shift-right"],
    ),
    own(PanelAction::Flip, Panel::Rc, "rc.flip", "flip", "Flip the switch, or centre the stick", &["enter"]),
    own(PanelAction::Record, Panel::Rc, "rc.record", "record", "Record the sticks, or end that", &["r"]),
    own(PanelAction::Play, Panel::Rc, "rc.play", "play", "Play the recorded sticks again, or stop", &["p"]),
    own(
        PanelAction::CursorBack,
        Panel::Graphs,
        "graphs.earlier",
        "earlier",
        "The cursor to an earlier instant",
        &["left", "h"],
    ),
    own(
        PanelAction::CursorOn,
        Panel::Graphs,
        "graphs.later",
        "later",
        "The cursor to a later instant",
        &["right", "l"],
    ),
    own(PanelAction::SpanLess, Panel::Graphs, "graphs.shorter", "shorter", "A shorter time", &["+", "="]),
    own(
        PanelAction::SpanMore,
        Panel::Graphs,
        "graphs.longer",
        "longer",
        "A longer time, up to two hours",
        &["-"],
    ),
    own(
        PanelAction::ChoosePlots,
        Panel::Graphs,
        "graphs.choose",
        "choose",
        "Choose what is shown",
        &["enter"],
    ),
    own(
        PanelAction::CursorOff,
        Panel::Graphs,
        "graphs.live",
        "live",
        "No cursor: the newest instant",
        &["0", "end"],
    ),
    own(PanelAction::KnobUp, Panel::World, "world.up", "knob above", "Select the knob above", &["up", "k"]),
    own(
        PanelAction::KnobDown,
        Panel::World,
        "world.down",
        "knob below",
        "Select the knob below",
        &["down", "j"],
    ),
    own(
        PanelAction::KnobLess,
        Panel::World,
        "world.less",
        "less",
        "Less of it, or end the fault",
        &["left", "h", "-"],
    ),
    own(
        PanelAction::KnobMore,
        Panel::World,
        "world.more",
        "more",
        "More of it, or begin the fault",
        &["right", "l", "+"],
    ),
    own(
        PanelAction::KnobEnter,
        Panel::World,
        "world.change",
        "change",
        "Type a number, change a level, begin or end a fault",
        &["enter"],
    ),
    own(
        PanelAction::KnobEdit,
        Panel::World,
        "world.type",
        "type",
        "Type the value, of a fault SECONDS,VALUE",
        &["="],
    ),
    own(
        PanelAction::KnobDefault,
        Panel::World,
        "world.default",
        "default",
        "Back to its default",
        &["delete", "backspace"],
    ),
    own(
        PanelAction::ExplainGuards,
        Panel::State,
        "state.explain",
        "explain",
        "Explain the guards and the abbreviations",
        &["enter"],
    ),
    own(
        PanelAction::Search,
        Panel::Log,
        "log.search",
        "search",
        "Search: Enter keeps it, Esc leaves",
        &["/"],
    ),
    own(PanelAction::NextMatch, Panel::Log, "log.next", "next match", "To the next older match", &["n"]),
    own(
        PanelAction::PreviousMatch,
        Panel::Log,
        "log.previous",
        "previous match",
        "To the next newer match",
        &["N"],
    ),
    own(
        PanelAction::Filter,
        Panel::Log,
        "log.filter",
        "filter",
        "Everything, warnings and faults, faults",
        &["f"],
    ),
];
