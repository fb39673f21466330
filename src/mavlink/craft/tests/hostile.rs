//! Input that means harm.

use proptest::prelude::*;

use super::*;

/// Returns the bytes that wait in queues.
fn waiting(craft: &CraftProtocol) -> usize {
    let mut craft = craft.clone();
    std::iter::from_fn(|| craft.poll_transmit()).map(|(_, bytes)| bytes.len()).sum()
}

#[test]
fn a_flood_of_commands_takes_bounded_memory_and_each_that_was_read_is_answered() {
    let mut rig = Rig::of(Identity::Generic);
    let message = CommandLong {
        command: 512,
        param1: 435.0,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    };
    let flood: Vec<u8> = (0..20_000).flat_map(|_| rig.bytes(message)).collect();
    rig.craft.receive(rig.now, FIRST, &flood);
    assert!(waiting(&rig.craft) < 64 * 1024, "{}", waiting(&rig.craft));
    let view = rig.craft.peers().next().unwrap();
    let answered =
        rig.answers(FIRST).iter().filter(|answer| matches!(answer, Message::CommandAck(_))).count();
    assert_eq!(answered as u64 + view.unread, 20_000);
    assert!(answered > 10);
}

#[test]
fn a_flood_of_requests_that_the_host_does_not_answer_is_rejected() {
    let mut rig = Rig::of(Identity::Generic);
    let mut rejected = 0;
    for number in 0..1000_u16 {
        let answers = rig.command(command::NAV_TAKEOFF, params([number.into()]));
        rejected += usize::from(
            !answers.is_empty()
                && acknowledged(&answers, command::NAV_TAKEOFF) == CommandResult::TemporarilyRejected,
        );
    }
    assert_eq!(rejected, 1000 - 64);
    assert_eq!(std::iter::from_fn(|| rig.craft.poll_request()).count(), 64);
}

#[test]
fn a_peer_that_does_not_read_loses_telemetry_and_disturbs_no_other() {
    let mut rig = Rig::of(Identity::Generic);
    rig.state.attitude = Some([0.0; 3]);
    rig.craft.connect(rig.now, FIRST, Lifetime::UntilDisconnected);
    rig.craft.connect(rig.now, SECOND, Lifetime::UntilDisconnected);
    for _ in 0..6000 {
        rig.now += Duration::from_millis(10);
        rig.craft.advance(rig.now, rig.now, &rig.state);
    }
    let full = waiting(&rig.craft);
    assert!(full < 2 * 256 * 64, "{full}");
    // There is still room for an answer.
    assert!(rig.command(512, params([148.0])).iter().any(|answer| matches!(answer, Message::CommandAck(_))));
}

#[test]
fn texts_without_end_take_bounded_memory() {
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(FIRST, Heartbeat::default());
    for _ in 0..100_000 {
        rig.craft.status_text(Severity::Info, "a text that is longer than the fifty bytes of one message");
    }
    assert!(waiting(&rig.craft) < 64 * 1024);
}

#[test]
fn states_without_numbers_do_not_stop_telemetry() {
    let nan = f64::NAN;
    let place = GeoPosition { lat_deg: nan, lon_deg: f64::INFINITY, alt_amsl: -1e300 };
    let state = CraftState {
        unix_time: Some(Duration::MAX),
        mode: Some(FlightMode::Acro),
        landed: Some(LandedState::InAir),
        load: Some(nan),
        attitude: Some([nan; 3]),
        rates: Some([f64::INFINITY; 3]),
        position: Some(place),
        altitude_above_home: Some(nan),
        local_ned: Some([nan; 3]),
        velocity_ned: Some([1e300; 3]),
        airspeed: Some(nan),
        throttle: Some(nan),
        home: Some(place),
        gps: Some(GpsState {
            fix: GpsFix::Fix3d,
            position: place,
            hdop: Some(nan),
            vdop: Some(-1.0),
            speed: Some(1e9),
            course: Some(nan),
            satellites: Some(255),
        }),
        battery: Some(BatteryState {
            voltage: nan,
            current: Some(nan),
            drawn_mah: Some(1e99),
            remaining: Some(-9.0),
        }),
        rc: Some(RcState { channels_us: [u16::MAX; 18], count: 255, rssi: Some(nan) }),
        outputs_us: Some([u16::MAX; 16]),
        navigation: Some(NavigationState {
            distance: nan,
            bearing: nan,
            cross_track: nan,
            altitude_error: nan,
        }),
        mission: MissionProgress { current: Some(u16::MAX), state: MissionState::Active },
        wind_ned: Some([nan; 3]),
        pressure_pa: Some(nan),
        temperature_c: Some(1e99),
        ..CraftState::default()
    };
    for identity in [Identity::Generic, Identity::Ardupilot, Identity::Px4] {
        let mut rig = Rig::of(identity);
        rig.state = state;
        rig.craft.connect(rig.now, FIRST, Lifetime::UntilDisconnected);
        let messages = rig.pass(FIRST, Duration::from_secs(2));
        assert!(messages.len() > 60, "{}", messages.len());
        rig.craft.advance(Duration::MAX, Duration::MAX, &state);
        rig.craft.advance(Duration::MAX, Duration::MAX, &state);
        rig.craft.advance(Duration::ZERO, Duration::ZERO, &state);
    }
}

