//! GeoJSON: plans as points with properties, the path as a line, the fence as a polygon.

use super::loss::{Finding, Place, Severity};
use super::map_choice::{Choice, points};
use super::map_data::{self, HOME, VERSION, metres, own_type};
use super::map_file::{MapFeature, MapKind};
use super::map_plan::{Builder, Map, Spot};
use super::{PlanFile, Problems, ReadOptions, Written};
use crate::geo::{Degrees7, LatLon};
use crate::plan::WaypointType;
use crate::plan::feature::Shape;

/// Reads the text and adds problems to `problems`.
pub(super) fn read(text: &str, options: &ReadOptions, problems: &mut Problems<'_>) -> PlanFile {
    let map = Map::read(MapKind::GeoJson, text, problems);
    if !problems.is_empty() {
        return PlanFile::default();
    }
    let mut builder = Builder::new(&map, options, problems, false);
    let has_points = map.features.iter().any(is_waypoint) || points(&map).next().is_some();
    if options.feature.is_none() && has_points && !options.ring {
        waypoints(&mut builder);
        return builder.finish();
    }
    match builder.choose() {
        Choice::Line(line) => builder.line(&line),
        Choice::Refused => return PlanFile::default(),
        // Our own plan without waypoints.
        Choice::None if builder.is_own_file() => {}
        Choice::None => {
            builder.refuse_nothing();
            return PlanFile::default();
        }
    }
    builder.finish()
}

fn is_waypoint(feature: &MapFeature) -> bool {
    // Other programs keep our properties when they convert a KML file.
    feature.properties.get("featureType") == Some("waypoint") || own_type(&feature.properties).is_some()
}

/// Reads the features that are waypoints, or else all points, in the order of their numbers.
fn waypoints(builder: &mut Builder<'_, '_, '_>) {
    let map = builder.map;
    let marked = map.features.iter().any(is_waypoint);
    let reads_own = marked && builder.reads_own_data();
    let of_features = map.features.iter().enumerate().filter(|(_, feature)| is_waypoint(feature));
    let mut found: Vec<Spot<'_>> = if marked {
        of_features
            .map(|(index, feature)| {
                let vertex = feature.pieces.iter().find_map(|piece| match piece.shape {
                    Shape::Point(vertex) => Some((vertex, piece.altitudes)),
                    Shape::Line(_) | Shape::Area(_) => None,
                });
                spot(index + 1, feature, vertex)
            })
            .collect()
    } else {
        let of_points = points(map).filter_map(|(item, feature, piece)| match piece.shape {
            Shape::Point(vertex) => Some(spot(item, feature, Some((vertex, piece.altitudes)))),
            Shape::Line(_) | Shape::Area(_) => None,
        });
        of_points.collect()
    };
    let number = |spot: &Spot<'_>| {
        spot.properties.get("sequenceNumber").and_then(|text| text.parse().ok()).unwrap_or(u64::MAX)
    };
    found.sort_by_key(number);
    for spot in &found {
        match own_type(spot.properties).filter(|_| reads_own) {
            Some(kind) => builder.own(spot, kind),
            None => command(builder, spot),
        }
    }
    map.features.iter().for_each(|feature| builder.wrapped(feature));
    if !marked
        && map
            .features
            .iter()
            .any(|feature| feature.pieces.iter().any(|piece| matches!(piece.shape, Shape::Line(_))))
    {
        let why = "the file has points and lines, the points are the plan: choose a line with --feature";
        builder.finding(Finding::new(Severity::Assumed, "lines", why));
    }
}

fn spot(
    item: usize,
    feature: &MapFeature,
    vertex: Option<(crate::plan::feature::Vertex, super::map_file::Altitudes)>,
) -> Spot<'_> {
    Spot { item, place: feature.place.as_ref(), at: feature.at, properties: &feature.properties, vertex }
}

/// Adds a point with the type for the MAVLink command that QGroundControl exports with it.
fn command(builder: &mut Builder<'_, '_, '_>, spot: &Spot<'_>) {
    match spot.properties.get("command") {
        None | Some("16") => builder.plain(spot),
        Some("17") => builder.point(spot, WaypointType::Hold),
        Some("21") => builder.land(spot),
        Some("22") => builder.point(spot, WaypointType::Takeoff),
        Some(other) => {
            let plain = builder.options.waypoint_as;
            let why = "the parameters of the command are not in the file, so it is a plain waypoint";
            let finding = Finding::new(Severity::Lost, "command", why).item(spot.item);
            let place: Option<Place> = spot.place.cloned();
            builder
                .finding(Finding { place, ..finding }.values(format!("command {other}"), plain.to_string()));
            builder.point(spot, plain);
        }
    }
}

