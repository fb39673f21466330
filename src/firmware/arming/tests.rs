use strum::IntoEnumIterator as _;

use super::*;

impl Default for ArmingConfig {
    fn default() -> Self {
        Self {
            min_check_us: 1050.0,
            small_angle_rad: None,
            boot_grace_s: 5.0,
            prearm_allow_rearm: false,
            has_arm_condition: true,
            has_prearm_condition: false,
            rescue_configured: false,
            rescue_min_sats: 8,
            rescue_allow_without_fix: false,
            full_yaw: 400.0,
            stick_arming: false,
            auto_disarm_s: None,
            raised_throttle_us: 1287.5,
            assist: false,
            calibrate_gyro_first: false,
            motors_disabled: false,
            reboot_required: false,
        }
    }
}

/// Returns the facts of a craft that may be armed: no flag set, ARM off.
fn ready() -> ArmingFacts {
    ArmingFacts {
        now: SimTime(6_000_000),
        new_frame: true,
        boxes: BoxSet::NONE,
        sticks: Sticks { throttle_us: 1000.0, ..Sticks::default() },
        signal: true,
        link_good: true,
        from_udp: true,
        failsafe_landed: false,
        tilt_rad: Some(0.0),
        calibrating: false,
        fix_sats: Some(12),
    }
}

fn with(mut facts: ArmingFacts, id: u8) -> ArmingFacts {
    facts.boxes.set(id, true);
    facts
}

fn names(flags: ArmingFlags) -> String {
    flags.iter().map(|flag| flag.to_string()).collect::<Vec<_>>().join(" ")
}

/// One row: the cause that sets the flag, and the change that clears it.
struct Row {
    name: &'static str,
    config: fn(&mut ArmingConfig),
    set: fn(&mut ArmingFacts),
    clear: fn(&mut ArmingFacts),
}

const SAME: fn(&mut ArmingConfig) = |_| {};
const BACK_TO_READY: fn(&mut ArmingFacts) = |_| {};

/// Returns the situations that set a flag only while they last.
fn situations() -> Vec<Row> {
    vec![
        Row { name: "FAILSAFE", config: SAME, set: |f| f.failsafe_landed = true, clear: BACK_TO_READY },
        Row { name: "RXLOSS", config: SAME, set: |f| f.link_good = false, clear: BACK_TO_READY },
        Row { name: "BOXFAILSAFE", config: SAME, set: |f| f.boxes.set(27, true), clear: BACK_TO_READY },
        Row {
            name: "THROTTLE",
            config: SAME,
            set: |f| f.sticks.throttle_us = 1050.0,
            clear: |f| f.sticks.throttle_us = 1049.0,
        },
        Row {
            name: "ANGLE",
            config: |c| c.small_angle_rad = Some(0.4),
            set: |f| f.tilt_rad = Some(0.41),
            clear: |f| f.tilt_rad = Some(0.4),
        },
        Row { name: "ANGLE", config: SAME, set: |f| f.tilt_rad = None, clear: |f| f.tilt_rad = Some(3.0) },
        Row {
            name: "BOOTGRACE",
            config: SAME,
            set: |f| f.now = SimTime(4_999_999),
            clear: |f| f.now = SimTime(5_000_000),
        },
        Row {
            name: "NOPREARM",
            config: |c| c.has_prearm_condition = true,
            set: BACK_TO_READY,
            clear: |f| f.boxes.set(36, true),
        },
        Row { name: "CALIB", config: SAME, set: |f| f.calibrating = true, clear: BACK_TO_READY },
        Row {
            name: "GPS",
            config: |c| c.rescue_configured = true,
            set: |f| f.fix_sats = None,
            clear: BACK_TO_READY,
        },
        Row {
            name: "GPS",
            config: |c| c.rescue_configured = true,
            set: |f| f.fix_sats = Some(7),
            clear: |f| f.fix_sats = Some(8),
        },
        Row {
            name: "RESCUE_SW",
            config: |c| c.rescue_configured = true,
            set: |f| f.boxes.set(46, true),
            clear: BACK_TO_READY,
        },
        Row { name: "ALT_HOLD_SW", config: SAME, set: |f| f.boxes.set(3, true), clear: BACK_TO_READY },
        Row { name: "POS_HOLD_SW", config: SAME, set: |f| f.boxes.set(11, true), clear: BACK_TO_READY },
        Row { name: "AUTOPILOT_SW", config: SAME, set: |f| f.boxes.set(56, true), clear: BACK_TO_READY },
        Row { name: "FLIP_SWITCH", config: SAME, set: |f| f.boxes.set(35, true), clear: BACK_TO_READY },
    ]
}

