//! An upload of a plan does what its lines do on the command line.

use betadeck_core::firmware::cli::{Interpreter, RefusedLine};
use betadeck_core::firmware::config::Configuration;
use betadeck_core::firmware::{Firmware, FirmwareOptions};
use betadeck_core::geo::LatLon;
use betadeck_core::plan::builtin::PLANS;
use betadeck_core::plan::{FlightPlan, Waypoint, upload_lines};

fn firmware() -> Firmware {
    Firmware::new(Configuration::default(), FirmwareOptions::default())
}

/// Runs the lines of an upload until one is refused, and returns the replies.
fn typed(
    firmware: &mut Firmware,
    plan: &FlightPlan,
    settings: &[String],
) -> Result<Vec<String>, RefusedLine> {
    let mut session = Interpreter::default();
    let run = |line: String| {
        let said = firmware.run_cli(&mut session, &line);
        let reply = said.text.trim().to_owned();
        if said.failed { Err(RefusedLine { line, reply }) } else { Ok(reply) }
    };
    upload_lines(plan.records(), settings).map(run).collect()
}

/// Uploads in both ways. Returns the result and the number of stored waypoints.
fn upload(plan: &FlightPlan, settings: &[&str]) -> (Result<Vec<String>, RefusedLine>, usize) {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let (mut as_plan, mut as_lines) = (firmware(), firmware());
    // An upload replaces this plan, unless a setting is refused.
    for firmware in [&mut as_plan, &mut as_lines] {
        let one = FlightPlan { waypoints: std::iter::once(Waypoint::default()).collect() };
        assert!(firmware.upload(&one, &[]).is_ok());
    }
    let result = as_plan.upload(plan, &settings);
    assert_eq!(result, typed(&mut as_lines, plan, &settings));
    assert_eq!(format!("{as_plan:?}"), format!("{as_lines:?}"), "the whole firmware is the same");
    (result, as_plan.stored_plan().waypoints.len())
}

#[test]
fn a_plan_and_its_settings_are_stored_as_by_their_lines() {
    for builtin in PLANS {
        let file = builtin.read().unwrap();
        let settings: Vec<&str> = file.settings.iter().map(String::as_str).collect();
        let (result, stored) = upload(&file.plan, &settings);
        assert_eq!(stored, file.plan.waypoints.len(), "{result:?}");
        assert_eq!(result.unwrap().len(), settings.len() + 1 + stored);
    }
}

#[test]
fn the_lines_before_a_refusal_keep_their_effect() {
    let place = |lat_e7, lon_e7| Waypoint { position: LatLon::new(lat_e7, lon_e7), ..Waypoint::default() };
    for (lat_e7, lon_e7, why) in [
        (900_000_001, 0, "LATITUDE OUT OF RANGE. USE: -90.0 to 90.0"),
        (0, -1_800_000_001, "LONGITUDE OUT OF RANGE. USE: -180.0 to 180.0"),
    ] {
        let waypoints = [place(1, 2), place(3, 4), place(lat_e7, lon_e7), place(5, 6)].into_iter().collect();
        let (result, stored) = upload(&FlightPlan { waypoints }, &["ap_max_angle = 33"]);
        let refused = result.unwrap_err();
        assert_eq!((refused.reply.as_str(), stored), (&*format!("###ERROR IN waypoint: {why}###"), 2));
        assert!(refused.line.starts_with("waypoint insert 2 "), "{refused}");
    }
    let (result, stored) = upload(&FlightPlan::default(), &["ap_max_angle = 33", "ap_no_such_thing = 1"]);
    assert_eq!((result.unwrap_err().line.as_str(), stored), ("set ap_no_such_thing = 1", 1));
}
