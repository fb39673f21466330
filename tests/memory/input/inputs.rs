//! The memory and work that hostile input can cause. Both are bounded for a line, a file and a stream,
//! whatever is in it.

use std::time::Duration;

use crate::meter::{Taken, measured};
use betadeck::firmware::cli::{
    COMMANDS, CliContext, CliFacts, CliMode, Interpreter, MAX_LINE, apply_lines, complete, hint, provision,
};
use betadeck::firmware::config::{Configuration, KeptLine};
use betadeck::firmware::settings::Scope;
use betadeck::firmware::storage::{MAX_IMAGE, decode, encode};
use betadeck::link::proto::command_line::{Completion, LineReply};
use betadeck::link::proto::line_editor::LineEditor;
use betadeck::link::proto::serial_session::{OUTPUT_MAX, SerialRequest, SerialSession};
use betadeck::msp::{Decoder, MAX_REPLY, MAX_REQUEST};
use betadeck::plan::MAX_WAYPOINTS;
use betadeck::plan::format::{Format, parse, read_features, report};
use betadeck::scenario::{BuiltinFiles, read};
use betadeck::sim::Airframe;

const KIB: usize = 1 << 10;
const MIB: usize = 1 << 20;
/// The most that one line may take.
const LINE: Taken = Taken { peak: MIB, total: MIB };
/// The length of a long input, bytes.
const LONG: usize = 10_000_000;
/// The most bytes that a door takes at once.
const CHUNK: usize = 64 * KIB;

fn assert_within(taken: Taken, bound: Taken, what: &str) {
    let what: String = what.chars().take(80).collect();
    assert!(taken.peak <= bound.peak && taken.total <= bound.total, "{what}: {taken:?}");
}

/// Returns every file of a corpus as text.
fn texts(corpus: &str) -> Vec<String> {
    let folder = test_support::path("tests/corpus").join(corpus);
    let files = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    files.map(|file| String::from_utf8_lossy(&std::fs::read(file).expect("a file")).into_owned()).collect()
}

/// Runs one line, completes it and hints at it.
fn assert_line_within(line: &str, interpreter: &mut Interpreter, configuration: &mut Configuration) {
    let facts = CliFacts::default();
    let (_, taken) = measured(|| {
        interpreter.run(line, &mut CliContext { configuration: &mut *configuration, facts: &facts })
    });
    assert_within(taken, LINE, line);
    let (_, taken) = measured(|| (complete(line), hint(line, Some(&configuration.settings))));
    assert_within(taken, LINE, line);
}

#[test]
fn the_meter_measures() {
    let (kept, taken) = measured(|| {
        drop(std::hint::black_box(Vec::<u8>::with_capacity(1000)));
        std::hint::black_box(Vec::<u8>::with_capacity(300))
    });
    assert_eq!(taken, Taken { peak: 1000, total: 1300 });
    let (_, taken) = measured(|| drop(kept));
    assert_eq!(taken, Taken::default());
}

#[test]
fn stored_lines() {
    for text in [texts("cli"), texts("settings_file")].concat() {
        for mode in [CliMode::Interactive, CliMode::Framed, CliMode::Message, CliMode::File] {
            let (mut interpreter, mut configuration) = (Interpreter::new(mode), Configuration::default());
            for line in text.lines() {
                assert_line_within(line, &mut interpreter, &mut configuration);
            }
        }
    }
}

/// Returns a craft on which everything is as long as possible.
fn fullest() -> Configuration {
    let mut configuration = Configuration::default();
    let mut interpreter = Interpreter::new(CliMode::File);
    let facts = CliFacts::default();
    let mut context = CliContext { configuration: &mut configuration, facts: &facts };
    for index in 0..MAX_WAYPOINTS {
        let line = format!(
            "waypoint insert {index} -40.4636801 -179.5182000 -2147483648 65535 ALT_CHANGE 65535 FIGURE8"
        );
        assert!(!interpreter.run(&line, &mut context).failed);
    }
    let mut stored = 0;
    while interpreter
        .run(&format!("led {stored} {}", "x".repeat(MAX_LINE - 10)), &mut context)
        .text
        .contains("kept")
    {
        stored += 1;
    }
    assert!(stored > 200, "{stored}");
    // Short lines need more memory beyond their text.
    while interpreter.run(&format!("vtx {stored}"), &mut context).text.contains("kept") {
        stored += 1;
    }
    configuration
}

