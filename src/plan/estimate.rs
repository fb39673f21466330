//! How long a plan is, in metres and seconds: an estimate from leg lengths, speeds and the altitudes that are waited for,
//! without wind, acceleration over ground and the shortened corners of FLYBY.

use crate::geo::{LatLon, distance_bearing};

use super::setpoint::{AltitudeSetpoint, SetpointLimits};
use super::{FlightPlan, Waypoint, WaypointType};

/// Slowest leg speed that a waypoint can ask for, m/s.
const SLOWEST_MPS: f64 = 1.0;

/// Slowest leg speed that a DELAY can make, m/s.
const SLOWEST_DELAYED_MPS: f64 = 0.1;

/// Least altitude error at which a HOLD begins, m.
const HOLD_ALTITUDE_M: f64 = 2.0;
/// How much nearer to it a craft may measure itself, m.
const MEASURED_M: f64 = 1.0;
/// How long a HOLD waits for an altitude that cannot be reached, s.
const HELD_OFF_S: f64 = 10.0;
/// A LAND reached this far above its altitude is approached vertically first, m; the approach ends this near to it, m.
const FAR_ABOVE_M: f64 = 2.0;
const NEAR_M: f64 = 0.5;
/// The vertical approach ends this far above `ap_landing_altitude_m` at the least, m.
const CLEARANCE_M: f64 = 5.0;

/// What the estimate needs to know about the craft, from its settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assumptions {
    /// `ap_max_velocity`, m/s.
    pub max_velocity_mps: f64,
    /// `alt_hold_climb_rate`, m/s.
    pub climb_mps: f64,
    /// `ap_landing_descent_rate`, m/s.
    pub landing_mps: f64,
    /// `ap_max_distance_from_home`, m; `None` = no fence.
    pub fence_m: Option<f64>,
    /// Height above home at which the mission begins, m.
    pub start_alt_m: f64,
    /// How long a full battery keeps the craft hovering, s; `None` = unknown.
    pub endurance_s: Option<f64>,
    /// What a touchdown asks of the throttle.
    pub touchdown_throttle: TouchdownThrottle,
    /// `ap_landing_altitude_m`.
    pub landing_alt_m: f64,
    /// `ap_min_nav_altitude_m`: below it the craft climbs on the spot first.
    pub min_nav_alt_m: f64,
    /// `ap_waypoint_arrival_radius`, m.
    pub arrival_radius_m: f64,
    /// `ap_waypoint_hold_radius`, m.
    pub hold_radius_m: f64,
    /// `ap_hold_orbit_radius`, m.
    pub orbit_radius_m: f64,
    /// `ap_max_turn_rate`, degrees/s.
    pub turn_rate_dps: f64,
    /// `ap_max_angle`, degrees.
    pub max_angle_deg: f64,
    /// `ap_velocity_buildup_max_pitch`, degrees.
    pub buildup_deg: f64,
    /// `ap_position_p`.
    pub position_p: f64,
}

/// The throttle condition of a touchdown: below `ap_hover_throttle` less `ap_landing_throttle_threshold`; µs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TouchdownThrottle {
    /// `ap_hover_throttle`; 0 = captured in flight.
    pub hover_us: f64,
    /// `ap_landing_throttle_threshold`.
    pub threshold_us: f64,
    /// `ap_throttle_min`: the autopilot commands no less.
    pub min_us: f64,
}

impl TouchdownThrottle {
    /// Whether the autopilot never commands so little.
    #[must_use]
    pub fn is_never_met(&self) -> bool {
        self.hover_us > 0.0 && self.hover_us - self.threshold_us <= self.min_us
    }
}

impl Default for TouchdownThrottle {
    fn default() -> Self {
        Self { hover_us: 1275.0, threshold_us: 100.0, min_us: 1100.0 }
    }
}

impl Default for Assumptions {
    /// The firmware's defaults, after the scripted pilot's climb.
    fn default() -> Self {
        Self {
            max_velocity_mps: 5.0,
            climb_mps: 5.0,
            landing_mps: 0.5,
            fence_m: None,
            start_alt_m: 10.0,
            endurance_s: None,
            touchdown_throttle: TouchdownThrottle::default(),
            landing_alt_m: 4.0,
            min_nav_alt_m: 5.0,
            arrival_radius_m: 5.0,
            hold_radius_m: 2.0,
            orbit_radius_m: 10.0,
            turn_rate_dps: 3.0,
            max_angle_deg: 50.0,
            buildup_deg: 8.0,
            position_p: 30.0,
        }
    }
}

