use super::*;

const DROP: Response = Response::Procedure(Procedure::Drop);
const AUTO_LAND: Response = Response::Procedure(Procedure::AutoLand);
const RESCUE: Response = Response::Procedure(Procedure::GpsRescue);

impl Default for FailsafeConfig {
    fn default() -> Self {
        Self {
            start_s: 5.0,
            landing_time_s: 60.0,
            throttle_low_s: 10.0,
            stick_threshold_percent: 30.0,
            switch_mode: SwitchMode::Stage1,
            procedure: Procedure::Drop,
        }
    }
}

/// Returns the facts of an armed craft in the air, with the link up and the mission flying, ten seconds after boot.
fn flying() -> FailsafeFacts {
    FailsafeFacts {
        now: SimTime(10_000_000),
        armed: true,
        switch: false,
        link_up: true,
        signal: true,
        throttle_low: false,
        held: true,
        stick_percent: 0.0,
        fix: true,
        home: true,
        mission: MissionStatus::Flying,
        response: DROP,
    }
}

/// Returns the facts `ms` later with the link down.
fn lost(ms: u64, response: Response) -> FailsafeFacts {
    FailsafeFacts {
        now: SimTime(10_000_000 + ms * 1000),
        link_up: false,
        signal: false,
        response,
        ..flying()
    }
}

fn config(procedure: Procedure) -> FailsafeConfig {
    FailsafeConfig { procedure, ..FailsafeConfig::default() }
}

/// Returns a machine whose procedure has begun, and its action.
fn begun(procedure: Procedure, response: Response) -> (Failsafe, FailsafeAction) {
    let mut machine = Failsafe::default();
    assert_eq!(machine.update(&config(procedure), &flying()), None);
    let action = machine.update(&config(procedure), &lost(1600, response)).unwrap();
    (machine, action)
}

#[test]
fn stage_2_by_response() {
    // response wanted, fix, home, response carried out, navigator flies for it, auto-landing, flight over
    let rows = [
        (DROP, true, true, DROP, None, false, true),
        (AUTO_LAND, true, true, AUTO_LAND, None, true, false),
        (RESCUE, true, true, RESCUE, Some(RESCUE), false, false),
        (RESCUE, false, true, AUTO_LAND, None, true, false),
        (RESCUE, true, false, AUTO_LAND, None, true, false),
        (Response::Continue, true, true, Response::Continue, Some(Response::Continue), false, false),
        (
            Response::EmergencyLand,
            true,
            true,
            Response::EmergencyLand,
            Some(Response::EmergencyLand),
            false,
            false,
        ),
        (Response::KeepLanding, true, true, Response::KeepLanding, Some(Response::KeepLanding), false, false),
    ];
    for (wanted, fix, home, done, mission, auto_landing, landed) in rows {
        let mut machine = Failsafe::default();
        let facts = FailsafeFacts { fix, home, ..lost(1600, wanted) };
        machine.update(&FailsafeConfig::default(), &flying());
        assert_eq!(
            machine.update(&FailsafeConfig::default(), &facts),
            Some(FailsafeAction::Stage2(done)),
            "{wanted:?}"
        );
        assert!(machine.active() && machine.shown());
        assert_eq!(machine.stage(), 2);
        assert_eq!(
            (machine.mission(), machine.auto_landing(), machine.landed()),
            (mission, auto_landing, landed)
        );
    }
}

#[test]
fn stage_1_is_reported_once() {
    let mut machine = Failsafe::default();
    let facts = FailsafeFacts { signal: false, ..flying() };
    assert_eq!(machine.update(&FailsafeConfig::default(), &flying()), None);
    assert_eq!(machine.update(&FailsafeConfig::default(), &facts), Some(FailsafeAction::Stage1));
    assert_eq!(machine.stage(), 1);
    assert_eq!(machine.update(&FailsafeConfig::default(), &facts), None);
    assert!(!machine.shown());
    machine.update(&FailsafeConfig::default(), &flying());
    assert_eq!(machine.stage(), 0);
}

