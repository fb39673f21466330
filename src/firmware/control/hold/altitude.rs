//! Altitude hold with the throttle stick, and the descent without it.

use super::HoldTuning;
use crate::autopilot::Params;
use crate::autopilot::control::{
    AltitudeController, AltitudeMeasurement, AltitudeTarget, FlightControllers, throttle_share,
};
use crate::autopilot::io::NavInputs;
use crate::autopilot::land_detector::{
    AT_REST_MPS, DescentFacts, GroundFacts, TouchdownFacts, TouchdownGuards,
};

/// The climb rate (m/s) above which the craft is stopped first when the hold begins.
const STEADY_MPS: f64 = 0.5;
/// The altitude that counts as airborne, m.
const AIRBORNE_M: f64 = 1.0;
/// The largest movement at which a stick counts as still, µs.
const STILL_STICK_US: f64 = 10.0;
/// The share of the demanded climb rate below which the craft counts as not climbing.
const STUCK_SHARE: f64 = 0.3;
/// The deceleration after the stick is released, m/s².
const STOP_MPS2: f64 = 1.25;
/// The speed, m/s, and the error, m, below which the craft has stopped.
const STOPPED_MPS: f64 = 0.2;
const STOPPED_M: f64 = 0.3;
/// The descent: the rate near the ground as a share of the climb rate, and its growth with height (1/m).
const DESCENT_SHARE: f64 = 0.2;
const DESCENT_GROWTH_PER_M: f64 = 0.05;
/// The altitude below which the failsafe descent is as slow as a landing, m.
const LAST_METRES_M: f64 = 1.5;
/// The setpoint of a descent is at most `DESCENT_LEASH_M` below the craft, m. Once the craft sinks at `SINKING_SHARE`
/// of its rate or faster, the remaining lag is reduced to `SINKING_LEASH_M` (m) at `GIVE_UP_MPS` (m/s).
const DESCENT_LEASH_M: f64 = 5.0;
const SINKING_SHARE: f64 = 0.6;
const SINKING_LEASH_M: f64 = 1.0;
const GIVE_UP_MPS: f64 = 3.0;
/// The limits for a craft on the ground: vertical speed as a share of the sink rate, and drift, m/s.
const GROUNDED_SHARE: f64 = 0.25;
const GROUNDED_DRIFT_MPS: f64 = 0.5;
/// The least time for which the signs of the ground must last, 0.1 s. A sluggish craft needs time to begin to sink.
const GROUNDED_DS: u8 = 10;
/// Below this altitude, m, a rescue sinks no faster than a landing. It slows down to that rate at `RESCUE_BRAKE_MPS2`,
/// m/s².
const RESCUE_LAST_METRES_M: f64 = 4.0;
const RESCUE_BRAKE_MPS2: f64 = 0.5;

/// The source of altitude changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum AltitudeOrder {
    /// The throttle stick, µs.
    Stick(f64),
    /// No change: the altitude is kept.
    Keep,
    /// A descent to the ground.
    Descend(DescentRate),
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Phase {
    #[default]
    Off,
    /// The stick moves the altitude.
    Moving,
    /// The stick was released, and the craft is led to a point at which it can stop. Setpoint, m, and its rate, m/s.
    Stopping(f64, f64),
    /// Holding this altitude, m.
    Holding(f64),
    /// Descending to the ground; the setpoint, m.
    Descending(f64),
}

#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct AltitudeHold {
    phase: Phase,
    /// `true` if the hold began on the ground, where the hover throttle cannot be learned, and the craft has not
    /// hovered since.
    began_low: bool,
    /// The last judged stick and the hover throttle used for it, µs.
    judged: Option<(f64, f64)>,
    has_touched_down: bool,
}

impl AltitudeHold {
    /// Releases the hold. The controller is engaged again at the next update.
    pub(super) fn release(&mut self) {
        *self = Self::default();
    }

    /// Returns `true` if the descent has ended on the ground.
    pub(super) fn has_touched_down(&self) -> bool {
        self.has_touched_down
    }

