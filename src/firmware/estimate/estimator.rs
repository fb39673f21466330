//! The estimator: sensor frames in, one [`Estimate`] out.

use nalgebra::{Vector2, Vector3};

use super::attitude::{Attitude, VerticalGains, missing_in_steady_motion};
use super::calibration::{AccCalibration, GyroCalibration, MagCalibration, NotTurned};
use super::compass::{CompassCheck, CompassVerdict};
use super::gps::GpsMonitor;
use super::heading::{CourseComparison, MagTrust, magnetic_error};
use super::horizontal::Horizontal;
use super::schedule::Schedule;
use super::straight::StraightFlight;
use super::tilt_check::{TiltCheck, urgency};
use super::tuning::{AttitudeSource, EstimatorOptions, EstimatorTuning};
use super::vertical::{AltitudeSource, Vertical, pressure_altitude_m};
use super::{DueTasks, Estimate, Rates};
use crate::firmware::filter::{Pt1, Pt2, pt1_gain};
use crate::geo::{GRAVITY, LatLon, wrap_pi};
use crate::math;
use crate::signals::{GpsSample, SensorFrame, SimTime};

/// The specific force of an impact, m/s²: a hard landing stays below half of it.
const IMPACT: f64 = 150.0;
/// The nominal step of the slow part, s.
const SLOW_S: f64 = 0.01;
/// The longest step that is integrated, s. After a stall the craft is assumed to be at its last position, not further
/// along its path.
const MAX_STEP_S: f64 = 0.05;
/// The largest plausible sensor readings, rad/s and m/s². Beyond them the sensor is broken.
const RATE_LIMIT: f64 = 60.0;
const FORCE_LIMIT: f64 = 500.0;
/// The body rate below which a sensor that repeats a sample may be at rest, rad/s.
const MOVING: f64 = 0.01;
/// The factor by which the tilt follows the accelerometer faster on the ground.
const PARKED_FACTOR: f64 = 10.0;
/// The same factor in the air after the GPS was lost or before the heading is known: slower. The tilt is correct then,
/// but a craft that coasts to a stop feels its drag as a tilt, and one that speeds up feels nothing.
const ORPHANED_FACTOR: f64 = 0.2;
/// The same factor while the horizontal filter knows the motion of the craft. The correction is then better informed
/// and works faster, and an integral (critically damped: a quarter of the square of the gain) finds a gyro offset in
/// flight.
const AIDED_FACTOR: f64 = 2.0;
const AIDED_INTEGRAL: f64 = 0.25;
/// The time after a sample for which the magnetometer counts as present, s.
const MAG_VALID_S: f64 = 1.0;
/// The time with the same inertial sample after which the sensor counts as frozen, s.
const FROZEN_S: f64 = 1.0;

/// Estimates attitude, position and altitude from sensor data.
#[derive(Debug, Clone)]
#[doc(hidden)]
pub struct Estimator {
    options: EstimatorOptions,
    tuning: EstimatorTuning,
    schedule: Schedule,
    estimate: Estimate,
    time: Option<SimTime>,
    armed: bool,
    /// `true` if the horizontal filter has supported the tilt correction in this flight.
    was_aided: bool,
    last_rate: Vector3<f64>,
    last_force: Vector3<f64>,
    /// `true` after an impact since the last slow step.
    has_hit: bool,
    same_s: f64,
    gyro: GyroCalibration,
    acc: Option<AccCalibration>,
    acc_result: Option<[i64; 3]>,
    mag: Option<MagCalibration>,
    mag_result: Option<Result<[i64; 3], NotTurned>>,
    attitude: Attitude,
    /// The sum of the specific force since the last attitude step, body axes, and the number of samples.
    force_sum: Vector3<f64>,
    force_samples: f64,
    /// The sum of their means since the last slow step, world axes, and the number of means.
    world_sum: Vector3<f64>,
    world_samples: f64,
    force_filter: [Pt1; 3],
    slow_time: SimTime,
    pending_gps: Option<(GpsSample, SimTime)>,
    pending_pressure: Option<f64>,
    pending_mag: Option<Vector3<f64>>,
    /// The time since the magnetometer last corrected the heading, and since its newest sample, s.
    since_mag_s: f64,
    since_mag_sample_s: f64,
    gps: GpsMonitor,
    horizontal: Horizontal,
    vertical: Vertical,
    course: CourseComparison,
    compass: CompassCheck,
    tilt: TiltCheck,
    straight: StraightFlight,
    /// The angle of the estimated heading clockwise from that of the newest magnetometer sample, rad.
    mag_error: f64,
    solution_at: SimTime,
    shown_alt: Pt2,
    shown_climb: Pt2,
}

