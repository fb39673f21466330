//! A craft made of plant, estimator, controller and holds, without arming rules and receiver. The control
//! tests fly it.

#![allow(dead_code, reason = "each test file uses a part of it")]

use betadeck_core::autopilot::Params;
use betadeck_core::autopilot::control::FlightControllers;
use betadeck_core::autopilot::io::NavInputs;
use betadeck_core::autopilot::land_detector::GroundMeasurement;
use betadeck_core::firmware::config::MixerKind;
use betadeck_core::firmware::control::hold::{HoldModes, HoldOutput, HoldTuning, Holds};
use betadeck_core::firmware::control::{ControlInput, Controller, StickMode, TiltDemand, Tuning};
use betadeck_core::firmware::estimate::{Estimate, Estimator, EstimatorOptions, EstimatorTuning};
use betadeck_core::firmware::settings::Settings;
use betadeck_core::signals::SimTime;
use betadeck_core::sim::{Airframe, Noise, Truth, World, WorldConfig};
use nalgebra::{Vector2, Vector3};

/// The interval of the RC frames, µs.
const FRAME_US: u64 = 20_000;

pub(crate) struct Rig {
    pub(crate) world: World,
    pub(crate) estimator: Estimator,
    pub(crate) controller: Controller,
    pub(crate) holds: Holds,
    pub(crate) controllers: FlightControllers,
    pub(crate) hold_tuning: HoldTuning,
    pub(crate) params: Params,
    pub(crate) modes: HoldModes,
    pub(crate) hold: HoldOutput,
    /// The sticks and mode of the pilot. They reach the controller with the next frame.
    pub(crate) sticks: ControlInput,
    received: ControlInput,
    dt: f64,
    slow_time: SimTime,
}

/// Returns a world with these sensors and this airframe in flat wind.
pub(crate) fn world(noise: Noise, airframe: Airframe) -> WorldConfig {
    let mut config = WorldConfig { noise, airframe, ..WorldConfig::default() };
    config.switches.wind_profile = betadeck_core::sim::WindProfile::Flat;
    config
}

impl Rig {
    pub(crate) fn new(config: WorldConfig, settings: &Settings) -> Self {
        let dt = 1.0 / f64::from(config.rate_hz);
        let mut params = Params::default();
        for field in Params::FIELDS {
            (field.set)(&mut params, settings.number(field.name));
        }
        Self {
            world: World::new(config).expect("a valid world"),
            estimator: Estimator::new(EstimatorOptions::default(), EstimatorTuning::from_settings(settings)),
            controller: Controller::new(Tuning::from_settings(settings, MixerKind::QuadX, &[]), dt),
            holds: Holds::default(),
            controllers: FlightControllers::default(),
            hold_tuning: HoldTuning::from_settings(settings),
            params,
            modes: HoldModes::default(),
            hold: HoldOutput::default(),
            sticks: ControlInput::default(),
            received: ControlInput::default(),
            dt,
            slow_time: SimTime::ZERO,
        }
    }

    /// Returns an armed craft 20 m above home, after 10 s of hover in ALTHOLD and POS HOLD.
    pub(crate) fn airborne(config: WorldConfig, settings: &Settings) -> Self {
        let mut rig = Self::new(config, settings);
        rig.run(6.0);
        rig.arm();
        rig.modes = HoldModes { altitude: true, position: true, descend: None };
        rig.sticks.throttle_us = 1900.0;
        let mut left = 30.0;
        while rig.estimate().alt_m < 18.0 && left > 0.0 {
            rig.run(0.1);
            left -= 0.1;
        }
        rig.sticks.throttle_us = rig.controllers.altitude.hover_stick_us(&rig.params, rig.hold_tuning.mid_us);
        rig.run(10.0);
        rig
    }

    pub(crate) fn arm(&mut self) {
        let home = self.estimate().gps.solution.map(|solution| solution.position);
        self.estimator.on_arm(home);
        self.sticks.armed = true;
        self.sticks.airmode = true;
    }

    /// Passes control to the pilot, at the throttle that hovers. Clears the holds.
    pub(crate) fn manual(&mut self, mode: StickMode) {
        self.sticks.throttle_us = self.controller.state().throttle_us;
        self.sticks.mode = mode;
        self.modes = HoldModes::default();
    }

    pub(crate) fn estimate(&self) -> &Estimate {
        self.estimator.estimate()
    }

    pub(crate) fn truth(&self) -> &Truth {
        self.world.truth()
    }

    /// Returns the true roll (right positive) and pitch (nose down positive), degrees.
    pub(crate) fn tilt_deg(&self) -> [f64; 2] {
        let m = self.truth().attitude.to_rotation_matrix();
        let m = m.matrix();
        [m[(2, 1)].atan2(m[(2, 2)]).to_degrees(), (-m[(2, 0)]).asin().to_degrees()]
    }