#[test]
fn nothing_happens_before_the_start_or_disarmed() {
    let early = FailsafeFacts { now: SimTime(4_999_999), ..lost(0, DROP) };
    assert_eq!(Failsafe::default().update(&FailsafeConfig::default(), &early), None);
    let disarmed = FailsafeFacts { armed: false, ..lost(0, DROP) };
    assert_eq!(Failsafe::default().update(&FailsafeConfig::default(), &disarmed), None);
}

#[test]
fn disarmed_the_mode_mirrors_the_switch() {
    let mut machine = Failsafe::default();
    for switch in [true, false] {
        machine.update(&FailsafeConfig::default(), &FailsafeFacts { armed: false, switch, ..flying() });
        assert_eq!(machine.shown(), switch);
        assert!(!machine.active());
    }
}

#[test]
fn throttle_long_low_just_disarms_unless_held_or_rescued() {
    // procedure, held, seconds since the throttle was high (None = never), action
    let rows = [
        (Procedure::AutoLand, false, None, DROP),
        (Procedure::AutoLand, false, Some(9), AUTO_LAND),
        (Procedure::AutoLand, false, Some(10), DROP),
        (Procedure::AutoLand, true, Some(60), AUTO_LAND),
        (Procedure::GpsRescue, false, Some(60), RESCUE),
    ];
    for (procedure, held, high, expected) in rows {
        let mut machine = Failsafe::default();
        let config = config(procedure);
        let low = FailsafeFacts { throttle_low: true, held, ..flying() };
        machine.update(&config, &FailsafeFacts { throttle_low: high.is_none(), ..low });
        let later = lost(high.unwrap_or(1) * 1000, Response::Procedure(procedure));
        assert_eq!(
            machine.update(&config, &FailsafeFacts { throttle_low: true, held, ..later }),
            Some(FailsafeAction::Stage2(expected)),
            "{procedure:?} {high:?}"
        );
    }
}

#[test]
fn link_gives_the_craft_back() {
    // procedure running, stick %, back?
    let rows = [
        (AUTO_LAND, 0.0, true),
        (DROP, 0.0, true),
        (Response::Continue, 29.0, false),
        (Response::Continue, 30.0, true),
        (Response::EmergencyLand, 0.0, false),
        (Response::EmergencyLand, 45.0, true),
        (RESCUE, 0.0, false),
        (RESCUE, 30.0, true),
    ];
    for (response, stick_percent, back) in rows {
        let (mut machine, _) = begun(Procedure::Drop, response);
        let facts =
            FailsafeFacts { now: SimTime(20_000_000), stick_percent, armed: response != DROP, ..flying() };
        let action = machine.update(&FailsafeConfig::default(), &facts);
        assert_eq!(action, back.then_some(FailsafeAction::Recovered), "{response:?} {stick_percent}");
        assert_eq!(machine.active(), !back);
    }
}

#[test]
fn made_by_the_switch_it_ends_with_the_switch() {
    let config = FailsafeConfig { switch_mode: SwitchMode::Stage2, ..FailsafeConfig::default() };
    let mut machine = Failsafe::default();
    let on = FailsafeFacts { switch: true, response: Response::Continue, ..flying() };
    assert_eq!(machine.update(&config, &on), Some(FailsafeAction::Stage2(Response::Continue)));
    assert_eq!(machine.update(&config, &on), None);
    assert!(machine.by_switch());
    assert_eq!(machine.update(&config, &flying()), Some(FailsafeAction::Recovered));
}

