//! The angle loop: turns demanded and flown angles into rate setpoints.
//!
//! A demand first moves a *leading angle*, the angle that a well-damped craft would fly. The rate of the leading angle
//! is commanded directly, and the gain corrects only the craft's error from it, so the craft follows a stick step
//! quickly without overshoot. With `angle_feedforward = 0` there is no lead and the gain alone pulls the craft to the
//! demand.
//!
//! Master has no leading angle: the gain pulls the craft to the demand, and the rate of the sticks' demand is added, smoothed.
//! The angles of its autopilot and holds get the gain alone.

use super::derived::Derived;
use super::tuning::LevelTuning;
use crate::firmware::filter::Pt3;
use crate::math;

/// The poles of the leading angle per smoothing time. It settles within 5 % after 2.4 smoothing times.
const LEAD_POLES: f64 = 2.0;
/// The largest rate of the leading angle, °/s.
const LEAD_LIMIT_DPS: f64 = 600.0;
/// The yaw rate (°/s) below which yaw is not coupled, to save the trigonometry.
const COUPLED_YAW_DPS: f64 = 0.01;
/// The largest roll (°) used to compensate a pitch rate with yaw. Near the vertical there is no heading.
const COUPLED_ROLL_DEG: f64 = 75.0;
/// The smoothing time of the feedforward of master times the cutoff of its low-pass.
const SMOOTHING_CYCLES: f64 = 7.2;

/// The inputs of the angle loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LevelDemand {
    /// The demanded roll and pitch, °.
    pub target: [f64; 2],
    /// The flown roll and pitch, °.
    pub flown: [f64; 2],
    /// The demanded yaw rate about the vertical, °/s.
    pub yaw_dps: f64,
    /// The share of the yaw that turns about the vertical of the earth, 0…1.
    pub earth_reference: f64,
    /// `true` if the yaw rate is that of the heading. A change of the tilt must not turn it then.
    pub keeps_heading: bool,
}

/// The leading angle: a critically damped second-order filter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Lead {
    angle: f64,
    rate: f64,
}

impl Lead {
    fn follow(&mut self, target: f64, poles: f64, dt: f64) {
        let accel = poles * (poles * (target - self.angle) - 2.0 * self.rate);
        self.rate = (self.rate + accel * dt).clamp(-LEAD_LIMIT_DPS, LEAD_LIMIT_DPS);
        self.angle += self.rate * dt;
    }
}

/// The state of the angle loop.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Level {
    lead: [Lead; 2],
    /// Master: the demand of the last update, °, and the smoothed rate of it.
    last_target: [f64; 2],
    target_rates: [Pt3; 2],
    filters: [Pt3; 2],
    wanted: [f64; 2],
    yaw_share: f64,
    /// The yaw rate that keeps the heading while the tilt changes, °/s.
    yaw_coupling_dps: f64,
    is_on: bool,
}

impl Level {
    /// Ends levelling. The next update starts from the craft's attitude.
    pub(super) fn release(&mut self) {
        self.is_on = false;
    }

    /// Updates the demanded rates, `dt` seconds after the last update.
    pub(super) fn update(&mut self, demand: &LevelDemand, gyro: &[f64; 3], tuning: &LevelTuning, dt: f64) {
        if !self.is_on {
            self.is_on = true;
            for (axis, &rate) in gyro.iter().take(2).enumerate() {
                self.lead[axis] = Lead { angle: demand.flown[axis], rate };
                self.filters[axis].reset(rate);
                self.target_rates[axis].reset(0.0);
            }
            self.last_target = demand.target;
        }
        if tuning.is_plain {
            self.pull(demand, tuning, dt);
        } else {
            self.lead(demand, tuning, dt);
        }
        let keeps_heading = demand.keeps_heading && !tuning.is_plain;
        self.yaw_coupling_dps = if keeps_heading { keep_heading(demand, gyro[1]) } else { 0.0 };
        self.yaw_share = 1.0;
        if demand.yaw_dps.abs() > COUPLED_YAW_DPS {
            self.couple(demand);
        }
    }

    /// Moves the leading angle, and corrects the craft's error from it.
    fn lead(&mut self, demand: &LevelDemand, tuning: &LevelTuning, dt: f64) {
        let share = tuning.feedforward.min(1.0);
        let poles = LEAD_POLES / tuning.smoothing_s.max(dt);
        for axis in 0..2 {
            let lead = &mut self.lead[axis];
            lead.follow(demand.target[axis], poles, dt);
            let wanted = demand.target[axis] + share * (lead.angle - demand.target[axis]);
            let error = wrap_deg(wanted - demand.flown[axis] - tuning.trim_deg[axis]);
            self.wanted[axis] = tuning.p * error + tuning.feedforward * lead.rate;
        }
    }

