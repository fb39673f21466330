//! The recorded exchanges of `tests/vectors/cli.md`, byte for byte.

mod parse;

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::time::Duration;

use betadeck::firmware::cli::{
    CliAction, CliContext, CliFacts, CliMode, GpsFacts, GpsSolutionFacts, Interpreter, LoopFacts, TaskFacts,
    complete,
};
use betadeck::firmware::config::Configuration;
use betadeck::geo::LatLon;
use betadeck::link::proto::command_line::Completion;
use betadeck::link::proto::line_editor::{LineEditor, LinkMode};
use betadeck::telemetry::{ArmingFlag, ArmingFlags, NavState, NavTelemetry};
use parse::{Exchange, assert_matches, exchanges};

/// A craft with a command line session.
struct Bench {
    configuration: Configuration,
    facts: CliFacts,
    interpreter: Interpreter,
}

impl Bench {
    fn new() -> Self {
        let mut facts = CliFacts {
            uptime_s: 3,
            arming_blocks: [ArmingFlag::RxLoss, ArmingFlag::Angle, ArmingFlag::BootGrace, ArmingFlag::Cli]
                .into_iter()
                .collect(),
            loops: LoopFacts {
                cpu_load_percent: 0,
                cycle_time_us: 1211,
                gyro_hz: 826,
                rx_hz: 0,
                system_hz: 10,
            },
            ..CliFacts::default()
        };
        facts.storage.used_bytes = 3650;
        Self { configuration: Configuration::default(), facts, interpreter: Interpreter::default() }
    }

    fn run(&mut self, line: &str) -> betadeck::firmware::cli::CliReply {
        let mut context = CliContext { configuration: &mut self.configuration, facts: &self.facts };
        self.interpreter.run(line, &mut context)
    }

    fn text(&mut self, line: &str) -> String {
        self.run(line).text
    }
}

fn all() -> BTreeMap<usize, Exchange> {
    exchanges(include_str!("../../vectors/cli.md"))
        .into_iter()
        .map(|exchange| (exchange.number, exchange))
        .collect()
}

/// Returns the product's answer where it deliberately differs from the reference.
fn product_answer(number: usize) -> Option<&'static str> {
    Some(match number {
        62 => "craft_name set to test craft",
        71 => "aux 3 1 2 1700 2100 0 0\r\n",
        74 => "###ERROR IN aux: MODE ID NOT KNOWN: 99###\r\n",
        75 => "###ERROR IN aux: CHANNEL NOT BETWEEN 0 AND 13###\r\n",
        77 => "###ERROR IN aux: INVALID ARGUMENT COUNT###\r\n",
        230 => "serial UART1 64 115200 57600 0 115200\r\n",
        _ => return None,
    })
}

/// The recorded sessions, run in one go.
const SESSIONS: RangeInclusive<usize> = 1..=217;
/// The exchanges of these that a session on one craft cannot hold: a line whose setting is kept here and
/// would show in the later dumps, and a byte that only a link understands. Each has its own test.
const NOT_IN_A_SESSION: [usize; 2] = [64, 216];
/// The firmware's messages in flight.
const IN_FLIGHT: RangeInclusive<usize> = 218..=221;
/// Single lines, each run on the craft that the one before left.
const SINGLE_LINES: [usize; 21] =
    [222, 223, 224, 225, 226, 227, 228, 229, 230, 244, 245, 246, 247, 248, 249, 250, 251, 237, 239, 240, 241];
const BATCHES: RangeInclusive<usize> = 231..=236;
/// The exchanges that need a link.
const ON_A_LINK: [usize; 3] = [216, 242, 243];
/// The exchanges that need their own craft.
const ON_THEIR_OWN: [usize; 5] = [64, 238, 252, 253, 254];

/// Checks that every exchange of the document belongs to a test.
#[test]
fn no_exchange_is_left_out() {
    let mut tested: Vec<usize> = SESSIONS.filter(|number| !NOT_IN_A_SESSION.contains(number)).collect();
    tested.extend(IN_FLIGHT.chain(BATCHES));
    tested.extend(SINGLE_LINES.into_iter().chain(ON_A_LINK).chain(ON_THEIR_OWN));
    tested.sort_unstable();
    assert_eq!(tested, all().into_keys().collect::<Vec<_>>());
}

