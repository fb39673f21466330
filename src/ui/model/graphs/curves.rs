//! The curves of the recorded series, for the part of the flight that is shown and a little around it.

use super::GraphsState;
use crate::replay::{Curve, CurvesRequest, Series};
use crate::signals::SimTime;

/// The number of steps of the shown time, some two for each column of a wide screen.
const STEPS: usize = 800;
/// The length of a requested part, in shown times. A flight that plays then needs another part only now and then.
const PARTS: f64 = 3.0;

/// The curves that were requested and read.
#[derive(Debug, Default)]
pub(super) struct SeriesCurves {
    /// The newest request.
    requested: Option<CurvesRequest>,
    /// The newest answer with its request.
    read: Option<(CurvesRequest, Vec<Curve>)>,
}

impl GraphsState {
    /// Returns the request for the curves of a time, s, unless they are there or were requested. `all` are the series of
    /// the flight.
    pub(in crate::ui) fn wanted_curves(
        &self,
        all: &[Series],
        (from_s, to_s): (f64, f64),
    ) -> Option<CurvesRequest> {
        let index = |name: &String| all.iter().position(|series| series.name == *name);
        let series: Vec<usize> = self.series.iter().filter_map(index).collect();
        let span_s = to_s - from_s;
        let is_enough = |request: &&CurvesRequest| {
            let is_as_fine = (request.to.seconds_since(request.from) / PARTS - span_s).abs() < span_s / 100.0;
            let covers = request.from.as_secs_f64() <= from_s.max(0.0) && request.to.as_secs_f64() >= to_s;
            is_as_fine && covers && request.series == series
        };
        if series.is_empty() || self.curves.requested.as_ref().filter(is_enough).is_some() {
            return None;
        }
        let from_s = (from_s - span_s).max(0.0);
        let (from, to) = (SimTime::from_secs_f64(from_s), SimTime::from_secs_f64(from_s + PARTS * span_s));
        Some(CurvesRequest { series, from, to, steps: PARTS as usize * STEPS })
    }

    /// Records that curves were requested.
    pub(in crate::ui) fn request_curves(&mut self, request: CurvesRequest) {
        self.curves.requested = Some(request);
    }

    /// Takes the curves of the newest request. Those of an older one are dropped.
    pub(in crate::ui) fn take_curves(&mut self, request: CurvesRequest, curves: Vec<Curve>) {
        if self.curves.requested.as_ref() == Some(&request) {
            self.curves.read = Some((request, curves));
        }
    }

    /// Returns the curve of a series, by its index in the flight, that was read last.
    pub(in crate::ui) fn curve(&self, series: usize) -> Option<&Curve> {
        let (request, curves) = self.curves.read.as_ref()?;
        curves.get(request.series.iter().position(|read| *read == series)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::replay::Overview;

    fn series() -> Vec<Series> {
        ["gyroADC[0]", "motor[0]"].map(|name| Series::new(name, "")).to_vec()
    }

    fn graphs() -> GraphsState {
        let mut graphs = GraphsState::default();
        graphs.load(&Overview { series: series(), ..Overview::default() });
        graphs.toggle_series("motor[0]");
        graphs
    }

    #[test]
    fn a_part_of_the_flight_is_requested_once_and_lasts_a_while() {
        let (mut graphs, all) = (graphs(), series());
        let request = graphs.wanted_curves(&all, (10.0, 11.0)).unwrap();
        assert_eq!((request.series.as_slice(), request.from), (&[1][..], SimTime(9_000_000)));
        graphs.request_curves(request);
        // The flight plays on.
        assert_eq!(graphs.wanted_curves(&all, (10.9, 11.9)), None);
        assert!(graphs.wanted_curves(&all, (11.1, 12.1)).is_some());
        assert!(graphs.wanted_curves(&all, (10.0, 10.3)).is_some(), "a shorter time is finer");
        graphs.toggle_series("gyroADC[0]");
        assert!(graphs.wanted_curves(&all, (10.0, 11.0)).is_some(), "another series");
        ["gyroADC[0]", "motor[0]"].iter().for_each(|name| graphs.toggle_series(name));
        assert_eq!(graphs.wanted_curves(&all, (10.0, 11.0)), None, "nothing is shown");
    }

    #[test]
    fn the_curves_stay_until_newer_ones_are_there() {
        let (mut graphs, all) = (graphs(), series());
        let curve = |last| Curve::new(SimTime::ZERO, SimTime(last), vec![Some((0.0, 1.0))]);
        let first = graphs.wanted_curves(&all, (0.0, 1.0)).unwrap();
        graphs.request_curves(first.clone());
        assert_eq!(graphs.curve(1), None);
        graphs.take_curves(first.clone(), vec![curve(1)]);
        let second = graphs.wanted_curves(&all, (9.0, 10.0)).unwrap();
        graphs.request_curves(second.clone());
        graphs.take_curves(first, vec![curve(2)]);
        assert_eq!(graphs.curve(1), Some(&curve(1)), "the answer to an older request is dropped");
        graphs.take_curves(second, vec![curve(3)]);
        assert_eq!((graphs.curve(1), graphs.curve(0)), (Some(&curve(3)), None));
    }
}
