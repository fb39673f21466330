//! Altitude and climb rate: dead reckoning by the accelerometer, corrected by barometer and GPS.

use super::gps::Dilution;
use super::history::{ACCEL_ERROR_LIMIT, Axis};
use super::kalman::{KalmanCovariance, ProcessNoise};
use crate::math;
use crate::signals::GpsSample;

/// The nominal step, s.
const STEP_S: f64 = 0.01;
/// The assumed errors.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Errors {
    /// The white error of the acceleration, and the random walk of its slow error.
    noise: ProcessNoise,
    /// The standard deviation of a barometer sample at full preference, m (1 Pa is 8 cm).
    baro_sigma: f64,
    /// The standard deviations of the receiver's altitude beside a barometer, m, and of its climb rate, m/s.
    gps_beside_sigma: f64,
    climb_sigma: f64,
}

const USUAL: Errors = Errors {
    noise: ProcessNoise { accel: 4e-4, drift: 4e-4 },
    baro_sigma: 0.1,
    gps_beside_sigma: 4.0,
    climb_sigma: 0.08,
};

/// Those of master, whose SITL target takes the dilution of its receiver for unknown. It does not use the climb rate.
const PLAIN: Errors = Errors {
    noise: ProcessNoise { accel: 0.02, drift: 0.0 },
    baro_sigma: 0.387,
    gps_beside_sigma: 42.4,
    climb_sigma: 1e6,
};
/// The steps between the pressure and its sample: halfway between an ideal sensor and a filtered one.
const BARO_AGE: usize = 1;
/// The error beyond five standard deviations at which a sample counts as a spike and is ignored, m.
const BARO_GATE: f64 = 1.0;
/// The number of spikes in a row after which a sample is accepted.
const PATIENCE: u8 = 10;
/// The standard deviation of the receiver's altitude without a barometer, m.
const GPS_ALONE_SIGMA: f64 = 0.6;
/// The share of a solution that the zero of the GPS altitude follows while the barometer is the better source.
const GPS_ZERO_SHARE: f64 = 0.02;
/// The standard deviations of climb rate and acceleration after an impact, m/s and m/s²: a fall, and a craft on its back.
const IMPACT_SIGMA: f64 = 20.0;
/// The time for which a measurement counts, s.
const VALID_S: f64 = 2.0;

/// The sources of the altitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[doc(hidden)]
pub enum AltitudeSource {
    /// The barometer, and the GPS as far as it helps.
    #[default]
    Both,
    BaroOnly,
    GpsOnly,
}

/// The vertical filter. Altitudes count from the last zero.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Vertical {
    errors: Errors,
    covariance: KalmanCovariance,
    axis: Axis,
    /// The barometric and GPS altitude (m) of the zero.
    baro_zero: Option<f64>,
    gps_zero: Option<f64>,
    /// The newest barometric altitude, m, and its value at the zero, also if it corrects nothing.
    seen_baro: Option<(f64, f64)>,
    spikes: u8,
    since_baro_s: f64,
    since_gps_s: f64,
}

/// Returns the altitude (m) in the standard atmosphere for a pressure (Pa).
pub(in crate::firmware) fn pressure_altitude_m(pressure_pa: f64) -> f64 {
    (1.0 - math::powf(pressure_pa / 101_325.0, 1.0 / 5.255_88)) / 2.255_77e-5
}

impl Vertical {
    pub(super) fn new() -> Self {
        Self {
            errors: USUAL,
            covariance: KalmanCovariance::new(0.5, 0.1, 0.1),
            axis: Axis::new(),
            baro_zero: None,
            gps_zero: None,
            seen_baro: None,
            spikes: 0,
            since_baro_s: f64::INFINITY,
            since_gps_s: f64::INFINITY,
        }
    }

    /// Chooses the assumed errors.
    pub(super) fn set_law(&mut self, is_plain: bool) {
        let errors = if is_plain { PLAIN } else { USUAL };
        if errors != self.errors {
            self.errors = errors;
            self.covariance = KalmanCovariance::new(0.5, 0.1, if is_plain { 0.0 } else { 0.1 });
            self.axis.accel_error = 0.0;
        }
    }

