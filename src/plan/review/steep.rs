//! Legs that are too steep for their speed. The review simulates the altitude setpoint over the time of each leg.

use std::fmt;

use nalgebra::Vector2;

use super::ends_the_mission;
use crate::geo::{GRAVITY, LatLon, local_offset};
use crate::math;
use crate::plan::estimate::Assumptions;
use crate::plan::leg_time::{LegShape, Motion};
use crate::plan::setpoint::AltitudeSetpoint;
use crate::plan::{Approach, HoldPattern, LegSpeed, Modifier, Then, Waypoint};

/// The altitude error at a waypoint that makes a leg too steep, m.
const STEEP_M: f64 = 7.0;
/// The altitude error that a slower leg may leave, m.
const LEVEL_M: f64 = 1.0;
/// The distance below which two waypoints count as one, m.
const CO_LOCATED_M: f64 = 0.1;
/// The slowest speed of a waypoint, 0.1 m/s.
const SLOWEST_DMPS: u16 = 10;

/// A change with which the craft reaches the altitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Remedy {
    /// Fly the leg no faster than this speed.
    Slow {
        /// Speed of the waypoint.
        speed: LegSpeed,
    },
    /// Wait for the altitude in a HOLD at the previous place.
    HoldFirst,
}

/// A leg at whose end the craft is not at the altitude of the waypoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteepLeg {
    /// Index of the waypoint to which the leg leads.
    pub index: usize,
    /// Altitude of the leg above home, m.
    pub alt_m: f64,
    /// Altitude error of the craft at the waypoint, m; negative = too low.
    pub error_m: f64,
    /// The time of the leg, s.
    pub leg_s: f64,
    /// The time of the climb or descent, s.
    pub needed_s: f64,
    /// A change with which the craft reaches the altitude.
    pub remedy: Remedy,
}

impl fmt::Display for SteepLeg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { index, alt_m, error_m, leg_s, needed_s, remedy } = self;
        let (side, way) = if *error_m < 0.0 { ("low", "climb") } else { ("high", "descent") };
        write!(
            f,
            "waypoint {index} is passed about {:.0} m too {side}: its leg takes {leg_s:.0} s, the {way} to {alt_m:.0} m \
             {needed_s:.0} s; ",
            error_m.abs()
        )?;
        match remedy {
            Remedy::Slow { speed } => {
                write!(f, "fly the leg at {:.1} m/s or slower", speed.mps())
            }
            Remedy::HoldFirst => {
                write!(f, "put a HOLD at {alt_m:.0} m before it, which waits for the altitude")
            }
        }
    }
}

/// Returns the legs of a flight from above `home` that are too steep.
pub(super) fn steep_legs(waypoints: &[Waypoint], home: LatLon, assumptions: &Assumptions) -> Vec<SteepLeg> {
    let mut walk = Walk {
        assumptions,
        place: home,
        beside: Vector2::zeros(),
        motion: Motion::REST,
        setpoint: AltitudeSetpoint::at(assumptions.start_alt_m),
        climbs_first: assumptions.start_alt_m < assumptions.min_nav_alt_m,
        alt_change_m: None,
        delay_s: None,
    };
    let end = waypoints.iter().position(ends_the_mission).map_or(waypoints.len(), |end| end + 1);
    let waypoints = &waypoints[..end];
    (0..end).filter_map(|index| walk.take(index, waypoints)).collect()
}

/// The position and the motion of the craft after some waypoints.
struct Walk<'a> {
    assumptions: &'a Assumptions,
    /// The place of the previous waypoint.
    place: LatLon,
    /// The offset of the craft from that place, north and east, m.
    beside: Vector2<f64>,
    motion: Motion,
    setpoint: AltitudeSetpoint,
    /// `true` if the craft climbs on the spot before the first leg.
    climbs_first: bool,
    alt_change_m: Option<f64>,
    delay_s: Option<f64>,
}

/// A leg from the craft to a waypoint.
#[derive(Clone, Copy)]
struct Leg {
    distance_m: f64,
    along: Vector2<f64>,
    alt_m: f64,
    approach: Approach,
    stops: bool,
    /// The speed limit from a DELAY, m/s.
    cap_mps: f64,
}

