//! The track of a flight with the states of the autopilot, written at the end of the flight as KML or as GeoJSON.
//! Times are simulated, as in the GPX track, so that equal flights give equal files.

mod geojson;
mod kml;

use super::gpx::{GpxHeader, UtcSeconds};
use crate::plan::FlightPlan;
use crate::signals::SimTime;
use crate::telemetry::NavState;

/// One place of the track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackPoint {
    pub time: SimTime,
    /// Latitude, degrees.
    pub lat_deg: f64,
    /// Longitude, degrees.
    pub lon_deg: f64,
    /// Above home, m.
    pub alt_m: f64,
    /// The state of the autopilot, if it is known.
    pub state: Option<NavState>,
}

/// A track.
#[derive(Debug, Clone)]
pub struct Track {
    header: GpxHeader,
    plan: FlightPlan,
    points: Vec<TrackPoint>,
}

impl Track {
    /// Begins the track of a flight of this plan.
    pub fn new(header: GpxHeader, plan: FlightPlan) -> Self {
        Self { header, plan, points: Vec::new() }
    }

    /// Adds a place. Leaves out places that are not on the globe.
    pub fn add(&mut self, point: TrackPoint) {
        let on_globe = point.lat_deg.abs() <= 90.0 && point.lon_deg.abs() <= 180.0 && point.alt_m.is_finite();
        if on_globe {
            self.points.push(point);
        }
    }

    /// Returns the parts of the track with the same state. Each also has the first point of the next one, so that the
    /// line has no gap.
    fn parts(&self) -> impl Iterator<Item = (Option<NavState>, &[TrackPoint])> {
        let mut start = 0;
        std::iter::from_fn(move || {
            let state = self.points.get(start)?.state;
            let same = self.points[start..].iter().take_while(|point| point.state == state).count();
            let end = (start + same + 1).min(self.points.len());
            let part = &self.points[start..end];
            start += same;
            Some((state, part))
        })
        .filter(|(_, part)| part.len() > 1)
    }

    /// Returns the waypoints that are a place, with their numbers and their altitudes above sea level.
    fn waypoints(&self) -> impl Iterator<Item = (usize, &crate::plan::Waypoint, f64)> {
        let places = self
            .plan
            .waypoints
            .iter()
            .enumerate()
            .filter(|(_, waypoint)| waypoint.kind.uses_position() && waypoint.position.is_on_globe());
        places.map(|(index, waypoint)| {
            (index, waypoint, self.header.home_amsl_m + waypoint.altitude.above_home_m())
        })
    }

    fn amsl_m(&self, point: &TrackPoint) -> f64 {
        self.header.home_amsl_m + point.alt_m
    }

    /// Returns the instant of a point with milliseconds: `2026-01-01T00:00:00.200Z`.
    fn instant(&self, point: &TrackPoint) -> String {
        let UtcSeconds(boot) = self.header.boot;
        let whole = UtcSeconds(boot).plus(point.time.0 / 1_000_000).to_string();
        format!("{}.{:03}Z", whole.trim_end_matches('Z'), point.time.0 / 1000 % 1000)
    }
}