/// Checks the exchanges whose answer is this program's own, with the reason.
#[test]
fn the_products_own_answers_stand() {
    let all = all();
    // Settings of other builds are kept and not refused.
    assert_eq!(Bench::new().text(&all[&64].input), "# pilot_name: not used by this vehicle, kept\r\n");
    // Groups have numbers only in the reference's storage. Storage here uses names.
    let refusal = "###ERROR IN defaults: GROUPS HAVE NO NUMBERS HERE, USE 'defaults nosave'###\r\n";
    assert_eq!(Bench::new().text(&all[&238].input), refusal);
    let mut fresh = Bench::new();
    fresh.text("defaults nosave");
    assert_matches(&all[&253], &fresh.text(&all[&253].input));
}

#[test]
fn the_guides_plan_is_listed_as_it_was_typed() {
    let exchange = &all()[&254];
    let mut bench = Bench::new();
    for line in include_str!("../../vectors/guide-step7.txt").lines() {
        assert!(!bench.run(line).failed, "{line}");
    }
    assert_matches(exchange, &bench.text(&exchange.input));
}

#[test]
fn what_only_a_link_knows_is_reproduced() {
    let all = all();
    let in_cli = || {
        let mut editor = LineEditor::default();
        editor.feed(b'#', false, Duration::ZERO);
        editor.poll(false, Duration::from_secs(1)).expect("a greeting");
        editor
    };
    let mut editor = in_cli();
    let output = editor.feed(4, false, Duration::ZERO);
    assert_matches(&all[&216], &String::from_utf8(output.bytes).expect("ASCII"));
    assert!(output.restart && editor.mode() == LinkMode::Msp);

    let mut bench = Bench::new();
    let sent = link(&mut bench, &mut in_cli(), b"wa\t");
    assert_matches(&all[&242], sent.strip_prefix("wa").expect("the echo"));

    bench.interpreter = Interpreter::new(CliMode::Framed);
    let sent = link(&mut bench, &mut LineEditor::default(), b"\x02foo\n\x03");
    let reply = sent.strip_prefix('\x02').and_then(|sent| sent.strip_suffix('\x03'));
    assert_matches(&all[&243], reply.expect("a reply between STX and ETX"));
}

/// Removes parts of dumps that the reference prints because of its quirks.
fn without_quirks(exchange: &Exchange) -> Exchange {
    let mut exchange = exchange.clone();
    for quirk in [
        &["", "# feature", "feature -TELEMETRY", "#feature TELEMETRY"][..],
        &["", "# feature", "feature -TELEMETRY"],
        &["", "# rxfail", "#rxfail 5 h", "rxfail 5 h"],
        &["", "# rxfail", "rxfail 5 h"],
    ] {
        let at = exchange
            .lines
            .windows(quirk.len())
            .position(|window| window.iter().zip(quirk).all(|(a, b)| a.text == *b));
        if let Some(at) = at {
            exchange.lines.drain(at..at + quirk.len());
        }
    }
    exchange
}

/// Runs the sessions A to E from the first line to the last on one craft.
#[test]
fn recorded_sessions_are_reproduced() {
    let all = all();
    let mut bench = Bench::new();
    bench.facts.tasks = task_facts(&all[&6]);
    for (number, exchange) in all.range(SESSIONS) {
        match number {
            number if NOT_IN_A_SESSION.contains(number) => continue,
            79 => {
                bench.text("aux 3 0 0 900 900 0 0");
                bench.text("aux 4 0 0 900 900 0 0");
            }
            _ => {}
        }
        if *number == 7 {
            bench.facts.uptime_s = 4;
            bench.facts.loops = LoopFacts { cycle_time_us: 1000, gyro_hz: 1000, ..bench.facts.loops };
        }
        let mut reply = bench.run(&exchange.input);
        if *number == 1 {
            // This command exists only in this product.
            reply.text = reply.text.replace("reboot - restart without saving\r\n", "");
        }
        match product_answer(*number) {
            Some(answer) => assert_eq!(reply.text, answer, "exchange {number}"),
            None => assert_matches(&without_quirks(exchange), &reply.text),
        }
        if *number == 188 {
            for at in 1..30 {
                let step = |base: i32, step: i32| betadeck::geo::Degrees7(base + at * step);
                let (lat, lon) = (step(-275_000_000, 1000), step(1_530_000_000, 1000));
                bench
                    .text(&format!("waypoint insert {at} {lat} {lon} {} 500 flyover 0 none", 4000 + 10 * at));
            }
        }
        if *number == 212 {
            // The list of exchanges shows the dump of the reset craft last.
            assert_matches(&all[&217], &bench.text("diff all"));
        }
    }
}

