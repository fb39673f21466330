//! The clock of a hold and the phase of its pattern.

use crate::signals::SimTime;

/// A hold under way.
#[derive(Debug, Clone, Default)]
pub(super) struct Hold {
    began: SimTime,
    phase_rad: f64,
    by_command: bool,
}

impl Hold {
    pub(super) fn begin(&mut self, time: SimTime) {
        self.began = time;
    }

    /// Enters HOLDING by a command. Its time does not end.
    pub(super) fn begin_by_command(&mut self, time: SimTime) {
        self.begin(time);
        self.by_command = true;
    }

    /// Returns `true` if the hold was commanded.
    pub(super) fn is_by_command(&self) -> bool {
        self.by_command
    }

    /// Returns the time since HOLDING was entered, µs.
    pub(super) fn elapsed_us(&self, time: SimTime) -> u64 {
        time.0.saturating_sub(self.began.0)
    }

    pub(super) fn begin_pattern(&mut self) {
        self.phase_rad = 0.0;
    }

    /// Advances by `step_rad` on a pattern that repeats after `period_rad`.
    pub(super) fn advance_pattern(&mut self, step_rad: f64, period_rad: f64) {
        self.phase_rad = (self.phase_rad + step_rad).rem_euclid(period_rad);
    }

    /// Returns the phase of the pattern, rad.
    pub(super) fn phase_rad(&self) -> f64 {
        self.phase_rad
    }
}
