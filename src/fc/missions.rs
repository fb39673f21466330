//! Plans as missions, and missions as plans.
//!
//! Both ways use the format of waypoint files, whose items are those of the link, with its loss report.

use std::fmt::Write as _;

use crate::geo::LatLon;
use crate::mavlink::MissionItem;
use crate::mavlink::state::GeoPosition;
use crate::mavlink::value::{MissionResult, position_frame};
use crate::plan::FlightPlan;
use crate::plan::format::loss::{Finding, LossReport, Severity};
use crate::plan::format::{self, Format, HomePosition, PlanFile, ReadOptions};

/// The first line of a waypoint file.
const HEADER: &str = "QGC WPL 110\n";
/// The fields of an item.
const FIELDS: usize = 12;
/// The name of a plan from a ground station.
pub const NAME: &str = "ground station";

/// The mission of a plan.
#[derive(Debug, Clone, Default)]
pub struct Mission {
    /// The items, without a home item.
    pub items: Vec<MissionItem>,
    /// The differences between the plan and the items, as sentences.
    pub losses: Vec<String>,
    /// The waypoint of each item.
    sources: Vec<usize>,
}

impl Mission {
    /// Returns the mission of a plan. Altitudes of the plan are above home.
    pub fn of_plan(plan: &FlightPlan, home: &GeoPosition) -> Self {
        let position = LatLon::from_degrees(home.lat_deg, home.lon_deg);
        let home = Some(HomePosition { position, amsl_m: Some(home.alt_amsl) });
        let file = PlanFile { plan: plan.clone(), home, ..PlanFile::default() };
        let written = format::write(&file, Format::QgcWpl);
        // The first two lines are the header and home.
        let items = written.text().lines().skip(2).filter_map(item).collect();
        Self {
            items,
            losses: lines(&written.losses),
            sources: format::item_sources(&plan.waypoints, position),
        }
    }

    /// Returns the item at which the craft arrives at a waypoint; `None` if the waypoint has none.
    pub fn item_of_waypoint(&self, waypoint: u16) -> Option<u16> {
        let mut positions = self.positions(0);
        positions.find(|(_, source)| *source == usize::from(waypoint)).map(|(item, _)| item)
    }

    /// Returns the waypoint of an item, or the next one for an item without a position.
    pub fn waypoint_of_item(&self, item: u16) -> Option<u8> {
        self.positions(item).next().and_then(|(_, source)| u8::try_from(source).ok())
    }

    /// Returns the items with a position from one on, and their waypoints.
    fn positions(&self, from: u16) -> impl Iterator<Item = (u16, usize)> {
        let numbered = (0..).zip(self.items.iter().zip(&self.sources)).skip(usize::from(from));
        numbered.filter(|(_, (item, _))| is_position(item)).map(|(number, (_, source))| (number, *source))
    }
}

/// Reads a line of a waypoint file.
fn item(line: &str) -> Option<MissionItem> {
    let fields: Vec<f64> = line.split('\t').filter_map(|field| field.trim().parse().ok()).collect();
    let &[_, current, frame, command, p1, p2, p3, p4, lat, lon, alt, on] = fields.as_slice() else {
        return None;
    };
    let position = LatLon::from_degrees(lat, lon);
    Some(MissionItem {
        frame: frame as u8,
        command: command as u16,
        params: [p1, p2, p3, p4].map(|param| param as f32),
        x: position.lat_e7,
        y: position.lon_e7,
        z: alt as f32,
        is_current: current != 0.0,
        autocontinue: on != 0.0,
    })
}

/// Returns the plan of a mission and the differences as sentences.
///
/// # Errors
/// Fails with the result and the reasons if the mission has no place in a plan.
pub fn plan(
    items: &[MissionItem],
    home: Option<&GeoPosition>,
) -> Result<(FlightPlan, Vec<String>), (MissionResult, Vec<String>)> {
    let needs_home = items.iter().any(|item| position_frame::is_global(item.frame));
    let Some(home) = home.copied().or((!needs_home).then(GeoPosition::default)) else {
        let why = "The craft has no home yet, from which altitudes count: wait for its fix.";
        return Err((MissionResult::UnsupportedFrame, vec![why.to_owned()]));
    };
    let position = LatLon::from_degrees(home.lat_deg, home.lon_deg);
    let text = text(items, position, home.alt_amsl);
    let options = ReadOptions {
        home: Some(HomePosition { position, amsl_m: Some(home.alt_amsl) }),
        ..ReadOptions::default()
    };
    match format::read(NAME, text.as_bytes(), Format::QgcWpl, &options) {
        Ok(file) if file.losses.worst() == Some(Severity::Refused) => {
            Err((MissionResult::Unsupported, lines(&file.losses)))
        }
        Ok(file) => Ok((file.plan.clone(), lines(&file.losses))),
        Err(errors) => {
            let reason = |error: &format::PlanError| {
                format!("Item {}: {}.", error.line.saturating_sub(3), error.message)
            };
            Err((MissionResult::Unsupported, errors.iter().map(reason).collect()))
        }
    }
}

