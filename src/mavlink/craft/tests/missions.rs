//! Uploads, downloads and deletions of missions and fences.

use super::*;

fn item(frame: u8, command: u16, z: f32) -> MissionItem {
    MissionItem {
        frame,
        command,
        z,
        x: 404_640_000,
        y: -795_175_000,
        params: [0.0, 5.0, 0.0, 0.0],
        is_current: false,
        autocontinue: true,
    }
}

fn plan(length: usize) -> Vec<MissionItem> {
    (0..length).map(|at| item(3, 16, at as f32)).collect()
}

const TO: (u8, u8) = (1, 1);

fn to(seq: u16, kind: u8) -> super::super::super::mission::Address {
    super::super::super::mission::Address { system: TO.0, component: TO.1, kind, seq }
}

fn count(count: u16, mission_type: u8) -> MissionCount {
    MissionCount { count, target_system: TO.0, target_component: TO.1, mission_type, opaque_id: 0 }
}

fn clear(mission_type: u8) -> MissionClearAll {
    MissionClearAll { target_system: TO.0, target_component: TO.1, mission_type }
}

/// Returns the result of the only acknowledgement of a transfer among messages.
fn end(messages: &[Message]) -> Option<MissionResult> {
    let mut ends = messages.iter().filter_map(|message| {
        if let Message::MissionAck(end) = message { MissionResult::from_code(end.r#type) } else { None }
    });
    let end = ends.next();
    assert_eq!(ends.next(), None, "{messages:?}");
    end
}

/// Returns the item that the craft asks for, and whether by the new request.
fn asked(messages: &[Message]) -> Option<(u16, bool)> {
    messages.iter().find_map(|message| match message {
        Message::MissionRequestInt(request) => Some((request.seq, true)),
        Message::MissionRequest(request) => Some((request.seq, false)),
        _ => None,
    })
}

impl Rig {
    /// Uploads items until the craft asks for no more. Returns its last messages.
    fn upload(&mut self, peer: PeerId, items: &[MissionItem], kind: u8) -> Vec<Message> {
        let mut answers = self.tell(peer, count(items.len() as u16, kind));
        while let Some((seq, _)) = asked(&answers) {
            answers = self.tell(peer, items[usize::from(seq)].to_int(to(seq, kind)));
        }
        answers
    }

    /// Downloads the items of a kind.
    fn download(&mut self, peer: PeerId, mission_type: u8) -> Vec<MissionItem> {
        let (target_system, target_component) = TO;
        let answers = self.tell(peer, MissionRequestList { target_system, target_component, mission_type });
        let [Message::MissionCount(count)] = answers[..] else { panic!("{answers:?}") };
        let one = |seq| {
            let answers =
                self.tell(peer, MissionRequestInt { seq, target_system, target_component, mission_type });
            let [Message::MissionItemInt(item)] = answers[..] else { panic!("{answers:?}") };
            assert_eq!((item.seq, item.mission_type, item.target_system), (seq, mission_type, 255));
            MissionItem::from_int(&item)
        };
        (0..count.count).map(one).collect()
    }

    /// Accepts the mission that waits, as a host does, and returns its request.
    fn accept(&mut self) -> RequestKind {
        let request = self.craft.poll_request().unwrap();
        match request.kind.clone() {
            RequestKind::Mission { items, .. } => self.craft.set_mission(items),
            RequestKind::Fence(items) => self.craft.set_fence(items),
            other => panic!("{other:?}"),
        }
        self.craft.answer(
            request.ticket,
            Answer::Mission(MissionResult::Accepted),
            &["nothing is lost".to_owned()],
        );
        request.kind
    }
}

#[test]
fn a_mission_goes_up_and_comes_down_equal() {
    let mut rig = Rig::of(Identity::Generic);
    let items = plan(30);
    assert_eq!(rig.upload(FIRST, &items, 0), []);
    assert_eq!(rig.accept(), RequestKind::Mission { items: items.clone(), home: None });
    let answers = rig.answers(FIRST);
    assert_eq!(
        (end(&answers), texts(&answers)),
        (Some(MissionResult::Accepted), vec!["nothing is lost".to_owned()])
    );
    assert_eq!(rig.download(FIRST, 0), items);
    assert_eq!(rig.download(SECOND, 0), items);
}

#[test]
fn the_refusal_of_a_mission_is_passed_on() {
    let mut rig = Rig::of(Identity::Generic);
    rig.upload(FIRST, &plan(2), 0);
    let ticket = rig.craft.poll_request().unwrap().ticket;
    rig.craft.answer(
        ticket,
        Answer::Mission(MissionResult::Unsupported),
        &["item 1: 178 is not known".to_owned()],
    );
    let answers = rig.answers(FIRST);
    assert_eq!(end(&answers), Some(MissionResult::Unsupported));
    assert_eq!(texts(&answers).len(), 1);
    // The last item again, because the end was lost.
    assert_eq!(end(&rig.tell(FIRST, plan(2)[1].to_int(to(1, 0)))), Some(MissionResult::Unsupported));
}

#[test]
fn a_mission_that_is_too_long_is_refused_before_its_items() {
    let mut rig = Rig::of(Identity::Generic);
    assert_eq!(end(&rig.tell(FIRST, count(u16::MAX, 0))), Some(MissionResult::NoSpace));
    assert_eq!(end(&rig.tell(FIRST, count(32, 0))), Some(MissionResult::NoSpace));
    // 31 may be 30 and home.
    assert_eq!(end(&rig.upload(FIRST, &plan(31), 0)), Some(MissionResult::NoSpace));
    let with_home: Vec<MissionItem> = [item(0, 16, 300.0)].into_iter().chain(plan(30)).collect();
    assert_eq!(end(&rig.upload(FIRST, &with_home, 0)), None);
    assert!(matches!(rig.accept(), RequestKind::Mission { items, .. } if items.len() == 30));
}

#[test]
fn a_home_item_is_recognised_and_comes_back() {
    let home = item(0, 16, 300.0);
    let items: Vec<MissionItem> = [home].into_iter().chain(plan(3)).collect();
    let mut rig = Rig::of(Identity::Generic);
    rig.craft.set_mission(plan(3));
    rig.pass(FIRST, Duration::from_millis(10));
    let answers = rig.upload(FIRST, &items, 0);
    assert_eq!(texts(&answers), ["mission item 0 is home and is not flown"]);
    assert_eq!(rig.accept(), RequestKind::Mission { items: plan(3), home: Some(home) });
    rig.answers(FIRST);
    let down = rig.download(FIRST, 0);
    assert_eq!((down.len(), down[0].frame, down[0].x, down[0].z), (4, 0, 404_635_000, 300.0));
    assert_eq!(down[1..], plan(3));
    // Another peer has no home item.
    assert_eq!(rig.download(SECOND, 0), plan(3));
    // Its next mission has none, so it gets none back.
    rig.upload(FIRST, &plan(3), 0);
    rig.accept();
    rig.answers(FIRST);
    assert_eq!(rig.download(FIRST, 0), plan(3));
}

#[test]
fn an_absolute_mission_has_no_home_item_unless_its_sender_is_of_the_family_of_ardupilot() {
    let items: Vec<MissionItem> = (0..3).map(|at| item(0, 16, at as f32)).collect();
    let mut rig = Rig::of(Identity::Generic);
    rig.upload(FIRST, &items, 0);
    assert_eq!(rig.accept(), RequestKind::Mission { items: items.clone(), home: None });
    rig.tell(SECOND, Heartbeat { r#type: 6, autopilot: 3, ..Default::default() });
    rig.upload(SECOND, &items, 0);
    assert_eq!(rig.accept(), RequestKind::Mission { items: items[1..].to_vec(), home: Some(items[0]) });
    // A single waypoint is a mission.
    rig.upload(FIRST, &items[..1], 0);
    assert_eq!(rig.accept(), RequestKind::Mission { items: items[..1].to_vec(), home: None });
}

#[test]
fn ardupilot_has_a_home_item_in_every_mission_and_number() {
    let mut rig = Rig::of(Identity::Ardupilot);
    assert_eq!(rig.download(FIRST, 0), []);
    rig.upload(FIRST, &plan(4), 0);
    assert_eq!(rig.accept(), RequestKind::Mission { items: plan(4)[1..].to_vec(), home: Some(plan(4)[0]) });
    rig.answers(FIRST);
    assert_eq!(rig.download(FIRST, 0)[1..], plan(4)[1..]);
    assert_eq!(rig.request(command::DO_SET_MISSION_CURRENT, params([3.0])), RequestKind::SetCurrent(2));
    assert_eq!(rig.request(command::DO_SET_MISSION_CURRENT, params([0.0])), RequestKind::SetCurrent(0));
    assert_eq!(rig.result(command::DO_SET_MISSION_CURRENT, params([4.0])), CommandResult::Denied);
    rig.state.mission = MissionProgress { current: Some(2), state: MissionState::Active };
    let messages = rig.pass(FIRST, Duration::from_millis(10));
    let current = messages.iter().find_map(|message| {
        if let Message::MissionCurrent(current) = message { Some(*current) } else { None }
    });
    assert_eq!(current.map(|current| (current.seq, current.total, current.mission_state)), Some((3, 3, 3)));
}

#[test]
fn a_missing_item_is_asked_for_five_times_and_then_the_upload_is_cancelled() {
    let mut rig = Rig::of(Identity::Generic);
    assert_eq!(asked(&rig.tell(FIRST, count(2, 0))), Some((0, true)));
    for retry in 0..5 {
        rig.tell(FIRST, Heartbeat::default());
        assert_eq!(asked(&rig.pass(FIRST, Duration::from_millis(1400))), None);
        // An old ground station knows only the old request.
        assert_eq!(asked(&rig.pass(FIRST, Duration::from_millis(100))), Some((0, retry == 0)));
    }
    rig.tell(FIRST, Heartbeat::default());
    assert_eq!(end(&rig.pass(FIRST, Duration::from_millis(1500))), Some(MissionResult::Cancelled));
    assert_eq!(asked(&rig.pass(FIRST, Duration::from_secs(5))), None);
}

#[test]
fn an_old_ground_station_can_upload_and_download() {
    let mut rig = Rig::of(Identity::Generic);
    rig.version = Version::V1;
    let mut answers = rig.tell(FIRST, count(3, 0));
    while let Some((seq, is_new)) = asked(&answers) {
        assert!(!is_new);
        answers = rig.tell(FIRST, plan(3)[usize::from(seq)].to_float(to(seq, 0)));
    }
    rig.accept();
    rig.answers(FIRST);
    let (target_system, target_component, mission_type) = (1, 1, 0);
    let answers = rig.tell(FIRST, MissionRequest { seq: 1, target_system, target_component, mission_type });
    let [Message::MissionItemFloat(item)] = answers[..] else { panic!("{answers:?}") };
    assert!((item.x - 40.464).abs() < 1e-5 && item.z == 1.0);
}

#[test]
fn a_ground_station_that_refuses_the_old_request_is_asked_by_the_new_one() {
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(FIRST, count(2, 0));
    rig.pass(FIRST, Duration::from_secs(3));
    let refusal = MissionAck {
        target_system: 1,
        target_component: 1,
        r#type: MissionResult::Unsupported.code(),
        mission_type: 0,
        opaque_id: 0,
    };
    assert_eq!(asked(&rig.tell(FIRST, refusal)), Some((0, true)));
    rig.tell(FIRST, plan(2)[0].to_int(to(0, 0)));
    rig.tell(FIRST, Heartbeat::default());
    assert_eq!(asked(&rig.pass(FIRST, Duration::from_secs(5))), Some((1, true)));
}

#[test]
fn items_twice_out_of_order_or_from_others_change_nothing() {
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(FIRST, count(3, 0));
    assert_eq!(rig.tell(FIRST, plan(3)[2].to_int(to(2, 0))), []);
    assert_eq!(rig.tell(SECOND, plan(3)[0].to_int(to(0, 0))), []);
    assert_eq!(rig.tell(FIRST, plan(3)[0].to_int(to(0, 1))), []);
    assert_eq!(asked(&rig.tell(FIRST, plan(3)[0].to_int(to(0, 0)))), Some((1, true)));
    assert_eq!(rig.tell(FIRST, plan(3)[0].to_int(to(0, 0))), []);
    assert_eq!(asked(&rig.tell(FIRST, plan(3)[1].to_int(to(1, 0)))), Some((2, true)));
}

#[test]
fn a_second_upload_waits_for_the_first() {
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(FIRST, count(2, 0));
    assert_eq!(rig.tell(SECOND, count(2, 0)), []);
    assert_eq!(asked(&rig.tell(FIRST, plan(2)[0].to_int(to(0, 0)))), Some((1, true)));
    // The first sender may begin again.
    assert_eq!(asked(&rig.tell(FIRST, count(3, 0))), Some((0, true)));
    rig.craft.disconnect(FIRST);
    assert_eq!(asked(&rig.tell(SECOND, count(2, 0))), Some((0, true)));
}

#[test]
fn a_ground_station_can_cancel_its_upload() {
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(FIRST, count(2, 0));
    let cancelled =
        MissionAck { target_system: 1, target_component: 1, r#type: 15, mission_type: 0, opaque_id: 0 };
    rig.tell(FIRST, cancelled);
    assert_eq!(asked(&rig.tell(SECOND, count(2, 0))), Some((0, true)));
}

#[test]
fn a_mission_is_deleted() {
    let mut rig = Rig::new(CraftOptions { max_fence: 4, ..CraftOptions::default() });
    for kind in [0, 255] {
        rig.craft.set_mission(plan(2));
        rig.craft.set_fence(plan(2));
        assert_eq!(rig.tell(FIRST, clear(kind)), []);
        if kind == 255 {
            assert_eq!(rig.accept(), RequestKind::Fence(Vec::new()));
        }
        assert_eq!(rig.accept(), RequestKind::Mission { items: Vec::new(), home: None });
        assert_eq!(end(&rig.answers(FIRST)), Some(MissionResult::Accepted));
        assert_eq!(rig.download(FIRST, 0), []);
    }
    assert_eq!(rig.download(FIRST, 1), []);
    rig.craft.set_mission(plan(2));
    assert_eq!(rig.upload(FIRST, &[], 0), []);
    assert_eq!(rig.accept(), RequestKind::Mission { items: Vec::new(), home: None });
}

#[test]
fn fences_go_up_and_down_if_the_craft_takes_them() {
    let mut rig = Rig::new(CraftOptions { max_fence: 4, ..CraftOptions::default() });
    rig.upload(FIRST, &plan(4), 1);
    assert_eq!(rig.accept(), RequestKind::Fence(plan(4)));
    rig.answers(FIRST);
    assert_eq!(rig.download(FIRST, 1), plan(4));
    assert_eq!(end(&rig.upload(FIRST, &plan(5), 1)), Some(MissionResult::NoSpace));
    let mut rig = Rig::of(Identity::Generic);
    assert_eq!(end(&rig.upload(FIRST, &plan(4), 1)), Some(MissionResult::Unsupported));
    assert_eq!(end(&rig.upload(FIRST, &[], 1)), Some(MissionResult::Accepted));
    assert_eq!(rig.download(FIRST, 1), []);
}

#[test]
fn rally_points_are_none_and_other_kinds_unsupported() {
    let mut rig = Rig::of(Identity::Generic);
    assert_eq!(rig.download(FIRST, 2), []);
    assert_eq!(end(&rig.upload(FIRST, &plan(1), 2)), Some(MissionResult::Unsupported));
    assert_eq!(end(&rig.tell(FIRST, clear(2))), Some(MissionResult::Accepted));
    for kind in [3, 77, 255] {
        assert_eq!(end(&rig.tell(FIRST, count(1, kind))), Some(MissionResult::Unsupported));
    }
    assert_eq!(end(&rig.tell(FIRST, clear(77))), Some(MissionResult::Unsupported));
    let part = MissionWritePartialList {
        start_index: 0,
        end_index: 1,
        target_system: 1,
        target_component: 1,
        mission_type: 0,
    };
    assert_eq!(end(&rig.tell(FIRST, part)), Some(MissionResult::Unsupported));
}

#[test]
fn an_item_that_does_not_exist_is_refused() {
    let mut rig = Rig::of(Identity::Generic);
    rig.craft.set_mission(plan(2));
    let (target_system, target_component, mission_type) = (1, 1, 0);
    let ask = MissionRequestInt { seq: 2, target_system, target_component, mission_type };
    assert_eq!(end(&rig.tell(FIRST, ask)), Some(MissionResult::InvalidSequence));
}

#[test]
fn the_next_item_is_set_by_the_old_message() {
    let mut rig = Rig::of(Identity::Generic);
    rig.craft.set_mission(plan(3));
    rig.pass(FIRST, Duration::from_millis(10));
    let set = |seq| MissionSetCurrent { seq, target_system: 1, target_component: 1 };
    rig.tell(FIRST, set(2));
    let request = rig.craft.poll_request().unwrap();
    assert_eq!(request.kind, RequestKind::SetCurrent(2));
    rig.state.mission.current = Some(2);
    rig.craft.answer(request.ticket, Answer::Command(CommandResult::Accepted), &[]);
    let messages = rig.pass(FIRST, Duration::from_millis(10));
    assert!(
        messages
            .iter()
            .any(|message| matches!(message, Message::MissionCurrent(current) if current.seq == 2))
    );
    assert_eq!(end(&rig.tell(FIRST, set(3))), Some(MissionResult::InvalidSequence));
}

#[test]
fn an_old_item_without_a_place_ends_the_upload() {
    let mut rig = Rig::of(Identity::Generic);
    rig.tell(FIRST, count(2, 0));
    let broken = super::super::super::message::MissionItemFloat {
        x: f32::NAN,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    };
    assert_eq!(end(&rig.tell(FIRST, broken)), Some(MissionResult::InvalidX));
    assert_eq!(asked(&rig.tell(SECOND, count(2, 0))), Some((0, true)));
}
