//! 2 Plan: the waypoints of the open plan, edited in place, with what is wrong beside them and the altitudes below.

mod profile;
mod table;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

use super::{line, row, span};
use crate::plan::review::Finding;
use crate::ui::app_state::AppState;
use crate::ui::editor::findings;
use crate::ui::forecast;
use crate::ui::panel::Panel;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::Role;

/// Rows of the altitude profile, and the height of the panel from which it is there.
const PROFILE_ROWS: u16 = 6;
const PROFILE_FROM: u16 = 16;

/// The title: name of the plan, what of it is unsaved and what of it the craft does not have.
pub(crate) fn title(state: &AppState) -> String {
    let plan = state.editor.plan();
    let count = state.editor.plans().len();
    let which = if count > 1 { format!(" {}/{count}", state.editor.current() + 1) } else { String::new() };
    let unsaved = if plan.is_unsaved() { " ✎ unsaved" } else { "" };
    let disk = if plan.is_changed_on_disk() { " ▲ changed on disk" } else { "" };
    let craft = match &state.view.vehicle.stored_plan {
        _ if plan.document().plan.waypoints.is_empty() => String::new(),
        Some(stored) if *stored == plan.document().plan => " ✓ on the craft".to_owned(),
        Some(stored) => {
            format!(" ● {} not on the craft", table::differences(&plan.document().plan, stored))
        }
        None => " — on the craft?".to_owned(),
    };
    format!("{}{which} — {}{unsaved}{disk}{craft}", Panel::Plan.title(), plan.title())
}

/// Draws the inside; gives the place of the cursor while a cell is typed.
pub(crate) fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let theme = &state.theme;
    if state.plan().waypoints.is_empty() {
        let lines = [
            "No waypoints. `i` inserts one, `P` generates a pattern,",
            "`o` opens a file, `D` takes the plan of the craft;",
            "waypoint lines of a CLI can be pasted.",
        ];
        for (at, text) in lines.iter().enumerate() {
            row(buffer, area, at as u16, theme, Role::Dim, text);
        }
        return None;
    }
    let profile = if area.height >= PROFILE_FROM { PROFILE_ROWS } else { 0 };
    let findings = findings::findings(state);
    let below = below(state, &findings, usize::from(area.width));
    let mut below = below;
    if state.editor.field().is_none() {
        below.push(forecast::estimate_line(state, area.width));
    }
    let below_rows = (below.len() as u16).min(area.height.saturating_sub(2));
    let table = Rect { height: area.height.saturating_sub(below_rows + profile), ..area };
    let cursor = table::draw(state, &findings, table, buffer);
    let foot = Rect { y: area.y + table.height, height: below_rows, ..area };
    for (at, text) in below.iter().enumerate() {
        line(buffer, foot, at as u16, text);
    }
    if profile > 0 {
        let area = Rect { y: area.y + area.height - profile, height: profile, ..area };
        profile::draw(state, area, buffer);
    }
    cursor
}

/// What stands below the table: what is wrong with the value being typed, or the finding with its fix.
fn below(state: &AppState, findings: &[Finding], width: usize) -> Vec<Line<'static>> {
    let theme = &state.theme;
    let said = |role, text: &str| {
        let lines = wrapped(text, width);
        lines.into_iter().take(2).map(|text| Line::from(span(theme, role, text))).collect::<Vec<_>>()
    };
    if let Some(field) = state.editor.field() {
        let kind = state.plan().waypoints.get(state.editor.row()).map(|wp| wp.kind).unwrap_or_default();
        return match &field.problem {
            Some(problem) => said(Role::Fault, &format!("✗ {problem}")),
            None => said(Role::Dim, &state.editor.column().hint(kind)),
        };
    }
    let Some((finding, fix)) = findings::shown(state, findings) else {
        let difference = table::difference(state, state.editor.row());
        return difference.map_or_else(Vec::new, |text| said(Role::Dim, &text));
    };
    let (mark, role) = if finding.is_refusal() { ("✗", Role::Fault) } else { ("▲", Role::Warn) };
    let more = match findings.len() - 1 {
        0 => String::new(),
        more => format!(" (+{more})"),
    };
    let fix = fix.map(|fix| format!(" — f: {}", fix.title)).unwrap_or_default();
    said(role, &format!("{mark} {finding}{more}{fix}"))
}
