//! Complete files and pastes: the guide's blocks, a real quad's configuration, round trips, provisioning.

use betadeck_core::firmware::cli::{
    ApplyReport, CliAction, CliContext, CliFacts, CliMode, CliReply, Interpreter, apply_lines, provision,
};
use betadeck_core::firmware::config::{Configuration, ModeCondition, correct};
use betadeck_core::firmware::settings::{SETTINGS, Scope};
use betadeck_core::firmware::storage::{decode, encode};
use proptest::prelude::*;

const STEP_5: &str = include_str!("../../vectors/guide-step5.txt");
const STEP_7: &str = include_str!("../../vectors/guide-step7.txt");
const FIVE_INCH: &str = include_str!("../../corpus/cli/five-inch-4.5-diff-all.txt");
const QUAD: &str = include_str!("../../corpus/settings_file/quad-4.5-diff-all.txt");

fn run(configuration: &mut Configuration, interpreter: &mut Interpreter, line: &str) -> CliReply {
    interpreter.run(line, &mut CliContext { configuration, facts: &CliFacts::default() })
}

/// Types lines at a prompt and returns all replies.
fn typed(configuration: &mut Configuration, lines: &str) -> Vec<(String, CliReply)> {
    let mut interpreter = Interpreter::default();
    lines.lines().map(|line| (line.to_owned(), run(configuration, &mut interpreter, line))).collect()
}

fn text(configuration: &Configuration, line: &str) -> String {
    run(&mut configuration.clone(), &mut Interpreter::default(), line).text
}

fn apply(configuration: &mut Configuration, lines: &str) -> ApplyReport {
    let mut context = CliContext { configuration, facts: &CliFacts::default() };
    apply_lines(lines.lines(), &mut Interpreter::new(CliMode::File), &mut context, |_, _| ())
}

#[test]
fn the_guides_blocks_work_as_they_are() {
    let mut craft = Configuration::default();
    let mut saved = 0;
    for (line, reply) in [typed(&mut craft, STEP_5), typed(&mut craft, STEP_7)].concat() {
        assert!(!reply.text.contains("###ERROR") && !reply.failed, "{line}: {}", reply.text);
        saved += usize::from(reply.actions.contains(&CliAction::Save));
    }
    assert_eq!(saved, 2);
    let (restarted, findings) = decode(&encode(&craft)).expect("a good image");
    assert_eq!((&restarted, findings), (&craft, Vec::new()));
    let dump = text(&restarted, "dump");
    for line in STEP_5.lines().filter(|line| line.starts_with("set ")) {
        assert!(dump.contains(&format!("{line}\r\n")), "{line}");
    }
    let plan = "waypoint clear\r\n\
        waypoint insert 0 40.4640000 -79.5175000 5000 0 FLYOVER 0 ORBIT\r\n\
        waypoint insert 1 40.4630000 -79.5175000 5000 0 FLYBY 0 ORBIT\r\n\
        waypoint insert 2 40.4630000 -79.5190000 5000 0 HOLD 300 ORBIT\r\n\
        waypoint insert 3 40.4640000 -79.5190000 5000 0 LAND 0 ORBIT\r\n";
    assert_eq!(text(&restarted, "waypoint list"), plan);
    assert!(dump.contains(plan));
}

#[test]
fn a_real_quads_configuration_loads_and_is_complete_when_dumped() {
    let mut craft = Configuration::default();
    let mut replies = typed(&mut craft, QUAD);
    let (_, saved) = replies.pop().expect("the last line");
    for (line, reply) in &replies {
        assert!(!reply.failed, "{line}: {}", reply.text);
    }
    assert_eq!(saved.actions, [CliAction::Save, CliAction::Restart { close_links: true }]);
    let (craft, _) = decode(&encode(&craft)).expect("a good image");
    let dump = text(&craft, "diff all");
    let commands = QUAD.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    // Lines that this vehicle does not have: features, the identity of a real board, and the clipping of a
    // boot.
    let dropped = ["feature", "mcu_id", "signature"];
    for line in commands.filter(|line| !dropped.iter().any(|word| line.starts_with(word))) {
        assert!(
            dump.contains(&format!("{}\r\n", line.trim())) || line == "save",
            "{line} is missing in\n{dump}"
        );
    }
    assert_eq!(text(&craft, "get dyn_idle_min"), "dyn_idle_min_rpm = 40\r\n");
    assert_eq!(text(&craft, "get pilot_name"), "pilot_name = someone\r\n");
}

