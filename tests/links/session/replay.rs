//! A session over a blackbox log.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

use std::io;
use std::sync::{Arc, Mutex};

use betadeck::blackbox::decode::LogSource;
use betadeck::replay::{CurvesRequest, LogFlights, Overview, PastEventKind, PastFlight, PastFlights};
use betadeck::signals::SimTime;
use betadeck::telemetry::Mode;
use betadeck::telemetry::signal::Signal;

use test_support::made_log::{FIRST_US, HOME, MadeLog};

/// A file in memory. Copies share it.
#[derive(Debug, Clone)]
struct Memory(Arc<Mutex<io::Result<Vec<u8>>>>);

impl Memory {
    fn new(bytes: Vec<u8>) -> Self {
        Self(Arc::new(Mutex::new(Ok(bytes))))
    }

    fn replace(&self, contents: io::Result<Vec<u8>>) {
        *self.0.lock().unwrap() = contents;
    }
}

impl LogSource for Memory {
    fn size(&self) -> u64 {
        self.0.lock().unwrap().as_ref().map_or(0, |bytes| bytes.len() as u64)
    }

    fn read_at(&mut self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        match &*self.0.lock().unwrap() {
            Ok(bytes) => bytes.as_slice().read_at(offset, buffer),
            Err(error) => Err(error.kind().into()),
        }
    }
}

fn read(bytes: Vec<u8>) -> (LogFlights<Memory>, Memory) {
    let memory = Memory::new(bytes);
    let mut flights = LogFlights::new("a.bbl", memory.clone());
    assert_eq!(flights.read(&mut |_| true), Ok(true));
    (flights, memory)
}

fn opened(log: MadeLog) -> (Box<dyn PastFlight>, Arc<Overview>) {
    let flight = read(log.bytes()).0.open(0).unwrap();
    let overview = flight.overview();
    (flight, overview)
}

fn after(seconds: f64) -> SimTime {
    SimTime(u64::from(FIRST_US) + SimTime::from_secs_f64(seconds).0)
}

fn texts(overview: &Overview) -> Vec<String> {
    let text = |kind: &PastEventKind| match kind {
        PastEventKind::Vehicle(kind) => format!("{kind:?}"),
        PastEventKind::Notice(text) | PastEventKind::Warning(text) => text.clone(),
    };
    overview.about.iter().chain(overview.events.iter().map(|event| &event.kind)).map(text).collect()
}

#[test]
fn an_instant_shows_the_craft_as_it_was_logged() {
    let (mut flight, overview) = opened(MadeLog::default());
    let moment = flight.at(after(10.0)).unwrap();
    let (estimate, craft) = (&moment.snapshot.estimate, &moment.snapshot.craft);
    assert_eq!(moment.snapshot.origin.map(|origin| (origin.lat_e7, origin.lon_e7)), Some(HOME));
    // A quarter of the circle.
    let (n, e) = (estimate.n.unwrap(), estimate.e.unwrap());
    assert!((n - 40.0).abs() < 1.0 && (e - 40.0).abs() < 1.0, "{n} {e}");
    assert!((estimate.alt.unwrap() - 30.0).abs() < 0.1, "{:?}", estimate.alt);
    assert!((craft.battery_v.unwrap() - 15.8).abs() < 1e-6, "{:?}", craft.battery_v);
    assert!(craft.is_armed() && craft.is_active(Mode::Angle) && craft.is_active(Mode::Autopilot));
    assert_eq!(craft.channels.map(|channels| channels[2..4].to_vec()), Some(vec![1480, 1488]));
    assert_eq!(craft.motors.map(|motors| (motors[3] * 100.0).round()), Some(41.0));
    assert_eq!((moment.snapshot.truth, moment.snapshot.nav.is_some()), (None, false), "no log has them");
    let debug = overview.series.iter().position(|series| series.name == "debug[0]").unwrap();
    assert!((moment.values[debug] + 250.0).abs() < 1e-9, "{}", moment.values[debug]);
}

