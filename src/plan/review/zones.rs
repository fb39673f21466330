//! The zones of a map: waypoints, legs and flown paths that enter a no-fly zone or leave the zone around the flight.

use std::fmt;

use nalgebra::Vector2;

use super::Finding;
use crate::geo::{LatLon, local_offset};
use crate::plan::feature::{Feature, Shape, Zone};
use crate::plan::{FlightPlan, WaypointType};
use crate::text::printable;

/// A place this near to the border of a zone is on it, m. This is the resolution of a position.
const BORDER_M: f64 = 0.012;
/// The number of edges of a border that are left out together where a path does not come near them.
const RUN: usize = 32;

/// The part of a plan that is where a zone forbids it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ZonePart {
    /// The waypoint itself.
    Waypoint,
    /// The leg to the waypoint, but neither of its ends.
    Leg,
}

/// Returns the findings about the zones among `features`: for each zone the waypoints in plan order.
pub fn zone_findings(plan: &FlightPlan, home: LatLon, features: &[Feature]) -> Vec<Finding> {
    let outlines = Outline::all(features, home);
    if outlines.is_empty() {
        return Vec::new();
    }
    let places: Vec<(usize, Vector2<f64>)> = plan
        .waypoints
        .iter()
        .enumerate()
        .filter(|(_, wp)| wp.kind.is_positional())
        .map(|(index, wp)| {
            let is_home = wp.kind == WaypointType::Takeoff;
            (index, if is_home { Vector2::zeros() } else { local_offset(home, wp.position) })
        })
        .collect();
    let mut findings = Vec::new();
    for outline in &outlines {
        let mut from = (Vector2::zeros(), outline.forbids(Vector2::zeros()));
        for &(index, place) in &places {
            let is_forbidden = outline.forbids(place);
            let part = if is_forbidden {
                Some(ZonePart::Waypoint)
            } else {
                // The finding about a forbidden start covers the leg from there, except from home.
                let is_start = from.1 && index == places.first().map_or(0, |first| first.0);
                let crosses = is_start || !from.1 && outline.is_crossed(from.0, place);
                crosses.then_some(ZonePart::Leg)
            };
            let (zone, name) = (outline.zone, outline.name.to_owned());
            findings.extend(part.map(|part| Finding::AgainstZone { index, part, zone, name }));
            from = (place, is_forbidden);
        }
    }
    findings
}

/// Returns the zones that a flown path enters or leaves against their meaning, each with the index of the first point
/// behind its border. A path that begins on the wrong side has index 0.
pub fn zones_on_path(path: &[LatLon], features: &[Feature]) -> Vec<(Zone, String, usize)> {
    let Some(&start) = path.first() else { return Vec::new() };
    let outlines = Outline::all(features, start);
    if outlines.is_empty() {
        return Vec::new();
    }
    let points: Vec<Vector2<f64>> = path.iter().map(|&place| local_offset(start, place)).collect();
    let first_behind = |outline: &Outline<'_>| {
        if outline.forbids(points[0]) {
            return Some(0);
        }
        let crossed = points.windows(2).position(|pair| outline.is_crossed(pair[0], pair[1]));
        crossed.map(|at| at + 1)
    };
    let found = outlines.iter().filter_map(|outline| Some((outline, first_behind(outline)?)));
    found.map(|(outline, at)| (outline.zone, outline.name.to_owned(), at)).collect()
}

/// Writes the sentence about a waypoint or a leg.
pub(super) fn write_part(
    f: &mut fmt::Formatter<'_>,
    index: usize,
    part: ZonePart,
    zone: Zone,
    name: &str,
) -> fmt::Result {
    let zone_name = zone_name(zone, name);
    match (part, zone) {
        (ZonePart::Waypoint, Zone::Exclusion) => write!(f, "waypoint {index} is in {zone_name}"),
        (ZonePart::Waypoint, Zone::Inclusion) => write!(f, "waypoint {index} is outside {zone_name}"),
        (ZonePart::Leg, Zone::Exclusion) => write!(f, "the leg to waypoint {index} crosses {zone_name}"),
        (ZonePart::Leg, Zone::Inclusion) => write!(f, "the leg to waypoint {index} leaves {zone_name}"),
    }
}

