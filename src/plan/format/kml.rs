//! KML: plans as points with data, the path as a line, the fence as a closed line.

use super::loss::{Finding, LossReport, Severity};
use super::map_choice::{Choice, points};
use super::map_data::{self, HOME, VERSION, metres, own_type};
use super::map_file::{MapFeature, MapKind, kmz};
use super::map_plan::{Builder, Map, Spot};
use super::xml::{carried, escaped};
use super::{PlanFile, Problems, ReadOptions, WriteOptions, Written};
use crate::geo::{Degrees7, LatLon};
use crate::plan::Waypoint;
use crate::plan::feature::Shape;

/// Reads the text and adds problems to `problems`.
pub(super) fn read(text: &str, options: &ReadOptions, problems: &mut Problems<'_>) -> PlanFile {
    let map = Map::read(MapKind::Kml, text, problems);
    if !problems.is_empty() {
        return PlanFile::default();
    }
    let mut builder = Builder::new(&map, options, problems, true);
    let is_own = |feature: &&MapFeature| own_type(&feature.properties).is_some();
    let has_own = map.features.iter().any(|feature| is_own(&feature));
    if options.feature.is_none() && has_own && builder.reads_own_data() {
        own(&mut builder);
        return builder.finish();
    }
    match builder.choose() {
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
                let vertex = Some((vertex, piece.altitudes));
                builder.plain(&spot(item, feature, vertex));
            }
        }
    }
    builder.finish()
}

/// Reads our own waypoints, and the points that another program added between them.
fn own(builder: &mut Builder<'_, '_, '_>) {
    let map = builder.map;
    for (index, feature) in map.features.iter().enumerate() {
        let point = feature.pieces.iter().find_map(|piece| match piece.shape {
            Shape::Point(vertex) => Some((vertex, piece.altitudes)),
            Shape::Line(_) | Shape::Area(_) => None,
        });
        let spot = spot(index + 1, feature, point);
        builder.wrapped(feature);
        match own_type(&feature.properties) {
            Some(kind) => builder.own(&spot, kind),
            None if point.is_some() && feature.properties.get("type") != Some(HOME) => {
                builder.plain(&spot);
            }
            None => {}
        }
    }
}

fn spot(
    item: usize,
    feature: &MapFeature,
    vertex: Option<(crate::plan::feature::Vertex, super::map_file::Altitudes)>,
) -> Spot<'_> {
    Spot { item, place: feature.place.as_ref(), at: feature.at, properties: &feature.properties, vertex }
}

/// Writes a plan.
pub(super) fn write(file: &PlanFile, options: &WriteOptions) -> Written {
    match document(file, options) {
        Ok((text, losses)) => Written { contents: text.into_bytes(), losses },
        Err(losses) => Written { contents: Vec::new(), losses },
    }
}

/// Writes a plan as an archive.
pub(super) fn write_archive(file: &PlanFile, options: &WriteOptions) -> Written {
    let (text, mut losses) = match document(file, options) {
        Ok(document) => document,
        Err(losses) => return Written { contents: Vec::new(), losses },
    };
    let contents = kmz::packed(&text).unwrap_or_else(|message| {
        losses.add(Finding::new(Severity::Refused, "archive", message));
        Vec::new()
    });
    Written { contents, losses }
}

/// The reference of the altitudes of a document.
#[derive(Clone, Copy)]
struct Heights {
    /// The altitude of home above sea level if altitudes are above sea level.
    home_amsl_m: Option<f64>,
}

impl Heights {
    fn mode(self) -> &'static str {
        if self.home_amsl_m.is_some() { "absolute" } else { "relativeToGround" }
    }

    /// Returns the third number of a waypoint with its comma.
    fn third(self, waypoint: &Waypoint) -> String {
        let metres_above =
            map_data::above_home_m(waypoint).map(|above| above + self.home_amsl_m.unwrap_or(0.0));
        metres_above
            .filter(|height| height.abs() <= 20_000.0)
            .map_or(String::new(), |height| format!(",{}", metres(height)))
    }
}

