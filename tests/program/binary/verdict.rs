//! `complete` is reported only if it is true. A craft that drifts, falls or misses is reported as `missed`,
//! with the worst value and its excess.

use betadeck::plan::builtin::{BuiltinPlan, PLANS};

use crate::binary::support::{Flown, Sandbox};

/// A plan that holds sixty seconds 20 m above home.
const HOLD: &str = "waypoint insert 0 40.4635000 -79.5182000 2000 0 HOLD 600 NONE\n";
/// A plan that lands at home.
const LAND: &str = "waypoint insert 0 40.4635000 -79.5182000 5000 0 LAND 0 NONE\n";
/// A plan that flies past a point one kilometre up and then lands at home.
const HIGH: &str = "waypoint insert 0 40.4644000 -79.5182000 100000 0 FLYOVER 0 NONE\n\
                    waypoint insert 1 40.4635000 -79.5182000 2000 0 LAND 0 NONE\n";

fn fly(plan: &str, arguments: &[&str]) -> Flown {
    let sandbox = Sandbox::new();
    sandbox.write("plan.txt", plan);
    sandbox.fly(&[&["plan.txt"], arguments].concat())
}

/// Returns the flight and the reason why the true flight path contradicts its completion.
#[track_caller]
fn missed(flown: Flown) -> (Flown, String) {
    let flown = flown.ends(1, "missed");
    let reason = flown.first("end").text("reason").to_owned();
    (flown, reason)
}

/// Returns a number of a waypoint in the last line.
#[track_caller]
fn of_waypoint(flown: &Flown, index: usize, key: &str) -> f64 {
    let number = flown.first("end").value("waypoints")[index][key].as_f64();
    number.unwrap_or_else(|| panic!("no {key} of {index} in {:?}", flown.first("end")))
}

#[test]
fn a_craft_that_drifts_away_is_not_complete() {
    let blown = fly(HOLD, &["--fault", "wind@10,,16@0", "--set", "ap_max_angle=25"]);
    let (flown, reason) = missed(blown);
    assert!(reason.contains("waypoint 0 (HOLD)") && reason.contains("12.0 m are allowed"), "{reason}");
    assert!(of_waypoint(&flown, 0, "hold_max_m") > 100.0);
    assert!(flown.first("end").number("parked_m") > 150.0 && flown.first("end").number("parked_mps") > 1.0);
}

#[test]
fn a_landing_far_from_its_place_is_not_complete() {
    let arguments = ["--takeoff", "50", "--fault", "wind@5,,20@0", "--set", "ap_max_angle=25"];
    let (flown, reason) = missed(fly(LAND, &arguments));
    assert!(reason.contains("touched down") && reason.contains("waypoint 0 (LAND)"), "{reason}");
    assert!(of_waypoint(&flown, 0, "miss_m") > 500.0);
}

#[test]
fn a_craft_that_is_five_kilometres_away_is_not_complete() {
    let (flown, reason) = missed(fly(HOLD, &["--fault", "teleport@10,,0,5000,0"]));
    assert!(reason.contains("waypoint 0 (HOLD) was not held"), "{reason}");
    assert!((of_waypoint(&flown, 0, "miss_m") - 5000.0).abs() < 5.0);
}

#[test]
fn a_craft_that_lies_on_the_ground_is_not_complete() {
    let (flown, reason) = missed(fly(HOLD, &["--fault", "motor-stuck@5,,2:0.5"]));
    assert!(reason.contains("too low; 10.0 m are allowed"), "{reason}");
    assert!((of_waypoint(&flown, 0, "miss_alt_m") - 20.0).abs() < 2.0);
}

#[test]
fn a_waypoint_that_is_passed_far_below_is_not_complete() {
    let (flown, reason) = missed(fly(HIGH, &[]));
    assert!(reason.contains("waypoint 0 (FLYOVER)") && reason.contains("too low"), "{reason}");
    assert!(of_waypoint(&flown, 0, "miss_alt_m") > 800.0);
    assert!(of_waypoint(&flown, 0, "miss_m") < 5.0, "it was passed, but not up there");
    assert!(of_waypoint(&flown, 1, "miss_m") < 2.0);
}

#[test]
fn how_much_is_too_much_is_the_users_to_say() {
    let arguments = ["--fault", "wind@10,,16@0", "--set", "ap_max_angle=25", "--tolerance", "1000"];
    fly(HOLD, &arguments).ends(0, "complete");
    missed(fly(
        HOLD,
        &["--wind", "8@270", "--gust", "2", "--tolerance", "0", "--set", "ap_waypoint_hold_radius=50"],
    ));
}

#[test]
fn every_shipped_plan_is_truly_flown_in_calm_and_rough_air() {
    let airs: [&[&str]; 2] = [&[], &["--wind", "6@250", "--turbulence", "light"]];
    let sandbox = Sandbox::new();
    for BuiltinPlan { name: plan, .. } in PLANS {
        for airframe in ["iris", "five-inch"] {
            for (air, seed) in airs.iter().zip(["1", "2"]) {
                let arguments = [&[*plan, "--airframe", airframe, "--seed", seed], *air].concat();
                let flown = sandbox.fly(&arguments);
                assert_eq!(flown.first("end").text("result"), "complete", "{arguments:?}: {}", flown.err);
            }
        }
    }
}

