//! Whole logs as flights.

mod maker;
mod sticks;
mod units;

use std::io;

use super::{FailsafePhase, Indexer, LogFile, LogFlight, LogMarkKind, LogSample, LogSignal};
use crate::blackbox::AdjustedValue;
use crate::signals::SimTime;
use crate::telemetry::{DisarmReason, Mode, ModeBox};
use maker::{Maker, header};

fn file(bytes: &[u8]) -> LogFile {
    Indexer::new(bytes).run().unwrap()
}

fn only(bytes: &[u8]) -> LogFlight {
    let LogFile { mut flights, refused, left_out } = file(bytes);
    assert_eq!((refused.len(), left_out, flights.len()), (0, 0, 1));
    flights.remove(0)
}

fn at(flight: &LogFlight, bytes: &[u8], time_us: u64) -> LogSample {
    flight.sample(bytes, SimTime(time_us)).unwrap().unwrap()
}

/// Returns a log of `seconds` at 1 kHz whose gyro and barometer count, with a GPS frame and a slow frame a second.
fn long(seconds: u32) -> Vec<u8> {
    let mut maker = Maker::default();
    maker.begin(&header());
    maker.home(404_640_000, -795_175_000, 3000);
    for at in 0..seconds * 1000 {
        maker.main(at, 1_000_000 + at * 1000, at as i32 % 777, 10 * at as i32);
        if at % 1000 == 500 {
            let second = (at / 1000) as i32;
            maker.slow([1 | (second as u32 & 1) << 1, 3, 0, 1, 1]);
            maker.gps(
                1_000_000 + at * 1000,
                12,
                404_640_000 + 1000 * second,
                -795_175_000,
                3000 + second,
                500,
                900,
            );
        }
    }
    maker.end();
    maker.bytes
}

#[test]
fn any_instant_is_the_same_whether_it_is_read_in_order_or_at_once() {
    let bytes = long(20);
    let flight = only(&bytes);
    assert!(flight.blocks.len() > 50, "{}", flight.blocks.len());
    let mut cursor = flight.cursor(&bytes[..], SimTime::ZERO).unwrap().unwrap();
    let mut count = 0;
    loop {
        let time = cursor.time();
        // Not every one of them, for speed.
        if count % 37 == 0 {
            assert_eq!(format!("{:?}", at(&flight, &bytes, time.0 + 999)), format!("{:?}", cursor.sample()));
        }
        count += 1;
        if !cursor.advance().unwrap() {
            break;
        }
    }
    assert_eq!((count, flight.counts().main), (20_000, 20_000));
    assert_eq!((flight.first(), flight.last()), (SimTime(1_000_000), SimTime(20_999_000)));
    assert_eq!(at(&flight, &bytes, 0).time, flight.first());
    assert_eq!(at(&flight, &bytes, u64::MAX).time, flight.last());
}

#[test]
fn a_series_has_the_extents_of_its_parts_from_afar_and_near() {
    let bytes = long(20);
    let flight = only(&bytes);
    let altitude = flight.find("altitude").unwrap();
    let whole = SimTime(1_000_000)..SimTime(21_000_000);
    for parts in [10, 20] {
        let far = flight.series(&bytes[..], altitude, whole.clone(), parts).unwrap();
        assert_eq!(far.len(), parts);
        let share = 2000.0 / parts as f64;
        for (part, extent) in far.iter().enumerate() {
            let (extent, begin) = (extent.unwrap(), part as f64 * share);
            // A block has less than half a second.
            assert!((begin - 50.0..=begin).contains(&extent.min), "{part}: {extent:?}");
            assert!((begin + share - 0.1..=begin + share + 50.0).contains(&extent.max), "{part}: {extent:?}");
        }
    }
    let near = flight.series(&bytes[..], altitude, SimTime(2_000_000)..SimTime(2_010_000), 20).unwrap();
    let values: Vec<_> = near.iter().map(|extent| extent.map(|extent| (extent.min, extent.max))).collect();
    for (part, value) in values.iter().enumerate() {
        let expected = 100.0 + 0.1 * (part / 2) as f64;
        match value {
            Some((min, max)) if part % 2 == 0 => {
                assert!((min - expected).abs() < 1e-9 && (max - expected).abs() < 1e-9);
            }
            other => assert!(part % 2 == 1 && other.is_none(), "{part}"),
        }
    }
    let modes = flight.find("flightModeFlags").unwrap();
    let extents = flight.series(&bytes[..], modes, whole, 4).unwrap();
    assert!(extents.iter().all(|extent| extent.unwrap().max == 3.0));
}

