//! Keys in, screen out, with a session: rewind, and flying on from an earlier instant.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

use betadeck::session::Command;
use betadeck::session::ReplyTo;
use betadeck::session::command::Seek;
use betadeck::signals::SimTime;
use betadeck::sim::WorldCommand;
use betadeck::telemetry::NavState;
use betadeck::timeline::MarkKind;
use betadeck::ui::{AppState, Msg, update};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};

use crate::ui::session_rig::Rig;

fn rewound(state: &AppState) -> bool {
    state.shared.is_rewound()
}

#[tokio::test]
async fn every_instant_shown_again_is_as_it_was_and_the_end_is_where_it_was() {
    let mut rig = Rig::new().await;
    rig.keys("F").await;
    let mut seen = Vec::new();
    // The steps lead from an arrival on to the next leg.
    for state in [NavState::Approaching, NavState::Arrived, NavState::Arrived] {
        rig.fly_to(state).await;
        seen.push(rig.picture());
        for _ in 0..3 {
            let before = rig.time();
            rig.keys(".").await;
            rig.until("a step", |state| state.shared.view.vehicle.time > before).await;
            seen.push(rig.picture());
        }
    }
    let head = rig.picture();
    for picture in seen.iter().rev().skip(1).chain(&seen[..seen.len() - 1]) {
        rig.show(picture.time).await;
        assert_eq!(rig.picture(), *picture);
    }
    rig.assert_shown(&["REWOUND −", "b fly on", "e end", "Rewound by"]);
    rig.keys("e").await;
    rig.until("the end", |state| !rewound(state)).await;
    assert_eq!(rig.picture(), head);
    assert!(rig.state.shared.view.paused, "as before");
    assert!(!rig.screen().contains("REWOUND"));
}

#[tokio::test]
async fn keys_go_back_and_forth_by_events_states_and_seconds() {
    let mut rig = Rig::new().await;
    rig.keys("F").await;
    rig.fly_to(NavState::Approaching).await;
    let engaged = rig.time();
    rig.fly_to(NavState::Arrived).await;
    let arrived = rig.time();

    rig.keys("{").await;
    rig.until("the state before", |state| state.shared.view.vehicle.time == engaged).await;
    rig.keys(">").await;
    rig.until("10 s later", |state| state.shared.view.vehicle.time.0 == engaged.0 + 10_000_000).await;
    rig.keys("<<").await;
    rig.until("10 s earlier", |state| state.shared.view.vehicle.time.0 == engaged.0 - 10_000_000).await;
    rig.keys("}").await;
    rig.until("the state after", |state| state.shared.view.vehicle.time == engaged).await;
    let before = |state: &AppState| {
        state.shared.view.vehicle.time < engaged && !state.shared.view.vehicle.is_engaged()
    };
    rig.keys(",").await;
    rig.until("the event before", before).await;
    rig.keys(";").await;
    rig.until("the event after", |state| state.shared.view.vehicle.time == engaged).await;
    // One tick, then to the end of the recording, where the flight is no longer rewound.
    let tick = KeyEvent::new(KeyCode::Char('.'), KeyModifiers::ALT);
    let effects = update(&mut rig.state, Msg::Key(tick));
    rig.carry_out(effects).await;
    rig.until("a tick", |state| state.shared.view.vehicle.time.0 == engaged.0 + 1000).await;
    assert!(rewound(&rig.state));
    rig.keys("}").await;
    rig.until("the end", |state| !rewound(state)).await;
    assert_eq!(rig.time(), arrived);
    // Far before the beginning.
    rig.session.commands.send(Command::Seek(Seek::Seconds(-1e6))).await.unwrap();
    rig.until("the beginning", |state| state.shared.view.vehicle.time == SimTime::ZERO).await;
    rig.keys(",").await;
    rig.until("a sentence", |state| {
        state.shared.notice.is_none()
            && state.shared.log.newest_first().any(|line| line.text.contains("Nothing happened"))
    })
    .await;
}

