//! A track as GeoJSON: one line for each time in a state, and a point for each waypoint.

use super::{Track, TrackPoint, look};
use crate::geo::Degrees7;

impl Track {
    /// Returns the document.
    pub fn geojson(&self) -> String {
        let position = |point: &TrackPoint| {
            let TrackPoint { lat_deg, lon_deg, .. } = point;
            format!("[{lon_deg:.7},{lat_deg:.7},{:.2}]", self.amsl_m(point))
        };
        let joined = |texts: Vec<String>| texts.join(",");
        let parts = self.parts().map(|(state, part)| {
            let ([red, green, blue], name) = look(state);
            let times = part.iter().map(|point| format!("\"{}\"", self.instant(point))).collect();
            let positions = part.iter().map(position).collect();
            format!(
                "{{\"type\":\"Feature\",\"properties\":{{\"featureType\":\"flight\",\"name\":\"{name}\",\
                 \"stroke\":\"#{red:02x}{green:02x}{blue:02x}\",\"coordTimes\":[{}]}},\
                 \"geometry\":{{\"type\":\"LineString\",\"coordinates\":[{}]}}}}",
                joined(times),
                joined(positions)
            )
        });
        let waypoints = self.waypoints().map(|(index, waypoint, amsl_m)| {
            let (lat, lon) = (Degrees7(waypoint.position.lat_e7), Degrees7(waypoint.position.lon_e7));
            let above_m = waypoint.altitude.above_home_m();
            format!(
                "{{\"type\":\"Feature\",\"properties\":{{\"featureType\":\"waypoint\",\"sequenceNumber\":{index},\
                 \"name\":\"WP{index} {}\",\"altitudeRelative\":{above_m:.2},\"altitudeAMSL\":{amsl_m:.2}}},\
                 \"geometry\":{{\"type\":\"Point\",\"coordinates\":[{lon},{lat},{amsl_m:.2}]}}}}",
                waypoint.kind
            )
        });
        let features: Vec<String> = parts.chain(waypoints).collect();
        let [generator, name] =
            [&self.header.creator, &self.header.track].map(|text| serde_json::Value::from(text.as_str()));
        format!(
            "{{\"type\":\"FeatureCollection\",\"generator\":{generator},\"name\":{name},\"features\":[\n{}\n]}}\n",
            features.join(",\n")
        )
    }
}
