//! Moves through the recording of the flight.

use crate::session::command::Seek;
use crate::session::{Command, SessionView};
use crate::ui::acts::availability::is_wrecked;
use crate::ui::acts::screen_layout;
use crate::ui::model::action::Action;
use crate::ui::model::effect::Effect;
use crate::ui::shared::Shared;
use crate::ui::timeline;

/// The time that one press of the keys for earlier and later skips, s.
const SKIP_S: f64 = 10.0;

/// Carries out an action of the timeline.
pub(super) fn act(state: &Shared, action: Action) -> Vec<Effect> {
    let command = match action {
        Action::EventBack => Command::Seek(Seek::Back { states_only: false }),
        Action::EventForward => Command::Seek(Seek::Forward { states_only: false }),
        Action::StateBack if is_wrecked(state) || state.is_disarmed_in_the_air() => {
            Command::Seek(Seek::BeforeMishap)
        }
        Action::StateBack => Command::Seek(Seek::Back { states_only: true }),
        Action::StateForward => Command::Seek(Seek::Forward { states_only: true }),
        Action::Earlier => Command::Seek(Seek::Seconds(-SKIP_S)),
        Action::Later => Command::Seek(Seek::Seconds(SKIP_S)),
        Action::FlyOn => Command::FlyOn,
        Action::Newest => Command::Seek(Seek::Newest),
        Action::NextFlight => Command::ShowFlight(1),
        Action::PreviousFlight => Command::ShowFlight(-1),
        _ => return Vec::new(),
    };
    vec![Effect::Send(command)]
}

/// Pauses and advances by some ticks.
pub(super) fn step(state: &Shared, ticks: u32) -> Vec<Effect> {
    let pause = (!state.view.paused).then_some(Effect::Send(Command::Pause(true)));
    pause.into_iter().chain([Effect::Send(Command::Step(ticks))]).collect()
}

/// Handles a click on the timeline, which shows that instant; `None` if the click is elsewhere.
pub(super) fn click(state: &Shared, column: u16, row: u16) -> Option<Vec<Effect>> {
    let area = screen_layout::screen(state)?.timeline.filter(|area| area.contains((column, row).into()))?;
    let recorded = state.view.timeline.as_ref()?;
    let time = timeline::time_at(recorded, area, column);
    Some(time.map_or_else(Vec::new, |time| vec![Effect::Send(Command::Seek(Seek::Time(time)))]))
}

/// Moves the track after the fork to the abandoned tracks if `view` is on another branch than the view before. Returns
/// `true` in that case.
pub(super) fn follow_branch(state: &mut Shared, view: &SessionView) -> bool {
    let branch = |view: &SessionView| view.timeline.as_ref().map_or(0, |timeline| timeline.branch);
    let Some(timeline) = view.timeline.as_ref().filter(|timeline| timeline.branch != branch(&state.view))
    else {
        return false;
    };
    state.stick_recording.go_back_to(timeline.branched_at.as_secs_f64());
    let part = state.track.cut_after(timeline.branched_at.as_secs_f64());
    state.abandoned.keep(part);
    true
}
