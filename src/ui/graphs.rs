//! The graphs of a flight: the history of its signals, which plots are shown, over which time, and the cursor in it.

mod history;
mod signal;

pub(super) use history::Sample;
pub(super) use signal::{PLOTS, Plot, Quantity, Signal, Stroke};

use super::app_state::AppState;
use super::map_point::MapPoint;
use crate::signals::SimTime;
use history::SignalHistory;

/// The spans of time that can be shown, s.
const SPANS_S: [f64; 8] = [10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 7200.0];
/// A step of the cursor is this share of the span.
const CURSOR_STEPS: f64 = 60.0;

/// What the Graphs panel remembers.
#[derive(Debug)]
pub struct GraphsState {
    history: SignalHistory,
    shown: [bool; PLOTS.len()],
    span: usize,
    cursor_s: Option<f64>,
}

impl Default for GraphsState {
    /// Altitude, speed, cross-track and attitude of the last minute.
    fn default() -> Self {
        let shown = std::array::from_fn(|plot| plot < 5);
        Self { history: SignalHistory::default(), shown, span: 2, cursor_s: None }
    }
}

impl GraphsState {
    /// The plots that are shown.
    pub(super) fn plots(&self) -> impl Iterator<Item = &'static Plot> + '_ {
        PLOTS.iter().zip(self.shown).filter_map(|(plot, shown)| shown.then_some(plot))
    }

    /// Whether a plot is shown, by its place in [`PLOTS`].
    pub(super) fn is_shown(&self, plot: usize) -> bool {
        self.shown.get(plot).copied().unwrap_or(false)
    }

    /// Shows a plot, or no longer.
    pub(super) fn toggle(&mut self, plot: usize) {
        if let Some(shown) = self.shown.get_mut(plot) {
            *shown = !*shown;
        }
    }

    /// A longer span of time, or a shorter one.
    pub(super) fn change_span(&mut self, by: isize) {
        self.span = self.span.saturating_add_signed(by).min(SPANS_S.len() - 1);
    }

    /// The span of time that is shown, s.
    pub(super) fn span_s(&self) -> f64 {
        SPANS_S.get(self.span).copied().unwrap_or(60.0)
    }

    /// The time that is shown, from and to, s: up to the newest sample, or around an older cursor.
    pub(super) fn window(&self, cursor_s: Option<f64>) -> (f64, f64) {
        let span = self.span_s();
        let newest = self.history.newest().map_or(0.0, |sample| sample.time_s);
        let to =
            cursor_s.filter(|cursor| *cursor < newest - span).map_or(newest, |cursor| cursor + span / 2.0);
        let to = to.max(span);
        (to - span, to)
    }

    /// Moves the cursor by a step, from the newest sample when there is none.
    pub(super) fn move_cursor(&mut self, steps: f64) {
        let (Some(oldest), Some(newest)) = (self.history.oldest(), self.history.newest()) else { return };
        let from = self.cursor_s.unwrap_or(newest.time_s);
        let to = (from + steps * self.span_s() / CURSOR_STEPS).max(oldest.time_s);
        // Beyond the newest sample there is nothing to point at: the present is shown again.
        self.cursor_s = (to < newest.time_s).then_some(to);
    }

    /// Takes the cursor away; whether there was one.
    pub(super) fn leave_cursor(&mut self) -> bool {
        self.cursor_s.take().is_some()
    }

    /// The samples between two times.
    pub(super) fn samples(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &Sample> {
        self.history.between(from_s, to_s)
    }

    /// The sample that belongs to a time; the newest without one.
    pub(super) fn sample_at(&self, time_s: Option<f64>) -> Option<&Sample> {
        match time_s {
            Some(time_s) => self.history.at(time_s),
            None => self.history.newest(),
        }
    }
}

/// Takes the newest picture into the history.
pub(super) fn record(state: &mut AppState) {
    let sample = Sample::of(&state.view.vehicle);
    state.graphs.history.push(sample);
}

/// The instant that the cursor points at, s: the user's, else the earlier one that the screen shows.
pub(super) fn cursor_s(state: &AppState) -> Option<f64> {
    let shown = state.is_rewound().then(|| state.view.vehicle.time.as_secs_f64());
    state.graphs.cursor_s.or(shown)
}

/// The instant that the user points at.
pub(super) fn pointed_at(state: &AppState) -> Option<SimTime> {
    state.graphs.cursor_s.map(SimTime::from_secs_f64)
}

/// Where the craft was at the user's cursor.
pub(super) fn cursor_place(state: &AppState) -> Option<MapPoint> {
    let sample = state.graphs.history.at(state.graphs.cursor_s?)?;
    let place = MapPoint::new(sample.value(Signal::North)?, sample.value(Signal::East)?);
    (place.n.is_finite() && place.e.is_finite()).then_some(place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;

    fn flown(seconds: u32) -> AppState {
        let mut state = AppState::bare((80, 24), SessionView::default());
        for tenth in 0..=seconds * 10 {
            let vehicle = std::sync::Arc::make_mut(&mut state.view.vehicle);
            vehicle.time = SimTime::from_secs_f64(f64::from(tenth) / 10.0);
            vehicle.estimate.alt = Some(f64::from(tenth));
            record(&mut state);
        }
        state
    }

    #[test]
    fn the_cursor_stays_in_the_history_and_in_the_window() {
        let mut state = flown(300);
        state.graphs.move_cursor(1.0);
        assert_eq!(cursor_s(&state), None, "there is nothing newer");
        for _ in 0..70 {
            state.graphs.move_cursor(-1.0);
        }
        let cursor = cursor_s(&state).expect("a cursor");
        let (from, to) = state.graphs.window(Some(cursor));
        assert!((from..to).contains(&cursor) && (to - from - 60.0).abs() < 1e-9, "{cursor} {from} {to}");
        for _ in 0..1000 {
            state.graphs.move_cursor(-1.0);
        }
        assert_eq!(cursor_s(&state), Some(0.0));
        assert!(state.graphs.leave_cursor() && !state.graphs.leave_cursor());
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
