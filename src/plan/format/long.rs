//! Files with more waypoints than a plan holds. They are shown, simplified and split, and not flown.

use super::PlanFile;
use super::loss::{Finding, Severity};
use super::thinned::thinned;
use crate::plan::feature::Vertex;
use crate::plan::{FlightPlan, MAX_WAYPOINTS, Waypoint, WaypointType};

/// The hint for a file that is refused for its length.
pub(super) fn hint() -> String {
    format!(
        "a plan holds at most {MAX_WAYPOINTS} waypoints: `betadeck convert` with --simplify METRES leaves out points near \
         the line, with --split it writes several plans"
    )
}

impl PlanFile {
    /// Puts waypoints into the plan, and those for which it has no room into the rest.
    pub(super) fn take(&mut self, waypoints: impl IntoIterator<Item = Waypoint>) {
        let mut waypoints = waypoints.into_iter();
        self.plan = FlightPlan { waypoints: waypoints.by_ref().take(MAX_WAYPOINTS).collect() };
        self.rest = waypoints.collect();
    }

    /// Returns all waypoints of the file.
    pub fn waypoints(&self) -> Vec<Waypoint> {
        self.plan.waypoints.iter().chain(&self.rest).copied().collect()
    }

    /// Leaves out points that are nearer than `tolerance_m` to the line without them: each FLYOVER and FLYBY between two
    /// legs of the same speed.
    pub(super) fn simplify(&mut self, tolerance_m: f64) {
        let before = self.waypoints();
        let mut kept: Vec<Waypoint> = Vec::new();
        // The waypoint at which the present line begins, which is kept already. A line has waypoints with a place only.
        let mut begin = None;
        for (end, waypoint) in before.iter().enumerate() {
            let has_place = waypoint.kind.uses_position();
            match begin.filter(|_| has_place) {
                None => kept.push(*waypoint),
                Some(_) if before.get(end + 1).is_some_and(|next| is_on_the_way(waypoint, next)) => continue,
                Some(begin) => {
                    let line: Vec<Vertex> = before[begin..=end].iter().map(vertex).collect();
                    let kept_here = thinned(&line, tolerance_m, line.len()).kept;
                    kept.extend(kept_here.into_iter().skip(1).map(|index| before[begin + index]));
                }
            }
            begin = has_place.then_some(end);
        }
        if kept.len() < before.len() {
            let why = "points near the line are left out (--simplify)";
            let finding = Finding::new(Severity::Changed, "points", why);
            self.losses.add(finding.values(before.len().to_string(), kept.len().to_string()));
            self.take(kept);
        }
    }

    /// Splits the file into parts that each fit into a plan. Each part begins with the waypoint with which the one before
    /// ends.
    pub fn parts(&self) -> Vec<Self> {
        let all = self.waypoints();
        let mut rest = all.as_slice();
        let mut parts = Vec::new();
        while rest.len() > MAX_WAYPOINTS {
            let joint = joint(&rest[..MAX_WAYPOINTS]);
            parts.push(&rest[..=joint]);
            rest = &rest[joint..];
        }
        parts.push(rest);
        let named = parts.len() > 1;
        let part = |(number, waypoints): (usize, &[Waypoint])| {
            let name = if named { format!("{} {number}", self.name) } else { self.name.clone() };
            let mut part = Self { name, rest: Vec::new(), ..self.clone() };
            part.take(waypoints.iter().copied());
            part
        };
        (1..).zip(parts).map(part).collect()
    }
}

/// Returns `true` if a waypoint is only a point on the way to the next one.
fn is_on_the_way(waypoint: &Waypoint, next: &Waypoint) -> bool {
    matches!(waypoint.kind, WaypointType::Flyover | WaypointType::Flyby)
        && next.kind.uses_position()
        && waypoint.speed == next.speed
}

fn vertex(waypoint: &Waypoint) -> Vertex {
    Vertex { position: waypoint.position, altitude_m: waypoint.altitude.above_home_m() as f32 }
}

