//! The flight controller: settings, modes, arming, receiver, failsafe, estimation, control, CLI and MSP.
//!
//! One step takes one sensor frame and gives one motor command, in this order; slower parts run when their time has
//! come, counted in time and not in steps, so that every step rate flies alike:
//!
//! ```text
//!  SensorFrame ─► Estimator ─► receiver, link, modes, arming ─► failsafe, orders, navigator, holds ─► controller ─► MotorCommand
//!   every step    every step    per RC frame, at least 20 Hz           100 Hz                     every step
//! ```
//!
//! | part | file | is |
//! | --- | --- | --- |
//! | settings, configuration, CLI, MSP, storage | [`settings`], [`config`], [`cli`], [`msp`] | what the craft remembers and how it is talked to |
//! | parameters | [`parameters`] | the same as typed numbers, made outside the step |
//! | receiver | [`rx`] | sources, channels, sticks, signal |
//! | modes | [`modes`] | boxes, conditions, which flight mode is on |
//! | arming | [`arming`] | the switch, what blocks it, what disarms |
//! | failsafe | [`failsafe`] | link, guard time, procedures, recovery |
//! | orders | [`mission`] | who tells the navigator what to do |
//! | estimator, controller | [`estimate`], [`control`] | where the craft is, and what the motors do |
//!
//! Nothing here reads a clock, allocates in a step, or panics.

pub mod arming;
pub mod battery;
pub mod cli;
pub mod config;
pub mod control;
pub mod estimate;
pub mod failsafe;
pub mod filter;
pub mod mission;
pub mod modes;
pub mod msp;
pub mod outbox;
pub mod parameters;
pub mod rx;
pub mod settings;
pub mod storage;

mod command;
mod facts;
mod flight;
mod navigation_pass;
mod receiver_pass;
mod sensor_pass;
mod status;

pub use estimate::AttitudeSource;

use nalgebra::Vector3;
use strum::{EnumCount as _, IntoEnumIterator as _};

use crate::autopilot::Navigator;
use crate::autopilot::io::NavInputs;
use crate::geo::LatLon;
use crate::signals::{MotorCommand, RcFrame, RcSource, SensorFrame, SimTime};
use crate::telemetry::{DisarmReason, FirmwareEvent, ModeFlags, NavOutput};

use arming::Arming;
use arming::crash::CrashDetector;
use arming::impact::Impact;
use arming::runaway::Runaway;
use battery::Battery;
use cli::{BuildInfo, StorageFacts};
use config::{Configuration, Feature, MixerKind};
use control::hold::Holds;
use estimate::{Estimator, EstimatorOptions};
use failsafe::{Failsafe, LinkMonitor};
use flight::{Flight, FlightStep};
use mission::Orders;
use modes::BoxSet;
use outbox::Outbox;
use parameters::{BootChoices, Parameters};
use rx::Receiver;

/// How the firmware is built and helped; not part of its configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirmwareOptions {
    /// Steps a second.
    pub rate_hz: u32,
    /// Arming rules are softened for RC from UDP, so that a simple script can arm.
    pub arm_assist: bool,
    /// Where the attitude comes from.
    pub attitude: AttitudeSource,
    /// Silence of the GPS that ends the fix, s: short for the embedded world, long for a link that may stall.
    pub gps_timeout_s: f64,
    /// Declination of the magnetic field where the craft flies, degrees east.
    pub declination_deg: f64,
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
        }
    }
}

/// The flight controller. A clone is a frozen copy that goes on identically.
#[derive(Debug, Clone)]
pub struct Firmware {
    options: FirmwareOptions,
    build: BuildInfo,
    storage: StorageFacts,
    // What it remembers.
    configuration: Configuration,
    boot: BootChoices,
    parameters: Parameters,
    // Time.
    booted_at: SimTime,
    now: SimTime,
    // Receiver and modes.
    inbox: [Option<RcFrame>; RcSource::COUNT],
    rx: Receiver,
    link: LinkMonitor,
    link_lost: bool,
    boxes: BoxSet,
    modes: ModeFlags,
    // Arming.
    arming: Arming,
    runaway: Runaway,
    crash: CrashDetector,
    impact: Impact,
    last_disarm: Option<DisarmReason>,
    home: Option<LatLon>,
    headfree_rad: f64,
    // Estimation and battery.
    estimator: Estimator,
    battery: Battery,
    imu_frozen: bool,
    /// Newest magnetic field, body forward-left-up, as sensed.
    mag_flu: Vector3<f64>,
    fix: bool,
    fix_since: SimTime,
    // Who flies.
    failsafe: Failsafe,
    orders: Orders,
    navigator: Navigator,
    nav_inputs: NavInputs,
    nav_output: Option<NavOutput>,
    nav_time: SimTime,
    holds: Holds,
    no_position: bool,
    flight: Flight,
    rc_frame: bool,
    outbox: Outbox,
}

