//! Every action of a key, by name: the one table for keymap, hint bar, help, palette and the `:` line.

use super::panel::Panel;

mod edit;
mod enabled;
mod intent;
mod panels;
mod table;

pub use edit::EditAction;
pub use enabled::enabled;
pub(super) use enabled::is_wrecked;
pub use panels::PanelAction;
pub use table::ACTIONS;

/// The context in which a key triggers its action.
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

/// An action that a key or a command triggers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumIter)]
pub enum Action {
    /// Fly the whole plan with the scripted pilot, or stop the pilot.
    Fly,
    Arm,
    /// Move the throttle stick to hover, down gently, or low.
    Throttle,
    Autopilot,
    /// Fly home and land, or cancel the return.
    ReturnHome,
    /// Go to a waypoint of the plan, now.
    GoTo,
    /// Hold this place and altitude.
    HoldHere,
    /// Go on with the plan after such a hold.
    Resume,
    /// Cut or restore the RC link.
    CutRc,
    /// Upload the plan to the craft.
    Upload,
    Edit(EditAction),
    /// Permit changes of the remote craft.
    AllowChanges,
    /// Put the craft back home.
    ResetCraft,
    /// Fly ahead from the current state, or end that.
    LookAhead,
    /// Fly ahead with something going wrong.
    WhatIf,
    /// Pause or go on.
    Pause,
    /// One step of the navigator.
    Step,
    Tick,
    /// Show the previous event.
    EventBack,
    /// Show the next event.
    EventForward,
    /// Show the previous state of the autopilot.
    StateBack,
    /// Show the next state of the autopilot.
    StateForward,
    /// Show an instant some seconds earlier.
    Earlier,
    /// Show an instant some seconds later.
    Later,
    /// Fly on from the shown instant.
    FlyOn,
    /// Show the newest instant.
    Newest,
    Slower,
    Faster,
    RealTime,
    Show(Panel),
    /// Focus the next panel.
    Next,
    /// Focus the previous panel.
    Previous,
    /// Show the focused panel alone.
    Zoom,
    /// Write the flight as a scenario.
    WriteScenario,
    /// Start the tutorial.
    Tutorial,
    Help,
    /// Open the `:` line.
    CommandLine,
    /// Search all commands.
    Palette,
    Back,
    Quit,
    Cancel,
    /// Return to the shell for a while.
    Suspend,
    /// An action of one panel.
    Panel(PanelAction),
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
    /// Stable name for keymaps and scripts, such as `rc.cut`.
    pub name: &'static str,
    /// A word or two for the hint bar.
    pub title: &'static str,
    /// A sentence for the help.
    pub help: &'static str,
    /// Default keys as text.
    pub keys: &'static [&'static str],
    /// The context in which the keys trigger the action.
    pub context: Context,
}

/// Returns the row of an action.
pub fn spec_of(action: Action) -> Option<&'static Spec> {
    ACTIONS.iter().find(|spec| spec.action == action)
}

impl Context {
    /// Returns `true` if keys of this context apply while `focus` has the focus. In a text field letters are text.
    pub fn applies(self, focus: Panel) -> bool {
        match self {
            Self::Always => true,
            Self::Global => !focus.takes_text(),
            Self::In(panel) => panel == focus,
            Self::Lists => focus.is_list(),
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
