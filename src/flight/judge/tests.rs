use super::*;
use crate::telemetry::CrashCause;

fn facts(seconds: f64) -> JudgeFacts {
    JudgeFacts {
        time: SimTime::from_secs_f64(seconds),
        engaged: true,
        armed: true,
        last_disarm: None,
        state: NavState::Approaching,
        entered_for: None,
        alt_m: 10.0,
        wp: 1,
        source: PlanSource::Stored,
        refusal: None,
        failsafe: false,
        ends_in_land: true,
        lift_share: None,
        touched_down: false,
        crash: None,
        diverged: false,
    }
}

fn judge() -> Judge {
    let mut judge = Judge::new(SimTime::from_secs_f64(100.0));
    assert_eq!(judge.look(&facts(10.0)), None);
    judge
}

#[test]
fn a_landed_plan_is_complete_and_an_injected_one_is_landed() {
    for (source, result) in [
        (PlanSource::Stored, FlightResult::Complete),
        (PlanSource::Rth, FlightResult::Landed),
        (PlanSource::Emergency, FlightResult::Landed),
    ] {
        let down = JudgeFacts {
            armed: false,
            engaged: false,
            last_disarm: Some(DisarmReason::Landing),
            state: NavState::Complete,
            touched_down: true,
            source,
            ..facts(20.0)
        };
        assert_eq!(judge().look(&down).map(|v| v.result), Some(result));
    }
}

#[test]
fn a_parked_plan_is_watched_for_five_seconds() {
    let mut judge = judge();
    let parked = |s| JudgeFacts { state: NavState::Complete, ends_in_land: false, ..facts(s) };
    assert_eq!(judge.look(&parked(20.0)), None);
    assert_eq!(judge.look(&parked(24.9)), None);
    assert_eq!(judge.look(&parked(25.0)).map(|v| v.result), Some(FlightResult::Complete));
}

#[test]
fn a_refusal_must_stay_ten_seconds() {
    let mut judge = Judge::new(SimTime::from_secs_f64(100.0));
    let refused =
        |s, why| JudgeFacts { engaged: false, refusal: Some(why), state: NavState::Idle, ..facts(s) };
    assert_eq!(judge.look(&refused(10.0, Refusal::NoFix)), None);
    assert_eq!(judge.look(&refused(15.0, Refusal::NoPlan)), None);
    assert_eq!(judge.look(&refused(24.0, Refusal::NoPlan)), None);
    assert_eq!(judge.look(&refused(25.0, Refusal::NoPlan)).map(|v| v.result), Some(FlightResult::Refused));
}

#[test]
fn a_landing_that_goes_on_without_a_fix_is_waited_for() {
    let mut judge = judge();
    assert_eq!(judge.look(&JudgeFacts { state: NavState::Landing, ..facts(20.0) }), None);
    let lost = |s, alt_m| JudgeFacts {
        state: NavState::Idle,
        engaged: false,
        entered_for: Some(TransitionReason::GivenUp(AbortReason::GpsLost)),
        alt_m,
        ..facts(s)
    };
    for (s, alt_m) in [(21.0, 20.0), (45.0, 8.0), (70.0, 1.0)] {
        assert_eq!(judge.look(&lost(s, alt_m)), None, "{s}");
    }
    let mut stuck = judge.clone();
    assert_eq!(stuck.look(&lost(99.9, 0.5)), None);
    let down = JudgeFacts {
        armed: false,
        last_disarm: Some(DisarmReason::Landing),
        touched_down: true,
        ..lost(80.0, 0.0)
    };
    let verdict = judge.look(&down).unwrap();
    assert_eq!((verdict.result, verdict.reason.as_str()), (FlightResult::Landed, "landed without a GPS fix"));
}

#[test]
fn a_mission_that_was_given_up_for_a_reason_that_is_reported_once_ends_with_it() {
    let mut judge = judge();
    let idle = |s, entered_for| JudgeFacts { state: NavState::Idle, entered_for, ..facts(s) };
    let lost = Some(TransitionReason::GivenUp(AbortReason::GpsLost));
    assert_eq!(judge.look(&idle(20.0, lost)), None);
    assert_eq!(judge.look(&idle(21.0, None)), None);
    assert_eq!(judge.look(&idle(50.0, None)).unwrap().reason, "mission given up: the GPS fix was lost.");
}