#[test]
fn a_five_inch_quads_refused_line_is_named_and_blocks_saving_until_it_is_gone() {
    // A debug mode that has another name in this release.
    let refused = "set debug_mode = GYRO_SCALED";
    let mut craft = Configuration::default();
    let replies = typed(&mut craft, FIVE_INCH);
    let failed: Vec<_> =
        replies.iter().filter(|(_, reply)| reply.failed).map(|(line, _)| line.as_str()).collect();
    assert_eq!(failed, [refused, "save"]);
    let (_, saved) = replies.last().expect("the last line");
    assert!(saved.text.contains("PLEASE FIX ERRORS THEN 'SAVE'") && saved.actions.is_empty());

    let mut craft = Configuration::default();
    let good = FIVE_INCH.replace(&format!("{refused}\n"), "");
    let mut replies = typed(&mut craft, &good);
    let (_, saved) = replies.pop().expect("the last line");
    assert_eq!(saved.actions, [CliAction::Save, CliAction::Restart { close_links: true }]);
    for (line, reply) in &replies {
        assert!(!reply.failed, "{line}: {}", reply.text);
    }
    // Settings without a use on this craft say so, line by line.
    let kept = |line: &str| {
        let (_, reply) = replies.iter().find(|(typed, _)| typed == line).expect("a line of the file");
        reply.text.starts_with("# ") && reply.text.ends_with(": not used by this vehicle, kept\r\n")
    };
    for line in [
        "set dyn_notch_count = 1",
        "set gps_rescue_max_angle = 45",
        "set d_min_roll = 39",
        "vtx 0 7 0 0 1 900 1100",
    ] {
        assert!(kept(line), "{line}");
    }
    let (craft, findings) = decode(&encode(&craft)).expect("a good image");
    assert_eq!(findings, Vec::<String>::new());
    let dump = text(&craft, "diff all");
    // Not shown again: parts that this vehicle does not have, values that equal its defaults, and D max below
    // the new D.
    let same = ["feature", "mcu_id", "signature", "serial", "rxfail 5 h", "set d_max"];
    let fresh = text(&Configuration::default(), "dump all");
    let commands = good.lines().filter(|line| !line.starts_with('#') && !line.is_empty() && *line != "save");
    for line in commands.filter(|line| !same.iter().any(|word| line.starts_with(word))) {
        let line = line.trim();
        assert!(
            dump.contains(&format!("{line}\r\n")) || fresh.contains(&format!("{line}\r\n")),
            "{line}\n{dump}"
        );
    }
    assert_eq!(craft.settings.number("thrust_linear"), 20);
    assert_eq!(text(&craft, "get vtx_low_power"), "vtx_low_power_disarm = UNTIL_FIRST_ARM\r\n");
    assert_round_trip(&craft, "diff all");
}

/// Feeds a dump to a fresh craft. Expects the same configuration and no error.
fn assert_round_trip(craft: &Configuration, command: &str) {
    let dump = text(craft, command);
    let mut copy = Configuration::default();
    for (line, reply) in typed(&mut copy, &dump) {
        assert!(!reply.failed, "{line}: {}", reply.text);
    }
    assert_eq!(text(&copy, "diff all"), text(craft, "diff all"), "{command}");
    assert_eq!(&copy, craft, "{command}");
}

#[test]
fn dumps_rebuild_the_craft() {
    let mut guide = Configuration::default();
    typed(&mut guide, &[STEP_5, STEP_7].concat());
    let mut quad = Configuration::default();
    typed(&mut quad, QUAD);
    let mut starter = Configuration::default();
    assert!(starter.starter_modes());
    for craft in [Configuration::default(), guide, quad, starter] {
        for command in ["diff all", "dump all", "diff all defaults", "dump all defaults"] {
            assert_round_trip(&craft, command);
        }
    }
}