#[test]
fn every_command_on_the_fullest_craft() {
    let full = fullest();
    for command in COMMANDS {
        for rest in ["", " all", " list", " bare", " hardware bare defaults all", " 0", " = ="] {
            let (mut configuration, mut interpreter) = (full.clone(), Interpreter::default());
            assert_line_within(&format!("{}{rest}", command.name), &mut interpreter, &mut configuration);
        }
    }
}

#[test]
fn one_endless_line() {
    let facts = CliFacts::default();
    for piece in ["x", " ", "\t", "#", "set ", "é", "a=", "waypoint insert 0 ", "led\t"] {
        let line = piece.repeat(LONG / piece.len());
        let mut configuration = Configuration::default();
        for mode in [CliMode::Interactive, CliMode::File] {
            let mut interpreter = Interpreter::new(mode);
            let mut context = CliContext { configuration: &mut configuration, facts: &facts };
            let (_, taken) = measured(|| interpreter.run(&line, &mut context));
            assert_within(taken, LINE, &line);
            let (_, taken) =
                measured(|| apply_lines([line.as_str()], &mut interpreter, &mut context, |_, _| ()));
            assert_within(taken, LINE, &line);
            let (_, taken) = measured(|| provision(&line, &mut interpreter, &mut context, |_| ()));
            assert_within(taken, LINE, &line);
        }
    }
}

#[test]
fn ten_megabytes_without_a_line_end_through_the_editor() {
    for opening in [b"#".as_slice(), b"\x02"] {
        for (byte, count) in
            [(b'x', LONG), (b' ', LONG / 20), (0, LONG / 20), (0xff, LONG / 20), (0x08, LONG / 20)]
        {
            let mut editor = LineEditor::default();
            editor.feed(opening[0], false, Duration::ZERO);
            editor.poll(false, Duration::from_millis(100));
            let ((), taken) = measured(|| {
                for _ in 0..count {
                    let output = editor.feed(byte, false, Duration::from_millis(200));
                    assert!(output.line.is_none());
                }
            });
            assert_within(taken, LINE, &format!("{byte}"));
            let line = editor.feed(b'\r', false, Duration::from_millis(200)).line;
            assert!(line.is_none_or(|line| line.len() <= MAX_LINE));
        }
    }
}

/// Returns bytes from a seed (xorshift).
fn noise(count: usize) -> Vec<u8> {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 32) as u8
    };
    (0..count).map(|_| next()).collect()
}

#[test]
fn ten_megabytes_of_garbage_through_the_decoders() {
    let noise = noise(LONG / 2);
    let almost: Vec<u8> =
        b"$M<\xff\x01\xff\xff$X>\0\x01\0\xff\x1f".iter().copied().cycle().take(LONG / 2).collect();
    for (mut decoder, limit) in [(Decoder::server(), MAX_REQUEST), (Decoder::client(), MAX_REPLY)] {
        let ((), taken) = measured(|| {
            for byte in noise.iter().chain(&almost) {
                if let Some(frame) = decoder.push(*byte) {
                    assert!(frame.payload.len() <= limit);
                }
            }
        });
        // One payload, and its new place while it grows.
        assert!(taken.peak <= 4 * limit, "{taken:?}");
    }
}

/// Measures the memory that a stream takes beyond the bytes read at once, when every line is answered with
/// `reply`.
fn stream(bytes: &[u8], reply: &LineReply) -> Taken {
    let mut session = SerialSession::default();
    let mut now = Duration::ZERO;
    measured(|| {
        session.push(b"#");
        assert!(session.next(now).is_none());
        now += Duration::from_millis(150);
        for chunk in bytes.chunks(CHUNK) {
            session.push(chunk);
            while let Some(ask) = session.next(now) {
                match ask {
                    SerialRequest::Msp(frame) => session.reply(&frame, Some(vec![0; MAX_REQUEST])),
                    SerialRequest::EnterCli { .. } => session.admit(true, now),
                    SerialRequest::Line { .. } => assert!(!session.answer(reply)),
                    SerialRequest::Complete { line } => {
                        let found = complete(&line);
                        let tail = found.tail(&line).to_owned();
                        session.complete(Completion { tail, words: found.candidates });
                    }
                    SerialRequest::Flush => drop(session.take_output()),
                    SerialRequest::Restart
                    | SerialRequest::LeftCli
                    | SerialRequest::Ignored { .. }
                    | SerialRequest::Foreign => {}
                }
            }
            drop(session.take_output());
        }
    })
    .1
}

