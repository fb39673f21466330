//! A GPX 1.1 track of a flight with its waypoints, with one point for each simulated second.
//!
//! GPX elevations are above mean sea level, so the altitude of home is added to altitudes above home. Times are
//! simulated: they count from an instant that the caller chooses, so that equal flights give equal files.

mod utc;

use std::io::{self, Write};

use super::xml::escaped;
use crate::geo::Degrees7;
use crate::plan::FlightPlan;
use crate::signals::SimTime;

pub use utc::UtcSeconds;

/// The header of the file.
#[derive(Debug, Clone, PartialEq)]
pub struct GpxHeader {
    /// The program that made the file.
    pub creator: String,
    /// Name of the track.
    pub track: String,
    /// Altitude of home above mean sea level, m.
    pub home_amsl_m: f64,
    /// The instant of boot.
    pub boot: UtcSeconds,
}

impl GpxHeader {
    /// Returns the header of the reference firmware simulator.
    pub fn sitl(home_amsl_m: f64, boot: UtcSeconds) -> Self {
        let (creator, track) = ("Betaflight SITL".to_owned(), "SITL Flight Track".to_owned());
        Self { creator, track, home_amsl_m, boot }
    }
}

/// One place of the track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GpxPoint {
    pub time: SimTime,
    /// Latitude, degrees.
    pub lat_deg: f64,
    /// Longitude, degrees.
    pub lon_deg: f64,
    /// Above home, m.
    pub alt_m: f64,
}

/// Writes a track during the flight. The written part is complete up to the last point; [`GpxWriter::finish`] closes
/// the document.
#[derive(Debug)]
pub struct GpxWriter<W: Write> {
    out: W,
    header: GpxHeader,
    /// The second of the last point.
    last: Option<u64>,
}

impl<W: Write> GpxWriter<W> {
    /// Writes the head of the document with a `wpt` for each waypoint of the plan that is a place.
    ///
    /// # Errors
    ///
    /// Returns the error of the output.
    pub fn new(mut out: W, header: GpxHeader, plan: &FlightPlan) -> io::Result<Self> {
        writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
        writeln!(
            out,
            "<gpx version=\"1.1\" creator=\"{}\" xmlns=\"http://www.topografix.com/GPX/1/1\">",
            escaped(&header.creator)
        )?;
        for (index, waypoint) in plan.waypoints.iter().enumerate() {
            if !waypoint.kind.uses_position() || !waypoint.position.is_on_globe() {
                continue;
            }
            let (lat, lon) = (Degrees7(waypoint.position.lat_e7), Degrees7(waypoint.position.lon_e7));
            let ele = header.home_amsl_m + waypoint.altitude.above_home_m();
            writeln!(out, "  <wpt lat=\"{lat}\" lon=\"{lon}\">")?;
            writeln!(out, "    <ele>{ele:.2}</ele>")?;
            writeln!(out, "    <name>WP{index} {}</name>", waypoint.kind)?;
            writeln!(out, "  </wpt>")?;
        }
        writeln!(out, "  <trk>")?;
        writeln!(out, "    <name>{}</name>", escaped(&header.track))?;
        writeln!(out, "    <trkseg>")?;
        out.flush()?;
        Ok(Self { out, header, last: None })
    }

    /// Writes a place if it is the first of its simulated second. Leaves out places that are not on the globe.
    ///
    /// # Errors
    ///
    /// Returns the error of the output.
    pub fn offer(&mut self, point: &GpxPoint) -> io::Result<()> {
        let second = point.time.0 / 1_000_000;
        let on_globe = point.lat_deg.abs() <= 90.0 && point.lon_deg.abs() <= 180.0 && point.alt_m.is_finite();
        if !on_globe || self.last.is_some_and(|last| last >= second) {
            return Ok(());
        }
        self.last = Some(second);
        let GpxPoint { lat_deg, lon_deg, alt_m, .. } = point;
        let ele = self.header.home_amsl_m + alt_m;
        let time = self.header.boot.plus(second);
        writeln!(self.out, "      <trkpt lat=\"{lat_deg:.7}\" lon=\"{lon_deg:.7}\">")?;
        writeln!(self.out, "        <ele>{ele:.2}</ele>")?;
        writeln!(self.out, "        <time>{time}</time>")?;
        writeln!(self.out, "      </trkpt>")?;
        self.out.flush()
    }

    /// Closes the document and returns the output.
    ///
    /// # Errors
    ///
    /// Returns the error of the output.
    pub fn finish(mut self) -> io::Result<W> {
        writeln!(self.out, "    </trkseg>")?;
        writeln!(self.out, "  </trk>")?;
        writeln!(self.out, "</gpx>")?;
        self.out.flush()?;
        Ok(self.out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::plan::{Altitude, Waypoint, WaypointType};

    fn header() -> GpxHeader {
        GpxHeader {
            creator: "betadeck <test>".to_owned(),
            track: "a & b".to_owned(),
            home_amsl_m: 300.0,
            boot: UtcSeconds::SIMULATED_BOOT,
        }
    }

    #[test]
    fn a_document_has_waypoints_and_one_point_a_second() {
        let mut plan = FlightPlan::default();
        plan.waypoints.push(Waypoint { kind: WaypointType::Delay, ..Waypoint::default() });
        plan.waypoints.push(Waypoint { kind: WaypointType::Takeoff, ..Waypoint::default() });
        plan.waypoints.push(Waypoint {
            position: LatLon::new(404_640_000, -795_175_000),
            altitude: Altitude::above_home(50.0),
            kind: WaypointType::Flyby,
            ..Waypoint::default()
        });
        let mut writer = GpxWriter::new(Vec::new(), header(), &plan).unwrap();
        let point = |us, lat_deg| GpxPoint { time: SimTime(us), lat_deg, lon_deg: -79.518_2, alt_m: 1.25 };
        for (us, lat) in
            [(0, 40.0), (999_999, 41.0), (3_000_000, 42.0), (3_500_000, 43.0), (5_000_000, f64::NAN)]
        {
            writer.offer(&point(us, lat)).unwrap();
        }
        let text = String::from_utf8(writer.finish().unwrap()).unwrap();
        // A DELAY and a TAKEOFF are not places.
        assert_eq!(
            text,
            r#"<?xml version="1.0" encoding="UTF-8"?>
<gpx version="1.1" creator="betadeck &lt;test&gt;" xmlns="http://www.topografix.com/GPX/1/1">
  <wpt lat="40.4640000" lon="-79.5175000">
    <ele>350.00</ele>
    <name>WP2 FLYBY</name>
  </wpt>
  <trk>
    <name>a &amp; b</name>
    <trkseg>
      <trkpt lat="40.0000000" lon="-79.5182000">
        <ele>301.25</ele>
        <time>2026-01-01T00:00:00Z</time>
      </trkpt>
      <trkpt lat="42.0000000" lon="-79.5182000">
        <ele>301.25</ele>
        <time>2026-01-01T00:00:03Z</time>
      </trkpt>
    </trkseg>
  </trk>
</gpx>
"#
        );
    }

    #[test]
    fn the_sitl_header_is_the_references() {
        let header = GpxHeader::sitl(300.0, UtcSeconds(0));
        assert_eq!(
            (header.creator.as_str(), header.track.as_str()),
            ("Betaflight SITL", "SITL Flight Track")
        );
    }
}
