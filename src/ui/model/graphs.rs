//! The graphs of a flight: the history of its signals, the shown plots, the time span, and the cursor.
//!
//! Signals and the series of a recorded flight are shown by name, too. `curves` has the part of the series that is shown.

mod chosen;
mod curves;
mod history;
mod plot;

pub(in crate::ui) use chosen::ChosenGraphs;
pub(in crate::ui) use plot::{PLOTS, Plot};

use crate::replay::{Overview, Picture};
use crate::session::SessionView;
use crate::signals::SimTime;
use crate::telemetry::Snapshot;
use crate::telemetry::signal::{SIGNALS, Signal, SignalInfo};
use crate::ui::model::map_point::MapPoint;
use curves::SeriesCurves;
use history::SignalHistory;

/// The selectable time spans, s.
const SPANS_S: [f64; 12] = [0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 7200.0];
/// The index of the shortest span of a flight without recorded series: its pictures come a few times a second.
const MIN_OF_PICTURES: usize = 4;
/// The index of the span at start.
const FIRST_SPAN: usize = 6;
/// The number of cursor steps in a span.
const CURSOR_STEPS: f64 = 60.0;

/// A graph of the Graphs panel.
#[derive(Debug, Clone, Copy)]
pub(in crate::ui) enum Graph<'a> {
    Plot(&'static Plot),
    /// The difference of a plot's last curve between two flights.
    Difference(&'static Plot),
    /// A recorded series or a signal, by name.
    Named(&'a str),
}

/// The state of the Graphs panel.
#[derive(Debug)]
pub struct GraphsState {
    history: SignalHistory,
    shown: [bool; PLOTS.len()],
    /// The plots whose difference between two flights is shown.
    differences: [bool; PLOTS.len()],
    /// The names of the series and signals that are shown as graphs of their own.
    series: Vec<String>,
    curves: SeriesCurves,
    has_series: bool,
    /// The signals that a recorded flight has; `None` while a vehicle flies.
    recorded: Option<Vec<Signal>>,
    span: usize,
    /// `true` if the plots and the span are those of an earlier run.
    is_restored: bool,
    cursor_s: Option<f64>,
}

impl Default for GraphsState {
    /// Returns a state that shows altitude, speed, cross-track error, roll and pitch over the last minute, and of two
    /// flights the differences of altitude and speed.
    fn default() -> Self {
        Self {
            history: SignalHistory::default(),
            shown: std::array::from_fn(|plot| plot < 5),
            differences: std::array::from_fn(|plot| plot < 2),
            series: Vec::new(),
            curves: SeriesCurves::default(),
            has_series: false,
            recorded: None,
            span: FIRST_SPAN,
            is_restored: false,
            cursor_s: None,
        }
    }
}

impl GraphsState {
    /// Shows the whole of a recorded flight. What was chosen for the one before stays chosen.
    pub(in crate::ui) fn load(&mut self, overview: &Overview) {
        if self.recorded.is_none() && !self.is_restored {
            self.shown = std::array::from_fn(|plot| plot < 7);
        }
        let is_recorded =
            |info: &&SignalInfo| overview.pictures.iter().any(|picture| picture.value(info.signal).is_some());
        self.recorded = Some(SIGNALS.iter().filter(is_recorded).map(|info| info.signal).collect());
        self.history = SignalHistory::from_past(&overview.pictures);
        self.has_series = !overview.series.is_empty();
        self.curves = SeriesCurves::default();
        self.cursor_s = None;
        self.change_span(0);
    }

    /// Returns the shown graphs, from top to bottom, without plots of which a recorded flight has nothing. Differences are
    /// shown if there are two flights.
    pub(in crate::ui) fn graphs(&self, has_two: bool) -> impl Iterator<Item = Graph<'_>> {
        let plots = PLOTS.iter().zip(self.shown.iter().zip(&self.differences));
        let plots = plots.filter(|(plot, _)| plot.curves.iter().any(|(signal, ..)| self.has(*signal)));
        let plots = plots.flat_map(move |(plot, (shown, difference))| {
            let difference = (*difference && has_two).then_some(Graph::Difference(plot));
            shown.then_some(Graph::Plot(plot)).into_iter().chain(difference)
        });
        plots.chain(self.series.iter().map(|name| Graph::Named(name)))
    }

    /// Returns `true` if a signal may have a value: in a recorded flight, if it has one at any instant.
    pub(in crate::ui) fn has(&self, signal: Signal) -> bool {
        self.recorded.as_ref().is_none_or(|recorded| recorded.contains(&signal))
    }

    /// Returns `true` if the row at this index of the list of plots is shown. After the plots come their differences.
    pub(in crate::ui) fn is_shown(&self, row: usize) -> bool {
        self.shown.iter().chain(&self.differences).nth(row).copied().unwrap_or(false)
    }

    /// Shows the row at this index of the list of plots, or hides it.
    pub(in crate::ui) fn toggle(&mut self, row: usize) {
        if let Some(shown) = self.shown.iter_mut().chain(&mut self.differences).nth(row) {
            *shown = !*shown;
        }
    }

    /// Returns `true` if the series or signal with this name is shown.
    pub(in crate::ui) fn shows_series(&self, name: &str) -> bool {
        self.series.iter().any(|shown| shown == name)
    }

    /// Shows a series or a signal, or hides it.
    pub(in crate::ui) fn toggle_series(&mut self, name: &str) {
        if self.shows_series(name) {
            self.series.retain(|shown| shown != name);
        } else {
            self.series.push(name.to_owned());
        }
    }

    /// Selects a longer time span, or a shorter one.
    pub(in crate::ui) fn change_span(&mut self, by: isize) {
        let shortest = if self.has_series { 0 } else { MIN_OF_PICTURES };
        self.span = self.span.saturating_add_signed(by).clamp(shortest, SPANS_S.len() - 1);
    }

    /// Returns the shown time span, s.
    pub(in crate::ui) fn span_s(&self) -> f64 {
        SPANS_S.get(self.span).copied().unwrap_or(60.0)
    }

    /// Returns the start and end of the shown time, s: up to the newest sample, or around an older cursor.
    pub(in crate::ui) fn window(&self, cursor_s: Option<f64>) -> (f64, f64) {
        let span = self.span_s();
        let newest = self.history.newest().map_or(0.0, Picture::time_s);
        let to =
            cursor_s.filter(|cursor| *cursor < newest - span).map_or(newest, |cursor| cursor + span / 2.0);
        let to = to.max(span);
        (to - span, to)
    }

    /// Moves the cursor by steps, starting from the newest sample if there is no cursor.
    pub(in crate::ui) fn move_cursor(&mut self, steps: f64) {
        let (Some(oldest), Some(newest)) = (self.history.oldest(), self.history.newest()) else { return };
        let from = self.cursor_s.unwrap_or(newest.time_s());
        let to = (from + steps * self.span_s() / CURSOR_STEPS).max(oldest.time_s());
        // Beyond the newest sample there is nothing to point at, so the graphs show the present again.
        self.cursor_s = (to < newest.time_s()).then_some(to);
    }

    pub(in crate::ui) fn leave_cursor(&mut self) {
        self.cursor_s = None;
    }

    /// Adds a picture to the history.
    pub(in crate::ui) fn record(&mut self, vehicle: &Snapshot) {
        self.history.push(Picture::of(vehicle));
    }

    /// Returns the instant of the cursor, s: of the user's cursor, else the earlier instant on the screen.
    pub(in crate::ui) fn cursor_s(&self, view: &SessionView) -> Option<f64> {
        self.cursor_s.or(view.is_rewound().then(|| view.vehicle.time.as_secs_f64()))
    }

    /// Returns the instant of the user's cursor.
    pub(in crate::ui) fn pointed_at(&self) -> Option<SimTime> {
        self.cursor_s.map(SimTime::from_secs_f64)
    }

    /// Returns the position of the craft at the user's cursor.
    pub(in crate::ui) fn cursor_place(&self) -> Option<MapPoint> {
        let sample = self.history.at(self.cursor_s?)?;
        let place = MapPoint::new(sample.value(Signal::North)?, sample.value(Signal::East)?);
        (place.n.is_finite() && place.e.is_finite()).then_some(place)
    }

    /// Returns the samples between two times.
    pub(in crate::ui) fn samples(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &Picture> {
        self.history.between(from_s, to_s)
    }

    /// Returns the values at the user's cursor, else at the instant on the screen.
    pub(in crate::ui) fn sample_now(&self, view: &SessionView) -> Option<Picture> {
        match self.cursor_s {
            Some(time_s) => self.history.at(time_s).copied(),
            // The history has ten samples a second, the picture on the screen is of the instant itself.
            None if view.is_rewound() => Some(Picture::of(&view.vehicle)),
            None => self.history.newest().copied(),
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
        assert_eq!(graphs.span_s(), 10.0);
        let series = vec![crate::replay::Series::new("debug[0]", "")];
        graphs.load(&Overview { series, ..Overview::default() });
        for _ in 0..20 {
            graphs.change_span(-1);
        }
        assert_eq!(graphs.span_s(), 0.1, "a log is finer than pictures");
        for _ in 0..20 {
            graphs.change_span(1);
        }
        assert_eq!(graphs.span_s(), 7200.0);
    }
}
