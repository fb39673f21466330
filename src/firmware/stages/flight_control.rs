//! The controller, driven by the sticks or by the demands that replace them.

use crate::autopilot::io::NavOutput;
use crate::firmware::control::{ControlInput, Controller, StickMode, TiltDemand, Tuning};
use crate::firmware::estimate::{DueTasks, Estimate};
use crate::firmware::rx::Sticks;
use crate::signals::{MOTORS, MotorCommand, PerMotor};
use crate::telemetry::{Mode, ModeFlags};

/// The pulse of a stopped motor, µs.
const MOTOR_STOP_US: f64 = 1000.0;

/// Demands that replace the pilot's, updated a hundred times a second.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::firmware) struct Demand {
    pub tilt: Option<TiltDemand>,
    /// The yaw rate, rad/s, clockwise positive.
    pub yaw_rate_rps: Option<f64>,
    /// The throttle into the mixer, 0…1.
    pub throttle: Option<f64>,
    /// `true` while the craft is on its legs.
    pub stands: bool,
}

impl From<NavOutput> for Demand {
    fn from(output: NavOutput) -> Self {
        Self {
            tilt: Some(TiltDemand { roll_rad: output.roll_rad, pitch_down_rad: output.pitch_down_rad }),
            yaw_rate_rps: output.yaw_rate_rps,
            throttle: Some(output.throttle),
            stands: false,
        }
    }
}

/// The inputs of one controller step, other than the estimate.
#[derive(Debug, Clone, Copy)]
pub(in crate::firmware) struct ControlStep<'a> {
    /// The loops that are due.
    pub due: DueTasks,
    pub armed: bool,
    pub modes: ModeFlags,
    /// The stick positions in use.
    pub sticks: &'a Sticks,
    /// `true` if a new RC frame came.
    pub rc_frame: bool,
    /// Full stabilisation at zero throttle.
    pub airmode: bool,
    /// Raises the gains in quick throttle changes.
    pub anti_gravity: bool,
    /// Stops the motors at low throttle.
    pub motor_stop: bool,
    /// `true` while a failsafe procedure runs.
    pub failsafe: bool,
    /// Levels the craft after a crash, regardless of the sticks.
    pub levels_after_crash: bool,
    /// The reference heading of HEADFREE, rad.
    pub headfree_rad: f64,
}

/// The tilt demand while the craft is levelled after a crash.
const LEVEL: TiltDemand = TiltDemand { roll_rad: 0.0, pitch_down_rad: 0.0 };

/// The controller and the demands in force.
#[derive(Debug, Clone)]
pub(in crate::firmware) struct FlightControl {
    pub controller: Controller,
    pub demand: Demand,
    motor_test_us: PerMotor,
    step_s: f64,
}

impl FlightControl {
    /// Creates a controller at boot for `rate_hz` steps a second.
    pub(in crate::firmware) fn new(tuning: &Tuning, rate_hz: u32) -> Self {
        let step_s = 1.0 / f64::from(rate_hz.max(1));
        Self {
            controller: Controller::new(*tuning, step_s),
            demand: Demand::default(),
            motor_test_us: [MOTOR_STOP_US; MOTORS],
            step_s,
        }
    }

    pub(in crate::firmware) fn set_tuning(&mut self, tuning: &Tuning) {
        self.controller.set_tuning(*tuning);
    }

    /// Runs motors on the bench; `None` = all motors. No effect while armed.
    pub(in crate::firmware) fn test_motor(&mut self, motor: Option<u8>, output_us: u16) {
        let pulse = f64::from(output_us);
        match motor {
            None => self.motor_test_us = [pulse; MOTORS],
            Some(index) => {
                if let Some(motor) = self.motor_test_us.get_mut(usize::from(index)) {
                    *motor = pulse;
                }
            }
        }
    }

    /// Stops the motors that run on the bench.
    pub(in crate::firmware) fn end_motor_test(&mut self) {
        self.motor_test_us = [MOTOR_STOP_US; MOTORS];
    }

    pub(in crate::firmware) fn step(&mut self, step: &ControlStep<'_>, estimate: &Estimate) -> MotorCommand {
        let centred = Sticks { throttle_us: step.sticks.throttle_us, ..Sticks::default() };
        let sticks = if step.levels_after_crash { &centred } else { step.sticks };
        let input = ControlInput {
            due: step.due,
            armed: step.armed,
            mode: stick_mode(step.modes),
            stick_roll: sticks.roll,
            stick_pitch: sticks.pitch,
            stick_yaw: sticks.yaw,
            throttle_us: sticks.throttle_us,
            rc_frame: step.rc_frame,
            tilt: self.demand.tilt.or(step.levels_after_crash.then_some(LEVEL)),
            stands: self.demand.stands,
            yaw_rate_rps: self.demand.yaw_rate_rps,
            throttle: self.demand.throttle,
            airmode: step.airmode,
            anti_gravity: step.anti_gravity,
            motor_stop: step.motor_stop,
            failsafe: step.failsafe,
            headfree_reference_rad: headfree(step).then_some(step.headfree_rad),
            heading_hold: step.modes.has(Mode::Mag),
            motor_test_us: self.motor_test_us,
        };
        self.controller.step(&input, estimate, self.step_s).motors
    }
}

/// Returns `true` if HEADFREE is active. It has no effect while the autopilot flies.
fn headfree(step: &ControlStep<'_>) -> bool {
    step.modes.has(Mode::HeadFree) && !step.modes.has(Mode::Autopilot)
}

fn stick_mode(modes: ModeFlags) -> StickMode {
    if modes.has(Mode::Angle) {
        StickMode::Angle
    } else if modes.has(Mode::Horizon) {
        StickMode::Horizon
    } else {
        StickMode::Acro
    }
}