/// Returns the colour of a state, red, green and blue, and its name.
fn look(state: Option<NavState>) -> ([u8; 3], &'static str) {
    let colour = match state {
        None => [0x80, 0x80, 0x80],
        Some(NavState::Idle) => [0xb0, 0xb0, 0xb0],
        Some(NavState::Approaching) => [0x20, 0x90, 0xff],
        Some(NavState::Arrived) => [0x00, 0xd0, 0xd0],
        Some(NavState::Holding) => [0xff, 0xd0, 0x00],
        Some(NavState::Orbiting) => [0xff, 0x90, 0x00],
        Some(NavState::Figure8) => [0xd0, 0x60, 0xff],
        Some(NavState::Landing) => [0xff, 0x30, 0x30],
        Some(NavState::Complete) => [0x20, 0xc0, 0x40],
    };
    (colour, state.map_or("UNKNOWN", Into::into))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::plan::feature::Shape;
    use crate::plan::format::read_features;
    use crate::plan::{Altitude, Waypoint, WaypointType};

    fn track() -> Track {
        let header = GpxHeader {
            creator: "betadeck (simulated)".to_owned(),
            track: "a & \"b\"".to_owned(),
            home_amsl_m: 300.0,
            boot: UtcSeconds::SIMULATED_BOOT,
        };
        let mut plan = FlightPlan::default();
        plan.waypoints.push(Waypoint { kind: WaypointType::Delay, ..Waypoint::default() });
        plan.waypoints.push(Waypoint {
            position: LatLon::new(404_640_000, -795_175_000),
            altitude: Altitude::above_home(50.0),
            kind: WaypointType::Flyby,
            ..Waypoint::default()
        });
        let mut track = Track::new(header, plan);
        let point = |us, lat_deg, state| TrackPoint {
            time: SimTime(us),
            lat_deg,
            lon_deg: -79.518_2,
            alt_m: 1.25,
            state,
        };
        let approaching = Some(NavState::Approaching);
        track.add(point(0, 40.0, Some(NavState::Idle)));
        track.add(point(500_000, 41.0, Some(NavState::Idle)));
        track.add(point(1_000_000, 42.0, approaching));
        track.add(point(1_200_000, f64::NAN, approaching));
        track.add(point(2_000_000, 43.0, approaching));
        track
    }

    #[test]
    fn kml_has_a_track_and_parts_by_state() {
        assert_eq!(
            track().kml(),
            r#"<?xml version="1.0" encoding="UTF-8"?>
<!-- betadeck (simulated) -->
<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2">
<Document>
  <name>a &amp; &quot;b&quot;</name>
  <Style id="IDLE"><LineStyle><color>ffb0b0b0</color><width>3</width></LineStyle></Style>
  <Style id="APPROACHING"><LineStyle><color>ffff9020</color><width>3</width></LineStyle></Style>
  <Placemark>
    <name>Track</name>
    <gx:Track>
      <altitudeMode>absolute</altitudeMode>
      <when>2026-01-01T00:00:00.000Z</when>
      <when>2026-01-01T00:00:00.500Z</when>
      <when>2026-01-01T00:00:01.000Z</when>
      <when>2026-01-01T00:00:02.000Z</when>
      <gx:coord>-79.5182000 40.0000000 301.25</gx:coord>
      <gx:coord>-79.5182000 41.0000000 301.25</gx:coord>
      <gx:coord>-79.5182000 42.0000000 301.25</gx:coord>
      <gx:coord>-79.5182000 43.0000000 301.25</gx:coord>
    </gx:Track>
  </Placemark>
  <Folder>
    <name>States</name>
    <Placemark>
      <name>IDLE</name>
      <TimeSpan><begin>2026-01-01T00:00:00.000Z</begin><end>2026-01-01T00:00:01.000Z</end></TimeSpan>
      <styleUrl>#IDLE</styleUrl>
      <LineString><altitudeMode>absolute</altitudeMode><coordinates>
        -79.5182000,40.0000000,301.25
        -79.5182000,41.0000000,301.25
        -79.5182000,42.0000000,301.25
      </coordinates></LineString>
    </Placemark>
    <Placemark>
      <name>APPROACHING</name>
      <TimeSpan><begin>2026-01-01T00:00:01.000Z</begin><end>2026-01-01T00:00:02.000Z</end></TimeSpan>
      <styleUrl>#APPROACHING</styleUrl>
      <LineString><altitudeMode>absolute</altitudeMode><coordinates>
        -79.5182000,42.0000000,301.25
        -79.5182000,43.0000000,301.25
      </coordinates></LineString>
    </Placemark>
  </Folder>
  <Placemark>
    <name>WP1 FLYBY</name>
    <Point><altitudeMode>absolute</altitudeMode><coordinates>-79.5175000,40.4640000,350.00</coordinates></Point>
  </Placemark>
</Document>
</kml>
"#
        );
    }

    #[test]
    fn geojson_has_a_line_a_state() {
        let text = track().geojson();
        let mut lines = text.lines();
        assert_eq!(
            lines.next(),
            Some(
                "{\"type\":\"FeatureCollection\",\"generator\":\"betadeck (simulated)\",\"name\":\"a & \\\"b\\\"\",\"features\":["
            )
        );
        assert_eq!(
            lines.nth(1),
            Some(
                "{\"type\":\"Feature\",\"properties\":{\"featureType\":\"flight\",\"name\":\"APPROACHING\",\"stroke\":\"#2090ff\",\
                 \"coordTimes\":[\"2026-01-01T00:00:01.000Z\",\"2026-01-01T00:00:02.000Z\"]},\
                 \"geometry\":{\"type\":\"LineString\",\"coordinates\":[[-79.5182000,42.0000000,301.25],[-79.5182000,43.0000000,301.25]]}},"
            )
        );
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(json["features"].as_array().map(Vec::len), Some(3));
    }

    #[test]
    fn a_flight_is_a_backdrop() {
        for text in [track().kml(), track().geojson()] {
            let features = read_features("track", text.as_bytes()).unwrap();
            let lines = features.iter().filter(|feature| matches!(feature.shape, Shape::Line(_))).count();
            assert!(lines >= 2, "{features:?}");
        }
        let empty = Track { points: Vec::new(), plan: FlightPlan::default(), ..track() };
        assert_eq!(read_features("track", empty.kml().as_bytes()).unwrap(), []);
        assert_eq!(read_features("track", empty.geojson().as_bytes()).unwrap(), []);
    }
}
