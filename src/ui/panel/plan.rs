//! 2 Plan: the waypoints of the open plan, edited in place, with their findings and the altitude profile below.

mod in_words;
mod legs;
mod profile;
mod table;

use crate::ui::acts::{estimate_line, findings, settings_in_force};
use crossterm::event::MouseEvent;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

use super::{Content, Hint};
use crate::plan::Altitude;
use crate::plan::review::Finding;
use crate::ui::area::{line, row, span};
use crate::ui::formatting::cut;
use crate::ui::model::action::{Action, EditAction};
use crate::ui::model::editor::Column;
use crate::ui::model::message::{Change, Request};
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::Role;

/// The panel height from which the altitude profile is always shown.
const PROFILE_FROM: u16 = 16;
/// The least number of rows of the altitude profile, and the greatest.
const PROFILE_ROWS: (u16, u16) = (6, 24);

/// The mouse on the altitude profile; the plan and the cursor are those of the editor.
#[derive(Debug, Default)]
pub(super) struct PlanPanel {
    /// The row where the mouse picked up an altitude, the metres per row, and that altitude, m.
    dragged: Option<(u16, f64, f64)>,
}

impl Content for PlanPanel {
    /// Returns the title: the name of the plan, its unsaved edits, and its differences from the craft.
    fn title(&self, state: &Shared) -> String {
        let plan = state.editor.plan();
        let count = state.editor.plans().len();
        let which =
            if count > 1 { format!(" {}/{count}", state.editor.current() + 1) } else { String::new() };
        let unsaved = if plan.is_unsaved() { " ✎ unsaved" } else { "" };
        let kept = if state.editor.journal_fails { " ✗ edits not kept" } else { "" };
        let disk = if plan.is_changed_on_disk() { " ▲ changed on disk" } else { "" };
        // It is temporary, so it is in front, where it is not cut off.
        if let Some(upload) = state.upload_of(plan.id()) {
            let uploading = format!("↑ uploading {}/{}", upload.sent, upload.total);
            return format!(
                "{}{which} — {uploading} {}{unsaved}",
                state.panel_title(Panel::Plan),
                plan.title()
            );
        }
        let craft = match &state.view.vehicle.stored_plan {
            _ if plan.document().plan.waypoints.is_empty() => String::new(),
            Some(_) if settings_in_force::has_settings_to_upload(state) => {
                " ● settings not on the craft".to_owned()
            }
            Some(stored) if *stored == plan.document().plan => " ✓ on the craft".to_owned(),
            Some(stored) => {
                format!(" ● {} not on the craft", table::differences(&plan.document().plan, stored))
            }
            None => " — on the craft?".to_owned(),
        };
        let selection = state.editor.selection().filter(|_| !state.plan().waypoints.is_empty());
        let selected = selection
            .map_or_else(String::new, |rows| format!(" · {} selected", rows.end() - rows.start() + 1));
        let title = plan.title();
        format!("{}{which} — {title}{selected}{unsaved}{kept}{disk}{craft}", state.panel_title(Panel::Plan))
    }

    /// Draws the inside. Returns the position of the cursor while a cell is typed.
    fn draw(&self, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = &state.theme;
        if state.plan().waypoints.is_empty() {
            for (at, text) in nothing_planned(state).iter().enumerate() {
                row(buffer, area, at as u16, theme, Role::Dim, text);
            }
            return None;
        }
        let findings = findings::findings(state);
        let below = below(state, &findings, area);
        let (table, foot, profile) = divided(state, area, below.len());
        let cursor = table::draw(state, &findings, table, buffer);
        for (at, text) in below.iter().enumerate() {
            line(buffer, foot, at as u16, text);
        }
        if let Some(area) = profile {
            profile::draw(state, area, buffer);
        }
        cursor
    }

    fn in_words(&self, state: &Shared) -> Vec<String> {
        in_words::lines(state)
    }

    fn hints(&self, _: &Shared) -> Vec<Hint> {
        vec![
            (&[Action::Edit(EditAction::Cell)], "edit"),
            (&[Action::Edit(EditAction::Insert)], "insert"),
            (&[Action::Edit(EditAction::Delete)], "delete"),
            (&[Action::Edit(EditAction::Select)], "select"),
            (&[Action::Edit(EditAction::Undo)], "undo"),
            (&[Action::Upload], "upload"),
            (&[Action::Edit(EditAction::Save)], "save"),
        ]
    }

    fn typing(&self, state: &Shared) -> Option<Action> {
        let is_word = matches!(state.editor.column(), Column::Type | Column::Pattern);
        (!is_word).then_some(Action::Edit(EditAction::Cell))
    }

    fn scroll(&mut self, _: &Shared, _: Rect, by: isize) -> Vec<Request> {
        vec![Change::PlanRows(by).into()]
    }

    /// Moves the cursor to the value under the mouse, or picks up a waypoint of the altitude profile.
    fn press(&mut self, state: &Shared, area: Rect, event: &MouseEvent) -> Vec<Request> {
        match target_at(state, area, (event.column, event.row)) {
            Some(PlanTarget::Cell(row, column)) => {
                vec![Change::PlanCell(row, column).into(), Request::Chosen]
            }
            Some(PlanTarget::Altitude(index)) => {
                let altitude = state.plan().waypoints.get(index).map(|wp| wp.altitude).unwrap_or_default();
                // The current scale: it changes with the altitude.
                let metres = metres_per_row(state, area).unwrap_or_default();
                self.dragged = Some((event.row, metres, altitude.above_home_m()));
                vec![
                    Change::PlanCell(index, Column::Altitude).into(),
                    Change::DragAltitude(index, altitude).into(),
                ]
            }
            None => Vec::new(),
        }
    }

