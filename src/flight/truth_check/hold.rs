//! Measures the accuracy of a place or a pattern during a hold.

use nalgebra::Vector2;

use super::craft::CraftTruth;
use super::pattern::Pattern;
use super::settle::Settle;
use crate::signals::SimTime;

/// The limits of a hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HoldLimits {
    /// Error below which a craft counts as at the place, m.
    pub(super) small_m: f64,
    /// Altitude error below which it counts as at the altitude, m.
    pub(super) small_alt_m: f64,
    /// Speed on the way there, m/s.
    pub(super) speed_mps: f64,
    /// Speed of climb and descent, m/s.
    pub(super) climb_mps: f64,
}

/// A hold in progress, with its largest errors so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HoldWatch {
    pattern: Pattern,
    limits: HoldLimits,
    place: Settle,
    /// `true` if a position outside the pattern counts before the hold counts. Not for a craft that the pilot brought
    /// there.
    outside_counts: bool,
    overridden: bool,
    level: Settle,
    worst: Option<(f64, SimTime)>,
    worst_alt_m: Option<f64>,
    last_alt_m: Option<f64>,
}

impl HoldWatch {
    /// Begins a hold now, with the craft `alt_error_m` above its altitude. A point is held from the beginning, a
    /// pattern is entered from its middle.
    pub(super) fn begin(pattern: Pattern, limits: HoldLimits, now: SimTime, alt_error_m: f64) -> Self {
        let place = match pattern {
            Pattern::Point => Settle::Counts,
            Pattern::Orbit(_) | Pattern::Figure8(_) => {
                Settle::after(now, pattern.entry_m(), limits.speed_mps)
            }
        };
        Self {
            pattern,
            limits,
            place,
            outside_counts: true,
            overridden: false,
            level: Settle::after(now, alt_error_m.abs(), limits.climb_mps),
            worst: None,
            worst_alt_m: None,
            last_alt_m: None,
        }
    }

    pub(super) fn look(&mut self, craft: &CraftTruth, target_ne: Vector2<f64>, target_alt_m: f64) {
        let alt_error_m = craft.alt_m - target_alt_m;
        if let Some(error_m) = self.error_m(craft, target_ne)
            && self.worst.is_none_or(|(worst, _)| error_m > worst)
        {
            self.worst = Some((error_m, craft.time));
        }
        if craft.stick_override {
            return;
        }
        self.last_alt_m = Some(alt_error_m);
        if self.level.counts(craft.time, alt_error_m.abs(), self.limits.small_alt_m)
            && self.worst_alt_m.is_none_or(|worst| alt_error_m.abs() > worst.abs())
        {
            self.worst_alt_m = Some(alt_error_m);
        }
    }

    /// Returns the horizontal error of an instant, m, if it counts. After the pilot has flown, the craft gets time to
    /// come back.
    pub(super) fn error_m(&mut self, craft: &CraftTruth, target_ne: Vector2<f64>) -> Option<f64> {
        let offset = craft.ne - target_ne;
        let error_m = self.pattern.error_m(offset);
        if craft.stick_override {
            self.overridden = true;
            return None;
        }
        if std::mem::take(&mut self.overridden) {
            self.place = Settle::after(craft.time, error_m, self.limits.speed_mps);
            self.outside_counts = false;
        }
        if self.place.counts(craft.time, error_m, self.limits.small_m) {
            return Some(error_m);
        }
        self.outside_counts.then(|| self.pattern.outside_m(offset))
    }

    /// Returns the largest horizontal error, m, and its time, or `None` if nothing counted.
    pub(super) fn worst(&self) -> Option<(f64, SimTime)> {
        self.worst
    }