#[test]
fn each_situation_sets_its_flag_and_its_end_clears_it() {
    for row in situations() {
        let mut config = ArmingConfig::default();
        (row.config)(&mut config);
        let (mut bad, mut good) = (ready(), ready());
        (row.set)(&mut bad);
        (row.clear)(&mut good);

        let mut arming = Arming { link_was_good: bad.link_good, ..Arming::default() };
        arming.update(&config, &bad);
        assert_eq!(names(arming.flags()), row.name, "set");
        arming.update(&config, &good);
        assert_eq!(names(arming.flags()), "", "cleared: {}", row.name);
        assert_eq!(
            arming.update(&config, &with(good, boxes::ARM)),
            Some(ArmingChange::Armed { assisted: false }),
            "{}",
            row.name
        );

        let mut held = Arming { link_was_good: bad.link_good, ..Arming::default() };
        assert_eq!(held.update(&config, &with(bad, boxes::ARM)), None, "{} blocks", row.name);
        assert_eq!(held.update(&config, &with(good, boxes::ARM)), None, "{} latches", row.name);
        assert!(names(held.flags()).ends_with("ARM_SWITCH"), "{}", names(held.flags()));
        held.update(&config, &good);
        assert_eq!(names(held.flags()), "");
    }
}

/// A change of the configuration.
type Change = fn(&mut ArmingConfig);

/// The flags that come from the configuration. They end when the change is undone, or with a restart.
const BY_CONFIGURATION: [(&str, Change); 2] =
    [("REBOOT_REQD", |c| c.reboot_required = true), ("MOTOR_PROTO", |c| c.motors_disabled = true)];

#[test]
fn configuration_sets_its_flags_while_it_lasts() {
    for (name, change) in BY_CONFIGURATION {
        let mut changed = ArmingConfig::default();
        change(&mut changed);
        let mut arming = Arming::default();
        assert_eq!(arming.update(&changed, &ready()), None);
        assert_eq!(names(arming.flags()), name);
        assert_eq!(arming.update(&changed, &with(ready(), boxes::ARM)), None);
        assert_eq!(names(arming.flags()), format!("{name} ARM_SWITCH"));
        arming.update(&ArmingConfig::default(), &ready());
        assert_eq!(names(arming.flags()), "", "{name}");
        assert!(arming.update(&ArmingConfig::default(), &with(ready(), boxes::ARM)).is_some());
    }
}

/// The flags that latch. The tests below show what sets and what clears each.
const LATCHES: [&str; 6] = ["NOT_DISARMED", "RUNAWAY", "CRASH", "CLI", "PARALYZE", "ARM_SWITCH"];

#[test]
fn every_flag_has_its_situation_or_says_why_it_never_comes() {
    let situations = situations();
    for flag in ArmingFlag::iter() {
        let name = flag.to_string();
        let shown = situations.iter().any(|row| row.name == name)
            || BY_CONFIGURATION.iter().any(|(row, _)| *row == name)
            || LATCHES.contains(&name.as_str());
        assert_ne!(shown, flag.cause().starts_with("never: "), "{name}: {}", flag.cause());
    }
}

#[test]
fn first_arming_waits_for_the_gyro_when_asked_to() {
    let config = ArmingConfig { calibrate_gyro_first: true, ..ArmingConfig::default() };
    let on = with(ready(), boxes::ARM);
    let calibrating = ArmingFacts { calibrating: true, ..on };
    let mut arming = Arming::default();
    arming.update(&config, &ready());
    assert_eq!(arming.update(&config, &on), Some(ArmingChange::CalibrateGyro));
    for _ in 0..50 {
        assert_eq!(arming.update(&config, &calibrating), None);
        assert_eq!(names(arming.flags()), "CALIB", "the switch need not be cycled");
    }
    assert_eq!(arming.update(&config, &on), Some(ArmingChange::Armed { assisted: false }));
    arming.disarm(DisarmReason::Switch);
    arming.update(&config, &ready());
    assert_eq!(arming.update(&config, &on), Some(ArmingChange::Armed { assisted: false }), "only once");
}

#[test]
fn first_calibration_does_not_arm_a_craft_whose_switch_went_off() {
    let config = ArmingConfig { calibrate_gyro_first: true, ..ArmingConfig::default() };
    let mut arming = Arming::default();
    arming.update(&config, &ready());
    assert_eq!(arming.update(&config, &with(ready(), boxes::ARM)), Some(ArmingChange::CalibrateGyro));
    arming.update(&config, &ArmingFacts { calibrating: true, ..ready() });
    assert_eq!(arming.update(&config, &ready()), None);
    assert!(arming.update(&config, &with(ready(), boxes::ARM)).is_some());
}

