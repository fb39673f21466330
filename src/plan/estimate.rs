//! An estimate of the length of a plan in metres and seconds. It uses leg lengths, speeds and the altitudes for which
//! the craft waits. It ignores wind, acceleration over ground and the shorter corners of FLYBY.

mod assumptions;
mod return_flight;

use crate::geo::{LatLon, distance_bearing};
use crate::math;

use super::setpoint::AltitudeSetpoint;
use super::{FlightPlan, Modifier, Then, Waypoint};
pub use assumptions::{Assumptions, MAX_ALTITUDE_M, SettingSource, TouchdownThrottle};
pub use return_flight::{ReturnFlight, ReturnMode};

/// A craft that reaches a LAND at least this far above its altitude first approaches it vertically, m. That approach
/// ends within `NEAR_M` of the altitude.
const FAR_ABOVE_M: f64 = 2.0;
const NEAR_M: f64 = 0.5;
/// The vertical approach ends at least this far above `ap_landing_altitude_m`, m.
const CLEARANCE_M: f64 = 5.0;

/// One waypoint of the estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegEstimate {
    /// Horizontal distance from the previous place, m; `None` for modifiers.
    pub distance_m: Option<f64>,
    /// Bearing of the leg, degrees clockwise from north, if there is one.
    pub bearing_deg: Option<f64>,
    /// Altitude of the leg above home, m.
    pub alt_m: f64,
    /// Speed of the leg, m/s; `None` if there is no distance to fly.
    pub speed_mps: Option<f64>,
    /// The time at which the craft is done with the waypoint, seconds from the start; `None` if it never gets there or
    /// holds forever.
    pub done_s: Option<f64>,
}

/// An estimate for a plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanEstimate {
    /// One entry for each waypoint.
    pub legs: Vec<LegEstimate>,
    /// Length of the flown path, m.
    pub distance_m: f64,
    /// Time from the start to the end of the mission, s; `None` if a HOLD lasts forever.
    pub time_s: Option<f64>,
}

/// Estimates a flight of the plan that begins above `home`.
pub fn estimate(plan: &FlightPlan, home: LatLon, assumptions: &Assumptions) -> PlanEstimate {
    let mut walk = Walk {
        place: home,
        setpoint: AltitudeSetpoint::at(assumptions.start_alt_m),
        clock_s: Some(0.0),
        landed: false,
        alt_change_m: None,
        delay_s: None,
        distance_m: 0.0,
    };
    let legs = plan.waypoints.iter().map(|waypoint| walk.leg(waypoint, assumptions)).collect();
    PlanEstimate { legs, distance_m: walk.distance_m, time_s: walk.clock_s }
}

/// The state of the craft after some waypoints.
struct Walk {
    place: LatLon,
    setpoint: AltitudeSetpoint,
    clock_s: Option<f64>,
    landed: bool,
    alt_change_m: Option<f64>,
    delay_s: Option<f64>,
    distance_m: f64,
}

impl Walk {
    fn leg(&mut self, waypoint: &Waypoint, assumptions: &Assumptions) -> LegEstimate {
        let own_alt_m = waypoint.altitude.above_home_m();
        let duration_s = waypoint.duration.get();
        match waypoint.kind.modifier() {
            Some(Modifier::Altitude) => self.alt_change_m = Some(own_alt_m),
            Some(Modifier::Delay) => self.delay_s = Some(duration_s),
            Some(Modifier::YawRate) => {}
            None => return self.fly(waypoint, own_alt_m, duration_s, assumptions),
        }
        LegEstimate {
            distance_m: None,
            bearing_deg: None,
            alt_m: own_alt_m,
            speed_mps: None,
            done_s: self.done(),
        }
    }