/// Returns the differences that matter, as sentences. They name waypoints: items have other numbers in each ground station.
fn lines(losses: &LossReport) -> Vec<String> {
    let matters = |severity: Severity| severity >= Severity::Assumed;
    let findings = losses.findings.iter().filter(|finding| matters(finding.severity));
    let sentence = |finding: &Finding| Finding { item: None, place: None, ..finding.clone() }.to_string();
    findings.map(|finding| sentence(finding).split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

/// Returns a mission as a waypoint file.
fn text(items: &[MissionItem], home: LatLon, home_amsl_m: f64) -> String {
    let mut text = HEADER.to_owned();
    let home = MissionItem {
        frame: position_frame::GLOBAL,
        command: 16,
        params: [0.0; 4],
        x: home.lat_e7,
        y: home.lon_e7,
        z: home_amsl_m as f32,
        is_current: true,
        autocontinue: true,
    };
    for (number, item) in std::iter::once(&home).chain(items).enumerate() {
        let [p1, p2, p3, p4] = item.params.map(|param| if param.is_finite() { param } else { 0.0 });
        let place = LatLon::new(item.x, item.y);
        let (lat, lon) = match position_frame::is_global(item.frame) {
            true => (format!("{:.7}", place.lat_deg()), format!("{:.7}", place.lon_deg())),
            false => (item.x.to_string(), item.y.to_string()),
        };
        let altitude = if item.z.is_finite() { item.z } else { 0.0 };
        let on = u8::from(item.autocontinue);
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{number}\t0\t{}\t{}\t{p1}\t{p2}\t{p3}\t{p4}\t{lat}\t{lon}\t{altitude}\t{on}",
            item.frame, item.command
        );
        debug_assert_eq!(text.lines().last().map(|line| line.split('\t').count()), Some(FIELDS));
    }
    text
}

/// Returns `true` for an item at which the craft arrives.
fn is_position(item: &MissionItem) -> bool {
    matches!(item.command, 16..=19 | 21 | 22 | 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::builtin::BuiltinPlan;
    use crate::plan::{Seconds, Waypoint, WaypointType};

    const HOME: GeoPosition = GeoPosition { lat_deg: 40.4635, lon_deg: -79.5182, alt_amsl: 300.0 };

    fn mission(name: &str) -> (FlightPlan, Mission) {
        let plan = BuiltinPlan::find(name).unwrap().read().unwrap().plan;
        let mission = Mission::of_plan(&plan, &HOME);
        (plan, mission)
    }

    #[test]
    fn a_plan_goes_to_a_ground_station_and_comes_back_equal() {
        for name in ["square", "hold-orbit", "flyover"] {
            let (plan, Mission { items, .. }) = mission(name);
            let (back, lines) = super::plan(&items, Some(&HOME)).unwrap();
            let positions = |plan: &FlightPlan| {
                plan.waypoints.iter().map(|waypoint| (waypoint.kind, waypoint.position)).collect::<Vec<_>>()
            };
            assert_eq!(positions(&back), positions(&plan), "{name}: {lines:?}");
            assert_eq!(Mission::of_plan(&back, &HOME).items, items, "{name}");
        }
    }

    #[test]
    fn every_waypoint_with_a_position_has_its_item_and_the_item_its_waypoint() {
        for name in
            ["square", "hold-orbit", "hold-none", "alt-change", "delay", "yaw-rate", "land", "takeoff"]
        {
            let (plan, mission) = mission(name);
            assert_eq!(mission.items.len(), mission.sources.len());
            for (index, waypoint) in plan.waypoints.iter().enumerate() {
                // A take-off at home has no position of its own.
                if !waypoint.kind.is_positional() || waypoint.position == LatLon::default() {
                    continue;
                }
                let item = mission.item_of_waypoint(index as u16).unwrap();
                let MissionItem { x, y, .. } = mission.items[usize::from(item)];
                assert_eq!(LatLon::new(x, y), waypoint.position);
                assert_eq!(mission.waypoint_of_item(item), Some(index as u8));
            }
            assert_eq!(mission.item_of_waypoint(200), None);
            assert_eq!(mission.waypoint_of_item(200), None);
        }
    }

    #[test]
    fn a_wait_before_a_landing_and_the_landing_are_one_waypoint() {
        let position = |north: f64| LatLon::from_degrees(40.4635 + north, -79.5182);
        let at = |kind, north| Waypoint { kind, position: position(north), ..Waypoint::default() };
        let waits = Waypoint { duration: Seconds::new(5.0), ..at(WaypointType::Land, 0.001) };
        let plan = FlightPlan { waypoints: [waits, at(WaypointType::Flyover, 0.002)].into_iter().collect() };
        let mission = Mission::of_plan(&plan, &HOME);
        let waypoints: Vec<_> =
            (0..mission.items.len()).map(|item| mission.waypoint_of_item(item as u16)).collect();
        assert_eq!(waypoints, [Some(0), Some(0), Some(1)]);
        assert_eq!((mission.item_of_waypoint(0), mission.item_of_waypoint(1)), (Some(0), Some(2)));
    }

    #[test]
    fn numbers_that_are_none_and_unknown_commands_are_answered() {
        let item = MissionItem {
            frame: 3,
            command: 16,
            params: [f32::NAN; 4],
            x: 404_640_000,
            y: -795_182_000,
            z: f32::NAN,
            is_current: false,
            autocontinue: true,
        };
        assert_eq!(plan(&[item], Some(&HOME)).unwrap().0.waypoints.len(), 1);
        assert_eq!(plan(&[item], None).unwrap_err().0, MissionResult::UnsupportedFrame);
        let unknown = MissionItem { command: 60_000, ..item };
        match plan(&[item, unknown], Some(&HOME)) {
            Ok((_, lines)) => assert!(lines.iter().any(|line| line.contains("60000")), "{lines:?}"),
            Err((result, lines)) => assert!(result != MissionResult::Accepted && !lines.is_empty()),
        }
    }
}