    /// Returns the true body rates, roll right, pitch nose down, yaw clockwise, °/s.
    pub(crate) fn rates_dps(&self) -> [f64; 3] {
        let rate = self.truth().rate_flu;
        [rate.x.to_degrees(), rate.y.to_degrees(), -rate.z.to_degrees()]
    }

    /// Returns the true position north and east of home, m.
    pub(crate) fn position_ne(&self) -> Vector2<f64> {
        Vector2::new(self.truth().pos_enu.y, self.truth().pos_enu.x)
    }

    /// Returns the true altitude above the standing height, m.
    pub(crate) fn altitude_m(&self) -> f64 {
        self.truth().pos_enu.z - self.world.airframe().standing_height_m()
    }

    pub(crate) fn run(&mut self, seconds: f64) {
        self.watch(seconds, |_| ());
    }

    /// Runs, and calls `look` with the craft after each step.
    pub(crate) fn watch(&mut self, seconds: f64, mut look: impl FnMut(&Self)) {
        for _ in 0..(seconds / self.dt).round() as usize {
            self.step();
            look(self);
        }
    }

    pub(crate) fn step(&mut self) {
        let frame = *self.world.sensors();
        let is_frame = frame.time.0.is_multiple_of(FRAME_US);
        if is_frame {
            self.received = self.sticks;
        }
        let due = self.estimator.update(&frame);
        if due.navigation {
            let now = self.nav_inputs(frame.time);
            let rates = self.estimate().rates;
            let rate_rps = Vector3::new(rates.roll, rates.pitch_down, rates.yaw).norm();
            let motors = &self.controller.state().motors;
            let ground = GroundMeasurement::new(&now, self.estimate().force_flu, rate_rps, motors);
            let FlightControllers { altitude, land, .. } = &mut self.controllers;
            land.observe(&ground, now.armed, now.dt);
            altitude.set_on_ground(land.awaits_lift_off(), land.load());
            let stick = Some(self.received.throttle_us);
            self.hold = self.holds.update(
                self.modes,
                &now,
                stick,
                &self.params,
                &self.hold_tuning,
                &mut self.controllers,
            );
        }
        let mut input = self.received;
        (input.due, input.rc_frame) = (due, is_frame);
        input.throttle = self.hold.throttle.or(input.throttle);
        let share = self.controllers.land.tilt_share();
        let held = self.hold.tilt.map(|tilt| TiltDemand {
            roll_rad: share * tilt.roll_rad,
            pitch_down_rad: share * tilt.pitch_down_rad,
        });
        input.tilt = held.or(input.tilt);
        input.stands = self.controllers.land.stands();
        if self.modes.altitude && input.tilt.is_none() {
            input.mode = StickMode::Angle;
        }
        let state = self.controller.step(&input, self.estimator.estimate(), self.dt);
        self.world.step(&state.motors);
    }

    fn nav_inputs(&mut self, time: SimTime) -> NavInputs {
        let estimate = self.estimator.estimate();
        let dt = time.seconds_since(self.slow_time);
        self.slow_time = time;
        NavInputs {
            armed: self.received.armed,
            throttle_raised: true,
            home: estimate.origin,
            throttle_us: self.controller.state().throttle_us,
            stick_roll: self.received.stick_roll,
            stick_pitch: self.received.stick_pitch,
            stick_yaw: self.received.stick_yaw,
            ..estimate.nav_inputs(time, dt)
        }
    }

    /// Demands this tilt from the next frame on.
    pub(crate) fn tilt(&mut self, roll_deg: f64, pitch_deg: f64) {
        self.sticks.tilt =
            Some(TiltDemand { roll_rad: roll_deg.to_radians(), pitch_down_rad: pitch_deg.to_radians() });
    }
}

/// The response of a signal to a step from 0 to `target`, sampled every `dt` seconds.
#[derive(Debug)]
pub(crate) struct StepResponse {
    /// The overshoot as a share of the step.
    pub(crate) overshoot: f64,
    /// Seconds until the signal stayed within 5 % of the step.
    pub(crate) settled_s: f64,
    /// Seconds until the signal reached 90 %.
    pub(crate) rise_s: f64,
}

impl StepResponse {
    pub(crate) fn of(values: &[f64], target: f64, dt: f64) -> Self {
        let shares: Vec<f64> = values.iter().map(|value| value / target).collect();
        let last_outside = shares.iter().rposition(|share| (share - 1.0).abs() > 0.05);
        let rise = shares.iter().position(|share| *share >= 0.9).unwrap_or(shares.len());
        Self {
            overshoot: shares.iter().fold(0.0_f64, |most, share| most.max(share - 1.0)),
            settled_s: last_outside.map_or(0.0, |index| (index + 1) as f64 * dt),
            rise_s: rise as f64 * dt,
        }
    }
}