#[test]
fn a_stream_takes_no_more_than_it_reads_at_once_and_an_answer() {
    let reply = LineReply { text: "x".repeat(CHUNK), ..LineReply::default() };
    let noise = noise(LONG / 10);
    let long_line = vec![b'x'; LONG];
    let tabs: Vec<u8> = b"set ".iter().copied().chain(std::iter::repeat_n(b'\t', 20_000)).collect();
    let lines = b"a\r".repeat(5_000);
    let requests = b"$M<\0\x01\x01".repeat(100_000);
    for (what, bytes) in [
        ("noise", noise),
        ("a long line", long_line),
        ("tabs", tabs),
        ("lines", lines),
        ("requests", requests),
    ] {
        let taken = stream(&bytes, &reply);
        // Input and output may move while they grow, and an answer exists twice while it is queued.
        let bound = 3 * CHUNK + 3 * (OUTPUT_MAX + 2 * CHUNK);
        assert!(taken.peak <= bound, "{what}: {taken:?}, allowed {bound}");
    }
}

/// Returns an image of these records.
fn sealed(records: &str) -> Vec<u8> {
    let mut image = b"BDCF\x01\x00\x00\x00".to_vec();
    image.extend((records.len() as u32).to_le_bytes());
    image.extend(records.as_bytes());
    image.extend(crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&image).to_le_bytes());
    image
}

#[test]
fn the_largest_images_of_one_kind_of_record() {
    let room = MAX_IMAGE - 16;
    for record in [
        "\t",
        "x",
        "x\n",
        "mix\n",
        "mix\tx\n",
        "setting\t",
        "mode\t",
        "board\t",
        "kept\tmaster\t0\t\tx",
        "kept\tmaster\t0\t\tled 0\n",
        "waypoint\t0\t0\t0\t0\t0\t0\t0\n",
        "board\tx\n",
        "setting\tcraft_name\tx\n",
    ] {
        let image = sealed(&record.repeat(room / record.len()));
        assert!(image.len() <= MAX_IMAGE);
        let (decoded, taken) = measured(|| decode(&image));
        let (configuration, findings) = decoded.expect("a good checksum");
        assert!(taken.peak <= MIB, "{record:?}: {taken:?}");
        assert!(findings.len() <= 30 && findings.iter().all(|finding| finding.len() < 200), "{findings:?}");
        let again = encode(&configuration);
        assert_eq!(decode(&again), Ok((configuration, Vec::new())), "{record:?}");
    }
    // One record that fills the image is one line.
    for record in ["\t", "x", "setting\t", "mode\t", "board\tx"] {
        let image = sealed(&record.repeat(room / record.len()));
        let empty = measured(|| decode(&sealed(""))).1;
        let taken = measured(|| decode(&image)).1;
        assert!(taken.total <= empty.total + MIB, "{record:?}: {taken:?}");
    }
}

#[test]
fn files_with_as_many_problems_as_fit() {
    const SIZE: usize = 1 << 17;
    /// Bytes of a syntax tree for each byte of TOML, a little more than the parser needs for a list of
    /// digits.
    const TREE: usize = 128;
    /// The same for text. Only waypoints, counts and some problems are kept.
    const TEXT: usize = 8;
    let list =
        |open: &str, item: &str, close: &str| format!("{open}{}{close}", item.repeat(SIZE / item.len()));
    let numbered = |open: &str, close: &str| {
        let items: String = (0..SIZE / 12).map(|at| format!("k{at}=1{close}")).collect();
        format!("{open}{items}")
    };
    let texts = [
        list("settings = [", "5,", "]"),
        list("waypoint = [", "5,", "]"),
        numbered("home = {", ",") + "}",
        numbered("battery = {", ",") + "}",
        numbered("", "\n"),
        list("", "[[waypoint]]\n", ""),
        list("", "waypoint insert 0\n", ""),
        list("", "waypoint insert 0 1 2 3 0 LAND 0 NONE\n", ""),
        list("waypoint insert", " x", ""),
        list("waypoint ", "x", ""),
        list("", "x", ""),
        list("", "waypont\n", ""),
        list("name = ", "[", ""),
        list("", "\"", ""),
    ];
    for text in texts {
        let start: String = text.chars().take(30).collect();
        for format in [Format::Toml, Format::CliText] {
            let (result, taken) = measured(|| parse("file", &text, format));
            let factor = if format == Format::Toml { TREE } else { TEXT };
            assert!(taken.peak <= factor * text.len(), "{format} {start}: {taken:?}");
            if let Err(errors) = result {
                let shown = report(&errors);
                assert!(shown.len() <= 200 * KIB, "{format} {start}: {} bytes", shown.len());
            }
        }
        let (result, taken) = measured(|| Airframe::from_toml(&text));
        assert!(taken.peak <= TREE * text.len(), "airframe {start}: {taken:?}");
        let shown = result.expect_err("no airframe").to_string();
        assert!(shown.len() <= 200 * KIB, "airframe {start}: {} bytes", shown.len());
    }
}

