use proptest::prelude::*;
use serde_json::json;

use super::super::mission_item::tests::plan_file;
use super::super::{Format, parse, report, write as write_file};
use super::*;
use crate::plan::feature::Zone;
use crate::plan::{HoldPattern, WaypointType};

/// The example of the format.
const EXAMPLE: &str = r#"{"fileType":"Plan","version":1,"groundStation":"betadeck",
 "mission":{"version":2,"firmwareType":0,"vehicleType":2,"cruiseSpeed":15,"hoverSpeed":10,"globalPlanAltitudeMode":1,
  "plannedHomePosition":[40.4635,-79.5182,300],
  "items":[
   {"type":"SimpleItem","doJumpId":1,"command":16,"frame":3,"autoContinue":true,"AltitudeMode":1,"Altitude":50,
    "AMSLAltAboveTerrain":null,"params":[0,5,0,null,40.464,-79.5175,50]},
   {"type":"SimpleItem","doJumpId":2,"command":178,"frame":2,"autoContinue":true,"params":[1,5,-1,0,0,0,0]},
   {"type":"SimpleItem","doJumpId":3,"command":18,"frame":3,"autoContinue":true,"AltitudeMode":1,"Altitude":50,
    "AMSLAltAboveTerrain":null,"params":[0.25,0,10,null,40.463,-79.519,50]},
   {"type":"SimpleItem","doJumpId":4,"command":21,"frame":3,"autoContinue":true,"AltitudeMode":1,"Altitude":0,
    "AMSLAltAboveTerrain":null,"params":[0,0,0,null,40.464,-79.519,0]}]},
 "geoFence":{"version":2,"circles":[{"version":1,"inclusion":true,"circle":{"center":[40.4635,-79.5182],"radius":500}}],"polygons":[]},
 "rallyPoints":{"version":2,"points":[]}}"#;

