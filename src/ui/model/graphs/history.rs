//! The values of all signals over time, bounded: the last ten minutes in fine steps, two hours in coarse steps.

use std::collections::VecDeque;

use crate::replay::Picture;

/// The time between two fine samples, s, and their number: ten minutes.
const FINE: (f64, usize) = (0.1, 6000);
/// The time between two coarse samples, s, and their number: two hours.
const COARSE: (f64, usize) = (1.0, 7200);

#[derive(Debug, Default)]
pub(super) struct SignalHistory {
    fine: VecDeque<Picture>,
    coarse: VecDeque<Picture>,
}

impl SignalHistory {
    /// Returns the whole history of a flight that is over.
    pub(super) fn from_past(pictures: &[Picture]) -> Self {
        Self { fine: pictures.iter().copied().collect(), coarse: VecDeque::new() }
    }

    /// Adds a sample. An older one than the last belongs to a flight that continues from an earlier instant, so the
    /// samples after it are removed.
    pub(super) fn push(&mut self, sample: Picture) {
        for (ring, (interval_s, most)) in [(&mut self.fine, FINE), (&mut self.coarse, COARSE)] {
            while ring.back().is_some_and(|last| last.time_s() > sample.time_s()) {
                ring.pop_back();
            }
            // A little less than the interval, because pictures do not come at exact times.
            if ring.back().is_some_and(|last| sample.time_s() - last.time_s() < interval_s * 0.999) {
                continue;
            }
            if ring.len() == most {
                ring.pop_front();
            }
            ring.push_back(sample);
        }
    }

    pub(super) fn oldest(&self) -> Option<&Picture> {
        self.coarse.front().or(self.fine.front())
    }

    pub(super) fn newest(&self) -> Option<&Picture> {
        self.fine.back()
    }

    /// Returns the samples between two times, the oldest first: fine ones as far back as there are.
    pub(super) fn between(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &Picture> {
        let first_fine = self.fine.front().map_or(f64::INFINITY, Picture::time_s);
        let older = self.coarse.iter().take_while(move |sample| sample.time_s() < first_fine);
        older
            .skip_while(move |sample| sample.time_s() < from_s)
            .chain(self.fine.iter().skip(self.fine.partition_point(|sample| sample.time_s() < from_s)))
            .take_while(move |sample| sample.time_s() <= to_s)
    }

    /// Returns the newest sample that is not later than a time, or the oldest sample if all are later.
    pub(super) fn at(&self, time_s: f64) -> Option<&Picture> {
        let in_ring = |ring: &'_ VecDeque<Picture>| ring.partition_point(|sample| sample.time_s() <= time_s);
        let fine = in_ring(&self.fine).checked_sub(1).and_then(|at| self.fine.get(at));
        let coarse = || in_ring(&self.coarse).checked_sub(1).and_then(|at| self.coarse.get(at));
        fine.or_else(coarse).or(self.oldest())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signals::SimTime;
    use crate::telemetry::Snapshot;
    use crate::telemetry::signal::Signal;

    fn sample(time_s: f64) -> Picture {
        let mut vehicle = Snapshot { time: SimTime::from_secs_f64(time_s), ..Snapshot::default() };
        vehicle.estimate.alt = Some(time_s);
        Picture::of(&vehicle)
    }

    #[test]
    fn it_is_bounded_and_reaches_back_two_hours() {
        let mut history = SignalHistory::default();
        for tenth in 0..100_000 {
            history.push(sample(f64::from(tenth) / 10.0));
        }
        assert_eq!((history.fine.len(), history.coarse.len()), (6000, 7200));
        let all: Vec<f64> = history.between(0.0, 1e9).map(Picture::time_s).collect();
        assert!(all.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(all[0] < 2900.0 && all[all.len() - 1] > 9999.0, "{} {}", all[0], all[all.len() - 1]);
        assert_eq!(history.at(5000.4).map(Picture::time_s), Some(5000.0));
        assert_eq!(history.at(9990.05).and_then(|sample| sample.value(Signal::EstAltitude)), Some(9990.0));
    }

    #[test]
    fn a_flight_that_goes_on_from_an_earlier_instant_replaces_what_came_after() {
        let mut history = SignalHistory::default();
        for second in 0..50 {
            history.push(sample(f64::from(second)));
        }
        history.push(sample(20.5));
        assert_eq!(history.newest().map(Picture::time_s), Some(20.5));
        assert!(history.between(0.0, 100.0).all(|sample| sample.time_s() <= 20.5));
    }

    #[test]
    fn what_is_unknown_has_no_value() {
        assert_eq!(sample(1.0).value(Signal::CrossTrack), None);
    }
}
