//! Edits of many waypoints at once. Positions move on the ground in metres, the same everywhere on the globe. Waypoints
//! without a position stay unchanged.

use nalgebra::Vector2;

use crate::geo::{GroundPlane, LatLon};
use crate::math;
use crate::plan::{Altitude, FlightPlan, LegSpeed, SpeedUse, Waypoint};

/// An edit of each selected waypoint that has such a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Transform {
    /// Sets the altitude.
    Altitude(Altitude),
    /// A change of altitude, m.
    AltitudeBy(f64),
    /// Sets the speed of the leg.
    Speed(LegSpeed),
    /// A move, metres north and east.
    Move(Vector2<f64>),
    /// A turn about the middle of the selection, radians clockwise.
    Rotate(f64),
    /// Swaps north and south about the middle.
    MirrorNorthSouth,
    /// Swaps east and west about the middle.
    MirrorEastWest,
    /// Reverses the flight order.
    Reverse,
}

/// Applies the edit to those waypoints of `selected` that exist.
pub fn transform(plan: &mut FlightPlan, selected: std::ops::RangeInclusive<usize>, what: Transform) {
    let end = plan.waypoints.len().min(selected.end().saturating_add(1));
    let Some(waypoints) = plan.waypoints.get_mut(*selected.start()..end) else { return };
    match what {
        Transform::Altitude(altitude) => with_altitude(waypoints).for_each(|wp| wp.altitude = altitude),
        Transform::AltitudeBy(by_m) => {
            with_altitude(waypoints).for_each(|wp| wp.altitude = wp.altitude.raised_m(by_m));
        }
        Transform::Speed(speed) => {
            waypoints
                .iter_mut()
                .filter(|wp| wp.kind.capability().speed == SpeedUse::Leg)
                .for_each(|wp| wp.speed = speed);
        }
        Transform::Move(by) => {
            for wp in waypoints.iter_mut().filter(|wp| wp.kind.uses_position()) {
                wp.position = GroundPlane::new(wp.position).to_position(by);
            }
        }
        Transform::Rotate(angle) => {
            let (sin, cos) = math::sin_cos(angle);
            about_middle(waypoints, |ne| Vector2::new(ne.x * cos - ne.y * sin, ne.x * sin + ne.y * cos));
        }
        Transform::MirrorNorthSouth => about_middle(waypoints, |ne| Vector2::new(-ne.x, ne.y)),
        Transform::MirrorEastWest => about_middle(waypoints, |ne| Vector2::new(ne.x, -ne.y)),
        Transform::Reverse => waypoints.reverse(),
    }
}

fn with_altitude(waypoints: &mut [Waypoint]) -> impl Iterator<Item = &mut Waypoint> {
    waypoints.iter_mut().filter(|wp| wp.kind.capability().altitude)
}

fn about_middle(waypoints: &mut [Waypoint], place: impl Fn(Vector2<f64>) -> Vector2<f64>) {
    let Some(middle) = middle(waypoints) else { return };
    let plane = GroundPlane::new(middle);
    for wp in waypoints.iter_mut().filter(|wp| wp.kind.uses_position()) {
        wp.position = plane.to_position(place(plane.to_ne(wp.position)));
    }
}

/// Returns the middle of the positions of some waypoints: the middle of the box around them, as on north-up maps.
pub fn middle(waypoints: &[Waypoint]) -> Option<LatLon> {
    let mut places = waypoints.iter().filter(|wp| wp.kind.uses_position()).map(|wp| wp.position);
    let plane = GroundPlane::new(places.next()?);
    let (mut low, mut high) = (Vector2::zeros(), Vector2::zeros());
    for place in places {
        let ne = plane.to_ne(place);
        (low, high) = (low.inf(&ne), high.sup(&ne));
    }
    Some(plane.to_position((low + high) / 2.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::distance_bearing;
    use crate::plan::WaypointType;
    use proptest::prelude::*;

    fn plan(lat: f64, lon: f64) -> FlightPlan {
        let plane = GroundPlane::new(LatLon::from_degrees(lat, lon));
        let place =
            |n, e| Waypoint { position: plane.to_position(Vector2::new(n, e)), ..Waypoint::default() };
        FlightPlan {
            waypoints: [place(0.0, 0.0), place(80.0, 0.0), place(80.0, 120.0)].into_iter().collect(),
        }
    }

    fn sides(plan: &FlightPlan) -> Vec<f64> {
        let plane = GroundPlane::new(plan.waypoints[0].position);
        plan.waypoints.iter().map(|wp| plane.to_ne(wp.position).norm()).collect()
    }

    proptest! {
        #[test]
        fn a_shape_keeps_its_sides_wherever_it_is(
            lat in prop_oneof![-89.9999..89.9999_f64, Just(89.9999), Just(-89.9999)],
            lon in prop_oneof![-180.0..180.0_f64, Just(180.0), Just(-179.9999)],
            angle in -7.0..7.0_f64,
        ) {
            let before = plan(lat, lon);
            for what in [Transform::Rotate(angle), Transform::MirrorEastWest, Transform::MirrorNorthSouth] {
                let mut after = before.clone();
                transform(&mut after, 0..=2, what);
                for (a, b) in std::iter::zip(sides(&before), sides(&after)) {
                    prop_assert!((a - b).abs() < 0.1, "{what:?}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn a_quarter_turn_clockwise_brings_north_to_east() {
        let mut turned = plan(40.0, 180.0);
        let middle = middle(&turned.waypoints).unwrap();
        let (_, before) = distance_bearing(middle, turned.waypoints[1].position);
        transform(&mut turned, 0..=2, Transform::Rotate(std::f64::consts::FRAC_PI_2));
        let (_, after) = distance_bearing(middle, turned.waypoints[1].position);
        assert!(
            ((after - before).rem_euclid(std::f64::consts::TAU) - std::f64::consts::FRAC_PI_2).abs() < 1e-3
        );
    }

    #[test]
    fn a_speed_for_many_waypoints_leaves_the_rate_of_a_turn_alone() {
        let mut plan = plan(40.0, -79.0);
        plan.waypoints[1] = Waypoint { kind: WaypointType::YawRate, yaw_rate_dps: 30, ..Waypoint::default() };
        transform(&mut plan, 0..=2, Transform::Speed(LegSpeed::from_mps(5.0)));
        transform(&mut plan, 0..=2, Transform::Altitude(Altitude::above_home(7.0)));
        assert_eq!(plan.records().iter().map(|record| record.speed).collect::<Vec<_>>(), [500, 30, 500]);
        assert_eq!(plan.records().iter().map(|record| record.alt_cm).collect::<Vec<_>>(), [700, 0, 700]);
    }

    #[test]
    fn only_what_is_selected_changes_and_a_selection_beyond_the_end_is_cut() {
        let mut after = plan(40.0, -79.0);
        transform(&mut after, 1..=9, Transform::Altitude(Altitude::above_home(7.0)));
        assert_eq!(after.records().iter().map(|record| record.alt_cm).collect::<Vec<_>>(), [0, 700, 700]);
        let before = after.clone();
        transform(&mut after, 5..=9, Transform::Reverse);
        assert_eq!(after, before);
    }
}