/// Generates commands that change the craft, with allowed arguments.
fn change() -> impl Strategy<Value = String> {
    let setting = (0..SETTINGS.len(), any::<u64>(), 0..4_u8).prop_map(|(at, seed, instance)| {
        use betadeck_core::firmware::settings::{Kind, PORT_NAMES};
        let setting = &SETTINGS[at];
        let pick = |count: usize| (seed % count as u64) as usize;
        let value = match setting.kind {
            Kind::Number { min, max, .. } => (min + (seed % (max - min + 1) as u64) as i64).to_string(),
            Kind::Choice { words, .. } => words[pick(words.len())].to_owned(),
            Kind::Port { .. } => PORT_NAMES[pick(PORT_NAMES.len())].to_owned(),
            Kind::Array { default } => vec![(seed % 100).to_string(); default.len()].join(","),
            Kind::Text { max } => format!("{seed:x} =,").chars().take(max).collect(),
        };
        let select = match setting.scope {
            Scope::Master => String::new(),
            scope => format!("{} {}\n", scope.word(), instance % scope.instances()),
        };
        format!("{select}set {} = {value}", setting.name)
    });
    let numbers = "[0-9]{1,4}";
    prop_oneof![
        6 => setting,
        1 => (0..20, prop::sample::select(vec![0, 1, 3, 11, 46, 56]), 0..14, 900..2100, 900..2100, 0..2, 0..2)
            .prop_map(|(i, b, c, s, e, l, k)| format!("aux {i} {b} {c} {s} {e} {l} {}", if b == 0 { 0 } else { k })),
        1 => (0..30, 0..14, 900..2100, 900..2100, 0..200, 0..14, 0..9999, 0..9999)
            .prop_map(|(i, c, s, e, f, k, m, n)| format!("adjrange {i} 0 {c} {s} {e} {f} {k} {m} {n}")),
        1 => (4..18, 700..2300).prop_map(|(c, v)| format!("rxfail {c} s {v}")),
        1 => (0..4, 750..1500, 1501..2250).prop_map(|(c, a, b)| format!("rxrange {c} {a} {b}")),
        1 => (1..=8, any::<u16>(), 0..16_usize).prop_map(|(p, f, b)| {
            let baud = betadeck_core::firmware::config::BAUD_RATES[b];
            format!("serial UART{p} {f} {baud} {baud} {baud} {baud}")
        }),
        1 => (0..8, -5.0..5.0, -5.0..5.0).prop_map(|(i, a, b)| format!("mmix {i} {a} {b} {a} {b}")),
        1 => prop::sample::select(vec!["mixer hex6x", "mixer custom", "feature -GPS", "feature MOTOR_STOP", "feature 3D",
            "feature RX_MSP", "map TAER1234", "map RETA4321", "board_name BETAFPVF4SX1280", "manufacturer_id BEFH",
            "profile 2", "rateprofile 3", "battery_profile 1", "set dshot_bidir = ON", "set osd_vbat_pos = 234",
            "beeper -GYRO_CALIBRATED", "resource MOTOR 1 A08", "waypoint clear"]).prop_map(str::to_owned),
        2 => (-90.0..90.0, -180.0..180.0, any::<i32>(), any::<u16>(), 0..8_u8, any::<u16>(), 0..3_u8)
            .prop_map(|(lat, lon, alt, speed, kind, time, pattern)| {
                use betadeck_core::plan::{HoldPattern, WaypointType};
                let kind = WaypointType::from_repr(kind).expect("a type");
                let pattern = HoldPattern::from_repr(pattern).expect("a pattern");
                format!("waypoint insert 0 {lat:.7} {lon:.7} {alt} {speed} {kind} {time} {pattern}")
            }),
        1 => numbers.prop_map(|number| format!("set vbat_sag_lpf_period_{number} = 1")),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_craft_survives_dump_and_storage(changes in prop::collection::vec(change(), 0..60)) {
        let mut craft = Configuration::default();
        apply(&mut craft, &changes.join("\n"));
        // The `save` of a dump corrects the stored values.
        correct(&mut craft);
        assert_round_trip(&craft, "diff all");
        assert_round_trip(&craft, "dump all");
        let (stored, findings) = decode(&encode(&craft)).expect("a good image");
        prop_assert_eq!(findings, Vec::<String>::new());
        prop_assert_eq!(stored, craft);
    }
}

#[test]
fn reports_name_the_lines_that_failed() {
    let mut craft = Configuration::default();
    let report = apply(
        &mut craft,
        "# mine\nset ap_max_angle = 20\nset nonsense = 1\n\nsave\nfeature BLACKBOX # not here\n",
    );
    assert_eq!(report.commands, 3);
    let failed: Vec<_> = report.failed.iter().map(|line| (line.number, line.line.as_str())).collect();
    assert_eq!(failed, [(3, "set nonsense = 1"), (6, "feature BLACKBOX")]);
    assert_eq!(report.failed[0].reason, "###ERROR IN set: INVALID NAME: nonsense = 1###");
    assert_eq!(craft.settings.number("ap_max_angle"), 20);
}

fn provisioned(file: &str) -> (Configuration, ApplyReport, String) {
    let mut configuration = Configuration::default();
    let mut shown = String::new();
    let mut context = CliContext { configuration: &mut configuration, facts: &CliFacts::default() };
    let report =
        provision(file, &mut Interpreter::new(CliMode::File), &mut context, |text| shown.push_str(text));
    (configuration, report, shown)
}

#[test]
fn provisioning_stops_at_save_and_skips_what_leaves() {
    let (craft, report, shown) =
        provisioned("defaults\nexit\nfeature BLACKBOX\nset small_angle = 180\nsave\nset small_angle = 1");
    assert_eq!(craft.settings.number("small_angle"), 180);
    assert_eq!((report.commands, report.failed.len(), report.batch_failed), (3, 1, false));
    assert!(shown.contains("set small_angle = 180\r\nsmall_angle set to 180\r\n# "), "{shown}");
}

#[test]
fn lines_of_a_file_are_cut_as_at_a_prompt() {
    let mut craft = Configuration::default();
    let blanks = " ".repeat(300);
    let report = apply(
        &mut craft,
        &format!("{blanks}set small_angle = 99\nset craft_name = {}\n{blanks}save\n", "x".repeat(300)),
    );
    assert_eq!(craft.settings.number("small_angle"), 99);
    assert_eq!((report.commands, report.failed.len()), (2, 1));
    assert_eq!(report.failed[0].line.len(), 255);
    let mut context = CliContext { configuration: &mut craft, facts: &CliFacts::default() };
    let stop = format!("{blanks}save\nset small_angle = 50");
    assert_eq!(provision(&stop, &mut Interpreter::new(CliMode::File), &mut context, |_| ()).commands, 0);
}

#[test]
fn what_would_disconnect_a_real_craft_is_not_kept_for_it() {
    let mut craft = Configuration::default();
    let replies = typed(&mut craft, "batch start\nresource MOTOR 1 B00\nmsc\n");
    assert!(!replies[1].1.failed && replies[2].1.failed);
    let diff = text(&craft, "diff all");
    assert!(diff.contains("resource MOTOR 1 B00\r\n") && !diff.contains("msc"), "{diff}");
}

#[test]
fn provisioning_refuses_a_failed_batch() {
    for file in ["batch start\nset nonsense = 1\nsave", "batch start\nset nonsense = 1\nbatch end\nsave"] {
        assert!(provisioned(file).1.batch_failed, "{file}");
    }
    assert!(!provisioned("batch start\nset small_angle = 1\nbatch end\nset nonsense = 1").1.batch_failed);
    let mut craft = Configuration::default();
    let mut lenient = Interpreter::new(CliMode::File).lenient(true);
    let mut context = CliContext { configuration: &mut craft, facts: &CliFacts::default() };
    assert!(
        !provision("batch start\nset nonsense = 1\nsave", &mut lenient, &mut context, |_| ()).batch_failed
    );
}

#[test]
fn starter_modes_leave_a_configured_craft_alone() {
    let mut craft = Configuration::default();
    craft.modes[7] = ModeCondition { box_id: 1, start_us: 1700, end_us: 2100, ..ModeCondition::default() };
    assert!(!craft.starter_modes());
}
