//! Answers to commands, questions and parameters.

use super::*;

#[test]
fn commands_become_requests_and_their_outcome_is_acknowledged() {
    let mut rig = Rig::of(Identity::Generic);
    let takes = |rig: &mut Rig, command, first: &[f32], expected: RequestKind| {
        let params = std::array::from_fn(|at| first.get(at).copied().unwrap_or_default());
        assert_eq!(rig.request(command, params), expected);
    };
    takes(&mut rig, command::COMPONENT_ARM_DISARM, &[1.0], RequestKind::Arm);
    takes(&mut rig, command::COMPONENT_ARM_DISARM, &[0.0], RequestKind::Disarm);
    takes(&mut rig, command::NAV_LAND, &[f32::NAN; 7], RequestKind::Land);
    takes(&mut rig, command::NAV_RETURN_TO_LAUNCH, &[], RequestKind::ReturnHome);
    takes(&mut rig, command::MISSION_START, &[], RequestKind::StartMission);
    takes(&mut rig, command::DO_PAUSE_CONTINUE, &[0.0], RequestKind::Pause);
    takes(&mut rig, command::DO_PAUSE_CONTINUE, &[1.0], RequestKind::Continue);
    takes(&mut rig, command::DO_SET_HOME, &[1.0], RequestKind::SetHome(None));
    takes(&mut rig, command::PREFLIGHT_REBOOT_SHUTDOWN, &[1.0], RequestKind::Reboot);
    takes(&mut rig, command::DO_SET_STANDARD_MODE, &[6.0], RequestKind::SetMode(FlightMode::Autopilot));
    takes(&mut rig, command::DO_SET_STANDARD_MODE, &[8.0], RequestKind::TakeOff { altitude: None });
    let up = |altitude| RequestKind::TakeOff { altitude };
    takes(&mut rig, command::NAV_TAKEOFF, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 12.5], up(Some(12.5)));
    takes(&mut rig, command::NAV_TAKEOFF, &[f32::NAN; 7], up(None));
    let home = GeoPosition { lat_deg: 40.5, lon_deg: -79.5, alt_amsl: 300.0 };
    takes(
        &mut rig,
        command::DO_SET_HOME,
        &[0.0, 0.0, 0.0, 0.0, 40.5, -79.5, 300.0],
        RequestKind::SetHome(Some(home)),
    );
}

#[test]
fn a_refusal_has_its_reasons_as_texts_for_its_sender_only() {
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(SECOND, Heartbeat::default());
    assert_eq!(rig.command(command::COMPONENT_ARM_DISARM, params([1.0])), []);
    let ticket = rig.craft.poll_request().unwrap().ticket;
    let lines = ["no satellite fix".to_owned(), "throttle is not low".to_owned()];
    rig.craft.answer(ticket, Answer::Command(CommandResult::TemporarilyRejected), &lines);
    let mut copy = Rig { craft: rig.craft.clone(), ..Rig::of(Identity::Generic) };
    let answers = rig.answers(FIRST);
    assert!(matches!(answers[0], Message::CommandAck(_)));
    assert_eq!(acknowledged(&answers, 400), CommandResult::TemporarilyRejected);
    assert_eq!(texts(&answers), lines);
    assert_eq!(copy.answers(SECOND), []);
}

