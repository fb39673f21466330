//! The keys that record and play the sticks, and the step of the recording with each picture.

use super::transmitter;
use crate::session::Command;
use crate::ui::model::action::{Action, PanelAction};
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::stick_recording::{Activity, MAX_FRAMES, StickRecording};
use crate::ui::shared::Shared;
use crate::vehicle::VehicleCommand;

/// Begins a recording, or ends it.
pub(in crate::ui) fn toggle_recording(state: &mut Shared) -> Vec<Effect> {
    let now_s = state.view.vehicle.time.as_secs_f64();
    let first = transmitter::frame(state);
    let recording = &mut state.stick_recording;
    if let Activity::Recording(since) = recording.activity {
        recording.activity = Activity::Idle;
        recording.length_s = now_s - since;
        let text = format!("{:.1} s of stick movements recorded.", recording.length_s);
        state.notify(Severity::Good, text);
    } else {
        *recording = StickRecording {
            frames: vec![(0.0, first)],
            length_s: 0.0,
            activity: Activity::Recording(now_s),
        };
        state.notify(Severity::Info, "Recording the sticks from here.");
    }
    Vec::new()
}

/// Plays the recording from its beginning, or stops playing.
pub(in crate::ui) fn toggle_playing(state: &mut Shared) -> Vec<Effect> {
    let now_s = state.view.vehicle.time.as_secs_f64();
    let recording = &mut state.stick_recording;
    if recording.stop_playing() {
        state.notify(Severity::Info, "Playing stopped: the sticks stay where they are.");
        return Vec::new();
    }
    recording.activity = Activity::Playing(now_s, 0);
    state.notify(Severity::Info, "Playing the recorded stick movements.");
    advance(state)
}

/// Checks that the recorded stick movements can be played, or playing can be stopped.
///
/// # Errors
/// Returns the reason in a sentence if not.
pub(in crate::ui) fn can_play(state: &Shared) -> Result<(), String> {
    let recording = &state.stick_recording;
    match recording.activity {
        Activity::Recording(_) => Err("The sticks are being recorded: end that first.".to_owned()),
        Activity::Idle if recording.frames.is_empty() => {
            let key = state.key(Action::Panel(PanelAction::Record));
            Err(format!("No stick movements are recorded: `{key}` in the RC panel begins."))
        }
        Activity::Idle | Activity::Playing(..) => Ok(()),
    }
}

/// Records a changed frame, or sends the frame that is due. Called with each picture.
pub(in crate::ui) fn advance(state: &mut Shared) -> Vec<Effect> {
    let now_s = state.view.vehicle.time.as_secs_f64();
    let frame = transmitter::frame(state);
    let recording = &mut state.stick_recording;
    match recording.activity {
        Activity::Idle => Vec::new(),
        Activity::Recording(since) => {
            let is_new = recording.frames.last().is_none_or(|(_, last)| *last != frame);
            if is_new && recording.frames.len() < MAX_FRAMES && now_s >= since {
                recording.frames.push((now_s - since, frame));
            }
            Vec::new()
        }
        Activity::Playing(since, next) => {
            let elapsed_s = now_s - since;
            let due = recording.frames.partition_point(|(at_s, _)| *at_s <= elapsed_s);
            let frame = due.checked_sub(1).filter(|_| due > next).and_then(|at| recording.frames.get(at));
            let frame = frame.map(|(_, frame)| *frame);
            recording.activity = Activity::Playing(since, due.max(next));
            if due == recording.frames.len() && elapsed_s >= recording.length_s {
                recording.activity = Activity::Idle;
                state.notify(Severity::Good, "The recorded stick movements were played to their end.");
            }
            let Some(frame) = frame else { return Vec::new() };
            state.sticks_sent = Some((frame, state.now));
            vec![Effect::Send(Command::Vehicle(VehicleCommand::Sticks(frame)))]
        }
    }
}
