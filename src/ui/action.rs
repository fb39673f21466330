//! Everything a key can do, by name: the one table behind keymap, hint bar, help, palette and the `:` line.

use super::panel::Panel;

mod edit;
mod enabled;
mod real_craft;
mod table;

pub use edit::EditAction;
pub use enabled::enabled;
pub(super) use enabled::is_wrecked;
pub use table::ACTIONS;

/// Where a key means what its action says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Context {
    /// Everywhere but in text fields.
    Global,
    /// Everywhere, in text fields too.
    Always,
    /// While this panel has the focus.
    In(Panel),
    /// While a panel that scrolls has the focus.
    Lists,
}

/// What can be done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumIter)]
pub enum Action {
    /// The whole flight by the scripted pilot, or stop it.
    Fly,
    Arm,
    /// The throttle stick to hover, down gently, or low.
    Throttle,
    Autopilot,
    /// Fly home and land, or take that back.
    ReturnHome,
    /// Go to a waypoint of the plan, now.
    GoTo,
    /// Hold this place and altitude.
    HoldHere,
    /// Go on after such a hold.
    Resume,
    /// Cut or restore the RC link.
    CutRc,
    /// Hand the plan to the craft.
    Upload,
    Edit(EditAction),
    /// Let the craft outside be changed.
    AllowChanges,
    /// Put the craft back home.
    ResetCraft,
    /// Fly ahead as things stand, or end that.
    LookAhead,
    /// Fly ahead with something going wrong.
    WhatIf,
    /// Pause or go on.
    Pause,
    /// One step of the navigator.
    Step,
    Tick,
    /// Show the event before, or after.
    EventBack,
    /// See [`Action::EventBack`].
    EventForward,
    /// Show the state of the autopilot before, or after.
    StateBack,
    /// See [`Action::StateBack`].
    StateForward,
    /// Show an instant some seconds earlier, or later.
    Earlier,
    /// See [`Action::Earlier`].
    Later,
    /// Fly on from the instant shown.
    FlyOn,
    /// Back to the newest instant.
    Newest,
    Slower,
    Faster,
    RealTime,
    Show(Panel),
    /// Focus the next panel.
    Next,
    /// Focus the previous panel.
    Previous,
    /// The focused panel alone.
    Zoom,
    /// The flight as a scenario.
    WriteScenario,
    /// The first minutes, step by step.
    Tutorial,
    Help,
    /// A command by its name.
    CommandLine,
    /// All commands, to be searched.
    Palette,
    Back,
    Quit,
    Cancel,
    /// Back to the shell for a while.
    Suspend,
    /// Pan the map up.
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
    /// The cursor of the graphs to an earlier instant.
    CursorBack,
    /// The cursor of the graphs to a later instant.
    CursorOn,
    /// A shorter time in the graphs.
    SpanLess,
    /// A longer time in the graphs.
    SpanMore,
    /// Choose what the graphs show.
    ChoosePlots,
    /// The graphs show the newest instant.
    CursorOff,
    /// Record the sticks, or end that.
    Record,
    /// Play the recorded sticks, or stop.
    Play,
    /// Select the knob above.
    KnobUp,
    /// Select the knob below.
    KnobDown,
    /// Less of the selected knob.
    KnobLess,
    /// More of the selected knob.
    KnobMore,
    /// Change the selected knob, or type its value.
    KnobEnter,
    /// Type the value of the selected knob.
    KnobEdit,
    /// The selected knob to its default.
    KnobDefault,
    /// What the guards and abbreviations mean.
    ExplainGuards,
    /// Search in the log.
    Search,
    /// To the next older match.
    NextMatch,
    /// To the next newer match.
    PreviousMatch,
    /// Show only what is serious.
    Filter,
    /// Scroll up a line.
    ScrollUp,
    /// Scroll down a line.
    ScrollDown,
    /// Scroll up a page.
    PageUp,
    /// Scroll down a page.
    PageDown,
    Top,
    Bottom,
}

/// A row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Spec {
    pub action: Action,
    /// Stable name for keymaps and scripts, `rc.cut`.
    pub name: &'static str,
    /// A word or two for the hint bar.
    pub title: &'static str,
    /// A sentence for the help.
    pub help: &'static str,
    /// Default keys as text.
    pub keys: &'static [&'static str],
    /// Where the keys mean this.
    pub context: Context,
}

/// The row of an action.
pub fn spec_of(action: Action) -> Option<&'static Spec> {
    ACTIONS.iter().find(|spec| spec.action == action)
}

impl Context {
    /// Whether keys of this context apply while `focus` has the focus. In a text field letters are text.
    pub fn applies(self, focus: Panel) -> bool {
        match self {
            Self::Always => true,
            Self::Global => !focus.takes_text(),
            Self::In(panel) => panel == focus,
            Self::Lists => matches!(focus, Panel::State | Panel::Log | Panel::Plan),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strum::IntoEnumIterator as _;

    #[test]
    fn every_action_has_a_row_a_key_and_a_name_of_its_own() {
        let actions = Action::iter().filter(|a| !matches!(a, Action::Show(_) | Action::Edit(_)));
        let actions = actions.chain(Panel::ALL.map(Action::Show)).chain(EditAction::iter().map(Action::Edit));
        for action in actions {
            let spec = spec_of(action).unwrap_or_else(|| panic!("{action:?} is not in the table"));
            assert!(!spec.keys.is_empty(), "{} has no key", spec.name);
            assert_eq!(ACTIONS.iter().filter(|other| other.name == spec.name).count(), 1, "{}", spec.name);
        }
    }
}