#[test]
fn what_happens_is_marked() {
    let mut maker = Maker::default();
    maker.begin(&header()).event(&[0]).unsigned(900_000);
    maker.slow([1, 0, 0, 1, 1]).main(0, 1_000_000, 0, 0).main(1, 1_001_000, 0, 0);
    maker.event(&[30, 3, 1]).main(2, 1_002_000, 0, 0);
    maker.slow([3, 0, 0, 1, 1]).slow([3, 2, 1, 0, 0]).main(3, 1_003_000, 0, 0);
    maker.event(&[14]).unsigned(9000).unsigned(10_000_000).main(9000, 10_000_000, 0, 0);
    maker.event(&[13, 4, 6]).main(9001, 10_001_000, 0, 0).raw(b"xxxx").main(9002, 10_002_000, 0, 0);
    maker.event(&[15, 4]).end();
    let flight = only(&maker.bytes);
    let marks: Vec<(u64, String)> =
        flight.marks().iter().map(|mark| (mark.time.0, named(&mark.kind))).collect();
    let expected = [
        (1_000_000, "armed"),
        (1_001_000, "ARM -> ARM ANGLE"),
        (1_002_000, "RX_LOSS_DETECTED"),
        (1_002_000, "signal false"),
        (1_002_000, "fix true"),
        (10_000_000, "resumed after 1003000"),
        (10_000_000, "adjusted 4 to 3"),
        (10_002_000, "skipped 40 after 10000000"),
        (10_002_000, "disarmed SWITCH"),
        (10_002_000, "end"),
    ];
    assert_eq!(marks, expected.map(|(time, name)| (time, name.to_owned())));
    assert!(flight.end().is_complete && flight.end().cut_bytes == 0);
    assert_eq!(flight.counts().skipped_bytes, 40);
    let sample = at(&flight, &maker.bytes, 1_001_500);
    assert!(sample.boxes.unwrap().has(ModeBox::Angle), "an event counts before the next slow frame");
    let sample = at(&flight, &maker.bytes, 20_000_000);
    assert_eq!(sample.boxes.unwrap().modes().iter().collect::<Vec<_>>(), [Mode::Arm, Mode::Angle]);
    assert_eq!(sample.failsafe_phase, Some(FailsafePhase::RxLossDetected));
    assert_eq!(
        (sample.rx_signal, sample.rx_channels_valid, sample.gps_fix),
        (Some(false), Some(false), Some(true))
    );
}

fn named(kind: &LogMarkKind) -> String {
    let names = |flags: &super::BoxFlags| flags.names().collect::<Vec<_>>().join(" ");
    match kind {
        LogMarkKind::Armed => "armed".to_owned(),
        LogMarkKind::Disarmed(reason) => format!("disarmed {reason}"),
        LogMarkKind::Boxes { old, new } => format!("{} -> {}", names(old), names(new)),
        LogMarkKind::FailsafePhase(phase) => phase.to_string(),
        LogMarkKind::RxSignal(is) => format!("signal {is}"),
        LogMarkKind::GpsFix(is) => format!("fix {is}"),
        LogMarkKind::Adjustment { function, value: AdjustedValue::Whole(value) } => {
            format!("adjusted {function} to {value}")
        }
        LogMarkKind::Adjustment { .. } => "adjusted".to_owned(),
        LogMarkKind::Resumed { since } => format!("resumed after {}", since.0),
        LogMarkKind::Skipped { since, bytes } => format!("skipped {bytes} after {}", since.0),
        LogMarkKind::End => "end".to_owned(),
    }
}

#[test]
fn reasons_of_other_firmwares_are_unknown() {
    let mut maker = Maker::default();
    maker.begin(&header().replace("revision:Betaflight 4.5.2", "revision:INAV 7.1.0"));
    maker.slow([1, 0, 0, 1, 1]).main(0, 1_000_000, 0, 0).event(&[15, 4]).end();
    let flight = only(&maker.bytes);
    let reason = flight.marks().iter().find_map(|mark| match mark.kind {
        LogMarkKind::Disarmed(reason) => Some(reason),
        _ => None,
    });
    assert_eq!(reason, Some(DisarmReason::Unknown));
    assert_eq!(at(&flight, &maker.bytes, 0).boxes.unwrap().names().count(), 0);
}