    /// Runs one update. Returns the throttle 0…1.
    pub(super) fn update(
        &mut self,
        order: AltitudeOrder,
        now: &NavInputs,
        params: &Params,
        tuning: &HoldTuning,
        controllers: &mut FlightControllers,
    ) -> f64 {
        let controller = &mut controllers.altitude;
        let measured = AltitudeMeasurement::from(now);
        if self.phase == Phase::Off {
            controller.engage(&measured, params);
            self.began_low = now.alt_m < AIRBORNE_M;
            let is_steady = now.climb_mps.abs() < STEADY_MPS;
            self.phase = if is_steady { Phase::Holding(now.alt_m) } else { stop(now) };
        }
        self.learn_after_lift_off(now, &measured, params, controller);
        let target = match order {
            AltitudeOrder::Stick(stick) => self.by_stick(stick, now, params, tuning, controller),
            AltitudeOrder::Keep => self.keep(now, 0.0),
            AltitudeOrder::Descend(rate) => self.descend(rate, now, params, controllers),
        };
        let FlightControllers { altitude: controller, land, .. } = controllers;
        if !matches!(order, AltitudeOrder::Descend(_)) {
            land.end_descent();
        }
        controller.set_relief_us(land.relief_us());
        let throttle_us = controller.update(&measured, target, params, now.dt);
        controllers.limit_tilt(now, params);
        throttle_share(throttle_us, params)
    }

    /// Engages the controller again once the craft has hovered and no longer climbs, because its hover throttle is
    /// known then.
    fn learn_after_lift_off(
        &mut self,
        now: &NavInputs,
        measured: &AltitudeMeasurement,
        params: &Params,
        controller: &mut AltitudeController,
    ) {
        if self.began_low && now.climb_mps.abs() < STEADY_MPS && controller.has_hovered() {
            self.began_low = false;
            controller.engage(measured, params);
        }
    }

    fn by_stick(
        &mut self,
        stick_us: f64,
        now: &NavInputs,
        params: &Params,
        tuning: &HoldTuning,
        controller: &AltitudeController,
    ) -> AltitudeTarget {
        // Only a moved stick is judged again. A newly learned hover throttle must not end a climb or let the craft
        // sink.
        let is_still = |(stick, _): &(f64, f64)| (stick_us - stick).abs() <= STILL_STICK_US;
        let judged = self.judged.filter(is_still);
        let (stick, hover_us) =
            judged.unwrap_or_else(|| (stick_us, controller.hover_stick_us(params, tuning.mid_us)));
        let share = climb_share(stick_us, hover_us, tuning);
        self.judged = Some((stick, hover_us));
        self.keep(now, share * params.climb_rate_mps())
    }

    /// Moves at `rate` (m/s). At 0, comes to rest and holds.
    fn keep(&mut self, now: &NavInputs, rate: f64) -> AltitudeTarget {
        self.has_touched_down = false;
        self.phase = match self.phase {
            _ if rate != 0.0 => Phase::Moving,
            Phase::Moving | Phase::Descending(_) => stop(now),
            Phase::Stopping(setpoint, rate) if has_stopped(setpoint, rate, now) => Phase::Holding(setpoint),
            Phase::Stopping(setpoint, rate) => {
                let step = STOP_MPS2 * now.dt;
                Phase::Stopping(setpoint + rate * now.dt, rate - rate.clamp(-step, step))
            }
            phase => phase,
        };
        match self.phase {
            Phase::Holding(altitude) => AltitudeTarget::Altitude(altitude),
            // Led like a landing. The integral works at full gain, because climbing needs its own hover throttle.
            Phase::Stopping(setpoint_m, rate_mps) => AltitudeTarget::Landing { setpoint_m, rate_mps },
            // A craft that does not rise is heavier than its hover throttle suggests, or is on the ground. The integral
            // must work.
            _ if rate > 0.0 && now.climb_mps < STUCK_SHARE * rate => {
                AltitudeTarget::Landing { setpoint_m: now.alt_m + rate, rate_mps: rate }
            }
            _ => AltitudeTarget::Rate(rate),
        }
    }

