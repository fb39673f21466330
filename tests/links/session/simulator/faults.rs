//! Faults of the link to the simulator and of the receiver: their beginning, their end and their losses.

use std::time::Instant;

use betadeck::events::SessionEvent;
use betadeck::link::Request;
use betadeck::link::endpoint::SimulatorStats;
use betadeck::telemetry::{EventKind, FirmwareEvent, LinkState};

use super::rig::{Rig, speaking, stats};

#[tokio::test]
async fn a_stall_lasts_its_time_although_the_firmwares_clock_stops() {
    let (mut rig, begun) = speaking(&[]).await;
    rig.world("fault=stall,0.3").await.unwrap();
    for _ in 0..29 {
        rig.state(10, 0.0, 0.0).await;
    }
    assert_eq!(rig.flown_ms().await, begun, "nothing comes through");
    rig.state(10, 0.0, 0.0).await;
    assert_eq!(rig.flown_ms().await, begun + 300, "the stamps tell how long it was");
    assert_eq!((rig.hear_fault("stall", true).await, rig.hear_fault("stall", false).await), (begun, begun));

    // Longer than half a second: the first packet only sets the time base, so nothing jumps.
    rig.faults.clear();
    rig.world("fault=stall,2").await.unwrap();
    for _ in 0..200 {
        rig.state(10, 3.0, 0.0).await;
    }
    assert_eq!(rig.flown_ms().await, begun + 300);
    assert_eq!(rig.hear_fault("stall", false).await, begun + 300);
    rig.state(10, 3.0, 0.0).await;
    assert_eq!(rig.flown_ms().await, begun + 310);
}

#[tokio::test]
async fn without_a_word_from_the_simulator_a_stall_ends_by_the_clock() {
    let (mut rig, _) = speaking(&[]).await;
    rig.at = Instant::now();
    rig.state(10, 0.0, 0.0).await;
    // The state must arrive before the stall begins.
    rig.flown_ms().await;
    rig.world("fault=stall,0.3").await.unwrap();
    rig.hear_fault("stall", true).await;
    rig.hear_fault("stall", false).await;
    rig.world("fault=stall").await.unwrap();
    rig.hear("The simulator is silent: time is stopped").await;
    rig.faults.clear();
    rig.world("end=stall").await.unwrap();
    rig.state(10, 0.0, 0.0).await;
    rig.hear_fault("stall", false).await;
}

/// Sends forty packets with a loss of one half. Returns for each packet `true` if it came through.
async fn losses(faults: &[&str]) -> Vec<bool> {
    let (mut rig, mut now) = speaking(faults).await;
    rig.world("fault=fdm-loss,,0.5").await.unwrap();
    let mut through = Vec::new();
    let begun = now;
    for sent in 1..=40 {
        rig.state(10, 0.0, 0.0).await;
        let flown = rig.flown_ms().await;
        assert!(flown == now || flown == begun + 10 * sent, "what was lost is made up for: {flown}");
        through.push(flown > now);
        now = flown;
    }
    through
}

#[tokio::test]
async fn the_same_packets_are_lost_in_every_session() {
    let first = losses(&[]).await;
    let count = first.iter().filter(|through| **through).count();
    assert!((8..=32).contains(&count), "{first:?}");
    // A fault that never begins draws no random numbers.
    assert_eq!(losses(&["fdm-jitter@0"]).await, first);
}

#[tokio::test]
async fn late_packets_come_later_and_those_overtaken_are_old() {
    let (mut rig, begun) = speaking(&[]).await;
    rig.world("fault=fdm-late,,50").await.unwrap();
    for _ in 0..5 {
        rig.state(10, 0.0, 0.0).await;
    }
    assert_eq!(rig.flown_ms().await, begun);
    for sent in 6..=9 {
        rig.state(10, 0.0, 0.0).await;
        assert_eq!(rig.flown_ms().await, begun + (sent - 5) * 10);
    }
    rig.world("end=fdm-late").await.unwrap();
    rig.state(10, 0.0, 0.0).await;
    assert_eq!(rig.flown_ms().await, begun + 100, "the tenth comes at once");
    for _ in 0..10 {
        rig.state(10, 0.0, 0.0).await;
    }
    assert_eq!(rig.flown_ms().await, begun + 200);
    let view = rig.picture(|view| stats(view).old > 0).await;
    let flying = SimulatorStats { link: LinkState::Flowing, dialect: Some("sitl-gz"), refused: 0, old: 4 };
    assert_eq!(stats(&view), flying);
}

