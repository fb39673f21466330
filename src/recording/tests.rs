//! Whole recordings: written, read, damaged, flown again.

use std::io::{self, Read as _};

use super::fingerprint::FlightPrint;
use super::*;
use crate::flight::FlightSetup;
use crate::plan::builtin::BuiltinPlan;
use crate::signals::{RcFrame, RcSource, SimTime};
use crate::timeline::Shown;
use crate::vehicle::{Vehicle, VehicleCommand};

/// A flight of the built-in `land` whose craft gets its plan and its pilot as inputs.
struct Recorded {
    bytes: Vec<u8>,
    vehicle: Vehicle,
    print: FlightPrint,
}

fn header() -> Header {
    let text = |text: &str| text.to_owned();
    Header { format: FORMAT, program: text("0.1.0"), date: text("2026-05-09T07:29:33Z"), plan: text("land") }
}

fn setup() -> FlightSetup {
    FlightSetup { plan: BuiltinPlan::find("land").unwrap().read().unwrap(), ..FlightSetup::default() }
}

fn record(seconds: u64, mut happen: impl FnMut(u64, &mut Vehicle)) -> Recorded {
    let setup = setup();
    let mut writer = Writer::new(header());
    writer.setup(&Setup::from(&setup));
    writer.begin(SimTime::ZERO);
    let plan = setup.plan.plan.clone();
    let (mut vehicle, _) = setup.build().unwrap();
    vehicle.keep_inputs(true);
    let (mut print, mut cadence) = (FlightPrint::default(), Cadence::default());
    let mut bytes = Vec::new();
    for tick in 0..seconds * 1000 {
        if tick == 5 {
            let _reported = vehicle.apply(&VehicleCommand::upload(plan.clone(), Vec::new()));
            vehicle.apply(&VehicleCommand::StartPilot(5.0)).accepted().unwrap();
        }
        happen(tick, &mut vehicle);
        let at = vehicle.time();
        vehicle.take_inputs(|input| writer.input(at, &input));
        vehicle.tick();
        vehicle.drain_events(|event| writer.event(&event.into()));
        if let Some(seen) = cadence.due(&vehicle) {
            print.add(vehicle.time(), seen.print.unwrap());
            writer.picture(seen);
        }
        if tick % 1000 == 999 {
            bytes.extend(writer.flush());
        }
    }
    let end = End {
        t: vehicle.time(),
        result: "complete".to_owned(),
        reason: "done".to_owned(),
        flown_s: 1.5,
        hash: Some(print.text()),
    };
    bytes.extend(writer.finish(end));
    Recorded { bytes, vehicle, print }
}