impl Estimator {
    /// Creates an estimator at boot.
    pub fn new(options: EstimatorOptions, tuning: EstimatorTuning) -> Self {
        let mut estimator = Self {
            options,
            tuning: tuning.clone(),
            schedule: Schedule::default(),
            estimate: Estimate::default(),
            time: None,
            armed: false,
            was_aided: false,
            last_rate: Vector3::zeros(),
            last_force: Vector3::new(0.0, 0.0, GRAVITY),
            has_hit: false,
            same_s: 0.0,
            gyro: GyroCalibration::new(),
            acc: None,
            acc_result: None,
            mag: None,
            mag_result: None,
            attitude: Attitude::new(),
            force_sum: Vector3::zeros(),
            force_samples: 0.0,
            world_sum: Vector3::zeros(),
            world_samples: 0.0,
            force_filter: [Pt1::default(); 3],
            slow_time: SimTime::ZERO,
            pending_gps: None,
            pending_pressure: None,
            pending_mag: None,
            since_mag_s: 0.0,
            since_mag_sample_s: f64::INFINITY,
            gps: GpsMonitor::default(),
            horizontal: Horizontal::new(),
            vertical: Vertical::new(),
            course: CourseComparison::new(),
            compass: CompassCheck::default(),
            tilt: TiltCheck::default(),
            straight: StraightFlight::default(),
            mag_error: 0.0,
            solution_at: SimTime::ZERO,
            shown_alt: Pt2::default(),
            shown_climb: Pt2::default(),
        };
        estimator.set_tuning(tuning);
        estimator
    }

    /// Changes the tuning. Not for use within a step.
    pub fn set_tuning(&mut self, tuning: EstimatorTuning) {
        self.horizontal.set_law(tuning.is_plain, tuning.accel_trust);
        self.vertical.set_law(tuning.is_plain);
        self.tuning = tuning;
    }

    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// Sets altitude zero and starts the local frame at `home`, or here if there is none. Called when the craft is armed.
    pub fn on_arm(&mut self, home: Option<LatLon>) {
        self.armed = true;
        self.was_aided = false;
        self.compass.reset();
        self.tilt = TiltCheck::default();
        self.vertical.zero();
        self.shown_alt.reset(0.0);
        if let Some(origin) = home.or_else(|| self.estimate.place()) {
            self.horizontal.set_origin(origin);
        }
        self.publish();
    }

    /// Notes that the craft was disarmed. Altitude and position keep their zero, so the way back to home stays known.
    pub fn on_disarm(&mut self) {
        self.armed = false;
    }

    /// Starts a calibration of the gyro.
    pub fn calibrate_gyro(&mut self) {
        self.gyro = GyroCalibration::after(self.gyro.bias);
        self.estimate.calibrating = true;
    }

    /// Starts a calibration of the accelerometer. The craft must be level and still.
    pub fn calibrate_accelerometer(&mut self) {
        self.acc = Some(AccCalibration::new());
        self.estimate.calibrating = true;
    }

    /// Starts a calibration of the magnetometer. The pilot must turn the craft about all its axes for half a minute.
    pub fn calibrate_magnetometer(&mut self) {
        self.mag = Some(MagCalibration::new());
        self.estimate.calibrating = true;
    }

    /// Returns once the result of a magnetometer calibration that has just ended, for `mag_calibration`.
    pub fn take_mag_calibration(&mut self) -> Option<Result<[i64; 3], NotTurned>> {
        self.mag_result.take()
    }

    /// Returns once the result of an accelerometer calibration that has just ended, for the begin of `acc_calibration`.
    pub fn take_acc_calibration(&mut self) -> Option<[i64; 3]> {
        self.acc_result.take()
    }