#[tokio::test]
async fn space_plays_the_recording_to_its_end_and_waits_there() {
    let mut rig = Rig::new().await;
    rig.session.commands.send(Command::Step(3000)).await.unwrap();
    rig.until("three seconds", |state| state.shared.view.vehicle.time.0 >= 3_000_000).await;
    let head = rig.picture();
    rig.keys("<").await;
    rig.until("the beginning", rewound).await;
    rig.session.commands.send(Command::Speed(f64::INFINITY)).await.unwrap();
    rig.keys(" ").await;
    rig.until("the end", |state| !rewound(state)).await;
    assert!(rig.state.shared.view.paused);
    assert_eq!(rig.picture(), head);
}

#[tokio::test]
async fn settings_of_an_earlier_instant_are_read() {
    let mut rig = Rig::new().await;
    rig.session.commands.send(Command::Step(1000)).await.unwrap();
    rig.until("a second", |state| state.shared.view.vehicle.time.0 >= 1_000_000).await;
    let read = rig.cli("get ap_max_angle").await.text;
    assert!(!rig.cli("set ap_max_angle = 33").await.text.contains("ERROR"));
    rig.session.commands.send(Command::Step(3000)).await.unwrap();
    rig.until("four seconds", |state| state.shared.view.vehicle.time.0 >= 4_000_000).await;
    assert!(rig.cli("get ap_max_angle").await.text.contains("= 33"));
    rig.show(SimTime(500_000)).await;
    let then = rig.cli("get ap_max_angle").await;
    assert_eq!(then.text, read);
    assert_eq!(then.advice.as_deref(), Some("As it was at the shown instant, 0.5 s."));
    for line in ["set ap_max_angle = 44", "save", "waypoint clear", "defaults"] {
        assert!(rig.cli(line).await.text.contains("REWOUND"), "{line}");
    }
}

#[tokio::test]
async fn nothing_steers_an_instant_that_is_past() {
    let mut rig = Rig::new().await;
    rig.session.commands.send(Command::Step(3000)).await.unwrap();
    rig.until("three seconds", |state| state.shared.view.vehicle.time.0 >= 3_000_000).await;
    rig.keys("<").await;
    rig.until("the rewind", rewound).await;
    rig.keys("a").await;
    let refused = rig.state.shared.notice.as_ref().map(|notice| notice.text.clone()).unwrap();
    assert!(refused.contains("`b`") && refused.contains("`e`"), "{refused}");
    // The session itself refuses, too.
    let (reply, answer) = ReplyTo::channel();
    let plan = Box::default();
    rig.session
        .commands
        .send(Command::Upload { name: String::new(), plan, settings: Vec::new(), reply })
        .await
        .unwrap();
    assert_eq!(answer.await.unwrap(), Err(refused.clone()));
    let (reply, answer) = ReplyTo::channel();
    let change = Box::new(WorldCommand::parse("wind=5@270").unwrap());
    rig.session.commands.send(Command::World { change, reply }).await.unwrap();
    assert_eq!(answer.await.unwrap(), Err(refused));
    let (reply, answer) = ReplyTo::channel();
    let line = "set ap_max_angle = 30".to_owned();
    rig.session.commands.send(Command::Cli { line, reply }).await.unwrap();
    assert!(answer.await.unwrap().advice.is_some_and(|advice| advice.contains("`b`")));
}