/// Returns the index of the last waypoint that ends one part and begins the next: the last one that is only passed, or
/// else the last one with a place.
fn joint(part: &[Waypoint]) -> usize {
    let last = |is: fn(&Waypoint) -> bool| part.iter().rposition(is).filter(|index| *index > 0);
    last(|waypoint| matches!(waypoint.kind, WaypointType::Flyover | WaypointType::Flyby))
        .or_else(|| last(|waypoint| waypoint.kind.uses_position()))
        .unwrap_or(part.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::{Degrees7, LatLon, offset_to_latlon};
    use crate::plan::format::{Format, ReadOptions, read, write};
    use crate::plan::{Altitude, LegSpeed};
    use nalgebra::Vector2;

    /// Returns a file with a waypoint every 10 m to the north, each second one 1 m east of the line.
    fn long(count: usize) -> PlanFile {
        let home = LatLon::new(404_635_000, -795_182_000);
        let waypoint = |index: usize| Waypoint {
            position: offset_to_latlon(home, Vector2::new(10.0 * index as f64, (index % 2) as f64)),
            altitude: Altitude::above_home(20.0),
            ..Waypoint::default()
        };
        let mut file = PlanFile { name: "field".to_owned(), ..PlanFile::default() };
        file.take((0..count).map(waypoint));
        file
    }

    /// Returns the file as a text with all its waypoints.
    fn text(file: &PlanFile) -> String {
        let written = |part: &PlanFile| write(part, Format::Csv).text().into_owned();
        let mut text = String::new();
        for part in file.waypoints().chunks(MAX_WAYPOINTS) {
            let mut piece = PlanFile::default();
            piece.take(part.iter().copied());
            let lines = written(&piece);
            let skipped = if text.is_empty() { 0 } else { lines.find('\n').unwrap() + 1 };
            text.push_str(&lines[skipped..]);
        }
        text
    }

    #[test]
    fn a_long_file_is_read_whole_if_it_is_asked_for_and_is_refused_for_a_flight() {
        let text = text(&long(75));
        let options = |long| ReadOptions { long, ..ReadOptions::default() };
        let errors = read("a.csv", text.as_bytes(), Format::Csv, &options(false)).unwrap_err();
        let said = errors[0].to_string();
        assert!(
            said.contains("75 waypoints") && said.contains("--simplify") && said.contains("--split"),
            "{said}"
        );
        let file = read("a.csv", text.as_bytes(), Format::Csv, &options(true)).unwrap();
        assert_eq!((file.plan.waypoints.len(), file.rest.len()), (30, 45));
        assert_eq!(file.waypoints(), long(75).waypoints());
        let simplified = ReadOptions { simplify_m: Some(1.5), ..options(true) };
        let file = read("a.csv", text.as_bytes(), Format::Csv, &simplified).unwrap();
        assert_eq!((file.plan.waypoints.len(), file.rest.len()), (2, 0));
    }

    #[test]
    fn parts_fit_and_repeat_the_joint() {
        for count in [0, 1, 30, 31, 59, 60, 75, 200] {
            let parts = long(count).parts();
            assert!(parts.iter().all(|part| part.rest.is_empty()));
            let mut joined = parts[0].waypoints();
            for pair in parts.windows(2) {
                assert_eq!(pair[0].plan.waypoints.last(), pair[1].plan.waypoints.first(), "{count}");
                joined.extend(&pair[1].plan.waypoints[1..]);
            }
            assert_eq!(joined, long(count).waypoints());
            assert_eq!(parts.len(), 1 + count.saturating_sub(2) / 29, "{count}");
        }
        assert_eq!(long(75).parts()[2].name, "field 3");
    }

    #[test]
    fn a_part_ends_where_the_craft_only_passes() {
        let mut all = long(40).waypoints();
        all[25..32].iter_mut().for_each(|waypoint| waypoint.kind = WaypointType::Hold);
        let mut file = PlanFile::default();
        file.take(all.clone());
        assert_eq!(file.parts().iter().map(|part| part.plan.waypoints.len()).collect::<Vec<_>>(), [25, 16]);
        all.iter_mut().for_each(|waypoint| waypoint.kind = WaypointType::Hold);
        file.take(all);
        assert_eq!(file.parts().iter().map(|part| part.plan.waypoints.len()).collect::<Vec<_>>(), [30, 11]);
    }

    #[test]
    fn a_line_begins_and_ends_at_a_waypoint_without_a_place() {
        let mut all = long(40).waypoints();
        // One point of the line between the two is far from it, the others are near.
        all[15].position = all[16].position;
        all[15].position.lon_e7 += 10_000;
        for index in [10, 20] {
            all[index] = Waypoint { kind: WaypointType::Delay, ..Waypoint::default() };
        }
        let mut file = PlanFile::default();
        file.take(all.clone());
        file.simplify(5.0);
        let expected: Vec<Waypoint> =
            [0, 9, 10, 11, 14, 15, 16, 19, 20, 21, 39].map(|index| all[index]).into();
        assert_eq!(file.waypoints(), expected);
    }

    #[test]
    fn the_points_of_a_map_are_simplified() {
        let options = ReadOptions { simplify_m: Some(1.5), long: true, ..ReadOptions::default() };
        let points: String = long(45)
            .waypoints()
            .iter()
            .map(|waypoint| {
                let LatLon { lat_e7, lon_e7 } = waypoint.position;
                format!("<wpt lat=\"{}\" lon=\"{}\"/>", Degrees7(lat_e7), Degrees7(lon_e7))
            })
            .collect();
        let gpx = format!("<gpx>{points}</gpx>");
        for (format, contents) in [
            (Format::Gpx, gpx.into_bytes()),
            (Format::Gpx, write(&long(30), Format::Gpx).contents),
            (Format::Kml, write(&long(30), Format::Kml).contents),
            (Format::Kmz, write(&long(30), Format::Kmz).contents),
            (Format::GeoJson, write(&long(30), Format::GeoJson).contents),
        ] {
            let file = read("a", &contents, format, &options).unwrap();
            assert_eq!((file.plan.waypoints.len(), file.rest.len()), (2, 0), "{format}");
            let finding = file.losses.findings.iter().find(|finding| finding.field == "points").unwrap();
            assert_eq!(finding.to, "2", "{finding}");
        }
    }

    #[test]
    fn a_large_toml_plan_is_refused_for_its_size() {
        let text = "#".repeat(600 << 10);
        let say = |long| {
            let options = ReadOptions { long, ..ReadOptions::default() };
            read("a.toml", text.as_bytes(), Format::Toml, &options).unwrap_err()[0].to_string()
        };
        assert!(say(false).contains("at most 30 waypoints"), "{}", say(false));
        let long = say(true);
        assert!(long.contains("600 KiB, a TOML plan at most 512 KiB") && !long.contains("30"), "{long}");
    }

    #[test]
    fn what_is_more_than_a_point_on_the_way_is_kept() {
        let mut all = long(40).waypoints();
        all[10].kind = WaypointType::Hold;
        all[20].speed = LegSpeed::checked(3.0).unwrap();
        let mut file = PlanFile::default();
        file.take(all.clone());
        file.simplify(5.0);
        // The first and the last one, the HOLD, and both ends of the slow leg.
        let expected: Vec<Waypoint> = [0, 10, 19, 20, 39].map(|index| all[index]).into();
        assert_eq!(file.waypoints(), expected);
        let finding = &file.losses.findings[0];
        assert!(finding.to_string().contains("points: 40 → 5"), "{finding}");
    }
}
