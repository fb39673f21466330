//! The fence of a `.plan`: circles and polygons to stay in or out of.

use std::f64::consts::TAU;

use nalgebra::Vector2;
use serde_json::Value;

use super::super::HomePosition;
use super::super::bounds::{self, MAX_ITEMS};
use super::super::loss::{Finding, LossReport, Severity};
use super::source::Source;
use crate::geo::{LatLon, distance_bearing, local_offset, offset_to_latlon};
use crate::math;
use crate::plan::FlightPlan;
use crate::plan::feature::{Feature, Shape, Vertex, Zone};

/// The number of points of a circle.
const CIRCLE_POINTS: usize = 72;
/// A circle whose centre is within this distance of the home is one around home, m.
const AT_HOME_M: f64 = 1.0;
/// The largest circle, m.
const MAX_M: f64 = 1e6;

/// The fences of a file.
#[derive(Debug, Default)]
pub(super) struct Fences {
    /// The radius of the smallest circle around home that the craft must stay in, m.
    pub(super) home_radius_m: Option<f64>,
    /// The radii of the other circles that the craft must stay in, m.
    pub(super) elsewhere_m: Vec<f64>,
    /// The others.
    pub(super) features: Vec<Feature>,
    has_breach_return: bool,
}

/// Reads `/geoFence`.
pub(super) fn read(value: &Value, home: Option<HomePosition>, source: &mut Source<'_, '_>) -> Fences {
    let mut fences = Fences::default();
    let fence = &value["geoFence"];
    fences.has_breach_return = fence["breachReturn"].as_array().is_some_and(|values| !values.is_empty());
    let list = |key: &str| fence[key].as_array().map_or(&[][..], Vec::as_slice);
    for (index, value) in list("circles").iter().enumerate().take(MAX_ITEMS) {
        let pointer = format!("/geoFence/circles/{index}");
        let Some((center, radius_m)) = circle(&value["circle"], &format!("{pointer}/circle"), source) else {
            continue;
        };
        let zone = zone(value);
        let at_home = home.is_some_and(|home| distance_bearing(home.position, center).0 <= AT_HOME_M);
        if at_home && zone == Zone::Inclusion && radius_m >= 1.0 {
            let smallest = fences.home_radius_m.map_or(radius_m, |radius| radius.min(radius_m));
            fences.home_radius_m = Some(smallest);
        } else {
            if zone == Zone::Inclusion {
                fences.elsewhere_m.push(radius_m);
            }
            fences.add(format!("fence circle {index}"), ring(center, radius_m), zone);
        }
    }
    for (index, value) in list("polygons").iter().enumerate().take(MAX_ITEMS) {
        let pointer = format!("/geoFence/polygons/{index}/polygon");
        if let Some(corners) = polygon(&value["polygon"], &pointer, source) {
            fences.add(format!("fence polygon {index}"), corners, zone(value));
        }
    }
    fences
}

fn zone(value: &Value) -> Zone {
    if value["inclusion"].as_bool().unwrap_or(true) { Zone::Inclusion } else { Zone::Exclusion }
}

fn position(value: &Value, pointer: &str, source: &mut Source<'_, '_>) -> Option<LatLon> {
    let lat = source.number(&value[0], &format!("{pointer}/0"), "latitude");
    let lon = source.number(&value[1], &format!("{pointer}/1"), "longitude");
    let (Some(lat), Some(lon)) = (lat, lon) else {
        source.fault(pointer, "this is not a place", "write [latitude, longitude]");
        return None;
    };
    match bounds::position(lat, lon) {
        Ok((position, _)) => Some(position),
        Err(message) => {
            source.fault(pointer, message, "");
            None
        }
    }
}

fn circle(value: &Value, pointer: &str, source: &mut Source<'_, '_>) -> Option<(LatLon, f64)> {
    let center = position(&value["center"], &format!("{pointer}/center"), source)?;
    let at = format!("{pointer}/radius");
    let radius_m = source.number(&value["radius"], &at, "radius").unwrap_or(0.0);
    if !(0.01..=MAX_M).contains(&radius_m) {
        source.fault(&at, format!("radius {radius_m} m is out of range"), "allowed: 0.01 to 1000000 m");
        return None;
    }
    Some((center, radius_m))
}

fn polygon(value: &Value, pointer: &str, source: &mut Source<'_, '_>) -> Option<Vec<LatLon>> {
    let list = value.as_array().map_or(&[][..], Vec::as_slice);
    let mut corners = Vec::new();
    for (index, value) in list.iter().enumerate() {
        corners.push(position(value, &format!("{pointer}/{index}"), source)?);
    }
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    if corners.len() < 3 {
        source.fault(
            pointer,
            format!("a polygon of {} points is no area", corners.len()),
            "write at least 3 points",
        );
        return None;
    }
    Some(corners)
}

/// Returns the points of a circle.
fn ring(center: LatLon, radius_m: f64) -> Vec<LatLon> {
    let point = |index: usize| {
        let (east, north) = math::sin_cos(TAU * index as f64 / CIRCLE_POINTS as f64);
        offset_to_latlon(center, Vector2::new(north, east) * radius_m)
    };
    (0..CIRCLE_POINTS).map(point).collect()
}

impl Fences {
    fn add(&mut self, name: String, ring: Vec<LatLon>, zone: Zone) {
        let vertex = |position: LatLon| Vertex { position, altitude_m: f32::NAN };
        let shape = Shape::Area(vec![ring.into_iter().map(vertex).collect()]);
        self.features.push(Feature { name, shape, zone: Some(zone) });
    }

    /// Reports the fences that are not settings of the craft, and the waypoints that break them.
    pub(super) fn report(&self, plan: &FlightPlan, losses: &mut LossReport) {
        for feature in &self.features {
            let (side, wrong) = match feature.zone {
                Some(Zone::Exclusion) => ("stay outside", "inside"),
                _ => ("stay inside", "outside"),
            };
            let why = "this craft will not keep to it";
            losses.add(Finding::new(Severity::Lost, feature.name.clone(), why).values(side, ""));
            for (index, waypoint) in plan.waypoints.iter().enumerate() {
                let is_wrong =
                    (feature.zone == Some(Zone::Exclusion)) == contains(feature, waypoint.position);
                if waypoint.kind.uses_position() && is_wrong {
                    let why = format!("the waypoint is {wrong} the {}", feature.name);
                    losses.add(Finding::new(Severity::Lost, "fence", why).at(index));
                }
            }
        }
        if self.has_breach_return {
            let why = "this craft returns to its home";
            losses.add(Finding::new(Severity::Lost, "breach return point", why));
        }
    }
}

/// Returns `true` if a point is in the outer ring of an area.
fn contains(feature: &Feature, point: LatLon) -> bool {
    let Shape::Area(rings) = &feature.shape else { return false };
    let Some(ring) = rings.first() else { return false };
    let offsets: Vec<Vector2<f64>> = ring.iter().map(|vertex| local_offset(point, vertex.position)).collect();
    let mut inside = false;
    for (index, a) in offsets.iter().enumerate() {
        let b = offsets[(index + 1) % offsets.len()];
        let crosses = (a.x > 0.0) != (b.x > 0.0);
        inside ^= crosses && a.y - a.x * (b.y - a.y) / (b.x - a.x) > 0.0;
    }
    inside
}