#[tokio::test]
async fn the_flight_goes_on_from_an_earlier_instant_and_the_old_one_is_dropped() {
    let mut rig = Rig::new().await;
    rig.keys("F").await;
    rig.fly_to(NavState::Approaching).await;
    rig.fly_to(NavState::Arrived).await;
    let left = rig.picture();
    rig.keys("<").await;
    rig.until("the rewind", rewound).await;
    let fork = rig.time();
    rig.keys("b").await;
    rig.until("the branch", |state| state.shared.view.timeline.as_ref().unwrap().branch == 1).await;
    assert!(!rig.state.shared.view.paused, "it flies");
    rig.keys(" ").await;
    rig.until("the pause", |state| state.shared.view.paused).await;
    rig.assert_shown(&["Flying on from here", "╎"]);
    let behind: Vec<bool> = rig.state.shared.log.newest_first().map(|line| line.left_behind).collect();
    assert!(behind.contains(&true) && behind.contains(&false));
    // Without any other action, it is the same flight again.
    rig.fly_to(NavState::Arrived).await;
    assert_eq!(rig.picture(), left);
    // With other sticks, it is another flight.
    rig.keys("<").await;
    rig.until("the rewind", rewound).await;
    assert_eq!(rig.time(), fork);
    rig.keys("b").await;
    rig.until("the branch", |state| state.shared.view.timeline.as_ref().unwrap().branch == 2).await;
    rig.keys(" ").await;
    rig.until("the pause", |state| state.shared.view.paused).await;
    rig.keys("g").await;
    rig.fly_to(NavState::Idle).await;
    assert!(rig.time() < left.time);
    rig.keys("b").await;
    rig.until("why not", |state| {
        state.shared.log.newest_first().any(|line| line.text.contains("go back to one"))
    })
    .await;
}

#[tokio::test]
async fn a_click_on_the_timeline_shows_that_instant() {
    let mut rig = Rig::new().await;
    rig.session.commands.send(Command::Step(8000)).await.unwrap();
    rig.until("eight seconds", |state| state.shared.view.vehicle.time.0 >= 8_000_000).await;
    let click = |column| MouseEvent {
        kind: MouseEventKind::Down(MouseButton::Left),
        column,
        row: 38,
        modifiers: KeyModifiers::NONE,
    };
    let effects = update(&mut rig.state, Msg::Mouse(click(60)));
    rig.carry_out(effects).await;
    rig.until("an instant", rewound).await;
    let shown = rig.time().as_secs_f64();
    assert!((3.5..4.7).contains(&shown), "{shown}");
    let effects = update(&mut rig.state, Msg::Mouse(click(110)));
    rig.carry_out(effects).await;
    rig.until("the end", |state| !rewound(state)).await;
}

#[tokio::test]
async fn the_wait_after_the_landing_is_one_column_for_the_mouse_and_the_keys() {
    let mut rig = Rig::new().await;
    rig.keys("F").await;
    rig.session.commands.send(Command::Step(330_000)).await.unwrap();
    rig.until("two minutes after the landing", |state| state.shared.view.vehicle.time.0 >= 330_000_000).await;
    let place = |rig: &Rig, glyph: char| {
        let screen = rig.screen();
        let row = screen.lines().nth(38).unwrap().trim_matches('"');
        row.chars().position(|shown| shown == glyph).unwrap_or_else(|| panic!("no {glyph} in {row}"))
    };
    let (landed, fold) = (place(&rig, 'C'), place(&rig, '≈'));
    assert!((landed + 1..landed + 10).contains(&fold), "{}", rig.screen());
    let marks = rig.state.shared.view.timeline.as_ref().unwrap().marks.clone();
    let disarmed = marks.iter().find(|mark| mark.kind == MarkKind::Disarmed).unwrap().time;

    let (column, row, modifiers) = (fold as u16, 38, KeyModifiers::NONE);
    let kind = MouseEventKind::Down(MouseButton::Left);
    let effects = update(&mut rig.state, Msg::Mouse(MouseEvent { kind, column, row, modifiers }));
    rig.carry_out(effects).await;
    rig.until("the beginning of the wait", rewound).await;
    let begins = rig.time();
    let since_s = begins.seconds_since(disarmed);
    assert!((9.0..12.0).contains(&since_s), "{since_s} s after the landing");
    assert_eq!(place(&rig, '┃'), fold);
    rig.keys(">").await;
    rig.until("10 s later", |state| state.shared.view.vehicle.time.0 == begins.0 + 10_000_000).await;
    assert_eq!(place(&rig, '┃'), fold);
    rig.keys("{").await;
    rig.until("the landing", |state| state.shared.view.vehicle.time < begins).await;
    assert_eq!(place(&rig, '┃'), landed);
}
