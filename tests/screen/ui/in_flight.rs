//! Keys in, screen out, with a session: losses in flight, and an upload read back.

#![allow(clippy::unwrap_used, reason = "tests may panic")]

use betadeck::session::Command;
use betadeck::telemetry::NavState;
use betadeck::ui::AppState;

use crate::ui::session_rig::Rig;

#[tokio::test]
async fn a_cut_rc_link_shows_failsafe_and_the_landing_that_was_chosen() {
    let mut rig = Rig::new().await;
    rig.keys(":set ap_rx_loss_policy=LAND\nF").await;
    rig.fly_to(NavState::Approaching).await;
    rig.keys("x").await;
    rig.until("the cut", |state| state.shared.view.rc_cut).await;
    rig.assert_shown(&["RC CUT", "x restore RC"]);
    rig.fly_to(NavState::Landing).await;
    rig.assert_shown(&[
        "◆ LANDING",
        "RC link lost.",
        "Failsafe stage 1",
        "policy LAND",
        "APPROACHING → LANDING",
    ]);
    rig.fly_to(NavState::Complete).await;
    rig.assert_shown(&["DISARMED", "The RC link is cut.", "x restores it", "◆ COMPLETE"]);
}

/// Steps through the flight until the screen matches.
async fn step_until(rig: &mut Rig, wanted: impl Fn(&AppState) -> bool) {
    for _ in 0..400 {
        if wanted(&rig.state) {
            return;
        }
        let before = rig.time();
        rig.keys(".").await;
        rig.until("a step", |state| state.shared.view.vehicle.time > before).await;
    }
    panic!("never seen\n{}", rig.screen());
}

#[tokio::test]
async fn a_cut_link_counts_down_to_the_drop_and_the_panel_says_how_to_take_it_back() {
    let mut rig = Rig::new().await;
    rig.keys("F").await;
    rig.fly_to(NavState::Approaching).await;
    rig.keys("x").await;
    step_until(&mut rig, |state| state.shared.view.vehicle.craft.failsafe_ahead.is_some()).await;
    rig.assert_shown(&["Failsafe in ", " s: DROP, motors off.", "x restores the link"]);
    let ahead = rig.picture().craft.failsafe_ahead.unwrap();
    let lost = rig.time();
    step_until(&mut rig, |state| state.shared.view.vehicle.craft.armed == Some(false)).await;
    let passed_s = rig.time().seconds_since(lost);
    assert!((passed_s - ahead.in_s).abs() < 0.1, "{ahead:?}, {passed_s} s passed");
    rig.assert_shown(&["Disarmed in the air.", "{, then b takes it back", "R puts the craft"]);
    rig.keys(" ").await;
    rig.until("the crash", |state| state.shared.view.vehicle.truth.as_ref().unwrap().crashed).await;
    rig.assert_shown(&["The craft crashed.", "{, then b takes it back"]);
    rig.keys("{").await;
    rig.until("before the mishap", |state| state.shared.is_rewound()).await;
    assert!(rig.time() < lost, "{:?} {lost:?}", rig.time());
    rig.keys("b").await;
    rig.until("the flight", |state| !state.shared.is_rewound()).await;
    assert_eq!(rig.picture().craft.armed, Some(true), "{}", rig.screen());
}

#[tokio::test]
async fn a_wreck_that_lay_for_minutes_at_a_high_speed_is_taken_back_by_the_two_keys_that_are_named() {
    let mut rig = Rig::new().await;
    rig.keys("F").await;
    rig.fly_to(NavState::Approaching).await;
    let flown = rig.time();
    rig.keys("x ").await;
    rig.until("the crash", |state| state.shared.view.vehicle.truth.as_ref().unwrap().crashed).await;
    rig.session.commands.send(Command::Speed(f64::INFINITY)).await.unwrap();
    rig.until("three minutes", |state| state.shared.view.vehicle.time.seconds_since(flown) > 180.0).await;
    rig.keys(" ").await;
    rig.until("the pause", |state| state.shared.view.paused).await;
    rig.keys("{").await;
    rig.until("before the mishap", |state| state.shared.is_rewound()).await;
    assert_eq!(rig.picture().craft.armed, Some(true), "{}", rig.screen());
    assert!(rig.time().seconds_since(flown) < 5.0, "{}", rig.screen());
    rig.keys("b").await;
    rig.until("the flight", |state| !state.shared.is_rewound()).await;
    assert_eq!(rig.picture().craft.armed, Some(true), "{}", rig.screen());
}