#[test]
fn what_the_pilot_flies_and_what_is_resumed_does_not_count() {
    // The craft is pushed 40 m away in the middle of the hold, released, and is back in time.
    let pushed = fly(HOLD, &["--stick", "pitch=1900@10,6"]).ends(0, "complete");
    assert!(of_waypoint(&pushed, 0, "hold_max_m") < 12.0);
    // The autopilot is switched off, the craft is flown away by hand, and the autopilot is switched on again.
    // It flies the hold again.
    let again = fly(HOLD, &["--stick", "aux2=1000@10,10", "--stick", "pitch=1900@11,6"]).ends(0, "complete");
    assert!(of_waypoint(&again, 0, "hold_max_m") < 12.0);
}

#[test]
fn a_return_home_is_reported_but_not_judged() {
    let far = "waypoint insert 0 40.4680000 -79.5182000 2000 0 FLYOVER 0 NONE\n";
    let lines = "set ap_max_distance_from_home = 600\nset ap_geofence_action = RTH\n";
    let sandbox = Sandbox::new();
    sandbox.write("plan.txt", far);
    sandbox.write("fence.txt", lines);
    let fenced = ["--fault", "teleport@5,,0,650,0", "--settings", "fence.txt"];
    let flown = sandbox.fly(&[&["plan.txt"], &fenced[..]].concat()).ends(1, "landed");
    let waypoints = flown.first("end").value("waypoints").as_array().unwrap().clone();
    assert!(
        !waypoints.is_empty() && waypoints.iter().all(|waypoint| waypoint["source"] == "rth"),
        "{waypoints:?}"
    );
}

#[test]
fn what_really_happened_is_reported_in_sentences_too() {
    let sandbox = Sandbox::new();
    sandbox.write("plan.txt", HOLD);
    let ran = sandbox.run(&["fly", "plan.txt"]).exits(0);
    let truths: Vec<_> = ran.out.lines().filter(|line| line.contains("Truth: ")).collect();
    assert_eq!(truths.len(), 3, "{truths:?}");
    assert!(truths[0].contains("waypoint 0 (HOLD) held within "), "{truths:?}");
    assert!(truths[2].ends_with(" % of the battery used."), "{truths:?}");
    assert!(ran.err.contains("complete: mission complete, parked 0."), "{}", ran.err);
}

#[test]
fn a_craft_that_never_arms_or_climbs_says_what_it_waited_for() {
    let reason = |arguments: &[&str], result| {
        let flown = fly(HOLD, &[&["--timeout", "60"], arguments].concat()).ends(1, result);
        flown.first("end").text("reason").to_owned()
    };
    let fix = reason(&["--gps-loss-at", "boot+0"], "timeout");
    assert!(fix.contains("the craft never armed: it waits for a GPS fix"), "{fix}");
    let blocked = reason(&["--stick", "throttle=1500@boot+0"], "timeout");
    assert!(blocked.contains("arming is blocked by THROTTLE (lower the throttle)"), "{blocked}");
    let heavy = reason(&["--fault", "payload@boot+0,,5"], "refused");
    assert!(heavy.contains("does not lift off") && heavy.contains(" of its weight"), "{heavy}");
}

#[test]
fn a_waypoint_below_the_ground_and_an_impossible_touchdown_are_warned_of() {
    let deep = "waypoint insert 0 40.4640000 -79.5182000 -500 0 FLYOVER 0 NONE\n\
                waypoint insert 1 40.4635000 -79.5182000 2000 0 LAND 0 NONE\n";
    let sandbox = Sandbox::new();
    sandbox.write("deep.txt", deep);
    let shown = sandbox.run(&["plan", "show", "deep.txt"]).exits(0);
    assert!(shown.out.contains("waypoint 0 is 5.0 m below home"), "{}", shown.out);

    let text = std::fs::read_to_string(crate::binary::support::plan("land.toml")).expect("the plan");
    sandbox.write(
        "land.toml",
        &text.replacen("settings = [", "settings = [\"ap_landing_throttle_threshold = 450\", ", 1),
    );
    let shown = sandbox.run(&["plan", "show", "land.toml"]).exits(0);
    assert!(shown.out.contains("ap_landing_throttle_threshold = 450 can never be met"), "{}", shown.out);

    let set = "ap_landing_throttle_threshold=450";
    let flown = fly(LAND, &["--set", set, "--takeoff", "5", "--timeout", "30"]);
    let warned = flown.all("notice").any(|line| {
        line.text("text").starts_with("Caution: ap_landing_throttle_threshold = 450 can never be met")
    });
    assert!(warned, "{:?}", flown.all("notice").collect::<Vec<_>>());
}
