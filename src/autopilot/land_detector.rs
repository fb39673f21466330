//! The land detector: distinguishes ground and air, whatever flies the craft.
//!
//! - `GroundContact`: the legs carry weight, according to the force that the accelerometer measures beyond the
//!   thrust. Tilts and attitude integrals then work against the ground.
//! - `ThrottleRelief`: probes for the ground in a descent. A craft that does not sink although it should gets less
//!   and less throttle: on the ground until its weight is on the legs, in the air until it sinks again.
//! - [`TouchdownGuards`] and [`TouchdownTimer`]: the conditions of a touchdown and the time that they have held.
//! - `StationaryTimer`: a second way to a touchdown, for a craft on the ground for which one of those conditions
//!   cannot become true.
//! - `Impact`: the bump of the ground, if `landing_disarm_threshold` enables it.

mod contact;
mod impact;
mod relief;
mod stationary;
mod touchdown;

use nalgebra::Vector3;

use super::io::NavInputs;
use crate::signals::{MotorCommand, SimTime};
use contact::GroundContact;
use impact::Impact;
use relief::ThrottleRelief;
use stationary::StationaryTimer;

pub use impact::ImpactFacts;
pub use relief::DescentFacts;
pub use stationary::STATIONARY_S;
pub use touchdown::{AT_REST_MPS, GroundFacts, TouchdownFacts, TouchdownGuards, TouchdownTimer};

/// Below this altitude, m, a descent waits while the ground speed is above this, m/s, but no longer than this time,
/// s.
const LAST_METRES_M: f64 = 5.0;
const TOUCHDOWN_MPS: f64 = 2.0;
const FAST_PATIENCE_S: f64 = 30.0;

/// The measurements of the craft for the detector, a hundred times a second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundMeasurement {
    /// Specific force, body forward-left-up, m/s².
    pub force_flu: Vector3<f64>,
    /// Magnitude of the turn rate, rad/s.
    pub rate_rps: f64,
    /// Mean square of the current motor commands (0…1).
    pub motor_square: f64,
    /// Altitude above home, m; `None` if it is not known.
    pub altitude_m: Option<f64>,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Ground speed, m/s; `None` if it is not known.
    pub ground_speed_mps: Option<f64>,
}

impl GroundMeasurement {
    /// Returns the measurement of a craft in the state `now`.
    pub fn new(now: &NavInputs, force_flu: Vector3<f64>, rate_rps: f64, motors: &MotorCommand) -> Self {
        Self {
            force_flu,
            rate_rps,
            motor_square: motors.mean_square(),
            altitude_m: now.altitude_valid.then_some(now.alt_m),
            climb_mps: now.climb_mps,
            ground_speed_mps: now.fix.then(|| now.vel_ne.norm()),
        }
    }

    fn is_finite(&self) -> bool {
        let scalars = self.rate_rps + self.motor_square + self.climb_mps;
        let known = self.ground_speed_mps.unwrap_or(0.0) + self.altitude_m.unwrap_or(0.0);
        (self.force_flu.sum() + scalars + known).is_finite()
    }
}

/// The land detector of a craft; see the module's description.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LandDetector {
    contact: GroundContact,
    impact: Impact,
    relief: ThrottleRelief,
    /// Highest altitude of the current descent, m.
    highest_m: Option<f64>,
    /// Time at which the craft was first too fast over ground for the last metres.
    fast_since: Option<SimTime>,
    timer: TouchdownTimer,
    held_us: Option<u64>,
    stationary: StationaryTimer,
}

impl LandDetector {
    /// Takes one cycle of an armed or disarmed craft, `dt` seconds after the last. Ignores a measurement that is not
    /// finite, since it would stay in the averages.
    pub fn observe(&mut self, now: &GroundMeasurement, armed: bool, dt: f64) {
        if now.is_finite() {
            self.impact.observe(now.force_flu, dt);
        }
        if !armed {
            self.contact.rest();
        } else if now.is_finite() {
            self.contact.update(now, dt);
            self.stationary.observe(now, dt);
        }
    }

    /// Returns `true` if the legs carry weight: before the lift-off and after a touchdown.
    pub fn on_ground(&self) -> bool {
        self.contact.on_ground()
    }

    /// Returns `true` if the craft has not left the ground since arming.
    pub fn awaits_lift_off(&self) -> bool {
        !self.contact.has_lifted_off()
    }

    /// Returns the specific force along the thrust, averaged over 50 ms, in multiples of gravity.
    pub fn load(&self) -> f64 {
        self.contact.load()
    }

    /// Begins a descent to the ground at this altitude, m, and climb rate, m/s.
    pub fn begin_descent(&mut self, altitude_m: f64, climb_mps: f64) {
        self.end_descent();
        self.highest_m = Some(altitude_m);
        self.relief.begin(climb_mps);
    }

    /// Reports a cycle without a descent to the ground.
    pub fn end_descent(&mut self) {
        if self.highest_m.take().is_some() {
            self.relief = ThrottleRelief::default();
            self.fast_since = None;
            self.timer = TouchdownTimer::default();
            self.held_us = None;
            self.stationary.restart();
        }
    }

    /// Returns `true` if a descent should wait in its last metres, since a craft that still flies fast over ground
    /// must not sink into it on the way. It waits only once and for a limited time, so that a craft that the wind
    /// carries off still comes down.
    pub fn is_too_fast(&mut self, now: &NavInputs) -> bool {
        let is_low = (1.0..LAST_METRES_M).contains(&now.alt_m);
        if !now.fix || !is_low || now.vel_ne.norm() <= TOUCHDOWN_MPS {
            return false;
        }
        let since = *self.fast_since.get_or_insert(now.time);
        now.time.seconds_since(since) < FAST_PATIENCE_S
    }