/// Writes a plan.
pub(super) fn write(file: &PlanFile) -> Written {
    let mut losses = map_data::losses(file, "polygon");
    let home_amsl_m = file.home.and_then(|home| home.amsl_m);
    if home_amsl_m.is_none() && !file.plan.waypoints.is_empty() {
        let why = "the altitude of home above sea level is unknown, so other programs see no altitudes: \
                   add --home LAT,LON,AMSL";
        losses.add(Finding::new(Severity::Info, "altitude", why));
    }
    let mut features = Vec::new();
    if let Some(home) = file.home {
        // A number of more digits may come back as its neighbour.
        let exact = |amsl: f64| match amsl.to_string() {
            long if long.len() > 15 => format!("\"{long}\""),
            short => short,
        };
        let amsl = home.amsl_m.map_or(String::new(), |amsl| format!(",\"alt_amsl_m\":{}", exact(amsl)));
        let properties = format!("\"featureType\":\"home\",\"name\":\"Home\",\"type\":\"{HOME}\"{amsl}");
        let point = position(home.position, home.amsl_m);
        features.push(feature(&format!("{{\"type\":\"Point\",\"coordinates\":{point}}}"), &properties));
    }
    let path: Vec<String> = map_data::places(file)
        .map(|waypoint| position(waypoint.position, map_data::amsl_m(file.home, waypoint)))
        .collect();
    if path.len() > 1 {
        let line = format!("{{\"type\":\"LineString\",\"coordinates\":[{}]}}", path.join(","));
        features.push(feature(&line, "\"featureType\":\"flightPath\",\"name\":\"Path\""));
    }
    for (index, waypoint) in file.plan.waypoints.iter().enumerate() {
        let kind = waypoint.kind;
        let amsl_m = map_data::amsl_m(file.home, waypoint);
        let mut properties = format!(
            "\"featureType\":\"waypoint\",\"sequenceNumber\":{index},\"name\":\"WP {index} {kind}\",\"altitudeRelative\":{}",
            metres(waypoint.altitude.above_home_m())
        );
        if let Some(amsl_m) = amsl_m.filter(|_| kind.capability().altitude) {
            properties.push_str(&format!(",\"altitudeAMSL\":{}", metres(amsl_m)));
        }
        for (key, value) in map_data::values((*waypoint).into()) {
            let is_word = matches!(key, "type" | "pattern");
            let value = if is_word { format!("\"{value}\"") } else { value };
            properties.push_str(&format!(",\"{key}\":{value}"));
        }
        let point = position(waypoint.position, amsl_m);
        let geometry = if kind.uses_position() {
            format!("{{\"type\":\"Point\",\"coordinates\":{point}}}")
        } else {
            "null".to_owned()
        };
        features.push(feature(&geometry, &properties));
    }
    if let Some((_, fence)) = map_data::fence(file) {
        let ring: Vec<String> = fence.into_iter().map(|point| position(point, None)).collect();
        let polygon = format!("{{\"type\":\"Polygon\",\"coordinates\":[[{}]]}}", ring.join(","));
        features
            .push(feature(&polygon, "\"featureType\":\"geofence\",\"inclusion\":true,\"name\":\"Fence\""));
    }
    let quoted = |text: &String| serde_json::Value::from(text.as_str()).to_string();
    let settings: Vec<String> = file.settings.iter().map(quoted).collect();
    let text = format!(
        "{{\"type\":\"FeatureCollection\",\n\"betadeck\":{{\"version\":{VERSION},\"name\":{},\"description\":{},\
         \"settings\":[{}]}},\n\"features\":[\n{}\n]}}\n",
        quoted(&file.name),
        quoted(&file.description),
        settings.join(","),
        features.join(",\n")
    );
    Written { contents: text.into_bytes(), losses }
}

fn position(position: LatLon, amsl_m: Option<f64>) -> String {
    let (lat, lon) = (Degrees7(position.lat_e7), Degrees7(position.lon_e7));
    let third = amsl_m.map_or(String::new(), |amsl_m| format!(",{}", metres(amsl_m)));
    format!("[{lon},{lat}{third}]")
}

fn feature(geometry: &str, properties: &str) -> String {
    format!("{{\"type\":\"Feature\",\"properties\":{{{properties}}},\"geometry\":{geometry}}}")
}

#[cfg(test)]
mod tests;