    /// Forgets how fast the craft climbs and how well the accelerometer knows it: an impact beyond what the sensor can
    /// follow has stopped it, and perhaps turned it over. The barometer finds both again.
    pub(super) fn take_impact(&mut self) {
        self.covariance = KalmanCovariance::new(1.0, IMPACT_SIGMA, IMPACT_SIGMA);
        self.axis.accel_error_limit = 2.0 * IMPACT_SIGMA;
    }

    /// Returns the altitude above the zero, m.
    pub(super) fn altitude(&self) -> f64 {
        self.axis.position
    }

    /// Returns the climb rate, m/s.
    pub(super) fn climb(&self) -> f64 {
        self.axis.velocity
    }

    /// Takes a barometric altitude, m, without a correction of the state.
    pub(super) fn see_baro(&mut self, altitude: f64) {
        let zero = self.seen_baro.map_or(altitude - self.axis.position, |(_, zero)| zero);
        self.seen_baro = Some((altitude, zero));
    }

    /// Returns the newest barometric altitude above the zero, m; zero before the first one.
    pub(super) fn baro_altitude(&self) -> f64 {
        self.seen_baro.map_or(0.0, |(altitude, zero)| altitude - zero)
    }

    /// Returns `true` if the altitude is valid.
    pub(super) fn is_valid(&self) -> bool {
        self.since_baro_s.min(self.since_gps_s) <= VALID_S
    }

    /// Sets the zero at the present altitude.
    pub(super) fn zero(&mut self) {
        let altitude = self.axis.position;
        self.axis.accel_error_limit = ACCEL_ERROR_LIMIT;
        self.axis.shift(-altitude);
        self.baro_zero = self.baro_zero.map(|zero| zero + altitude);
        self.gps_zero = self.gps_zero.map(|zero| zero + altitude);
        self.seen_baro = self.seen_baro.map(|(baro, zero)| (baro, zero + altitude));
    }

    /// Takes one step with the measured upward acceleration without gravity, m/s².
    pub(super) fn predict(&mut self, accel: f64, dt: f64) {
        self.since_baro_s += dt;
        self.since_gps_s += dt;
        if !self.is_valid() {
            // Without any measurement the craft is assumed not to climb, because dead reckoning would diverge.
            self.axis.velocity = 0.0;
            return;
        }
        self.covariance.predict(dt, &self.errors.noise);
        self.axis.predict(accel, dt);
    }

    /// Applies a barometric altitude (m). `preference` is its weight, 0…1.
    pub(super) fn fuse_baro(&mut self, altitude: f64, preference: f64) {
        if preference <= 0.0 {
            return;
        }
        let zero = *self.baro_zero.get_or_insert(altitude - self.axis.position);
        let sigma = self.errors.baro_sigma / preference.sqrt();
        let mut covariance = self.covariance;
        let gain = covariance.measure_position(sigma * sigma);
        let error = altitude - zero - self.axis.past(BARO_AGE).0;
        self.since_baro_s = 0.0;
        if error.abs() > BARO_GATE + 5.0 * gain.innovation.sqrt() && self.spikes < PATIENCE {
            self.spikes += 1;
            return;
        }
        self.spikes = 0;
        self.covariance = covariance;
        self.axis.correct(&gain, error, BARO_AGE, STEP_S);
    }

