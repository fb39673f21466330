//! A leg along a line: the craft follows a point that runs ahead of it, the carrot, and that slows down before a corner.

use nalgebra::Vector2;

use super::corner::Corner;
use crate::autopilot::params::Params;
use crate::geo::wrap_pi;
use crate::math;

/// The time constant of the place along the leg and of the speed, s.
const FILTER_S: f64 = 0.2;
/// The excess over the speed of the carrot at which it stops, and below which it goes on, m/s.
pub(super) const TOO_FAST_MPS: f64 = 1.5;
const SLOW_AGAIN_MPS: f64 = 0.75;
/// The carrot falls behind the craft by no more than the way of this time, s, and this distance, m.
const BEHIND_S: f64 = 0.25;
const BEHIND_M: f64 = 1.5;
/// It leads by at least this, m.
const MIN_LEAD_M: f64 = 6.0;
/// A craft that has passed the end within this distance of the line has reached it, m.
const BESIDE_M: f64 = 8.0;
/// The nose has turned this far before the gate, m.
const TURNED_M: f64 = 5.0;
/// Beyond this angle off the leg the nose counts as not aligned.
const ALIGNED_RAD: f64 = std::f64::consts::FRAC_PI_2;

/// The place and motion of the craft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Motion {
    /// North and east, m.
    pub(super) ne: Vector2<f64>,
    /// Ground speed, m/s.
    pub(super) speed_mps: f64,
    pub(super) heading_rad: f64,
}

/// The state of a leg along a line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    start: Vector2<f64>,
    end: Vector2<f64>,
    /// The place along the leg, m, and the speed, m/s, both smoothed.
    along_m: f64,
    speed_mps: f64,
    carrot_m: f64,
    carrot_mps: f64,
    /// The excess of the craft's speed over the wanted one of the carrot, m/s.
    excess_mps: f64,
    is_too_fast: bool,
}

/// The result of an update.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Followed {
    /// The carrot, north and east, m.
    pub(super) carrot: Vector2<f64>,
    /// Its distance ahead of the craft along the leg, m.
    pub(super) lead_m: f64,
    /// The speed of the carrot, m/s.
    pub(super) speed_mps: f64,
    /// The excess of the craft's speed over the wanted one of the carrot, m/s.
    pub(super) excess_mps: f64,
    /// The heading that the leg commands.
    pub(super) heading_rad: Option<f64>,
    /// `true` while the nose turns to the next leg.
    pub(super) is_turning: bool,
    /// `true` if the waypoint is reached.
    pub(super) is_reached: bool,
    /// The place of the craft: along the leg, and to the right of it, m.
    pub(super) along_m: f64,
    pub(super) across_m: f64,
}

impl Line {
    /// Begins the leg from `start`, the last carrot, to `end`. The carrot keeps its speed.
    pub(super) fn new(start: Vector2<f64>, carrot_mps: f64, end: Vector2<f64>, now: &Motion) -> Self {
        let line = Self {
            start,
            end,
            along_m: 0.0,
            speed_mps: now.speed_mps,
            carrot_m: 0.0,
            carrot_mps,
            excess_mps: 0.0,
            is_too_fast: false,
        };
        let (along_m, _) = line.place(now.ne);
        Self { along_m, ..line }
    }

    /// Returns the start of the leg, north and east, m.
    pub(super) fn start(&self) -> Vector2<f64> {
        self.start
    }

    fn direction(&self) -> Vector2<f64> {
        let way = self.end - self.start;
        way.try_normalize(1e-6).unwrap_or_default()
    }

    /// Returns the distance of a point along the leg and its offset to the right, m.
    fn place(&self, ne: Vector2<f64>) -> (f64, f64) {
        let (direction, from_start) = (self.direction(), ne - self.start);
        (direction.dot(&from_start), direction.x * from_start.y - direction.y * from_start.x)
    }

