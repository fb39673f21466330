//! The receiver pass: link, switches, arming; and everything that stops the motors besides.

use crate::signals::{RcSource, SimTime};

use super::Firmware;
use super::arming::crash::{CrashAction, CrashFacts};
use super::arming::impact::ImpactFacts;
use super::arming::runaway::RunawayFacts;
use super::arming::{ArmingChange, ArmingFacts};
use super::failsafe::SwitchMode;
use super::failsafe::link::LinkChange;
use super::flight::Demand;
use super::modes::{self, BoxSet, boxes};
use crate::telemetry::{DisarmReason, FirmwareEvent, Mode};

impl Firmware {
    /// Time since this firmware booted.
    pub(super) fn uptime(&self) -> SimTime {
        SimTime(self.now.0.saturating_sub(self.booted_at.0))
    }

    /// Receiver, link, switches, arming.
    pub(super) fn receiver_pass(&mut self) {
        let parameters = &self.parameters;
        let failsafe_switch = self.boxes.has(boxes::FAILSAFE);
        let switched_off = failsafe_switch && parameters.failsafe.switch_mode == SwitchMode::Stage1;
        let new_frame = self.rx.update(&parameters.rx, self.now, switched_off, self.failsafe.active());
        let at_once = self.failsafe.by_switch() && !failsafe_switch;
        match self.link.update(&parameters.link, self.now, self.rx.signal(), self.rx.last_frame(), at_once) {
            Some(LinkChange::Lost) => {
                self.link_lost = true;
                self.outbox.push(FirmwareEvent::RxLoss);
            }
            Some(LinkChange::Recovered) if std::mem::take(&mut self.link_lost) => {
                self.outbox.push(FirmwareEvent::RxRecovered);
            }
            Some(LinkChange::Recovered) | None => {}
        }
        self.boxes = match self.rx.has_heard() {
            true => modes::evaluate(&self.parameters.modes, self.rx.aux(&self.parameters.rx)),
            false => BoxSet::NONE,
        };
        if self.boxes.has(boxes::HEADADJ) {
            self.headfree_rad = self.estimator.estimate().heading_rad;
        }
        self.rc_frame |= new_frame;
        self.arming_pass(new_frame);
    }

    fn arming_pass(&mut self, new_frame: bool) {
        let estimate = self.estimator.estimate();
        let facts = ArmingFacts {
            now: self.uptime(),
            new_frame,
            boxes: self.boxes,
            sticks: *self.rx.sticks(),
            signal: self.rx.signal(),
            link_good: self.link.good(),
            from_udp: self.rx.sources().in_charge() == Some(RcSource::Udp),
            failsafe_landed: self.failsafe.landed(),
            tilt_rad: estimate.attitude_valid.then(|| estimate.cos_tilt.clamp(-1.0, 1.0).acos()),
            calibrating: estimate.calibrating,
            fix_sats: estimate.gps.fix.then_some(estimate.gps.sats),
        };
        match self.arming.update(&self.parameters.arming, &facts) {
            Some(ArmingChange::Armed { assisted }) => self.on_arm(assisted),
            Some(ArmingChange::CalibrateGyro) => {
                self.estimator.calibrate_gyro();
                self.outbox.push(FirmwareEvent::Notice("Calibrating the gyro before the first arming."));
            }
            Some(ArmingChange::Disarmed(reason)) => self.on_disarm(reason),
            None => {}
        }
    }

    fn on_arm(&mut self, assisted: bool) {
        let estimate = self.estimator.estimate();
        let trusted = estimate.gps.fix && estimate.gps.sats >= self.parameters.rescue.min_sats;
        let position = estimate.gps.solution.filter(|_| trusted).map(|solution| solution.position);
        if !(self.parameters.rescue.home_once && self.home.is_some()) {
            self.home = position;
        }
        self.headfree_rad = estimate.heading_rad;
        self.estimator.on_arm(position);
        self.runaway.rearm();
        self.holds.reset();
        self.outbox.push(FirmwareEvent::Armed);
        if assisted {
            self.outbox.push(FirmwareEvent::Notice(
                "Arm assist: armed although the ARM switch was on early or the throttle was not quite low.",
            ));
        }
    }

    /// Stops the motors for a reason, if they were not stopped already.
    pub(super) fn disarm(&mut self, reason: DisarmReason) {
        if self.arming.disarm(reason) {
            self.on_disarm(reason);
        }
    }

    fn on_disarm(&mut self, reason: DisarmReason) {
        self.estimator.on_disarm();
        self.flight.set_demand(Demand::default());
        self.holds.reset();
        self.note_disarm(reason);
    }

    pub(super) fn note_disarm(&mut self, reason: DisarmReason) {
        self.last_disarm = Some(reason);
        self.outbox.push(FirmwareEvent::Disarmed(reason));
    }

    pub(super) fn runaway_pass(&mut self) {
        if !self.arming.armed() {
            return;
        }
        let state = self.flight.state();
        let sticks = self.rx.sticks();
        let facts = RunawayFacts {
            now: self.now,
            pid_sum: state.pid_sum.into(),
            rate_dps: state.gyro_dps.into(),
            throttle_percent: (sticks.throttle_us - 1000.0) / 10.0,
            stick_percent: sticks.deflection_percent(),
        };
        if self.runaway.update(&self.parameters.runaway, &facts) {
            self.disarm(DisarmReason::RunawayTakeoff);
        }
    }

    /// Watches for a crash, where the settings ask for it.
    pub(super) fn crash_pass(&mut self) {
        let config = &self.parameters.crash;
        if config.action == CrashAction::Off || !self.arming.armed() || !self.arming.raised() {
            // Also when it is switched off while it levels: the sticks are the pilot's again.
            self.crash.reset();
            return;
        }
        let state = self.flight.state();
        let motors = &state.motors_us;
        let spread = motors.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - motors.iter().copied().fold(f64::INFINITY, f64::min);
        let mixer = &self.parameters.control.mixer;
        let facts = CrashFacts {
            now: self.now,
            gyro_dps: state.gyro_dps,
            setpoint_dps: state.setpoint_dps,
            motor_spread: spread / (mixer.max_us - mixer.idle_us).max(1.0),
            tilt_rad: self.estimator.estimate().cos_tilt.clamp(-1.0, 1.0).acos(),
        };
        if !self.crash.update(config, &facts) {
            return;
        }
        if config.action == CrashAction::Disarm {
            self.disarm(DisarmReason::CrashProtection);
        } else {
            self.outbox
                .push(FirmwareEvent::Notice("Crash detected: the craft is levelled, the sticks rest."));
        }
    }

    /// Touchdown by the bump of the ground.
    pub(super) fn landing_pass(&mut self, dt: f64) {
        let estimate = self.estimator.estimate();
        self.impact.observe(estimate.force_flu, dt);
        if !self.arming.armed() {
            return;
        }
        let sticks = self.rx.sticks();
        let facts = ImpactFacts {
            raised: self.arming.raised(),
            stick_percent: sticks.deflection_percent(),
            throttle_percent: (sticks.throttle_us - 1000.0) / 10.0,
            alt_hold: self.modes.has(Mode::AltHold),
            near_ground: estimate.alt_m < f64::from(self.parameters.nav.landing_altitude_m),
        };
        if self.impact.is_touchdown(self.parameters.landing_disarm_threshold, &facts) {
            self.disarm(DisarmReason::Landing);
        }
    }
}