    /// Processes one frame. Returns the slower loops that run in this step.
    pub fn update(&mut self, frame: &SensorFrame) -> DueTasks {
        let now = frame.time;
        let dt = self.time.map_or(0.0, |last| now.seconds_since(last)).min(MAX_STEP_S);
        let is_first = self.time.replace(now).is_none();
        let rate = self.take_inertial(frame, dt);
        if is_first {
            self.attitude.align(&self.last_force);
            self.slow_time = now;
        }
        self.take_slow(frame);
        match (self.options.attitude, frame.truth_attitude) {
            (AttitudeSource::Truth, Some(truth)) if truth.coords.iter().all(|c| c.is_finite()) => {
                self.attitude.q = truth;
                self.estimate.heading_valid = true;
            }
            _ => {
                self.attitude.integrate(&rate, dt);
            }
        }
        let due = self.schedule.due(now, self.tuning.attitude_us);
        if due.attitude {
            self.attitude_step();
        }
        if due.navigation {
            self.slow_step(frame, now);
        }
        due
    }

    /// Takes the gyro and accelerometer samples of this step. A broken sample repeats the last good one. Returns the body
    /// rates without the bias.
    fn take_inertial(&mut self, frame: &SensorFrame, dt: f64) -> Vector3<f64> {
        let (rate, force) = (frame.rate_flu, frame.specific_force_flu);
        let is_same = rate == self.last_rate && force == self.last_force + self.tuning.acc_offset_flu;
        // At rest, the samples of an ideal sensor repeat, too.
        self.same_s = if is_same && rate.norm_squared() > MOVING * MOVING { self.same_s + dt } else { 0.0 };
        self.estimate.imu_frozen = self.same_s > FROZEN_S;
        let rate = if rate.norm_squared() <= RATE_LIMIT * RATE_LIMIT { rate } else { self.last_rate };
        self.has_hit |= force.norm_squared() > IMPACT * IMPACT;
        let is_sound = force.norm_squared() <= FORCE_LIMIT * FORCE_LIMIT;
        let force = if is_sound { force - self.tuning.acc_offset_flu } else { self.last_force };
        (self.last_rate, self.last_force) = (rate, force);
        if !self.gyro.done && dt > 0.0 {
            let tuning = &self.tuning;
            self.gyro.feed(&rate, dt, tuning.gyro_calibration_s, tuning.gyro_noise_limit);
        }
        self.force_sum += force;
        self.force_samples += 1.0;
        self.estimate.force_flu = force;
        let rate = if self.tuning.is_plain { rate } else { rate - self.gyro.bias };
        self.estimate.rates = Rates::from_flu(&(rate + self.attitude.rate_correction()));
        rate
    }

    /// Stores samples that do not come with every frame for the next slow step.
    fn take_slow(&mut self, frame: &SensorFrame) {
        if let Some(gps) = frame.gps {
            self.pending_gps = Some((gps, frame.time));
        }
        if frame.pressure_pa.is_some() {
            self.pending_pressure = frame.pressure_pa;
        }
        if frame.mag_flu.is_some() {
            self.pending_mag = frame.mag_flu;
        }
    }

    fn attitude_step(&mut self) {
        self.attitude.refresh();
        if self.force_samples > 0.0 {
            self.world_sum += self.attitude.matrix * (self.force_sum / self.force_samples);
            self.world_samples += 1.0;
            (self.force_sum, self.force_samples) = (Vector3::zeros(), 0.0);
        }
        let estimate = &mut self.estimate;
        estimate.attitude = self.attitude.q;
        (estimate.roll_rad, estimate.pitch_down_rad) = self.attitude.roll_pitch_down();
        estimate.cos_tilt = self.attitude.cos_tilt();
        estimate.attitude_valid = true;
    }

    fn slow_step(&mut self, frame: &SensorFrame, now: SimTime) {
        let dt = now.seconds_since(self.slow_time).min(2.0 * MAX_STEP_S);
        self.slow_time = now;
        let force = self.world_sum / self.world_samples.max(1.0);
        (self.world_sum, self.world_samples) = (Vector3::zeros(), 0.0);
        if let Some(acc) = &mut self.acc
            && let Some(result) = acc.feed(&(self.last_force + self.tuning.acc_offset_flu))
        {
            (self.acc, self.acc_result) = (None, Some(result));
        }
        if let Some(mag) = &mut self.mag {
            if let Some(sample) = &self.pending_mag {
                mag.feed(&self.tuning.aligned_mag(sample));
            }
            if let Some(result) = mag.wait(dt) {
                (self.mag, self.mag_result) = (None, Some(result));
            }
        }
        let felt = Vector2::new(force.y, force.x);
        // While the heading is unknown, the felt acceleration has no known direction over the ground.
        let known = if self.estimate.heading_valid { felt } else { Vector2::zeros() };
        self.horizontal.predict(known, dt);
        if std::mem::take(&mut self.has_hit) {
            self.vertical.take_impact();
        }
        self.vertical.predict(force.z - GRAVITY, dt);
        self.course.predict(felt, dt);
        self.fuse_gps(now);
        self.fuse_baro();
        if self.options.attitude == AttitudeSource::Estimated || frame.truth_attitude.is_none() {
            self.fuse_mag(dt);
            self.correct_tilt(&force, dt);
        }
        self.estimate.heading_rad = self.attitude.heading();
        self.estimate.accel_ne = felt + self.horizontal.accel_error();
        self.show(dt);
        self.publish();
    }