/// An input of a craft.
#[derive(Debug, Clone)]
enum Step {
    Bytes(Vec<u8>),
    Frame { at: usize, payload: Vec<u8>, is_old: bool, is_for_us: bool, peer: u32 },
    Time(u64),
    Host(u8),
}

fn step() -> impl Strategy<Value = Step> {
    prop_oneof![
        1 => prop::collection::vec(any::<u8>(), 0..300).prop_map(Step::Bytes),
        8 => (0..table().len(), prop::collection::vec(any::<u8>(), 0..255), any::<bool>(), any::<bool>(), 0..20u32)
            .prop_map(|(at, payload, is_old, is_for_us, peer)| Step::Frame { at, payload, is_old, is_for_us, peer }),
        2 => (0..5_000_000_u64).prop_map(Step::Time),
        2 => any::<u8>().prop_map(Step::Host),
    ]
}

/// Returns a message to the craft with this content.
fn addressed(at: usize, payload: &[u8], is_for_us: bool) -> Message {
    let mut message = Message::decode(table()[at].id, payload).unwrap();
    if is_for_us {
        let known = [16, 20, 22, 176, 179, 193, 224, 246, 262, 300, 400, 410, 510, 511, 512, 519, 520];
        match &mut message {
            Message::CommandLong(long) => {
                (long.target_system, long.target_component) = (1, 1);
                long.command = known[usize::from(long.command) % known.len()];
                for number in [&mut long.param1, &mut long.param2, &mut long.param3] {
                    *number = f32::from(number.to_bits() as u8);
                }
            }
            Message::MissionCount(count) => {
                (count.target_system, count.target_component, count.mission_type) = (1, 1, 0);
                count.count %= 40;
            }
            Message::MissionItemInt(item) => {
                (item.target_system, item.target_component, item.mission_type, item.seq) =
                    (1, 1, 0, item.seq % 4);
            }
            Message::ParamRequestList(list) => (list.target_system, list.target_component) = (1, 1),
            Message::ParamSet(set) => {
                (set.target_system, set.target_component, set.param_id) = (1, 1, Text::new("A"));
            }
            _ => {}
        }
    }
    message
}

proptest! {
    #[test]
    fn no_input_stops_the_craft_or_fills_its_memory(
        steps in prop::collection::vec(step(), 0..150),
        identity in prop::sample::select(vec![Identity::Generic, Identity::Ardupilot, Identity::Px4]),
        is_read_only in any::<bool>(),
        max_fence in 0..4u16,
    ) {
        let mut rig = Rig::new(CraftOptions { identity, is_read_only, takes_rc: true, max_fence, ..CraftOptions::default() });
        rig.craft.set_parameters(&[Parameter { name: "A".into(), value: 1.0 }, Parameter { name: "B".repeat(40), value: f32::NAN }]);
        for step in steps {
            match step {
                Step::Bytes(bytes) => rig.craft.receive(rig.now, FIRST, &bytes),
                Step::Frame { at, payload, is_old, is_for_us, peer } => {
                    rig.version = if is_old { Version::V1 } else { Version::V2 };
                    let message = addressed(at, &payload, is_for_us);
                    let frame = Frame { version: rig.version, sequence: 0, system: 255, component: 190, message };
                    if let Some(bytes) = frame.encode() {
                        rig.craft.receive(rig.now, PeerId(peer), &bytes);
                    }
                }
                Step::Time(micros) => {
                    rig.now += Duration::from_micros(micros);
                    rig.craft.advance(rig.now, rig.now, &rig.state);
                }
                Step::Host(choice) => {
                    if let Some(request) = rig.craft.poll_request() {
                        prop_assert!(!is_read_only, "{request:?}");
                        let answer = match choice % 3 {
                            0 => Answer::Command(CommandResult::Accepted),
                            1 => Answer::Mission(MissionResult::Invalid),
                            _ => Answer::Parameter(f32::from(choice)),
                        };
                        if let RequestKind::Mission { items, .. } = request.kind {
                            prop_assert!(items.len() <= 30);
                            rig.craft.set_mission(items);
                        }
                        rig.craft.answer(request.ticket, answer, &["a line".repeat(usize::from(choice))]);
                    }
                    if choice % 7 == 0 {
                        rig.craft.disconnect(PeerId(u32::from(choice) % 20));
                    }
                }
            }
            prop_assert!(rig.craft.peers().count() <= 16);
        }
        prop_assert!(waiting(&rig.craft) < 16 * 1024 * 280);
        while rig.craft.poll_transmit().is_some() {}
    }
}