    fn fly(
        &mut self,
        waypoint: &Waypoint,
        own_alt_m: f64,
        duration_s: f64,
        assumptions: &Assumptions,
    ) -> LegEstimate {
        let target = if waypoint.kind.uses_position() { waypoint.position } else { self.place };
        let alt_m = self.alt_change_m.take().unwrap_or(own_alt_m);
        let (distance_m, bearing_rad) = distance_bearing(self.place, target);
        let mut speed_mps = assumptions.leg_speed_mps(waypoint);
        if let Some(delay_s) = self.delay_s.take().filter(|&delay_s| delay_s > 0.0) {
            let length_m = math::hypot(distance_m, alt_m - self.setpoint.altitude_m);
            speed_mps = speed_mps.min(assumptions.delayed_mps(length_m, delay_s));
        }
        let leg_s = distance_m / speed_mps;
        let stay_s = self.stay(waypoint, alt_m, leg_s, duration_s, assumptions);
        if !self.landed && self.clock_s.is_some() {
            self.distance_m += distance_m;
        }
        if !self.landed {
            self.clock_s = self.clock_s.zip(stay_s).map(|(clock_s, stay_s)| clock_s + leg_s + stay_s);
        }
        let done_s = self.done();
        self.landed |= waypoint.kind.capability().then == Then::Land;
        self.place = target;
        let bearing_deg = (distance_m > 0.0).then(|| bearing_rad.to_degrees());
        let speed_mps = (distance_m > 0.0).then_some(speed_mps);
        LegEstimate { distance_m: Some(distance_m), bearing_deg, alt_m, speed_mps, done_s }
    }

    /// Moves the altitude over a leg and the stay at its end, and returns the time of the stay, s. Only HOLD and
    /// TAKEOFF wait for their altitude.
    fn stay(
        &mut self,
        waypoint: &Waypoint,
        alt_m: f64,
        leg_s: f64,
        duration_s: f64,
        assumptions: &Assumptions,
    ) -> Option<f64> {
        let limits = assumptions.setpoint_limits();
        let setpoint = &mut self.setpoint;
        setpoint.run(alt_m, &limits, leg_s);
        match waypoint.kind.capability().then {
            Then::Hold => {
                let waited_s = assumptions.wait_for_hold(setpoint, alt_m);
                setpoint.run(alt_m, &limits, duration_s);
                (!waypoint.duration.is_zero()).then_some(waited_s + duration_s)
            }
            Then::Loiter => {
                let climb_s = setpoint.reach(alt_m, &limits, assumptions.hold_radius_m);
                setpoint.run(alt_m, &limits, duration_s);
                Some(duration_s + if climb_s.is_finite() { climb_s } else { 0.0 })
            }
            Then::Land => {
                setpoint.run(alt_m, &limits, duration_s);
                let floor_m = alt_m.max(assumptions.landing_alt_m + CLEARANCE_M);
                let approach_s = if setpoint.altitude_m > floor_m + FAR_ABOVE_M {
                    setpoint.reach(floor_m, &limits, NEAR_M)
                } else {
                    0.0
                };
                let descent_s = setpoint.altitude_m.max(0.0) / assumptions.landing_mps;
                Some(duration_s + approach_s + descent_s)
            }
            Then::GoOn => Some(0.0),
        }
    }

