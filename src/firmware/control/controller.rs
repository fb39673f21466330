//! The controller: one step from demands and motion to motor commands.

use super::boost::{GainBoost, ThrottleBoost};
use super::derived::Derived;
use super::gyro::GyroFilter;
use super::heading::{HeadingHold, headless};
use super::level::{Horizon, Level, LevelDemand};
use super::mixer::{MixDemand, command, mix};
use super::pid::{RateDemand, RateLoop};
use super::smoothing::Smoothing;
use super::tuning::Tuning;
use super::{ControlInput, ControlState, PidTerms, StickMode};
use crate::firmware::estimate::Estimate;
use crate::math;

/// The full stick deflection, RC command units.
const FULL_STICK: f64 = 500.0;
/// The longest plausible step, s.
const MAX_STEP_S: f64 = 0.05;
/// The relative change of the step length that needs new filter coefficients.
const STEP_TOLERANCE: f64 = 0.01;

/// Turns demands and the estimate into motor commands.
#[derive(Debug, Clone)]
pub struct Controller {
    tuning: Tuning,
    /// The stick rates at full deflection, °/s, for the angle target.
    full_rates: [f64; 2],
    derived: Derived,
    gyro: GyroFilter,
    smoothing: Smoothing,
    /// The setpoints (°/s) and throttle (0…1) of the sticks before smoothing, and the sticks they belong to.
    raw: [f64; 4],
    raw_sticks: [f64; 4],
    /// The setpoints of the sticks after the limit on their acceleration, °/s.
    limited: [f64; 3],
    throttle_boost: ThrottleBoost,
    /// The throttle added for the tilt.
    tilt_throttle: f64,
    heading_hold: HeadingHold,
    level: Level,
    horizon: Horizon,
    horizon_strength: f64,
    since_level_s: f64,
    /// `true` if a new attitude arrived since the last step of the rate loop.
    is_level_due: bool,
    rate_loop: RateLoop,
    phase: u8,
    was_armed: bool,
    was_raised: bool,
    state: ControlState,
}

impl Controller {
    /// Creates a controller at boot for steps of `dt` seconds.
    pub fn new(tuning: Tuning, dt: f64) -> Self {
        let mut controller = Self {
            derived: Derived::new(&tuning, dt),
            full_rates: [1.0; 2],
            tuning,
            gyro: GyroFilter::default(),
            smoothing: Smoothing::new(),
            raw: [0.0; 4],
            raw_sticks: [f64::NAN; 4],
            limited: [0.0; 3],
            throttle_boost: ThrottleBoost::default(),
            tilt_throttle: 0.0,
            heading_hold: HeadingHold::default(),
            level: Level::default(),
            horizon: Horizon::default(),
            horizon_strength: 0.0,
            since_level_s: 0.0,
            is_level_due: false,
            rate_loop: RateLoop::default(),
            phase: 0,
            was_armed: false,
            was_raised: false,
            state: ControlState::default(),
        };
        controller.set_tuning(tuning);
        controller
    }

    /// Changes the tuning. Not for use within a step. Filters keep their state.
    pub fn set_tuning(&mut self, tuning: Tuning) {
        self.tuning = tuning;
        self.derived = Derived::new(&tuning, self.derived.dt);
        self.full_rates = [0, 1].map(|axis| tuning.rates[axis].rate_dps(1.0).max(1.0));
        self.raw_sticks = [f64::NAN; 4];
        self.smoothing.invalidate();
    }

    /// Returns the smoothing cutoffs of sticks and throttle in use, Hz; 0 while nothing is smoothed.
    pub fn smoothing_hz(&self) -> [f64; 2] {
        self.smoothing.cutoffs_hz()
    }

    /// Returns `true` if the last step ran the rate loop, or if the craft is disarmed.
    pub fn has_run(&self) -> bool {
        self.phase == 0
    }

    /// Returns the results of the last step.
    pub fn state(&self) -> &ControlState {
        &self.state
    }

    /// Changes the held heading to this one, rad clockwise from north. Does nothing while no heading is held.
    pub fn hold_heading(&mut self, heading_rad: f64) {
        self.heading_hold.turn_to(heading_rad);
    }

    /// Forgets the previous flight. Called when the craft is armed.
    pub fn on_arm(&mut self) {
        self.rate_loop = RateLoop::default();
        self.was_raised = false;
        self.throttle_boost = ThrottleBoost::default();
        self.tilt_throttle = 0.0;
        self.level.release();
    }

