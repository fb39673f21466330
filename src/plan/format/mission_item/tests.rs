//! Each command and each type of waypoint, one test a row.

use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use strum::IntoEnumIterator as _;

use super::*;
use crate::plan::estimate::Assumptions;
use crate::plan::format::PlanFile;
use crate::plan::record::WaypointRecord;
use crate::plan::{FlightPlan, HoldPattern, MAX_WAYPOINTS, Waypoint, WaypointType};

const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);

fn item(number: usize, command: u16, frame: u16, params: [f64; 4], place: (f64, f64, f64)) -> MissionItem {
    MissionItem {
        number,
        command,
        frame,
        params: params.map(|param| Some(param).filter(|param| !param.is_nan())),
        lat_deg: Some(place.0),
        lon_deg: Some(place.1),
        altitude_m: Some(place.2),
        autocontinue: true,
        place: Some(Place::Line { line: number + 2 }),
    }
}

/// Returns an item 50 m above home.
fn at(number: usize, command: u16, params: [f64; 4]) -> MissionItem {
    item(number, command, ABOVE_HOME, params, (40.464, -79.5175, 50.0))
}

fn map_with(items: &[MissionItem], assumptions: &Assumptions) -> Mapping {
    let home = Some(HomePosition { position: HOME, amsl_m: Some(300.0) });
    Mission { items, home, assumptions, waypoint_as: WaypointType::Flyby, flat: false }.map()
}

/// Returns the waypoints as `TYPE PATTERN ALT SPEED TIME`, the findings and the faults.
fn map(items: &[MissionItem]) -> (Vec<String>, Vec<String>) {
    let mapping = map_with(items, &Assumptions::default());
    let waypoints = mapping.waypoints.iter().map(|(waypoint, _)| words(waypoint)).collect();
    let too_many = mapping.too_many();
    let faults = mapping.faults.iter().chain(&too_many).map(|fault| format!("fault {}", fault.message));
    (waypoints, mapping.findings.iter().map(ToString::to_string).chain(faults).collect())
}

fn words(waypoint: &Waypoint) -> String {
    let Waypoint { kind, pattern, altitude, speed, duration, yaw_rate_dps, .. } = waypoint;
    let pattern = if *kind == WaypointType::Hold { format!(" {pattern}") } else { String::new() };
    let rate = if *yaw_rate_dps > 0 { format!(" {yaw_rate_dps}") } else { String::new() };
    format!("{kind}{pattern} {} {} {}{rate}", altitude.above_home_m(), speed.mps(), duration.get())
}

/// Checks the waypoints, and the beginnings of the findings.
#[track_caller]
fn check(items: &[MissionItem], waypoints: &[&str], findings: &[&str]) {
    let (found, said) = map(items);
    assert_eq!(found, waypoints);
    let begin: Vec<bool> =
        said.iter().zip(findings).map(|(said, expected)| said.contains(expected)).collect();
    assert!(said.len() == findings.len() && !begin.contains(&false), "{said:#?}\n{findings:#?}");
}

const NAN: f64 = f64::NAN;

#[test]
fn waypoints_say_how_they_are_passed() {
    check(&[at(1, 16, [12.0, 5.0, 3.0, NAN])], &["HOLD NONE 50 0 12"], &[]);
    check(&[at(1, 16, [0.0, 5.0, 3.0, NAN])], &["FLYBY 50 0 0"], &[]);
    check(&[at(1, 16, [0.0, 5.0, 0.0, NAN])], &["FLYOVER 50 0 0"], &[]);
    check(
        &[at(1, 16, [0.0, 2.0, 0.0, NAN])],
        &["FLYOVER 50 0 0"],
        &["info     WP 0 (item 1, line 3) acceptance radius: 2 m → 5 m"],
    );
    check(
        &[at(1, 16, [0.0; 4]), at(2, 16, [NAN; 4])],
        &["FLYBY 50 0 0"; 2],
        &["assumed  waypoint type: 2 items → FLYBY"],
    );
    check(&[at(1, 16, [-1.0, 0.0, 0.0, 0.0])], &[], &["fault item 1: a stay of -1 s is out of range"]);
    check(&[at(1, 82, [0.0, 0.0, 1.0, 0.0])], &["FLYBY 50 0 0"], &["lost     WP 0 (item 1, line 3) spline"]);
    check(
        &[at(1, 16, [9000.0, 0.0, 0.0, 0.0])],
        &["HOLD NONE 50 0 6553.5"],
        &["changed  WP 0 (item 1, line 3) duration: 9000 s → 6553.5 s"],
    );
}