impl Assumptions {
    /// The settings that change them.
    pub const SETTINGS: [&str; 16] = [
        "ap_max_velocity",
        "alt_hold_climb_rate",
        "ap_landing_descent_rate",
        "ap_max_distance_from_home",
        "ap_hover_throttle",
        "ap_landing_throttle_threshold",
        "ap_throttle_min",
        "ap_landing_altitude_m",
        "ap_min_nav_altitude_m",
        "ap_waypoint_arrival_radius",
        "ap_waypoint_hold_radius",
        "ap_hold_orbit_radius",
        "ap_max_turn_rate",
        "ap_max_angle",
        "ap_velocity_buildup_max_pitch",
        "ap_position_p",
    ];

    /// The defaults, changed by the lines `name = value` of a plan file.
    #[must_use]
    pub fn from_settings(lines: &[String]) -> Self {
        let mut assumptions = Self::default();
        for (name, value) in lines.iter().filter_map(|line| line.split_once('=')) {
            let Ok(value) = value.trim().parse::<u16>() else { continue };
            let value = f64::from(value);
            match name.trim().to_ascii_lowercase().as_str() {
                "ap_max_velocity" => assumptions.max_velocity_mps = value / 100.0,
                "alt_hold_climb_rate" if value > 0.0 => assumptions.climb_mps = value / 10.0,
                "ap_landing_descent_rate" => assumptions.landing_mps = value / 100.0,
                "ap_max_distance_from_home" => assumptions.fence_m = (value > 0.0).then_some(value),
                "ap_hover_throttle" => assumptions.touchdown_throttle.hover_us = value,
                "ap_landing_throttle_threshold" => assumptions.touchdown_throttle.threshold_us = value,
                "ap_throttle_min" => assumptions.touchdown_throttle.min_us = value,
                "ap_landing_altitude_m" => assumptions.landing_alt_m = value,
                "ap_min_nav_altitude_m" => assumptions.min_nav_alt_m = value,
                "ap_waypoint_arrival_radius" => assumptions.arrival_radius_m = value / 100.0,
                "ap_waypoint_hold_radius" => assumptions.hold_radius_m = value / 100.0,
                "ap_hold_orbit_radius" => assumptions.orbit_radius_m = value / 100.0,
                "ap_max_turn_rate" => assumptions.turn_rate_dps = value,
                "ap_max_angle" => assumptions.max_angle_deg = value,
                "ap_velocity_buildup_max_pitch" => assumptions.buildup_deg = value,
                "ap_position_p" => assumptions.position_p = value,
                _ => {}
            }
        }
        assumptions
    }

    /// Speed of the leg to a waypoint, m/s.
    pub(super) fn leg_speed_mps(&self, waypoint: &Waypoint) -> f64 {
        match waypoint.speed_cms {
            0 => self.max_velocity_mps,
            speed => (f64::from(speed) / 100.0).clamp(SLOWEST_MPS, self.max_velocity_mps.max(SLOWEST_MPS)),
        }
    }

    /// Slowest speed of a leg after a DELAY, m/s, when the leg is so long.
    pub(super) fn delayed_mps(&self, length_m: f64, delay_s: f64) -> f64 {
        (length_m / delay_s).max(SLOWEST_DELAYED_MPS)
    }

    /// What limits the altitude setpoint.
    #[must_use]
    pub fn setpoint_limits(&self) -> SetpointLimits {
        SetpointLimits {
            climb_mps: self.climb_mps,
            landing_mps: self.landing_mps,
            landing_alt_m: self.landing_alt_m,
        }
    }

    /// Moves the setpoint until a HOLD at this altitude begins; returns how long that takes, s.
    pub(super) fn wait_for_hold(&self, setpoint: &mut AltitudeSetpoint, alt_m: f64) -> f64 {
        let within_m = self.hold_radius_m.max(HOLD_ALTITUDE_M) + MEASURED_M;
        let waited = setpoint.reach(alt_m, &self.setpoint_limits(), within_m);
        if waited.is_finite() { waited } else { HELD_OFF_S }
    }
}

/// One waypoint of the estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegEstimate {
    /// Horizontal distance from the place before, m; `None` for modifiers.
    pub distance_m: Option<f64>,
    /// Bearing of the leg, degrees clockwise from north, where there is one.
    pub bearing_deg: Option<f64>,
    /// Altitude flown at, above home, m.
    pub alt_m: f64,
    /// Speed flown at, m/s; `None` where there is no distance to fly.
    pub speed_mps: Option<f64>,
    /// When the craft is done with the waypoint, seconds from the start; `None` when it never gets there or holds
    /// forever.
    pub done_s: Option<f64>,
}