#[tokio::test]
async fn doubled_packets_are_no_time_of_their_own() {
    let (mut rig, begun) = speaking(&[]).await;
    rig.world("fault=fdm-dup,,1").await.unwrap();
    rig.motors.set_nonblocking(true).unwrap();
    let count = |rig: &Rig| std::iter::from_fn(|| rig.motors.recv(&mut [0; 64]).ok()).count();
    count(&rig);
    rig.state(10, 0.0, 0.0).await;
    assert_eq!(rig.flown_ms().await, begun + 10);
    assert_eq!(count(&rig), 2, "only the first is answered with a servo and a raw packet");
    for _ in 0..50 {
        rig.state(10, 0.0, 0.0).await;
    }
    assert_eq!(rig.flown_ms().await, begun + 510);
}

#[tokio::test]
async fn faults_begin_at_the_firmwares_time_and_end_after_theirs() {
    let (mut rig, begun) = speaking(&["fdm-jitter@boot+100,5,8", "gps-loss@boot+100,5"]).await;
    assert!(begun < 100_000 && rig.faults.is_empty());
    while rig.flown_ms().await < 104_000 {
        for _ in 0..100 {
            rig.state(10, 0.0, 0.0).await;
        }
    }
    let view = rig.session.view.borrow().clone();
    assert!(!view.vehicle.craft.has_fix(), "no solution for more than 2.5 s");
    let active: Vec<_> = view.vehicle.world.faults.iter().map(|fault| <&str>::from(fault.kind)).collect();
    assert_eq!(active, ["fdm-jitter", "gps-loss"]);
    for _ in 0..200 {
        rig.state(10, 0.0, 0.0).await;
    }
    assert_eq!(rig.hear_fault("fdm-jitter", true).await, 100_000);
    assert_eq!(rig.hear_fault("gps-loss", true).await, 100_000);
    assert_eq!(rig.hear_fault("gps-loss", false).await, 105_000);
    let ended = rig.hear_fault("fdm-jitter", false).await;
    assert!((104_900..=105_000).contains(&ended), "{ended}");
    rig.picture(|view| view.vehicle.craft.has_fix() && view.vehicle.world.faults.is_empty()).await;
}

#[tokio::test]
async fn a_lost_receiver_hears_no_script() {
    let (mut rig, _) = speaking(&[]).await;
    for on in [false, true] {
        if on {
            rig.world("fault=rx-loss").await.unwrap();
        }
        let mut lost = false;
        for _ in 0..100 {
            let frame = betadeck::signals::RcFrame::SAFE;
            rig.requests.send(Request::Rc { stamp_s: 0.0, frame, at: rig.at }).await.unwrap();
            rig.state(10, 0.0, 0.0).await;
        }
        rig.flown_ms().await;
        while let Ok(event) = rig.session.events.try_recv() {
            lost |= matches!(event.kind, SessionEvent::Vehicle(EventKind::Firmware(FirmwareEvent::RxLoss)));
        }
        assert_eq!(lost, on);
    }
}

#[tokio::test]
async fn faults_of_the_craft_are_the_simulators() {
    let (rig, _) = speaking(&[]).await;
    let refused = rig.world("fault=motor,,2:0.8").await.unwrap_err();
    assert!(
        refused.contains("fault motor is up to the simulator") && refused.contains("fdm-loss"),
        "{refused}"
    );
    let refused = rig.world("fault=motor@boot+900,,2:0.8").await.unwrap_err();
    assert!(refused.contains("fault motor is up to the simulator"), "{refused}");
    for line in ["reset", "noise=none", "wind_profile=flat"] {
        let refused = rig.world(line).await.unwrap_err();
        assert!(refused.contains("places the craft: change that there"), "{line}: {refused}");
    }
    rig.world("end=all").await.unwrap();
}