#[test]
fn the_last_instant_of_a_log_that_ends_by_a_disarming_is_disarmed() {
    let (mut flight, overview) = opened(MadeLog::default());
    let mut armed = |time| flight.at(time).unwrap().snapshot.craft.armed;
    assert_eq!((armed(after(19.0)), armed(overview.last)), (Some(true), Some(false)));
}

#[test]
fn the_whole_track_and_all_events_are_known_at_once() {
    let (_, overview) = opened(MadeLog::default());
    assert_eq!((overview.first, overview.last), (after(0.0), after(19.995)));
    assert_eq!((overview.frame_us, overview.pictures.len()), (5000, 201));
    let farthest =
        overview.pictures.iter().filter_map(|picture| picture.value(Signal::East)).fold(0.0, f64::max);
    assert!((farthest - 80.0).abs() < 1.0, "{farthest}");
    let texts = texts(&overview);
    assert!(texts[0].starts_with("Written by Betaflight 2026.12.0 (abcdef012) SITL, craft Test, 2026-05-01"));
    assert!(texts[0].ends_with(": 4000 main frames."), "{}", texts[0]);
    let events = texts[1..].join("\n");
    for event in ["Armed", "Mode(", "Disarmed(Switch)", "The log ends."] {
        assert!(events.contains(event), "{event} in {events}");
    }
    let states: Vec<_> =
        overview.marks.all().iter().filter(|mark| mark.kind.is_state()).map(|mark| mark.time).collect();
    assert_eq!(states, [after(4.0), after(8.0)]);
}

#[test]
fn a_curve_has_the_extremes_of_its_steps() {
    let (mut flight, overview) = opened(MadeLog::default());
    let debug = overview.series.iter().position(|series| series.name == "debug[0]").unwrap();
    let curve = |flight: &mut Box<dyn PastFlight>, from, to, steps| {
        let request = CurvesRequest { series: vec![debug], from, to, steps };
        let mut curves = flight.curves(&request).unwrap();
        assert_eq!(curves.len(), 1);
        curves.remove(0)
    };
    let whole = curve(&mut flight, after(0.0), after(19.995), 10);
    let extremes: Vec<_> = whole.between(0.0, 1e9).filter_map(|(_, extent)| extent).collect();
    assert_eq!(extremes.len(), 10);
    assert!(extremes.iter().all(|(least, greatest)| *least <= -50.0 && *greatest >= 49.0), "{extremes:?}");
    // Each frame alone: 5 ms apart.
    let frames = curve(&mut flight, after(1.0), after(1.1), 20);
    let values: Vec<_> = frames.between(0.0, 1e9).filter_map(|(_, extent)| extent).collect();
    assert_eq!(values.len(), 20);
    assert!(values.windows(2).all(|pair| (pair[1].0 - pair[0].0 - 1.0).abs() < 1e-9), "{values:?}");
    // A series that the log does not have is left out.
    let request = CurvesRequest { series: vec![9999], from: after(0.0), to: after(1.0), steps: 5 };
    assert!(flight.curves(&request).unwrap().is_empty());
}

#[test]
fn a_log_without_a_gps_has_no_track() {
    let (mut flight, overview) = opened(MadeLog { has_gps: false, ..MadeLog::default() });
    assert!(overview.pictures.iter().all(|picture| picture.place().is_none()));
    assert_eq!((overview.origin, flight.at(after(5.0)).unwrap().snapshot.craft.gps), (None, None));
    assert!(texts(&overview).contains(&"The log has no GPS: the map shows no track.".to_owned()));
}

#[test]
fn damaged_parts_are_counted_and_the_rest_is_shown() {
    let (mut flight, overview) = opened(MadeLog { damaged_at: Some(60_000), ..MadeLog::default() });
    let texts = texts(&overview);
    assert!(texts[1].starts_with("The log is damaged: "), "{texts:?}");
    assert!(texts.iter().any(|text| text.starts_with("The log is damaged here: ")), "{texts:?}");
    assert!(flight.at(after(19.0)).unwrap().snapshot.craft.is_armed());
}