    fn fuse_gps(&mut self, now: SimTime) {
        let timeout = self.options.gps_timeout_s.max(2.5 / self.tuning.gps_rate_hz);
        if let Some((sample, arrived)) = self.pending_gps.take()
            && let Some(sample) = self.gps.receive(sample, arrived)
        {
            let latency = if sample.latency_s.is_finite() { sample.latency_s.clamp(0.0, 0.3) } else { 0.0 };
            let age = latency + now.seconds_since(arrived);
            let velocity = Vector2::new(sample.vel_enu.y, sample.vel_enu.x);
            let turn = self.course.compare(velocity, (age / SLOW_S).round() as usize);
            if self.armed {
                self.fuse_course(velocity, turn, arrived);
            }
            // Master compares a solution with its newest estimate.
            let age = if self.tuning.is_plain { 0.0 } else { age };
            self.horizontal.fuse(&sample, age);
            if self.tuning.altitude_source != AltitudeSource::BaroOnly {
                self.vertical.fuse_gps(&sample, age, self.tuning.altitude_source, !self.armed);
            }
        }
        self.gps.update(now, timeout);
        if !self.gps.status.fix {
            self.course.clear();
        }
    }

    /// Updates the heading from a solution's velocity (north, east). `turn` is the correction from the comparison of
    /// accelerations, anticlockwise, rad.
    fn fuse_course(&mut self, velocity: Vector2<f64>, turn: f64, arrived: SimTime) {
        let dt = arrived.seconds_since(std::mem::replace(&mut self.solution_at, arrived)).min(1.0);
        if !self.estimate.heading_valid {
            let course = self.straight.update(velocity, self.tuning.min_forward_mps, dt);
            if let Some(course) = course {
                // If accelerations give no evidence, the craft is assumed to fly nose first.
                let nose_first = || wrap_pi(self.attitude.heading() - course);
                self.take_heading(self.course.heading_error().unwrap_or_else(nose_first));
                self.estimate.heading_valid = true;
            }
            return;
        }
        // A suspected magnetometer corrects nothing, so the heading already follows the course.
        let held = || self.compass.is_suspected().then_some(0.0);
        // Master compares its compass with nothing.
        if self.tuning.has_mag
            && !self.tuning.is_plain
            && self.since_mag_sample_s < MAG_VALID_S
            && let Some(error) = self.course.heading_error().or_else(held)
            && self.compass.update(wrap_pi(error - self.mag_error), dt) == Some(CompassVerdict::Doubted)
        {
            self.take_heading(error);
            return;
        }
        if turn != 0.0 && !self.has_mag() {
            self.turn_heading(turn);
        }
    }

    /// Corrects the heading at once. `error` is the angle of the estimated heading clockwise from the true one, rad.
    fn take_heading(&mut self, error: f64) {
        self.turn_heading(error);
        self.course.clear();
        self.horizontal.forget_accel_error();
    }

    fn fuse_baro(&mut self) {
        let Some(pressure) = self.pending_pressure.take() else { return };
        let altitude = pressure_altitude_m(pressure);
        if !altitude.is_finite() {
            return;
        }
        self.vertical.see_baro(altitude);
        if self.tuning.altitude_source != AltitudeSource::GpsOnly {
            self.vertical.fuse_baro(altitude, self.tuning.baro_preference);
        }
    }

    /// Returns `true` if the magnetometer corrects the heading.
    fn has_mag(&self) -> bool {
        self.tuning.has_mag && self.since_mag_s < MAG_VALID_S
    }