    /// Returns the clock, unless the mission is already over.
    fn done(&self) -> Option<f64> {
        self.clock_s.filter(|_| !self.landed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::offset_to_latlon;
    use crate::plan::WaypointType;
    use crate::plan::record::WaypointRecord;
    use nalgebra::Vector2;

    const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);

    fn waypoint(kind: WaypointType, north: f64, alt_m: i32, speed_cms: u16, duration_ds: u16) -> Waypoint {
        let position = offset_to_latlon(HOME, Vector2::new(north, 0.0));
        WaypointRecord {
            position,
            alt_cm: alt_m * 100,
            speed: speed_cms,
            duration_ds,
            kind,
            ..Default::default()
        }
        .into()
    }

    fn plan(waypoints: &[Waypoint]) -> PlanEstimate {
        let mut plan = FlightPlan::default();
        plan.waypoints.extend(waypoints.iter().copied());
        estimate(&plan, HOME, &Assumptions::default())
    }

    #[test]
    fn legs_add_up() {
        let estimate = plan(&[
            waypoint(WaypointType::Flyover, 100.0, 10, 500, 0),
            waypoint(WaypointType::Hold, 100.0, 20, 0, 300),
            waypoint(WaypointType::Land, 0.0, 20, 0, 0),
            waypoint(WaypointType::Flyby, 500.0, 20, 0, 0),
        ]);
        // 100 m at 5 m/s; 8 of 10 m climb and 30 s; 100 m at 5 m/s and 20 m at 0.5 m/s.
        let done: Vec<_> = estimate.legs.iter().map(|leg| leg.done_s.map(f64::round)).collect();
        assert_eq!(done, [Some(20.0), Some(53.0), Some(113.0), None]);
        assert!((estimate.distance_m - 200.0).abs() < 0.1);
        assert!((estimate.time_s.unwrap() - 113.2).abs() < 0.3, "{:?}", estimate.time_s);
        assert!(estimate.legs[2].bearing_deg.is_some_and(|bearing| (bearing - 180.0).abs() < 0.1));
        assert_eq!(estimate.legs[1].bearing_deg, None);
    }

    #[test]
    fn an_endless_hold_ends_the_clock() {
        let estimate = plan(&[
            waypoint(WaypointType::Hold, 0.0, 10, 0, 0),
            waypoint(WaypointType::Flyover, 100.0, 10, 0, 0),
        ]);
        assert_eq!(estimate.time_s, None);
        assert!(estimate.distance_m < 0.1);
    }

    #[test]
    fn modifiers_act_on_the_next_leg_only() {
        let estimate = plan(&[
            waypoint(WaypointType::AltChange, 0.0, 30, 0, 0),
            waypoint(WaypointType::Delay, 0.0, 0, 0, 600),
            waypoint(WaypointType::Flyover, 60.0, 10, 500, 0),
            waypoint(WaypointType::Flyover, 120.0, 10, 500, 0),
        ]);
        assert_eq!(estimate.legs[0].distance_m, None);
        assert!((estimate.legs[2].alt_m - 30.0).abs() < 1e-9 && (estimate.legs[3].alt_m - 10.0).abs() < 1e-9);
        // The delayed leg is 63 m long in space: 63 m in 60 s; on the ground 60 m of it.
        assert!((estimate.legs[2].speed_mps.unwrap() - 63.2 / 60.0).abs() < 0.01);
        assert!((estimate.legs[3].speed_mps.unwrap() - 5.0).abs() < 1e-9);
    }

    #[test]
    fn a_takeoff_stays_where_it_is() {
        let estimate = plan(&[waypoint(WaypointType::Takeoff, 9999.0, 60, 0, 20)]);
        assert!(estimate.distance_m.abs() < 1e-9);
        // 8.75 s until it slows down, 3 s more, and the stay of 2 s.
        assert!((estimate.time_s.unwrap() - 13.75).abs() < 0.2, "{:?}", estimate.time_s);
    }

    #[test]
    fn a_craft_that_climbs_slower_takes_longer_up_and_down() {
        let time_s = |setting: &str| {
            let mut plan = FlightPlan::default();
            plan.waypoints.extend([
                waypoint(WaypointType::Takeoff, 0.0, 50, 0, 0),
                waypoint(WaypointType::Flyover, 100.0, 50, 0, 0),
                waypoint(WaypointType::Flyover, 110.0, 30, 0, 0),
            ]);
            estimate(&plan, HOME, &Assumptions::from_settings(&[setting.to_owned()])).time_s.unwrap()
        };
        // 38 of 40 m up, 100 m on the level at 5 m/s; the FLYOVER after it does not wait for its altitude.
        let says = |setting, climb_s: f64| {
            let time_s = time_s(setting);
            assert!((time_s - (climb_s + 22.0)).abs() < 0.2, "{setting}: {time_s} s");
        };
        says("alt_hold_climb_rate = 50", 9.75);
        says("alt_hold_climb_rate = 20", 19.5);
        says("ALT_HOLD_CLIMB_RATE=1", 380.0);
        // With 0 the rate is unchanged.
        says("alt_hold_climb_rate = 0", 9.75);
    }

    #[test]
    fn a_landing_after_a_steep_leg_begins_where_the_craft_is_then() {
        let mut steep = FlightPlan::default();
        steep.waypoints.extend([
            waypoint(WaypointType::Flyover, 55.7, 15, 1000, 0),
            waypoint(WaypointType::Flyover, 85.7, 80, 1000, 0),
            waypoint(WaypointType::Land, 0.0, 15, 0, 0),
        ]);
        let settings = ["ap_max_velocity = 1000".to_owned()];
        let climb = estimate(&steep, HOME, &Assumptions::from_settings(&settings));
        // The real flight took 58.9 s; the craft never finished the climb to 80 m.
        assert!(climb.time_s.is_some_and(|time_s| (45.0..58.9).contains(&time_s)), "{:?}", climb.time_s);
        let held = plan(&[
            waypoint(WaypointType::Hold, 30.0, 80, 1000, 10),
            waypoint(WaypointType::Land, 30.0, 80, 0, 0),
        ]);
        // The HOLD waits for its altitude, so the landing begins there.
        assert!(held.time_s.is_some_and(|time_s| time_s > 14.0 + 1.0 + 156.0), "{:?}", held.time_s);
    }
}