#[test]
fn kill_switch_disarms_and_holds_until_it_is_off() {
    let config = FailsafeConfig { switch_mode: SwitchMode::Kill, ..FailsafeConfig::default() };
    let mut machine = Failsafe::default();
    let on = FailsafeFacts { switch: true, response: Response::Continue, ..flying() };
    assert_eq!(machine.update(&config, &on), Some(FailsafeAction::Stage2(DROP)));
    let disarmed = FailsafeFacts { armed: false, ..on };
    assert_eq!(machine.update(&config, &disarmed), None);
    assert!(machine.landed());
    assert_eq!(
        machine.update(&config, &FailsafeFacts { switch: false, ..disarmed }),
        Some(FailsafeAction::Recovered)
    );
}

#[test]
fn auto_land_ends_by_time_or_disarm() {
    let (mut machine, _) = begun(Procedure::AutoLand, AUTO_LAND);
    let config = config(Procedure::AutoLand);
    assert_eq!(machine.update(&config, &lost(61_500, AUTO_LAND)), None);
    assert_eq!(machine.update(&config, &lost(61_600, AUTO_LAND)), Some(FailsafeAction::Disarm));
    assert!(machine.landed());

    let (mut machine, _) = begun(Procedure::AutoLand, AUTO_LAND);
    assert_eq!(machine.update(&config, &FailsafeFacts { armed: false, ..lost(3000, AUTO_LAND) }), None);
    assert!(machine.landed());
}

#[test]
fn mission_that_ends_is_replaced() {
    // response flown, procedure, mission, fix, replacement
    let rows = [
        (Response::Continue, Procedure::Drop, MissionStatus::Over, true, DROP),
        (Response::Continue, Procedure::AutoLand, MissionStatus::Over, true, AUTO_LAND),
        (Response::Continue, Procedure::GpsRescue, MissionStatus::Over, true, AUTO_LAND),
        (Response::Continue, Procedure::Drop, MissionStatus::Flying, false, AUTO_LAND),
        (Response::EmergencyLand, Procedure::Drop, MissionStatus::Flying, false, AUTO_LAND),
        (Response::EmergencyLand, Procedure::Drop, MissionStatus::Over, true, AUTO_LAND),
        (RESCUE, Procedure::GpsRescue, MissionStatus::Over, true, AUTO_LAND),
        (RESCUE, Procedure::GpsRescue, MissionStatus::Flying, false, AUTO_LAND),
    ];
    for (response, procedure, mission, fix, next) in rows {
        let (mut machine, _) = begun(procedure, response);
        let facts = FailsafeFacts { mission, fix, ..lost(3000, DROP) };
        assert_eq!(
            machine.update(&config(procedure), &facts),
            Some(FailsafeAction::Switch(next)),
            "{response:?} {procedure:?} {mission:?} fix {fix}"
        );
        assert_eq!((machine.auto_landing(), machine.landed()), (next == AUTO_LAND, next == DROP));
    }
}

#[test]
fn absent_autopilot_is_given_a_second() {
    let (mut machine, _) = begun(Procedure::AutoLand, Response::Continue);
    let config = config(Procedure::AutoLand);
    let absent = |ms| FailsafeFacts { mission: MissionStatus::Absent, ..lost(ms, DROP) };
    assert_eq!(machine.update(&config, &absent(2000)), None);
    assert_eq!(machine.update(&config, &lost(2500, DROP)), None, "it came back");
    assert_eq!(machine.update(&config, &absent(3000)), None);
    assert_eq!(machine.update(&config, &absent(3999)), None);
    assert_eq!(machine.update(&config, &absent(4000)), Some(FailsafeAction::Switch(AUTO_LAND)));
}

#[test]
fn touchdown_in_a_mission_leaves_the_flag_until_the_link_is_up() {
    let (mut machine, _) = begun(Procedure::Drop, Response::EmergencyLand);
    machine.update(&FailsafeConfig::default(), &FailsafeFacts { armed: false, ..lost(9000, DROP) });
    assert!(machine.landed());
    assert_eq!(
        machine.update(&FailsafeConfig::default(), &FailsafeFacts { armed: false, ..flying() }),
        Some(FailsafeAction::Recovered)
    );
    assert!(!machine.landed() && !machine.active());
}
