//! Everything a key can do, by name: the one table behind keymap, hint bar and help.

use crate::telemetry::{LinkState, Mode};

use super::hands;
use super::state::{AppState, Pane};
use crate::session::command::{PLACE_IS_OUTSIDE, TIME_IS_OUTSIDE};

/// Where a key means what its action says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Context {
    /// Everywhere but in text fields.
    Global,
    /// Everywhere, in text fields too.
    Always,
    /// While this panel has the focus.
    In(Pane),
    /// While a panel that scrolls has the focus.
    Lists,
}

/// What can be done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumIter)]
pub enum Action {
    /// The whole flight by the scripted pilot, or stop it.
    Fly,
    /// The ARM switch.
    Arm,
    /// The throttle stick to hover, down gently, or low.
    Throttle,
    /// The AUTOPILOT switch.
    Autopilot,
    /// Fly home and land, or take that back.
    ReturnHome,
    /// Cut or restore the RC link.
    CutRc,
    /// Hand the plan to the craft.
    Upload,
    /// Put the craft back home.
    ResetCraft,
    /// Pause or go on.
    Pause,
    /// One step of the navigator.
    Step,
    /// Half the speed.
    Slower,
    /// Twice the speed.
    Faster,
    /// Real time.
    RealTime,
    /// Focus a panel.
    Show(Pane),
    /// Focus the next panel.
    Next,
    /// Focus the previous panel.
    Previous,
    /// The focused panel alone.
    Zoom,
    /// Help.
    Help,
    /// One step back.
    Back,
    /// Quit.
    Quit,
    /// Cancel; twice: quit.
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
    /// Scroll up a line.
    ScrollUp,
    /// Scroll down a line.
    ScrollDown,
    /// Scroll up a page.
    PageUp,
    /// Scroll down a page.
    PageDown,
    /// To the newest.
    Top,
    /// To the oldest.
    Bottom,
}

/// A row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Spec {
    /// What is done.
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

const fn spec(
    action: Action,
    name: &'static str,
    title: &'static str,
    help: &'static str,
    keys: &'static [&'static str],
    context: Context,
) -> Spec {
    Spec { action, name, title, help, keys, context }
}

use Context::{Always, Global, In, Lists};