#[test]
fn what_is_wrong_is_denied_and_what_is_unknown_unsupported() {
    let mut rig = Rig::of(Identity::Generic);
    let denied = [
        // Arming without checks.
        (command::COMPONENT_ARM_DISARM, params([1.0, 21196.0])),
        (command::COMPONENT_ARM_DISARM, [f32::NAN; 7]),
        (command::DO_PAUSE_CONTINUE, [f32::NAN; 7]),
        (command::DO_SET_MODE, params([0.0, 4.0])),
        (command::DO_SET_MODE, params([1.0, 99.0])),
        (command::DO_SET_MODE, [f32::NAN; 7]),
        // No command selects a failsafe.
        (command::DO_SET_MODE, params([1.0, 7.0])),
        (command::DO_SET_STANDARD_MODE, params([2.0])),
        (command::DO_SET_MISSION_CURRENT, params([0.0])),
        (command::DO_SET_HOME, [f32::NAN; 7]),
        (command::PREFLIGHT_REBOOT_SHUTDOWN, params([2.0])),
        (command::SET_MESSAGE_INTERVAL, [f32::NAN; 7]),
        (command::SET_MESSAGE_INTERVAL, params([30.0, f32::NAN])),
        (command::REQUEST_MESSAGE, [f32::INFINITY; 7]),
    ];
    for (command, params) in denied {
        assert_eq!(rig.result(command, params), CommandResult::Denied, "{command} {params:?}");
    }
    // Reposition, orbit, component information and metadata, the storage of files.
    for command in [192, 34, 245, 0, u16::MAX] {
        assert_eq!(rig.result(command, params([1.0])), CommandResult::Unsupported);
    }
    for id in [395.0, 396.0, 397.0, 77.0, 9999.0] {
        assert_eq!(rig.result(command::REQUEST_MESSAGE, params([id])), CommandResult::Unsupported);
        assert_eq!(rig.result(command::SET_MESSAGE_INTERVAL, params([id, 1e6])), CommandResult::Unsupported);
    }
}

#[test]
fn a_restart_waits_until_the_craft_is_disarmed() {
    let mut rig = Rig::of(Identity::Generic);
    rig.state.is_armed = true;
    rig.pass(FIRST, Duration::from_millis(10));
    let result = rig.result(command::PREFLIGHT_REBOOT_SHUTDOWN, params([1.0]));
    assert_eq!(result, CommandResult::TemporarilyRejected);
}

#[test]
fn modes_are_set_in_every_style() {
    let mode = |identity, numbers: [f32; 3]| Rig::of(identity).request(command::DO_SET_MODE, params(numbers));
    let set = RequestKind::SetMode;
    assert_eq!(mode(Identity::Generic, [1.0, 4.0, 0.0]), set(FlightMode::PosHold));
    assert_eq!(mode(Identity::Generic, [209.0, 5.0, f32::NAN]), set(FlightMode::Autopilot));
    assert_eq!(mode(Identity::Ardupilot, [1.0, 2.0, 0.0]), set(FlightMode::AltHold));
    assert_eq!(mode(Identity::Ardupilot, [1.0, 6.0, 0.0]), RequestKind::ReturnHome);
    assert_eq!(mode(Identity::Ardupilot, [1.0, 9.0, 0.0]), RequestKind::Land);
    assert_eq!(mode(Identity::Px4, [1.0, 3.0, 0.0]), set(FlightMode::PosHold));
    assert_eq!(mode(Identity::Px4, [1.0, 4.0, 2.0]), RequestKind::TakeOff { altitude: None });
    // The style of PX4, which MAVSDK uses for every identity.
    for identity in [Identity::Generic, Identity::Ardupilot, Identity::Px4] {
        assert_eq!(mode(identity, [129.0, 4.0, 4.0]), set(FlightMode::Autopilot));
        assert_eq!(mode(identity, [129.0, 4.0, 3.0]), set(FlightMode::PosHold));
        assert_eq!(mode(identity, [129.0, 4.0, 5.0]), RequestKind::ReturnHome);
    }
}

#[test]
fn the_old_message_sets_modes_too() {
    let mut rig = Rig::of(Identity::Px4);
    let set = SetMode { custom_mode: 0x404_0000, target_system: 1, base_mode: 157 };
    assert_eq!(rig.tell(FIRST, set), []);
    assert_eq!(rig.craft.poll_request().unwrap().kind, RequestKind::SetMode(FlightMode::Autopilot));
    let another = SetMode { custom_mode: 0x3_0000, ..set };
    assert_eq!(rig.tell(FIRST, another), []);
    assert_eq!(rig.craft.poll_request().unwrap().kind, RequestKind::SetMode(FlightMode::PosHold));
    let other = SetMode { target_system: 2, ..set };
    assert_eq!(rig.tell(FIRST, other), []);
    assert_eq!(rig.craft.poll_request(), None);
    let without_flag = SetMode { base_mode: 156, ..set };
    assert_eq!(acknowledged(&rig.tell(FIRST, without_flag), command::DO_SET_MODE), CommandResult::Denied);
}

