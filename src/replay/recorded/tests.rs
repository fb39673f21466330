//! Recordings that are made, read and shown.

use super::RecordedFlights;
use crate::geo::LatLon;
use crate::recording::{End, FORMAT, Header, Seen, Writer};
use crate::replay::{CurvesRequest, PastEventKind, PastFlight, PastFlights as _};
use crate::signals::{RcFrame, SimTime};
use crate::telemetry::snapshot::{EstimateView, TruthView};
use crate::telemetry::{Event, EventKind, FirmwareEvent, Snapshot};
use crate::timeline::MarkKind;

/// Returns a recording with a picture each 100 ms, from the first second on. The craft flies north at 1 m/s.
fn made(pictures: u64, first: SimTime) -> Vec<u8> {
    let text = |text: &str| text.to_owned();
    let header =
        Header { format: FORMAT, program: text("1.0"), date: text("2026-05-09"), plan: text("square") };
    let mut writer = Writer::new(header);
    writer.begin(first);
    let armed = EventKind::Firmware(FirmwareEvent::Armed);
    writer.event(&Event { time: SimTime(first.0 + 500_000), kind: armed }.into());
    for picture in 0..pictures {
        let north_m = picture as f64 / 10.0;
        let snapshot = Snapshot {
            time: SimTime(first.0.saturating_add(picture * 100_000)),
            origin: Some(LatLon::new(470_000_000, 80_000_000)),
            truth: Some(TruthView { n: north_m, ..TruthView::default() }),
            estimate: EstimateView { n: Some(north_m + 0.5), ..EstimateView::default() },
            ..Snapshot::default()
        };
        writer.picture(Seen { snapshot, sticks: RcFrame::default(), rc_cut: false, print: None });
    }
    let mut bytes = writer.flush();
    let end = End { result: text("complete"), reason: text("landed"), ..End::default() };
    bytes.extend(writer.finish(end));
    bytes
}

/// Reads a recording and opens its flight.
fn opened(bytes: &[u8]) -> Result<Box<dyn PastFlight>, String> {
    let mut flights = RecordedFlights::new("a.flight", bytes);
    flights.read(&mut |_| true)?;
    flights.open(0)
}

fn texts(flight: &dyn PastFlight) -> Vec<String> {
    let text = |kind: &PastEventKind| match kind {
        PastEventKind::Vehicle(kind) => format!("{kind:?}"),
        PastEventKind::Notice(text) => text.clone(),
        PastEventKind::Warning(text) => format!("warning: {text}"),
    };
    flight.overview().about.iter().map(text).collect()
}

#[test]
fn a_recording_is_shown_by_its_pictures() {
    let mut flight = opened(&made(100, SimTime(1_000_000))).unwrap();
    let overview = flight.overview();
    assert_eq!((overview.first, overview.last), (SimTime(1_000_000), SimTime(10_900_000)));
    assert_eq!((overview.pictures.len(), overview.frame_us), (100, 100_000));
    assert_eq!(overview.origin, Some(LatLon::new(470_000_000, 80_000_000)));
    let marks: Vec<MarkKind> = overview.marks.all().iter().map(|mark| mark.kind).collect();
    assert_eq!(marks, [MarkKind::Armed]);
    let moment = flight.at(SimTime(3_050_000)).unwrap();
    assert_eq!(moment.snapshot.truth.map(|truth| truth.n), Some(2.0));
    let value = |name: &str| {
        let at = overview.series.iter().position(|series| series.name == name);
        at.map(|at| (moment.values[at], overview.series[at].unit))
    };
    assert_eq!((value("north"), value("est_north")), (Some((2.0, "m")), Some((2.5, "m"))));
    assert_eq!(value("current"), None, "what no picture has is no series");
    assert_eq!(
        texts(&*flight),
        ["Recorded by betadeck 1.0 on 2026-05-09, plan square.", "Result: complete, landed."]
    );
}

#[test]
fn a_curve_has_the_extremes_of_its_steps() {
    let mut flight = opened(&made(100, SimTime(0))).unwrap();
    let north = flight.overview().series.iter().position(|series| series.name == "north").unwrap();
    let request =
        CurvesRequest { series: vec![north, 9999], from: SimTime(0), to: SimTime(4_000_000), steps: 2 };
    let curves = flight.curves(&request).unwrap();
    assert_eq!(curves.len(), 1, "an unknown series has no curve");
    let steps: Vec<_> = curves[0].between(0.0, 9.0).collect();
    assert_eq!(steps, [(1.0, Some((0.0, 1.9))), (3.0, Some((2.0, 3.9)))]);
    // More steps than pictures.
    let request = CurvesRequest { series: vec![north], from: SimTime(0), to: SimTime(200_000), steps: 8 };
    let steps: Vec<_> = flight.curves(&request).unwrap()[0].between(0.0, 9.0).collect();
    assert_eq!(steps.iter().filter(|(_, extent)| extent.is_some()).count(), 2);
}

#[test]
fn a_recording_that_was_cut_short_is_shown_up_to_its_last_picture() {
    let bytes = made(100, SimTime(0));
    let flight = opened(&bytes[..bytes.len() / 2]).unwrap();
    let overview = flight.overview();
    assert!((10..100).contains(&overview.pictures.len()), "{}", overview.pictures.len());
    assert!(overview.last < SimTime(9_900_000));
    let cut = "warning: The recording ends early: it was cut short.".to_owned();
    assert!(texts(&*flight).contains(&cut), "{:?}", texts(&*flight));
}

#[test]
fn what_cannot_be_shown_is_refused_in_a_sentence() {
    let month = SimTime(31 * 86_400_000_000);
    for (bytes, said) in [
        (made(0, SimTime(0)), "a.flight cannot be shown: it has neither pictures nor"),
        (b"\x1f\x8bjunk".to_vec(), "a.flight cannot be shown: it is not a recording of a flight"),
        (Vec::new(), "a.flight cannot be shown: it is not a recording of a flight"),
        (made(3, month), "a.flight cannot be shown: it ends more than 30 days after boot."),
        (made(3, SimTime(u64::MAX - 500_000)), "a.flight cannot be shown: it ends more than 30 days"),
    ] {
        let refused = opened(&bytes).err().unwrap_or_default();
        assert!(refused.starts_with(said), "{refused}");
    }
    let bytes = made(3, SimTime(0));
    let mut flights = RecordedFlights::new("a.flight", bytes.as_slice());
    assert_eq!(flights.open(0).err().as_deref(), Some("a.flight is not read yet."));
    assert_eq!(flights.read(&mut |_| true), Ok(true));
    assert_eq!(flights.open(1).err().as_deref(), Some("a.flight has only one flight."));
}

#[test]
fn reading_stops_when_nobody_waits_for_it() {
    let bytes = made(100, SimTime(0));
    let mut flights = RecordedFlights::new("a.flight", bytes.as_slice());
    assert_eq!(flights.read(&mut |_| false), Ok(false));
    let mut shares = Vec::new();
    let mut note = |share: f64| {
        shares.push(share);
        true
    };
    assert_eq!(flights.read(&mut note), Ok(true), "it can be read later");
    assert!(shares.is_sorted() && shares.last().is_some_and(|last| *last <= 1.0), "{shares:?}");
}
