//! GPX 1.1: a plan as one route, with our data as extensions of its points.

use super::loss::{Finding, Severity};
use super::map_choice::{Choice, points};
use super::map_data::{self, HOME, VERSION, metres, own_type};
use super::map_file::{Kind, MapFeature, MapKind};
use super::map_plan::{Builder, Map, Spot};
use super::xml::{carried, escaped};
use super::{PlanFile, Problems, ReadOptions, Written};
use crate::geo::{Degrees7, LatLon};
use crate::plan::WaypointType;
use crate::plan::feature::Shape;

/// Reads the text and adds problems to `problems`.
pub(super) fn read(text: &str, options: &ReadOptions, problems: &mut Problems<'_>) -> PlanFile {
    let map = Map::read(MapKind::Gpx, text, problems);
    if !problems.is_empty() {
        return PlanFile::default();
    }
    let mut builder = Builder::new(&map, options, problems, false);
    match builder.choose() {
        Choice::Line(line) if is_own(line.feature) && builder.reads_own_data() => {
            let feature = line.feature;
            for (index, (detail, vertex)) in feature.details.iter().zip(line.vertices()).enumerate() {
                let vertex = Some((*vertex, line.piece.altitudes));
                let (at, properties) = (detail.at, &detail.properties);
                let spot = Spot { item: index + 1, place: feature.place.as_ref(), at, properties, vertex };
                match own_type(properties) {
                    // A plain point, and the approach to a landing, need no data but the type and the place.
                    Some(kind @ (WaypointType::Flyover | WaypointType::Flyby | WaypointType::Land)) => {
                        builder.own(&spot, kind);
                    }
                    Some(kind) if map_data::has_data(properties) => builder.own(&spot, kind),
                    Some(kind) => builder.without_data(&spot, kind),
                    None => builder.plain(&spot),
                }
            }
        }
        Choice::Line(line) => builder.line(&line),
        Choice::Refused => return PlanFile::default(),
        Choice::None if points(&map).next().is_none() && !builder.is_own_file() => {
            builder.refuse_nothing();
            return PlanFile::default();
        }
        // Our own plan without waypoints.
        Choice::None if builder.is_own_file() => {}
        Choice::None => {
            for (item, feature, piece) in points(&map) {
                let Shape::Point(vertex) = piece.shape else { continue };
                builder.wrapped(feature);
                let MapFeature { place, at, properties, .. } = feature;
                let vertex = Some((vertex, piece.altitudes));
                let spot = Spot { item, place: place.as_ref(), at: *at, properties, vertex };
                builder.plain(&spot);
            }
        }
    }
    builder.finish()
}

/// Returns `true` if a route has waypoints of ours.
fn is_own(feature: &MapFeature) -> bool {
    feature.pieces.iter().all(|piece| piece.kind == Kind::Line)
        && feature.details.iter().any(|detail| own_type(&detail.properties).is_some())
}

/// Writes a plan.
pub(super) fn write(file: &PlanFile) -> Written {
    let mut losses = map_data::losses(file, "");
    map_data::add_text_losses(file, &mut losses);
    if map_data::fence(file).is_some() {
        losses.findings.retain(|finding| finding.field != "fence");
        let why = "GPX has no areas";
        losses.add(Finding::new(Severity::Info, "fence", why));
    }
    if file.home.and_then(|home| home.amsl_m).is_none() && !file.plan.waypoints.is_empty() {
        let why = "GPX has altitudes above sea level, and that of home is unknown: give the plan a home, or `convert` one by --home LAT,LON,AMSL";
        losses.add(Finding::new(Severity::Lost, "altitude", why).values("above home", ""));
    }
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
        <gpx version=\"1.1\" creator=\"betadeck\" xmlns=\"http://www.topografix.com/GPX/1/1\" \
        xmlns:b=\"urn:betadeck:1\">\n"
        .to_owned();
    text.push_str(&format!("  <metadata>\n    <name>{}</name>\n", escaped(map_data::xml_name(file))));
    if !carried(&file.description).is_empty() {
        text.push_str(&format!("    <desc>{}</desc>\n", escaped(&file.description)));
    }
    let settings = file.settings.iter().map(|line| ("setting", line.clone()));
    let own = std::iter::once(("betadeck", VERSION.to_owned())).chain(settings);
    text.push_str(&extensions("    ", own));
    text.push_str("  </metadata>\n");
    if let Some(home) = file.home {
        let ele = home.amsl_m.map(metres);
        let amsl = home.amsl_m.map(|amsl| ("alt_amsl_m", amsl.to_string()));
        text.push_str(&point("  ", "wpt", home.position, ele, "Home", HOME, amsl.into_iter()));
    }
    text.push_str(&format!("  <rte>\n    <name>{}</name>\n", escaped(map_data::xml_name(file))));
    for (index, waypoint) in file.plan.waypoints.iter().enumerate() {
        let kind = waypoint.kind;
        let ele = map_data::amsl_m(file.home, waypoint).filter(|_| kind.capability().altitude).map(metres);
        let own = map_data::values((*waypoint).into()).into_iter().filter(|(key, _)| *key != "type");
        let name = format!("WP {index} {kind}");
        text.push_str(&point("    ", "rtept", drawn(file, index), ele, &name, &kind.to_string(), own));
    }
    text.push_str("  </rte>\n</gpx>\n");
    Written { contents: text.into_bytes(), losses }
}

/// Returns the place of a waypoint in the route. One that is not a place has that of its neighbour.
fn drawn(file: &PlanFile, index: usize) -> LatLon {
    let (before, after) = file.plan.waypoints.split_at(index);
    let place = |waypoint: &crate::plan::Waypoint| waypoint.kind.uses_position().then_some(waypoint.position);
    let own = after.first().and_then(place);
    let near = || before.iter().rev().find_map(place);
    let far = || after.iter().find_map(place);
    own.or_else(near).or_else(|| file.home.map(|home| home.position)).or_else(far).unwrap_or_default()
}

fn point(
    indent: &str,
    element: &str,
    position: LatLon,
    ele: Option<String>,
    name: &str,
    kind: &str,
    own: impl Iterator<Item = (&'static str, String)>,
) -> String {
    let (lat, lon) = (Degrees7(position.lat_e7), Degrees7(position.lon_e7));
    let ele = ele.map_or(String::new(), |ele| format!("<ele>{ele}</ele>"));
    let mut own = own.peekable();
    let own = if own.peek().is_some() { extensions(&format!("{indent}  "), own) } else { String::new() };
    format!(
        "{indent}<{element} lat=\"{lat}\" lon=\"{lon}\">{ele}<name>{name}</name><type>{kind}</type>\n{own}\
         {indent}</{element}>\n"
    )
}

fn extensions(indent: &str, own: impl Iterator<Item = (&'static str, String)>) -> String {
    let own: String = own.map(|(key, value)| format!("<b:{key}>{}</b:{key}>", escaped(&value))).collect();
    format!("{indent}<extensions>{own}</extensions>\n")
}

#[cfg(test)]
mod tests;
