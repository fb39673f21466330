//! The progress of a craft towards its waypoint, for a mission that is given up without a reason.

use nalgebra::Vector2;

use crate::math;
use crate::signals::SimTime;
use crate::telemetry::NavState;

/// The distance by which a craft must come closer to make progress, m.
const CLOSER_M: f64 = 1.0;
/// The shortest time without progress that is reported, s.
const STALLED_S: f64 = 5.0;
/// The shortest distance away from the waypoint that is reported, m.
const AWAY_M: f64 = 5.0;
/// The speed from which the course has a meaning, m/s, and the angle between it and the heading that is reported,
/// degrees.
const MOVING_MPS: f64 = 1.0;
const AGAINST_DEG: f64 = 90.0;

/// The progress towards the present waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Progress {
    wp: Option<u8>,
    closest_m: f64,
    closest_at: SimTime,
    now: SimTime,
    distance_m: f64,
    /// The angle between heading and course, if the craft moves, degrees.
    against_deg: Option<f64>,
    /// `true` after the end of the engagement in which the last look was.
    is_over: bool,
}

impl Progress {
    /// Takes the state of the mission. Only a craft on the way to its waypoint makes progress: one that holds or lands begins
    /// from the start again. The last looks before the end are kept for the verdict, until the next engagement.
    pub(super) fn follow(&mut self, state: NavState) {
        match state {
            NavState::Idle => self.is_over = true,
            NavState::Approaching if !self.is_over => {}
            _ => *self = Self::default(),
        }
    }

    /// Takes the way to the waypoint and the velocity (north, east), and the heading.
    pub(super) fn look(
        &mut self,
        now: SimTime,
        wp: u8,
        way: Vector2<f64>,
        velocity: Vector2<f64>,
        heading_deg: f64,
    ) {
        self.distance_m = way.norm();
        self.now = now;
        if self.wp != Some(wp) || self.distance_m <= self.closest_m - CLOSER_M {
            (self.wp, self.closest_m, self.closest_at) = (Some(wp), self.distance_m, now);
        }
        let course_deg = math::atan2(velocity.y, velocity.x).to_degrees();
        let apart_deg = (heading_deg - course_deg + 180.0).rem_euclid(360.0) - 180.0;
        self.against_deg = (velocity.norm() >= MOVING_MPS).then_some(apart_deg.abs());
    }

    /// Returns what the last look before the end showed; `None` if the craft made progress.
    pub(super) fn sentence(&self) -> Option<String> {
        let wp = self.wp?;
        let mut parts = Vec::new();
        let away_m = self.distance_m - self.closest_m;
        let stalled_s = self.now.seconds_since(self.closest_at);
        if away_m >= AWAY_M {
            parts.push(format!("moved away from waypoint {wp} by {away_m:.0} m"));
        }
        if stalled_s >= STALLED_S {
            parts.push(format!("came no closer to waypoint {wp} for {stalled_s:.0} s"));
        }
        if let Some(against) = self.against_deg.filter(|against| *against >= AGAINST_DEG) {
            parts.push(format!("pointed {against:.0}° away from its course"));
        }
        (!parts.is_empty()).then(|| format!("before that the craft {}", parts.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(seconds: u64, way_m: impl Fn(f64) -> f64, north_mps: f64) -> Option<String> {
        let mut progress = Progress::default();
        for second in 0..=seconds {
            let way = Vector2::new(way_m(second as f64), 0.0);
            progress.look(SimTime(second * 1_000_000), 2, way, Vector2::new(north_mps, 0.0), 0.0);
        }
        progress.sentence()
    }

    #[test]
    fn a_mission_given_up_without_a_reason_says_what_the_craft_did() {
        assert_eq!(after(30, |s| 100.0 - 3.0 * s, 3.0), None);
        let stalled = "before that the craft came no closer to waypoint 2 for 30 s";
        assert_eq!(after(30, |_| 50.0, 0.0).as_deref(), Some(stalled));
        let away = "before that the craft moved away from waypoint 2 by 40 m, came no closer to waypoint 2 for 20 s, pointed \
                    180° away from its course";
        assert_eq!(after(20, |s| 10.0 + 2.0 * s, -2.0).as_deref(), Some(away));
    }

    #[test]
    fn a_craft_that_holds_or_lands_as_planned_is_not_said_to_make_no_progress() {
        let mut progress = Progress::default();
        let mut fly = |seconds: std::ops::Range<u64>, state| {
            for second in seconds {
                progress.follow(state);
                if state == NavState::Approaching {
                    let way = Vector2::new(50.0, 0.0);
                    progress.look(SimTime(second * 1_000_000), 3, way, Vector2::zeros(), 0.0);
                }
            }
            progress.sentence()
        };
        let stalled = |seconds: u64| {
            Some(format!("before that the craft came no closer to waypoint 3 for {seconds} s"))
        };
        assert_eq!(fly(0..11, NavState::Approaching), stalled(10));
        assert_eq!(fly(11..40, NavState::Holding), None);
        assert_eq!(fly(40..60, NavState::Landing), None);
        assert_eq!(fly(60..68, NavState::Approaching), stalled(7));
        assert_eq!(fly(68..80, NavState::Idle), stalled(7), "for the verdict after the end");
        assert_eq!(fly(80..83, NavState::Approaching), None, "a new engagement");
    }
}
