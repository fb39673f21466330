//! Arming, and everything that stops the motors by itself.

use crate::firmware::arming::crash::{CrashAction, CrashDetector, CrashFacts};
use crate::firmware::arming::runaway::{Runaway, RunawayFacts};
use crate::firmware::arming::{Arming, ArmingChange, ArmingFacts};
use crate::firmware::control::ControlState;
use crate::firmware::estimate::Estimate;
use crate::firmware::parameters::Parameters;
use crate::geo::LatLon;
use crate::math;
use crate::signals::{GpsSample, RcSource, SimTime};
use crate::telemetry::DisarmReason;

use super::RcInput;

/// Arming with its watchdogs, and the values recorded at arming.
#[derive(Debug, Clone, Default)]
pub(in crate::firmware) struct Safety {
    pub arming: Arming,
    runaway: Runaway,
    pub crash: CrashDetector,
    pub last_disarm: Option<DisarmReason>,
    pub home: Option<LatLon>,
    /// The altitude of home above mean sea level, cm.
    pub home_alt_amsl_cm: Option<i32>,
    pub headfree_rad: f64,
}

impl Safety {
    /// Runs one update of arming, with the newest state of the receiver. `uptime` counts from boot. `failsafe_landed`
    /// is `true` if a failsafe ended the last flight and the link has not recovered yet.
    pub(in crate::firmware) fn update(
        &mut self,
        parameters: &Parameters,
        uptime: SimTime,
        (rc, new_frame): (&RcInput, bool),
        estimate: &Estimate,
        failsafe_landed: bool,
    ) -> Option<ArmingChange> {
        let receiver = &rc.receiver;
        let facts = ArmingFacts {
            now: uptime,
            new_frame,
            boxes: rc.boxes,
            sticks: *receiver.sticks(),
            signal: receiver.signal(),
            link_good: rc.link.good(),
            from_udp: receiver.sources().in_charge() == Some(RcSource::Udp),
            failsafe_landed,
            tilt_rad: estimate.attitude_valid.then(|| tilt_rad(estimate)),
            calibrating: estimate.calibrating,
            fix_sats: estimate.gps.fix.then_some(estimate.gps.sats),
        };
        let change = self.arming.update(&parameters.arming, &facts);
        match change {
            Some(ArmingChange::Armed { .. }) => {
                if !(parameters.rescue.home_once && self.home.is_some()) {
                    let solution = trusted_solution(parameters, estimate);
                    self.home = solution.map(|solution| solution.position);
                    self.home_alt_amsl_cm = solution.map(|solution| solution.alt_amsl_cm);
                }
                self.headfree_rad = estimate.heading_rad;
                self.runaway.rearm();
            }
            Some(ArmingChange::Disarmed(reason)) => self.last_disarm = Some(reason),
            Some(ArmingChange::CalibrateGyro) | None => {}
        }
        change
    }

    /// Stops the motors for the given reason. Returns `false` if they were already stopped.
    pub(in crate::firmware) fn disarm(&mut self, reason: DisarmReason) -> bool {
        let was_armed = self.arming.disarm(reason);
        if was_armed {
            self.last_disarm = Some(reason);
        }
        was_armed
    }

    /// Returns the state after a restart, which ends a flight.
    pub(in crate::firmware) fn restarted(&self) -> Self {
        let last_disarm = self.arming.armed().then_some(DisarmReason::System);
        Self { last_disarm, ..Self::default() }
    }

    /// Returns `true` if the craft turns against its controller at take-off, as with swapped motors.
    pub(in crate::firmware) fn is_runaway(
        &mut self,
        parameters: &Parameters,
        now: SimTime,
        rc: &RcInput,
        state: &ControlState,
    ) -> bool {
        let facts = RunawayFacts {
            now,
            pid_sum: state.pid_sum.into(),
            rate_dps: state.gyro_dps.into(),
            throttle_percent: rc.throttle_percent(),
            stick_percent: rc.receiver.sticks().deflection_percent(),
        };
        self.arming.armed() && self.runaway.update(&parameters.runaway, &facts)
    }

    /// Returns the action for a crash noticed in this step, if the settings require one.
    pub(in crate::firmware) fn crash(
        &mut self,
        parameters: &Parameters,
        now: SimTime,
        state: &ControlState,
        estimate: &Estimate,
    ) -> Option<CrashAction> {
        let config = &parameters.crash;
        if config.action == CrashAction::Off || !self.arming.armed() || !self.arming.raised() {
            // This includes a detection switched off while it levels: the pilot gets the sticks back.
            self.crash.reset();
            return None;
        }
        let motors = &state.motors_us;
        let spread = motors.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - motors.iter().copied().fold(f64::INFINITY, f64::min);
        let mixer = &parameters.control.mixer;
        let facts = CrashFacts {
            now,
            gyro_dps: state.gyro_dps,
            setpoint_dps: state.setpoint_dps,
            motor_spread: spread / (mixer.max_us - mixer.idle_us).max(1.0),
            tilt_rad: tilt_rad(estimate),
        };
        self.crash.update(config, &facts).then_some(config.action)
    }
}

/// Returns the position of the craft, if there are enough satellites to fly home by it.
pub(in crate::firmware) fn trusted_position(parameters: &Parameters, estimate: &Estimate) -> Option<LatLon> {
    trusted_solution(parameters, estimate).map(|solution| solution.position)
}

fn trusted_solution(parameters: &Parameters, estimate: &Estimate) -> Option<GpsSample> {
    let gps = &estimate.gps;
    let trusted = gps.fix && gps.sats >= parameters.rescue.min_sats;
    gps.solution.filter(|_| trusted)
}

fn tilt_rad(estimate: &Estimate) -> f64 {
    math::acos(estimate.cos_tilt.clamp(-1.0, 1.0))
}
