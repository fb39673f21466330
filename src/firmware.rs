//! The flight controller: settings, modes, arming, receiver, failsafe, estimation, control, CLI and MSP.
//!
//! Each step takes one sensor frame and returns one motor command, in the order below. The slower parts run on a
//! schedule in time, not in steps, so the craft flies the same at every step rate:
//!
//! ```text
//!  SensorFrame ─► Estimator ─► receiver, link, modes, arming ─► failsafe, orders, navigator, holds ─► controller ─► MotorCommand
//!   every step    every step    per RC frame, at least 20 Hz           100 Hz                     every step
//! ```
//!
//! The layers, from the outermost to the innermost. A module uses only its own layer and the ones below it. `config` and
//! `parameters` also fill the types that the modules above them define:
//!
//! | layer | modules | purpose |
//! | --- | --- | --- |
//! | the whole craft | this file, [`Firmware`]'s requests and views | wires the stages: one step, the requests of its owner, the data for displays |
//! | interfaces | [`cli`], [`msp`], `storage`, `blackbox` | command line, MSP messages, the stored image: text and bytes in and out of the configuration; logs of flights |
//! | stages | `stages` | own the state of the step and update it in order |
//! | decisions | `rx`, `modes`, `arming`, `failsafe`, `orders`, `battery` | state machines of plain facts: the sticks that count, the active modes, permission to run the motors, orders for the navigator |
//! | flying | [`estimate`], `control`, `filter` | estimation of the craft's state, and control of the motors |
//! | memory | [`config`], [`settings`], `parameters` | the configuration, one table of settings, and the same as typed numbers, computed outside the step |
//!
//! Nothing here reads a clock, allocates in a step, or panics.

#[doc(hidden)]
pub mod arming;
#[doc(hidden)]
pub mod battery;
#[doc(hidden)]
pub mod blackbox;
pub mod cli;
pub mod config;
#[doc(hidden)]
pub mod control;
pub mod estimate;
#[doc(hidden)]
pub mod failsafe;
#[doc(hidden)]
pub mod filter;
#[doc(hidden)]
pub mod modes;
pub mod msp;
#[doc(hidden)]
pub mod orders;
#[doc(hidden)]
pub mod outbox;
#[doc(hidden)]
pub mod parameters;
#[doc(hidden)]
pub mod rx;
pub mod settings;
#[doc(hidden)]
pub mod storage;

mod requests;
mod stages;
mod throttle_takeover;
mod views;

pub use estimate::AttitudeSource;

use crate::signals::{MotorCommand, SensorFrame, SimTime};
use crate::telemetry::{DisarmReason, FirmwareEvent, FirmwareNotice, Mode, ModeFlags};

use arming::ArmingChange;
use arming::crash::CrashAction;
use blackbox::Recorder;
use config::Configuration;
use modes::{boxes, flight_modes};
use outbox::Outbox;
use stages::{
    ControlStep, Demand, FailsafeRequest, FlightControl, Navigation, RcInput, Safety, Sensing, Setup,
};

/// Options that the firmware is created with. They are not part of its configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirmwareOptions {
    /// Steps per second, one of [`STEP_RATES_HZ`](crate::sim::STEP_RATES_HZ).
    pub rate_hz: u32,
    /// Softens the arming rules for RC from UDP, so that a simple script can arm.
    pub arm_assist: bool,
    /// The source of the attitude.
    pub attitude: AttitudeSource,
    /// The GPS silence that ends the fix, s: short for the embedded world, long for a link that may stall.
    pub gps_timeout_s: f64,
    /// The declination of the magnetic field at the flying site, degrees east.
    pub declination_deg: f64,
    /// The altitude of the flying site above mean sea level, m.
    pub site_alt_m: f64,
    /// Writes blackbox logs, whatever the setting `blackbox_device` says.
    pub logs: bool,
}

impl Default for FirmwareOptions {
    fn default() -> Self {
        let estimator = estimate::EstimatorOptions::default();
        Self {
            rate_hz: 1000,
            arm_assist: false,
            attitude: estimator.attitude,
            gps_timeout_s: estimator.gps_timeout_s,
            declination_deg: estimator.declination_deg,
            site_alt_m: 0.0,
            logs: false,
        }
    }
}