    /// Runs one step of `dt` seconds.
    #[inline(always)]
    pub fn step(&mut self, input: &ControlInput, estimate: &Estimate, dt: f64) -> &ControlState {
        let dt = if dt > 0.0 { dt.min(MAX_STEP_S) } else { self.derived.dt };
        if (dt - self.derived.dt).abs() > STEP_TOLERANCE * self.derived.dt {
            self.derived = Derived::new(&self.tuning, dt);
            self.smoothing.invalidate();
        }
        if input.armed && !self.was_armed {
            self.on_arm();
        }
        self.was_armed = input.armed;
        self.state.gyro_dps = self.gyro.apply(&estimate.rates, &self.derived);
        let [roll, pitch, yaw, lift] = self.sticks(input, estimate, dt);
        self.since_level_s += dt;
        if !input.armed {
            self.rest(input);
            return &self.state;
        }
        self.is_level_due |= input.due.attitude;
        self.phase += 1;
        if self.phase < self.tuning.rate.denominator {
            return &self.state;
        }
        self.phase = 0;
        let yaw = self.yaw_dps(input, estimate, yaw);
        let mut setpoint = [roll, pitch, yaw];
        let levelling = self.levelling(input, estimate, &mut setpoint);
        self.fly(input, setpoint, lift, levelling);
        self.is_level_due = false;
        &self.state
    }

    /// Returns the smoothed setpoints (°/s) and throttle (0…1) of the sticks.
    #[inline(always)]
    fn sticks(&mut self, input: &ControlInput, estimate: &Estimate, dt: f64) -> [f64; 4] {
        let (mut roll, mut pitch) = (input.stick_roll, input.stick_pitch);
        if let Some(reference) = input.headfree_reference_rad {
            (roll, pitch) = headless(roll, pitch, reference, estimate.heading_rad);
        }
        let sticks = [roll, pitch, input.stick_yaw, input.throttle_us];
        if sticks != self.raw_sticks {
            self.raw_sticks = sticks;
            let [roll_curve, pitch_curve, yaw_curve] = &self.tuning.rates;
            let yaw_sign = if self.tuning.yaw_stick_reversed { -1.0 } else { 1.0 };
            self.raw = [
                roll_curve.rate_dps(roll / FULL_STICK),
                pitch_curve.rate_dps(pitch / FULL_STICK),
                yaw_sign * yaw_curve.rate_dps(input.stick_yaw / FULL_STICK),
                self.tuning.throttle.throttle(input.throttle_us),
            ];
        }
        let mut smooth = self.smoothing.apply(&self.raw, input.rc_frame, &self.tuning, dt);
        for ((setpoint, last), limit) in
            smooth.iter_mut().zip(&mut self.limited).zip(self.tuning.accel_limit_dps2)
        {
            if limit > 0.0 {
                *setpoint = *last + (*setpoint - *last).clamp(-limit * dt, limit * dt);
            }
            *last = *setpoint;
        }
        smooth
    }

    /// Runs a step while disarmed: the motors are stopped or follow the `motor` command.
    fn rest(&mut self, input: &ControlInput) {
        self.rate_loop.clear_integrals();
        self.level.release();
        self.phase = 0;
        let state = &mut self.state;
        state.motors_us = input.motor_test_us;
        state.motors = command(&input.motor_test_us);
        (state.throttle_us, state.throttle) = (1000.0, 0.0);
        (state.setpoint_dps, state.pid_sum, state.angle_demand_rad) = ([0.0; 3], [0.0; 3], None);
        state.terms = PidTerms::default();
    }

    fn yaw_dps(&mut self, input: &ControlInput, estimate: &Estimate, stick_dps: f64) -> f64 {
        if let Some(rate) = input.yaw_rate_rps.filter(|rate| rate.is_finite()) {
            return rate.to_degrees();
        }
        let (heading, gyro) = (estimate.heading_rad, self.state.gyro_dps[2]);
        let held = self.heading_hold.rate_dps(input.heading_hold, input.stick_yaw, heading, gyro);
        held.unwrap_or(stick_dps)
    }

