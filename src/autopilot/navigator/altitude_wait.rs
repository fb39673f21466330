//! The wait of a HOLD for its altitude: measures the time at its place without getting nearer to the altitude.

use crate::signals::SimTime;

/// The decrease of the altitude error within [`HELD_OFF_S`](crate::autopilot::machine::HELD_OFF_S) that lets the wait
/// go on, m: 0.2 m/s.
const PROGRESS_M: f64 = 2.0;

/// The wait, with its state for one leg.
#[derive(Debug, Clone, Default)]
pub(super) struct AltitudeWait {
    /// Altitude error at which progress was last seen, m.
    mark_m: Option<f64>,
    /// Time of that progress, or since when the craft has been at the place.
    since: Option<SimTime>,
}

impl AltitudeWait {
    /// Takes the altitude error of an update, m. Returns `true` if the craft has come nearer to its altitude.
    pub(super) fn update(&mut self, error_m: f64, is_at_place: bool, now: SimTime) -> bool {
        if !is_at_place {
            self.since = None;
            return false;
        }
        // A climb while the wind carried the craft off its place counts, too.
        let entered = self.since.is_none();
        let mark_m = self.mark_m.get_or_insert(error_m);
        if entered {
            *mark_m = mark_m.max(error_m);
            self.since = Some(now);
        }
        let has_progress = error_m <= *mark_m - PROGRESS_M;
        if has_progress {
            *mark_m = error_m;
            self.since = Some(now);
        }
        has_progress
    }

    /// Returns the time at the place without progress, s; 0 elsewhere.
    pub(super) fn held_off_s(&self, now: SimTime) -> f64 {
        self.since.map_or(0.0, |since| now.seconds_since(since))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the time held off after these altitude errors, one value per second.
    fn held_off_s(errors_m: impl IntoIterator<Item = (f64, bool)>) -> f64 {
        let mut wait = AltitudeWait::default();
        let mut now = SimTime::ZERO;
        for (error_m, is_at_place) in errors_m {
            now = SimTime(now.0 + 1_000_000);
            wait.update(error_m, is_at_place, now);
        }
        wait.held_off_s(now)
    }

    #[test]
    fn a_craft_that_climbs_slowly_is_waited_for_and_one_that_does_not_is_not() {
        let climbing = |rate: f64| held_off_s((0..60).map(|second| (30.0 - rate * f64::from(second), true)));
        assert!(climbing(0.25) < 10.0, "{}", climbing(0.25));
        assert!(climbing(0.0) >= 59.0, "{}", climbing(0.0));
    }

    #[test]
    fn only_the_time_at_the_place_counts() {
        let blown_off = (0..60).map(|second| (30.0, second % 8 != 0));
        assert!(held_off_s(blown_off) < 8.0);
        assert!(held_off_s([(30.0, true), (30.0, false)]) < 0.1);
    }
}