#[test]
fn loiters_are_holds() {
    check(&[at(1, 17, [0.0; 4])], &["HOLD NONE 50 0 0"], &[]);
    check(&[at(1, 17, [0.0, 0.0, 10.0, NAN])], &["HOLD ORBIT 50 0 0"], &[]);
    check(
        &[at(1, 17, [0.0, 0.0, -25.0, NAN])],
        &["HOLD ORBIT 50 0 0"],
        &["changed  WP 0 (item 1, line 3) radius: 25 m → 10 m", "lost     WP 0 (item 1, line 3) direction"],
    );
    check(&[at(1, 18, [0.25, 0.0, 10.0, NAN])], &["HOLD ORBIT 50 0 30"], &[]);
    check(
        &[at(1, 18, [0.3337, 0.0, 0.0, NAN])],
        &["HOLD ORBIT 50 0 40"],
        &["changed  WP 0 (item 1, line 3) duration: 40.04 s → 40 s"],
    );
    check(
        &[at(1, 19, [30.0, 0.0, 50.0, NAN])],
        &["HOLD NONE 50 0 30"],
        &["info     WP 0 (item 1, line 3) radius: 50 m"],
    );
    check(&[at(1, 19, [0.0; 4])], &["HOLD NONE 50 0 0.1"], &[]);
    check(
        &[at(1, 31, [0.0; 4]), at(2, 19, [1.0, 0.0, 0.0, 0.0])],
        &["FLYOVER 50 0 0", "TAKEOFF 50 0 0", "HOLD NONE 50 0 1"],
        &["changed  WP 0 (item 1, line 3) loiter to altitude: 1 item → 2 waypoints"],
    );
}

#[test]
fn landings_returns_and_take_offs() {
    let ground = item(2, 21, ABOVE_HOME, [0.0; 4], (40.464, -79.519, 0.0));
    let before = at(1, 16, [0.0, 5.0, 0.0, 0.0]);
    let changed = "changed  WP 1 (item 2, line 4) altitude: 0 m → 50 m: the altitude of a MAVLink LAND is that of the ground";
    check(&[before.clone(), ground.clone()], &["FLYOVER 50 0 0", "LAND 50 0 0"], &[changed]);
    check(&[before.clone(), at(2, 21, [0.0; 4])], &["FLYOVER 50 0 0", "LAND 50 0 0"], &[]);
    let vtol = MissionItem { command: 85, ..ground.clone() };
    check(
        &[before.clone(), vtol],
        &["FLYOVER 50 0 0", "LAND 50 0 0"],
        &["lost     WP 1 (item 2, line 4) transition", changed],
    );
    let payload = MissionItem { command: 94, ..ground };
    check(
        &[before.clone(), payload],
        &["FLYOVER 50 0 0", "LAND 50 0 0"],
        &["lost     WP 1 (item 2, line 4) payload", changed],
    );
    let back = item(2, 20, NO_PLACE, [0.0; 4], (0.0, 0.0, 0.0));
    let two = "changed  WP 1 (item 2, line 4) return: 1 item → 2 waypoints";
    check(&[before.clone(), back.clone()], &["FLYOVER 50 0 0", "FLYOVER 50 0 0", "LAND 50 0 0"], &[two]);
    let more = at(3, 16, [0.0, 5.0, 0.0, 0.0]);
    check(
        &[before.clone(), back, more],
        &["FLYOVER 50 0 0", "FLYOVER 50 0 0", "LAND 50 0 0"],
        &[two, "lost     item 3, line 5 items after the return: 1 item"],
    );
    check(
        &[at(1, 22, [15.0, 0.0, 0.0, NAN])],
        &["TAKEOFF 50 0 0"],
        &["info     WP 0 (item 1, line 3) pitch: 15 deg"],
    );
    check(&[at(1, 84, [0.0; 4])], &["TAKEOFF 50 0 0"], &["lost     WP 0 (item 1, line 3) transition"]);
    // Without a position it is that of the craft.
    let here = item(2, 21, ABOVE_HOME, [0.0; 4], (0.0, 0.0, 50.0));
    let mapping = map_with(&[before.clone(), here], &Assumptions::default());
    assert_eq!(mapping.waypoints[1].0.position, mapping.waypoints[0].0.position);
    let here = item(1, 22, ABOVE_HOME, [0.0; 4], (0.0, 0.0, 50.0));
    assert_eq!(map_with(&[here], &Assumptions::default()).waypoints[0].0.position, HOME);
}