/// Returns the figures of the recorded task table, so that the columns can be compared.
fn task_facts(table: &Exchange) -> Vec<TaskFacts> {
    const NAMES: [&str; 19] = [
        "SYSTEM",
        "SYSTEM",
        "GYRO",
        "FILTER",
        "PID",
        "ACC",
        "ATTITUDE",
        "RX",
        "SERIAL",
        "DISPATCH",
        "BATTERY_CURRENT",
        "BATTERY_ALERTS",
        "GPS",
        "GPS_RESCUE",
        "ALTHOLD",
        "POSHOLD",
        "COMPASS",
        "BARO",
        "ALTITUDE",
    ];
    let rows = table.lines.iter().filter(|line| line.text.contains(" - ("));
    rows.zip(NAMES)
        .map(|(row, name)| {
            assert!(row.text.contains(name));
            let number = |text: &str| text.trim().parse::<u32>().expect("a number");
            let columns: Vec<&str> = row.text[22..].split_ascii_whitespace().collect();
            TaskFacts {
                id: number(&row.text[..2]) as u8,
                name,
                rate_hz: number(columns[0]),
                max_us: number(columns[1]),
                avg_us: number(columns[2]),
                total_ms: number(columns[5]),
            }
        })
        .collect()
}

/// Runs exchanges that come from the reference source and apply here, and the product's own.
#[test]
fn other_exchanges_are_reproduced() {
    let all = all();
    let mut bench = Bench::new();
    for number in SINGLE_LINES {
        let reply = bench.text(&all[&number].input);
        match product_answer(number) {
            Some(answer) => assert_eq!(reply, answer, "exchange {number}"),
            None => assert_matches(&all[&number], &reply),
        }
        bench.text("profile 0");
    }
}

#[test]
fn batches_remember_their_errors() {
    let all = all();
    let mut bench = Bench::new();
    for number in [231, 232] {
        assert_matches(&all[&number], &bench.text(&all[&number].input));
    }
    let save = bench.run("save");
    assert_matches(&all[&233], &save.text);
    assert_eq!(save.actions, []);
    bench.text("batch start");
    bench.text("set nonsense = 1");
    assert_matches(&all[&234], &bench.text("batch end"));
    bench.text("batch start");
    bench.text("set nonsense = 1");
    bench.text("defaults nosave");
    assert_matches(&all[&235], &bench.text("batch end"));
    assert_matches(&all[&236], &bench.text("batch foo"));
}

#[test]
fn armed_craft_refuses_to_save() {
    let mut bench = Bench::new();
    bench.facts.armed = true;
    let reply = bench.run("save");
    assert_matches(&all()[&252], &reply.text);
    assert_eq!(reply.actions, []);
}

/// Session F: the firmware's messages in flight.
#[test]
fn flying_craft_is_reported() {
    let all = all();
    let mut bench = Bench::new();
    bench.interpreter = Interpreter::new(CliMode::Message);
    let home = LatLon::new(-275_000_000, 1_530_000_000);
    bench.facts.gps = GpsFacts::Connected(Some(GpsSolutionFacts {
        sats: 12,
        hdop: 0.0,
        vdop: 0.0,
        position: Some((home, 3000)),
    }));
    bench.facts.arming_blocks = ArmingFlags::NONE;
    bench.facts.uptime_s = 20;
    bench.facts.loops =
        LoopFacts { cycle_time_us: 1019, gyro_hz: 982, rx_hz: 50, system_hz: 10, ..Default::default() };
    assert_matches(&all[&218], &bench.text("status"));
    bench.text("waypoint insert 0 -27.4973051 153 4000 0 flyover 0 none");
    bench.facts.nav.telemetry = NavTelemetry {
        state: NavState::Approaching,
        engaged: true,
        wp: 0,
        count: 1,
        distance_m: Some(210.44),
        bearing_rad: Some(-1e-6),
        eta_s: Some(39.2),
        ..NavTelemetry::default()
    };
    let status = bench.text("waypoint status").replace("APPROACHING", "TARGETING");
    assert_matches(&all[&219], &status.replace("\r\n", "\n").replace('\n', "\r\n"));
    bench.facts.nav.telemetry.state = NavState::Complete;
    let status = bench.text("waypoint status");
    assert_matches(&all[&220], &status.replace("\r\n", "\n").replace('\n', "\r\n"));
    bench.facts.uptime_s = 49;
    bench.facts.loops = LoopFacts { cycle_time_us: 995, gyro_hz: 1005, ..bench.facts.loops };
    assert_matches(&all[&221], &bench.text("env"));
}

