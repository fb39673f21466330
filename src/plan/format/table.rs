//! A plan as a table for people.

use crate::geo::{Degrees7, LatLon};
use crate::plan::estimate::{Assumptions, LegEstimate, PlanEstimate, estimate};
use crate::plan::review::review;
use crate::plan::{HoldPattern, TimeUse, Waypoint};
use crate::text::printable;

use super::PlanFile;

/// Titles of the columns; the numbers are right-aligned.
const TITLES: [&str; 11] =
    ["#", "type", "lat", "lon", "alt", "speed", "leg", "bearing", "stay", "done", "battery"];

/// Columns that hold text.
const LEFT: [usize; 1] = [1];

/// Returns the plan with distances, times and findings, for a flight that starts above `home`.
pub fn table(file: &PlanFile, home: LatLon, assumptions: &Assumptions) -> String {
    let estimate = estimate(&file.plan, home, assumptions);
    let mut text = printable::name(&file.name);
    if !file.description.is_empty() {
        text.push_str(&format!(": {}", file.description));
    }
    text.push_str(&format!(
        "\nhome {}\n",
        file.home.map_or_else(|| home.to_string(), |home| home.to_string())
    ));
    for line in &file.settings {
        text.push_str(&format!("set {line}\n"));
    }
    text.push('\n');
    let rows = file.plan.waypoints.iter().zip(&estimate.legs).enumerate();
    let endurance_s = assumptions.endurance_s;
    let rows: Vec<[String; 11]> =
        rows.map(|(index, (waypoint, leg))| row(index, waypoint, leg, endurance_s)).collect();
    // Without an airframe the battery is unknown.
    let count = if endurance_s.is_some() { TITLES.len() } else { TITLES.len() - 1 };
    push_rows(&rows, count, &mut text);
    text.push_str(&format!("\n{}\n", total(&estimate)));
    for finding in review(&file.plan, home, assumptions) {
        text.push_str(&format!("{finding}\n"));
    }
    for notice in file.notices() {
        text.push_str(&format!("{notice}\n"));
    }
    text
}

fn row(index: usize, waypoint: &Waypoint, leg: &LegEstimate, endurance_s: Option<f64>) -> [String; 11] {
    let uses = waypoint.kind.capability();
    let kind = match waypoint.pattern {
        pattern if uses.pattern && pattern != HoldPattern::None => format!("{} {pattern}", waypoint.kind),
        _ => waypoint.kind.to_string(),
    };
    let place =
        |value: i32| if waypoint.kind.uses_position() { Degrees7(value).to_string() } else { String::new() };
    let has_altitude = uses.altitude;
    let speed = match leg.speed_mps {
        Some(speed) => format!("{speed:.1} m/s"),
        None if waypoint.kind.has_yaw_rate() => format!("{} deg/s", waypoint.yaw_rate_dps),
        None => String::new(),
    };
    let stay = match uses.time {
        TimeUse::Stay if waypoint.duration.is_zero() => "endless".to_owned(),
        _ if waypoint.duration.is_zero() => String::new(),
        _ => format!("{:.1} s", waypoint.duration.get()),
    };
    let done = match leg.done_s {
        _ if !waypoint.kind.is_positional() => String::new(),
        Some(seconds) => clock(seconds),
        None => "never".to_owned(),
    };
    // As if the craft hovered all the time.
    let used = leg.done_s.zip(endurance_s).filter(|_| waypoint.kind.is_positional());
    let used = used.map_or_else(String::new, |(done_s, endurance_s)| {
        format!("{:.0} %", (100.0 * done_s / endurance_s).min(100.0))
    });
    [
        index.to_string(),
        kind,
        place(waypoint.position.lat_e7),
        place(waypoint.position.lon_e7),
        if has_altitude { format!("{:.2} m", leg.alt_m) } else { String::new() },
        speed,
        leg.distance_m.map_or_else(String::new, |distance| format!("{distance:.1} m")),
        leg.bearing_deg.map_or_else(String::new, |bearing| format!("{:.0}°", bearing.round() % 360.0)),
        stay,
        done,
        used,
    ]
}

