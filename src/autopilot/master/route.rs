//! The plan that is flown, and the modifiers in front of its waypoints.

use nalgebra::Vector2;

use super::leg::End;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::{LatLon, local_offset};
use crate::plan::{FlightPlan, Seconds, Waypoint, WaypointType};
use crate::telemetry::PlanSource;

/// The slowest leg, and the slowest leg under a DELAY, m/s.
const SLOWEST_MPS: f64 = 1.0;
const SLOWEST_DELAYED_MPS: f64 = 0.1;

/// A DELAY that slows a leg down.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Delay {
    speed_mps: f64,
    left_s: f64,
}

/// The plan that is flown, its current waypoint, and what the modifiers before it have set.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Route {
    plan: FlightPlan,
    source: PlanSource,
    index: u8,
    /// The altitude of the next waypoint by ALT_CHANGE, m.
    altitude_m: Option<f64>,
    delay: Option<Delay>,
    /// The yaw rate by YAW_RATE, degrees/s, until the end of the mission.
    yaw_cap_dps: Option<f64>,
    /// The correction of all altitudes of the plan, m.
    added_m: f64,
    /// The place at which a TAKEOFF began.
    takeoff_ne: Vector2<f64>,
}

impl Route {
    /// Takes a plan, whose altitudes differ by `added_m` from those above home.
    pub(super) fn take(&mut self, plan: &FlightPlan, source: PlanSource, added_m: f64) {
        self.plan.clone_from(plan);
        *self = Self { plan: std::mem::take(&mut self.plan), source, added_m, ..Self::default() };
    }

    pub(super) fn plan(&self) -> &FlightPlan {
        &self.plan
    }

    pub(super) fn source(&self) -> PlanSource {
        self.source
    }

    pub(super) fn index(&self) -> u8 {
        self.index
    }

    pub(super) fn yaw_cap_dps(&self) -> Option<f64> {
        self.yaw_cap_dps
    }

    pub(super) fn current(&self) -> Option<&Waypoint> {
        self.plan.waypoints.get(usize::from(self.index))
    }

    /// Returns the index of the positional waypoint after the current one.
    pub(super) fn following(&self) -> Option<u8> {
        self.positional_from(self.index.saturating_add(1))
    }

    fn positional_from(&self, from: u8) -> Option<u8> {
        let rest = (from..).zip(self.plan.waypoints.iter().skip(usize::from(from)));
        let mut positional = rest.filter(|(_, waypoint)| waypoint.kind.is_positional());
        positional.next().map(|(index, _)| index)
    }

    /// Goes to the first positional waypoint from `from` on and applies the modifiers before it. Returns `false` if there is
    /// none.
    pub(super) fn go_to(&mut self, from: u8, now: &NavInputs, params: &Params) -> bool {
        let Some(index) = self.positional_from(from) else { return false };
        (self.altitude_m, self.delay) = (None, None);
        let mut delay_s = None;
        for at in from..index {
            let Some(modifier) = self.plan.waypoints.get(usize::from(at)) else { break };
            match modifier.kind {
                WaypointType::AltChange => self.altitude_m = Some(modifier.altitude.above_home_m()),
                WaypointType::Delay => delay_s = Some(modifier.duration.get()),
                // 0 removes the cap.
                WaypointType::YawRate => {
                    self.yaw_cap_dps = Some(modifier.yaw_rate_dps).filter(|rate| *rate > 0).map(f64::from);
                }
                _ => {}
            }
        }
        self.index = index;
        self.takeoff_ne = now.pos_ne;
        if let (Some(time_s), Some(end)) = (delay_s, self.end(now)) {
            let height_m = end.altitude_m - now.alt_m;
            let length_m = (end.ne - now.pos_ne).push(height_m).norm();
            let own_mps = self.own_mps(params);
            let speed_mps = (length_m / time_s.max(0.1)).clamp(SLOWEST_DELAYED_MPS, own_mps);
            self.delay = Some(Delay { speed_mps, left_s: time_s });
        }
        true
    }

    /// Returns the time for which the craft stays at the current waypoint, s; infinite for a HOLD without an end.
    pub(super) fn hold_s(&self) -> Option<f64> {
        let waypoint = self.current()?;
        Some(match (waypoint.kind, waypoint.duration) {
            (WaypointType::Hold, duration) if duration.is_zero() => f64::INFINITY,
            (WaypointType::Hold, duration) if duration <= Seconds::AT_ONCE => 0.0,
            (_, duration) => duration.get(),
        })
    }