#[test]
fn commands_with_a_position_are_taken() {
    let mut rig = Rig::of(Identity::Generic);
    rig.pass(FIRST, Duration::from_millis(10));
    let (target_system, target_component) = (1, 0);
    let int = |command, frame, x, y, z| CommandInt {
        command,
        frame,
        x,
        y,
        z,
        target_system,
        target_component,
        ..Default::default()
    };
    rig.tell(FIRST, int(command::DO_SET_HOME, 0, 404_635_001, -795_182_001, 301.5));
    let home = GeoPosition { lat_deg: 40.4635001, lon_deg: -79.5182001, alt_amsl: 301.5 };
    assert_eq!(rig.craft.poll_request().unwrap().kind, RequestKind::SetHome(Some(home)));
    // Home is 300 m above sea level.
    rig.tell(FIRST, int(command::NAV_TAKEOFF, 0, 0, 0, 320.0));
    assert_eq!(rig.craft.poll_request().unwrap().kind, RequestKind::TakeOff { altitude: Some(20.0) });
    rig.tell(FIRST, int(command::NAV_TAKEOFF, 3, 0, 0, 20.0));
    assert_eq!(rig.craft.poll_request().unwrap().kind, RequestKind::TakeOff { altitude: Some(20.0) });
}

#[test]
fn a_repeated_command_is_carried_out_once() {
    let mut rig = Rig::of(Identity::Generic);
    for _ in 0..3 {
        assert_eq!(rig.command(command::NAV_TAKEOFF, params([])), []);
    }
    let request = rig.craft.poll_request().unwrap();
    assert_eq!(rig.craft.poll_request(), None);
    rig.craft.answer(request.ticket, Answer::Command(CommandResult::Accepted), &[]);
    rig.craft.answer(request.ticket, Answer::Command(CommandResult::Failed), &[]);
    assert_eq!(acknowledged(&rig.answers(FIRST), command::NAV_TAKEOFF), CommandResult::Accepted);
}

#[test]
fn commands_to_others_are_not_answered() {
    let mut rig = Rig::of(Identity::Generic);
    for (target_system, target_component) in [(2, 1), (1, 154)] {
        let command = CommandLong { command: 400, target_system, target_component, ..Default::default() };
        assert_eq!(rig.tell(FIRST, command), []);
    }
    assert_eq!(rig.craft.poll_request(), None);
}

#[test]
fn the_acknowledgement_comes_before_the_message() {
    let mut rig = Rig::of(Identity::Generic);
    rig.pass(FIRST, Duration::from_millis(10));
    for (command, id) in
        [(512, 148), (512, 242), (512, 245), (512, 49), (512, 300), (520, 148), (410, 242), (519, 300)]
    {
        let answers = rig.command(command, params([id as f32]));
        assert_eq!(acknowledged(&answers, command), CommandResult::Accepted);
        assert_eq!(answers.iter().map(|answer| answer.info().id).collect::<Vec<_>>(), [77, id], "{command}");
    }
}

#[test]
fn a_message_whose_content_is_not_known_is_not_sent_now() {
    let mut rig = Rig::of(Identity::Generic);
    let result = rig.result(command::REQUEST_MESSAGE, params([24.0]));
    assert_eq!(result, CommandResult::TemporarilyRejected);
}

#[test]
fn the_version_names_what_the_craft_can() {
    let mut rig = Rig::new(CraftOptions {
        max_fence: 10,
        version: [2026, 6, 1].map(|x| x as u8),
        ..Default::default()
    });
    let answers = rig.command(512, params([148.0]));
    let Message::AutopilotVersion(version) = answers[1] else { panic!("{answers:?}") };
    assert_eq!(version.capabilities, 8192 + 4 + 8 + 16384 + 2 + 131_072);
    assert_eq!(version.flight_sw_version.to_be_bytes(), [234, 6, 1, 255]);
}