    /// Follows the craft for `dt` seconds. `next` is the bearing of the next leg, if there is one.
    pub(super) fn follow(
        &mut self,
        now: &Motion,
        corner: &Corner,
        next_rad: Option<f64>,
        cruise_mps: f64,
        params: &Params,
        dt: f64,
    ) -> Followed {
        let length_m = (self.end - self.start).norm();
        let (along_m, across_m) = self.place(now.ne);
        let share = dt / (FILTER_S + dt);
        self.along_m += share * (along_m - self.along_m);
        self.speed_mps += share * (now.speed_mps - self.speed_mps);

        let direction = self.direction();
        let leg_rad = math::atan2(direction.y, direction.x);
        let is_aligned = wrap_pi(now.heading_rad - leg_rad).abs() < ALIGNED_RAD;
        let turn =
            next_rad.and_then(|next| turned(length_m - along_m - corner.gate_m, next - leg_rad, params));
        let may_run = is_aligned || turn.is_some();
        let wanted_mps = self.wanted_mps(length_m, corner, cruise_mps, params);
        let wanted_mps = if self.is_too_fast || !may_run { 0.0 } else { wanted_mps };
        let step_mps = 0.01 * f64::from(params.nav_accel) * dt;
        self.carrot_mps += (wanted_mps - self.carrot_mps).clamp(-step_mps, step_mps);
        self.carrot_m = self.limited(self.carrot_m + self.carrot_mps * dt, params).clamp(0.0, length_m);

        let lead_m = self.carrot_m - along_m;
        let is_commanded = turn.is_some() || !is_aligned || lead_m <= 0.0;
        let gone_by = along_m >= length_m && across_m.abs() <= BESIDE_M;
        Followed {
            carrot: self.start + direction * self.carrot_m,
            lead_m,
            speed_mps: self.carrot_mps,
            excess_mps: self.excess_mps,
            heading_rad: is_commanded.then(|| leg_rad + turn.unwrap_or_default()),
            is_turning: turn.is_some(),
            is_reached: (self.end - now.ne).norm() <= corner.gate_m || gone_by,
            along_m,
            across_m,
        }
    }

    /// Returns the speed that the carrot should have, m/s, and notes a craft that is too fast for it.
    fn wanted_mps(&mut self, length_m: f64, corner: &Corner, cruise_mps: f64, params: &Params) -> f64 {
        let rest_m = (length_m - self.along_m - corner.gate_m).max(0.0);
        let lead_s = 0.1 * f64::from(params.nav_carrot_lead_time);
        let brake_m = (rest_m - self.carrot_mps * lead_s).max(0.0);
        let decel = 0.01 * f64::from(params.nav_decel);
        let wanted = (corner.speed_mps * corner.speed_mps + 2.0 * decel * brake_m).sqrt().min(cruise_mps);
        let allowed_mps = if self.is_too_fast { SLOW_AGAIN_MPS } else { TOO_FAST_MPS };
        self.excess_mps = self.speed_mps - wanted;
        self.is_too_fast = self.excess_mps > allowed_mps;
        wanted
    }

    /// Returns the carrot within its distance from the craft.
    fn limited(&self, carrot_m: f64, params: &Params) -> f64 {
        let along_m = self.along_m.max(0.0);
        let least = along_m - (BEHIND_S * self.speed_mps + BEHIND_M);
        carrot_m.clamp(least, along_m + most_lead_m(self.speed_mps, params))
    }
}

/// Returns the longest distance of the carrot ahead of a craft at this speed, m.
pub(super) fn most_lead_m(speed_mps: f64, params: &Params) -> f64 {
    let lead_s = 0.1 * f64::from(params.nav_carrot_lead_time);
    let most_m = MIN_LEAD_M.max(0.01 * f64::from(params.nav_carrot_lead_max));
    (speed_mps * lead_s).clamp(MIN_LEAD_M, most_m)
}