#[test]
fn altitudes_speeds_delays_and_yaw() {
    check(
        &[at(1, 30, [2.0, 0.0, 0.0, 0.0])],
        &["ALT_CHANGE 50 0 0"],
        &["info     WP 0 (item 1, line 3) direction: descend"],
    );
    let pass = |number| at(number, 16, [0.0, 5.0, 0.0, 0.0]);
    let speed = |number, of, mps| at(number, 178, [of, mps, -1.0, 0.0]);
    check(
        &[pass(1), speed(2, 1.0, 4.0), pass(3), speed(4, 1.0, -1.0), pass(5), speed(6, 1.0, -2.0), pass(7)],
        &["FLYOVER 50 0 0", "FLYOVER 50 4 0", "FLYOVER 50 4 0", "FLYOVER 50 0 0"],
        &[],
    );
    check(&[speed(1, 0.0, 3.0), pass(2)], &["FLYOVER 50 3 0"], &["assumed  item 1, line 3 speed: 3 m/s"]);
    check(
        &[speed(1, 1.0, 9.0), pass(2)],
        &["FLYOVER 50 9 0"],
        &["changed  item 1, line 3 speed: 9 m/s → 5 m/s"],
    );
    check(
        &[speed(1, 2.0, 3.0), pass(2)],
        &["FLYOVER 50 0 0"],
        &["lost     item 1, line 3 climb or descent speed"],
    );
    check(&[speed(1, 1.0, 1e9)], &[], &["fault item 1: speed 1000000000 m/s is out of range"]);
    check(
        &[pass(1), at(2, 93, [7.0, 0.0, 0.0, 0.0])],
        &["FLYOVER 50 0 0", "HOLD NONE 50 0 7"],
        &["assumed  WP 1 (item 2, line 4) delay: 7 s → HOLD"],
    );
    check(
        &[pass(1), at(2, 93, [-1.0, 12.0, 0.0, 0.0])],
        &["FLYOVER 50 0 0"],
        &["fault item 2: a delay until a time of day"],
    );
    check(&[at(1, 93, [7.0, 0.0, 0.0, 0.0])], &[], &["lost     WP 0 (item 1, line 3) delay"]);
    check(&[at(1, 213, [0.0, 45.0, 0.0, 0.0])], &["YAW_RATE 0 0 0 45"], &[]);
    check(&[at(1, 16, [0.0, 5.0, 0.0, 90.0])], &["FLYOVER 50 0 0"], &["lost     heading: 1 item"]);
    let stops = MissionItem { autocontinue: false, ..pass(1) };
    check(&[stops], &["FLYOVER 50 0 0"], &["lost     WP 0 (item 1, line 3) autocontinue: off → on"]);
}

#[test]
fn other_commands_are_counted_or_refused() {
    let commands = [203, 203, 1000, 183, 201, 115, 112, 189, 5001, 5100, 211];
    let items: Vec<_> =
        commands.iter().enumerate().map(|(at, &c)| item(at, c, 0, [0.0; 4], (0.0, 0.0, 0.0))).collect();
    check(
        &items,
        &[],
        &[
            "info     condition (command 112): 1 item",
            "lost     nose direction (command 115): 1 item",
            "lost     servo or relay (command 183): 1 item",
            "info     landing start (command 189): 1 item",
            "lost     nose direction (command 201): 1 item",
            "info     camera (command 203): 2 items",
            "lost     gripper (command 211): 1 item",
            "info     gimbal (command 1000): 1 item",
            "lost     fence (command 5001): 1 item",
            "lost     rally point (command 5100): 1 item",
        ],
    );
    check(&[at(4, 176, [0.0; 4])], &[], &["fault item 4: command 176 is unknown"]);
}

