//! Holding a place: the patterns of a HOLD, and coming to rest after a mission.

use nalgebra::Vector2;

use crate::autopilot::params::Params;
use crate::math;
use crate::plan::HoldPattern;

/// The most that the target of a pattern turns, rad/s.
pub const PATTERN_RPS: f64 = 0.25;
/// The interval at which the target of a pattern moves, s.
const PATTERN_STEP_S: f64 = 0.2;
/// The speed below which a pattern begins, m/s, and the time after the arrival at which it begins anyway, s.
const SLOW_MPS: f64 = 1.5;
const WAIT_S: f64 = 5.0;
/// The speed above which a hold begins by braking, m/s, and the longest time that it takes, s.
const BRAKE_MPS: f64 = 1.0;
const BRAKE_S: f64 = 1.0;

/// A pattern around the waypoint of a HOLD.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Pattern {
    /// The phase of the target, rad; `None` until it begins.
    phase_rad: Option<f64>,
    waited_s: f64,
    since_step_s: f64,
}

impl Pattern {
    /// Returns the phase of the target, rad; `None` until the pattern begins.
    pub(super) fn phase_rad(&self) -> Option<f64> {
        self.phase_rad
    }

    /// Returns the target relative to the place, north and east, m, after `dt` seconds; `None` if it is the place itself.
    /// `away` is the craft relative to the place.
    pub(super) fn follow(
        &mut self,
        pattern: HoldPattern,
        away: Vector2<f64>,
        speed_mps: f64,
        cruise_mps: f64,
        params: &Params,
        dt: f64,
    ) -> Option<Vector2<f64>> {
        let radius_m = params.hold_radius_m();
        self.waited_s += dt;
        let phase_rad = match self.phase_rad {
            Some(phase_rad) => {
                self.since_step_s += dt;
                let path_mps = cruise_mps.min(PATTERN_RPS * radius_m);
                let is_due = self.since_step_s >= PATTERN_STEP_S;
                let step_s = if is_due { std::mem::take(&mut self.since_step_s) } else { 0.0 };
                phase_rad + path_mps / radius_m * step_s
            }
            None if speed_mps < SLOW_MPS || self.waited_s >= WAIT_S => match pattern {
                HoldPattern::None => return None,
                // Anticlockwise seen from above, from where the craft is.
                HoldPattern::Orbit => math::atan2(away.x, away.y),
                HoldPattern::Figure8 => 0.0,
            },
            None => return None,
        };
        self.phase_rad = Some(phase_rad.rem_euclid(std::f64::consts::TAU));
        let (sin, cos) = math::sin_cos(phase_rad);
        match pattern {
            HoldPattern::None => None,
            HoldPattern::Orbit => Some(radius_m * Vector2::new(sin, cos)),
            HoldPattern::Figure8 => Some(radius_m * Vector2::new(sin * cos, sin)),
        }
    }
}

/// The entry into the hold of a place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stop {
    place: Vector2<f64>,
    /// The velocity at the begin; `None` once the craft has stopped.
    entry: Option<Vector2<f64>>,
    braked_s: f64,
}

impl Stop {
    /// Begins to hold with this place and velocity, m and m/s.
    pub(super) fn new(ne: Vector2<f64>, vel_ne: Vector2<f64>) -> Self {
        Self { place: ne, entry: (vel_ne.norm() > BRAKE_MPS).then_some(vel_ne), braked_s: 0.0 }
    }

    /// Returns the place to hold, and `true` while the craft brakes. The place follows a craft that brakes.
    pub(super) fn follow(
        &mut self,
        ne: Vector2<f64>,
        vel_ne: Vector2<f64>,
        params: &Params,
        dt: f64,
    ) -> (Vector2<f64>, bool) {
        if let Some(entry) = self.entry {
            self.place = ne;
            self.braked_s += dt;
            let is_slow = vel_ne.norm() < 0.01 * f64::from(params.stop_threshold);
            if is_slow || vel_ne.dot(&entry) < 0.0 || self.braked_s >= BRAKE_S {
                self.entry = None;
            }
        }
        (self.place, self.entry.is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(pattern: HoldPattern, away: Vector2<f64>, seconds: f64) -> Vec<Vector2<f64>> {
        let (mut state, params) = (Pattern::default(), Params::default());
        let steps = (seconds / 0.01) as usize;
        (0..steps).filter_map(|_| state.follow(pattern, away, 0.0, 5.0, &params, 0.01)).collect()
    }

    #[test]
    fn an_orbit_has_the_hold_radius_and_turns_anticlockwise_from_the_craft_at_a_quarter_radian_a_second() {
        let all = points(HoldPattern::Orbit, Vector2::new(0.0, 3.0), 10.01);
        assert!((all[0] - Vector2::new(0.0, 2.0)).norm() < 1e-9, "east, where the craft is: {}", all[0]);
        assert!(all.iter().all(|point| (point.norm() - 2.0).abs() < 1e-9));
        let last = all.last().unwrap();
        let phase = last.x.atan2(last.y);
        assert!((phase - 2.5).abs() < 0.06, "{phase}");
    }

    #[test]
    fn a_figure_of_eight_crosses_its_place() {
        let all = points(HoldPattern::Figure8, Vector2::zeros(), 26.0);
        let most = |axis: usize| all.iter().map(|point| point[axis].abs()).fold(0.0, f64::max);
        assert!((most(1) - 2.0).abs() < 0.01 && (most(0) - 1.0).abs() < 0.01, "{} {}", most(0), most(1));
    }

    #[test]
    fn a_pattern_waits_for_a_slow_craft_but_not_for_ever() {
        let (mut state, params) = (Pattern::default(), Params::default());
        let first = (0..1000).find(|_| {
            state.follow(HoldPattern::Orbit, Vector2::new(1.0, 0.0), 3.0, 5.0, &params, 0.01).is_some()
        });
        assert!((490..=500).contains(&first.unwrap()), "{first:?}");
    }

    #[test]
    fn a_fast_craft_brakes_and_holds_where_it_stops() {
        let params = Params::default();
        let mut stop = Stop::new(Vector2::zeros(), Vector2::new(5.0, 0.0));
        let at = |x: f64| Vector2::new(x, 0.0);
        assert_eq!(stop.follow(at(1.0), at(4.0), &params, 0.3), (at(1.0), true));
        assert_eq!(stop.follow(at(2.0), at(0.05), &params, 0.3), (at(2.0), false));
        assert_eq!(stop.follow(at(2.5), at(0.2), &params, 0.3), (at(2.0), false));
        let mut slow = Stop::new(at(1.0), at(0.9));
        assert_eq!(slow.follow(at(2.0), at(0.9), &params, 0.01), (at(1.0), false));
    }

    #[test]
    fn braking_ends_after_a_second_or_when_the_craft_turns_back() {
        let params = Params::default();
        let velocity = Vector2::new(5.0, 0.0);
        let mut late = Stop::new(Vector2::zeros(), velocity);
        let braking = (0..200).take_while(|_| late.follow(velocity, velocity, &params, 0.01).1).count();
        assert!((98..=100).contains(&braking), "{braking}");
        let mut back = Stop::new(Vector2::zeros(), velocity);
        assert!(!back.follow(velocity, -velocity, &params, 0.01).1);
    }
}