    fn descend(
        &mut self,
        rate: DescentRate,
        now: &NavInputs,
        params: &Params,
        controllers: &mut FlightControllers,
    ) -> AltitudeTarget {
        let rate = rate.at(now.alt_m, params);
        let FlightControllers { altitude: controller, land, .. } = controllers;
        let before = match self.phase {
            Phase::Descending(setpoint) => setpoint,
            _ => {
                land.begin_descent(now.alt_m, now.climb_mps);
                now.alt_m
            }
        };
        let rate = if land.is_too_fast(now) { 0.0 } else { rate };
        let setpoint = descending_setpoint_m(before, rate, now);
        self.phase = Phase::Descending(setpoint);
        land.follow_altitude(now.alt_m);
        let demand = (controller.setpoint_m(), controller.throttle_us());
        let descent = DescentFacts::new(now, params, demand, rate);
        land.descend(&descent, now.time, now.dt);
        let ground = GroundFacts::new(now, params, controller, land);
        // A craft that has not left the ground has no descent to make.
        let descent_m = if land.awaits_lift_off() { f64::INFINITY } else { ground.descent_m };
        let ground = GroundFacts { descent_m, ..ground };
        // Uses the learned hover throttle. The configured one may be far off, and waiting for it would tip the craft
        // over.
        let facts = TouchdownFacts {
            // The ground may be higher or lower than home, so the altitude does not count.
            landing_altitude_m: f64::INFINITY,
            // Without a fix the speed is unknown and does not count.
            max_speed_mps: if now.fix { GROUNDED_DRIFT_MPS } else { f64::INFINITY },
            ground_speed_mps: if now.fix { now.vel_ne.norm() } else { 0.0 },
            // The craft must neither sink nor climb. A craft stopped in a climb has little throttle too, and has not
            // landed.
            climb_mps: -now.climb_mps.abs(),
            min_climb_mps: -(GROUNDED_SHARE * rate.min(params.descent_rate_mps())).min(AT_REST_MPS),
            ..TouchdownFacts::new(
                params,
                controller.hover_us(),
                now.alt_m,
                0.0,
                now.throttle_us,
                now.climb_mps,
            )
        };
        // The proof: at the lowest throttle every craft sinks, unless something carries it. Throttle below the hover
        // throttle is no proof, because that may have been learned in a climb.
        let is_down = descent.throttle_at_min && TouchdownGuards::new(&facts, &ground).all_hold();
        land.time_touchdown(is_down, now.time);
        self.has_touched_down = land.has_landed(params.landing_detection_time.max(GROUNDED_DS));
        AltitudeTarget::Landing { setpoint_m: setpoint, rate_mps: -rate }
    }
}

/// Returns the next setpoint of a descent at `rate` (m/s), from the one before.
fn descending_setpoint_m(before_m: f64, rate: f64, now: &NavInputs) -> f64 {
    let setpoint_m = (before_m - rate * now.dt).max(now.alt_m - DESCENT_LEASH_M.max(rate));
    let sinks = rate > 0.0 && -now.climb_mps > SINKING_SHARE * rate;
    // To make up for the lag, the craft would have to sink faster than it should.
    let lag_m = now.alt_m - SINKING_LEASH_M.max(rate) - setpoint_m;
    if sinks { setpoint_m + lag_m.clamp(0.0, GIVE_UP_MPS * now.dt) } else { setpoint_m }
}

/// Returns the phase that begins to stop here.
fn stop(now: &NavInputs) -> Phase {
    Phase::Stopping(now.alt_m, now.climb_mps)
}

/// Returns `true` if a craft led to `setpoint` (m) at `rate` (m/s) has come to rest there.
fn has_stopped(setpoint: f64, rate: f64, now: &NavInputs) -> bool {
    rate == 0.0 && now.climb_mps.abs() < STOPPED_MPS && (now.alt_m - setpoint).abs() < STOPPED_M
}

/// The sink rate of a descent to the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DescentRate {
    /// The failsafe rate: a fifth of the climb rate near the ground, faster from high up, and a landing in the last
    /// metres.
    Failsafe,
    /// `ap_landing_descent_rate`, for a landing whose fix was lost.
    Landing,
    /// `gps_rescue_descend_rate` (m/s), for a rescue whose fix was lost. In the last metres no faster than a landing.
    Rescue(f64),
}