#[test]
fn frames_give_the_reference() {
    let altitude = |frame| map(&[item(1, 19, frame, [1.0, 0.0, 0.0, 0.0], (40.0, -79.0, 350.0))]);
    for frame in [0, 5] {
        let said = "info     WP 0 (item 1, line 3) altitude reference: 350 m above sea level → 50 m above home: \
                    altitudes of a plan are above home";
        assert_eq!(altitude(frame), (vec!["HOLD NONE 50 0 1".to_owned()], vec![said.to_owned()]));
    }
    for frame in [3, 6] {
        assert_eq!(altitude(frame), (vec!["HOLD NONE 350 0 1".to_owned()], vec![]));
    }
    for frame in [10, 11] {
        assert!(altitude(frame).1[0].starts_with("assumed  WP 0 (item 1, line 3) altitude reference"));
    }
    for frame in [1, 2, 4, 7, 8, 9, 12, 21] {
        assert!(altitude(frame).1[0].starts_with(&format!("fault item 1: frame {frame}")), "{frame}");
    }
    let places: [(f64, f64, f64, &str); 5] = [
        (91.0, 0.0, 1.0, "latitude 91 is out of range"),
        (0.0, 400.0, 1.0, "longitude 400 is out of range"),
        (NAN, 1.0, 1.0, "latitude NaN is out of range"),
        (1.0, 1.0, f64::INFINITY, "altitude inf is out of range"),
        (1.0, 1.0, 20_001.0, "altitude 20001 is out of range"),
    ];
    for (lat, lon, alt, why) in places {
        let said = map(&[item(1, 16, ABOVE_HOME, [0.0; 4], (lat, lon, alt))]).1;
        assert!(said[0].contains(why), "{said:?}");
    }
    check(
        &[item(1, 17, 3, [0.0; 4], (1.0, 359.0, 1.0))],
        &["HOLD NONE 1 0 0"],
        &["changed  WP 0 (item 1, line 3) longitude: 359 → -1"],
    );
}

#[test]
fn an_item_without_a_position_is_where_the_craft_is() {
    let nowhere = |number, command, alt| item(number, command, 3, [1.0, 0.0, 10.0, 0.0], (0.0, 0.0, alt));
    let items = [at(1, 16, [0.0, 5.0, 0.0, 0.0]), nowhere(2, 18, 0.0), nowhere(3, 17, 7.0)];
    check(
        &items,
        &["FLYOVER 50 0 0", "HOLD ORBIT 50 0 120", "HOLD ORBIT 7 0 0"],
        &[
            "assumed  WP 1 (item 2, line 4) position: 40.4640000,-79.5175000, 50 m",
            "assumed  WP 2 (item 3, line 5)",
        ],
    );
    let mission = Mission {
        items: &items[1..],
        home: None,
        assumptions: &Assumptions::default(),
        waypoint_as: WaypointType::Flyby,
        flat: false,
    };
    assert!(mission.map().faults[0].message.contains("it has no position, and there is none before it"));
}

#[test]
fn jumps_are_unrolled() {
    let pass = |number, alt| item(number, 16, 3, [0.0, 5.0, 0.0, 0.0], (40.0, -79.0, alt));
    let jump = |number, to, times| at(number, 177, [to, times, 0.0, 0.0]);
    check(
        &[pass(1, 1.0), pass(2, 2.0), jump(3, 1.0, 2.0), pass(4, 4.0)],
        &[
            "FLYOVER 1 0 0",
            "FLYOVER 2 0 0",
            "FLYOVER 1 0 0",
            "FLYOVER 2 0 0",
            "FLYOVER 1 0 0",
            "FLYOVER 2 0 0",
            "FLYOVER 4 0 0",
        ],
        &["changed  item 3, line 5 jump: to item 1, 2 times → unrolled"],
    );
    check(&[pass(1, 1.0), jump(2, 1.0, -1.0)], &[], &["fault the jump of item 2 repeats without an end"]);
    check(
        &[pass(1, 1.0), jump(2, 7.0, 1.0)],
        &[],
        &["fault the jump of item 2 goes to item 7, which is not there"],
    );
    let said = map(&[pass(1, 1.0), jump(2, 1.0, 40.0)]).1;
    assert!(said[1].starts_with("fault with its jumps the mission has 41 waypoints"), "{said:?}");
    check(&[jump(1, 1.0, 1e300)], &[], &["fault the jumps give more than 10000 items"]);
    check(
        &[jump(1, 3.0, 1.0), pass(2, 2.0), pass(3, 3.0)],
        &["FLYOVER 3 0 0"],
        &["changed  item 1, line 3 jump"],
    );
}

#[test]
fn many_waypoints_are_one_fault() {
    let items: Vec<_> = (1..=40).map(|number| at(number, 17, [0.0; 4])).collect();
    let mapping = map_with(&items, &Assumptions::default());
    let fault = mapping.too_many().unwrap();
    assert_eq!(fault.message, "waypoint 30 does not fit: the file has 40");
    assert_eq!((fault.item, mapping.faults.len()), (30, 0));
}