    fn fuse_mag(&mut self, dt: f64) {
        self.since_mag_s += dt;
        self.since_mag_sample_s += dt;
        let declination = match self.tuning.declination_deg {
            0.0 => self.options.declination_deg,
            set => set,
        };
        let sample = self.pending_mag.take().filter(|_| self.tuning.has_mag);
        if let Some(mag) = sample.map(|mag| self.tuning.field_flu(&mag))
            && let Some(error) = magnetic_error(&self.attitude.matrix, &mag, declination.to_radians())
        {
            self.since_mag_sample_s = 0.0;
            self.mag_error = error;
            if !self.estimate.heading_valid {
                self.take_heading(error);
                self.estimate.heading_valid = true;
            }
            if self.armed && !self.compass.may_correct() {
                return;
            }
            let trust = MagTrust::new(self.armed, self.tuning.trust_mag, self.tuning.is_plain);
            let correction = trust.correction(error, dt);
            if correction != 0.0 {
                self.since_mag_s = 0.0;
                self.turn_heading(correction);
            }
        }
    }

    /// Turns the attitude anticlockwise, so that the heading falls by `angle` (rad).
    fn turn_heading(&mut self, angle: f64) {
        if angle.is_finite() {
            self.attitude.turn_world(&Vector3::new(0.0, 0.0, angle));
            self.course.turn(angle);
        }
    }

    fn correct_tilt(&mut self, force: &Vector3<f64>, dt: f64) {
        let gain = pt1_gain(self.tuning.acc_lpf_hz, dt);
        let filtered = Vector3::new(
            self.force_filter[0].apply(force.x, gain),
            self.force_filter[1].apply(force.y, gain),
            self.force_filter[2].apply(force.z, gain),
        );
        let heading_valid = self.estimate.heading_valid;
        let is_plain = self.tuning.is_plain;
        let is_aided = !is_plain && self.armed && heading_valid && self.horizontal.is_settled();
        self.was_aided |= is_aided;
        let (missing, gains) = if is_aided {
            let missing = self.horizontal.accel_error();
            self.tilt.update(math::atan2(missing.norm(), GRAVITY), dt);
            let kp = self.tuning.kp * AIDED_FACTOR * urgency(missing.norm());
            let gains = VerticalGains { kp, ki: self.tuning.ki + AIDED_INTEGRAL * kp * kp };
            (Vector3::new(missing.y, missing.x, 0.0), gains)
        } else {
            let factor = match (self.armed, self.was_aided) {
                (false, _) => PARKED_FACTOR,
                (true, false) if heading_valid || is_plain => 1.0,
                (true, _) => ORPHANED_FACTOR,
            };
            let gains = VerticalGains { kp: self.tuning.kp * factor, ki: self.tuning.ki };
            let Some(missing) = missing_in_steady_motion(&filtered) else { return };
            (missing, gains)
        };
        let explained = self.attitude.correct_tilt(&filtered, &missing, &gains, dt);
        if !is_plain {
            self.horizontal.explain(Vector2::new(explained.y, explained.x));
        }
    }

    fn show(&mut self, dt: f64) {
        let (alt, climb) = (self.vertical.altitude(), self.vertical.climb());
        let tuning = &self.tuning;
        self.estimate.shown_alt_m = self.shown_alt.apply(alt, Pt2::gain(tuning.shown_alt_hz, dt));
        self.estimate.shown_climb_mps = self.shown_climb.apply(climb, Pt2::gain(tuning.shown_climb_hz, dt));
    }

    fn publish(&mut self) {
        let estimate = &mut self.estimate;
        estimate.origin = self.horizontal.origin();
        estimate.position_valid = self.horizontal.is_valid();
        estimate.pos_ne = self.horizontal.position();
        estimate.vel_ne = self.horizontal.velocity();
        estimate.altitude_valid = self.vertical.is_valid();
        estimate.alt_m = self.vertical.altitude();
        estimate.climb_mps = self.vertical.climb();
        estimate.baro_alt_m = self.vertical.baro_altitude();
        estimate.gps = self.gps.status;
        estimate.heading_doubt_rad = self.compass.doubt();
        estimate.tilt_doubt_rad = self.tilt.doubt();
        estimate.calibrating = !self.gyro.done || self.acc.is_some() || self.mag.is_some();
    }
}
