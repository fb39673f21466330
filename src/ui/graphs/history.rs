//! The values of all signals over time, bounded: the last ten minutes in fine steps, two hours in coarse steps.

use std::collections::VecDeque;

use crate::telemetry::Snapshot;
use crate::telemetry::signal::{Observed, Signal, SignalValues};

/// The time between two fine samples, s, and their number: ten minutes.
const FINE: (f64, usize) = (0.1, 6000);
/// The time between two coarse samples, s, and their number: two hours.
const COARSE: (f64, usize) = (1.0, 7200);

/// All signals at one instant.
#[derive(Debug, Clone, Copy)]
pub(in crate::ui) struct Sample {
    /// Simulated time, s.
    pub(in crate::ui) time_s: f64,
    values: SignalValues,
}

impl Sample {
    /// Returns the signals of a picture.
    pub(super) fn of(vehicle: &Snapshot) -> Self {
        let mut values = SignalValues::of(&Observed::of(vehicle));
        // A navigator that flies nothing keeps the values of its last mission.
        if !vehicle.is_engaged() {
            for signal in [Signal::TargetAltitude, Signal::CrossTrack, Signal::WpDistance] {
                values.set(signal, f64::NAN);
            }
        }
        // The curve is the horizontal wind.
        let wind = values.get(Signal::WindNorth).hypot(values.get(Signal::WindEast));
        values.set(Signal::Wind, wind);
        // A real craft has no truth.
        for (truth, estimate) in [(Signal::North, Signal::EstNorth), (Signal::East, Signal::EstEast)] {
            if values.get(truth).is_nan() {
                values.set(truth, values.get(estimate));
            }
        }
        Self { time_s: vehicle.time.as_secs_f64(), values }
    }

    /// Returns the value of a signal, if it is known.
    pub(in crate::ui) fn value(&self, signal: Signal) -> Option<f64> {
        Some(self.values.get(signal)).filter(|value| value.is_finite())
    }
}

#[derive(Debug, Default)]
pub(super) struct SignalHistory {
    fine: VecDeque<Sample>,
    coarse: VecDeque<Sample>,
}

impl SignalHistory {
    /// Adds a sample. An older one than the last belongs to a flight that continues from an earlier instant, so the
    /// samples after it are removed.
    pub(super) fn push(&mut self, sample: Sample) {
        for (ring, (interval_s, most)) in [(&mut self.fine, FINE), (&mut self.coarse, COARSE)] {
            while ring.back().is_some_and(|last| last.time_s > sample.time_s) {
                ring.pop_back();
            }
            // A little less than the interval, because pictures do not come at exact times.
            if ring.back().is_some_and(|last| sample.time_s - last.time_s < interval_s * 0.999) {
                continue;
            }
            if ring.len() == most {
                ring.pop_front();
            }
            ring.push_back(sample);
        }
    }

    pub(super) fn oldest(&self) -> Option<&Sample> {
        self.coarse.front()
    }

    pub(super) fn newest(&self) -> Option<&Sample> {
        self.fine.back()
    }

    /// Returns the samples between two times, the oldest first: fine ones as far back as there are.
    pub(super) fn between(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &Sample> {
        let first_fine = self.fine.front().map_or(f64::INFINITY, |sample| sample.time_s);
        let older = self.coarse.iter().take_while(move |sample| sample.time_s < first_fine);
        older
            .skip_while(move |sample| sample.time_s < from_s)
            .chain(self.fine.iter().skip(self.fine.partition_point(|sample| sample.time_s < from_s)))
            .take_while(move |sample| sample.time_s <= to_s)
    }

    /// Returns the newest sample that is not later than a time, or the oldest sample if all are later.
    pub(super) fn at(&self, time_s: f64) -> Option<&Sample> {
        let in_ring = |ring: &'_ VecDeque<Sample>| ring.partition_point(|sample| sample.time_s <= time_s);
        let fine = in_ring(&self.fine).checked_sub(1).and_then(|at| self.fine.get(at));
        let coarse = || in_ring(&self.coarse).checked_sub(1).and_then(|at| self.coarse.get(at));
        fine.or_else(coarse).or(self.oldest())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signals::SimTime;

    fn sample(time_s: f64) -> Sample {
        let mut vehicle = Snapshot { time: SimTime::from_secs_f64(time_s), ..Snapshot::default() };
        vehicle.estimate.alt = Some(time_s);
        Sample::of(&vehicle)
    }

    #[test]
    fn it_is_bounded_and_reaches_back_two_hours() {
        let mut history = SignalHistory::default();
        for tenth in 0..100_000 {
            history.push(sample(f64::from(tenth) / 10.0));
        }
        assert_eq!((history.fine.len(), history.coarse.len()), (6000, 7200));
        let all: Vec<f64> = history.between(0.0, 1e9).map(|sample| sample.time_s).collect();
        assert!(all.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(all[0] < 2900.0 && all[all.len() - 1] > 9999.0, "{} {}", all[0], all[all.len() - 1]);
        assert_eq!(history.at(5000.4).map(|sample| sample.time_s), Some(5000.0));
        assert_eq!(history.at(9990.05).and_then(|sample| sample.value(Signal::EstAltitude)), Some(9990.0));
    }

    #[test]
    fn a_flight_that_goes_on_from_an_earlier_instant_replaces_what_came_after() {
        let mut history = SignalHistory::default();
        for second in 0..50 {
            history.push(sample(f64::from(second)));
        }
        history.push(sample(20.5));
        assert_eq!(history.newest().map(|sample| sample.time_s), Some(20.5));
        assert!(history.between(0.0, 100.0).all(|sample| sample.time_s <= 20.5));
    }

    #[test]
    fn what_is_unknown_has_no_value() {
        assert_eq!(sample(1.0).value(Signal::CrossTrack), None);
    }
}
