//! Telemetry, texts and peers.

use super::*;

fn count<T>(messages: &[Message], of: impl Fn(&Message) -> Option<T>) -> usize {
    messages.iter().filter_map(of).count()
}

fn heartbeats(messages: &[Message]) -> Vec<Heartbeat> {
    let heartbeat =
        |message: &Message| if let Message::Heartbeat(heartbeat) = message { Some(*heartbeat) } else { None };
    messages.iter().filter_map(heartbeat).collect()
}

#[test]
fn a_peer_gets_telemetry_before_it_has_sent_anything() {
    let mut rig = Rig::of(Identity::Generic);
    assert!(rig.craft.connect(rig.now, FIRST, Lifetime::UntilDisconnected));
    let messages = rig.pass(FIRST, Duration::from_secs(60));
    assert_eq!(heartbeats(&messages).len(), 60);
    assert_eq!(count(&messages, |message| matches!(message, Message::HomePosition(_)).then_some(())), 60);
    // Values that are unknown are not sent.
    assert_eq!(count(&messages, |message| matches!(message, Message::Attitude(_)).then_some(())), 0);
}

#[test]
fn the_heartbeat_names_identity_mode_and_state() {
    let heartbeat = |identity, state: CraftState| {
        let mut rig = Rig::of(identity);
        rig.craft.connect(rig.now, FIRST, Lifetime::UntilDisconnected);
        rig.state = state;
        heartbeats(&rig.pass(FIRST, Duration::from_millis(10)))[0]
    };
    let state = |mode, is_armed, is_failsafe| CraftState {
        mode: Some(mode),
        is_armed,
        is_failsafe,
        ..Default::default()
    };
    let found = heartbeat(Identity::Generic, state(FlightMode::Acro, false, false));
    assert_eq!(
        (found.autopilot, found.r#type, found.base_mode, found.custom_mode, found.system_status),
        (0, 2, 65, 0, 3)
    );
    let found = heartbeat(Identity::Ardupilot, state(FlightMode::Autopilot, true, false));
    assert_eq!(
        (found.autopilot, found.base_mode, found.custom_mode, found.system_status),
        (3, 128 + 64 + 16 + 8 + 4 + 1, 3, 4)
    );
    let found = heartbeat(Identity::Px4, state(FlightMode::Landing, true, true));
    assert_eq!((found.autopilot, found.custom_mode, found.system_status), (12, 0x604_0000, 5));
}

#[test]
fn a_change_of_mode_is_sent_at_once() {
    let mut rig = Rig::of(Identity::Generic);
    rig.craft.connect(rig.now, FIRST, Lifetime::UntilDisconnected);
    rig.pass(FIRST, Duration::from_millis(510));
    rig.state.mode = Some(FlightMode::PosHold);
    rig.state.mission = MissionProgress { current: Some(3), state: MissionState::Active };
    let messages = rig.pass(FIRST, Duration::from_millis(10));
    assert_eq!(heartbeats(&messages)[0].custom_mode, 4);
    assert_eq!(
        count(&messages, |message| matches!(message, Message::MissionCurrent(current) if current.seq == 3)
            .then_some(())),
        1
    );
}

#[test]
fn a_paused_mission_of_px4_is_in_the_mode_hold() {
    let mut rig = Rig::of(Identity::Px4);
    rig.craft.connect(rig.now, FIRST, Lifetime::UntilDisconnected);
    rig.state.mode = Some(FlightMode::PosHold);
    rig.state.mission.state = MissionState::Paused;
    assert_eq!(heartbeats(&rig.pass(FIRST, Duration::from_millis(10)))[0].custom_mode, 0x304_0000);
}

#[test]
fn streams_follow_requests_for_their_peer_only() {
    let mut rig = Rig::of(Identity::Generic);
    rig.state.attitude = Some([0.0; 3]);
    rig.craft.connect(rig.now, SECOND, Lifetime::UntilDisconnected);
    rig.tell(
        FIRST,
        RequestDataStream {
            req_message_rate: 4,
            target_system: 1,
            target_component: 1,
            req_stream_id: 0,
            start_stop: 1,
        },
    );
    let mut other =
        Rig { craft: rig.craft.clone(), state: rig.state, now: rig.now, ..Rig::of(Identity::Generic) };
    let attitudes = |messages: &[Message]| {
        count(messages, |message| matches!(message, Message::Attitude(_)).then_some(()))
    };
    assert_eq!(attitudes(&rig.pass(FIRST, Duration::from_secs(5))), 20);
    assert_eq!(attitudes(&other.pass(SECOND, Duration::from_secs(5))), 50);
}

#[test]
fn a_silent_peer_is_forgotten_after_ten_seconds_and_a_connection_is_not() {
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(FIRST, Heartbeat::default());
    rig.craft.connect(rig.now, SECOND, Lifetime::UntilDisconnected);
    rig.pass(FIRST, Duration::from_millis(9_900));
    assert_eq!(rig.craft.peers().count(), 2);
    rig.pass(FIRST, Duration::from_millis(200));
    assert_eq!(rig.craft.peers().map(|peer| peer.id).collect::<Vec<_>>(), [SECOND]);
    rig.craft.disconnect(SECOND);
    assert_eq!(rig.craft.peers().count(), 0);
}

#[test]
fn at_most_sixteen_peers_are_known() {
    let mut rig = Rig::of(Identity::Generic);
    for peer in 0..100 {
        rig.tell(PeerId(peer), Heartbeat::default());
    }
    assert_eq!(rig.craft.peers().count(), 16);
    assert_eq!(rig.craft.refused_peers(), 84);
}

#[test]
fn a_peer_of_version_1_gets_version_1() {
    let mut rig = Rig::of(Identity::Generic);
    rig.version = Version::V1;
    let answers = rig.command(command::REQUEST_MESSAGE, params([300.0]));
    // Version 1 has no target.
    let expected = CommandAck { command: 512, result: 3, ..CommandAck::default() };
    assert_eq!(answers, [expected.into()]);
    assert_eq!(rig.craft.peers().next().unwrap().version, Version::V1);
    rig.craft.status_text(Severity::Info, &"x".repeat(100));
    let texts = texts(&rig.answers(FIRST));
    assert_eq!(texts, ["x".repeat(50), "x".repeat(50)]);
    rig.version = Version::V2;
    rig.tell(FIRST, Heartbeat::default());
    assert_eq!(rig.craft.peers().next().unwrap().version, Version::V2);
}

#[test]
fn long_texts_are_sent_in_chunks() {
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(FIRST, Heartbeat::default());
    let chunks = |rig: &mut Rig, length: usize| {
        rig.craft.status_text(Severity::Warning, &"x".repeat(length));
        let chunk = |message: &Message| {
            if let Message::Statustext(text) = message {
                Some((text.id, text.chunk_seq, text.text.as_bytes().len()))
            } else {
                None
            }
        };
        rig.answers(FIRST).iter().filter_map(chunk).collect::<Vec<_>>()
    };
    assert_eq!(chunks(&mut rig, 50), [(0, 0, 50)]);
    assert_eq!(chunks(&mut rig, 51), [(1, 0, 50), (1, 1, 1)]);
    assert_eq!(chunks(&mut rig, 100), [(2, 0, 50), (2, 1, 50), (2, 2, 0)]);
    assert_eq!(chunks(&mut rig, 9999).len(), 6);
}

#[test]
fn a_reached_item_is_reported_in_the_numbers_of_the_peer() {
    for (identity, expected) in [(Identity::Generic, 2), (Identity::Ardupilot, 3)] {
        let mut rig = Rig::of(identity);
        rig.tell(FIRST, Heartbeat::default());
        rig.craft.item_reached(2);
        assert_eq!(rig.answers(FIRST), [MissionItemReached { seq: expected }.into()]);
    }
}

#[test]
fn own_frames_that_come_back_are_ignored() {
    let mut rig = Rig::of(Identity::Generic);
    let message =
        CommandLong { command: 400, target_system: 1, target_component: 1, ..Default::default() }.into();
    let echo = Frame { version: Version::V2, sequence: 0, system: 1, component: 1, message };
    rig.craft.receive(rig.now, FIRST, &echo.encode().unwrap());
    assert_eq!(rig.answers(FIRST), []);
}
