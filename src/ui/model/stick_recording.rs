//! Stick and switch movements, recorded in simulated time and played again.

use crate::signals::RcFrame;

/// The greatest number of frames kept. A frame is kept when it changes.
pub(in crate::ui) const MAX_FRAMES: usize = 60_000;

/// A recording, and the current activity.
#[derive(Debug, Default)]
pub struct StickRecording {
    /// Each frame with its start, in seconds since the beginning.
    pub(in crate::ui) frames: Vec<(f64, RcFrame)>,
    pub(in crate::ui) length_s: f64,
    pub(in crate::ui) activity: Activity,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::ui) enum Activity {
    #[default]
    Idle,
    /// Recording since this simulated time, s.
    Recording(f64),
    /// Playing since this simulated time, s, with the index of the next frame.
    Playing(f64, usize),
}

impl StickRecording {
    /// Returns the activity for the title of the RC panel; `None` while idle.
    pub(in crate::ui) fn shown(&self, now_s: f64) -> Option<String> {
        match self.activity {
            Activity::Idle => None,
            Activity::Recording(since) => Some(format!("● REC {:.1} s", now_s - since)),
            Activity::Playing(since, _) => {
                Some(format!("► PLAY {:.1} of {:.1} s", (now_s - since).max(0.0), self.length_s))
            }
        }
    }

    /// Follows the flight back to this earlier instant, s: drops the frames recorded after it and ends playing.
    pub(in crate::ui) fn go_back_to(&mut self, time_s: f64) {
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
    pub(in crate::ui) fn stop_playing(&mut self) -> bool {
        let was_on = matches!(self.activity, Activity::Playing(..));
        if was_on {
            self.activity = Activity::Idle;
        }
        was_on
    }
}