    /// Returns the largest altitude error, m, since the altitude was reached. For a craft without enough time for
    /// that, it is the last error.
    pub(super) fn worst_alt_m(&self) -> Option<f64> {
        self.worst_alt_m.or(self.last_alt_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: HoldLimits = HoldLimits { small_m: 2.0, small_alt_m: 10.0, speed_mps: 5.0, climb_mps: 5.0 };

    fn craft(seconds: f64, east_m: f64, alt_m: f64) -> CraftTruth {
        CraftTruth {
            time: SimTime::from_secs_f64(seconds),
            ne: Vector2::new(0.0, east_m),
            alt_m,
            speed_mps: 0.0,
            stick_override: false,
            climbing: false,
        }
    }

    fn watch(pattern: Pattern, alt_error_m: f64, path: &[CraftTruth]) -> HoldWatch {
        let mut watch = HoldWatch::begin(pattern, LIMITS, SimTime::ZERO, alt_error_m);
        path.iter().for_each(|craft| watch.look(craft, Vector2::zeros(), 20.0));
        watch
    }

    fn worst(watch: &HoldWatch) -> Option<f64> {
        watch.worst().map(|(error, _)| error)
    }

    #[test]
    fn a_point_is_held_from_the_beginning() {
        let drifting = watch(Pattern::Point, 0.0, &[craft(0.0, 3.0, 20.0), craft(1.0, 8.0, 20.0)]);
        assert_eq!(worst(&drifting), Some(8.0));
        assert_eq!(drifting.worst_alt_m(), Some(0.0));
    }

    #[test]
    fn a_pattern_counts_from_the_ring_on() {
        let orbit = Pattern::Orbit(10.0);
        let entered = [craft(0.0, 0.5, 20.0), craft(5.0, 9.0, 20.0), craft(6.0, 13.0, 20.0)];
        assert_eq!(worst(&watch(orbit, 0.0, &entered)), Some(3.0));
        let late = [craft(0.0, 0.5, 20.0), craft(22.0, 0.5, 20.0)];
        assert_eq!(worst(&watch(orbit, 0.0, &late)), Some(9.5), "it never came to the ring");
        let early = [craft(0.0, 0.5, 20.0), craft(21.0, 4.0, 20.0)];
        assert_eq!(worst(&watch(orbit, 0.0, &early)), Some(0.0), "it has the time to get there");
        let blown = [craft(0.0, 0.5, 20.0), craft(1.0, 40.0, 20.0)];
        assert_eq!(worst(&watch(orbit, 0.0, &blown)), Some(30.0), "outside the ring it counts at once");
    }

    #[test]
    fn what_the_pilot_does_does_not_count_nor_the_way_back() {
        let by_hand = |seconds, east| CraftTruth { stick_override: true, ..craft(seconds, east, 20.0) };
        let path = [
            craft(0.0, 1.0, 20.0),
            by_hand(1.0, 30.0),
            craft(2.0, 50.0, 20.0),
            craft(9.0, 1.5, 20.0),
            craft(10.0, 1.6, 20.0),
        ];
        for pattern in [Pattern::Point, Pattern::Figure8(50.0)] {
            let error = worst(&watch(pattern, 0.0, &path)).unwrap();
            assert!(error < 2.0, "{error}");
        }
        let stuck = [by_hand(1.0, 30.0), craft(2.0, 30.0, 20.0), craft(28.1, 29.0, 20.0)];
        assert_eq!(worst(&watch(Pattern::Point, 0.0, &stuck)), Some(29.0));
        assert_eq!(worst(&watch(Pattern::Point, 0.0, &[by_hand(1.0, 30.0)])), None);
    }

    #[test]
    fn the_altitude_counts_once_it_is_reached() {
        let climbing = [craft(0.0, 0.0, 50.0), craft(6.0, 0.0, 28.0), craft(7.0, 0.0, 17.0)];
        assert_eq!(watch(Pattern::Point, 30.0, &climbing).worst_alt_m(), Some(8.0));
        let fallen = [craft(0.0, 0.0, 20.0), craft(6.0, 0.0, 0.3)];
        assert!(watch(Pattern::Point, 0.0, &fallen).worst_alt_m().unwrap() < -19.0);
        let hurried = [craft(0.0, 0.0, 90.0), craft(3.0, 0.0, 80.0)];
        assert_eq!(watch(Pattern::Point, 70.0, &hurried).worst_alt_m(), Some(60.0), "the last it was");
    }
}
