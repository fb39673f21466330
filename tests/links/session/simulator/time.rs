//! Time and truth come from the simulator: its stamps, its silence, its restart.

use std::time::{Duration, Instant};

use betadeck::link::endpoint::{EndpointKind, SimulatorStats};
use betadeck::session::ReplyTo;
use betadeck::session::policy::{PLACE_IS_EXTERNAL, TIME_IS_EXTERNAL};
use betadeck::session::{Command, SessionView};
use betadeck::telemetry::LinkState;
use betadeck::vehicle::VehicleCommand;

use super::rig::{AHEAD, PATIENCE, START, rig, speaking, stats};

#[tokio::test]
async fn until_a_simulator_speaks_the_firmware_lives_and_nothing_is_made_up() {
    let mut rig = rig().await;
    let view = rig.picture(|view| view.vehicle.time.0 > 50_000).await;
    assert_eq!(view.simulator, Some(LinkState::Waiting));
    assert_eq!(
        (view.vehicle.truth, view.vehicle.estimate.n, view.vehicle.craft.has_fix()),
        (None, None, false)
    );
    assert_eq!(view.vehicle.world.airframe, "external");
    assert_eq!(stats(&view).link, LinkState::Waiting);
    let motors = view.endpoints.iter().find(|endpoint| endpoint.kind == EndpointKind::Motors).unwrap();
    assert_eq!(motors.address, rig.motors.local_addr().unwrap().to_string());

    let (reply, answer) = ReplyTo::channel();
    rig.command(Command::Cli { line: "get ap_max_angle".to_owned(), reply }).await;
    let answer = tokio::time::timeout(PATIENCE, answer).await.unwrap().unwrap();
    assert!(answer.text.contains("ap_max_angle = "), "{}", answer.text);
}

#[tokio::test]
async fn the_simulators_stamps_are_the_time_and_its_state_the_truth() {
    let mut rig = rig().await;
    rig.state(0, 0.0, 0.0).await;
    rig.hear("The simulator sends").await;
    // The first packet only sets the time base; the second sets the start of the craft.
    rig.state(0, 0.0, 0.0).await;
    let begun = rig.picture(|view| view.simulator == Some(LinkState::Flowing)).await.vehicle.time;
    for step in 1..=400 {
        rig.state(10, f64::from(step) * 0.1, f64::from(step) * 0.05).await;
    }
    let flown = |view: &SessionView| view.vehicle.time.0 >= begun.0 + 4_000_000;
    let view = rig.picture(flown).await;
    assert_eq!(view.vehicle.time.0, begun.0 + 4_000_000, "not a tick of the wall clock");
    let truth = view.vehicle.truth.unwrap();
    assert!((truth.n - 40.0).abs() < 0.01 && truth.e.abs() < 0.01 && (truth.alt - 20.0).abs() < 0.01);
    assert!((truth.lat_deg - (START.0 + 40.0 / 111_043.55)).abs() < 1e-9, "{truth:?}");
    assert!((truth.heading_deg - 90.0).abs() < 1e-6 && (truth.pitch_deg - 5.0).abs() < 1e-6);
    assert!((truth.roll_deg + 3.0).abs() < 1e-6 && (truth.vn - 10.0).abs() < 1e-6 && !truth.on_ground);
    assert!((view.vehicle.estimate.pitch_deg.unwrap() - 5.0).abs() < 0.1, "the firmware believes it");
    assert!(view.vehicle.craft.has_fix() && view.vehicle.craft.sats == Some(12));
    let flying = SimulatorStats { link: LinkState::Flowing, dialect: Some("sitl-gz"), refused: 0, old: 0 };
    assert_eq!(stats(&view), flying);
}