/// Appends the first `count` columns.
fn push_rows(rows: &[[String; 11]], count: usize, text: &mut String) {
    let titles = TITLES.map(str::to_owned);
    let all = || std::iter::once(&titles).chain(rows);
    let widths: [usize; 11] =
        std::array::from_fn(|column| all().map(|row| row[column].chars().count()).max().unwrap_or(0));
    for row in all() {
        let mut line = String::new();
        for (column, (cell, width)) in row.iter().zip(widths).take(count).enumerate() {
            let cell =
                if LEFT.contains(&column) { format!("{cell:<width$}") } else { format!("{cell:>width$}") };
            line.push_str(&cell);
            line.push_str("  ");
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
}

fn total(estimate: &PlanEstimate) -> String {
    let time = match estimate.time_s {
        Some(seconds) => format!("at least {} from engagement", clock(seconds)),
        None => "holding without end".to_owned(),
    };
    let count = estimate.legs.len();
    let waypoints = if count == 1 { "waypoint" } else { "waypoints" };
    format!("{count} {waypoints}, {:.0} m, {time}", estimate.distance_m)
}

/// Returns minutes and seconds: `4:05`.
fn clock(seconds: f64) -> String {
    let seconds = seconds.round() as u64;
    format!("{}:{:02}", seconds / 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::{Assumptions, LatLon, PlanFile};
    use crate::plan::builtin::BuiltinPlan;

    fn table(file: &PlanFile, home: LatLon) -> String {
        super::table(file, home, &Assumptions::from_settings(&file.settings))
    }

    #[test]
    fn a_plan_as_a_table() {
        let file = BuiltinPlan::find("hold-orbit").unwrap().read().unwrap();
        let home = file.home.unwrap().position;
        insta::assert_snapshot!(table(&file, home), @r"
        hold-orbit: Circles a point 40 m north of home with a radius of 10 m, one lap in 30 s, then lands
        home 40.4635000,-79.5182000,300
        set ap_hover_throttle = 1500
        set ap_max_angle = 25
        set ap_max_yaw_rate = 90
        set ap_hold_orbit_radius = 1000
        set ap_max_turn_rate = 12

        #  type               lat          lon      alt    speed     leg  bearing    stay  done
        0  HOLD ORBIT  40.4638593  -79.5182000  12.00 m  5.0 m/s  40.0 m       0°  45.0 s  0:53
        1  LAND        40.4635000  -79.5182000  12.00 m  5.0 m/s  40.0 m     180°          1:25

        2 waypoints, 80 m, at least 1:25 from engagement
        ");
    }

    #[test]
    fn a_bearing_just_west_of_north_is_none_of_360_degrees() {
        let text = "waypoint insert 0 40.5 -79.5183 1000 0 LAND 0 NONE";
        let file = super::super::parse("x.txt", text, super::super::Format::CliText).unwrap();
        let table = table(&file, LatLon::new(404_635_000, -795_182_000));
        assert!(table.contains(" 0°") && !table.contains("360°"), "{table}");
    }

    #[test]
    fn modifiers_and_findings() {
        let text = "[[waypoint]]\ntype='YAW_RATE'\nyaw_rate_dps=20\n[[waypoint]]\ntype='HOLD'\nlat_deg=40.4638593\n\
                    lon_deg=-79.5182\nalt_m=20\nspeed_mps=30\n[[waypoint]]\ntype='TAKEOFF'\nalt_m=3\n";
        let file = super::super::parse("x.toml", text, super::super::Format::Toml).unwrap();
        insta::assert_snapshot!(table(&file, LatLon::new(404_635_000, -795_182_000)), @r"
        x
        home 40.4635000,-79.5182000

        #  type             lat          lon      alt     speed     leg  bearing     stay   done
        0  YAW_RATE                                    20 deg/s
        1  HOLD      40.4638593  -79.5182000  20.00 m   5.0 m/s  40.0 m       0°  endless  never
        2  TAKEOFF                             3.00 m             0.0 m                    never

        3 waypoints, 40 m, holding without end
        waypoint 1 holds forever (duration 0): the waypoints after it are never flown
        waypoint 1 asks for 30 m/s; ap_max_velocity limits it to 5 m/s
        the plan does not end in LAND: the craft stays in the air at its end
        ");
    }
}