/// The table, in the order help shows it.
pub const ACTIONS: &[Spec] = &[
    spec(
        Action::Fly,
        "flight.fly",
        "fly",
        "Fly the whole plan: arm, climb, engage (again: stop the pilot)",
        &["F"],
        Global,
    ),
    spec(Action::Arm, "flight.arm", "arm", "Arm or disarm by the ARM switch", &["a"], Global),
    spec(
        Action::Throttle,
        "flight.throttle",
        "throttle",
        "Throttle up and hold the place; in the air come down; else low",
        &["t"],
        Global,
    ),
    spec(
        Action::Autopilot,
        "flight.autopilot",
        "autopilot",
        "AUTOPILOT switch on or off: engage, disengage",
        &["g"],
        Global,
    ),
    spec(
        Action::ReturnHome,
        "flight.home",
        "home",
        "Return to home and land there (again: take it back)",
        &["H"],
        Global,
    ),
    spec(Action::CutRc, "rc.cut", "cut RC", "Cut or restore the RC link of the sticks", &["x"], Global),
    spec(Action::Upload, "plan.upload", "upload", "Upload the plan to the craft", &["U"], Global),
    spec(
        Action::ResetCraft,
        "craft.reset",
        "reset",
        "Put the craft back home, disarmed; plan and settings are kept",
        &["R"],
        Global,
    ),
    spec(Action::Pause, "sim.pause", "pause", "Pause, or go on", &["space"], Global),
    spec(
        Action::Step,
        "sim.step",
        "step",
        "Pause and advance by 10 ms, one navigator update",
        &["."],
        Global,
    ),
    spec(Action::Slower, "sim.slower", "slower", "Half the speed", &["["], Global),
    spec(
        Action::Faster,
        "sim.faster",
        "faster",
        "Twice the speed, in the end as fast as it goes",
        &["]"],
        Global,
    ),
    spec(Action::RealTime, "sim.real-time", "real time", "Back to real time", &["\\"], Global),
    spec(Action::Show(Pane::Map), "view.map", "map", "Map panel", &["1", "f1"], Global),
    spec(Action::Show(Pane::Plan), "view.plan", "plan", "Plan panel", &["2", "f2"], Global),
    spec(Action::Show(Pane::State), "view.state", "state", "State panel", &["3", "f3"], Global),
    spec(Action::Show(Pane::Rc), "view.rc", "RC", "RC panel", &["4", "f4"], Global),
    spec(Action::Show(Pane::Cli), "view.cli", "CLI", "CLI panel", &["5", "f5"], Global),
    spec(Action::Show(Pane::Log), "view.log", "log", "Log panel", &["8", "f8"], Global),
    spec(Action::Next, "view.next", "next panel", "Focus the next panel", &["tab"], Global),
    spec(
        Action::Previous,
        "view.previous",
        "previous panel",
        "Focus the previous panel",
        &["shift-tab"],
        Always,
    ),
    spec(Action::Zoom, "view.zoom", "zoom", "The focused panel alone, or all again", &["z"], Global),
    spec(Action::Help, "app.help", "help", "The keys of this place", &["?"], Global),
    spec(
        Action::Back,
        "app.back",
        "back",
        "One step back: close, leave a text field, end zoom",
        &["esc"],
        Always,
    ),
    spec(Action::Quit, "app.quit", "quit", "Quit (asks while the craft is armed)", &["q"], Global),
    spec(
        Action::Cancel,
        "app.cancel",
        "cancel",
        "Cancel what is going on; twice within 2 s: quit",
        &["ctrl-c"],
        Always,
    ),
    spec(Action::Suspend, "app.suspend", "suspend", "Back to the shell, `fg` returns", &["ctrl-z"], Always),
    spec(Action::PanUp, "map.up", "up", "Pan up", &["up", "k"], In(Pane::Map)),
    spec(Action::PanDown, "map.down", "down", "Pan down", &["down", "j"], In(Pane::Map)),
    spec(Action::PanLeft, "map.left", "left", "Pan left", &["left", "h"], In(Pane::Map)),
    spec(Action::PanRight, "map.right", "right", "Pan right", &["right", "l"], In(Pane::Map)),
    spec(
        Action::ZoomIn,
        "map.zoom-in",
        "zoom in",
        "Zoom in (or the mouse wheel)",
        &["+", "="],
        In(Pane::Map),
    ),
    spec(Action::ZoomOut, "map.zoom-out", "zoom out", "Zoom out", &["-"], In(Pane::Map)),
    spec(Action::Follow, "map.follow", "follow", "Keep the craft in the middle", &["f"], In(Pane::Map)),
    spec(Action::Fit, "map.fit", "fit", "Show the whole plan", &["0"], In(Pane::Map)),
    spec(Action::ChannelUp, "rc.up", "channel above", "Select the channel above", &["up", "k"], In(Pane::Rc)),
    spec(
        Action::ChannelDown,
        "rc.down",
        "channel below",
        "Select the channel below",
        &["down", "j"],
        In(Pane::Rc),
    ),
    spec(Action::Lower, "rc.lower", "lower", "Lower the channel by 10 µs", &["left", "h", "-"], In(Pane::Rc)),
    spec(
        Action::Raise,
        "rc.raise",
        "raise",
        "Raise the channel by 10 µs",
        &["right", "l", "+"],
        In(Pane::Rc),
    ),
    spec(
        Action::LowerMuch,
        "rc.lower-much",
        "lower much",
        "Lower the channel by 100 µs",
        &["pagedown", "shift-left"],
        In(Pane::Rc),
    ),
    spec(
        Action::RaiseMuch,
        "rc.raise-much",
        "raise much",
        "Raise the channel by 100 µs",
        &["pageup", "shift-right"],
        In(Pane::Rc),
    ),
    spec(Action::Flip, "rc.flip", "flip", "Flip the switch, or centre the stick", &["enter"], In(Pane::Rc)),
    spec(Action::ScrollUp, "list.up", "up", "Scroll up", &["up", "k"], Lists),
    spec(Action::ScrollDown, "list.down", "down", "Scroll down", &["down", "j"], Lists),
    spec(Action::PageUp, "list.page-up", "page up", "Scroll up a page", &["pageup"], Lists),
    spec(Action::PageDown, "list.page-down", "page down", "Scroll down a page", &["pagedown"], Lists),
    spec(Action::Top, "list.top", "top", "To the first line", &["home"], Lists),
    spec(Action::Bottom, "list.bottom", "end", "To the last line", &["end"], Lists),
];

