//! The flight as a line: its states, its events, and the shown instant.
//!
//! ```text
//!  00:00.0 I────●─A━━━━━━━━━━━━H━━━━┃──────A─────────▲──L──── 03:12.4
//! ```
//!
//! A letter is at the start of a state. The line is thick up to the shown instant. Marks show alarms, arming and
//! touchdown. A long part in which nothing happens is folded into one column, `≈`.

mod columns;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use super::drawing;
use super::formatting::clock;
use super::shared::Shared;
use super::theme::Role;
use crate::signals::SimTime;
use crate::telemetry::{Mode, NavState};
use crate::timeline::{Mark, MarkKind, TimelineView};
use crate::ui::area::span;
use columns::Columns;

/// Returns the instant at a column; `None` beside the line.
pub(super) fn time_at(timeline: &TimelineView, area: Rect, column: u16) -> Option<SimTime> {
    Columns::new(timeline, area).time_at(column)
}

pub(super) fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let Some(timeline) = &state.view.timeline else { return };
    let theme = &state.theme;
    let columns = Columns::new(timeline, area);
    let shown = columns.column_of(state.view.vehicle.time);
    // The cursor of the graphs, if it is within the recording.
    let pointed_at = state.graphs.pointed_at().filter(|time| *time >= timeline.first);
    let pointed_at = pointed_at.map(|time| columns.column_of(time));
    let mut spans: Vec<Span<'_>> = vec![span(theme, Role::Dim, format!(" {} ", clock(timeline.first)))];
    let mut flying = NavState::Idle;
    // A record without states has only events.
    let has_states = state.view.replay.is_none()
        || timeline.marks.iter().any(|mark| matches!(mark.kind, MarkKind::State(_)));
    let mut marks = timeline.marks.iter().peekable();
    for column in 0..columns.width {
        let mut here: Option<Mark> = None;
        while let Some(mark) = marks.next_if(|mark| columns.column_of(mark.time) <= column) {
            if let MarkKind::State(to) = mark.kind {
                flying = to;
            }
            // A mark before the start of the line only sets its first state.
            let recorded = mark.time >= timeline.first;
            if recorded && here.is_none_or(|other| weight(mark.kind) >= weight(other.kind)) {
                here = Some(*mark);
            }
        }
        spans.push(if column == shown {
            span(theme, Role::Active, "┃")
        } else if Some(column) == pointed_at {
            span(theme, Role::Focus, "╋")
        } else if let Some(mark) = here {
            let (glyph, role) = appearance(mark.kind);
            span(theme, role, glyph)
        } else if columns.is_fold(column) {
            span(theme, Role::Dim, "≈")
        } else if column == 0 && has_states {
            span(theme, role_of(flying), letter(flying))
        } else {
            span(theme, role_of(flying), if column < shown { "━" } else { "─" })
        });
    }
    spans.push(span(theme, Role::Dim, format!(" {} ", clock(timeline.head))));
    drawing::line(buffer, area.x, area.y, &Line::from(spans), area.width);
}

/// Returns the weight of a mark; of several marks in one column the heaviest is shown.
fn weight(kind: MarkKind) -> u8 {
    match kind {
        MarkKind::Recovery => 0,
        MarkKind::Touchdown => 1,
        MarkKind::Armed | MarkKind::Disarmed => 2,
        MarkKind::State(_) | MarkKind::Modes(_) => 3,
        MarkKind::Alarm => 4,
    }
}

fn appearance(kind: MarkKind) -> (&'static str, Role) {
    match kind {
        MarkKind::Alarm => ("▲", Role::Fault),
        MarkKind::Armed => ("●", Role::Text),
        MarkKind::Disarmed => ("○", Role::Text),
        MarkKind::Touchdown => ("▼", Role::Text),
        MarkKind::Recovery => ("✓", Role::Ok),
        MarkKind::State(state) => (letter(state), role_of(state)),
        MarkKind::Modes(modes) if modes.has(Mode::Autopilot) => ("◆", Role::Target),
        MarkKind::Modes(_) => ("◇", Role::Title),
    }
}

fn letter(state: NavState) -> &'static str {
    match state {
        NavState::Idle => "I",
        NavState::Approaching => "A",
        NavState::Arrived => "R",
        NavState::Holding => "H",
        NavState::Orbiting => "O",
        NavState::Figure8 => "8",
        NavState::Landing => "L",
        NavState::Complete => "C",
    }
}

fn role_of(state: NavState) -> Role {
    match state {
        NavState::Idle => Role::Dim,
        NavState::Approaching => Role::Track,
        NavState::Arrived => Role::Title,
        NavState::Holding | NavState::Orbiting | NavState::Figure8 => Role::Key,
        NavState::Landing => Role::Warn,
        NavState::Complete => Role::Ok,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;
    use crate::telemetry::Snapshot;
    use crate::timeline::IdleSpan;
    use std::sync::Arc;

    fn at(seconds: u64) -> SimTime {
        SimTime(seconds * 1_000_000)
    }

    fn state(shown_s: u64) -> Shared {
        let mark = |seconds, kind| Mark { time: at(seconds), kind };
        let marks = vec![
            mark(5, MarkKind::State(NavState::Approaching)),
            mark(20, MarkKind::Armed),
            mark(40, MarkKind::State(NavState::Holding)),
            mark(41, MarkKind::Recovery),
            mark(70, MarkKind::Alarm),
        ];
        let timeline = TimelineView {
            first: at(10),
            head: at(100),
            rewound: true,
            marks: Arc::new(marks),
            ..TimelineView::default()
        };
        let vehicle = Arc::new(Snapshot { time: at(shown_s), ..Snapshot::default() });
        Shared::bare((80, 24), SessionView { vehicle, timeline: Some(timeline), ..SessionView::default() })
    }

    const AREA: Rect = Rect { x: 0, y: 0, width: 28, height: 1 };

    fn line(state: &Shared) -> String {
        let mut buffer = Buffer::empty(AREA);
        draw(state, AREA, &mut buffer);
        buffer.content().iter().map(ratatui::buffer::Cell::symbol).collect()
    }

    #[test]
    fn a_state_that_began_before_the_line_is_its_first() {
        assert_eq!(line(&state(55)), " 00:10.0 A●━H┃─▲─── 01:40.0 ");
    }

    #[test]
    fn waiting_after_the_flight_is_one_column() {
        let mut state = state(100_000);
        let timeline = state.view.timeline.as_mut().expect("a timeline");
        timeline.folds = vec![IdleSpan { from: at(100), to: at(100_000) }];
        timeline.head = at(100_000);
        // `1666:40.0` is wider than `01:40.0`.
        let area = Rect { width: AREA.width + 4, ..AREA };
        let mut buffer = Buffer::empty(area);
        draw(&state, area, &mut buffer);
        let shown: String = buffer.content().iter().map(ratatui::buffer::Cell::symbol).collect();
        assert_eq!(shown, " 00:10.0 A●━H━━▲━━━≈┃ 1666:40.0 ");
    }

    #[test]
    fn a_column_and_its_instant_belong_together() {
        let state = state(55);
        let timeline = state.view.timeline.as_ref().expect("a timeline");
        let columns = Columns::new(timeline, AREA);
        for column in 0..columns.width {
            let time = time_at(timeline, AREA, columns.x + column).expect("an instant");
            assert_eq!(columns.column_of(time), column);
        }
        assert_eq!(time_at(timeline, AREA, columns.x + columns.width - 1), Some(timeline.head));
        assert_eq!(time_at(timeline, AREA, columns.x + columns.width), None);
        assert_eq!(time_at(timeline, AREA, 0), None);
    }
}