/// Returns the items of a plan as `COMMAND p1 p2 p3 ALT`, and the findings.
fn sent(waypoints: &[Waypoint], settings: &[&str]) -> (Vec<String>, Vec<String>) {
    let settings: Vec<String> = settings.iter().map(|&line| line.to_owned()).collect();
    let sent = send(waypoints, HOME, &Assumptions::from_settings(&settings), false);
    let text = |item: &MissionItem| {
        let [p1, p2, p3] = [1, 2, 3].map(|number| (item.param(number) * 1e4).round() / 1e4);
        format!("{} {p1} {p2} {p3} {}", item.command, item.altitude_m.unwrap_or_default())
    };
    (sent.items.iter().map(text).collect(), sent.findings.iter().map(ToString::to_string).collect())
}

fn waypoint(kind: WaypointType, alt_m: f64, seconds: f64) -> Waypoint {
    let position = LatLon::new(404_640_000, -795_175_000);
    let (altitude, duration) = (Altitude::above_home(alt_m), crate::plan::Seconds::new(seconds));
    Waypoint { position, altitude, duration, kind, ..Waypoint::default() }
}

#[test]
fn each_type_becomes_its_items() {
    use WaypointType::{AltChange, Delay, Flyby, Flyover, Hold, Land, Takeoff, YawRate};
    let orbit = |seconds| Waypoint { pattern: HoldPattern::Orbit, ..waypoint(Hold, 50.0, seconds) };
    let eight = Waypoint { pattern: HoldPattern::Figure8, ..waypoint(Hold, 50.0, 9.0) };
    let rate = Waypoint { yaw_rate_dps: 45, kind: YawRate, ..Waypoint::default() };
    let delay = Waypoint { kind: Delay, duration: crate::plan::Seconds::new(40.0), ..Waypoint::default() };
    let rise = Waypoint { kind: AltChange, altitude: Altitude::above_home(70.0), ..Waypoint::default() };
    let rows: [(&[Waypoint], &[&str], &[&str]); 13] = [
        (&[waypoint(Flyover, 50.0, 0.0)], &["16 0 5 0 50"], &[]),
        (&[waypoint(Flyby, 50.0, 0.0)], &["16 0 0 5.47 50"], &["info     waypoint type: 1 FLYBY → waypoint"]),
        (&[waypoint(Hold, 50.0, 9.5)], &["19 9.5 0 0 50"], &[]),
        (&[waypoint(Hold, 50.0, 0.0)], &["17 0 0 0 50"], &[]),
        (&[orbit(30.0)], &["18 0.25 0 10 50"], &[]),
        (&[orbit(0.0)], &["17 0 0 10 50"], &[]),
        (&[eight], &["19 9 0 0 50"], &["lost     WP 0 pattern: FIGURE8 → NONE"]),
        (&[waypoint(Flyover, 50.0, 0.0), waypoint(Land, 50.0, 0.0)], &["16 0 5 0 50", "21 0 0 0 0"], &[]),
        (
            &[waypoint(Flyover, 50.0, 0.0), waypoint(Land, 20.0, 3.0)],
            &["16 0 5 0 50", "19 3 0 0 20", "21 0 0 0 0"],
            &["changed  WP 1 type: LAND → HOLD, LAND"],
        ),
        (
            &[Waypoint { position: LatLon::default(), ..waypoint(Takeoff, 8.0, 2.0) }],
            &["22 0 0 0 8", "19 2 0 0 8"],
            &["changed  WP 0 type: TAKEOFF → TAKEOFF, HOLD"],
        ),
        (
            &[rise, waypoint(Flyover, 50.0, 0.0)],
            &["16 0 5 0 70"],
            &["changed  WP 0 type: ALT_CHANGE → no item", "changed  WP 1 altitude: 50 m → 70 m"],
        ),
        (
            &[delay, waypoint(Flyover, 10.0, 0.0), waypoint(Flyover, 10.0, 0.0)],
            &["178 1 2.03 -1 0", "16 0 5 0 10", "178 1 5 -1 0", "16 0 5 0 10"],
            &[
                "changed  WP 0 type: DELAY of 40 s → a speed",
                "changed  WP 1 speed: default → 2.03 m/s",
                "changed  WP 2 speed: default → 5 m/s",
            ],
        ),
        (&[rate], &["213 0 45 0 0"], &["lost     WP 0 yaw rate: 45 deg/s"]),
    ];
    for (waypoints, items, findings) in rows {
        let (found, said) = sent(waypoints, &["ap_max_angle = 25"]);
        assert_eq!(found, items);
        assert_eq!(said.len(), findings.len(), "{said:#?}");
        assert!(said.iter().zip(findings).all(|(said, expected)| said.starts_with(expected)), "{said:#?}");
    }
    let (_, said) = sent(&[waypoint(Flyover, 50.0, 0.0), waypoint(Land, 20.0, 0.0)], &[]);
    assert!(said[0].starts_with("lost     WP 1 altitude: 20 m → 50 m"), "{said:?}");
    let (_, said) = sent(&[orbit(30.0)], &["ap_max_turn_rate = 6"]);
    assert!(said[0].starts_with("changed  WP 0 duration: 30 s → 60 s"), "{said:?}");
    let (items, said) = sent(&[orbit(30.0)], &["ap_max_turn_rate = 0"]);
    assert!(
        items == ["19 30 0 0 50"] && said[0].starts_with("lost     WP 0 pattern: ORBIT → NONE"),
        "{said:?}"
    );
    let high = sent(&[waypoint(Flyover, 30_000.0, 0.0)], &[]).1;
    assert!(high[0].starts_with("refused  WP 0 altitude: 30000 m"), "{high:?}");
    let zero = Waypoint { position: LatLon::default(), ..waypoint(Flyover, 50.0, 0.0) };
    assert!(sent(&[zero], &[]).1[0].starts_with("changed  WP 0 position: 0,0"));
}