/// An estimate for a plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanEstimate {
    /// One entry a waypoint.
    pub legs: Vec<LegEstimate>,
    /// Length of the path that is flown, m.
    pub distance_m: f64,
    /// Time from the start to the end of the mission, s; `None` when a HOLD lasts forever.
    pub time_s: Option<f64>,
}

/// Estimates a flight of the plan that begins above `home`.
#[must_use]
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

/// Where the craft is after some waypoints.
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
        let own_alt_m = f64::from(waypoint.alt_cm) / 100.0;
        let duration_s = f64::from(waypoint.duration_ds) / 10.0;
        match waypoint.kind {
            WaypointType::AltChange => self.alt_change_m = Some(own_alt_m),
            WaypointType::Delay => self.delay_s = Some(duration_s),
            WaypointType::YawRate => {}
            WaypointType::Flyover
            | WaypointType::Flyby
            | WaypointType::Hold
            | WaypointType::Land
            | WaypointType::Takeoff => return self.fly(waypoint, own_alt_m, duration_s, assumptions),
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
            let length_m = distance_m.hypot(alt_m - self.setpoint.altitude_m);
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
        self.landed |= waypoint.kind == WaypointType::Land;
        self.place = target;
        let bearing_deg = (distance_m > 0.0).then(|| bearing_rad.to_degrees());
        let speed_mps = (distance_m > 0.0).then_some(speed_mps);
        LegEstimate { distance_m: Some(distance_m), bearing_deg, alt_m, speed_mps, done_s }
    }

    /// Moves the altitude over a leg and the stay at its end; returns how long the stay takes, s. Of the types only HOLD and
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
        match waypoint.kind {
            WaypointType::Hold => {
                let waited_s = assumptions.wait_for_hold(setpoint, alt_m);
                setpoint.run(alt_m, &limits, duration_s);
                (waypoint.duration_ds > 0).then_some(waited_s + duration_s)
            }
            WaypointType::Takeoff => {
                let climb_s = setpoint.reach(alt_m, &limits, assumptions.hold_radius_m);
                setpoint.run(alt_m, &limits, duration_s);
                Some(duration_s + if climb_s.is_finite() { climb_s } else { 0.0 })
            }
            WaypointType::Land => {
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
            _ => Some(0.0),
        }
    }

    /// The clock, unless the mission is over already.
    fn done(&self) -> Option<f64> {
        self.clock_s.filter(|_| !self.landed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::offset_to_latlon;
    use nalgebra::Vector2;

    const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);

    fn waypoint(kind: WaypointType, north: f64, alt_m: i32, speed_cms: u16, duration_ds: u16) -> Waypoint {
        let position = offset_to_latlon(HOME, Vector2::new(north, 0.0));
        Waypoint { position, alt_cm: alt_m * 100, speed_cms, duration_ds, kind, ..Waypoint::default() }
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
        // 8.75 s to where it slows down, 3 s more, and the stay of 2 s.
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
        // With 0 the rate stays as it is.
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
        // It was flown in 58.9 s; the climb to 80 m was never finished.
        assert!(climb.time_s.is_some_and(|time_s| (45.0..58.9).contains(&time_s)), "{:?}", climb.time_s);
        let held = plan(&[
            waypoint(WaypointType::Hold, 30.0, 80, 1000, 10),
            waypoint(WaypointType::Land, 30.0, 80, 0, 0),
        ]);
        // The HOLD waits for its altitude, and so the landing begins there.
        assert!(held.time_s.is_some_and(|time_s| time_s > 14.0 + 1.0 + 156.0), "{:?}", held.time_s);
    }

    #[test]
    fn settings_change_the_assumptions() {
        let lines = [
            "ap_max_velocity = 700",
            "AP_LANDING_DESCENT_RATE = 100",
            "ap_max_distance_from_home = 300",
            "x",
        ];
        let assumptions = Assumptions::from_settings(&lines.map(str::to_owned));
        assert!(
            (assumptions.max_velocity_mps - 7.0).abs() < 1e-9 && (assumptions.landing_mps - 1.0).abs() < 1e-9
        );
        assert_eq!(assumptions.fence_m, Some(300.0));
        for name in Assumptions::SETTINGS {
            assert_ne!(
                Assumptions::from_settings(&[format!("{name} = 999")]),
                Assumptions::default(),
                "{name}"
            );
        }
    }
}