#[test]
fn a_plan_of_four_megabytes_costs_at_most_sixty_four() {
    const SIZE: usize = 4 * MIB;
    for item in
        ["[[waypoint]]\n", "5,", "waypoint insert 0\n", "x", "waypoint insert 0 1 2 3 0 LAND 0 NONE\n"]
    {
        let text = item.repeat(SIZE / item.len());
        for format in [Format::Toml, Format::CliText] {
            let (_, taken) = measured(|| parse("file", &text, format).map_err(|errors| report(&errors)));
            assert!(taken.peak <= 64 * MIB, "{format} {item}: {taken:?}");
        }
    }
}

#[test]
fn lines_of_other_builds_find_an_end() {
    let mut configuration = Configuration::default();
    let mut kept = 0;
    let ((), taken) = measured(|| {
        for at in 0..20_000 {
            let line = KeptLine {
                scope: Scope::Master,
                instance: 0,
                name: String::new(),
                text: format!("led {at}"),
            };
            kept += usize::from(configuration.kept.keep(line));
        }
    });
    assert!((1000..5000).contains(&kept), "{kept}");
    assert!(taken.peak <= 2 * MIB, "{taken:?}");
}

#[test]
fn scenarios_that_unfold_to_more_than_is_allowed() {
    let head = "format = 1\nseeds = '1..10000'\n[plan]\nbuiltin = 'square'\n[air]\nnoise = 'real'\n";
    let cases =
        |count: usize| (0..count).map(|number| format!("[[case]]\nname = 'c{number}'\n")).collect::<String>();
    let expectations: String =
        (0..600).map(|number| format!("[[expect]]\nmax = 'altitude <= {number} m'\n")).collect();
    let seeds =
        format!("seeds = [{}]\n{}", vec!["1"; 150_000].join(","), head.replace("seeds = '1..10000'\n", ""));
    let sum = format!("[[expect]]\nmax = '{} <= 9 m'\n", vec!["east"; 12_000].join(" + "));
    for (what, text, most) in [
        ("600 cases with 600 expectations", format!("{head}{expectations}{}", cases(600)), 8 * MIB),
        ("150 000 seeds", seeds, 64 * MIB),
        ("100 cases with 10 000 seeds", format!("{head}{}", cases(100)), 8 * MIB),
        ("12 000 terms", format!("{head}{sum}"), 8 * MIB),
    ] {
        let (problems, taken) = measured(|| read("s.toml", &text, None, &mut BuiltinFiles).err());
        assert!(problems.is_some(), "{what} is read");
        assert!(taken.peak <= most, "{what}: {taken:?}");
        // Refused data is not created and dropped again and again.
        assert!(taken.total <= 32 * most, "{what}: {taken:?}");
    }
}

/// A map takes at most four times its size with its text.
#[test]
fn maps() {
    let repeated = |head: &str, part: &str, tail: &str| {
        let count = 4 * MIB / part.len();
        format!("{head}{}{tail}", part.repeat(count))
    };
    let texts = [
        repeated(
            "<kml><Placemark><LineString><coordinates>",
            "1,2 ",
            "</coordinates></LineString></Placemark></kml>",
        ),
        repeated("<gpx><trk><trkseg>", "<trkpt lat='1' lon='2'/>", "</trkseg></trk></gpx>"),
        repeated("{\"type\":\"LineString\",\"coordinates\":[", "[8.55,47.37],", "[1,2]]}"),
        repeated("<kml>", "\n", "</kml>"),
        repeated("{\"type\":\"Feature\",\"properties\":{\"name\":\"", "x", "\"},\"geometry\":null}"),
    ];
    for text in &texts {
        let (features, taken) = measured(|| read_features("map", text.as_bytes()));
        assert!(features.is_ok(), "{}", &text[..60]);
        assert!(taken.peak < 3 * text.len() + 64 * KIB, "{}: {taken:?} of {}", &text[..60], text.len());
    }
    let text = repeated("{\"type\":\"MultiPoint\",\"coordinates\":[", "[1,2],", "[1,2]]}");
    let (features, taken) = measured(|| read_features("map", text.as_bytes()));
    assert!(features.is_err() && taken.peak < 24 * MIB, "{taken:?}");
}
