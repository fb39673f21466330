//! The report about a flight that is over.

use super::{FlightReport, Verdict};
use crate::geo::LocalFrame;
use crate::replay::Overview;
use crate::report::record::FlightRecord;
use crate::telemetry::signal::Signal;

impl FlightReport {
    /// Returns the report about a recorded flight, without its settings, its map and its command.
    pub fn from_past(name: &str, overview: &Overview) -> Self {
        let record = FlightRecord::from_past(overview);
        let length_s = overview.last.seconds_since(overview.first);
        let about = record.sentences.first().filter(|_| !overview.about.is_empty());
        let reason = about.map_or_else(String::new, |(_, sentence)| sentence.clone());
        let mut facts = vec![("recorded".to_owned(), format!("{length_s:.1} s"))];
        facts.extend(extremes(&record));
        Self {
            kind: "Recorded flight, by betadeck".to_owned(),
            name: name.to_owned(),
            verdict: Verdict { passed: None, word: "recorded".to_owned(), reason },
            facts,
            // The altitude of home has no effect on the places of a map.
            frame: overview.origin.map(|home| LocalFrame::new(home.lat_deg(), home.lon_deg(), 0.0)),
            record,
            ..Self::default()
        }
    }
}

/// Returns how far, high and fast the craft was: name and value.
fn extremes(record: &FlightRecord) -> Vec<(String, String)> {
    let places = record.samples.iter().filter_map(|sample| record.place(sample));
    let farthest = places.map(|[north, east]| north.hypot(east)).fold(f64::NAN, f64::max);
    let greatest = |signals: [Signal; 2]| {
        let of = signals.map(|signal| record.values(signal).fold(f64::NAN, f64::max));
        of.into_iter().find(|greatest| greatest.is_finite()).unwrap_or(f64::NAN)
    };
    let highest = greatest([Signal::Altitude, Signal::EstAltitude]);
    let fastest = greatest([Signal::Speed, Signal::EstSpeed]);
    let all = [("farthest", farthest, "m"), ("highest", highest, "m"), ("fastest", fastest, "m/s")];
    let known = all.into_iter().filter(|(_, value, _)| value.is_finite());
    known.map(|(name, value, unit)| (name.to_owned(), format!("{value:.1} {unit}"))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::replay::{PastEventKind, Picture};
    use crate::signals::SimTime;
    use crate::telemetry::Snapshot;
    use crate::telemetry::snapshot::EstimateView;

    #[test]
    fn a_recorded_flight_has_no_verdict_but_its_extremes() {
        let picture = |second: u64| {
            let estimate = EstimateView {
                n: Some(3.0 * second as f64),
                e: Some(4.0 * second as f64),
                alt: Some(20.0 - second as f64),
                ..EstimateView::default()
            };
            Picture::of(&Snapshot { time: SimTime(second * 1_000_000), estimate, ..Snapshot::default() })
        };
        let overview = Overview {
            last: SimTime(10_000_000),
            origin: Some(LatLon::from_degrees(47.0, 8.0)),
            about: vec![PastEventKind::Notice("Written by a firmware.".to_owned())],
            pictures: (0..=10).map(picture).collect(),
            ..Overview::default()
        };
        let report = FlightReport::from_past("LOG00001.BFL", &overview);
        let facts: Vec<(&str, &str)> =
            report.facts.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect();
        assert_eq!(facts, [("recorded", "10.0 s"), ("farthest", "50.0 m"), ("highest", "20.0 m")]);
        assert_eq!((report.verdict.passed, report.verdict.reason.as_str()), (None, "Written by a firmware."));
        assert!(report.frame.is_some());
    }
}
