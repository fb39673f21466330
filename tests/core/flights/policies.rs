//! Every RX-loss policy with every failsafe procedure, in a mission and in manual hover.

use crate::flights::rig::{Rig, world};
use betadeck_core::telemetry::{DisarmReason, EventKind, FirmwareEvent, Mode};
use betadeck_core::vehicle::VehicleCommand;

const MISSION: &str = "\nwaypoint insert 0 40.4648508 -79.5182000 2000 500 FLYOVER 0 ORBIT
waypoint insert 1 40.4648508 -79.5174926 2000 500 LAND 0 ORBIT";

/// Cuts the link in flight. Returns the response of stage 2 and the modes about half a second later.
fn stage_2(policy: &str, procedure: &str, engaged: bool) -> (String, String) {
    let lines = format!("set ap_rx_loss_policy = {policy}\nset failsafe_procedure = {procedure}{MISSION}");
    let mut rig = Rig::new(world(0).0, &lines, 10.0);
    if engaged {
        rig.engaged().fly(3.0);
    } else {
        rig.until(60.0, "hover", |rig| rig.vehicle.embedded().unwrap().altitude_m() > 9.0);
    }
    rig.vehicle.apply(&VehicleCommand::CutRc(true));
    rig.fly(2.1);
    let word: Option<&str> = rig.events.iter().find_map(|event| match event.kind {
        EventKind::Firmware(FirmwareEvent::Failsafe { stage: 2, procedure, .. }) => Some(procedure.into()),
        _ => None,
    });
    let last = rig.samples.last().unwrap();
    if !last.armed {
        assert_eq!(rig.disarmed().unwrap().1, DisarmReason::Failsafe);
    }
    let shown = [Mode::Arm, Mode::Autopilot, Mode::Failsafe, Mode::AltHold, Mode::PosHold];
    let letters = shown.iter().map(|&mode| if last.modes.has(mode) { 'x' } else { '-' }).collect();
    (word.unwrap_or("nothing").to_owned(), letters)
}

#[test]
fn response_by_policy_procedure_and_flight() {
    // Modes: ARM, AUTOPILOT, FAILSAFE, ALTHOLD, POS HOLD.
    let by_hand = |procedure| match procedure {
        "DROP" => ("DROP", "--x--"),
        "AUTO-LAND" => ("AUTO-LAND", "x-xxx"),
        _ => ("GPS-RESCUE", "xxxxx"),
    };
    for procedure in ["DROP", "AUTO-LAND", "GPS-RESCUE"] {
        for policy in ["DISABLE", "CONTINUE", "LAND"] {
            let in_mission = match policy {
                "CONTINUE" => ("CONTINUE", "xxxxx"),
                "LAND" => ("LAND", "x-xxx"),
                _ => by_hand(procedure),
            };
            for (engaged, (word, modes)) in [(true, in_mission), (false, by_hand(procedure))] {
                let got = stage_2(policy, procedure, engaged);
                assert_eq!(
                    got,
                    (word.to_owned(), modes.to_owned()),
                    "{policy} {procedure} engaged {engaged}"
                );
            }
        }
    }
}

/// Cuts the link in a mission, 12 to 28 m from home. Returns the height of the rescue's return above the
/// craft, m.
fn rescue_climb(min_start_dist_m: u32) -> f64 {
    let lines = format!(
        "set gps_rescue_min_start_dist = {min_start_dist_m}\nset failsafe_procedure = GPS-RESCUE{MISSION}"
    );
    let mut rig = Rig::new(world(0).0, &lines, 10.0);
    rig.engaged();
    rig.until(60.0, "12 m from home", |rig| {
        rig.samples.last().is_some_and(|now| now.from([0.0, 0.0]) > 12.0)
    });
    rig.vehicle.apply(&VehicleCommand::CutRc(true));
    let plans = rig.plans().len();
    rig.until(10.0, "the rescue", |rig| rig.plans().len() > plans);
    let now = *rig.samples.last().unwrap();
    assert!(now.from([0.0, 0.0]) < 28.0, "{}", now.from([0.0, 0.0]));
    let (_, plan) = rig.plans().pop().unwrap();
    plan.waypoints[0].altitude.above_home_m() - now.alt
}

#[test]
fn rescue_climbs_first_only_away_from_home() {
    let near = rescue_climb(30);
    assert!(near.abs() < 1.0, "{near}");
    let far = rescue_climb(5);
    assert!((9.0..12.0).contains(&far), "the initial climb: {far}");
}
