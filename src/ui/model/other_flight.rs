//! A second flight beside the one that is shown: its track, its graphs, and the times of both.

use std::sync::Arc;

use strum::Display;

use crate::geo::LocalFrame;
use crate::replay::{Overview, Picture};
use crate::signals::SimTime;
use crate::telemetry::{Mode, NavState};
use crate::timeline::{Mark, MarkKind};
use crate::ui::model::map_point::{MapPoint, to_map};
use crate::ui::model::track::{Track, TrackPoint};

/// The distance from which two flights count as flown at different places, m. Their homes are then put on each other.
const FAR_M: f64 = 20_000.0;
/// The difference below which two origins of the map are the same, degrees.
const SAME_DEG: f64 = 1e-6;

/// The instant at which two flights have the same time. `Display` ends a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Display)]
pub(in crate::ui) enum Alignment {
    #[strum(to_string = "at the engagement of the autopilot")]
    Engagement,
    #[strum(to_string = "at arming")]
    Arming,
    #[strum(to_string = "at their first instants")]
    Start,
}

/// Returns the instant at which the autopilot first engaged.
fn engaged_at(marks: &[Mark]) -> Option<SimTime> {
    let is_engagement = |mark: &&Mark| match mark.kind {
        MarkKind::State(state) => state != NavState::Idle,
        MarkKind::Modes(modes) => modes.has(Mode::Autopilot),
        _ => false,
    };
    marks.iter().find(is_engagement).map(|mark| mark.time)
}

fn armed_at(marks: &[Mark]) -> Option<SimTime> {
    marks.iter().find(|mark| mark.kind == MarkKind::Armed).map(|mark| mark.time)
}

/// A second flight.
#[derive(Debug)]
pub struct OtherFlight {
    /// The name of its file.
    pub(in crate::ui) name: String,
    overview: Arc<Overview>,
    track: Track,
    /// The origin of the map on which the track is.
    placed_on: Option<LocalFrame>,
    /// The time by which the user shifted it, µs.
    shift_us: i64,
    /// The alignment that the user was shown last.
    pub(in crate::ui) reported: Option<(Alignment, i64)>,
}

impl OtherFlight {
    pub(in crate::ui) fn new(name: String, overview: Arc<Overview>) -> Self {
        Self {
            name,
            track: Track::from_past(overview.pictures.iter().filter_map(TrackPoint::of)),
            placed_on: None,
            overview,
            shift_us: 0,
            reported: None,
        }
    }

    /// Returns the alignment with a flight, and the time to add to a time of this flight, µs.
    pub(in crate::ui) fn aligned(&self, marks: &[Mark], first: SimTime) -> (Alignment, i64) {
        let own = self.overview.marks.all();
        let (alignment, theirs, ours) =
            if let (Some(theirs), Some(ours)) = (engaged_at(marks), engaged_at(&own)) {
                (Alignment::Engagement, theirs, ours)
            } else if let (Some(theirs), Some(ours)) = (armed_at(marks), armed_at(&own)) {
                (Alignment::Arming, theirs, ours)
            } else {
                (Alignment::Start, first, self.overview.first)
            };
        (alignment, theirs.0 as i64 - ours.0 as i64 + self.shift_us)
    }

    /// Shifts it to later times.
    pub(in crate::ui) fn shift(&mut self, by_us: i64) {
        self.shift_us += by_us;
    }

    /// Returns the time by which the user shifted it, s.
    pub(in crate::ui) fn shift_s(&self) -> f64 {
        self.shift_us as f64 / 1e6
    }

    /// Puts its track on a map that counts metres from `origin`.
    pub(in crate::ui) fn place_on(&mut self, origin: LocalFrame) {
        let is_same = |placed: &LocalFrame| {
            (placed.lat_deg - origin.lat_deg).abs() < SAME_DEG
                && (placed.lon_deg - origin.lon_deg).abs() < SAME_DEG
        };
        if self.placed_on.as_ref().is_some_and(is_same) {
            return;
        }
        self.placed_on = Some(origin);
        let offset = self.overview.origin.map_or_else(MapPoint::default, |own| to_map(&origin, own));
        let is_near = offset.distance(MapPoint::default()) < FAR_M;
        let offset = if is_near { offset } else { MapPoint::default() };
        let moved = |point: TrackPoint| TrackPoint { n: point.n + offset.n, e: point.e + offset.e, ..point };
        self.track = Track::from_past(self.overview.pictures.iter().filter_map(TrackPoint::of).map(moved));
    }

    /// Returns its track on the map.
    pub(in crate::ui) fn track(&self) -> &[TrackPoint] {
        self.track.points()
    }