    /// Applies altitude and climb rate of a solution that is `age_s` old. The zero of the GPS altitude follows on the
    /// ground (`parked`) and stays in the air.
    pub(super) fn fuse_gps(&mut self, sample: &GpsSample, age_s: f64, source: AltitudeSource, parked: bool) {
        let age = (age_s / STEP_S).round().max(0.0) as usize;
        let altitude = f64::from(sample.alt_amsl_cm) * 0.01;
        let has_baro = self.since_baro_s <= VALID_S;
        let dilution = Dilution::of(sample);
        let expected = self.axis.past(age).0;
        let zero = self.gps_zero.get_or_insert(altitude - expected);
        if has_baro && parked {
            *zero += GPS_ZERO_SHARE * (altitude - expected - *zero);
        }
        let zero = *zero;
        self.since_gps_s = 0.0;
        let gain = self.covariance.measure_velocity(math::powi(self.errors.climb_sigma * dilution.speed, 2));
        let error = sample.vel_enu.z - self.axis.past(age).1;
        self.axis.correct(&gain, error.clamp(-5.0, 5.0), age, STEP_S);
        let sigma = if has_baro && source == AltitudeSource::Both {
            self.errors.gps_beside_sigma
        } else {
            GPS_ALONE_SIGMA
        };
        let gain = self.covariance.measure_position(math::powi(sigma * dilution.vertical, 2));
        let error = altitude - zero - self.axis.past(age).0;
        self.axis.correct(&gain, error, age, STEP_S);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled() -> Vertical {
        let mut filter = Vertical::new();
        for step in 0..1000 {
            filter.predict(0.05, STEP_S);
            if step % 2 == 0 {
                filter.fuse_baro(300.0, 1.0);
            }
        }
        filter
    }

    #[test]
    fn the_standard_atmosphere_inverts() {
        assert!(pressure_altitude_m(101_325.0).abs() < 1e-9);
        let pressure = 101_325.0 * (1.0 - 2.25577e-5 * 300.0_f64).powf(5.25588);
        assert!((pressure_altitude_m(pressure) - 300.0).abs() < 1e-6);
    }

    #[test]
    fn accelerometer_bias_does_not_lift_the_craft() {
        let filter = settled();
        assert!(filter.altitude().abs() < 0.02, "{}", filter.altitude());
        assert!(filter.climb().abs() < 0.02, "{}", filter.climb());
    }

    #[test]
    fn after_an_impact_the_altitude_does_not_go_on_below_the_ground() {
        let mut filter = settled();
        let (mut altitude, mut climb) = (0.0, 0.0);
        let mut fly = |filter: &mut Vertical, true_accel: f64, felt: f64, steps: u32| {
            let mut lowest = f64::INFINITY;
            for step in 0..steps {
                climb += true_accel * STEP_S;
                altitude += climb * STEP_S;
                filter.predict(felt, STEP_S);
                if step % 2 == 0 {
                    filter.fuse_baro(300.0 + altitude, 1.0);
                }
                lowest = filter.altitude().min(lowest);
            }
            lowest - altitude
        };
        fly(&mut filter, 20.0, 20.0, 100);
        fly(&mut filter, -20.0, -20.0, 200);
        filter.take_impact();
        // On its back it feels the ground as a pull downwards.
        let below_m = fly(&mut filter, 2000.0, -19.6, 1);
        let below_m = fly(&mut filter, 0.0, -19.6, 300).min(below_m);
        assert!(below_m > -2.0, "{below_m} m");
    }

    #[test]
    fn a_spike_does_not_move_the_altitude_but_a_lasting_step_does() {
        let mut filter = settled();
        filter.fuse_baro(308.0, 1.0);
        assert!(filter.altitude().abs() < 0.02);
        for _ in 0..2000 {
            filter.predict(0.05, STEP_S);
            filter.fuse_baro(308.0, 1.0);
        }
        assert!((filter.altitude() - 8.0).abs() < 0.2, "{}", filter.altitude());
    }

    #[test]
    fn the_zero_moves_without_a_jump_of_the_climb_rate() {
        let mut filter = settled();
        for _ in 0..300 {
            filter.predict(0.05, STEP_S);
            filter.fuse_baro(310.0, 1.0);
        }
        let climb = filter.climb();
        filter.zero();
        assert_eq!((filter.altitude(), filter.climb()), (0.0, climb));
        filter.fuse_baro(310.0, 1.0);
        assert!(filter.altitude().abs() < 0.5);
    }
}