/// Returns the part of a turn by `turn_rad` that the nose has made `rest_m` before the gate; `None` before the turn.
fn turned(rest_m: f64, turn_rad: f64, params: &Params) -> Option<f64> {
    let begin_m = 0.01 * f64::from(params.nav_preturn_dist);
    let left = (rest_m - TURNED_M) / (begin_m - TURNED_M).max(1e-3);
    (rest_m < begin_m).then(|| wrap_pi(turn_rad) * (1.0 - left.clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NORTH: f64 = 0.0;

    fn craft(north_m: f64, speed_mps: f64) -> Motion {
        Motion { ne: Vector2::new(north_m, 0.0), speed_mps, heading_rad: NORTH }
    }

    /// A leg of 200 m to the north with a corner of 3 m/s at its end.
    struct Bench {
        line: Line,
        corner: Corner,
        params: Params,
        north_m: f64,
    }

    impl Bench {
        fn new() -> Self {
            let end = Vector2::new(200.0, 0.0);
            let line = Line::new(Vector2::zeros(), 0.0, end, &craft(0.0, 0.0));
            Self {
                line,
                corner: Corner { speed_mps: 3.0, gate_m: 5.0 },
                params: Params::default(),
                north_m: 0.0,
            }
        }

        /// Flies half a second behind the carrot until the waypoint is reached. Returns each update.
        fn fly(&mut self) -> Vec<Followed> {
            let mut all = Vec::new();
            let mut speed_mps = 0.0;
            while all.len() < 100_000 {
                let now = craft(self.north_m, speed_mps);
                let east = Some(std::f64::consts::FRAC_PI_2);
                let followed = self.line.follow(&now, &self.corner, east, 10.0, &self.params, 0.01);
                all.push(followed);
                if followed.is_reached {
                    break;
                }
                speed_mps += (2.0 * followed.lead_m - speed_mps).clamp(-0.03, 0.03);
                self.north_m += speed_mps * 0.01;
            }
            all
        }
    }

    #[test]
    fn the_carrot_speeds_up_leads_and_slows_down_before_the_corner() {
        let all = Bench::new().fly();
        let fastest = all.iter().map(|one| one.speed_mps).fold(0.0, f64::max);
        assert!((fastest - 10.0).abs() < 0.01, "{fastest}");
        let last = all.last().unwrap();
        assert!(last.is_reached && (3.0..4.0).contains(&last.speed_mps), "{last:?}");
        assert!((last.along_m - 195.0).abs() < 0.1, "{last:?}");
        let in_the_middle = all.iter().find(|one| one.along_m > 100.0).unwrap();
        assert!((4.0..=6.0).contains(&in_the_middle.lead_m), "{in_the_middle:?}");
        assert_eq!(in_the_middle.heading_rad, None);
    }

    #[test]
    fn the_nose_turns_to_the_next_leg_before_the_gate() {
        let all = Bench::new().fly();
        let at = |rest_m: f64| all.iter().find(|one| 195.0 - one.along_m <= rest_m).unwrap().heading_rad;
        assert_eq!(at(20.0), None);
        assert!(at(14.9).unwrap() < 0.1);
        assert!((at(5.0).unwrap() - std::f64::consts::FRAC_PI_2).abs() < 0.02);
    }

    #[test]
    fn a_craft_that_is_too_fast_is_waited_for() {
        let mut bench = Bench::new();
        bench.line = Line::new(Vector2::zeros(), 9.0, Vector2::new(200.0, 0.0), &craft(190.0, 9.0));
        let followed = bench.line.follow(&craft(190.0, 9.0), &bench.corner, None, 10.0, &bench.params, 0.01);
        assert!(bench.line.is_too_fast && followed.excess_mps > TOO_FAST_MPS);
        for _ in 0..500 {
            bench.line.follow(&craft(190.0, 4.0), &bench.corner, None, 10.0, &bench.params, 0.01);
        }
        assert!(!bench.line.is_too_fast);
    }

    #[test]
    fn a_nose_that_points_back_stops_the_carrot_and_is_turned() {
        let mut bench = Bench::new();
        let back = Motion { heading_rad: 3.0, ..craft(50.0, 0.0) };
        bench.line = Line::new(Vector2::zeros(), 0.0, Vector2::new(200.0, 0.0), &back);
        let followed = bench.line.follow(&back, &bench.corner, None, 10.0, &bench.params, 0.01);
        assert_eq!((followed.speed_mps, followed.heading_rad), (0.0, Some(NORTH)));
    }

    #[test]
    fn a_waypoint_passed_nearby_is_reached_and_one_passed_far_beside_is_not() {
        let bench = Bench::new();
        let beside = |east_m: f64| {
            let now = Motion { ne: Vector2::new(201.0, east_m), ..craft(0.0, 5.0) };
            let mut line = bench.line.clone();
            line.follow(&now, &bench.corner, None, 10.0, &bench.params, 0.01).is_reached
        };
        assert!(beside(7.9) && beside(-7.9) && !beside(8.1));
    }
}
