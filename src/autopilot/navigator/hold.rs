//! The clock of a hold, its pattern and the phase in it.

use std::f64::consts::TAU;

use crate::autopilot::guidance::{PatternPoint, figure8, orbit, pattern_rate_rps};
use crate::autopilot::params::Params;
use crate::signals::SimTime;
use crate::telemetry::NavState;

/// The pattern of a hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pattern {
    Orbit,
    Figure8,
}

impl Pattern {
    /// Returns the pattern that is flown in a state.
    pub(super) fn of(state: NavState) -> Option<Self> {
        match state {
            NavState::Orbiting => Some(Self::Orbit),
            NavState::Figure8 => Some(Self::Figure8),
            NavState::Idle
            | NavState::Approaching
            | NavState::Arrived
            | NavState::Holding
            | NavState::Landing
            | NavState::Complete => None,
        }
    }

    /// Returns the radius of the circles, m.
    pub(super) fn radius_m(self, params: &Params) -> f64 {
        match self {
            Self::Orbit => f64::from(params.hold_orbit_radius) / 100.0,
            Self::Figure8 => f64::from(params.hold_figure8_width) / 200.0,
        }
    }

    /// Returns the change of the phase at a speed, rad/s.
    pub(super) fn rate_rps(self, speed_mps: f64, params: &Params) -> f64 {
        pattern_rate_rps(self.radius_m(params), speed_mps, params)
    }

    /// Returns the phase after which the pattern repeats, rad.
    pub(super) fn period_rad(self) -> f64 {
        match self {
            Self::Orbit => TAU,
            Self::Figure8 => 2.0 * TAU,
        }
    }

    pub(super) fn point(self, phase_rad: f64, params: &Params) -> PatternPoint {
        let radius = self.radius_m(params);
        match self {
            Self::Orbit => orbit(radius, phase_rad),
            Self::Figure8 => figure8(2.0 * radius, phase_rad),
        }
    }
}

/// A hold under way.
#[derive(Debug, Clone, Default)]
pub(super) struct Hold {
    began: SimTime,
    pub phase_rad: f64,
    pub by_command: bool,
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

    /// Returns the time since HOLDING was entered, µs.
    pub(super) fn elapsed_us(&self, time: SimTime) -> u64 {
        time.0.saturating_sub(self.began.0)
    }

    /// Advances by `step_rad` on a pattern that repeats after `period_rad`.
    pub(super) fn advance_pattern(&mut self, step_rad: f64, period_rad: f64) {
        self.phase_rad = (self.phase_rad + step_rad).rem_euclid(period_rad);
    }
}