    /// Drags an altitude of the profile, by whole metres or feet.
    fn drag(&mut self, state: &Shared, _: Rect, event: &MouseEvent) -> Vec<Request> {
        let (Some((index, _)), Some((from_row, metres, from_m))) =
            (state.editor.dragged_altitude, self.dragged)
        else {
            return Vec::new();
        };
        let rows = f64::from(from_row) - f64::from(event.row);
        let shown = state.units.length(from_m + rows * metres).round();
        let altitude = Altitude::above_home(state.units.metres(shown));
        vec![Change::DragAltitude(index, altitude).into()]
    }

    fn release(&mut self, state: &Shared) -> Vec<Request> {
        self.dragged = None;
        state.editor.dragged_altitude.map(|_| Change::DropAltitude.into()).into_iter().collect()
    }
}

/// An item of the panel under the mouse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PlanTarget {
    /// A value of the table.
    Cell(usize, Column),
    /// A waypoint of the altitude profile.
    Altitude(usize),
}

/// Returns the item at a cell of the screen.
fn target_at(state: &Shared, area: Rect, at: (u16, u16)) -> Option<PlanTarget> {
    if state.plan().waypoints.is_empty() {
        return None;
    }
    let (table, _, profile) = divided(state, area, below(state, &findings::findings(state), area).len());
    let cell = table::cell_at(state, table, at).map(|(row, column)| PlanTarget::Cell(row, column));
    cell.or_else(|| profile::waypoint_at(state, profile?, at).map(PlanTarget::Altitude))
}

/// Returns the height of a row of the altitude profile, m.
fn metres_per_row(state: &Shared, area: Rect) -> Option<f64> {
    let (_, _, profile) = divided(state, area, below(state, &findings::findings(state), area).len());
    profile::metres_per_row(state, profile?)
}

/// Divides the area into table, the lines below it, and profile. The profile takes the rows that a short plan leaves.
fn divided(state: &Shared, area: Rect, below_rows: usize) -> (Rect, Rect, Option<Rect>) {
    let below_rows = (below_rows as u16).min(area.height.saturating_sub(2));
    let waypoints = u16::try_from(state.plan().waypoints.len()).unwrap_or(u16::MAX);
    let left = area.height.saturating_sub(below_rows).saturating_sub(waypoints.saturating_add(1));
    let share = if area.height >= PROFILE_FROM { (area.height / 4).clamp(6, 12) } else { 0 };
    let profile = left.max(share).min(PROFILE_ROWS.1);
    let profile = if profile < PROFILE_ROWS.0 { 0 } else { profile };
    let table = Rect { height: area.height.saturating_sub(below_rows + profile), ..area };
    let foot = Rect { y: area.y + table.height, height: below_rows, ..area };
    let bottom = Rect { y: area.y + area.height - profile, height: profile, ..area };
    (table, foot, (profile > 0).then_some(bottom))
}

/// Returns the advice for an empty plan.
fn nothing_planned(state: &Shared) -> [String; 3] {
    use EditAction::{Download, Generate, Insert, Open};
    let [insert, generate, open, download] =
        [Insert, Generate, Open, Download].map(|action| state.key(Action::Edit(action)));
    [
        format!("No waypoints. `{insert}` inserts one, `{generate}` generates a pattern,"),
        format!("`{open}` opens a file, `{download}` takes the plan of the craft;"),
        "waypoint lines of a CLI can be pasted.".to_owned(),
    ]
}

/// Returns the lines below the table: the hint or the problem of the value being typed, else the finding with its fix,
/// and the estimate.
fn below(state: &Shared, findings: &[Finding], area: Rect) -> Vec<Line<'static>> {
    let mut lines = said_below(state, findings, usize::from(area.width));
    if state.editor.field().is_none() {
        // A table that fills the screen shows the legs, in columns if there is room.
        if state.zoomed && !table::has_legs(state, area.width) {
            let text = legs::line(state).map(|text| cut(&text, usize::from(area.width)));
            lines.extend(text.map(|text| Line::from(span(&state.theme, Role::Dim, text))));
        }
        lines.extend(estimate_line::lines(state, area.width));
    }
    lines
}

fn said_below(state: &Shared, findings: &[Finding], width: usize) -> Vec<Line<'static>> {
    let theme = &state.theme;
    let said = |role, text: &str| {
        let lines = wrapped(text, width);
        lines.into_iter().take(2).map(|text| Line::from(span(theme, role, text))).collect::<Vec<_>>()
    };
    if let Some(field) = state.editor.field() {
        let kind = state.plan().waypoints.get(state.editor.row()).map(|wp| wp.kind).unwrap_or_default();
        return match &field.problem {
            Some(problem) => said(Role::Fault, &format!("✗ {problem}")),
            None => said(Role::Dim, &state.editor.column().hint(kind, state.units)),
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
    let key = state.key(Action::Edit(EditAction::Fix));
    let fix = fix.map(|fix| format!(" — {key}: {}", fix.title)).unwrap_or_default();
    said(role, &state.units.in_sentence(format!("{mark} {finding}{more}{fix}")))
}
