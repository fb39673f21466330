//! The flown track: a polyline that never grows beyond a bound.

use crate::geo::{BoundedPath, Located};
use crate::replay::Picture;

/// The maximum number of points.
const MAX_POINTS: usize = 20_480;
/// The initial spacing of points, m.
const SPACING_M: f64 = 0.4;
/// A faster movement is a jump, not flight: a reset or a glitch.
const JUMP_MPS: f64 = 60.0;
/// The greatest step that is never a jump, m.
const STEP_M: f64 = 5.0;

/// The number of other tracks that are kept.
const MAX_KEPT: usize = 4;

/// A point of the track, metres from the boot place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrackPoint {
    /// North, m.
    pub n: f64,
    /// East, m.
    pub e: f64,
    /// Altitude above home, m: the true one if the simulator reports it.
    pub alt_m: f64,
    /// Simulated time, s.
    pub time_s: f64,
    /// `true` if the autopilot was flying.
    pub engaged: bool,
    /// The index of the current waypoint of the stored plan.
    pub wp: Option<u8>,
}

impl TrackPoint {
    /// Returns the point of a picture, if it has a place.
    pub(in crate::ui) fn of(picture: &Picture) -> Option<Self> {
        let (n, e) = picture.place()?;
        let alt_m = picture.altitude_m().unwrap_or_default();
        Some(Self { n, e, alt_m, time_s: picture.time_s(), engaged: picture.engaged, wp: None })
    }
}

/// The newest other tracks, the newest last: those of abandoned branches of the flight, or of earlier flights.
#[derive(Debug, Default)]
pub struct KeptTracks {
    tracks: Vec<Vec<TrackPoint>>,
}

impl KeptTracks {
    pub(in crate::ui) fn keep(&mut self, track: Vec<TrackPoint>) {
        if track.len() > 1 {
            if self.tracks.len() == MAX_KEPT {
                self.tracks.remove(0);
            }
            self.tracks.push(track);
        }
    }

    /// Keeps the track of a flight, unless it stayed at its place.
    pub(in crate::ui) fn keep_flight(&mut self, track: Vec<TrackPoint>) {
        let has_left = |first: &TrackPoint| track.iter().any(|point| point.distance_m(first) > STEP_M);
        if track.first().is_some_and(has_left) {
            self.keep(track);
        }
    }

    pub(in crate::ui) fn forget(&mut self) {
        self.tracks.clear();
    }

    pub fn tracks(&self) -> &[Vec<TrackPoint>] {
        &self.tracks
    }
}

impl Located for TrackPoint {
    fn distance_m(&self, other: &Self) -> f64 {
        (self.n - other.n).hypot(self.e - other.e).hypot(self.alt_m - other.alt_m)
    }
}

#[derive(Debug)]
pub struct Track {
    path: BoundedPath<TrackPoint>,
    /// The last known position of the craft, which may be too near the last point to be kept.
    seen: Option<TrackPoint>,
    /// `true` after a reset was requested: the next jump counts as that reset, however old the last position is.
    awaits_reset: bool,
}

impl Default for Track {
    fn default() -> Self {
        Self { path: BoundedPath::new(MAX_POINTS, SPACING_M), seen: None, awaits_reset: false }
    }
}

impl Track {
    /// Returns the track of a flight that is over. Its jumps are gaps of the record, not resets.
    pub(in crate::ui) fn from_past(points: impl Iterator<Item = TrackPoint>) -> Self {
        let mut track = Self::default();
        for point in points {
            track.add(point);
        }
        track
    }

    /// Appends a point if it is far enough from the last one. A jump starts a new track; the one before is returned.
    pub fn push(&mut self, point: TrackPoint) -> Vec<TrackPoint> {
        if !(point.n.is_finite() && point.e.is_finite() && point.alt_m.is_finite()) {
            return Vec::new();
        }
        let distance = |from: &TrackPoint| (point.n - from.n).hypot(point.e - from.e);
        // Measured from the last known position: since the last kept point a standing craft has had time to go
        // anywhere.
        let jumped =
            self.seen.is_some_and(|seen| distance(&seen) > STEP_M + JUMP_MPS * (point.time_s - seen.time_s));
        let ended = if jumped { self.clear() } else { Vec::new() };
        self.seen = Some(point);
        self.add(point);
        ended
    }

    fn add(&mut self, point: TrackPoint) {
        let is_same_leg = |last: &TrackPoint| last.engaged == point.engaged && last.wp == point.wp;
        if self.points().last().is_none_or(is_same_leg) {
            self.path.push(point);
        } else {
            self.path.append(point);
        }
    }

    /// Removes the part after `time_s`, s. Returns it, starting with the last kept point.
    pub fn cut_after(&mut self, time_s: f64) -> Vec<TrackPoint> {
        let kept = self.points().partition_point(|point| point.time_s <= time_s);
        let mut part = self.path.split_off(kept);
        self.seen = self.points().last().copied();
        if let (Some(last), false) = (self.seen, part.is_empty()) {
            part.insert(0, last);
        }
        part
    }