impl Firmware {
    /// Boots with this configuration, made consistent.
    #[must_use]
    pub fn new(mut configuration: Configuration, options: FirmwareOptions) -> Self {
        let had_gps = configuration.features.has(Feature::Gps);
        config::correct(&mut configuration);
        let boot = BootChoices::new(&configuration);
        let parameters = Parameters::new(&configuration, &boot, &options);
        let estimator = Estimator::new(estimator_options(&options), parameters.estimator.clone());
        let mut outbox = Outbox::default();
        if configuration.mixer.rows().is_none() && configuration.mixer != MixerKind::Custom {
            outbox.push(FirmwareEvent::Notice(
                "This mixer type does not fly here: QUADX, QUADP, QUADX1234 and CUSTOM do; QUADX is flown instead.",
            ));
        }
        let mut firmware = Self {
            options,
            build: BuildInfo::default(),
            storage: StorageFacts::default(),
            inbox: [None; RcSource::COUNT],
            rx: Receiver::new(&parameters.rx),
            flight: Flight::new(&parameters.control, options.rate_hz),
            configuration,
            boot,
            parameters,
            booted_at: SimTime::ZERO,
            now: SimTime::ZERO,
            link: LinkMonitor::default(),
            link_lost: false,
            boxes: BoxSet::NONE,
            modes: ModeFlags::NONE,
            arming: Arming::default(),
            runaway: Runaway::default(),
            crash: CrashDetector::default(),
            impact: Impact::default(),
            last_disarm: None,
            home: None,
            headfree_rad: 0.0,
            estimator,
            battery: Battery::default(),
            imu_frozen: false,
            mag_flu: Vector3::zeros(),
            fix: false,
            fix_since: SimTime::ZERO,
            failsafe: Failsafe::default(),
            orders: Orders::default(),
            navigator: Navigator::new(),
            nav_inputs: idle_inputs(),
            nav_output: None,
            nav_time: SimTime::ZERO,
            rc_frame: false,
            holds: Holds::default(),
            no_position: false,
            outbox,
        };
        firmware.tell_lost_gps(had_gps);
        firmware
    }

    /// One step: one frame of the sensors in, one command for the motors out.
    pub fn step(&mut self, frame: &SensorFrame) -> MotorCommand {
        self.now = frame.time;
        let due = self.estimator.update(frame);
        if let Some(sample) = frame.battery {
            self.hear_battery(sample);
        }
        self.take_frames();
        self.mag_flu = frame.mag_flu.unwrap_or(self.mag_flu);
        if self.rx.is_due(self.now) {
            self.receiver_pass();
        }
        if due.navigation {
            let dt = self.now.seconds_since(std::mem::replace(&mut self.nav_time, self.now));
            self.navigation_pass(dt);
        }
        let estimate = self.estimator.estimate();
        let step = FlightStep {
            due,
            armed: self.arming.armed(),
            modes: self.modes,
            sticks: self.rx.sticks(),
            rc_frame: std::mem::take(&mut self.rc_frame),
            airmode: self.airmode(),
            anti_gravity: self.parameters.anti_gravity || self.boxes.has(modes::boxes::ANTI_GRAVITY),
            motor_stop: self.parameters.motor_stop,
            failsafe: self.failsafe.active(),
            levels_after_crash: self.crash.is_levelling(),
            headfree_rad: self.headfree_rad,
        };
        let motors = self.flight.step(&step, estimate);
        self.runaway_pass();
        self.crash_pass();
        motors
    }

    /// Hands the frames that came since the last step to the receiver.
    fn take_frames(&mut self) {
        for source in RcSource::iter() {
            if let Some(frame) = self.inbox[source as usize].take() {
                self.rx.receive(&self.parameters.rx, frame, source, self.now);
            }
        }
    }

    /// Full stabilisation at zero throttle, once the throttle was raised.
    fn airmode(&self) -> bool {
        (self.parameters.airmode || self.boxes.has(modes::boxes::AIR_MODE)) && self.arming.raised()
    }
}

/// A craft that knows nothing yet.
fn idle_inputs() -> NavInputs {
    NavInputs {
        time: SimTime::ZERO,
        dt: 0.01,
        armed: false,
        fix: false,
        altitude_valid: false,
        throttle_raised: false,
        failsafe: false,
        home: None,
        origin: LatLon::default(),
        pos_ne: nalgebra::Vector2::zeros(),
        vel_ne: nalgebra::Vector2::zeros(),
        alt_m: 0.0,
        climb_mps: 0.0,
        heading_rad: 0.0,
        yaw_rate_rps: 0.0,
        roll_rad: 0.0,
        pitch_rad: 0.0,
        cos_tilt: 1.0,
        accel_ne: nalgebra::Vector2::zeros(),
        throttle_us: 1000.0,
        stick_roll: 0.0,
        stick_pitch: 0.0,
        stick_yaw: 0.0,
    }
}

fn estimator_options(options: &FirmwareOptions) -> EstimatorOptions {
    EstimatorOptions {
        attitude: options.attitude,
        gps_timeout_s: options.gps_timeout_s,
        declination_deg: options.declination_deg,
    }
}
