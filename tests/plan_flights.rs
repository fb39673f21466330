//! Every shipped plan is flown to its end by the program itself.

use std::path::Path;

use betadeck::plan::builtin::PLANS;

/// The JSON lines of a flight, after checking its exit code.
fn fly(arguments: &[&str], exit_code: i32) -> Vec<serde_json::Value> {
    let output = assert_cmd::Command::cargo_bin("betadeck")
        .expect("the program")
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("plans"))
        .env_clear()
        .arg("fly")
        .args(arguments)
        .args(["--json", "-"])
        .output()
        .expect("a flight");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(exit_code), "{arguments:?}: {errors}");
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    text.lines().map(|line| serde_json::from_str(line).expect("a JSON object a line")).collect()
}

/// The types whose state machine was seen ARRIVED or beyond, in order, without repetitions.
fn visited(events: &[serde_json::Value]) -> Vec<String> {
    let mut types: Vec<String> = Vec::new();
    for event in events.iter().filter(|event| event["event"] == "state" && event["to"] == "ARRIVED") {
        types.push(event["type"].as_str().unwrap_or_default().to_owned());
    }
    types
}

#[test]
fn every_builtin_plan_lands() {
    for plan in PLANS {
        let events = fly(&[plan.name], 0);
        let end = events.last().expect("an end");
        assert_eq!(
            (&end["event"], &end["result"]),
            (&"end".into(), &"complete".into()),
            "{}: {end}",
            plan.name
        );
        let disarmed = events.iter().find(|event| event["event"] == "disarmed").expect("a disarm");
        assert_eq!(disarmed["reason"], "LANDING", "{}", plan.name);
        let file = plan.read().expect("a plan");
        let places = file.plan.waypoints.iter().filter(|waypoint| waypoint.kind.is_positional());
        let places: Vec<String> = places.map(|waypoint| waypoint.kind.to_string()).collect();
        assert_eq!(visited(&events), places, "{}", plan.name);
    }
}

#[test]
fn the_guides_block_flies_with_the_guides_settings() {
    let folder = tempfile::tempdir().expect("a folder");
    let settings = folder.path().join("settings.txt");
    let square =
        betadeck::plan::builtin::BuiltinPlan::find("square").expect("the demo").read().expect("a plan");
    let lines: String = square.settings.iter().map(|line| format!("set {line}\n")).collect();
    std::fs::write(&settings, lines).expect("a settings file");
    let settings = settings.to_str().expect("a plain path");
    let from_text = fly(&["guide-square.txt", "--settings", settings, "--noise", "none"], 0);
    let built_in = fly(&["square", "--noise", "none"], 0);
    // The same plan and settings by two ways are the same flight.
    let states = |events: &[serde_json::Value]| -> Vec<serde_json::Value> {
        events.iter().filter(|event| event["event"] == "state").cloned().collect()
    };
    assert_eq!(states(&from_text), states(&built_in));
}