impl DescentRate {
    /// Returns the sink rate at an altitude, m/s.
    pub fn at(self, altitude_m: f64, params: &Params) -> f64 {
        match self {
            // The craft searches for the ground at the rate of a landing.
            Self::Failsafe if altitude_m < LAST_METRES_M => params.descent_rate_mps(),
            Self::Failsafe => {
                let factor = 0.9 + (altitude_m * DESCENT_GROWTH_PER_M).clamp(0.1, 9.0);
                factor * params.climb_rate_mps() * DESCENT_SHARE
            }
            Self::Landing => params.descent_rate_mps(),
            Self::Rescue(rate) => {
                let slow = params.descent_rate_mps();
                let above_m = (altitude_m - RESCUE_LAST_METRES_M).max(0.0);
                rate.min((slow * slow + 2.0 * RESCUE_BRAKE_MPS2 * above_m).sqrt())
            }
        }
    }
}

/// Returns the share of the climb rate that the throttle stick demands, −1…1; zero about the hover throttle.
pub(super) fn climb_share(stick_us: f64, hover_us: f64, tuning: &HoldTuning) -> f64 {
    if stick_us < tuning.low_us {
        return 0.0;
    }
    let low = sink_edge_us(hover_us, tuning);
    let high = hover_us + tuning.throttle_deadband * (2000.0 - hover_us).max(0.0);
    if stick_us > high {
        ((stick_us - high) / (2000.0 - high).max(1.0)).min(1.0)
    } else if stick_us < low {
        -((low - stick_us) / (low - tuning.low_us).max(1.0)).min(1.0)
    } else {
        0.0
    }
}

/// Returns the throttle stick below which the craft sinks, µs.
fn sink_edge_us(hover_us: f64, tuning: &HoldTuning) -> f64 {
    hover_us - tuning.throttle_deadband * (hover_us - tuning.low_us).max(0.0)
}