#[test]
fn modes_are_listed_all_or_one() {
    let mut rig = Rig::of(Identity::Generic);
    let modes = |answers: Vec<Message>| {
        let name = |answer: &Message| {
            if let Message::AvailableModes(mode) = answer {
                Some((mode.mode_index, mode.custom_mode, mode.mode_name.to_string()))
            } else {
                None
            }
        };
        answers.iter().filter_map(name).collect::<Vec<_>>()
    };
    let all = modes(rig.command(512, params([435.0, 0.0])));
    assert_eq!(all.len(), 8);
    assert_eq!(all[4], (5, 4, "Pos Hold".to_owned()));
    assert_eq!(modes(rig.command(512, params([435.0, 5.0]))), all[4..5]);
    assert_eq!(rig.result(512, params([435.0, 9.0])), CommandResult::Denied);
}

#[test]
fn intervals_are_set_and_read() {
    let mut rig = Rig::of(Identity::Generic);
    let read = |rig: &mut Rig, id: f32| {
        let answers = rig.command(command::GET_MESSAGE_INTERVAL, params([id]));
        let Message::MessageInterval(interval) = answers[1] else { panic!("{answers:?}") };
        assert_eq!(f32::from(interval.message_id), id);
        interval.interval_us
    };
    assert_eq!(read(&mut rig, 30.0), 100_000);
    assert_eq!(rig.result(command::SET_MESSAGE_INTERVAL, params([30.0, 50_000.0])), CommandResult::Accepted);
    assert_eq!(read(&mut rig, 30.0), 50_000);
    assert_eq!(rig.result(command::SET_MESSAGE_INTERVAL, params([30.0, -1.0])), CommandResult::Accepted);
    assert_eq!(read(&mut rig, 30.0), -1);
    assert_eq!(rig.result(command::SET_MESSAGE_INTERVAL, params([30.0, 3e7 + 2.0])), CommandResult::Accepted);
    assert_eq!(read(&mut rig, 30.0), 30_000_002);
    assert_eq!(
        rig.result(command::SET_MESSAGE_INTERVAL, params([30.0, f32::INFINITY])),
        CommandResult::Accepted
    );
    assert_eq!(rig.result(command::SET_MESSAGE_INTERVAL, params([30.0, 0.0])), CommandResult::Accepted);
    assert_eq!(read(&mut rig, 30.0), 100_000);
    assert_eq!(read(&mut rig, 999.0), 0);
}

#[test]
fn clocks_are_compared() {
    let mut rig = Rig::of(Identity::Generic);
    rig.pass(FIRST, Duration::from_millis(10));
    let answers = rig.tell(FIRST, Timesync { tc1: 0, ts1: 1234, ..Default::default() });
    let [Message::Timesync(sync)] = answers[..] else { panic!("{answers:?}") };
    assert_eq!((sync.tc1, sync.ts1), (rig.now.as_nanos() as i64, 1234));
    assert_eq!(rig.tell(FIRST, Timesync { tc1: 5, ts1: 1234, ..Default::default() }), []);
    let ping = Ping { time_usec: 9, seq: 3, target_system: 0, target_component: 0 };
    assert_eq!(rig.tell(FIRST, ping), [Ping { target_system: 255, target_component: 190, ..ping }.into()]);
    assert_eq!(rig.tell(FIRST, Ping { target_system: 3, ..ping }), []);
}

