//! The link: who is followed, what is asked, orders and transfers.

use super::*;

/// A station and a craft of this crate, joined by a link.
struct Joined {
    station: StationProtocol,
    craft: CraftProtocol,
    state: CraftState,
    now: Duration,
    /// `true` if the link loses a sixth of the frames, but no heartbeat.
    is_bad: bool,
    random: u32,
}

impl Joined {
    fn new(identity: Identity) -> Self {
        let options = CraftOptions { identity, version: [4, 5, 6], ..CraftOptions::default() };
        let mut craft = CraftProtocol::new(options);
        craft.connect(Duration::ZERO, PeerId(0), Lifetime::UntilDisconnected);
        let home = GeoPosition { lat_deg: 40.4635, lon_deg: -79.5182, alt_amsl: 300.0 };
        let state = CraftState {
            mode: Some(FlightMode::Angle),
            home: Some(home),
            position: Some(home),
            attitude: Some([0.1, 0.2, 0.3]),
            ..CraftState::default()
        };
        let station = StationProtocol::new(StationOptions::default());
        Self { station, craft, state, now: Duration::ZERO, is_bad: false, random: 1 }
    }

    fn is_lost(&mut self, bytes: &[u8]) -> bool {
        self.random = self.random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.is_bad && bytes[7..10] != [0; 3] && self.random >> 16 < 0x2aaa
    }

    /// Lets time pass. The host accepts everything and flies as ordered.
    fn pass(&mut self, time: Duration) -> Vec<Event> {
        let end = self.now + time;
        let mut events = Vec::new();
        while self.now < end {
            self.now += Duration::from_millis(20);
            self.station.advance(self.now);
            while let Some(bytes) = self.station.poll_transmit() {
                if !self.is_lost(&bytes) {
                    self.craft.receive(self.now, PeerId(0), &bytes);
                }
            }
            while let Some(request) = self.craft.poll_request() {
                let answer = match request.kind {
                    RequestKind::Mission { items, .. } => {
                        self.craft.set_mission(items);
                        Answer::Mission(MissionResult::Accepted)
                    }
                    RequestKind::SetMode(mode) => {
                        self.state.mode = Some(mode);
                        Answer::Command(CommandResult::Accepted)
                    }
                    RequestKind::StartMission => {
                        self.state.mode = Some(FlightMode::Autopilot);
                        Answer::Command(CommandResult::Accepted)
                    }
                    RequestKind::Arm => panic!("a station arms nothing"),
                    RequestKind::Land => Answer::Command(CommandResult::TemporarilyRejected),
                    _ => Answer::Command(CommandResult::Accepted),
                };
                self.craft.answer(request.ticket, answer, &[]);
            }
            self.craft.advance(self.now, self.now, &self.state);
            while let Some((_, bytes)) = self.craft.poll_transmit() {
                if !self.is_lost(&bytes) {
                    self.station.receive(self.now, &bytes);
                }
            }
            events.extend(std::iter::from_fn(|| self.station.poll_event()));
        }
        events
    }
}

fn plan(length: usize) -> Vec<MissionItem> {
    let item = |at: usize| MissionItem {
        frame: 3,
        command: 16,
        params: [0.0, 5.0, 0.0, 0.0],
        x: 404_640_000 + at as i32,
        y: -795_175_000,
        z: at as f32,
        is_current: false,
        autocontinue: true,
    };
    (0..length).map(item).collect()
}

const IDENTITIES: [Identity; 3] = [Identity::Generic, Identity::Ardupilot, Identity::Px4];

#[test]
fn a_station_finds_a_craft_and_learns_all_about_it() {
    for identity in IDENTITIES {
        let mut joined = Joined::new(identity);
        let events = joined.pass(Duration::from_secs(3));
        assert_eq!(events[0], Event::Connected { system: 1, component: 1 });
        let name = match identity {
            Identity::Generic => "Angle",
            Identity::Ardupilot => "Stabilize",
            Identity::Px4 => "Stabilized",
        };
        let report = joined.station.report();
        assert_eq!(report.presence.as_ref().unwrap().value.mode, name);
        assert_eq!(report.firmware.unwrap().value.version, [4, 5, 6]);
        assert!((report.attitude.unwrap().value[1] - 0.2).abs() < 1e-6);
        assert!((report.position.unwrap().value.lat_deg - 40.4635).abs() < 1e-7);
        assert_eq!(report.home.unwrap().value.alt_amsl, 300.0);
        assert!(joined.station.mode_names().len() >= 7);
        assert!(joined.now - report.attitude.unwrap().at < Duration::from_millis(200));
    }
}

