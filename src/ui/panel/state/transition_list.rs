//! The last transitions of the state machine, the newest on top, and the search among them.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

use crate::telemetry::TransitionReason;
use crate::ui::area::{line, row, span};
use crate::ui::formatting::{clock, cut};
use crate::ui::model::action::{Action, PanelAction};
use crate::ui::model::event_log::Severity;
use crate::ui::model::message::{Change, Request};
use crate::ui::model::panel_table::Panel;
use crate::ui::search::has_all;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;
use crate::ui::transitions::{Transition, Transitions};

/// The room for the cause of a transition in the text that is searched.
const LONG: usize = 60;

/// Returns the transitions up to the shown instant that have the searched words, the newest first.
pub(super) fn found<'a>(
    own: &'a Transitions,
    state: &'a Shared,
) -> impl Iterator<Item = &'a Transition> + 'a {
    let words = own.search.words();
    own.shown(state).rev().filter(move |step| {
        let text = format!("{} {} → {} {}", clock(step.time), step.from, step.to, why(step, LONG));
        has_all(&text.to_lowercase(), &words)
    })
}

/// Goes to the next older match, or to the next newer one.
pub(super) fn next(own: &mut Transitions, state: &Shared, older: isize) -> Vec<Request> {
    if own.search.field.is_empty() {
        let key = state.key(Action::Panel(PanelAction::SearchTransitions));
        return vec![Change::Notify(Severity::Info, format!("No search yet: `{key}` begins.")).into()];
    }
    let last = found(own, state).count().saturating_sub(1);
    let to = own.scroll.saturating_add_signed(older).min(last);
    if to == own.scroll {
        let end = if older > 0 { "older" } else { "newer" };
        let text = format!("No {end} transition has {:?}.", own.search.field.value());
        return vec![Change::Say(Severity::Info, text).into()];
    }
    own.scroll = to;
    Vec::new()
}

/// Draws the matches in the whole panel, and the search below them. Returns the position of the cursor while it is
/// typed.
pub(super) fn draw_search(
    own: &Transitions,
    state: &Shared,
    area: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = &state.theme;
    let list = Rect { height: area.height.checked_sub(1)?, ..area };
    rows(own, state, list, own.scroll, buffer);
    if found(own, state).next().is_none() {
        let is_empty = own.shown(state).len() == 0;
        let text = if is_empty { "No transition yet." } else { "None has these words." };
        row(buffer, list, 0, theme, Role::Dim, text);
    }
    row(buffer, area, list.height, theme, Role::Key, "/");
    let field = Rect { x: area.x + 1, y: area.y + list.height, width: area.width.checked_sub(1)?, height: 1 };
    own.search.field.draw(theme, field.intersection(area), buffer).filter(|_| own.search.is_typing)
}

/// Draws the last transitions below their heading.
pub(super) fn draw(own: &Transitions, state: &Shared, area: Rect, buffer: &mut Buffer) {
    let transitions = own.shown(state);
    if area.height < 3 || transitions.len() == 0 {
        return;
    }
    let theme = &state.theme;
    let mut heading = vec![span(theme, Role::Title, "Transitions")];
    if state.focus == Panel::State {
        let key = state.key(Action::Panel(PanelAction::SearchTransitions));
        heading.push(span(theme, Role::Key, format!("  {key}")));
        heading.push(span(theme, Role::Dim, " searches"));
    }
    line(buffer, area, 1, &Line::from(heading));
    let list = Rect { y: area.y + 2, height: area.height - 2, ..area };
    let first = own.scroll.min(transitions.len().saturating_sub(usize::from(list.height)));
    rows(own, state, list, first, buffer);
}

fn rows(own: &Transitions, state: &Shared, area: Rect, first: usize, buffer: &mut Buffer) {
    let theme = &state.theme;
    let wide = area.width >= 40;
    for (at, step) in (0..area.height).zip(found(own, state).skip(first)) {
        let mut spans = vec![span(theme, Role::Dim, format!("{} ", clock(step.time)))];
        if wide {
            let states = format!("{} → {} ", step.from, step.to);
            let room = usize::from(area.width).saturating_sub(8 + states.chars().count());
            spans.push(span(theme, Role::Text, states));
            spans.push(span(theme, Role::Dim, cut(&why(step, room), room)));
        } else {
            spans.push(span(theme, Role::Text, step.to.to_string()));
        }
        line(buffer, area, at, &Line::from(spans));
    }
}

/// Returns the waypoint and the cause of a transition. The start of a mission uses the words of the log, without the
/// waypoint if there is no room.
pub(super) fn why(step: &Transition, room: usize) -> String {
    match step.reason {
        TransitionReason::Reset => {
            let long = format!("mission starts, WP{}", step.wp);
            if long.chars().count() > room { "mission starts".to_owned() } else { long }
        }
        reason => format!("WP{} {reason}", step.wp),
    }
}