/// The row of an action.
#[must_use]
pub fn spec_of(action: Action) -> Option<&'static Spec> {
    ACTIONS.iter().find(|spec| spec.action == action)
}

impl Context {
    /// Whether keys of this context are heard while `focus` has the focus. In a text field letters are text.
    #[must_use]
    pub fn applies(self, focus: Pane) -> bool {
        match self {
            Self::Always => true,
            Self::Global => !focus.takes_text(),
            In(pane) => pane == focus,
            Lists => matches!(focus, Pane::State | Pane::Log | Pane::Plan),
        }
    }
}

/// Whether the action makes sense now, else why not, in one sentence with the way out.
///
/// # Errors
/// The sentence.
pub fn enabled(state: &AppState, action: Action) -> Result<(), String> {
    let craft = &state.view.vehicle.craft;
    match action {
        Action::Pause | Action::Step | Action::Slower | Action::Faster | Action::RealTime
            if state.view.simulator.is_some() =>
        {
            Err(TIME_IS_OUTSIDE.to_owned())
        }
        Action::ResetCraft if state.view.simulator == Some(LinkState::Flowing) => {
            Err(PLACE_IS_OUTSIDE.to_owned())
        }
        Action::Arm => hands::can_arm(state),
        Action::Autopilot => hands::switch(state, Mode::Autopilot).map(drop),
        Action::Throttle if state.view.vehicle.nav.engaged => {
            Err("The autopilot has the throttle: `g` switches it off.".to_owned())
        }
        Action::ReturnHome if !craft.armed => {
            Err("Nothing to bring home: the craft is disarmed. `F` flies the plan.".to_owned())
        }
        Action::ReturnHome if craft.home.is_none() => {
            Err("Home is unknown: it is the place of arming with a GPS fix.".to_owned())
        }
        Action::Upload if state.plan.plan.waypoints.is_empty() => {
            Err("No plan is open, so there is nothing to upload.".to_owned())
        }
        Action::Fly if state.view.pilot.is_none() && is_wrecked(state) => {
            Err("The craft crashed and cannot fly: `R` puts it back home.".to_owned())
        }
        Action::Fly if state.view.pilot.is_none() && craft.armed => {
            Err("The craft is armed already: `g` engages the autopilot, or disarm with `a` first.".to_owned())
        }
        _ => Ok(()),
    }
}

/// Whether the craft lies crashed, so that only a reset helps.
#[must_use]
pub fn is_wrecked(state: &AppState) -> bool {
    state.view.vehicle.truth.as_ref().is_some_and(|truth| truth.crashed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;
    use strum::IntoEnumIterator as _;

    #[test]
    fn a_simulator_outside_keeps_time_and_place_to_itself() {
        let mut state = AppState::bare((80, 24), SessionView::default());
        let times = [Action::Pause, Action::Step, Action::Slower, Action::Faster, Action::RealTime];
        let refused = |state: &AppState| times.iter().all(|&action| enabled(state, action).is_err());
        assert!(!refused(&state) && enabled(&state, Action::ResetCraft).is_ok());
        state.view.simulator = Some(LinkState::Flowing);
        assert!(refused(&state));
        assert_eq!(enabled(&state, Action::ResetCraft), Err(PLACE_IS_OUTSIDE.to_owned()));
        state.view.simulator = Some(LinkState::Silent);
        assert!(refused(&state) && enabled(&state, Action::ResetCraft).is_ok(), "it disarms at least");
    }

    #[test]
    fn every_action_has_a_row_a_key_and_a_name_of_its_own() {
        let actions =
            Action::iter().filter(|a| !matches!(a, Action::Show(_))).chain(Pane::ALL.map(Action::Show));
        for action in actions {
            let spec = spec_of(action).unwrap_or_else(|| panic!("{action:?} is not in the table"));
            assert!(!spec.keys.is_empty(), "{} has no key", spec.name);
            assert_eq!(ACTIONS.iter().filter(|other| other.name == spec.name).count(), 1, "{}", spec.name);
        }
    }
}
