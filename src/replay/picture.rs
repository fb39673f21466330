//! The signals of a flight at one instant, as tracks and graphs need them.

use crate::math;
use crate::signals::SimTime;
use crate::telemetry::signal::{Observed, Signal, SignalValues};
use crate::telemetry::{ModeFlags, Snapshot};

/// All signals at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Picture {
    pub time: SimTime,
    /// `true` if the autopilot was flying.
    pub engaged: bool,
    /// The active modes, if they are known.
    pub modes: Option<ModeFlags>,
    values: SignalValues,
}

impl Picture {
    /// Returns the signals of a snapshot.
    pub fn of(vehicle: &Snapshot) -> Self {
        let mut values = SignalValues::of(&Observed::of(vehicle));
        // A navigator that flies nothing keeps the values of its last mission.
        if !vehicle.is_engaged() {
            for signal in [Signal::TargetAltitude, Signal::CrossTrack, Signal::WpDistance] {
                values.set(signal, f64::NAN);
            }
        }
        // The curve is the horizontal wind.
        let wind = math::hypot(values.get(Signal::WindNorth), values.get(Signal::WindEast));
        values.set(Signal::Wind, wind);
        // A real craft has no truth.
        for (truth, estimate) in [(Signal::North, Signal::EstNorth), (Signal::East, Signal::EstEast)] {
            if values.get(truth).is_nan() {
                values.set(truth, values.get(estimate));
            }
        }
        Self { time: vehicle.time, engaged: vehicle.is_engaged(), modes: vehicle.craft.modes, values }
    }

    /// Returns the time, s.
    pub fn time_s(&self) -> f64 {
        self.time.as_secs_f64()
    }

    /// Returns the values of all signals.
    pub fn values(&self) -> &SignalValues {
        &self.values
    }

    /// Returns the value of a signal, if it is known.
    pub fn value(&self, signal: Signal) -> Option<f64> {
        Some(self.values.get(signal)).filter(|value| value.is_finite())
    }

    /// Returns the place, north and east of the origin, m, if it is known.
    pub fn place(&self) -> Option<(f64, f64)> {
        self.value(Signal::North).zip(self.value(Signal::East))
    }

    /// Returns the altitude, m: the true one if it is known.
    pub fn altitude_m(&self) -> Option<f64> {
        self.value(Signal::Altitude).or(self.value(Signal::EstAltitude))
    }
}