impl Walk<'_> {
    /// Flies to a waypoint. Returns the leg if the craft misses the altitude.
    fn take(&mut self, index: usize, waypoints: &[Waypoint]) -> Option<SteepLeg> {
        let waypoint = &waypoints[index];
        let own_alt_m = waypoint.altitude.above_home_m();
        match waypoint.kind.capability().approach {
            Approach::Modify(Modifier::Altitude) => self.alt_change_m = Some(own_alt_m),
            Approach::Modify(Modifier::Delay) => self.delay_s = Some(waypoint.duration.get()),
            Approach::Modify(Modifier::YawRate) => {}
            Approach::Climb => self.climb_on_the_spot(waypoint, own_alt_m),
            Approach::Level | Approach::Stop => {
                let leg = self.leg(index, waypoints, own_alt_m);
                self.fly(waypoint, &leg);
                self.stay(waypoint, leg.alt_m);
            }
            Approach::Pass | Approach::Turn => {
                let leg = self.leg(index, waypoints, own_alt_m);
                return self.pass(index, waypoint, &leg);
            }
        }
        None
    }

    fn climb_on_the_spot(&mut self, waypoint: &Waypoint, own_alt_m: f64) {
        let alt_m = self.alt_change_m.take().unwrap_or(own_alt_m);
        self.delay_s = None;
        self.climbs_first = false;
        let limits = self.assumptions.setpoint_limits();
        self.setpoint.reach(alt_m, &limits, self.assumptions.hold_radius_m);
        self.setpoint.run(alt_m, &limits, waypoint.duration.get());
        self.motion = Motion::REST;
    }

    fn leg(&mut self, index: usize, waypoints: &[Waypoint], own_alt_m: f64) -> Leg {
        let waypoint = &waypoints[index];
        let following = waypoints[index + 1..].iter().find(|next| next.kind.is_positional());
        let goes_on = following.is_some_and(|next| {
            next.kind.uses_position() && local_offset(waypoint.position, next.position).norm() >= CO_LOCATED_M
        });
        let passes = waypoint.kind.passes();
        let way = local_offset(self.place, waypoint.position) - self.beside;
        let distance_m = way.norm();
        let alt_m = self.alt_change_m.take().unwrap_or(own_alt_m);
        if std::mem::take(&mut self.climbs_first) && (passes || distance_m > self.assumptions.hold_radius_m) {
            let enough_m = self.assumptions.min_nav_alt_m;
            let target_m = alt_m.max(enough_m + 1.0);
            self.setpoint.reach(target_m, &self.assumptions.setpoint_limits(), target_m - enough_m);
        }
        let cap_mps = self.delay_s.take().filter(|&delay_s| delay_s > 0.0).map_or(f64::INFINITY, |delay_s| {
            self.assumptions.delayed_mps(math::hypot(distance_m, alt_m - self.setpoint.altitude_m), delay_s)
        });
        Leg {
            distance_m,
            along: way.try_normalize(1e-9).unwrap_or_else(Vector2::x),
            alt_m,
            approach: waypoint.kind.capability().approach,
            stops: !passes || !goes_on,
            cap_mps,
        }
    }

    /// Returns the distance from the waypoint at which it counts as reached by a craft of this speed, m.
    fn reach_m(&self, leg: &Leg, speed_mps: f64) -> f64 {
        match leg.approach {
            Approach::Pass | Approach::Turn if leg.stops => self.assumptions.arrival_radius_m,
            Approach::Turn => {
                let tilt = self.assumptions.max_angle_deg.clamp(5.0, 80.0).to_radians();
                math::powi(speed_mps, 2) / (GRAVITY * math::tan(tilt))
            }
            Approach::Pass => 0.0,
            _ => self.assumptions.hold_radius_m,
        }
    }

    /// Returns the motion and the altitude at the end of a leg at this speed, and its time, s.
    fn flown(&self, leg: &Leg, speed_mps: f64) -> (Motion, AltitudeSetpoint, f64) {
        let speed_mps = speed_mps.min(leg.cap_mps);
        let (mut motion, mut setpoint) = (self.motion, self.setpoint);
        let reach_m = self.reach_m(leg, speed_mps);
        let shape = LegShape { distance_m: leg.distance_m, reach_m, speed_mps, stops: leg.stops };
        let leg_s = motion.fly(&shape, leg.along, self.assumptions);
        setpoint.run(leg.alt_m, &self.assumptions.setpoint_limits(), leg_s);
        (motion, setpoint, leg_s)
    }

    fn fly(&mut self, waypoint: &Waypoint, leg: &Leg) -> f64 {
        let speed_mps = self.assumptions.leg_speed_mps(waypoint);
        let reach_m = self.reach_m(leg, speed_mps.min(leg.cap_mps)).min(leg.distance_m);
        let (motion, setpoint, leg_s) = self.flown(leg, speed_mps);
        (self.motion, self.setpoint) = (motion, setpoint);
        self.place = waypoint.position;
        self.beside = -leg.along * reach_m;
        leg_s
    }

    fn pass(&mut self, index: usize, waypoint: &Waypoint, leg: &Leg) -> Option<SteepLeg> {
        let error_of = |setpoint: &AltitudeSetpoint| setpoint.altitude_m - leg.alt_m;
        let (_, setpoint, _) = self.flown(leg, self.assumptions.leg_speed_mps(waypoint));
        let error_m = error_of(&setpoint);
        let steep = (error_m.abs() > STEEP_M).then(|| {
            let limits = self.assumptions.setpoint_limits();
            let mut alone = self.setpoint;
            (alone.reach(leg.alt_m, &limits, LEVEL_M), self.remedy(waypoint, leg))
        });
        let leg_s = self.fly(waypoint, leg);
        // A target in the ground is never reached, even on a long leg.
        let (needed_s, remedy) = steep.filter(|(needed_s, _)| needed_s.is_finite())?;
        Some(SteepLeg { index, alt_m: leg.alt_m, error_m, leg_s, needed_s, remedy })
    }

    fn remedy(&self, waypoint: &Waypoint, leg: &Leg) -> Remedy {
        let is_level = |dmps: u16| {
            let (_, setpoint, _) = self.flown(leg, f64::from(dmps) / 10.0);
            (setpoint.altitude_m - leg.alt_m).abs() <= LEVEL_M
        };
        if !is_level(SLOWEST_DMPS) {
            return Remedy::HoldFirst;
        }
        // Saturates at the range of the field.
        let most = (self.assumptions.leg_speed_mps(waypoint) * 10.0) as u16;
        let (mut slow, mut fast) = (SLOWEST_DMPS, most.clamp(SLOWEST_DMPS + 1, 6000));
        while fast - slow > 1 {
            let middle = slow.midpoint(fast);
            if is_level(middle) { slow = middle } else { fast = middle }
        }
        Remedy::Slow { speed: LegSpeed::from_mps(f64::from(slow) / 10.0) }
    }

    /// Adds the stay of a HOLD after a leg; a LAND ends the mission.
    fn stay(&mut self, waypoint: &Waypoint, alt_m: f64) {
        let duration_s = waypoint.duration.get();
        if waypoint.kind.capability().then == Then::Hold {
            self.assumptions.wait_for_hold(&mut self.setpoint, alt_m);
            self.setpoint.run(alt_m, &self.assumptions.setpoint_limits(), duration_s);
        }
        self.beside = match waypoint.pattern {
            HoldPattern::Orbit => self.on_the_orbit(waypoint, duration_s),
            HoldPattern::None | HoldPattern::Figure8 => Vector2::zeros(),
        };
    }

    /// Returns the place on the circle after so many seconds, m from the middle.
    fn on_the_orbit(&self, waypoint: &Waypoint, seconds: f64) -> Vector2<f64> {
        let radius_m = self.assumptions.orbit_radius_m.max(0.1);
        let rate = self.assumptions.orbit_rate_rps(waypoint);
        let (east, north) = math::sin_cos(rate * seconds);
        Vector2::new(north, east) * radius_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::offset_to_latlon;
    use crate::plan::{Altitude, Seconds, WaypointType};

    const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);

    fn steep(legs: &[(WaypointType, f64, i32, u16)]) -> Vec<SteepLeg> {
        let waypoints: Vec<Waypoint> = legs
            .iter()
            .map(|&(kind, north_m, alt_m, speed_cms)| Waypoint {
                position: offset_to_latlon(HOME, Vector2::new(north_m, 0.0)),
                altitude: Altitude::above_home(alt_m.into()),
                speed: LegSpeed::from_mps(f64::from(speed_cms) / 100.0),
                kind,
                duration: Seconds::new(1.0),
                ..Waypoint::default()
            })
            .collect();
        let settings = ["ap_max_velocity = 1000".to_owned()];
        steep_legs(&waypoints, HOME, &Assumptions::from_settings(&settings))
    }

    #[test]
    fn a_steep_leg_is_reported_with_its_miss_and_what_to_do() {
        use WaypointType::{Flyover, Land};
        let found = steep(&[(Flyover, 55.7, 15, 1000), (Flyover, 85.7, 80, 1000), (Land, 0.0, 15, 0)]);
        let reported: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert_eq!(
            reported,
            [
                "waypoint 1 is passed about 56 m too low: its leg takes 3 s, the climb to 80 m 15 s; fly the leg at 1.6 m/s or \
              slower"
            ]
        );
        let drop = steep(&[(Flyover, 100.0, 100, 200), (Flyover, 104.0, 20, 500), (Land, 0.0, 15, 0)]);
        let reported = drop.last().map(ToString::to_string).unwrap_or_default();
        assert!(reported.contains("too high") && reported.contains("the descent to 20 m"), "{reported}");
        assert!(
            reported.ends_with("put a HOLD at 20 m before it, which waits for the altitude"),
            "{reported}"
        );
    }

    #[test]
    fn legs_that_wait_for_their_altitude_or_have_the_time_are_not_reported() {
        use WaypointType::{Flyover, Hold, Land, Takeoff};
        assert!(steep(&[(Hold, 5.0, 90, 0), (Flyover, 50.0, 90, 0), (Land, 60.0, 20, 0)]).is_empty());
        assert!(steep(&[(Takeoff, 0.0, 90, 0), (Flyover, 50.0, 90, 0), (Land, 60.0, 20, 0)]).is_empty());
        assert!(steep(&[(Flyover, 200.0, 60, 500), (Flyover, 300.0, 90, 500)]).is_empty());
        assert!(steep(&[(Flyover, 20.0, 12, 1000), (Land, 0.0, 12, 0), (Flyover, 1.0, 900, 0)]).is_empty());
    }
}