#[test]
fn a_file_is_refused_at_once() {
    let mut rig = Rig::of(Identity::Generic);
    let mut payload = [0; 251];
    payload[..4].copy_from_slice(&[0xff, 0x01, 5, 4]);
    let ask = FileTransferProtocol { target_network: 0, target_system: 1, target_component: 1, payload };
    let answers = rig.tell(FIRST, ask);
    let [Message::FileTransferProtocol(nak)] = answers[..] else { panic!("{answers:?}") };
    assert_eq!((nak.target_system, nak.target_component), (255, 190));
    assert_eq!(nak.payload[..6], [0, 2, 5, 129, 1, 4]);
    assert_eq!(nak.payload[12], 10);
}

fn with_parameters(count: usize) -> Rig {
    let mut rig = Rig::of(Identity::Generic);
    let parameter = |at| Parameter { name: format!("AP_PARAMETER_{at:03}"), value: at as f32 };
    rig.craft.set_parameters(&(0..count).map(parameter).collect::<Vec<_>>());
    rig
}

fn parameters(messages: &[Message]) -> Vec<ParamValue> {
    let value =
        |message: &Message| if let Message::ParamValue(value) = message { Some(*value) } else { None };
    messages.iter().filter_map(value).collect()
}

#[test]
fn a_list_of_parameters_is_complete_and_does_not_come_at_once() {
    let mut rig = with_parameters(100);
    let list = ParamRequestList { target_system: 1, target_component: 1 };
    assert_eq!(rig.tell(FIRST, list), []);
    let early = parameters(&rig.pass(FIRST, Duration::from_millis(100)));
    assert!((10..=25).contains(&early.len()), "{}", early.len());
    let late = parameters(&rig.pass(FIRST, Duration::from_millis(450)));
    let all: Vec<u16> = early.iter().chain(&late).map(|value| value.param_index).collect();
    assert_eq!(all, (0..100).collect::<Vec<u16>>());
    assert!(late.iter().all(|value| value.param_count == 100 && value.param_type == 9));
    assert_eq!(late.last().unwrap().param_id.to_string(), "AP_PARAMETER_099");
    assert_eq!(parameters(&rig.pass(FIRST, Duration::from_secs(1))), []);
}

#[test]
fn a_craft_without_parameters_says_so() {
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(FIRST, ParamRequestList { target_system: 1, target_component: 1 });
    let values = parameters(&rig.pass(FIRST, Duration::from_secs(1)));
    assert_eq!(values.len(), 1);
    assert_eq!(values[0].param_count, 0);
}

#[test]
fn a_parameter_is_read_by_name_and_by_index() {
    let mut rig = with_parameters(10);
    let read = |param_index, name| ParamRequestRead {
        param_index,
        target_system: 1,
        target_component: 1,
        param_id: Text::new(name),
    };
    let by_index = rig.tell(FIRST, read(3, ""));
    assert_eq!(parameters(&by_index)[0].param_value, 3.0);
    assert_eq!(rig.tell(FIRST, read(-1, "AP_PARAMETER_003")), by_index);
    assert_eq!(rig.tell(FIRST, read(-1, "UNKNOWN")), []);
    assert_eq!(rig.tell(FIRST, read(10, "")), []);
    assert_eq!(rig.tell(FIRST, read(i16::MIN, "")), []);
}

#[test]
fn a_parameter_is_set_and_all_peers_learn_it() {
    let mut rig = with_parameters(10);
    rig.tell(SECOND, Heartbeat::default());
    let set = |value| ParamSet {
        param_value: value,
        target_system: 1,
        target_component: 1,
        param_id: Text::new("AP_PARAMETER_003"),
        param_type: 9,
    };
    assert_eq!(rig.tell(FIRST, set(5.0)), []);
    let request = rig.craft.poll_request().unwrap();
    assert_eq!(request.kind, RequestKind::SetParameter { name: "AP_PARAMETER_003".into(), value: 5.0 });
    rig.craft.answer(request.ticket, Answer::Parameter(5.0), &[]);
    assert_eq!(parameters(&rig.answers(SECOND))[0].param_value, 5.0);
    // A refusal has the old value, for the sender only.
    rig.tell(FIRST, set(5000.0));
    let request = rig.craft.poll_request().unwrap();
    rig.craft.answer(request.ticket, Answer::Parameter(5.0), &["at most 100".to_owned()]);
    let answers = rig.answers(FIRST);
    assert_eq!(parameters(&answers)[0].param_value, 5.0);
    assert_eq!(texts(&answers), ["at most 100"]);
    assert_eq!(parameters(&rig.tell(FIRST, set(f32::NAN)))[0].param_value, 5.0);
    assert_eq!(rig.craft.poll_request(), None);
}