/// Writes the sentence about the flown estimate.
pub(super) fn write_flown(f: &mut fmt::Formatter<'_>, zone: Zone, name: &str, along_m: f64) -> fmt::Result {
    let verb = if zone == Zone::Exclusion { "enters" } else { "leaves" };
    write!(f, "the flown estimate {verb} {} after {along_m:.0} m of the plan", zone_name(zone, name))
}

/// Returns the words for a zone in a sentence.
fn zone_name(zone: Zone, name: &str) -> String {
    let name = printable::name(name.trim());
    match (zone, name.is_empty()) {
        (Zone::Exclusion, true) => "a no-fly zone".to_owned(),
        (Zone::Exclusion, false) => format!("the no-fly zone {name}"),
        (Zone::Inclusion, true) => "the zone that the flight must not leave".to_owned(),
        (Zone::Inclusion, false) => format!("the zone {name}, which the flight must not leave"),
    }
}

/// A rectangle, m.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    low: Vector2<f64>,
    high: Vector2<f64>,
}

impl Bounds {
    fn of(points: impl IntoIterator<Item = Vector2<f64>>) -> Self {
        let none = Self { low: Vector2::repeat(f64::INFINITY), high: Vector2::repeat(f64::NEG_INFINITY) };
        points
            .into_iter()
            .fold(none, |all, point| Self { low: all.low.inf(&point), high: all.high.sup(&point) })
    }

    /// Returns `true` if the rectangles overlap or are as near to each other as places on a border.
    fn is_near(&self, other: &Self) -> bool {
        (0..2).all(|axis| {
            self.low[axis] <= other.high[axis] + BORDER_M && other.low[axis] <= self.high[axis] + BORDER_M
        })
    }
}

/// A zone in metres north and east of an origin.
struct Outline<'a> {
    zone: Zone,
    name: &'a str,
    bounds: Bounds,
    /// The edges of all rings.
    edges: Vec<(Vector2<f64>, Vector2<f64>)>,
    /// The rectangles of [`RUN`] edges each.
    runs: Vec<Bounds>,
}

impl<'a> Outline<'a> {
    /// Returns the outlines of all zones.
    fn all(features: &'a [Feature], origin: LatLon) -> Vec<Self> {
        let zones = features.iter().filter_map(|feature| {
            let (Some(zone), Shape::Area(rings)) = (feature.zone, &feature.shape) else { return None };
            let edges = rings.iter().flat_map(|ring| {
                let place = |index: usize| local_offset(origin, ring[index % ring.len()].position);
                (0..ring.len()).map(move |index| (place(index), place(index + 1)))
            });
            let edges: Vec<_> = edges.collect();
            let bounds_of = |edges: &[(Vector2<f64>, Vector2<f64>)]| {
                Bounds::of(edges.iter().flat_map(|&(from, to)| [from, to]))
            };
            let runs = edges.chunks(RUN).map(bounds_of).collect();
            Some(Self { zone, name: &feature.name, bounds: bounds_of(&edges), edges, runs })
        });
        zones.filter(|outline| !outline.edges.is_empty()).collect()
    }

    /// Returns `true` if the zone forbids to be at a place. The border itself is allowed.
    fn forbids(&self, place: Vector2<f64>) -> bool {
        let is_border = || self.edges.iter().any(|&(from, to)| distance_m(place, from, to) <= BORDER_M);
        match self.zone {
            Zone::Exclusion => self.contains(place) && !is_border(),
            Zone::Inclusion => !self.contains(place) && !is_border(),
        }
    }

    /// Returns `true` if a place is inside an odd number of rings: inside the outer one and in no hole.
    fn contains(&self, place: Vector2<f64>) -> bool {
        if !self.bounds.is_near(&Bounds { low: place, high: place }) {
            return false;
        }
        let is_left = |&&(from, to): &&(Vector2<f64>, Vector2<f64>)| {
            (from.x > place.x) != (to.x > place.x)
                && place.y < from.y + (place.x - from.x) / (to.x - from.x) * (to.y - from.y)
        };
        self.edges.iter().filter(is_left).count() % 2 == 1
    }