fn place() -> impl Strategy<Value = LatLon> {
    (-900_000_000..=900_000_000, -1_800_000_000..=1_800_000_000).prop_map(|(lat, lon)| LatLon::new(lat, lon))
}

prop_compose! {
    fn any_waypoint()(
        position in prop_oneof![1 => Just(LatLon::default()), 3 => Just(HOME), 9 => place()],
        alt_cm in prop_oneof![Just(5000), -2_000_000..=2_000_000],
        speed in prop_oneof![Just(0), Just(500), any::<u16>()],
        duration_ds in prop_oneof![Just(0), any::<u16>()],
        kind in proptest::sample::select(WaypointType::iter().collect::<Vec<_>>()),
        pattern in proptest::sample::select(HoldPattern::iter().collect::<Vec<_>>()),
    ) -> Waypoint {
        WaypointRecord { position, alt_cm, speed, duration_ds, kind, pattern }.into()
    }
}

prop_compose! {
    /// Generates plans with a home.
    pub(in crate::plan::format) fn plan_file()(
        name in "\\PC{1,12}",
        description in "\\PC{0,20}",
        position in prop_oneof![1 => Just(LatLon::default()), 9 => place()],
        amsl in option::of(-500..9000),
        settings in vec(prop_oneof![
            Just("ap_max_velocity = 700".to_owned()),
            Just("ap_max_turn_rate = 9".to_owned()),
            Just("ap_max_distance_from_home = 250".to_owned()),
            Just("ap_hold_orbit_radius = 1500".to_owned()),
            "[a-z_]{1,12} = [A-Z0-9.]{1,6}".boxed(),
        ], 0..4),
        waypoints in vec(any_waypoint(), 0..=MAX_WAYPOINTS),
    ) -> PlanFile {
        let home = Some(HomePosition { position, amsl_m: amsl.map(f64::from) });
        let plan = FlightPlan { waypoints: waypoints.into_iter().collect() };
        PlanFile { name, description, home, settings, plan, ..PlanFile::default() }
    }
}

/// Returns the waypoint without the values that its type does not use.
pub(in crate::plan::format) fn used(waypoint: Waypoint) -> Waypoint {
    let uses = waypoint.kind.capability();
    Waypoint {
        position: if uses.place { waypoint.position } else { LatLon::default() },
        altitude: if uses.altitude { waypoint.altitude } else { Altitude::default() },
        duration: if uses.time == crate::plan::TimeUse::Unused {
            Default::default()
        } else {
            waypoint.duration
        },
        pattern: if uses.pattern { waypoint.pattern } else { HoldPattern::None },
        speed: if waypoint.kind.is_positional() { waypoint.speed } else { Default::default() },
        ..waypoint
    }
}