#[tokio::test]
async fn what_is_the_simulators_business_is_refused_with_the_way_out() {
    let mut rig = rig().await;
    rig.state(0, 0.0, 0.0).await;
    rig.hear("The simulator sends").await;
    for command in [Command::Pause(true), Command::Step(100), Command::Speed(8.0)] {
        rig.command(command).await;
        rig.hear(TIME_IS_EXTERNAL).await;
    }
    rig.command(Command::Vehicle(VehicleCommand::ResetCraft)).await;
    rig.hear(PLACE_IS_EXTERNAL).await;
    let refused = rig.world("wind=5@270").await.unwrap_err();
    assert!(refused.contains("the simulator makes the air"), "{refused}");
    let before = rig.session.view.borrow().vehicle.time;
    for _ in 0..100 {
        rig.state(10, 0.0, 0.0).await;
    }
    let view = rig.picture(|view| view.vehicle.time.0 >= before.0 + 1_000_000).await;
    assert!(!view.paused && view.simulator == Some(LinkState::Flowing), "it flies on");
}

#[tokio::test]
async fn silence_stops_time_and_is_shown_until_the_simulator_returns() {
    let mut rig = rig().await;
    rig.at = Instant::now();
    for _ in 0..50 {
        rig.state(10, 0.0, 0.0).await;
    }
    rig.hear("The simulator is silent: time is stopped").await;
    let view = rig.picture(|view| view.simulator == Some(LinkState::Silent)).await;
    assert_eq!(stats(&view).link, LinkState::Silent);

    // Keys still act: the firmware can be restarted, and a notice names the way out.
    rig.command(Command::Vehicle(VehicleCommand::ResetCraft)).await;
    rig.hear("The firmware restarted, disarmed").await;
    let still = rig.picture(|view| view.vehicle.truth.is_none()).await;
    assert_eq!(still.vehicle.time, view.vehicle.time);

    // The first packet only sets the time base.
    rig.at = Instant::now() + AHEAD;
    rig.state(10, 7.0, 0.0).await;
    rig.hear("The simulator sends again after ").await;
    rig.state(10, 7.0, 0.0).await;
    let view = rig.picture(|view| view.vehicle.time.0 == still.vehicle.time.0 + 10_000).await;
    assert_eq!(view.simulator, Some(LinkState::Flowing));
    assert!(view.vehicle.truth.unwrap().n.abs() < 1e-6, "it counts from where it is seen now");
}

#[tokio::test]
async fn a_restarted_simulator_finds_a_disarmed_craft_and_resting_sticks() {
    let mut rig = rig().await;
    for _ in 0..700 {
        rig.state(10, 0.0, 0.0).await;
    }
    rig.picture(|view| view.vehicle.time.0 >= 6_900_000).await;
    let mut sticks = betadeck::signals::RcFrame::SAFE;
    sticks.channels[4] = 1900;
    rig.command(Command::Vehicle(VehicleCommand::Sticks(sticks))).await;
    rig.picture(|view| view.sticks == sticks).await;
    for _ in 0..100 {
        rig.state(10, 0.0, 0.0).await;
    }
    rig.picture(|view| view.vehicle.craft.is_armed()).await;

    // Its time jumps back, which counts as a late packet for half a second.
    rig.stamp_ms = 0;
    for _ in 0..60 {
        rig.state(10, 0.0, 0.0).await;
    }
    rig.hear("The simulator was restarted: disarmed.").await;
    let view = rig.picture(|view| !view.vehicle.craft.is_armed()).await;
    assert_eq!(view.sticks, betadeck::signals::RcFrame::SAFE);
}

#[tokio::test]
async fn a_simulator_that_is_slower_than_the_clock_is_reported_with_its_speed_and_what_was_lost() {
    let (mut rig, _) = speaking(&[]).await;
    // The time that a busy machine lost before the simulator started.
    let before = rig.session.view.borrow().lost_time.sum;
    for _ in 0..100 {
        // Ten milliseconds of flight take twenty-five.
        rig.at += Duration::from_millis(15);
        rig.state(10, 0.0, 0.0).await;
    }
    rig.hear("1 was requested").await;
    let lost = before + Duration::from_millis(1500);
    assert_eq!(rig.picture(|view| view.lost_time.sum >= lost).await.lost_time.sum, lost);
    // A pause does not count as time lost by the machine.
    rig.at += Duration::from_secs(30);
    rig.state(10, 0.0, 0.0).await;
    rig.flown_ms().await;
    assert_eq!(rig.session.view.borrow().lost_time.sum, lost);
}