    /// Takes one cycle of the descent, `dt` seconds after the last.
    pub fn descend(&mut self, facts: &DescentFacts, time: SimTime, dt: f64) {
        self.relief.update(facts, dt);
        let lowers_throttle = facts.sink_mps > 0.0 && (self.relief.is_rising() || facts.throttle_at_min);
        self.stationary.update(lowers_throttle, facts.max_speed_mps, time);
    }

    /// Takes the altitude of this cycle, m.
    pub fn follow_altitude(&mut self, altitude_m: f64) {
        self.highest_m = self.highest_m.map(|highest| highest.max(altitude_m));
    }

    /// Returns the height that the craft has lost since the highest point of the descent, m.
    pub fn descended_m(&self, altitude_m: f64) -> f64 {
        self.highest_m.map_or(0.0, |highest| highest - altitude_m)
    }

    /// Runs the timer during a descent. `all_hold` is `true` if all conditions hold in this cycle. Returns the time
    /// that they have held, µs.
    pub fn time_touchdown(&mut self, all_hold: bool, time: SimTime) -> Option<u64> {
        if self.highest_m.is_some() {
            self.held_us = self.timer.update(time, all_hold);
        }
        self.held_us
    }

    /// Returns the time that the conditions of the touchdown have held, µs.
    pub fn held_us(&self) -> Option<u64> {
        self.held_us
    }

    /// Returns `true` if a descent has ended on the ground: the conditions have held for `detection_time_ds` (0.1 s),
    /// or nothing has moved for [`STATIONARY_S`].
    pub fn has_landed(&self, detection_time_ds: u8) -> bool {
        let needed_us = u64::from(detection_time_ds) * 100_000;
        self.held_us.is_some_and(|held| held >= needed_us) || self.stationary_s() >= STATIONARY_S
    }

    /// Returns the time that the craft has not moved although it is commanded to descend, s.
    pub fn stationary_s(&self) -> f64 {
        self.stationary.held_s()
    }

    /// Returns the climb rate in the descent without the jolts of the legs, m/s.
    pub fn climb_mps(&self) -> f64 {
        self.relief.climb_mps()
    }

    /// Returns the throttle to subtract, µs.
    pub fn relief_us(&self) -> f64 {
        self.relief.relief_us()
    }

    /// Returns the share of the tilt demand that is flown. A craft on the ground is not tilted on its legs.
    pub fn tilt_share(&self) -> f64 {
        if self.on_ground() { 0.0 } else { self.relief.tilt_share() }
    }

    /// Returns `true` if attitude integrals would accumulate the forces of the ground: the legs carry weight, or a
    /// descent has ended on them.
    pub fn stands(&self) -> bool {
        self.on_ground() || self.relief.stands()
    }

    /// Returns `true` if a bump above `threshold` (setting units, 0 = never) ended the flight. Only a push that the
    /// motors cannot make counts, since a step of the throttle in the air also jolts a light craft.
    pub fn is_impact(&self, threshold: f64, facts: &ImpactFacts) -> bool {
        self.contact.is_pushed() && self.impact.is_touchdown(threshold, facts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::GRAVITY;

    #[test]
    fn a_single_broken_measurement_does_not_blind_the_land_detector() {
        let sound = GroundMeasurement::new(
            &NavInputs::hovering(),
            Vector3::new(0.0, 0.0, GRAVITY),
            0.0,
            &MotorCommand([0.5; 4]),
        );
        let broken = [
            GroundMeasurement { force_flu: Vector3::new(f64::NAN, 0.0, 0.0), ..sound },
            GroundMeasurement { force_flu: Vector3::new(0.0, 0.0, f64::INFINITY), ..sound },
            GroundMeasurement { motor_square: f64::NAN, ..sound },
            GroundMeasurement { climb_mps: f64::NAN, ..sound },
        ];
        let mut land = LandDetector::default();
        land.observe(&sound, true, 0.01);
        for now in broken {
            land.observe(&now, true, 0.01);
        }
        for _ in 0..100 {
            land.observe(&sound, true, 0.01);
        }
        assert!((land.load() - 1.0).abs() < 0.01, "{}", land.load());
        land.observe(
            &GroundMeasurement { force_flu: Vector3::new(0.0, 0.0, 4.0 * GRAVITY), ..sound },
            true,
            0.01,
        );
        let landing = ImpactFacts {
            raised: true,
            stick_percent: 0.0,
            throttle_percent: 0.0,
            alt_hold: false,
            near_ground: true,
        };
        assert!(land.is_impact(10.0, &landing));
    }

    #[test]
    fn a_descent_counts_from_its_highest_point() {
        let mut land = LandDetector::default();
        assert_eq!(land.descended_m(3.0), 0.0, "no descent has begun");
        land.begin_descent(20.0, 0.0);
        land.follow_altitude(22.0);
        land.follow_altitude(15.0);
        assert_eq!(land.descended_m(15.0), 7.0);
        land.end_descent();
        assert_eq!(land.descended_m(15.0), 0.0);
    }

    #[test]
    fn a_craft_has_landed_once_the_conditions_have_held_for_the_whole_time() {
        let mut land = LandDetector::default();
        land.begin_descent(1.0, 0.0);
        land.time_touchdown(true, SimTime::from_secs_f64(10.0));
        land.time_touchdown(true, SimTime::from_secs_f64(10.9));
        assert!(!land.has_landed(10));
        land.time_touchdown(true, SimTime::from_secs_f64(11.1));
        assert!(land.has_landed(10));
        land.time_touchdown(false, SimTime::from_secs_f64(11.2));
        assert!(!land.has_landed(10));
    }
}