#[test]
fn a_mission_that_the_switch_ended_says_so() {
    let idle = |s, failsafe| JudgeFacts {
        state: NavState::Idle,
        engaged: false,
        entered_for: Some(TransitionReason::Disengage),
        failsafe,
        ..facts(s)
    };
    for (failsafe, reason) in [
        (false, "mission given up: the AUTOPILOT switch was turned off; turned on again it resumes."),
        (true, "mission given up: a failsafe procedure flies."),
    ] {
        let mut judge = judge();
        assert_eq!(judge.look(&idle(20.0, failsafe)), None);
        assert_eq!(judge.look(&idle(50.0, failsafe)).unwrap().reason, reason);
    }
}

#[test]
fn a_craft_that_hovers_without_a_fix_is_given_up() {
    let mut judge = judge();
    assert_eq!(judge.look(&JudgeFacts { state: NavState::Landing, ..facts(20.0) }), None);
    let lost = |s| JudgeFacts {
        state: NavState::Idle,
        engaged: false,
        entered_for: Some(TransitionReason::GivenUp(AbortReason::GpsLost)),
        ..facts(s)
    };
    assert_eq!(judge.look(&lost(21.0)), None);
    assert_eq!(judge.look(&lost(51.0)).map(|v| v.result), Some(FlightResult::Aborted));
}

#[test]
fn idle_disarm_crash_timeout() {
    let idle = |s| JudgeFacts { state: NavState::Idle, engaged: false, ..facts(s) };
    let mut idling = judge();
    assert_eq!(idling.look(&idle(20.0)), None);
    assert_eq!(idling.look(&idle(50.0)).map(|v| v.result), Some(FlightResult::Aborted));

    let mut disarmed = judge();
    let down = |s| JudgeFacts { armed: false, last_disarm: Some(DisarmReason::Switch), ..facts(s) };
    assert_eq!(disarmed.look(&down(20.0)), None);
    assert_eq!(disarmed.look(&down(21.0)).map(|v| v.result), Some(FlightResult::Disarmed));

    let crash = Crash {
        cause: Some(CrashCause::SidewaysLanding(3.34)),
        state: NavState::Landing,
        wp: 3,
        attitude_deg: Some([-0.2, 12.4]),
        ..Crash::default()
    };
    let mut crashed = judge();
    let wreck = |s| JudgeFacts { crash: Some(crash), ..facts(s) };
    assert_eq!(crashed.look(&wreck(20.0)), None);
    let verdict = crashed.look(&wreck(21.0)).unwrap();
    assert_eq!(
        (verdict.result, verdict.reason.as_str()),
        (
            FlightResult::Crashed,
            "the craft crashed LANDING at waypoint 3: it touched the ground moving sideways at 3.3 m/s, roll 0°, pitch 12°"
        )
    );
    assert_eq!(Crash::default().to_string(), "the craft crashed");

    let verdict = judge().look(&facts(100.0)).unwrap();
    assert_eq!(verdict.result, FlightResult::Timeout);
    assert!(verdict.reason.contains("APPROACHING at waypoint 1"), "{}", verdict.reason);
}

#[test]
fn a_craft_that_is_too_heavy_is_refused_with_the_number() {
    let mut judge = Judge::new(SimTime::from_secs_f64(100.0));
    let heavy =
        |s, share| JudgeFacts { engaged: false, lift_share: share, state: NavState::Idle, ..facts(s) };
    assert_eq!(judge.look(&heavy(10.0, Some(0.97))), None);
    assert_eq!(judge.look(&heavy(14.0, None)), None);
    assert_eq!(judge.look(&heavy(15.0, Some(0.97))), None);
    let verdict = judge.look(&heavy(20.0, Some(0.97))).unwrap();
    assert_eq!(verdict.result, FlightResult::Refused);
    assert!(verdict.reason.contains("0.97 of its weight"), "{}", verdict.reason);
}