    /// Returns `true` if the way between two allowed places crosses the border. Touching the border of a no-fly zone
    /// counts, touching that of the zone around the flight does not.
    fn is_crossed(&self, from: Vector2<f64>, to: Vector2<f64>) -> bool {
        let way = Bounds::of([from, to]);
        if !self.bounds.is_near(&way) {
            return false;
        }
        let runs = self.edges.chunks(RUN).zip(&self.runs).filter(|(_, bounds)| bounds.is_near(&way));
        runs.flat_map(|(edges, _)| edges).any(|&(a, b)| {
            let sides = [cross(a, b, from), cross(a, b, to), cross(from, to, a), cross(from, to, b)];
            match self.zone {
                Zone::Inclusion => sides[0] * sides[1] < 0.0 && sides[2] * sides[3] < 0.0,
                Zone::Exclusion => {
                    Bounds::of([a, b]).is_near(&way)
                        && sides[0] * sides[1] <= 0.0
                        && sides[2] * sides[3] <= 0.0
                }
            }
        })
    }
}

/// Returns twice the area of a triangle, positive on one side of the line from `a` to `b`.
fn cross(a: Vector2<f64>, b: Vector2<f64>, point: Vector2<f64>) -> f64 {
    (b - a).perp(&(point - a))
}

/// Returns the distance from a place to an edge, m.
fn distance_m(place: Vector2<f64>, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
    let edge = to - from;
    let length2 = edge.norm_squared();
    let along = if length2 > 0.0 { ((place - from).dot(&edge) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (place - from - edge * along).norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::GroundPlane;
    use crate::plan::Waypoint;
    use crate::plan::feature::Vertex;
    use proptest::prelude::*;

    const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);

    fn at(n: f64, e: f64) -> LatLon {
        GroundPlane::new(HOME).to_position(Vector2::new(n, e))
    }

    fn ring(corners: &[(f64, f64)]) -> Vec<Vertex> {
        corners.iter().map(|&(n, e)| Vertex { position: at(n, e), altitude_m: f32::NAN }).collect()
    }

    fn rectangle(low: (f64, f64), high: (f64, f64)) -> Vec<Vertex> {
        ring(&[low, (low.0, high.1), high, (high.0, low.1)])
    }

    fn zone(zone: Zone, rings: Vec<Vec<Vertex>>) -> Feature {
        Feature { name: "Airfield".to_owned(), shape: Shape::Area(rings), zone: Some(zone) }
    }

    fn plan(places: &[(f64, f64)]) -> FlightPlan {
        let waypoints = places.iter().map(|&(n, e)| Waypoint { position: at(n, e), ..Waypoint::default() });
        FlightPlan { waypoints: waypoints.collect() }
    }

    fn say(places: &[(f64, f64)], feature: Feature) -> Vec<String> {
        zone_findings(&plan(places), HOME, &[feature]).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn waypoints_and_legs_in_a_no_fly_zone_are_named() {
        let airfield = || zone(Zone::Exclusion, vec![rectangle((50.0, -50.0), (100.0, 50.0))]);
        assert_eq!(say(&[(20.0, 0.0), (20.0, 90.0)], airfield()), [""; 0]);
        assert_eq!(
            say(&[(75.0, 0.0), (150.0, 0.0), (0.0, 0.0)], airfield()),
            [
                "waypoint 0 is in the no-fly zone Airfield",
                "the leg to waypoint 2 crosses the no-fly zone Airfield",
            ]
        );
        // Through two corners, where no edge is crossed between its ends.
        assert_eq!(
            say(
                &[(25.0, -75.0), (125.0, 75.0)],
                zone(
                    Zone::Exclusion,
                    vec![ring(&[(50.0, -37.5), (50.0, 37.5), (100.0, 37.5), (100.0, -37.5),])]
                )
            ),
            ["the leg to waypoint 1 crosses the no-fly zone Airfield"]
        );
    }

    #[test]
    fn a_hole_of_a_no_fly_zone_is_free_and_the_way_into_it_is_not() {
        let rings =
            vec![rectangle((-100.0, -100.0), (100.0, 100.0)), rectangle((-40.0, -40.0), (40.0, 40.0))];
        let airfield = zone(Zone::Exclusion, rings);
        assert_eq!(say(&[(30.0, 0.0), (0.0, 30.0)], airfield.clone()), [""; 0]);
        let out = say(&[(30.0, 0.0), (150.0, 0.0)], airfield);
        assert_eq!(out, ["the leg to waypoint 1 crosses the no-fly zone Airfield"]);
    }

    #[test]
    fn what_leaves_the_zone_around_the_flight_is_named() {
        let field = || zone(Zone::Inclusion, vec![rectangle((-100.0, -100.0), (100.0, 100.0))]);
        assert_eq!(say(&[(100.0, 100.0), (100.0, -100.0)], field()), [""; 0], "its border belongs to it");
        assert_eq!(
            say(&[(50.0, 0.0), (120.0, 0.0), (0.0, 0.0)], field()),
            ["waypoint 1 is outside the zone Airfield, which the flight must not leave"]
        );
        let corners = [
            (-100.0, -100.0),
            (-100.0, 100.0),
            (100.0, 100.0),
            (100.0, 50.0),
            (0.0, 0.0),
            (100.0, -50.0),
            (100.0, -100.0),
        ];
        let notched = zone(Zone::Inclusion, vec![ring(&corners)]);
        assert_eq!(
            say(&[(-10.0, 0.0), (80.0, 70.0), (80.0, -70.0)], notched),
            ["the leg to waypoint 2 leaves the zone Airfield, which the flight must not leave"]
        );
    }

    #[test]
    fn home_on_the_wrong_side_is_a_finding_about_the_first_leg() {
        let airfield = zone(Zone::Exclusion, vec![rectangle((-10.0, -10.0), (10.0, 10.0))]);
        let found = say(&[(50.0, 0.0), (60.0, 0.0)], airfield);
        assert_eq!(found, ["the leg to waypoint 0 crosses the no-fly zone Airfield"]);
    }

    #[test]
    fn a_path_names_the_point_behind_the_border() {
        let airfield = zone(Zone::Exclusion, vec![rectangle((50.0, -50.0), (100.0, 50.0))]);
        let path: Vec<LatLon> = (0..20).map(|step| at(f64::from(step) * 10.0 + 1.0, 0.0)).collect();
        let found = zones_on_path(&path, std::slice::from_ref(&airfield));
        assert_eq!(found, [(Zone::Exclusion, "Airfield".to_owned(), 5)]);
        assert_eq!(zones_on_path(&path[..5], &[airfield]), []);
        assert_eq!(zones_on_path(&[], &[]), []);
    }

    proptest! {
        #[test]
        fn a_leg_is_found_as_its_samples_are(
            corners in proptest::collection::vec((-100.0..100.0_f64, -100.0..100.0_f64), 3..8),
            from in (-120.0..120.0_f64, -120.0..120.0_f64), to in (-120.0..120.0_f64, -120.0..120.0_f64),
            excludes in any::<bool>(),
        ) {
            let kind = if excludes { Zone::Exclusion } else { Zone::Inclusion };
            let feature = zone(kind, vec![ring(&corners)]);
            let outline = Outline::all(std::slice::from_ref(&feature), HOME).remove(0);
            let [from, to] = [from, to].map(|(n, e)| Vector2::new(n, e));
            prop_assume!(!outline.forbids(from) && !outline.forbids(to));
            // Samples deep inside the forbidden side are only reached across the border.
            let is_behind = |place: Vector2<f64>| {
                outline.forbids(place) && outline.edges.iter().all(|&(a, b)| distance_m(place, a, b) > 0.1)
            };
            let is_seen = (0..=200).any(|step| is_behind(from.lerp(&to, f64::from(step) / 200.0)));
            prop_assert!(!is_seen || outline.is_crossed(from, to));
        }
    }
}
