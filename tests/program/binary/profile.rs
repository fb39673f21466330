//! The profile `master` in the executable: its flights, its command line, its scenarios.

use serde_json::Value;

use crate::binary::support::Sandbox;

#[test]
fn the_square_is_flown_by_the_laws_of_master_in_two_minutes() {
    let sandbox = Sandbox::new();
    let flown = sandbox.run(&["fly", "square", "--profile", "master", "--json", "-"]).exits(0);
    let last: Value = serde_json::from_str(flown.out.lines().last().expect("a line")).expect("JSON");
    let seconds = last["flown_s"].as_f64().or_else(|| last["sim_s"].as_f64()).expect("a time");
    assert!((110.0..145.0).contains(&seconds), "{seconds}: the guide takes 225 s");
}

#[test]
fn a_landing_with_the_usual_gains_falls_as_on_master() {
    let fallen = Sandbox::new().run(&["fly", "land", "--profile", "master"]).exits(1);
    let all = fallen.out + &fallen.err;
    assert!(all.contains("it hit the ground sinking at 12"), "{all}");
}

#[test]
fn a_scenario_chooses_its_profile_and_an_option_overrides_it() {
    let sandbox = Sandbox::new();
    let text = "format = 1\nname = \"laws\"\ndescription = \"The laws\"\n[plan]\nbuiltin = \"square\"\n[craft]\n\
                profile = \"master\"\n[[expect]]\nname = \"its own laws\"\nevent = \"COMPLETE\"\nwithin = \"100..150 s after engaged\"\n";
    sandbox.write("laws.toml", text);
    sandbox.run(&["check", "laws.toml"]).exits(0);
    let failed = sandbox.run(&["check", "laws.toml", "--profile", "guide"]).exits(1);
    assert!(failed.out.contains(" --profile guide"), "{}", failed.out);
    sandbox.write("wrong.toml", &text.replace("\"master\"", "\"wing\""));
    let wrong = sandbox.run(&["check", "wrong.toml"]).exits(2);
    assert!(wrong.err.contains("allowed: guide, master"), "{}", wrong.err);
}

#[test]
fn a_campaign_of_a_plan_flies_by_the_profile_and_one_of_a_scenario_refuses_it() {
    let sandbox = Sandbox::new();
    let campaign = |plan: &str| {
        sandbox.run(&[
            "campaign",
            plan,
            "--flights",
            "2",
            "--vary",
            "wind=[\"1@0\", \"2@90\"]",
            "--profile",
            "master",
        ])
    };
    let fallen = campaign("land").exits(1);
    assert!(fallen.out.contains("hit the ground sinking at 1"), "{}", fallen.out);
    sandbox.write(
        "laws.toml",
        "format = 1\nname = \"laws\"\ndescription = \"Laws\"\n[plan]\nbuiltin = \"land\"\n",
    );
    let scenario = sandbox.run(&["campaign", "laws.toml", "--flights", "2", "--profile", "master"]).exits(2);
    assert!(scenario.err.contains("--profile"), "{}", scenario.err);
}

#[test]
fn settings_of_master_suggest_its_profile_once() {
    let sandbox = Sandbox::new();
    sandbox.write("craft.txt", "set ap_nav_corner_speed = 300\nset ap_nav_decel = 200\n");
    let flown = sandbox.run(&["fly", "land", "--settings", "craft.txt"]).exits(0);
    let all = flown.out + &flown.err;
    assert_eq!(all.matches("act in the profile master only").count(), 1, "{all}");
}

#[test]
fn a_rescue_that_falls_is_reported_with_the_lines_that_mend_it() {
    let sandbox = Sandbox::new();
    sandbox.write(
        "diff.txt",
        "# Betaflight / SITL (SITL) 2026.12.0-alpha Nov 20 2026 / 10:00:00 (abc) MSP API: 1.49\n\
         set failsafe_procedure = GPS-RESCUE\nset gps_rescue_return_alt = 15\nset gps_rescue_alt_mode = FIXED_ALT\n",
    );
    let few = ["rescue", "diff.txt", "--distance", "40", "--directions", "1"];
    let flown = sandbox.run(&[&few[..], &["--scenario", "worst.toml"]].concat()).exits(1);
    assert!(flown.out.contains("In calm air it comes home from 40 m in 0 of "), "{}", flown.out);
    assert!(flown.out.contains("set ap_altitude_p = 2\n"), "{}", flown.out);
    assert!(sandbox.read("worst.toml").contains("profile = \"master\""));
    sandbox.run(&["check", "worst.toml"]).exits(1);
    sandbox.write(
        "mended.txt",
        &(sandbox.read("diff.txt")
            + "set ap_altitude_p = 2\nset ap_altitude_d = 200\nset ap_hover_throttle = 1500\nset gps_rescue_descend_rate = 50\n"),
    );
    let few = ["rescue", "mended.txt", "--distance", "40", "--directions", "1", "--json", "-"];
    let mended = sandbox.run(&few);
    let answer: Value = serde_json::from_str(&mended.out).expect("JSON");
    let home = answer["home"].as_u64().expect("a number");
    assert!(home >= 15, "{home} of {}", answer["flights"].as_array().map_or(0, Vec::len));
}