fn read_text(text: &str) -> PlanFile {
    assert_eq!(Format::from_contents(text.as_bytes()), Format::QgcPlan);
    parse("square.plan", text, Format::QgcPlan).unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

fn fault(text: &str) -> String {
    parse("x", text, Format::QgcPlan).unwrap_err()[0].headline()
}

fn findings(file: &PlanFile) -> Vec<String> {
    file.losses.findings.iter().map(ToString::to_string).collect()
}

/// Returns the example with other values at JSON pointers.
fn edited(edits: &[(&str, serde_json::Value)]) -> String {
    let mut value: serde_json::Value = serde_json::from_str(EXAMPLE).unwrap();
    for (pointer, new) in edits {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        match value.pointer_mut(parent).unwrap() {
            serde_json::Value::Object(object) => drop(object.insert(key.to_owned(), new.clone())),
            other => other[key.parse::<usize>().unwrap()] = new.clone(),
        }
    }
    value.to_string()
}

#[test]
fn the_example_is_read() {
    let file = read_text(EXAMPLE);
    assert_eq!(file.name, "square");
    assert_eq!(file.home.unwrap().to_string(), "40.4635000,-79.5182000,300");
    assert_eq!(file.settings, ["ap_max_distance_from_home = 500"]);
    let waypoints = &file.plan.waypoints;
    let kinds: Vec<_> = waypoints.iter().map(|waypoint| (waypoint.kind, waypoint.speed.mps())).collect();
    assert_eq!(kinds, [(WaypointType::Flyover, 0.0), (WaypointType::Hold, 5.0), (WaypointType::Land, 5.0)]);
    assert_eq!((waypoints[1].pattern, waypoints[1].duration.get()), (HoldPattern::Orbit, 30.0));
    assert_eq!((file.losses.items, file.losses.waypoints), (4, 3));
    assert_eq!(
        findings(&file),
        [
            "changed  WP 2 (item 4, /mission/items/3) altitude: 0 m → 50 m: the altitude of a MAVLink LAND is that of \
          the ground"
        ]
    );
}

#[test]
fn a_plan_is_written_like_the_example() {
    let file = read_text(EXAMPLE);
    let written: serde_json::Value =
        serde_json::from_slice(&write_file(&file, Format::QgcPlan).contents).unwrap();
    let example: serde_json::Value = serde_json::from_str(EXAMPLE).unwrap();
    for key in ["fileType", "version", "groundStation", "geoFence", "rallyPoints"] {
        assert_eq!(written[key], example[key], "{key}");
    }
    for key in
        ["version", "firmwareType", "vehicleType", "globalPlanAltitudeMode", "plannedHomePosition", "items"]
    {
        assert_eq!(written["mission"][key], example["mission"][key], "{key}");
    }
    assert_eq!(written["mission"]["hoverSpeed"], json!(5));
    assert_eq!(written["betadeck"]["version"], json!(1));
    let back = read_text(&written.to_string());
    assert_eq!((findings(&back), back.plan, back.settings), (vec![], file.plan, file.settings));
}

#[test]
fn items_of_version_1_and_older_are_read_the_same_way() {
    let mut value: serde_json::Value = serde_json::from_str(EXAMPLE).unwrap();
    value["mission"]["version"] = json!(1);
    for item in value["mission"]["items"].as_array_mut().unwrap() {
        let params = item["params"].as_array().unwrap().clone();
        let object = item.as_object_mut().unwrap();
        object.remove("params");
        let id = object.remove("doJumpId").unwrap();
        object.insert("id".to_owned(), id);
        object.insert("type".to_owned(), json!("missionItem"));
        object.insert("coordinate".to_owned(), params[4..].into());
        for (at, param) in params[..4].iter().enumerate() {
            object.insert(format!("param{}", at + 1), param.clone());
        }
    }
    let (old, new) = (read_text(&value.to_string()), read_text(EXAMPLE));
    assert_eq!((old.plan, old.losses), (new.plan, new.losses));
}

#[test]
fn altitudes_follow_frame_and_mode() {
    let sea = edited(&[
        ("/mission/items/0/frame", json!(0)),
        ("/mission/items/0/AltitudeMode", json!(3)),
        ("/mission/items/0/Altitude", json!(20)),
        ("/mission/items/0/params/6", json!(340.5)),
    ]);
    assert!((read_text(&sea).plan.waypoints[0].altitude.above_home_m() - 40.5).abs() < 1e-9);
    let null = sea.replace("340.5", "null");
    assert!(fault(&null).ends_with("item 1: it has no altitude"), "{}", fault(&null));
    let no_home = sea.replace("-79.5182,300]", "-79.5182,null]");
    assert!(fault(&no_home).contains("add --home"), "{}", fault(&no_home));
    let options = ReadOptions { home: Some("1,2,300".parse().unwrap()), ..ReadOptions::default() };
    let file = super::super::read("x", no_home.as_bytes(), Format::QgcPlan, &options).unwrap();
    assert_eq!(file.home.unwrap().to_string(), "40.4635000,-79.5182000,300");
    let ground = edited(&[("/mission/items/0/frame", json!(10))]);
    assert!(
        findings(&read_text(&ground))[0]
            .starts_with("assumed  WP 0 (item 1, /mission/items/0) altitude reference")
    );
    let flat = ReadOptions { flat: true, ..ReadOptions::default() };
    let file = super::super::read("x", ground.as_bytes(), Format::QgcPlan, &flat).unwrap();
    assert_eq!(file.losses.findings.len(), 1);
}

#[test]
fn surveys_are_expanded_and_other_complex_items_refused() {
    let simple = |lat: f64| json!({"type":"SimpleItem","command":16,"frame":3,"autoContinue":true,"params":[0,0,0,null,lat,-79.5,50]});
    let survey = json!({"type":"ComplexItem","complexItemType":"survey","version":5,"polygon":[],
        "TransectStyleComplexItem":{"Items":[simple(40.1), simple(40.2)]}});
    let file = read_text(&edited(&[("/mission/items/1", survey.clone())]));
    let lats: Vec<i32> = file.plan.waypoints.iter().map(|waypoint| waypoint.position.lat_e7).collect();
    assert_eq!(lats, [404_640_000, 401_000_000, 402_000_000, 404_630_000, 404_640_000]);
    let said = findings(&file);
    let line = "changed  item 2, /mission/items/1 survey: survey of 2 items → 2 items: it cannot be saved back as a survey";
    assert_eq!(said[0], line);
    for kind in ["StructureScan", "fwLandingPattern", "vtolLandingPattern"] {
        let mut other = survey.clone();
        other["complexItemType"] = json!(kind);
        let said = fault(&edited(&[("/mission/items/1", other)]));
        assert!(said.ends_with(&format!("a {kind} has no list of items that can be read")), "{said}");
    }
}

#[test]
fn fences_and_rally_points_are_reported() {
    let circle = |lat: f64, radius: f64, inclusion: bool| json!({"version":1,"inclusion":inclusion,"circle":{"center":[lat,-79.5182],"radius":radius}});
    let square = json!([[40.45, -79.53], [40.45, -79.50], [40.47, -79.50], [40.47, -79.53], [40.45, -79.53]]);
    let text = edited(&[
        ("/geoFence/circles", json!([circle(40.463_501, 300.7, true), circle(40.464, 90.0, false)])),
        ("/geoFence/polygons", json!([{"version":1,"inclusion":true,"polygon":square}])),
        ("/geoFence/breachReturn", json!([40.0, -79.0, 50])),
        ("/rallyPoints/points", json!([[40.0, -79.0, 50]])),
        ("/mission/vehicleType", json!(1)),
    ]);
    let file = read_text(&text);
    assert_eq!(file.settings, ["ap_max_distance_from_home = 300"]);
    let said = findings(&file);
    for begin in [
        "changed  fence: 300.7 m → 300 m",
        "assumed  vehicle type: 1 → 2",
        "lost     fence circle 1: stay outside",
        "lost     WP 0 fence: the waypoint is inside the fence circle 1",
        "lost     WP 2 fence: the waypoint is inside the fence circle 1",
        "lost     fence polygon 0: stay inside",
        "lost     breach return point",
        "lost     rally points: 1 point",
    ] {
        assert!(said.iter().any(|line| line.starts_with(begin)), "{begin}: {said:#?}");
    }
    assert_eq!(said.len(), 9, "{said:#?}");
    let features = qgc_fences(&text);
    assert_eq!(
        features.iter().map(|feature| feature.zone).collect::<Vec<_>>(),
        [Some(Zone::Exclusion), Some(Zone::Inclusion)]
    );
    assert_eq!(features.iter().map(|feature| feature.vertices().count()).collect::<Vec<_>>(), [72, 4]);
    assert!(qgc_fences(EXAMPLE).is_empty() && qgc_fences("{").is_empty());
}

#[test]
fn wrong_files_give_a_sentence_with_its_place() {
    for (edits, sentence) in [
        (("/fileType", json!("Mission")), "Mission is not a plan"),
        (("/version", json!(2)), "version 2 of a plan is unknown"),
        (("/mission", json!(null)), "the plan has no mission"),
        (("/mission/version", json!(9)), "version 9 of a mission is unknown"),
        (("/mission/items", json!({})), "the mission has no list of items"),
        (("/mission/items/0/type", json!("X")), "X is not a type of item"),
        (("/mission/items/0/params", json!([1, 2])), "params has 2 values"),
        (("/mission/items/0/params/4", json!(91)), "item 1: latitude 91 is out of range, allowed: -90 to 90"),
        (("/mission/items/0/params/4", json!("40,4")), "latitude is not a number"),
        (("/mission/items/0/command", json!(70_000)), "command 70000 is out of range"),
        (("/mission/items/0/command", json!(null)), "the item has no command"),
        (("/mission/items/0/frame", json!(1)), "item 1: frame 1 is not one of a plan"),
        (("/geoFence/circles/0/circle/radius", json!(-5)), "radius -5 m is out of range"),
        (("/geoFence/polygons", json!([{"polygon": [[1, 2]]}])), "a polygon of 1 points is no area"),
    ] {
        let said = fault(&edited(&[edits]));
        assert!(said.contains(sentence), "{said}\n{sentence}");
    }
    let text = EXAMPLE.replace("40.464,-79.5175", "94.0,-79.5175");
    assert_eq!(fault(&text), "x:5:4: item 1: latitude 94 is out of range, allowed: -90 to 90");
    let item = json!({"type":"SimpleItem","command":16,"frame":3,"params":[0,5,0,0,40,-79,50]});
    let many = edited(&[("/mission/items", vec![item.clone(); 31].into())]);
    assert!(fault(&many).ends_with("waypoint 30 does not fit: the file has 31"), "{}", fault(&many));
    let too_many = edited(&[("/mission/items", vec![item; 10_001].into())]);
    assert!(fault(&too_many).ends_with("the mission has 10001 items, at most 10000 are read"));
}

#[test]
fn an_implausible_home_costs_a_finding_not_the_plan() {
    for (home, line) in [
        (json!([91, 2, 3]), "home: 91,2 → unknown: latitude 91 is out of range"),
        (json!([1, 2, 99_999]), "home altitude: 99999 m → unknown: allowed: -500 to 9000 m"),
    ] {
        let file = read_text(&edited(&[("/mission/plannedHomePosition", home)]));
        assert!(!file.plan.waypoints.is_empty());
        let all: Vec<String> = file.losses.findings.iter().map(ToString::to_string).collect();
        assert!(all.iter().any(|finding| finding.contains(line)), "{all:?}");
    }
}

#[test]
fn private_data_are_used_for_items_that_nobody_edited() {
    let mut file = read_text(EXAMPLE);
    file.name = "eights".to_owned();
    file.settings.push("ap_max_velocity = 700".to_owned());
    let waypoints = &mut file.plan.waypoints;
    waypoints[0].kind = WaypointType::Hold;
    waypoints[0].pattern = HoldPattern::Figure8;
    waypoints[1].pattern = HoldPattern::Figure8;
    waypoints.insert(1, crate::plan::Waypoint { kind: WaypointType::AltChange, ..waypoints[0] });
    let written = write_file(&file, Format::QgcPlan);
    let text = written.text().into_owned();
    let said: Vec<_> = written.losses.findings.iter().map(ToString::to_string).collect();
    assert!(said[0].starts_with("lost     WP 0 pattern: FIGURE8 → NONE"), "{said:?}");
    let back = read_text(&text);
    assert_eq!((&back.plan, &back.name, &back.settings), (&file.plan, &file.name, &file.settings));
    assert_eq!(findings(&back), [""; 0]);
    // Another program moves the second waypoint.
    let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
    value["mission"]["items"][2]["params"][4] = json!(40.4611);
    let moved = read_text(&value.to_string());
    assert_eq!(
        findings(&moved),
        ["assumed  betadeck: another program edited items: their private data are not used"]
    );
    let patterns: Vec<_> =
        moved.plan.waypoints.iter().map(|waypoint| (waypoint.kind, waypoint.pattern)).collect();
    let (hold, land) = (WaypointType::Hold, WaypointType::Land);
    assert_eq!(
        patterns,
        [(hold, HoldPattern::Figure8), (hold, HoldPattern::None), (land, HoldPattern::None)]
    );
    assert_eq!(moved.plan.waypoints[1].position.lat_e7, 404_611_000);
    // It moves the home only.
    let mut other: serde_json::Value = serde_json::from_str(&text).unwrap();
    other["mission"]["plannedHomePosition"][0] = json!(40.4640);
    let said = findings(&read_text(&other.to_string()));
    let away = "lost     fence: 500 m → none: the home moved away from the centre of the circle";
    assert!(said.iter().any(|line| line == away), "{said:?}");
    // It removes the first item, and the circle.
    value["mission"]["items"].as_array_mut().unwrap().remove(0);
    value["geoFence"]["circles"] = json!([]);
    let removed = read_text(&value.to_string());
    assert_eq!((removed.plan.waypoints.len(), removed.settings.len()), (2, 1));
    assert!(findings(&removed)[0].starts_with("assumed  fence: 500 m → none"), "{:?}", findings(&removed));
    // Private data of another version, and damaged ones, are dropped.
    for private in [json!(7), json!({"version": 2}), json!({"version": 1, "waypoints": 5})] {
        value["betadeck"] = private;
        let dropped = read_text(&value.to_string());
        assert!(
            findings(&dropped)[0].starts_with("assumed  betadeck: the private data"),
            "{:?}",
            findings(&dropped)
        );
    }
}

proptest! {
    #[test]
    fn a_plan_survives(file in plan_file()) {
        let written = write_file(&file, Format::QgcPlan);
        prop_assert!(!written.is_refused());
        let back = read_text(&written.text());
        prop_assert_eq!(&back.plan, &file.plan);
        prop_assert_eq!((&back.name, &back.description, &back.settings), (&file.name, &file.description, &file.settings));
        if file.home.unwrap().position != crate::geo::LatLon::default() {
            prop_assert_eq!(back.home, file.home);
        }
        let again = write_file(&back, Format::QgcPlan);
        prop_assert_eq!(again.text(), written.text());
        prop_assert!(again.losses.findings.len() <= written.losses.findings.len());
    }

    #[test]
    fn cut_and_damaged_plans_do_not_panic(at in 0..EXAMPLE.len(), byte in "[\\[\\]{}\":,0-9a-z-]") {
        let _ = parse("any", &EXAMPLE[..at], Format::QgcPlan);
        let damaged = format!("{}{byte}{}", &EXAMPLE[..at], &EXAMPLE[at + 1..]);
        let _ = parse("any", &damaged, Format::QgcPlan);
        let _ = qgc_fences(&damaged);
    }
}