/// Returns the throttle stick (µs) that makes a craft with this hover throttle sink at a rate (m/s), or as fast as it
/// can; `None` if it cannot.
pub(super) fn sink_stick_us(
    rate_mps: f64,
    hover_us: f64,
    params: &Params,
    tuning: &HoldTuning,
) -> Option<f64> {
    let edge_us = sink_edge_us(hover_us, tuning);
    let share = (rate_mps / params.climb_rate_mps()).min(1.0);
    (edge_us > tuning.low_us).then_some(edge_us - share * (edge_us - tuning.low_us))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stick_holds_about_the_hover_throttle_and_when_low() {
        let tuning = HoldTuning { throttle_deadband: 0.2, ..HoldTuning::default() };
        for stick in [1000.0, 1049.0, 1240.0, 1275.0, 1420.0] {
            assert_eq!(climb_share(stick, 1275.0, &tuning), 0.0, "{stick}");
        }
        assert!((climb_share(1600.0, 1275.0, &tuning) - 180.0 / 580.0).abs() < 1e-9);
        assert!((climb_share(2000.0, 1275.0, &tuning) - 1.0).abs() < 1e-9);
        assert!((climb_share(1050.0, 1275.0, &tuning) + 1.0).abs() < 1e-9);
        assert!((climb_share(1800.0, 1500.0, &tuning) - 0.5).abs() < 1e-9);
    }

    #[test]
    fn the_sinking_stick_sinks_at_the_rate_asked_for() {
        let tuning = HoldTuning::default();
        let params = Params::default();
        for hover_us in [1275.0, 1500.0] {
            let stick = tuning.sink_stick_us(1.0, hover_us, &params).unwrap();
            let rate = climb_share(stick, hover_us, &tuning) * params.climb_rate_mps();
            assert!((rate + 1.0).abs() < 1e-9, "{hover_us}: {stick} {rate}");
        }
        assert_eq!(sink_stick_us(1.0, 1050.0, &params, &tuning), None);
    }

    /// Returns the time (s) until a drifting craft that neither sinks nor carries its weight counts as landed. It is
    /// 10 s at most.
    fn seconds_to_touchdown(drift_mps: f64, fix: bool) -> f64 {
        let (params, tuning) = (Params::default(), HoldTuning::default());
        let mut now = NavInputs {
            time: crate::signals::SimTime::ZERO,
            failsafe: true,
            fix,
            alt_m: 0.0,
            vel_ne: nalgebra::Vector2::new(0.6 * drift_mps, -0.8 * drift_mps),
            throttle_us: 1000.0,
            ..NavInputs::hovering()
        };
        let (mut hold, mut controllers) = (AltitudeHold::default(), FlightControllers::default());
        let mut updates = 0;
        while !hold.has_touched_down() && updates < 1000 {
            hold.update(
                AltitudeOrder::Descend(DescentRate::Failsafe),
                &now,
                &params,
                &tuning,
                &mut controllers,
            );
            updates += 1;
            now.time.0 += 10_000;
        }
        f64::from(updates) * now.dt
    }

    #[test]
    fn a_craft_that_drifts_over_the_ground_has_not_landed() {
        assert!(seconds_to_touchdown(0.0, true) < 5.0);
        assert!(seconds_to_touchdown(0.49, true) < 5.0);
        for drift_mps in [0.51, 2.0] {
            assert!(seconds_to_touchdown(drift_mps, true) >= 10.0, "{drift_mps} m/s");
        }
        // Without a fix the drift is unknown.
        assert!(seconds_to_touchdown(2.0, false) < 5.0);
    }

    #[test]
    fn a_rescue_sinks_at_its_own_rate_and_lands_at_that_of_a_landing() {
        let params = Params::default();
        for (rescue, altitude, rate) in [
            (0.8, 30.0, 0.8),
            (0.8, 4.0, 0.5),
            (0.8, 0.0, 0.5),
            (0.3, 30.0, 0.3),
            (0.3, 0.0, 0.3),
            (5.0, 40.0, 5.0),
        ] {
            let got = DescentRate::Rescue(rescue).at(altitude, &params);
            assert!((got - rate).abs() < 1e-9, "{rescue} m/s at {altitude} m: {got}");
        }
    }

    #[test]
    fn the_descent_slows_down_towards_the_ground() {
        let params = Params::default();
        for (altitude, rate) in [(0.0, 0.5), (2.0, 1.0), (20.0, 1.9), (180.0, 9.9), (500.0, 9.9)] {
            assert!((DescentRate::Failsafe.at(altitude, &params) - rate).abs() < 1e-9, "{altitude}");
        }
    }

    #[test]
    fn a_rescue_without_a_fix_brakes_from_its_rate_to_that_of_a_landing() {
        let params = Params::default();
        let slow = params.descent_rate_mps();
        let rate = |altitude_m| DescentRate::Rescue(5.0).at(altitude_m, &params);
        assert_eq!(rate(1000.0), 5.0);
        assert!((rate(RESCUE_LAST_METRES_M) - slow).abs() < 1e-9);
        assert!((rate(0.0) - slow).abs() < 1e-9);
        // v² = v₀² + 2·a·s.
        let expected = (slow * slow + 2.0 * RESCUE_BRAKE_MPS2 * 3.0).sqrt();
        assert!((rate(RESCUE_LAST_METRES_M + 3.0) - expected).abs() < 1e-9);
    }

    #[test]
    fn a_craft_has_stopped_only_at_its_setpoint_and_without_climb() {
        let at = |alt_m, climb_mps| NavInputs { alt_m, climb_mps, ..NavInputs::hovering() };
        for (rate, alt_m, climb_mps, expected) in [
            (0.0, 20.0, 0.0, true),
            (0.0, 20.2, -0.1, true),
            (0.0, 19.0, 0.0, false),
            (0.0, 20.5, 0.0, false),
            (0.0, 20.0, 0.5, false),
            (1.0, 20.0, 0.0, false),
        ] {
            assert_eq!(
                has_stopped(20.0, rate, &at(alt_m, climb_mps)),
                expected,
                "{rate} {alt_m} {climb_mps}"
            );
        }
    }

    #[test]
    fn a_hold_that_begins_in_a_climb_comes_to_rest_above_and_one_in_a_hover_stays_there() {
        for (climb_mps, rises) in [(0.0, false), (3.0, true)] {
            let (params, tuning) = (Params::default(), HoldTuning::default());
            let now = NavInputs { alt_m: 20.0, climb_mps, ..NavInputs::hovering() };
            let (mut hold, mut controllers) = (AltitudeHold::default(), FlightControllers::default());
            for _ in 0..1000 {
                hold.update(AltitudeOrder::Keep, &now, &params, &tuning, &mut controllers);
            }
            let setpoint_m = controllers.altitude.setpoint_m();
            assert_eq!(setpoint_m > 20.5, rises, "{climb_mps} m/s: {setpoint_m} m");
            assert!(rises || (setpoint_m - 20.0).abs() < 1e-9, "{setpoint_m} m");
        }
    }
}
