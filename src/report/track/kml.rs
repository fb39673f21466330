//! A track as KML: a `gx:Track` with times, and lines in the colours of the states.

use super::{Track, TrackPoint, look};
use crate::geo::Degrees7;
use crate::report::xml::escaped;

impl Track {
    /// Returns the document.
    pub fn kml(&self) -> String {
        let mut text = format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- {} -->\n\
             <kml xmlns=\"http://www.opengis.net/kml/2.2\" xmlns:gx=\"http://www.google.com/kml/ext/2.2\">\n<Document>\n",
            escaped(&self.header.creator)
        );
        text.push_str(&format!("  <name>{}</name>\n", escaped(&self.header.track)));
        let mut styles = Vec::new();
        for (state, _) in self.parts() {
            let ([red, green, blue], name) = look(state);
            if !styles.contains(&name) {
                styles.push(name);
                let colour = format!("ff{blue:02x}{green:02x}{red:02x}");
                text.push_str(&format!(
                    "  <Style id=\"{name}\"><LineStyle><color>{colour}</color><width>3</width></LineStyle></Style>\n"
                ));
            }
        }
        if !self.points.is_empty() {
            text.push_str("  <Placemark>\n    <name>Track</name>\n    <gx:Track>\n");
            text.push_str("      <altitudeMode>absolute</altitudeMode>\n");
            for point in &self.points {
                text.push_str(&format!("      <when>{}</when>\n", self.instant(point)));
            }
            for point in &self.points {
                text.push_str(&format!("      <gx:coord>{}</gx:coord>\n", self.triple(point, ' ')));
            }
            text.push_str("    </gx:Track>\n  </Placemark>\n  <Folder>\n    <name>States</name>\n");
            self.parts().for_each(|(state, part)| self.push_part(look(state).1, part, &mut text));
            text.push_str("  </Folder>\n");
        }
        for (index, waypoint, amsl_m) in self.waypoints() {
            let (lat, lon) = (Degrees7(waypoint.position.lat_e7), Degrees7(waypoint.position.lon_e7));
            text.push_str(&format!(
                "  <Placemark>\n    <name>WP{index} {}</name>\n    <Point><altitudeMode>absolute</altitudeMode>\
                 <coordinates>{lon},{lat},{amsl_m:.2}</coordinates></Point>\n  </Placemark>\n",
                waypoint.kind
            ));
        }
        text.push_str("</Document>\n</kml>\n");
        text
    }

    fn triple(&self, point: &TrackPoint, between: char) -> String {
        let TrackPoint { lat_deg, lon_deg, .. } = point;
        format!("{lon_deg:.7}{between}{lat_deg:.7}{between}{:.2}", self.amsl_m(point))
    }

    fn push_part(&self, name: &str, part: &[TrackPoint], text: &mut String) {
        let (Some(first), Some(last)) = (part.first(), part.last()) else { return };
        text.push_str(&format!(
            "    <Placemark>\n      <name>{name}</name>\n      \
             <TimeSpan><begin>{}</begin><end>{}</end></TimeSpan>\n      <styleUrl>#{name}</styleUrl>\n      \
             <LineString><altitudeMode>absolute</altitudeMode><coordinates>\n",
            self.instant(first),
            self.instant(last)
        ));
        for point in part {
            text.push_str(&format!("        {}\n", self.triple(point, ',')));
        }
        text.push_str("      </coordinates></LineString>\n    </Placemark>\n");
    }
}