/// The flight controller. A clone is a frozen copy that continues identically.
#[derive(Debug, Clone)]
pub struct Firmware {
    booted_at: SimTime,
    now: SimTime,
    setup: Setup,
    rc: RcInput,
    safety: Safety,
    sensing: Sensing,
    navigation: Navigation,
    control: FlightControl,
    modes: ModeFlags,
    outbox: Outbox,
    /// The flight recorder, unless it is off.
    recorder: Option<Box<Recorder>>,
}

impl Firmware {
    /// Boots with this configuration after making it consistent.
    pub fn new(configuration: Configuration, options: FirmwareOptions) -> Self {
        let mut outbox = Outbox::default();
        let setup = Setup::new(configuration, options, &mut outbox);
        Self::boot(setup, SimTime::ZERO, outbox)
    }

    fn boot(setup: Setup, now: SimTime, outbox: Outbox) -> Self {
        let (options, parameters) = (&setup.options, &setup.parameters);
        Self {
            booted_at: now,
            now,
            rc: RcInput::new(&parameters.rx),
            safety: Safety::default(),
            sensing: Sensing::new(options, parameters),
            navigation: Navigation::new(now),
            control: FlightControl::new(&parameters.control, options.rate_hz),
            modes: ModeFlags::NONE,
            recorder: parameters.blackbox.is_on().then(Box::default),
            setup,
            outbox,
        }
    }

    /// Runs one step: takes one sensor frame and returns one motor command.
    pub fn step(&mut self, frame: &SensorFrame) -> MotorCommand {
        self.now = frame.time;
        let due = self.sensing.update(frame, &self.setup.parameters, &mut self.outbox);
        self.rc.receive_queued(&self.setup.parameters, self.now);
        if self.rc.receiver.is_due(self.now) {
            self.update_arming();
        }
        if due.navigation {
            self.update_navigation();
        }
        let rc_frame = self.rc.take_new_frame();
        let parameters = &self.setup.parameters;
        let switched = self.rc.boxes;
        let airmode = parameters.airmode || switched.has(boxes::AIR_MODE);
        let step = ControlStep {
            due,
            armed: self.safety.arming.armed(),
            modes: self.modes,
            sticks: self.rc.receiver.sticks(),
            rc_frame,
            airmode: airmode && self.safety.arming.raised(),
            anti_gravity: parameters.anti_gravity || switched.has(boxes::ANTI_GRAVITY),
            motor_stop: parameters.motor_stop,
            failsafe: self.navigation.failsafe.active(),
            levels_after_crash: self.safety.crash.is_levelling(),
            headfree_rad: self.safety.headfree_rad,
        };
        let motors = self.control.step(&step, self.sensing.estimate());
        self.watch_for_crash();
        if let Some(mut recorder) = self.recorder.take() {
            recorder.step(self);
            self.recorder = Some(recorder);
        }
        motors
    }

    /// Returns the time since this firmware booted.
    fn uptime(&self) -> SimTime {
        SimTime(self.now.0.saturating_sub(self.booted_at.0))
    }

    /// Updates receiver, link, switches and arming. Runs at every RC frame, and at least twenty times a second.
    fn update_arming(&mut self) {
        let parameters = &self.setup.parameters;
        let failsafe = &self.navigation.failsafe;
        let new_frame = self.rc.update(parameters, self.now, failsafe, &mut self.outbox);
        let estimate = self.sensing.estimate();
        if self.rc.boxes.has(boxes::HEADADJ) {
            self.safety.headfree_rad = estimate.heading_rad;
        }
        let (uptime, landed) = (self.uptime(), failsafe.landed());
        match self.safety.update(parameters, uptime, (&self.rc, new_frame), estimate, landed) {
            Some(ArmingChange::Armed { assisted }) => self.on_arm(assisted),
            Some(ArmingChange::CalibrateGyro) => {
                self.sensing.estimator.calibrate_gyro();
                self.outbox.push(FirmwareEvent::Notice(FirmwareNotice::CalibratingGyro));
            }
            Some(ArmingChange::Disarmed(reason)) => self.on_disarm(reason),
            None => {}
        }
    }

    fn on_arm(&mut self, assisted: bool) {
        let position = stages::trusted_position(&self.setup.parameters, self.sensing.estimate());
        self.sensing.estimator.on_arm(position);
        self.navigation.reset_control();
        self.outbox.push(FirmwareEvent::Armed);
        if assisted {
            self.outbox.push(FirmwareEvent::Notice(FirmwareNotice::ArmAssisted));
        }
    }

    /// Stops the motors for the given reason, unless they are already stopped.
    fn disarm(&mut self, reason: DisarmReason) {
        if self.safety.disarm(reason) {
            self.on_disarm(reason);
        }
    }