#[test]
fn a_value_that_changes_otherwise_is_reported() {
    let mut rig = with_parameters(3);
    rig.tell(FIRST, Heartbeat::default());
    let parameter = |at, value| Parameter { name: format!("AP_PARAMETER_{at:03}"), value };
    rig.craft.set_parameters(&[parameter(0, 0.0), parameter(1, 7.0), parameter(2, 2.0)]);
    let values = parameters(&rig.answers(FIRST));
    assert_eq!(values.len(), 1);
    assert_eq!((values[0].param_index, values[0].param_value), (1, 7.0));
}

#[test]
fn sticks_are_taken_only_if_they_are_switched_on() {
    let channels = RcChannelsOverride { target_system: 1, target_component: 1, ..Default::default() };
    let sticks = ManualControl { target: 1, ..Default::default() };
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(FIRST, channels);
    rig.tell(FIRST, sticks);
    assert_eq!(rig.craft.poll_rc(), None);
    let mut rig = Rig::new(CraftOptions { takes_rc: true, ..CraftOptions::default() });
    rig.tell(FIRST, channels);
    rig.tell(SECOND, sticks);
    assert!(matches!(rig.craft.poll_rc(), Some((SECOND, RcInput::Manual { .. }))));
    assert_eq!(rig.craft.poll_rc(), None);
}

#[test]
fn a_craft_that_may_only_be_read_denies_changes_and_answers_questions() {
    let mut rig = Rig::new(CraftOptions { is_read_only: true, takes_rc: true, ..CraftOptions::default() });
    rig.craft.set_parameters(&[Parameter { name: "A".into(), value: 1.0 }]);
    rig.craft.set_mission(vec![MissionItem::default()]);
    rig.pass(FIRST, Duration::from_millis(10));
    for command in [400, 22, 21, 20, 300, 193, 179, 246, 224] {
        assert_eq!(rig.result(command, params([1.0])), CommandResult::Denied, "{command}");
    }
    assert_eq!(rig.result(command::DO_SET_MODE, params([1.0, 4.0])), CommandResult::Denied);
    let to = |kind| (1, 1, kind);
    let (target_system, target_component, mission_type) = to(0);
    let ends = [
        rig.tell(
            FIRST,
            MissionCount { count: 3, target_system, target_component, mission_type, opaque_id: 0 },
        ),
        rig.tell(FIRST, MissionClearAll { target_system, target_component, mission_type: 255 }),
        rig.tell(FIRST, MissionSetCurrent { seq: 0, target_system, target_component }),
    ];
    for end in ends {
        let [Message::MissionAck(end)] = end[..] else { panic!("{end:?}") };
        assert_eq!(end.r#type, MissionResult::Denied.code());
    }
    let set = ParamSet {
        param_value: 9.0,
        target_system,
        target_component,
        param_id: Text::new("A"),
        param_type: 9,
    };
    assert_eq!(parameters(&rig.tell(FIRST, set))[0].param_value, 1.0);
    rig.tell(FIRST, RcChannelsOverride { target_system, target_component, ..Default::default() });
    assert_eq!((rig.craft.poll_rc(), rig.craft.poll_request()), (None, None));
    let answers = rig.tell(FIRST, MissionRequestList { target_system, target_component, mission_type });
    assert!(matches!(answers[..], [Message::MissionCount(MissionCount { count: 1, .. })]));
    assert_eq!(rig.result(command::SET_MESSAGE_INTERVAL, params([30.0, 1e6])), CommandResult::Accepted);
    assert_eq!(rig.command(512, params([148.0])).len(), 2);
}
