//! The seconds of a sweep as a line, a character or more a second.
//!
//! ```text
//!  0:00 ····················ooooooXX······· 1:12  · 53  o 6  X 1
//! ```

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr as _;

use crate::flight::sweep::Fate;
use crate::ui::area::span;
use crate::ui::drawing;
use crate::ui::model::survey::{SurveyState, Surveyed, SweepSoFar, mark, role};
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

/// The seconds in a line of text.
const LINE: usize = 60;

/// The flights from one line of text about them to the next.
const FLIGHTS_PER_LINE: u64 = 10;

impl SurveyState {
    /// Returns the line of text that the last reply completed: some seconds of a sweep, or the number of flights.
    pub(in crate::ui) fn completed_line(&self) -> Option<String> {
        let shown = self.shown.as_ref()?;
        match &shown.what {
            Surveyed::Sweep(sweep) => completed_line(sweep, shown.is_over),
            Surveyed::GoNoGo(flown, None) if *flown == 1 || flown.is_multiple_of(FLIGHTS_PER_LINE) => {
                self.line()
            }
            Surveyed::GoNoGo(..) => None,
        }
    }
}

/// Returns minutes and seconds.
fn clock(second: usize) -> String {
    format!("{}:{:02}", second / 60, second % 60)
}

/// Draws the line.
pub(in crate::ui) fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let Some(sweep) = state.survey.sweep() else { return };
    let theme = &state.theme;
    // The end of the plan is known from its estimate, until it is flown.
    let flown = sweep.points.len();
    let ahead = state.forecast.estimate().map_or(0, |estimate| estimate.time_s.max(0.0) as usize + 1);
    let seconds = if state.survey.is_flying() { flown.max(ahead) } else { flown }.max(1);
    let (left, right) = (format!(" {} ", clock(0)), format!(" {}  ", clock(seconds)));
    let counts = counts(sweep);
    let legend: usize = counts.iter().map(|(text, _)| text.width()).sum();
    let width = usize::from(area.width).saturating_sub(left.width() + right.width() + legend);
    let mut spans: Vec<Span<'_>> = vec![span(theme, Role::Dim, left)];
    for column in 0..width {
        let (from, to) = (column * seconds / width, ((column + 1) * seconds).div_ceil(width));
        let there = sweep.points.get(from.min(flown)..to.min(flown)).unwrap_or_default();
        spans.push(match there.iter().map(|point| point.fate).max() {
            Some(fate) => span(theme, role(fate), mark(fate)),
            None => span(theme, Role::Dim, "─"),
        });
    }
    spans.push(span(theme, Role::Dim, right));
    spans.extend(counts.into_iter().map(|(text, role)| span(theme, role, text)));
    drawing::line(buffer, area.x, area.y, &Line::from(spans), area.width);
}

/// Returns the marks with their numbers, and their colours.
fn counts(sweep: &SweepSoFar) -> Vec<(String, Role)> {
    let count = |fate| sweep.points.iter().filter(|point| point.fate == fate).count();
    let fates = [Fate::Home, Fate::Off, Fate::Lost];
    fates.map(|fate| (format!("{} {} ", mark(fate), count(fate)), role(fate))).into()
}

/// Returns the last line of text of the seconds when it is full, or when the sweep is over and it has not been returned.
fn completed_line(sweep: &SweepSoFar, is_over: bool) -> Option<String> {
    let is_full = sweep.points.len().is_multiple_of(LINE);
    let line = sweep.points.chunks(LINE).next_back().filter(|_| is_full != is_over)?;
    let start = line.first()?.second as usize;
    let marks: String = line.iter().map(|point| mark(point.fate)).collect();
    Some(format!("{:>5}  {marks}", clock(start)))
}