#[test]
fn a_log_that_was_cut_is_shown_up_to_its_last_whole_frame() {
    let mut bytes = MadeLog::default().bytes();
    bytes.truncate(bytes.len() / 2);
    let mut flight = read(bytes).0.open(0).unwrap();
    let overview = flight.overview();
    let length_s = overview.last.seconds_since(overview.first);
    assert!((8.0..12.0).contains(&length_s), "{length_s}");
    assert!(texts(&overview)[1].starts_with("The log was cut: it has no end"), "{:?}", texts(&overview));
    assert!(flight.at(SimTime(u64::MAX)).unwrap().snapshot.estimate.n.is_some());
}

#[test]
fn a_log_with_one_frame_is_a_flight() {
    let (mut flight, overview) = opened(MadeLog { seconds: 1, hz: 1, ..MadeLog::default() });
    assert_eq!((overview.first, overview.last, overview.pictures.len()), (after(0.0), after(0.0), 1));
    for time in [SimTime::ZERO, after(0.0), SimTime(u64::MAX)] {
        assert!(flight.at(time).unwrap().snapshot.craft.channels.is_some());
    }
    let request = CurvesRequest { series: vec![0], from: after(0.0), to: after(0.0), steps: 9 };
    assert_eq!(flight.curves(&request).unwrap().len(), 1);
}

#[test]
fn the_logs_of_a_file_are_flights_of_their_own() {
    let first = MadeLog::default().bytes();
    let second = MadeLog { seconds: 5, craft: "Other", ..MadeLog::default() }.bytes();
    let cut =
        b"H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\nH Fie".to_vec();
    let (mut flights, _) = read([first, second, cut].concat());
    assert_eq!(flights.count(), 3);
    assert!(texts(&flights.open(1).unwrap().overview())[0].contains("craft Other"));
    let refused = flights.open(2).err().unwrap();
    assert!(refused.starts_with("Log 3 of a.bbl cannot be shown: "), "{refused}");
    let refused = flights.open(7).err().unwrap();
    assert_eq!(refused, "a.bbl has 3 logs: choose one from 1 to 3.");
}

#[test]
fn a_file_that_is_cut_or_lost_while_it_is_shown_ends_nothing() {
    let (mut flights, memory) = read(MadeLog::default().bytes());
    let mut flight = flights.open(0).unwrap();
    assert!(flight.at(after(15.0)).is_ok());
    memory.replace(Ok(Vec::new()));
    let cut = flight.at(after(15.0));
    assert!(cut.is_ok() || cut.is_err_and(|why| why.contains("a.bbl")));
    memory.replace(Err(io::ErrorKind::NotFound.into()));
    let lost = flight.at(after(3.0)).unwrap_err();
    assert!(lost.starts_with("a.bbl cannot be read any more: "), "{lost}");
    assert!(flights.open(0).err().unwrap().starts_with("a.bbl cannot be read any more: "));
}

#[test]
fn reading_stops_when_nobody_waits_for_it() {
    let bytes = MadeLog { seconds: 300, ..MadeLog::default() }.bytes();
    let mut flights = LogFlights::new("a.bbl", Memory::new(bytes));
    let mut shares = Vec::new();
    let read = flights.read(&mut |share| {
        shares.push(share);
        shares.len() < 2
    });
    assert_eq!(read, Ok(false));
    assert!(shares.len() == 2 && shares[0] < shares[1] && shares[1] < 1.0, "{shares:?}");
}

#[test]
fn a_file_without_a_log_is_refused() {
    let mut flights = LogFlights::new("a.bbl", Memory::new(vec![b'x'; 5000]));
    assert_eq!(flights.read(&mut |_| true), Err("a.bbl has no blackbox log.".to_owned()));
}

#[test]
fn a_long_log_has_a_bounded_number_of_pictures() {
    let log = MadeLog { seconds: 3000, hz: 200, ..MadeLog::default() };
    let (mut flight, overview) = opened(log);
    assert!(
        overview.pictures.len() <= 20_001 && overview.pictures.len() > 5000,
        "{}",
        overview.pictures.len()
    );
    let request = CurvesRequest { series: vec![0], from: after(0.0), to: after(3000.0), steps: 2400 };
    let curve = flight.curves(&request).unwrap().remove(0);
    let known = curve.between(0.0, 1e9).filter(|(_, extent)| extent.is_some()).count();
    assert!(known > 400, "{known}");
}