#[test]
fn rescue_switch_and_fix_matter_only_when_rescue_is_configured() {
    let mut arming = Arming::default();
    arming.update(&ArmingConfig::default(), &with(ArmingFacts { fix_sats: None, ..ready() }, 46));
    assert_eq!(names(arming.flags()), "");
}

#[test]
fn paralyze_and_cli_stay_until_reboot() {
    let mut arming = Arming::default();
    arming.update(&ArmingConfig::default(), &with(ready(), 45));
    arming.cli_opened();
    arming.update(&ArmingConfig::default(), &ready());
    assert_eq!(names(arming.flags()), "CLI PARALYZE");
}

#[test]
fn link_that_appears_with_the_switch_on_sets_not_disarmed() {
    let mut arming = Arming::default();
    let config = ArmingConfig::default();
    arming.update(&config, &with(ArmingFacts { link_good: false, ..ready() }, boxes::ARM));
    arming.update(&config, &with(ready(), boxes::ARM));
    assert_eq!(names(arming.flags()), "NOT_DISARMED ARM_SWITCH");
    arming.update(&config, &ready());
    assert_eq!(names(arming.flags()), "");
}

#[test]
fn runaway_crash_and_landing_ask_for_the_switch() {
    let cases = [
        (DisarmReason::RunawayTakeoff, "RUNAWAY ARM_SWITCH"),
        (DisarmReason::CrashProtection, "CRASH ARM_SWITCH"),
        (DisarmReason::Landing, "ARM_SWITCH"),
    ];
    for (reason, flags) in cases {
        let mut arming = armed();
        assert!(arming.disarm(reason));
        arming.update(&ArmingConfig::default(), &with(ready(), boxes::ARM));
        assert_eq!(names(arming.flags()), flags);
        arming.update(&ArmingConfig::default(), &ready());
        assert_eq!(names(arming.flags()), "", "{reason}");
    }
}

fn armed() -> Arming {
    let mut arming = Arming::default();
    arming.update(&ArmingConfig::default(), &ready());
    assert!(arming.update(&ArmingConfig::default(), &with(ready(), boxes::ARM)).is_some());
    arming
}

#[test]
fn switch_disarms_after_four_frames_but_not_without_signal() {
    let mut arming = armed();
    let config = ArmingConfig::default();
    for _ in 0..20 {
        assert_eq!(arming.update(&config, &ArmingFacts { signal: false, ..ready() }), None);
        assert_eq!(arming.update(&config, &ArmingFacts { new_frame: false, ..ready() }), None);
    }
    for _ in 0..3 {
        assert_eq!(arming.update(&config, &ready()), None);
    }
    assert_eq!(arming.update(&config, &with(ready(), boxes::ARM)), None, "a glitch starts the count again");
    for _ in 0..3 {
        assert_eq!(arming.update(&config, &ready()), None);
    }
    assert_eq!(arming.update(&config, &ready()), Some(ArmingChange::Disarmed(DisarmReason::Switch)));
}

#[test]
fn prearm_must_be_switched_again() {
    let config = ArmingConfig { has_prearm_condition: true, ..ArmingConfig::default() };
    let prearmed = with(ready(), boxes::PREARM);
    for (allow, second) in [(false, "NOPREARM"), (true, "")] {
        let config = ArmingConfig { prearm_allow_rearm: allow, ..config };
        let mut arming = Arming::default();
        arming.update(&config, &prearmed);
        assert!(arming.update(&config, &with(prearmed, boxes::ARM)).is_some());
        arming.disarm(DisarmReason::Switch);
        arming.update(&config, &prearmed);
        assert_eq!(names(arming.flags()), second);
        arming.update(&config, &ready());
        arming.update(&config, &prearmed);
        assert_eq!(names(arming.flags()), "");
    }
}

#[test]
fn gps_flag_is_gone_after_the_first_arming() {
    let config = ArmingConfig { rescue_configured: true, ..ArmingConfig::default() };
    let mut arming = armed();
    arming.disarm(DisarmReason::Switch);
    arming.update(&config, &ArmingFacts { fix_sats: None, ..ready() });
    assert_eq!(names(arming.flags()), "");
}