    /// Pulls the craft to the demand by the laws of master.
    fn pull(&mut self, demand: &LevelDemand, tuning: &LevelTuning, dt: f64) {
        let gain = Pt3::gain(1.0 / (SMOOTHING_CYCLES * tuning.smoothing_s.max(dt)), dt);
        let last = std::mem::replace(&mut self.last_target, demand.target);
        for (axis, last) in last.into_iter().enumerate() {
            let target = demand.target[axis];
            let rate = if demand.keeps_heading { 0.0 } else { (target - last) / dt.max(1e-6) };
            let lead_dps = tuning.feedforward * self.target_rates[axis].apply(rate, gain);
            let error = wrap_deg(target - demand.flown[axis] - tuning.trim_deg[axis]);
            self.wanted[axis] = tuning.p * error + lead_dps;
        }
    }

    /// Adds the roll and pitch rates that a tilting craft needs to turn about the vertical.
    fn couple(&mut self, demand: &LevelDemand) {
        let g = demand.earth_reference;
        let [roll, pitch] = demand.target.map(f64::to_radians);
        self.wanted[0] += demand.yaw_dps * math::sin(pitch) * g;
        self.wanted[1] -= demand.yaw_dps * math::sin(roll) * g;
        self.yaw_share = math::cos(roll.abs().max(pitch.abs()) * g);
    }

    /// Returns the rate setpoints of roll and pitch, °/s. Called once per step of the rate loop.
    pub(super) fn rates(&mut self, derived: &Derived) -> [f64; 2] {
        let [roll, pitch] = &mut self.filters;
        [roll.apply(self.wanted[0], derived.level_rate), pitch.apply(self.wanted[1], derived.level_rate)]
    }

    /// Returns the body yaw rate (°/s) for a demanded rate about the vertical. It is smaller while the craft tilts, and
    /// it compensates for the turn of the nose that pitching causes.
    pub(super) fn yaw_dps(&self, demanded_dps: f64) -> f64 {
        demanded_dps * self.yaw_share + self.yaw_coupling_dps
    }
}

/// Returns the yaw rate (°/s) that keeps the heading of a rolled craft while it pitches at `pitch_dps`, in addition to
/// the demanded turn about the vertical. Pitching about a tilted wing axis turns the nose sideways.
fn keep_heading(demand: &LevelDemand, pitch_dps: f64) -> f64 {
    let roll = demand.flown[0].clamp(-COUPLED_ROLL_DEG, COUPLED_ROLL_DEG).to_radians();
    (pitch_dps + demand.yaw_dps * math::sin(roll)) * math::tan(roll)
}

/// Wraps an angle to ±180°.
fn wrap_deg(angle: f64) -> f64 {
    if angle.abs() <= 180.0 { angle } else { (angle + 180.0).rem_euclid(360.0) - 180.0 }
}

/// The strength of levelling in HORIZON, 0…1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Horizon {
    strength: f64,
}

impl Horizon {
    /// Updates the strength for the farthest stick (0…1) and the tilt (°). It falls at once and rises with a delay.
    pub(super) fn update(&mut self, stick: f64, tilt_deg: f64, tuning: &LevelTuning, dt: f64) -> f64 {
        let by_tilt = (1.0 - tilt_deg / tuning.horizon_tilt_limit_deg.max(1.0)).max(0.0);
        let by_stick = if tuning.horizon_ignores_sticks {
            1.0
        } else {
            (1.0 - stick / tuning.horizon_stick_limit.max(0.01)).max(0.0)
        };
        let wanted = by_tilt * by_stick * tuning.horizon_strength;
        if wanted > self.strength {
            let gain = dt / (tuning.horizon_delay_s + dt);
            self.strength += gain * (wanted - self.strength);
        } else {
            self.strength = wanted;
        }
        self.strength
    }
}

#[cfg(test)]
mod tests {
    use super::super::tuning::Tuning;
    use super::*;

    fn demand(target: f64, flown: f64) -> LevelDemand {
        LevelDemand {
            target: [target, 0.0],
            flown: [flown, 0.0],
            yaw_dps: 0.0,
            earth_reference: 1.0,
            keeps_heading: false,
        }
    }

    #[test]
    fn without_feedforward_the_gain_alone_works() {
        let tuning = LevelTuning { feedforward: 0.0, ..Tuning::default().level };
        let mut level = Level::default();
        level.update(&demand(30.0, 10.0), &[0.0; 3], &tuning, 0.002);
        assert!((level.wanted[0] - 5.0 * 20.0).abs() < 1e-9);
    }