    /// Removes the part before `time_s`, s: the flight begins there. Returns it.
    pub(in crate::ui) fn begin_at(&mut self, time_s: f64) -> Vec<TrackPoint> {
        let before = self.points().partition_point(|point| point.time_s < time_s);
        let flown = self.path.split_off(before);
        let seen = self.seen.filter(|seen| seen.time_s >= time_s);
        let mut path = std::mem::replace(self, Self { seen, ..Self::default() }).path;
        flown.into_iter().for_each(|point| self.add(point));
        path.split_off(0)
    }

    /// Removes all points, and returns them.
    pub fn clear(&mut self) -> Vec<TrackPoint> {
        std::mem::take(self).path.split_off(0)
    }

    /// Prepares for a reset: if the craft is then disarmed away from its last position, the track starts again, even if
    /// at high simulation speed it could have flown there.
    pub fn await_reset(&mut self) {
        self.awaits_reset = true;
    }

    /// Records a disarmed craft at a place, which ends the track if a reset was requested. Returns the track that ended.
    pub fn disarmed_at(&mut self, n: f64, e: f64) -> Vec<TrackPoint> {
        let moved = self.seen.is_some_and(|seen| (n - seen.n).hypot(e - seen.e) > STEP_M);
        if self.awaits_reset && moved { self.clear() } else { Vec::new() }
    }

    /// Returns the points, the oldest first.
    pub fn points(&self) -> &[TrackPoint] {
        self.path.points()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_track_of_a_flight_begins_where_the_craft_was_armed() {
        let mut track = Track::default();
        let at =
            |step: u32| TrackPoint { n: f64::from(step), time_s: f64::from(step), ..TrackPoint::default() };
        for step in 0..20 {
            track.push(at(step));
        }
        let before = track.begin_at(7.5);
        assert_eq!(
            before.iter().map(|point| point.time_s).collect::<Vec<_>>(),
            [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
        );
        assert_eq!(track.points().first().map(|point| point.time_s), Some(8.0));
        assert_eq!(track.points().last().map(|point| point.time_s), Some(19.0));
        track.begin_at(30.0);
        assert!(track.points().is_empty());
        // The craft was put back home before it was armed again.
        track.push(TrackPoint { time_s: 30.1, ..TrackPoint::default() });
        assert_eq!(track.points().len(), 1);
    }

    #[test]
    fn a_long_flight_stays_bounded_and_keeps_both_ends() {
        let mut track = Track::default();
        for step in 0..100_000 {
            let n = f64::from(step);
            track.push(TrackPoint { n, time_s: n / 10.0, engaged: true, ..TrackPoint::default() });
        }
        assert!(track.points().len() <= MAX_POINTS);
        assert_eq!(track.points().first().map(|p| p.n), Some(0.0));
        assert!(track.points().last().is_some_and(|p| p.n > 99_980.0));
    }

    #[test]
    fn a_branch_goes_on_from_where_it_was_cut_off() {
        let mut track = Track::default();
        let at = |n: f64| TrackPoint { n, time_s: n, engaged: true, ..TrackPoint::default() };
        for n in 0..10 {
            track.push(at(f64::from(n)));
        }
        assert_eq!(track.cut_after(6.5), [at(6.0), at(7.0), at(8.0), at(9.0)]);
        assert!(track.cut_after(6.5).is_empty());
        track.push(TrackPoint { e: 1.0, ..at(7.0) });
        assert_eq!(track.points().len(), 8, "no jump");
    }

    #[test]
    fn a_reset_after_a_long_stand_starts_a_new_track() {
        let mut track = Track::default();
        let at = |n, time_s| TrackPoint { n, time_s, ..TrackPoint::default() };
        for second in 0..30 {
            track.push(at(100.0, f64::from(second)));
        }
        assert!(!track.push(at(0.0, 29.1)).is_empty(), "the track before is an earlier flight");
        assert_eq!(track.points(), [at(0.0, 29.1)]);
    }

    #[test]
    fn an_awaited_reset_needs_a_disarmed_craft_elsewhere() {
        let mut track = Track::default();
        let at = |n, time_s| TrackPoint { n, time_s, ..TrackPoint::default() };
        track.push(at(100.0, 0.0));
        track.disarmed_at(0.0, 0.0);
        assert_eq!(track.points().len(), 1, "a landing after a slice as long as this is no reset");
        track.await_reset();
        track.disarmed_at(101.0, 0.0);
        assert_eq!(track.points().len(), 1, "it stands where it stood");
        track.disarmed_at(0.0, 0.0);
        assert!(track.points().is_empty());
    }

    #[test]
    fn a_climb_straight_up_is_kept() {
        let mut track = Track::default();
        for step in 0..100 {
            let alt_m = f64::from(step) * 0.1;
            track.push(TrackPoint { alt_m, time_s: alt_m, ..TrackPoint::default() });
        }
        assert!(track.points().len() > 15 && track.points().last().is_some_and(|point| point.alt_m > 9.0));
    }

    #[test]
    fn a_reset_starts_a_new_track() {
        let mut track = Track::default();
        let at = |n, time_s| TrackPoint { n, time_s, engaged: true, ..TrackPoint::default() };
        track.push(at(100.0, 50.0));
        track.push(at(90.0, 51.0));
        assert_eq!(track.points().len(), 2);
        track.push(at(0.0, 51.02));
        assert_eq!(track.points(), [at(0.0, 51.02)]);
        track.push(at(f64::NAN, 52.0));
        assert_eq!(track.points().len(), 1);
    }
}