#[test]
fn throttle_counts_as_raised_once_per_flight() {
    let mut arming = armed();
    let config = ArmingConfig::default();
    let throttle = |us| {
        let mut facts = with(ready(), boxes::ARM);
        facts.sticks.throttle_us = us;
        facts
    };
    arming.update(&config, &throttle(1287.0));
    assert!(!arming.raised());
    arming.update(&config, &throttle(1288.0));
    arming.update(&config, &throttle(1000.0));
    assert!(arming.raised());
    arming.disarm(DisarmReason::Switch);
    assert!(!arming.raised());
}

#[test]
fn sticks_arm_and_disarm_when_no_switch_does() {
    let config = ArmingConfig { has_arm_condition: false, stick_arming: true, ..ArmingConfig::default() };
    let held = |yaw: f64, ms: u64| ArmingFacts {
        now: SimTime(6_000_000 + ms * 1000),
        sticks: Sticks { yaw, throttle_us: 1000.0, ..Sticks::default() },
        ..ready()
    };
    let mut arming = Arming::default();
    assert_eq!(arming.update(&config, &held(500.0, 0)), None);
    assert_eq!(arming.update(&config, &held(500.0, 499)), None);
    assert_eq!(arming.update(&config, &held(500.0, 500)), Some(ArmingChange::Armed { assisted: false }));
    assert_eq!(arming.update(&config, &held(-500.0, 1000)), None);
    assert_eq!(
        arming.update(&config, &held(-500.0, 1500)),
        Some(ArmingChange::Disarmed(DisarmReason::Sticks))
    );
}

#[test]
fn sticks_arm_nothing_while_their_commands_are_switched_off() {
    let config = ArmingConfig { has_arm_condition: false, stick_arming: true, ..ArmingConfig::default() };
    let mut arming = Arming::default();
    for ms in [0, 1000, 2000] {
        let mut facts = with(ready(), boxes::STICK_COMMANDS_DISABLE);
        facts.now.0 += ms * 1000;
        facts.sticks.yaw = 500.0;
        assert_eq!(arming.update(&config, &facts), None);
    }
}

#[test]
fn low_throttle_disarms_a_stick_armed_craft() {
    let config = ArmingConfig {
        has_arm_condition: false,
        stick_arming: true,
        auto_disarm_s: Some(5.0),
        ..ArmingConfig::default()
    };
    let mut arming = armed();
    let at = |ms: u64| ArmingFacts { now: SimTime(6_000_000 + ms * 1000), ..ready() };
    assert_eq!(arming.update(&config, &at(0)), None);
    assert_eq!(arming.update(&config, &at(4999)), None);
    assert_eq!(
        arming.update(&config, &at(5000)),
        Some(ArmingChange::Disarmed(DisarmReason::ThrottleTimeout))
    );
}

/// Returns the facts of a script that holds the switch on and the throttle at 1100 from its first packet.
fn impatient(link_good: bool) -> ArmingFacts {
    let mut facts = with(ArmingFacts { link_good, ..ready() }, boxes::ARM);
    facts.sticks.throttle_us = 1100.0;
    facts
}

#[test]
fn assist_lets_an_impatient_script_arm() {
    let config = ArmingConfig { assist: true, ..ArmingConfig::default() };
    let mut arming = Arming::default();
    assert_eq!(arming.update(&config, &impatient(false)), None);
    assert_eq!(arming.update(&config, &impatient(true)), Some(ArmingChange::Armed { assisted: true }));
}

#[test]
fn assist_helps_only_udp_and_lifts_no_other_flag() {
    let config = ArmingConfig { assist: true, ..ArmingConfig::default() };
    let mut arming = Arming::default();
    for link_good in [false, true, true] {
        let facts = ArmingFacts { from_udp: false, ..impatient(link_good) };
        assert_eq!(arming.update(&config, &facts), None);
    }
    assert_eq!(names(arming.flags()), "NOT_DISARMED THROTTLE ARM_SWITCH");

    let mut arming = Arming::default();
    arming.cli_opened();
    arming.update(&config, &impatient(false));
    assert_eq!(arming.update(&config, &impatient(true)), None);
    assert_eq!(names(arming.flags()), "CLI");
}

#[test]
fn assist_says_nothing_when_it_was_not_needed() {
    let config = ArmingConfig { assist: true, ..ArmingConfig::default() };
    let mut arming = Arming::default();
    arming.update(&config, &ready());
    assert_eq!(
        arming.update(&config, &with(ready(), boxes::ARM)),
        Some(ArmingChange::Armed { assisted: false })
    );
}