#[test]
fn missions_go_up_and_down_equal_for_every_identity_also_over_a_bad_link() {
    for identity in IDENTITIES {
        for is_bad in [false, true] {
            let mut joined = Joined::new(identity);
            joined.pass(Duration::from_secs(5));
            joined.is_bad = is_bad;
            assert_eq!(joined.station.upload(MissionKind::Mission, plan(12)), Ok(()));
            assert_eq!(joined.station.download(MissionKind::Mission), Err(NotBegun::Busy));
            let events = joined.pass(Duration::from_secs(60));
            assert!(
                events.contains(&Event::Transfer(TransferEnd::Sent(MissionKind::Mission))),
                "{identity:?} {events:?}"
            );
            assert_eq!(joined.station.download(MissionKind::Mission), Ok(()));
            let events = joined.pass(Duration::from_secs(60));
            let received = events.iter().find_map(|event| match event {
                Event::Transfer(TransferEnd::Received { items, home, .. }) => {
                    Some((items.clone(), home.is_some()))
                }
                _ => None,
            });
            assert_eq!(received, Some((plan(12), identity == Identity::Ardupilot)), "{identity:?} {is_bad}");
        }
    }
}

#[test]
fn orders_are_carried_out_and_their_outcome_is_reported() {
    for identity in IDENTITIES {
        let mut joined = Joined::new(identity);
        joined.pass(Duration::from_secs(3));
        let start = joined.station.order(&Order::StartMission).unwrap();
        let land = joined.station.order(&Order::Land).unwrap();
        let home = joined.station.order(&Order::ReturnHome).unwrap();
        let events = joined.pass(Duration::from_secs(2));
        let answered = |result| OrderEnd::Answered(result);
        assert!(events.contains(&Event::Order(start, answered(CommandResult::Accepted))), "{events:?}");
        assert!(events.contains(&Event::Order(land, answered(CommandResult::TemporarilyRejected))));
        assert!(events.contains(&Event::Order(home, answered(CommandResult::Accepted))));
        assert_eq!(joined.state.mode, Some(FlightMode::Autopilot));
        assert!(events.iter().any(|event| matches!(event, Event::Mode(_))));
        for name in joined.station.mode_names() {
            assert!(joined.station.order(&Order::SetMode(name)).is_ok());
        }
        assert_eq!(joined.station.order(&Order::SetMode("hover".into())), Err(NotBegun::NoSuchMode));
    }
}

#[test]
fn nothing_is_begun_without_a_craft() {
    let mut station = StationProtocol::new(StationOptions::default());
    assert_eq!(station.order(&Order::Land), Err(NotBegun::NoCraft));
    assert_eq!(station.download(MissionKind::Mission), Err(NotBegun::NoCraft));
    assert_eq!(station.upload(MissionKind::Fence, Vec::new()), Err(NotBegun::NoCraft));
    assert!(station.mode_names().is_empty());
}