fn document(file: &PlanFile, options: &WriteOptions) -> Result<(String, LossReport), LossReport> {
    let mut losses = map_data::losses(file, "closed line");
    map_data::add_text_losses(file, &mut losses);
    let home_amsl_m = file.home.and_then(|home| home.amsl_m).filter(|_| options.absolute);
    if options.absolute && home_amsl_m.is_none() {
        let why = "the altitude of home above sea level is unknown: add --home LAT,LON,AMSL, or leave out --absolute";
        losses.add(Finding::new(Severity::Refused, "altitude", why));
        return Err(losses);
    }
    let heights = Heights { home_amsl_m };
    if home_amsl_m.is_none() {
        let why = "heights above home are drawn above the ground, which is the same on flat ground only";
        losses.add(Finding::new(Severity::Info, "altitude", why).values("above home", "above ground"));
    }
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
        <kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n"
        .to_owned();
    text.push_str(&format!("  <name>{}</name>\n", escaped(map_data::xml_name(file))));
    if !carried(&file.description).is_empty() {
        text.push_str(&format!("  <description>{}</description>\n", escaped(&file.description)));
    }
    text.push_str(&look_at(file));
    text.push_str(
        "  <Style id=\"path\"><LineStyle><color>ff00ffff</color><width>3</width></LineStyle></Style>\n  \
         <Style id=\"fence\"><LineStyle><color>ff0000ff</color><width>2</width></LineStyle></Style>\n",
    );
    let settings = file.settings.iter().map(|line| ("setting", line.clone()));
    let own = std::iter::once(("betadeck", VERSION.to_owned())).chain(settings);
    text.push_str(&extended_data("  ", own));
    if let Some(home) = file.home {
        let amsl = home.amsl_m.map(|amsl| ("alt_amsl_m", amsl.to_string()));
        let data = std::iter::once(("type", HOME.to_owned())).chain(amsl);
        let (mode, third) = match home.amsl_m {
            Some(amsl) => ("absolute", format!(",{}", metres(amsl))),
            None => ("clampToGround", String::new()),
        };
        let point = format!("{}{third}", lon_lat(home.position));
        text.push_str(&point_placemark("Home", data, Some((mode, point))));
    }
    let path: Vec<String> = map_data::places(file)
        .map(|waypoint| format!("{}{}", lon_lat(waypoint.position), heights.third(waypoint)))
        .collect();
    if path.len() > 1 {
        text.push_str(&line_placemark("Path", "path", "", heights.mode(), &path));
    }
    for (index, waypoint) in file.plan.waypoints.iter().enumerate() {
        let data = map_data::values((*waypoint).into());
        let point = format!("{}{}", lon_lat(waypoint.position), heights.third(waypoint));
        let shape = waypoint.kind.uses_position().then_some((heights.mode(), point));
        let name = format!("WP {index} {}", waypoint.kind);
        text.push_str(&point_placemark(&name, data.into_iter(), shape));
    }
    if let Some((_, fence)) = map_data::fence(file) {
        let fence: Vec<String> = fence.into_iter().map(lon_lat).collect();
        let data = extended_data("    ", std::iter::once(("featureType", "geofence".to_owned())));
        text.push_str(&line_placemark("Fence", "fence", &data, "clampToGround", &fence));
    }
    text.push_str("</Document>\n</kml>\n");
    Ok((text, losses))
}

fn lon_lat(position: LatLon) -> String {
    format!("{},{}", Degrees7(position.lon_e7), Degrees7(position.lat_e7))
}

/// Returns the view of the whole plan.
fn look_at(file: &PlanFile) -> String {
    let places = || map_data::places(file).map(|waypoint| waypoint.position);
    let Some(centre) = file.home.map(|home| home.position).or_else(|| places().next()) else {
        return String::new();
    };
    let distance = |position| crate::geo::distance_bearing(centre, position).0;
    let range = places().map(distance).fold(100.0, f64::max) * 2.5;
    let (lat, lon) = (Degrees7(centre.lat_e7), Degrees7(centre.lon_e7));
    format!(
        "  <LookAt><longitude>{lon}</longitude><latitude>{lat}</latitude><altitude>0</altitude>\
         <heading>0</heading><tilt>0</tilt><range>{range:.0}</range></LookAt>\n"
    )
}

fn extended_data(indent: &str, data: impl Iterator<Item = (&'static str, String)>) -> String {
    let mut text = format!("{indent}<ExtendedData>\n");
    for (key, value) in data {
        let value = escaped(&value);
        text.push_str(&format!("{indent}  <Data name=\"{key}\"><value>{value}</value></Data>\n"));
    }
    text.push_str(&format!("{indent}</ExtendedData>\n"));
    text
}

/// Writes a placemark with a point, of altitude mode and coordinates, or without one.
fn point_placemark(
    name: &str,
    data: impl Iterator<Item = (&'static str, String)>,
    point: Option<(&str, String)>,
) -> String {
    let data = extended_data("    ", data);
    let point = point.map_or(String::new(), |(mode, coordinates)| {
        let mode = format!("<altitudeMode>{mode}</altitudeMode>");
        format!("    <Point>{mode}<coordinates>{coordinates}</coordinates></Point>\n")
    });
    format!("  <Placemark>\n    <name>{name}</name>\n{data}{point}  </Placemark>\n")
}

fn line_placemark(name: &str, style: &str, data: &str, mode: &str, points: &[String]) -> String {
    // A line on the ground follows it only if it is tessellated.
    let tessellate = if mode == "clampToGround" { "<tessellate>1</tessellate>" } else { "" };
    format!(
        "  <Placemark>\n    <name>{name}</name>\n    <styleUrl>#{style}</styleUrl>\n{data}    \
         <LineString>{tessellate}<altitudeMode>{mode}</altitudeMode><coordinates>\n      {}\n    \
         </coordinates></LineString>\n  </Placemark>\n",
        points.join("\n      ")
    )
}

#[cfg(test)]
mod tests;