    /// Returns the speed of the leg, m/s, `dt` seconds after the last call.
    pub(super) fn cruise_mps(&mut self, params: &Params, dt: f64) -> f64 {
        let own_mps = self.own_mps(params);
        let Some(delay) = &mut self.delay else { return own_mps };
        delay.left_s -= dt;
        if delay.left_s > 0.0 {
            return delay.speed_mps;
        }
        self.delay = None;
        own_mps
    }

    fn own_mps(&self, params: &Params) -> f64 {
        let own = self.current().and_then(|waypoint| waypoint.speed.own_mps());
        own.unwrap_or_else(|| params.max_velocity_mps()).max(SLOWEST_MPS)
    }

    /// Returns the end of the current leg; `None` without a waypoint.
    pub(super) fn end(&self, now: &NavInputs) -> Option<End> {
        let waypoint = self.current()?;
        let place = |position: LatLon| local_offset(now.origin, position);
        let next = self.following().and_then(|index| self.plan.waypoints.get(usize::from(index)));
        let is_takeoff = waypoint.kind == WaypointType::Takeoff;
        Some(End {
            ne: if is_takeoff { self.takeoff_ne } else { place(waypoint.position) },
            altitude_m: self.altitude_m.unwrap_or_else(|| waypoint.altitude.above_home_m()) + self.added_m,
            kind: waypoint.kind,
            next: next.map(|next| place(next.position)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::offset_to_latlon;
    use crate::plan::{Altitude, LegSpeed};

    fn waypoint(kind: WaypointType, north_m: f64) -> Waypoint {
        let home = NavInputs::hovering().origin;
        Waypoint {
            kind,
            position: offset_to_latlon(home, Vector2::new(north_m, 0.0)),
            altitude: Altitude::above_home(320.0),
            speed: LegSpeed::from_mps(5.0),
            ..Waypoint::default()
        }
    }

    fn route(waypoints: &[Waypoint]) -> (Route, NavInputs, Params) {
        let mut plan = FlightPlan::default();
        plan.waypoints.extend(waypoints.iter().copied());
        let (mut route, now, params) = (Route::default(), NavInputs::hovering(), Params::default());
        route.take(&plan, PlanSource::Stored, -300.0);
        assert!(route.go_to(0, &now, &params));
        (route, now, params)
    }

    #[test]
    fn altitudes_count_from_the_reference_and_an_alt_change_is_for_the_next_waypoint_only() {
        let change =
            Waypoint { altitude: Altitude::above_home(330.0), ..waypoint(WaypointType::AltChange, 0.0) };
        let (mut route, now, params) =
            route(&[change, waypoint(WaypointType::Flyover, 50.0), waypoint(WaypointType::Land, 80.0)]);
        let end = route.end(&now).unwrap();
        assert_eq!((route.index(), end.altitude_m, end.kind), (1, 30.0, WaypointType::Flyover));
        assert!((end.ne.x - 50.0).abs() < 0.02 && end.next.is_some());
        assert!(route.go_to(2, &now, &params));
        assert_eq!(route.end(&now).map(|end| (end.altitude_m, end.next)), Some((20.0, None)));
        assert!(!route.go_to(3, &now, &params));
    }

    #[test]
    fn a_delay_slows_its_leg_down_until_its_time_is_over() {
        let delay = Waypoint { duration: Seconds::new(25.0), ..waypoint(WaypointType::Delay, 0.0) };
        let (mut route, _, params) = route(&[delay, waypoint(WaypointType::Land, 50.0)]);
        assert!((route.cruise_mps(&params, 0.01) - 2.0).abs() < 0.01);
        assert_eq!(route.cruise_mps(&params, 25.0), 5.0);
    }

    #[test]
    fn a_yaw_rate_stays_and_a_takeoff_rises_where_the_craft_is() {
        let yaw = Waypoint { yaw_rate_dps: 12, ..waypoint(WaypointType::YawRate, 0.0) };
        let (mut route, mut now, params) =
            route(&[yaw, waypoint(WaypointType::Takeoff, 99.0), waypoint(WaypointType::Land, 50.0)]);
        assert_eq!(route.end(&now).map(|end| end.ne), Some(now.pos_ne));
        now.pos_ne.x = 3.0;
        route.go_to(2, &now, &params);
        assert_eq!(route.yaw_cap_dps(), Some(12.0));
    }

    #[test]
    fn a_yaw_rate_of_zero_removes_the_cap() {
        let yaw = |yaw_rate_dps| Waypoint { yaw_rate_dps, ..waypoint(WaypointType::YawRate, 0.0) };
        let land = waypoint(WaypointType::Land, 50.0);
        let (mut route, now, params) = route(&[yaw(12), land, yaw(0), land]);
        assert_eq!(route.yaw_cap_dps(), Some(12.0));
        route.go_to(2, &now, &params);
        assert_eq!(route.yaw_cap_dps(), None);
    }
}
