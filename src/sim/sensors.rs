//! The sensors: they turn the true state into the inputs of the flight controller.
//!
//! Inertial samples come with every step, everything else on slow ticks of 10 ms: the magnetometer on each tick,
//! barometer and battery on every second one, GPS at its own rate. With [`Noise::None`] all values are exact and
//! without latency, and no random number is drawn.

use nalgebra::Vector3;

use crate::geo::LocalFrame;
use crate::signals::{BatterySample, SensorFrame};

use super::atmosphere;
use super::config::{Noise, WorldConfig};
use super::fault::Effects;
use super::random::{Normals, Stream};
use super::switches::Switches;
use super::truth::Truth;

mod barometer;
mod gps;
mod imu;
mod magnetometer;

use barometer::Barometer;
use gps::Gps;
use imu::Imu;
use magnetometer::Magnetometer;
pub use magnetometer::magnetic_field_enu;

/// The number of slow ticks between two samples of barometer and battery: 50 Hz.
const FIFTY_HZ_TICKS: u64 = 2;
/// The noise of voltage (V) and current (A) readings, standard deviation.
const VOLTAGE_SIGMA_V: f64 = 0.02;
const CURRENT_SIGMA_A: f64 = 0.1;

/// All sensors of the craft.
#[derive(Debug, Clone)]
pub(super) struct Sensors {
    pub noise: Noise,
    imu: Imu,
    barometer: Barometer,
    magnetometer: Magnetometer,
    pub gps: Gps,
    battery: Normals,
    local: LocalFrame,
}

/// The inputs of a sensor.
pub(super) struct SensorInputs<'a> {
    pub truth: &'a Truth,
    pub effects: &'a Effects,
    pub switches: &'a Switches,
    /// Number of the slow tick, if the present instant is one.
    pub slow_tick: Option<u64>,
    /// Body rates one step before, FLU, rad/s.
    pub rate_before_flu: Vector3<f64>,
}

impl Sensors {
    pub(super) fn new(config: &WorldConfig, step_s: f64) -> Self {
        let home = &config.home;
        Self {
            noise: config.noise,
            imu: Imu::new(config, step_s),
            barometer: Barometer::new(config.seed),
            magnetometer: Magnetometer::new(config.seed),
            gps: Gps::new(config.seed, config.switches.gps),
            battery: Normals::new(config.seed, Stream::Battery),
            local: LocalFrame::new(home.lat_deg, home.lon_deg, home.alt_amsl_m),
        }
    }

    /// Returns the local frame in which the positions are measured.
    pub(super) fn local(&self) -> &LocalFrame {
        &self.local
    }

    /// Forgets the history of delayed sensors, as if the craft had always been here.
    pub(super) fn settle(&mut self, pos_enu: Vector3<f64>, vel_enu: Vector3<f64>) {
        self.gps.settle(pos_enu, vel_enu);
        self.barometer.settle();
    }

    /// Reads every sensor that is due at the present instant.
    pub(super) fn read(&mut self, inputs: &SensorInputs<'_>, frame: &mut SensorFrame) {
        let truth = inputs.truth;
        let (rate, force) = (truth.rate_flu, truth.specific_force_flu);
        frame.time = truth.time;
        frame.truth_attitude = Some(truth.attitude);
        frame.pressure_pa = None;
        frame.mag_flu = None;
        frame.gps = None;
        frame.battery = None;
        if let Some(tick) = inputs.slow_tick {
            self.read_slow(tick, inputs, frame);
        }
        if !inputs.effects.imu_freeze {
            (frame.rate_flu, frame.specific_force_flu) = self.imu.read(rate, force, inputs, self.noise);
        }
    }

    fn read_slow(&mut self, tick: u64, inputs: &SensorInputs<'_>, frame: &mut SensorFrame) {
        let (truth, effects) = (inputs.truth, inputs.effects);
        self.imu.drift(inputs.switches, self.noise);
        frame.mag_flu =
            self.magnetometer.read(&truth.attitude, inputs.switches.declination_deg, effects, self.noise);
        frame.gps = self.gps.advance(tick, truth, &self.local, &effects.gps, self.noise);
        if tick.is_multiple_of(FIFTY_HZ_TICKS) {
            let pressure = atmosphere::pressure_pa(self.local.alt_amsl_m + truth.pos_enu.z);
            frame.pressure_pa = Some(self.barometer.read(pressure, inputs.switches, effects, self.noise));
            frame.battery = Some(self.read_battery(truth));
        }
    }

    fn read_battery(&mut self, truth: &Truth) -> BatterySample {
        let battery = &truth.battery;
        let (dv, di) = match self.noise {
            Noise::Real => (VOLTAGE_SIGMA_V * self.battery.next(), CURRENT_SIGMA_A * self.battery.next()),
            Noise::None => (0.0, 0.0),
        };
        BatterySample {
            voltage_v: (battery.voltage_v + dv).max(0.0),
            current_a: (battery.current_a + di).max(0.0),
            drawn_mah: battery.drawn_mah,
        }
    }
}

/// Rounds to a multiple of `1/per_unit`, as a converter does. This is a cheap exact rounding for magnitudes below
/// 2⁵¹.
fn quantise(value: f64, per_unit: f64) -> f64 {
    const SHIFT: f64 = 6_755_399_441_055_744.0; // 1.5·2⁵²: adding it leaves no bits below the unit.
    ((value * per_unit + SHIFT) - SHIFT) / per_unit
}

#[cfg(test)]
mod tests {
    use super::quantise;

    #[test]
    fn quantising_rounds_to_the_grid() {
        assert_eq!(quantise(1.26, 10.0), 1.3);
        assert_eq!(quantise(-1.24, 10.0), -1.2);
        assert_eq!(quantise(0.0, 16.4), 0.0);
    }
}
