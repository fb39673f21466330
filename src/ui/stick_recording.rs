//! Stick and switch movements, recorded in simulated time and played again.

use super::action::Action;
use super::app_state::AppState;
use super::event_log::Severity;
use super::message::Effect;
use super::transmitter;
use crate::session::Command;
use crate::signals::RcFrame;

/// The greatest number of frames kept. A frame is kept when it changes.
const MAX_FRAMES: usize = 60_000;

/// A recording, and the current activity.
#[derive(Debug, Default)]
pub struct StickRecording {
    /// Each frame with its start, in seconds since the beginning.
    frames: Vec<(f64, RcFrame)>,
    length_s: f64,
    activity: Activity,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Activity {
    #[default]
    Idle,
    /// Recording since this simulated time, s.
    Recording(f64),
    /// Playing since this simulated time, s, with the index of the next frame.
    Playing(f64, usize),
}

impl StickRecording {
    /// Returns the activity for the title of the RC panel; `None` while idle.
    pub(super) fn shown(&self, now_s: f64) -> Option<String> {
        match self.activity {
            Activity::Idle => None,
            Activity::Recording(since) => Some(format!("● REC {:.1} s", now_s - since)),
            Activity::Playing(since, _) => {
                Some(format!("► PLAY {:.1} of {:.1} s", (now_s - since).max(0.0), self.length_s))
            }
        }
    }

    /// Follows the flight back to this earlier instant, s: drops the frames recorded after it and ends playing.
    pub(super) fn go_back_to(&mut self, time_s: f64) {
        match self.activity {
            Activity::Recording(since) if since <= time_s => {
                self.frames.retain(|(at_s, _)| *at_s <= time_s - since);
            }
            Activity::Recording(_) => *self = Self::default(),
            Activity::Playing(..) => self.activity = Activity::Idle,
            Activity::Idle => {}
        }
    }

    /// Ends playing, because the user takes the sticks. Returns `true` if it was on.
    pub(super) fn stop_playing(&mut self) -> bool {
        let was_on = matches!(self.activity, Activity::Playing(..));
        if was_on {
            self.activity = Activity::Idle;
        }
        was_on
    }
}

/// Begins a recording, or ends it.
pub(super) fn toggle_recording(state: &mut AppState) -> Vec<Effect> {
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
pub(super) fn toggle_playing(state: &mut AppState) -> Vec<Effect> {
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

/// Checks that there is something to play.
///
/// # Errors
/// Returns the reason in a sentence if there is not.
pub(super) fn can_play(state: &AppState) -> Result<(), String> {
    let recording = &state.stick_recording;
    match recording.activity {
        Activity::Recording(_) => Err("The sticks are being recorded: end that first.".to_owned()),
        Activity::Idle if recording.frames.is_empty() => {
            let key = state.key(Action::Record);
            Err(format!("No stick movements are recorded: `{key}` in the RC panel begins."))
        }
        Activity::Idle | Activity::Playing(..) => Ok(()),
    }
}

/// Records a changed frame, or sends the frame that is due. Called with each picture.
pub(super) fn advance(state: &mut AppState) -> Vec<Effect> {
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
            vec![Effect::Send(Command::Sticks(frame))]
        }
    }
}