#[tokio::test]
async fn a_plan_that_the_autopilot_would_refuse_is_not_flown_and_the_pilot_keeps_the_throttle_when_stopped() {
    let mut rig = Rig::new().await;
    rig.keys("U").await;
    rig.until("the plan", |state| state.shared.plan_is_on_craft()).await;
    rig.cli("set ap_max_distance_from_home = 60").await;
    rig.until("the fence", |state| {
        state
            .shared
            .view
            .vehicle
            .settings
            .is_some_and(|settings| settings.assumptions().fence_m == Some(60.0))
    })
    .await;
    rig.keys("F").await;
    rig.assert_shown(&["Not flown, the autopilot would refuse: waypoint", "By hand: a and t."]);
    assert_eq!(rig.state.shared.view.pilot, None);
    rig.keys(" ").await;
    rig.until("a fix", |state| state.shared.view.vehicle.time.as_secs_f64() > 6.0).await;
    rig.assert_shown(&["The autopilot would refuse: waypoint", "2 edits the plan, U uploads it"]);
    rig.keys("a").await;
    rig.until("armed", |state| state.shared.view.vehicle.craft.armed == Some(true)).await;
    rig.assert_shown(&["The autopilot would refuse: waypoint", "→ a disarms"]);
    rig.keys("a").await;
    rig.until("disarmed", |state| state.shared.view.vehicle.craft.armed == Some(false)).await;
    rig.cli("set ap_max_distance_from_home = 500").await;
    rig.until("the fence", |state| {
        state
            .shared
            .view
            .vehicle
            .settings
            .is_some_and(|settings| settings.assumptions().fence_m == Some(500.0))
    })
    .await;
    rig.keys("F").await;
    rig.until("the climb", |state| state.shared.view.vehicle.truth.as_ref().unwrap().alt > 2.0).await;
    rig.keys("F").await;
    rig.until("the pilot is stopped", |state| state.shared.view.pilot.is_none()).await;
    let stopped = rig.time();
    rig.session.commands.send(Command::Speed(4.0)).await.unwrap();
    rig.until("ten seconds", |state| state.shared.view.vehicle.time.seconds_since(stopped) > 10.0).await;
    rig.keys("F").await;
    rig.assert_shown(&["The craft is in the air already: `g` engages the autopilot."]);
    assert!(rig.picture().truth.as_ref().unwrap().alt < 12.0, "{}", rig.screen());
}

#[tokio::test]
async fn disarming_in_flight_says_how_to_take_it_back() {
    let mut rig = Rig::new().await;
    rig.keys("F").await;
    rig.fly_to(NavState::Approaching).await;
    rig.keys("a").await;
    rig.assert_shown(&["▲ The motors would stop", "press `a` again within 2 s to disarm."]);
    assert_eq!(rig.picture().craft.armed, Some(true));
    rig.keys("a").await;
    step_until(&mut rig, |state| state.shared.view.vehicle.craft.armed == Some(false)).await;
    rig.assert_shown(&["Disarmed in the air.", "{, then b takes it back"]);
}

#[tokio::test]
async fn a_lost_gps_fix_shows_why_the_autopilot_idles_and_its_return_resumes_the_mission() {
    let mut rig = Rig::new().await;
    rig.keys("F").await;
    rig.fly_to(NavState::Approaching).await;
    rig.keys(":fault gps-loss\n").await;
    rig.fly_to(NavState::Idle).await;
    rig.assert_shown(&["◆ IDLE", "APPROACHING → IDLE: the GPS fix is lost", "GPS_LOST"]);
    let lost = rig.time();
    rig.keys(".").await;
    rig.until("a step", |state| state.shared.view.vehicle.time > lost).await;
    rig.assert_shown(&["⊕ no", "AUTOPILOT refused: The GPS fix was lost", "resumes 2 s after it is back"]);
    rig.keys(":end gps-loss\n").await;
    rig.fly_to(NavState::Approaching).await;
    rig.assert_shown(&["● ARMED AUTOPILOT", "⊕ 3D", "IDLE → APPROACHING"]);
}

#[tokio::test]
async fn a_plan_is_uploaded_and_read_back() {
    let mut rig = Rig::new().await;
    rig.assert_shown(&["● 4 not on the craft"]);
    rig.keys("U").await;
    rig.assert_shown(&["✓ Uploaded", "4 waypoints."]);
    rig.until("the plan", |state| state.shared.plan_is_on_craft()).await;
    rig.assert_shown(&["✓ on the craft"]);
}