    /// Lets the angle loop change the setpoints. Returns `true` for each axis that it controls fully.
    #[inline(always)]
    fn levelling(&mut self, input: &ControlInput, estimate: &Estimate, setpoint: &mut [f64; 3]) -> [bool; 3] {
        if input.tilt.is_none() && input.mode == StickMode::Acro {
            self.level.release();
            self.state.angle_demand_rad = None;
            self.tilt_throttle = 0.0;
            return [false; 3];
        }
        let is_horizon = input.tilt.is_none() && input.mode == StickMode::Horizon;
        if self.is_level_due {
            let target = self.target_deg(input, setpoint);
            let demand = LevelDemand {
                target,
                flown: [estimate.roll_rad.to_degrees(), estimate.pitch_down_rad.to_degrees()],
                yaw_dps: setpoint[2],
                earth_reference: if input.tilt.is_some() { 1.0 } else { self.tuning.level.earth_reference },
                keeps_heading: input.tilt.is_some(),
            };
            let dt = self.since_level_s;
            self.since_level_s = 0.0;
            self.level.update(&demand, &self.state.gyro_dps, &self.tuning.level, dt);
            self.state.angle_demand_rad = Some(target.map(f64::to_radians));
            self.tilt_throttle = self.tuning.tilt_throttle.at(estimate.cos_tilt);
            if is_horizon {
                let stick = input.stick_roll.abs().max(input.stick_pitch.abs()) / FULL_STICK;
                let tilt = math::acos(estimate.cos_tilt.clamp(-1.0, 1.0)).to_degrees();
                self.horizon_strength = self.horizon.update(stick, tilt, &self.tuning.level, dt);
            }
        }
        let level = self.level.rates(&self.derived);
        let share = if is_horizon { self.horizon_strength } else { 1.0 };
        let by_rate = input.tilt.is_none() && !is_horizon && self.tuning.level.race_mode;
        for axis in 0..if by_rate { 1 } else { 2 } {
            setpoint[axis] += share * (level[axis] - setpoint[axis]);
        }
        if !is_horizon {
            setpoint[2] = self.level.yaw_dps(setpoint[2]);
        }
        [!is_horizon, !is_horizon && !by_rate, false]
    }

    /// Returns the demanded roll and pitch, °: those of the navigator, or of the sticks within the angle limit.
    fn target_deg(&self, input: &ControlInput, setpoint: &[f64; 3]) -> [f64; 2] {
        if let Some(tilt) = input.tilt {
            let sane =
                |angle: f64| if angle.is_finite() { angle.to_degrees().clamp(-85.0, 85.0) } else { 0.0 };
            return [sane(tilt.roll_rad), sane(tilt.pitch_down_rad)];
        }
        let limit = self.tuning.level.limit_deg;
        [0, 1].map(|axis| limit * (setpoint[axis] / self.full_rates[axis]).clamp(-1.0, 1.0))
    }

    #[inline(always)]
    fn fly(&mut self, input: &ControlInput, setpoint: [f64; 3], lift: f64, levelled: [bool; 3]) {
        let is_held = input.throttle.is_some();
        let (lead, gain_boost) = self.throttle_boost.step(lift, &self.tuning.boost, &self.derived);
        let is_low = !is_held && input.throttle_us < self.tuning.throttle.zero_us;
        let by_pilot = if input.failsafe || is_low { lift } else { lead + self.tilt_throttle };
        let throttle = input.throttle.filter(|t| t.is_finite()).unwrap_or(by_pilot).clamp(0.0, 1.0);
        let airmode = input.airmode || is_held;
        if self.is_level_due {
            self.derived.set_filters_for(&self.tuning, throttle);
        }
        let demand = RateDemand {
            setpoint,
            gyro: self.state.gyro_dps,
            levelled,
            deflection: [input.stick_roll, input.stick_pitch, input.stick_yaw].map(|s| s.abs() / FULL_STICK),
            tpa: self.tpa(lift),
            // A throttle that the pilot does not control does not jump with the stick.
            boost: if input.anti_gravity && !is_held { gain_boost } else { GainBoost::NONE },
            integrate: (airmode || !is_low)
                && !(input.stands && (input.tilt.is_some() || is_held || input.mode == StickMode::Angle)),
        };
        let rate = &self.tuning.rate;
        let sums = self.rate_loop.step(&demand, rate, &self.derived);
        let limited =
            std::array::from_fn(|axis| sums[axis].clamp(-rate.sum_limit[axis], rate.sum_limit[axis]));
        let mixer = &self.tuning.mixer;
        let motors_us = if input.motor_stop && is_low && !airmode {
            [mixer.stop_us; 4]
        } else {
            mix(&MixDemand { sums: limited, throttle, airmode, may_stop: input.failsafe }, mixer)
        };
        let zero = self.tuning.throttle.zero_us;
        let state = &mut self.state;
        state.motors_us = motors_us;
        state.motors = command(&motors_us);
        state.throttle_us = zero + throttle * (2000.0 - zero);
        state.throttle = throttle;
        (state.setpoint_dps, state.pid_sum, state.terms) = (setpoint, sums, *self.rate_loop.terms());
    }

    /// Returns TPA, the gain factor for the stick throttle (0…1). It falls at high throttle, and at low throttle before
    /// take-off.
    fn tpa(&mut self, throttle: f64) -> f64 {
        let rate = &self.tuning.rate;
        if throttle >= rate.tpa_low_breakpoint {
            self.was_raised = true;
        } else if !self.was_raised || rate.tpa_low_always {
            let missing = 1.0 - throttle / rate.tpa_low_breakpoint.max(1e-6);
            return 1.0 - rate.tpa_low_share * missing;
        }
        (1.0 - rate.tpa_slope * (throttle - rate.tpa_breakpoint).max(0.0)).max(0.0)
    }
}

#[cfg(test)]
mod tests;
