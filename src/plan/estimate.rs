//! How long a plan is, in metres and seconds: an estimate from leg lengths and speeds, without wind, acceleration and the
//! shortened corners of FLYBY.

use crate::geo::{LatLon, distance_bearing};

use super::{FlightPlan, Waypoint, WaypointType};

/// Slowest leg speed that a waypoint can ask for, m/s.
const SLOWEST_MPS: f64 = 1.0;

/// Slowest leg speed that a DELAY can make, m/s.
const SLOWEST_DELAYED_MPS: f64 = 0.1;

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
        }
    }
}

impl Assumptions {
    /// The settings that change them.
    pub const SETTINGS: [&str; 7] = [
        "ap_max_velocity",
        "alt_hold_climb_rate",
        "ap_landing_descent_rate",
        "ap_max_distance_from_home",
        "ap_hover_throttle",
        "ap_landing_throttle_threshold",
        "ap_throttle_min",
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
                _ => {}
            }
        }
        assumptions
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
        alt_m: assumptions.start_alt_m,
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
    alt_m: f64,
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
        let climb_m = (alt_m - self.alt_m).abs();
        let mut speed_mps = match waypoint.speed_cms {
            0 => assumptions.max_velocity_mps,
            speed => {
                (f64::from(speed) / 100.0).clamp(SLOWEST_MPS, assumptions.max_velocity_mps.max(SLOWEST_MPS))
            }
        };
        if let Some(delay_s) = self.delay_s.take().filter(|&delay_s| delay_s > 0.0) {
            speed_mps = speed_mps.min((distance_m.hypot(climb_m) / delay_s).max(SLOWEST_DELAYED_MPS));
        }
        let leg_s = (distance_m / speed_mps).max(climb_m / assumptions.climb_mps);
        let stay_s = match waypoint.kind {
            WaypointType::Hold if waypoint.duration_ds == 0 => None,
            WaypointType::Hold | WaypointType::Takeoff => Some(duration_s),
            WaypointType::Land => Some(duration_s + alt_m.max(0.0) / assumptions.landing_mps),
            _ => Some(0.0),
        };
        if !self.landed && self.clock_s.is_some() {
            self.distance_m += distance_m;
        }
        if !self.landed {
            self.clock_s = self.clock_s.zip(stay_s).map(|(clock_s, stay_s)| clock_s + leg_s + stay_s);
        }
        let done_s = self.done();
        self.landed |= waypoint.kind == WaypointType::Land;
        (self.place, self.alt_m) = (target, alt_m);
        let bearing_deg = (distance_m > 0.0).then(|| bearing_rad.to_degrees());
        let speed_mps = (distance_m > 0.0).then_some(speed_mps);
        LegEstimate { distance_m: Some(distance_m), bearing_deg, alt_m, speed_mps, done_s }
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
        // 100 m at 5 m/s; 10 m climb at 5 m/s and 30 s; 100 m at 5 m/s and 20 m at 0.5 m/s.
        let done: Vec<_> = estimate.legs.iter().map(|leg| leg.done_s.map(f64::round)).collect();
        assert_eq!(done, [Some(20.0), Some(52.0), Some(112.0), None]);
        assert!((estimate.distance_m - 200.0).abs() < 0.1);
        assert!((estimate.time_s.unwrap() - 112.0).abs() < 0.1);
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
        assert!((estimate.time_s.unwrap() - 12.0).abs() < 1e-9);
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
        // 40 m up, 100 m on the level at 5 m/s, 20 m down over a leg that is flown in 2 s.
        assert!((time_s("alt_hold_climb_rate = 50") - (8.0 + 20.0 + 4.0)).abs() < 0.01);
        assert!((time_s("alt_hold_climb_rate = 20") - (20.0 + 20.0 + 10.0)).abs() < 0.01);
        assert!((time_s("ALT_HOLD_CLIMB_RATE=1") - (400.0 + 20.0 + 200.0)).abs() < 0.01);
        // With 0 the rate stays as it is.
        assert!((time_s("alt_hold_climb_rate = 0") - (8.0 + 20.0 + 4.0)).abs() < 0.01);
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