    fn on_disarm(&mut self, reason: DisarmReason) {
        self.sensing.estimator.on_disarm();
        self.control.demand = Demand::default();
        self.navigation.reset_control();
        self.outbox.push(FirmwareEvent::Disarmed(reason));
    }

    /// Runs the part that is due a hundred times a second: failsafe, navigator, touchdown, modes, holds.
    fn update_navigation(&mut self) {
        self.keep_calibrations();
        self.sensing.watch_doubts(&mut self.outbox);
        self.sensing.watch_fix(&self.setup.parameters, &mut self.outbox);
        self.navigation.observe(
            self.now,
            &self.setup.parameters,
            &self.sensing,
            &self.safety,
            &self.rc,
            self.control.controller.state(),
        );

        let (parameters, uptime) = (&self.setup.parameters, self.uptime());
        match self.navigation.update_failsafe(parameters, uptime, &self.rc, self.modes, &mut self.outbox) {
            Some(FailsafeRequest::Disarm) => self.disarm(DisarmReason::Failsafe),
            Some(FailsafeRequest::RequireSwitchOff) => self.safety.arming.require_switch_off(),
            None => {}
        }

        let (parameters, stored) = (&self.setup.parameters, &self.setup.configuration.plan);
        let armed = self.safety.arming.armed();
        if self.navigation.navigate(parameters, stored, &self.rc, armed, &mut self.outbox) {
            self.disarm(DisarmReason::Landing);
        }

        let (parameters, alt_hold) = (&self.setup.parameters, self.modes.has(Mode::AltHold));
        if self.navigation.is_impact(parameters, &self.rc, &self.safety, alt_hold) {
            self.disarm(DisarmReason::Landing);
        }
        self.update_modes();

        let (parameters, armed) = (&self.setup.parameters, self.safety.arming.armed());
        let throttle_stick_us = self.rc.receiver.sticks().throttle_us;
        let flown =
            self.navigation.demand(parameters, self.modes, armed, throttle_stick_us, &mut self.outbox);
        self.control.demand = flown.demand;
        if flown.touchdown {
            self.disarm(DisarmReason::Landing);
            self.update_modes();
        }
    }

    /// Applies the results of calibrations that have just ended.
    fn keep_calibrations(&mut self) {
        self.sensing.watch_imu(&mut self.outbox);
        if let Some(offsets) = self.sensing.estimator.take_acc_calibration() {
            self.setup.keep_acc_calibration(offsets);
            self.refresh();
            self.outbox.push(FirmwareEvent::Notice(FirmwareNotice::AccCalibrated));
        }
        if let Some(result) = self.sensing.estimator.take_mag_calibration() {
            let notice = self.setup.keep_mag_calibration(result);
            self.refresh();
            self.outbox.push(notice);
        }
    }

    fn update_modes(&mut self) {
        let modes =
            flight_modes(&self.navigation.mode_facts(&self.rc, &self.safety, self.sensing.estimate()));
        if modes != self.modes {
            self.modes = modes;
            self.outbox.push(FirmwareEvent::Mode(modes));
        }
    }

    /// Disarms on a runaway take-off or a crash, judged by the controller's last step.
    fn watch_for_crash(&mut self) {
        let (parameters, state) = (&self.setup.parameters, self.control.controller.state());
        if self.safety.is_runaway(parameters, self.now, &self.rc, state) {
            self.disarm(DisarmReason::RunawayTakeoff);
        }
        let (parameters, state) = (&self.setup.parameters, self.control.controller.state());
        match self.safety.crash(parameters, self.now, state, self.sensing.estimate()) {
            Some(CrashAction::Disarm) => self.disarm(DisarmReason::CrashProtection),
            Some(CrashAction::Level) => {
                self.outbox.push(FirmwareEvent::Notice(FirmwareNotice::CrashDetected));
            }
            Some(CrashAction::Off) | None => {}
        }
    }

    /// Updates the typed parameters, and everything tuned by them, from the configuration.
    fn refresh(&mut self) {
        self.setup.refresh();
        let parameters = &self.setup.parameters;
        self.sensing.set_tuning(parameters);
        self.control.set_tuning(&parameters.control);
        // A log under way goes on to its end.
        if !parameters.blackbox.is_on() {
            self.recorder.take_if(|recorder| !recorder.is_logging());
        } else if self.recorder.is_none() {
            self.recorder = Some(Box::default());
        }
    }
}