#[test]
fn a_file_has_several_logs_some_empty_some_refused() {
    let mut maker = Maker::default();
    maker.begin(&header()).main(0, 5000, 1, 1).end();
    maker.begin(&header().replace("version:2", "version:1"));
    maker.begin(&header()).end();
    maker.begin(&header()).main(0, 9000, 1, 1).main(1, 10_000, 1, 1).raw(b"I\x05");
    let LogFile { flights, refused, left_out } = file(&maker.bytes);
    let numbers: Vec<usize> = flights.iter().map(LogFlight::number).collect();
    assert_eq!((numbers, left_out), (vec![1, 3, 4], 0));
    assert_eq!(refused.iter().map(|refused| refused.number).collect::<Vec<_>>(), [2]);
    assert!(flights[1].is_empty() && flights[1].sample(&maker.bytes[..], SimTime(5)).unwrap().is_none());
    let cut = &flights[2];
    assert_eq!((cut.end().is_complete, cut.end().cut_bytes, cut.counts().main), (false, 2, 2));
    assert_eq!(at(cut, &maker.bytes, 9999).time, SimTime(9000));
}

#[test]
fn logs_beyond_the_first_500_are_counted() {
    let mut maker = Maker::default();
    for _ in 0..600 {
        maker.begin(&header()).main(0, 5000, 1, 1);
    }
    let found = file(&maker.bytes);
    assert_eq!((found.flights.len(), found.left_out), (500, 100));
}

#[test]
fn times_go_on_where_the_32_bits_of_a_log_are_full() {
    let mut maker = Maker::default();
    maker.begin(&header());
    let first = u32::MAX - 4_000_000;
    for at in 0..8000 {
        maker.main(at, first.wrapping_add(at * 1000), 1, at as i32);
    }
    let flight = only(&maker.bytes);
    assert_eq!(flight.last().0 - flight.first().0, 7_999_000);
    let late = at(&flight, &maker.bytes, u64::from(u32::MAX) + 3_000_000);
    assert!(late.iteration > 6990 && late.iteration < 7001, "{}", late.iteration);
}

#[test]
fn an_error_of_the_source_is_passed_on() {
    #[derive(Debug)]
    struct Broken;
    impl crate::blackbox::decode::LogSource for Broken {
        fn size(&self) -> u64 {
            10
        }
        fn read_at(&mut self, _: u64, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::other("gone"))
        }
    }
    assert!(Indexer::new(Broken).run().is_err());
    let bytes = long(1);
    assert!(only(&bytes).sample(Broken, SimTime(0)).is_err());
}

#[test]
fn a_log_of_a_few_frames_is_not_empty() {
    for frames in [1, 2, 15] {
        let mut maker = Maker::default();
        maker.begin(&header());
        for frame in 0..frames {
            maker.main(frame, 1_000_000 + 1000 * frame, 0, 0);
        }
        let flight = only(&maker.bytes);
        assert_eq!((flight.is_empty(), flight.counts().main), (false, u64::from(frames)));
    }
}

#[test]
fn values_that_rest_on_a_missing_line_are_marked() {
    let assumed = |without: &str| {
        let lines = header() + "H P interval:1\n";
        let mut maker = Maker::default();
        maker.begin(&lines.replace(without, "H a:1")).main(7, 1_000_000, 10, 1234);
        let flight = only(&maker.bytes);
        let found: Vec<_> = flight.findings().iter().map(|finding| finding.line().to_owned()).collect();
        let named = |signal: &LogSignal| signal.is_assumed.then(|| signal.name.clone());
        (found.join(" "), flight.signals().iter().filter_map(named).collect::<Vec<_>>().join(" "))
    };
    let of = |found: &str, names: &str| (found.to_owned(), names.to_owned());
    assert_eq!(assumed("H nothing"), of("", ""));
    let motors = of("motorOutput", "motor[0] motor[1]");
    assert_eq!(assumed("H motorOutput:1000,2000"), motors);
    let gyro = of("gyro_scale", "roll pitch heading gyroADC[0] gyroADC[1] gyroADC[2]");
    assert_eq!(assumed("H gyro_scale:0x3f800000"), gyro);
    let revision = "H Firmware revision:Betaflight 4.5.2 (024f8e13d) SITL";
    let (found, names) = assumed(revision);
    assert_eq!(found, "Firmware revision vbat_scale");
    assert_eq!(names, "battery vbatLatest flightModeFlags GPS_altitude");
}
