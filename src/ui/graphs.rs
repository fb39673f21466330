//! The graphs of a flight: the history of its signals, the shown plots, the time span, and the cursor.

mod history;
mod plot;

pub(super) use history::Sample;
pub(super) use plot::{PLOTS, Plot, Stroke};

use super::map_point::MapPoint;
use crate::session::SessionView;
use crate::signals::SimTime;
use crate::telemetry::Snapshot;
use crate::telemetry::signal::Signal;
use history::SignalHistory;

/// The selectable time spans, s.
const SPANS_S: [f64; 8] = [10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 7200.0];
/// The number of cursor steps in a span.
const CURSOR_STEPS: f64 = 60.0;

/// The state of the Graphs panel.
#[derive(Debug)]
pub struct GraphsState {
    history: SignalHistory,
    shown: [bool; PLOTS.len()],
    span: usize,
    cursor_s: Option<f64>,
}

impl Default for GraphsState {
    /// Returns a state that shows altitude, speed, cross-track error, roll and pitch over the last minute.
    fn default() -> Self {
        let shown = std::array::from_fn(|plot| plot < 5);
        Self { history: SignalHistory::default(), shown, span: 2, cursor_s: None }
    }
}

impl GraphsState {
    /// Returns the shown plots.
    pub(super) fn plots(&self) -> impl Iterator<Item = &'static Plot> + '_ {
        PLOTS.iter().zip(self.shown).filter_map(|(plot, shown)| shown.then_some(plot))
    }

    /// Returns `true` if the plot at this index of [`PLOTS`] is shown.
    pub(super) fn is_shown(&self, plot: usize) -> bool {
        self.shown.get(plot).copied().unwrap_or(false)
    }

    /// Shows a plot, or hides it.
    pub(super) fn toggle(&mut self, plot: usize) {
        if let Some(shown) = self.shown.get_mut(plot) {
            *shown = !*shown;
        }
    }

    /// Selects a longer time span, or a shorter one.
    pub(super) fn change_span(&mut self, by: isize) {
        self.span = self.span.saturating_add_signed(by).min(SPANS_S.len() - 1);
    }

    /// Returns the shown time span, s.
    pub(super) fn span_s(&self) -> f64 {
        SPANS_S.get(self.span).copied().unwrap_or(60.0)
    }

    /// Returns the start and end of the shown time, s: up to the newest sample, or around an older cursor.
    pub(super) fn window(&self, cursor_s: Option<f64>) -> (f64, f64) {
        let span = self.span_s();
        let newest = self.history.newest().map_or(0.0, |sample| sample.time_s);
        let to =
            cursor_s.filter(|cursor| *cursor < newest - span).map_or(newest, |cursor| cursor + span / 2.0);
        let to = to.max(span);
        (to - span, to)
    }

    /// Moves the cursor by steps, starting from the newest sample if there is no cursor.
    pub(super) fn move_cursor(&mut self, steps: f64) {
        let (Some(oldest), Some(newest)) = (self.history.oldest(), self.history.newest()) else { return };
        let from = self.cursor_s.unwrap_or(newest.time_s);
        let to = (from + steps * self.span_s() / CURSOR_STEPS).max(oldest.time_s);
        // Beyond the newest sample there is nothing to point at, so the graphs show the present again.
        self.cursor_s = (to < newest.time_s).then_some(to);
    }

    pub(super) fn leave_cursor(&mut self) {
        self.cursor_s = None;
    }

    /// Adds a picture to the history.
    pub(super) fn record(&mut self, vehicle: &Snapshot) {
        self.history.push(Sample::of(vehicle));
    }

    /// Returns the instant of the cursor, s: of the user's cursor, else the earlier instant on the screen.
    pub(super) fn cursor_s(&self, view: &SessionView) -> Option<f64> {
        self.cursor_s.or(view.is_rewound().then(|| view.vehicle.time.as_secs_f64()))
    }

    /// Returns the instant of the user's cursor.
    pub(super) fn pointed_at(&self) -> Option<SimTime> {
        self.cursor_s.map(SimTime::from_secs_f64)
    }

    /// Returns the position of the craft at the user's cursor.
    pub(super) fn cursor_place(&self) -> Option<MapPoint> {
        let sample = self.history.at(self.cursor_s?)?;
        let place = MapPoint::new(sample.value(Signal::North)?, sample.value(Signal::East)?);
        (place.n.is_finite() && place.e.is_finite()).then_some(place)
    }

    /// Returns the samples between two times.
    pub(super) fn samples(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &Sample> {
        self.history.between(from_s, to_s)
    }

    /// Returns the sample for a time, or the newest one without a time.
    pub(super) fn sample_at(&self, time_s: Option<f64>) -> Option<&Sample> {
        match time_s {
            Some(time_s) => self.history.at(time_s),
            None => self.history.newest(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flown(seconds: u32) -> (GraphsState, SessionView) {
        let (mut graphs, mut view) = (GraphsState::default(), SessionView::default());
        for tenth in 0..=seconds * 10 {
            let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
            vehicle.time = SimTime::from_secs_f64(f64::from(tenth) / 10.0);
            vehicle.estimate.alt = Some(f64::from(tenth));
            graphs.record(vehicle);
        }
        (graphs, view)
    }

    #[test]
    fn the_cursor_stays_in_the_history_and_in_the_window() {
        let (mut graphs, view) = flown(300);
        graphs.move_cursor(1.0);
        assert_eq!(graphs.cursor_s(&view), None, "there is nothing newer");
        for _ in 0..70 {
            graphs.move_cursor(-1.0);
        }
        let cursor = graphs.cursor_s(&view).expect("a cursor");
        let (from, to) = graphs.window(Some(cursor));
        assert!((from..to).contains(&cursor) && (to - from - 60.0).abs() < 1e-9, "{cursor} {from} {to}");
        for _ in 0..1000 {
            graphs.move_cursor(-1.0);
        }
        assert_eq!(graphs.cursor_s(&view), Some(0.0));
        graphs.leave_cursor();
        assert_eq!(graphs.pointed_at(), None);
    }

    #[test]
    fn spans_end_at_the_shortest_and_the_longest() {
        let mut graphs = GraphsState::default();
        for _ in 0..20 {
            graphs.change_span(-1);
        }
        assert_eq!(graphs.span_s(), SPANS_S[0]);
        for _ in 0..20 {
            graphs.change_span(1);
        }
        assert_eq!(graphs.span_s(), 7200.0);
    }
}
