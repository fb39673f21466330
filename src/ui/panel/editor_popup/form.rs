//! A form: its rows, and the field at a cell.

use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Position, Rect};

use super::{WIDTH, keys};
use crate::ui::area::{line, row};
use crate::ui::model::editor::{Form, FormClick, FormField, FormKind};
use crate::ui::popup::frame::{framed, place};
use crate::ui::shared::Shared;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::Role;

/// The columns of a form: labels, values, hints.
const LABEL: u16 = 14;
const VALUE: u16 = 30;
/// The columns of labels in a form beside the map.
const NARROW_LABEL: u16 = 12;
/// The least width of a typed value, and of a choice.
const NARROW: u16 = 9;
const NARROW_CHOICE: u16 = 21;

/// The places of a form's parts.
struct Places {
    frame: Rect,
    inside: Rect,
    /// The columns of the labels.
    label: u16,
    /// The first shown field, and the number of shown ones.
    first: u16,
    rows: u16,
    /// The lines below the fields: the result or the problem.
    foot: Vec<String>,
    foot_role: Role,
}

impl Places {
    /// Returns the places in the middle of an area, or beside the map.
    fn of(state: &Shared, form: &Form, area: Rect, beside: Option<Rect>) -> Self {
        let (foot_role, text) = match state.editor.form_reported(form) {
            Ok(text) => (Role::Dim, text),
            Err(problem) => (Role::Fault, format!("✗ {problem}")),
        };
        let (label, width) = match beside {
            Some(place) => (NARROW_LABEL, place.width.saturating_sub(2)),
            None => (LABEL, WIDTH),
        };
        let foot = wrapped(&text, usize::from(width));
        let fields = form.fields.len() as u16;
        let frame = beside.unwrap_or_else(|| place(area, (WIDTH, fields + foot.len() as u16 + 2)));
        let inside = frame.inner(Margin::new(1, 1));
        let rows = inside.height.saturating_sub(foot.len() as u16 + 2).min(fields);
        let first = (form.at as u16 + 1).saturating_sub(rows);
        Self { frame, inside, label, first, rows, foot, foot_role }
    }

    /// Returns the row of the value of a shown field.
    fn value(&self, at: u16, field: &FormField) -> Rect {
        let width = value_width(field, self.inside.width.saturating_sub(self.label));
        let x = self.inside.x + self.label;
        Rect { x, y: self.inside.y + at - self.first, width, height: 1 }
    }
}

/// Returns the click on a field for a cell of the screen; `None` beside the fields.
pub(crate) fn field_at(
    state: &Shared,
    form: &Form,
    area: Rect,
    beside: Option<Rect>,
    cell: (u16, u16),
) -> Option<FormClick> {
    let places = Places::of(state, form, area, beside);
    let rows = Rect { height: places.rows, ..places.inside };
    if !rows.contains(cell.into()) {
        return None;
    }
    let at = cell.1 - rows.y + places.first;
    let field = form.fields.get(usize::from(at))?;
    let value = places.value(at, field);
    let column = cell.0.checked_sub(value.x).filter(|column| *column < value.width);
    Some(FormClick { field: usize::from(at), column, width: value.width })
}

/// Draws a form. Returns the position of the cursor.
pub(super) fn draw(
    state: &Shared,
    form: &Form,
    area: Rect,
    beside: Option<Rect>,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = &state.theme;
    let title = match form.kind {
        FormKind::Bulk => "Change waypoints",
        FormKind::Generate => "Generate a pattern",
        FormKind::Properties => "Name, home, settings",
    };
    let places = Places::of(state, form, area, beside);
    let inside = framed(theme, places.frame, title, buffer);
    let mut cursor = None;
    let shown = (0..).zip(&form.fields).skip(usize::from(places.first)).take(usize::from(places.rows));
    for (at, field) in shown {
        let here = usize::from(at) == form.at;
        let role = if here { Role::Focus } else { Role::Text };
        let text = format!("{} {}", if here { "▸" } else { " " }, field.label);
        row(buffer, inside, at - places.first, theme, role, &text);
        let value = places.value(at, field);
        if field.choices.is_empty() {
            let position = field.text.draw(theme, value.intersection(inside), buffer);
            cursor = if here { position } else { cursor };
        } else {
            row(buffer, value, 0, theme, role, &format!("◂ {} ▸", field.text.value()));
        }
        let width = inside.right().saturating_sub(value.right());
        let hint = Rect { x: value.right(), width, ..value };
        row(buffer, hint, 0, theme, Role::Dim, &format!(" {}", field.hint));
    }
    for (at, text) in (0..).zip(&places.foot) {
        row(buffer, inside, places.rows + at, theme, places.foot_role, text);
    }
    let keys = keys(state, &[("Enter", "take"), ("↑ ↓", "next value"), ("Esc", "close")]);
    line(buffer, inside, inside.height.saturating_sub(1), &keys);
    cursor
}

/// Returns the width of a value. A narrow form shortens it so that the hint after it stays whole.
fn value_width(field: &FormField, columns: u16) -> u16 {
    let hint = field.hint.chars().count() as u16 + 1;
    let narrow = if field.choices.is_empty() { NARROW } else { NARROW_CHOICE };
    VALUE.min(columns.saturating_sub(hint).max(narrow)).min(columns)
}