    /// Returns its place on the map at one of its times, s.
    pub(in crate::ui) fn place_at(&self, time_s: f64) -> Option<MapPoint> {
        let points = self.track.points();
        let last = points.partition_point(|point| point.time_s <= time_s).checked_sub(1)?;
        let (from, to) = (points.get(last)?, points.get(last + 1).or(points.last())?);
        let length_s = to.time_s - from.time_s;
        let share = if length_s > 0.0 { ((time_s - from.time_s) / length_s).min(1.0) } else { 0.0 };
        Some(MapPoint::new(from.n, from.e).towards(MapPoint::new(to.n, to.e), share))
    }

    /// Returns its pictures between two of its times, s.
    pub(in crate::ui) fn pictures(&self, from_s: f64, to_s: f64) -> &[Picture] {
        let pictures = &self.overview.pictures;
        let from = pictures.partition_point(|picture| picture.time_s() < from_s);
        let to = pictures.partition_point(|picture| picture.time_s() <= to_s);
        pictures.get(from..to).unwrap_or_default()
    }

    /// Returns the picture at one of its times, s; `None` before and after the flight.
    pub(in crate::ui) fn picture_at(&self, time_s: f64) -> Option<&Picture> {
        let pictures = &self.overview.pictures;
        if time_s > self.overview.last.as_secs_f64() {
            return None;
        }
        pictures.get(pictures.partition_point(|picture| picture.time_s() <= time_s).checked_sub(1)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::telemetry::{EventKind, FirmwareEvent, ModeFlags, Snapshot};
    use crate::timeline::Marks;

    fn at(seconds: u64) -> SimTime {
        SimTime(seconds * 1_000_000)
    }

    /// Returns a flight to the east at 2 m/s, with marks.
    fn flight(armed_s: Option<u64>, engaged_s: Option<u64>) -> Overview {
        let mut marks = Marks::default();
        if let Some(armed_s) = armed_s {
            marks.note(at(armed_s), &EventKind::Firmware(FirmwareEvent::Armed));
        }
        if let Some(engaged_s) = engaged_s {
            let mut modes = ModeFlags::NONE;
            modes.set(Mode::Autopilot, true);
            marks.push(at(engaged_s), MarkKind::Modes(modes));
        }
        let picture = |second: u64| {
            let mut snapshot = Snapshot { time: at(second), ..Snapshot::default() };
            (snapshot.estimate.n, snapshot.estimate.e) = (Some(0.0), Some(2.0 * second as f64));
            Picture::of(&snapshot)
        };
        let origin = Some(LatLon::new(470_000_000, 80_000_000));
        let pictures = (0..=60).map(picture).collect();
        Overview { first: at(0), last: at(60), marks, origin, pictures, ..Overview::default() }
    }

    fn other(overview: Overview) -> OtherFlight {
        OtherFlight::new("b".to_owned(), Arc::new(overview))
    }

    #[test]
    fn flights_meet_at_the_engagement_else_at_arming_else_at_their_start() {
        for (own, theirs, expected) in [
            ((Some(5), Some(20)), (Some(7), Some(21)), (Alignment::Engagement, 1_000_000)),
            ((Some(5), None), (Some(7), Some(21)), (Alignment::Arming, 2_000_000)),
            ((None, Some(3)), (Some(7), None), (Alignment::Start, 4_000_000)),
        ] {
            let other = other(flight(own.0, own.1));
            let marks = flight(theirs.0, theirs.1).marks.all();
            assert_eq!(other.aligned(&marks, at(4)), expected);
        }
        let mut shifted = other(flight(Some(5), None));
        shifted.shift(-300_000);
        assert_eq!(shifted.aligned(&flight(Some(5), None).marks.all(), at(0)), (Alignment::Arming, -300_000));
    }

    #[test]
    fn the_track_is_at_its_own_place_unless_that_is_far_away() {
        let mut other = other(flight(None, None));
        other.place_on(LocalFrame::new(46.999, 8.0, 0.0));
        let place = other.place_at(10.25).unwrap();
        assert!((place.n - 111.0).abs() < 1.0 && (place.e - 20.5).abs() < 0.1, "{place:?}");
        other.place_on(LocalFrame::new(-47.0, 8.0, 0.0));
        assert_eq!(other.place_at(10.0).map(|place| place.n), Some(0.0));
        assert_eq!(other.place_at(-1.0), None);
        assert_eq!(other.place_at(1e9).map(|place| place.e), Some(120.0));
    }

    #[test]
    fn pictures_are_found_by_their_time_and_end_with_the_flight() {
        let other = other(flight(None, None));
        assert_eq!(other.pictures(10.5, 13.0).len(), 3);
        assert!(other.pictures(70.0, 5.0).is_empty());
        assert_eq!(other.picture_at(10.9).map(Picture::time_s), Some(10.0));
        assert!(other.picture_at(-0.1).is_none() && other.picture_at(60.1).is_none());
    }
}