/// Feeds bytes to a link and runs the lines on the craft. Returns the bytes that the link sends.
fn link(bench: &mut Bench, editor: &mut LineEditor, bytes: &[u8]) -> String {
    let mut sent = Vec::new();
    for byte in bytes {
        let output = editor.feed(*byte, false, Duration::ZERO);
        sent.extend(output.bytes);
        if output.completes {
            let found = complete(editor.line());
            let completion =
                Completion { tail: found.tail(editor.line()).to_owned(), words: found.candidates };
            sent.extend(editor.complete(completion));
        }
        if let Some(line) = output.line {
            let reply = bench.run(&line);
            sent.extend(editor.answer(&reply.into()));
        }
    }
    String::from_utf8(sent).expect("ASCII")
}

#[test]
fn the_link_greets_echoes_and_completes() {
    let mut bench = Bench::new();
    let mut editor = LineEditor::default();
    assert_eq!(link(&mut bench, &mut editor, b"#"), "");
    assert_eq!(editor.poll(false, Duration::from_millis(99)), None);
    let greeting = editor.poll(false, Duration::from_millis(100)).expect("a greeting");
    assert_eq!(greeting, b"\r\nEntering CLI Mode, type 'exit' to reboot, or 'help'\r\n\r\n# ");
    assert_eq!(
        link(&mut bench, &mut editor, b"set ap_max_angle = 25\n"),
        "set ap_max_angle = 25\r\nap_max_angle set to 25\r\n# "
    );
    assert_eq!(link(&mut bench, &mut editor, b"wa\t"), "waypoint ");
    assert_eq!(link(&mut bench, &mut editor, b"list\r\n"), "list\r\nwaypoint clear\r\n\r\n# ");
    assert_eq!(link(&mut bench, &mut editor, b"# 0.123\n"), "# 0.123\r\n\r\n# ");
    assert_eq!(link(&mut bench, &mut editor, b"rx\t"), "rx\r\n\x1b[Krxfail\trxrange\t\r\n# rx");
    assert_eq!(link(&mut bench, &mut editor, b"f\x7fr?"), "f\x08 \x08range ");
    assert_eq!(link(&mut bench, &mut editor, b"\x0c"), "\x1b[2J\x1b[1;1H\r\n# ");
    assert_eq!(
        link(&mut bench, &mut editor, b"\n\x04"),
        "\r\nrxrange 0 1000 2000\r\nrxrange 1 1000 2000\r\nrxrange 2 1000 2000\r\nrxrange 3 1000 2000\r\n\r\n# \r\nRebooting"
    );
}

#[test]
fn framed_lines_have_no_echo() {
    let mut bench = Bench::new();
    bench.interpreter = Interpreter::new(CliMode::Framed);
    let mut editor = LineEditor::default();
    assert_eq!(link(&mut bench, &mut editor, b"\x02foo bar\n\x03"), "\x02ERR_CMD_NA: foo bar\r\n\x03");
    assert_eq!(link(&mut bench, &mut editor, b"\x02version\x03"), "\x02\x03");
    assert_eq!(link(&mut bench, &mut editor, b"\x02save\n\x03"), "\x02\r\n# saving\r\n\x03");
    let two = link(&mut bench, &mut editor, b"\x02waypoint clear\nwaypoint list\n\x03");
    assert_eq!(two, "\x02Waypoints cleared\r\nwaypoint clear\r\n\x03");
    assert_eq!(link(&mut bench, &mut editor, b"\x02"), "\x02");
    let late = editor.feed(b'v', false, Duration::from_millis(2001));
    assert_eq!(late.bytes, b"\x03");
}

#[test]
fn leaving_returns_the_link_to_msp() {
    for (line, closes) in
        [("exit noreboot", false), ("exit", true), ("save", true), ("defaults", true), ("bl", true)]
    {
        let mut bench = Bench::new();
        let mut editor = LineEditor::default();
        link(&mut bench, &mut editor, b"#");
        editor.poll(false, Duration::from_secs(1)).expect("a greeting");
        let text = link(&mut bench, &mut editor, format!("{line}\n").as_bytes());
        assert!(!text.ends_with("# "), "{line}: {text:?}");
        assert_eq!(editor.mode(), LinkMode::Msp, "{line}");
        let reply = bench.run(line);
        let restarts = reply.actions.contains(&CliAction::Restart { close_links: true });
        assert_eq!(restarts, closes, "{line}");
    }
}