fn read(bytes: &[u8]) -> Recording {
    Recording::read(bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn repeat(recording: &Recording) -> Repeat<'_> {
    let mut repeat = Repeat::new(recording, recording.flight().unwrap()).unwrap();
    while !repeat.is_over() {
        repeat.prepare();
        repeat.tick(drop);
    }
    repeat
}

/// Returns every byte of the end of a file, and some of what is before: most of that is the setup.
fn sampled(length: usize) -> impl Iterator<Item = usize> {
    (0..length).filter(move |at| at % 41 == 0 || at + 600 > length)
}

#[test]
fn a_recording_flies_again_to_the_last_bit() {
    // RC of a script, a fault, a line and a change of the air between two ticks.
    let recorded = record(20, |tick, vehicle| match tick {
        12_000..13_000 if tick % 20 == 0 => {
            let mut frame = RcFrame::SAFE;
            frame.channels[0] += (tick % 100) as u16;
            let _reported = vehicle.apply(&VehicleCommand::Rc(frame, RcSource::Udp));
        }
        10_000 => {
            let _reported = vehicle.apply(&VehicleCommand::single_line("set ap_max_angle = 20"));
            vehicle
                .apply(&VehicleCommand::from(crate::sim::WorldCommand::parse("wind=3.1@270").unwrap()))
                .accepted()
                .unwrap();
        }
        _ => {}
    });
    let recording = read(&recorded.bytes);
    assert_eq!((recording.rest, recording.left_out, recording.notices()), (Rest::Whole, 0, Vec::new()));
    assert_eq!(recording.end.as_ref().unwrap().hash, Some(recorded.print.text()));
    assert!(recording.inputs.len() > 50 && recording.events.len() > 10);
    let repeat = repeat(&recording);
    assert_eq!(repeat.differs(), None);
    let (vehicle, timeline) = repeat.finish();
    assert_eq!(vehicle.truth(), recorded.vehicle.truth());
    assert_eq!(vehicle.snapshot(), recorded.vehicle.snapshot());
    let mut timeline = timeline.unwrap();
    assert_eq!(timeline.show(SimTime(8_000_000), vehicle.time()), Shown::Earlier);
    let flight = timeline.recorded_flight(vehicle.time()).unwrap();
    assert_eq!((flight.start.time(), flight.inputs.len()), (SimTime::ZERO, recording.inputs.len()));
}

#[test]
fn a_picture_shows_what_the_snapshot_showed() {
    let recorded = record(15, |_, _| {});
    let recording = read(&recorded.bytes);
    let pictures = recording.pictures.all();
    // One a second until the pilot flies, then ten.
    assert!((130..=150).contains(&pictures.len()), "{}", pictures.len());
    let last = recording.pictures.at(SimTime(u64::MAX)).unwrap();
    assert_eq!(last.time(), recorded.vehicle.time());
    let (shown, real) = (last.snapshot(), recorded.vehicle.snapshot());
    assert_eq!(shown.stored_plan, real.stored_plan);
    assert_eq!(shown.active_plan, real.active_plan);
    assert_eq!(shown.craft.mode_ranges, real.craft.mode_ranges);
    assert_eq!((shown.craft.modes, shown.craft.channels), (real.craft.modes, real.craft.channels));
    let (truth, real_truth) = (shown.truth.unwrap(), real.truth.unwrap());
    assert!((truth.n - real_truth.n).abs() < 1e-4 && (truth.alt - real_truth.alt).abs() < 1e-4);
    assert!((truth.lat_deg - real_truth.lat_deg).abs() < 1e-8);
    let (nav, real_nav) = (shown.nav.unwrap(), real.nav.unwrap());
    assert_eq!((nav.state, nav.wp, nav.guards.len()), (real_nav.state, real_nav.wp, real_nav.guards.len()));
    assert_eq!(recording.pictures.at(SimTime(10_050_000)).unwrap().time(), SimTime(10_000_000));
    assert_eq!(recording.pictures.at(SimTime::ZERO).unwrap().time(), pictures[0].time());
}

#[test]
fn a_recording_that_flies_differently_says_from_when_on() {
    let recorded = record(8, |_, _| {});
    let mut recording = read(&recorded.bytes);
    recording.inputs.retain(|(at, _)| at.0 < 5_000);
    let differs = repeat(&recording).differs().unwrap();
    assert!((100_000..8_000_000).contains(&differs.0), "{differs:?}");
}

#[test]
fn what_was_left_by_flying_on_from_an_earlier_instant_is_forgotten() {
    let mut writer = Writer::new(header());
    writer.setup(&Setup::from(&setup()));
    let (mut vehicle, _) = setup().build().unwrap();
    let mut see = |writer: &mut Writer, until: u64| {
        while vehicle.time().0 < until {
            vehicle.tick();
            if vehicle.time().0.is_multiple_of(1_000_000) {
                writer.picture(Seen::of(&vehicle));
            }
        }
    };
    writer.input(SimTime(10_000), &VehicleCommand::ReturnHome);
    see(&mut writer, 3_000_000);
    writer.input(SimTime(2_500_000), &VehicleCommand::CancelReturn);
    writer.event(&RecordedEvent { time: SimTime(2_600_000), what: Happened::Notice("left".to_owned()) });
    writer.branch(SimTime(1_500_000), 1);
    writer.input(SimTime(1_500_000), &VehicleCommand::CliOpened);
    let bytes = writer.finish(End { t: SimTime(2_000_000), ..End::default() });
    let recording = read(&bytes);
    let inputs: Vec<_> = recording.inputs.iter().map(|(at, input)| (at.0, input.clone())).collect();
    assert_eq!(inputs, [(10_000, VehicleCommand::ReturnHome), (1_500_000, VehicleCommand::CliOpened)]);
    assert_eq!(recording.pictures.all().len(), 1);
    assert_eq!(recording.events, []);
    assert_eq!(recording.end_time(), SimTime(2_000_000));
}

#[test]
fn a_recording_cut_anywhere_is_read_up_to_its_last_whole_line() {
    let recorded = record(3, |_, _| {});
    let whole = read(&recorded.bytes);
    let mut before = 0;
    let mut readable = 0;
    for cut in sampled(recorded.bytes.len()) {
        match Recording::read(&recorded.bytes[..cut]) {
            Ok(part) => {
                readable += 1;
                let pictures = part.pictures.all();
                assert!(pictures.len() >= before, "{cut}");
                before = pictures.len();
                assert_eq!(pictures, &whole.pictures.all()[..pictures.len()], "{cut}");
                assert_eq!(part.events, whole.events[..part.events.len()], "{cut}");
                assert_eq!(part.inputs, whole.inputs[..part.inputs.len()], "{cut}");
                assert!(
                    part.end.is_none() || part.end == whole.end && cut + 16 >= recorded.bytes.len(),
                    "{cut}"
                );
            }
            Err(error) => {
                assert!(matches!(error, ReadError::NoRecording | ReadError::Empty), "{cut}: {error}");
            }
        }
    }
    assert_eq!(before, whole.pictures.all().len(), "the end is a member of its own");
    assert!(readable > 600, "{readable}");
    let part = read(&recorded.bytes[..recorded.bytes.len() - 100]);
    assert_eq!(part.notices(), ["The recording ends early: it was cut short."]);
    assert_eq!(repeat(&part).differs(), None, "what is there can be flown again");
}

#[test]
fn a_damaged_byte_never_changes_what_is_read() {
    let recorded = record(3, |_, _| {});
    let whole = read(&recorded.bytes);
    for at in sampled(recorded.bytes.len()) {
        let mut bytes = recorded.bytes.clone();
        bytes[at] ^= 1 << (at % 8);
        if let Ok(part) = Recording::read(&bytes[..]) {
            let (pictures, inputs) = (part.pictures.all(), &part.inputs);
            assert_eq!(pictures, &whole.pictures.all()[..pictures.len()], "{at}");
            assert_eq!(*inputs, whole.inputs[..inputs.len()], "{at}");
        }
    }
}

#[test]
fn parts_written_apart_are_one_recording() {
    let mut bytes = Writer::new(header()).flush();
    let mut inputs = Writer::part();
    inputs.setup(&Setup::from(&setup()));
    inputs.input(SimTime(1000), &VehicleCommand::CliOpened);
    bytes.extend(inputs.flush());
    inputs.input(SimTime(2000), &VehicleCommand::CliClosed);
    bytes.extend(inputs.end_part());
    let mut rest = Writer::part();
    rest.begin(SimTime(2000));
    bytes.extend(rest.flush());
    rest.input(SimTime(3000), &VehicleCommand::ResetCraft);
    bytes.extend(rest.finish(End::default()));
    let recording = read(&bytes);
    assert_eq!((recording.inputs.len(), recording.begin, recording.rest), (3, SimTime(2000), Rest::Whole));
    assert_eq!(recording.end, Some(End::default()));
}

#[test]
fn a_list_needs_only_the_first_and_the_last_bytes() {
    let mut armed_s = None;
    let recorded = record(12, |tick, vehicle| {
        if vehicle.controller().is_armed() {
            armed_s.get_or_insert(tick as f64 / 1000.0);
        }
    });
    let bytes = &recorded.bytes[..];
    let tail = &bytes[bytes.len().saturating_sub(TAIL)..];
    let summary = read_summary(&bytes[..1000], tail).unwrap();
    assert_eq!(summary.header, header());
    assert_eq!(summary.end.as_ref().unwrap().result, "complete");
    assert!((summary.flown_s() - 1.5).abs() < 1e-9);
    let cut = &bytes[..bytes.len() - 1];
    let unfinished = read_summary(cut, cut).unwrap();
    assert_eq!((unfinished.header, unfinished.end), (header(), None));
    // The time of a flight counts from the arming.
    assert!((seen_s(cut).unwrap() - (12.0 - armed_s.unwrap())).abs() < 0.2);
    assert!(matches!(read_summary(b"GPS", b""), Err(ReadError::NoRecording)));
}

#[test]
fn a_later_format_is_refused_and_a_later_line_is_left_out() {
    let later = Writer::new(Header { format: FORMAT + 1, ..header() }).finish(End::default());
    let error = Recording::read(&later[..]).unwrap_err().to_string();
    assert_eq!(error, "a later version of betadeck wrote it (format 2, this one reads 1)");
    let recorded = record(2, |_, _| {});
    let mut text = String::new();
    flate2::read::MultiGzDecoder::new(&recorded.bytes[..]).read_to_string(&mut text).unwrap();
    let with = |line: &str| {
        let text = text.replacen('\n', &format!("\n{line}\n"), 1);
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        io::Write::write_all(&mut encoder, text.as_bytes()).unwrap();
        read(&encoder.finish().unwrap())
    };
    let recording = with("{\"later\":{\"x\":1}}");
    assert_eq!((recording.left_out, recording.only_pictures()), (1, None));
    assert_eq!(
        recording.notices(),
        ["Lines of the recording that are not known or too many are left out: 1."]
    );
    let recording = with("{\"input\":[1000,{\"later\":1}]}");
    assert_eq!(recording.only_pictures().unwrap(), "another version of betadeck wrote it");
    let recording = with("{\"input\":[1000,{\"world\":\"wind=500@0\"}]}");
    assert!(recording.only_pictures().unwrap().starts_with("an input makes no sense: "));
}

#[test]
fn text_without_end_in_a_small_file_is_bounded() {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    let line = serde_json::to_string(&record::Record::Flight(header())).unwrap();
    io::Write::write_all(&mut encoder, format!("{line}\n").as_bytes()).unwrap();
    for _ in 0..40 {
        io::Write::write_all(&mut encoder, &vec![b' '; 1 << 20]).unwrap();
    }
    let bomb = encoder.finish().unwrap();
    assert!(bomb.len() < 100_000);
    assert!(matches!(Recording::read(&bomb[..]), Err(ReadError::Empty)));
}

#[test]
fn the_lines_of_stored_recordings_keep_their_names() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/corpus/recording/");
    for name in ["every-input.txt", "unusual-start.txt", "events.txt", "pictures.txt", "in-flight.txt"] {
        let text = std::fs::read(format!("{folder}{name}")).unwrap();
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        io::Write::write_all(&mut encoder, &text).unwrap();
        let recording = read(&encoder.finish().unwrap());
        assert_eq!(recording.left_out, 0, "{name}");
        if name.contains("start") || name.contains("input") {
            assert_eq!(recording.flight().map(drop), Ok(()), "{name}");
        }
    }
    let recording = read(&std::fs::read(format!("{folder}short.flight")).unwrap());
    assert_eq!((recording.left_out, recording.rest, recording.only_pictures()), (0, Rest::Whole, None));
}