#[test]
fn a_station_sends_heartbeats_of_a_ground_station() {
    let mut played = Played::new();
    let sent = played.pass(Duration::from_secs(10), None);
    assert_eq!(sent.len(), 10);
    assert!(sent.iter().all(|message| matches!(message, Message::Heartbeat(heartbeat) if heartbeat.r#type == 6 && heartbeat.autopilot == 8)));
}

#[test]
fn the_first_autopilot_is_followed_and_others_are_counted() {
    let mut played = Played::new();
    played.hear_from(9, Heartbeat { r#type: 6, autopilot: 8, ..Default::default() });
    played.hear_from(8, Heartbeat { r#type: 26, autopilot: 8, ..Default::default() });
    played.hear_from(255, arducopter());
    assert_eq!(played.events(), []);
    played.hear(arducopter());
    played.hear_from(2, arducopter());
    played.hear_from(2, Statustext { text: Text::new("from another"), ..Default::default() });
    assert_eq!(played.events().len(), 2);
    assert_eq!(played.station.others().iter().collect::<Vec<_>>(), [&(2, 1)]);
}

#[test]
fn telemetry_is_asked_for_as_the_autopilot_understands_it() {
    let groups = |messages: &[Message]| {
        messages.iter().filter(|message| matches!(message, Message::RequestDataStream(_))).count()
    };
    let mut played = Played::connected(arducopter());
    assert_eq!(groups(&played.pass(Duration::from_millis(100), None)), 7);
    let mut played = Played::connected(heartbeat(12, 2, 81, 0x3_0000));
    let mut intervals = Vec::new();
    for _ in 0..40 {
        let sent = played.pass(Duration::from_millis(100), Some(heartbeat(12, 2, 81, 0x3_0000)));
        assert_eq!(groups(&sent), 0);
        for long in commands(&sent) {
            intervals.extend((long.command == 511).then_some(long.param1));
            played.hear(CommandAck { command: long.command, result: 0, ..Default::default() });
        }
    }
    assert_eq!(intervals.len(), 14);
}

#[test]
fn a_craft_that_answers_no_question_is_asked_four_times() {
    let inav = heartbeat(0, 2, 81, 3);
    let mut played = Played::connected(inav);
    let asked = commands(&played.pass(Duration::from_secs(60), Some(inav)));
    assert_eq!(asked.len(), 4);
    assert_eq!(asked.iter().map(|long| long.confirmation).collect::<Vec<_>>(), [0, 1, 2, 3]);
    assert_eq!(played.station.report().presence.as_ref().unwrap().value.mode, "AUTO");
}

#[test]
fn a_lost_link_is_noticed_after_three_seconds_and_ends_everything() {
    let mut played = Played::connected(arducopter());
    let order = played.station.order(&Order::ReturnHome).unwrap();
    played.station.download(MissionKind::Mission).unwrap();
    played.pass(Duration::from_millis(2900), None);
    assert!(played.station.is_connected());
    assert_eq!(played.events(), []);
    played.pass(Duration::from_millis(200), None);
    assert!(!played.station.is_connected());
    let silence = TransferEnd::Silence(MissionKind::Mission);
    assert_eq!(
        played.events(),
        [Event::LinkLost, Event::Order(order, OrderEnd::Lost), Event::Transfer(silence)]
    );
    assert_eq!(played.station.order(&Order::Land), Err(NotBegun::NoCraft));
    played.hear(arducopter());
    assert_eq!(played.events(), [Event::LinkRestored]);
    // Everything is asked for again.
    assert!(played.pass(Duration::from_millis(100), None).len() > 7);
}

#[test]
fn an_order_without_an_answer_is_repeated_and_given_up() {
    let mut played = Played::connected(arducopter());
    played.pass(Duration::from_secs(10), Some(arducopter()));
    let order = played.station.order(&Order::Pause).unwrap();
    let sent = commands(&played.pass(Duration::from_secs(10), Some(arducopter())));
    assert_eq!(
        sent.iter().map(|long| (long.command, long.param1, long.confirmation)).collect::<Vec<_>>(),
        [(193, 0.0, 0), (193, 0.0, 1), (193, 0.0, 2), (193, 0.0, 3)]
    );
    assert_eq!(played.events(), [Event::Order(order, OrderEnd::Silence)]);
    // A command that takes long is not repeated.
    let order = played.station.order(&Order::ReturnHome).unwrap();
    played.pass(Duration::from_millis(100), Some(arducopter()));
    played.hear(CommandAck { command: 20, result: 5, ..Default::default() });
    assert_eq!(commands(&played.pass(Duration::from_secs(10), Some(arducopter()))), []);
    played.hear(CommandAck { command: 20, result: 0, ..Default::default() });
    assert_eq!(played.events(), [Event::Order(order, OrderEnd::Answered(CommandResult::Accepted))]);
}

#[test]
fn px4_is_ordered_by_its_modes() {
    let px4 = heartbeat(12, 2, 81, 0x3_0000);
    let mut played = Played::connected(px4);
    played.pass(Duration::from_secs(10), Some(px4));
    let mut ordered = |order| {
        played.station.order(&order).unwrap();
        let sent = commands(&played.pass(Duration::from_millis(200), Some(px4)));
        played.hear(CommandAck { command: sent[0].command, ..Default::default() });
        (sent[0].command, sent[0].param1, sent[0].param2, sent[0].param3)
    };
    assert_eq!(ordered(Order::StartMission), (176, 1.0, 4.0, 4.0));
    assert_eq!(ordered(Order::Pause), (176, 1.0, 4.0, 3.0));
    assert_eq!(ordered(Order::SetMode("position".into())), (176, 1.0, 3.0, 0.0));
    assert_eq!(ordered(Order::SetCurrent(3)), (224, 3.0, 0.0, 0.0));
}

#[test]
fn inav_is_read_by_the_old_requests_and_has_no_home_item() {
    // It claims to be ArduPilot, and answers no questions.
    let mut played = Played::connected(arducopter());
    played.pass(Duration::from_secs(10), Some(arducopter()));
    played.station.download(MissionKind::Mission).unwrap();
    let mut items = 0;
    let mut received = None;
    for _ in 0..200 {
        for message in played.pass(Duration::from_millis(100), Some(arducopter())) {
            match message {
                Message::MissionRequestList(_) => {
                    played.hear(MissionCount { count: 3, ..Default::default() });
                }
                Message::MissionRequest(request) => {
                    items += 1;
                    played.hear(MissionItemFloat {
                        seq: request.seq,
                        frame: 3,
                        command: 16,
                        x: 40.5,
                        y: -79.5,
                        ..Default::default()
                    });
                }
                _ => {}
            }
        }
        for event in played.events() {
            if let Event::Transfer(TransferEnd::Received { items, home, .. }) = event {
                received = Some((items.len(), home, items[0].x));
            }
        }
    }
    assert_eq!((items, received), (3, Some((3, None, 405_000_000))));
    // It takes the old items only.
    played.station.upload(MissionKind::Mission, plan(2)).unwrap();
    let sent = played.pass(Duration::from_millis(200), Some(arducopter()));
    assert!(
        sent.iter().any(|message| matches!(message, Message::MissionCount(count) if count.count == 2)),
        "{sent:?}"
    );
    played.hear(MissionRequest { seq: 0, ..Default::default() });
    assert!(matches!(played.sent()[..], [Message::MissionItemFloat(item)] if item.seq == 0));
    assert_eq!(played.station.transfer_progress(), Some((0, Some(2))));
    played.hear(MissionAck { r#type: 3, ..Default::default() });
    assert_eq!(
        played.events(),
        [Event::Transfer(TransferEnd::Refused(MissionKind::Mission, MissionResult::Unsupported))]
    );
}

#[test]
fn a_mission_without_end_is_refused_and_a_silent_craft_given_up() {
    let mut played = Played::connected(arducopter());
    played.station.download(MissionKind::Mission).unwrap();
    played.pass(Duration::from_millis(100), Some(arducopter()));
    played.hear(MissionCount { count: u16::MAX, ..Default::default() });
    assert_eq!(played.events(), [Event::Transfer(TransferEnd::TooLong(MissionKind::Mission, u16::MAX))]);
    played.station.download(MissionKind::Fence).unwrap();
    played.pass(Duration::from_secs(10), Some(arducopter()));
    assert_eq!(played.events(), [Event::Transfer(TransferEnd::Silence(MissionKind::Fence))]);
    played.station.download(MissionKind::Mission).unwrap();
    played.pass(Duration::from_millis(100), Some(arducopter()));
    played.station.cancel_transfer();
    assert!(matches!(played.sent()[..], [Message::MissionAck(ack)] if ack.r#type == 15));
    assert_eq!(played.station.transfer_progress(), None);
}