    #[test]
    fn master_pulls_to_the_angle_of_the_autopilot_and_leads_only_for_the_sticks() {
        let tuning = LevelTuning { is_plain: true, ..Tuning::default().level };
        let wanted = |keeps_heading: bool| {
            let mut level = Level::default();
            let demand = |target: f64| LevelDemand { keeps_heading, ..demand(target, 0.0) };
            level.update(&demand(0.0), &[0.0; 3], &tuning, 0.002);
            (0..40).for_each(|_| level.update(&demand(20.0), &[0.0; 3], &tuning, 0.002));
            level.wanted[0]
        };
        assert!((wanted(true) - 5.0 * 20.0).abs() < 1e-9);
        assert!(wanted(false) > 5.0 * 20.0 + 30.0, "{}", wanted(false));
    }

    #[test]
    fn a_craft_that_follows_the_lead_needs_no_correction() {
        let tuning = LevelTuning { feedforward: 1.0, ..Tuning::default().level };
        let mut level = Level::default();
        let mut flown = 0.0;
        for _ in 0..250 {
            level.update(&demand(30.0, flown), &[0.0; 3], &tuning, 0.002);
            flown += level.wanted[0] * 0.002;
        }
        assert!((flown - 30.0).abs() < 0.1, "{flown}");
    }

    #[test]
    fn turning_while_leaning_couples_the_axes() {
        let tuning = LevelTuning { feedforward: 0.0, ..Tuning::default().level };
        let mut level = Level::default();
        // Nose down 30° and turning clockwise at 90°/s, the craft must roll right at 45°/s to keep its angles.
        let turning = LevelDemand {
            target: [0.0, 30.0],
            flown: [0.0, 30.0],
            yaw_dps: 90.0,
            earth_reference: 1.0,
            keeps_heading: false,
        };
        level.update(&turning, &[0.0; 3], &tuning, 0.002);
        assert!((level.wanted[0] - 45.0).abs() < 1e-9);
        assert!((level.yaw_dps(90.0) / 90.0 - 30_f64.to_radians().cos()).abs() < 1e-12);
    }

    #[test]
    fn pitching_while_rolled_does_not_turn_the_heading() {
        let tuning = Tuning::default().level;
        let mut level = Level::default();
        let rolled = LevelDemand {
            target: [45.0, 0.0],
            flown: [45.0, 0.0],
            yaw_dps: 0.0,
            earth_reference: 1.0,
            keeps_heading: true,
        };
        level.update(&rolled, &[0.0, 20.0, 0.0], &tuning, 0.002);
        assert!((level.yaw_dps(0.0) - 20.0).abs() < 1e-9, "as fast as it pitches at 45 degrees");
        level.update(&LevelDemand { keeps_heading: false, ..rolled }, &[0.0, 20.0, 0.0], &tuning, 0.002);
        assert_eq!(level.yaw_dps(0.0), 0.0, "the pilot's yaw stick is the craft's own rate");
    }

    #[test]
    fn the_shorter_way_round_is_taken() {
        assert!((wrap_deg(190.0) + 170.0).abs() < 1e-12);
        assert!((wrap_deg(-350.0) - 10.0).abs() < 1e-12);
    }

    #[test]
    fn horizon_fades_with_stick_and_tilt() {
        let tuning = Tuning::default().level;
        let mut horizon = Horizon::default();
        for _ in 0..5000 {
            horizon.update(0.0, 0.0, &tuning, 0.002);
        }
        assert!((horizon.update(0.0, 0.0, &tuning, 0.002) - 0.75).abs() < 0.01);
        assert_eq!(horizon.update(0.8, 0.0, &tuning, 0.002), 0.0);
    }

    #[test]
    fn horizon_levels_again_slowly_after_the_sticks() {
        let tuning = LevelTuning { horizon_delay_s: 0.5, ..Tuning::default().level };
        let mut horizon = Horizon::default();
        let mut after = |stick: f64, seconds: f64| {
            let steps = (seconds / 0.002).round() as usize;
            (0..steps).map(|_| horizon.update(stick, 0.0, &tuning, 0.002)).last().unwrap_or_default()
        };
        let full = after(0.0, 5.0);
        assert!(full > 0.7, "{full}");
        assert_eq!(after(1.0, 0.002), 0.0, "a flip begins at once");
        let soon = after(0.0, 0.05);
        assert!((0.02 * full..0.2 * full).contains(&soon), "centred sticks do not level at once: {soon}");
        let later = after(0.0, 0.45);
        assert!((0.5 * full..0.75 * full).contains(&later), "after the delay it is more than half: {later}");
        assert!(after(0.0, 3.0) > 0.98 * full);
    }
}
