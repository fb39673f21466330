//! The popups of the plan editor: forms, the file browser, questions.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

use super::{line, row, span};
use crate::ui::editor::{
    Browser, ConversionLosses, EditorPopup, Form, FormField, FormKind, LossList, OpenPlan, Purpose, Question,
};
use crate::ui::popup::frame::{framed, popup};
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
const WIDTH: u16 = 72;

/// Draws the open popup in the middle, or a form at its place beside the map. Returns the position of the cursor.
pub(crate) fn draw(
    state: &Shared,
    area: Rect,
    beside: Option<Rect>,
    buffer: &mut Buffer,
) -> Option<Position> {
    match state.editor.popup.as_ref()? {
        EditorPopup::Form(open) => form(state, open, area, beside, buffer),
        EditorPopup::Browser(open) => browser(state, open, area, buffer),
        EditorPopup::Question(asked) => {
            question(state, asked, area, buffer);
            None
        }
        EditorPopup::Losses(list) => {
            losses(state, list, area, buffer);
            None
        }
    }
}

fn form(
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
    let reported = state.editor.form_reported(form);
    let (role, text) = match &reported {
        Ok(text) => (Role::Dim, text.clone()),
        Err(problem) => (Role::Fault, format!("✗ {problem}")),
    };
    let (label, width) = match beside {
        Some(place) => (NARROW_LABEL, place.width.saturating_sub(2)),
        None => (LABEL, WIDTH),
    };
    let foot = wrapped(&text, usize::from(width));
    let height = form.fields.len() as u16 + foot.len() as u16 + 2;
    let inside = match beside {
        Some(place) => framed(theme, place, title, buffer),
        None => popup(theme, area, (WIDTH, height), title, buffer),
    };
    let rows = inside.height.saturating_sub(foot.len() as u16 + 2).min(form.fields.len() as u16);
    let first = (form.at as u16 + 1).saturating_sub(rows);
    let mut cursor = None;
    for (at, field) in form.fields.iter().enumerate().skip(usize::from(first)).take(usize::from(rows)) {
        let y = at as u16 - first;
        let here = at == form.at;
        let role = if here { Role::Focus } else { Role::Text };
        row(buffer, inside, y, theme, role, &format!("{} {}", if here { "▸" } else { " " }, field.label));
        let width = value_width(field, inside.width.saturating_sub(label));
        let place = Rect { x: inside.x + label, y: inside.y + y, width, height: 1 };
        if field.choices.is_empty() {
            let position = field.text.draw(theme, place.intersection(inside), buffer);
            cursor = if here { position } else { cursor };
        } else {
            let text = format!("◂ {} ▸", field.text.value());
            row(buffer, place, 0, theme, role, &text);
        }
        let hint = Rect {
            x: place.x + place.width,
            width: inside.width.saturating_sub(label + place.width),
            ..place
        };
        row(buffer, hint, 0, theme, Role::Dim, &format!(" {}", field.hint));
    }
    for (at, text) in foot.iter().enumerate() {
        row(buffer, inside, rows + at as u16, theme, role, text);
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

fn browser(state: &Shared, browser: &Browser, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let theme = &state.theme;
    let title = match browser.purpose {
        Purpose::Open => "Open a plan",
        Purpose::Save(_) => "Save as",
        Purpose::Backdrop(_) => "Show a file under the plan",
    };
    let inside = popup(theme, area, (WIDTH, area.height.saturating_sub(6).min(22)), title, buffer);
    let directory = browser.listing.directory.display().to_string();
    let slash = if directory.ends_with('/') { "" } else { "/" };
    row(buffer, inside, 0, theme, Role::Dim, &format!(" {directory}{slash}"));
    row(buffer, inside, 1, theme, Role::Title, " name ");
    let name = Rect { x: inside.x + 6, y: inside.y + 1, width: inside.width.saturating_sub(6), height: 1 };
    let cursor = browser.text.draw(theme, name.intersection(inside), buffer);
    let rows = usize::from(inside.height.saturating_sub(4));
    let visible = browser.visible();
    let first = browser.at.unwrap_or(0).saturating_sub(rows.saturating_sub(1));
    if visible.is_empty() {
        let text = match browser.purpose {
            Purpose::Backdrop(_) => " No map (.geojson, .kml, .kmz, .gpx) and no directory here.",
            Purpose::Open | Purpose::Save(_) => " No plan and no directory here.",
        };
        row(buffer, inside, 2, theme, Role::Dim, text);
    }
    for (at, entry) in visible.iter().enumerate().skip(first).take(rows) {
        let here = browser.at == Some(at);
        let (mark, role) = if here { ("▸", Role::Focus) } else { (" ", Role::Text) };
        let slash = if entry.is_directory { "/" } else { "" };
        row(buffer, inside, 2 + (at - first) as u16, theme, role, &format!("{mark}{}{slash}", entry.name));
    }
    let action = match browser.purpose {
        Purpose::Open => "open",
        Purpose::Save(_) => "save",
        Purpose::Backdrop(_) => "show",
    };
    let keys =
        keys(state, &[("Enter", action), ("↑ ↓", "choose"), ("←", "directory above"), ("Esc", "close")]);
    line(buffer, inside, inside.height.saturating_sub(1), &keys);
    cursor
}

fn question(state: &Shared, question: &Question, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let title_of = |id| state.editor.plan_of(id).map_or_else(String::new, OpenPlan::title);
    let (title, text) = match question {
        Question::Replace { path, changed: true, .. } => {
            ("Changed on disk", format!("{} was changed elsewhere since it was read.", path.display()))
        }
        Question::Replace { path, changed: false, .. } => ("Replace?", format!("{} exists.", path.display())),
        Question::MovesTarget { change, .. } => ("Upload in flight?", change.clone()),
        Question::Unsaved { id, .. } => {
            ("Unsaved", question.unsaved(&title_of(*id), state.editor.loses_edits))
        }
    };
    let lines = wrapped(&format!("▲ {text}"), 58);
    let inside = popup(theme, area, (60, lines.len() as u16 + 2), title, buffer);
    for (at, text) in lines.iter().enumerate() {
        row(buffer, inside, at as u16, theme, Role::Warn, &format!(" {text}"));
    }
    let answers: Vec<(String, &str)> = question
        .answers(state.editor.loses_edits)
        .iter()
        .map(|(key, what)| (key.to_string(), *what))
        .collect();
    let answers: Vec<(&str, &str)> = answers.iter().map(|(key, what)| (key.as_str(), *what)).collect();
    line(buffer, inside, lines.len() as u16 + 1, &keys(state, &answers));
}

fn losses(state: &Shared, list: &LossList, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let ConversionLosses { conversion, lines, summary } = &list.losses;
    let width = area.width.saturating_sub(4).min(100);
    let columns = usize::from(width.saturating_sub(4));
    let lines: Vec<String> = lines.iter().skip(list.scroll).flat_map(|line| wrapped(line, columns)).collect();
    let most = area.height.saturating_sub(4).saturating_sub(5).max(1);
    let shown = (lines.len() as u16).min(most);
    let inside = popup(theme, area, (width, shown + 4), conversion.title(), buffer);
    let head = format!(" {} {summary}.", conversion.question());
    row(buffer, inside, 0, theme, Role::Warn, &head);
    for (at, line) in lines.iter().take(usize::from(shown)).enumerate() {
        row(buffer, inside, 2 + at as u16, theme, Role::Text, &format!(" {line}"));
    }
    let mut answers = vec![("y", conversion.action()), ("n", "leave it")];
    if list.scroll > 0 || lines.len() > usize::from(shown) {
        answers.push(("↑ ↓", "more"));
    }
    line(buffer, inside, inside.height.saturating_sub(1), &keys(state, &answers));
}

fn keys(state: &Shared, keys: &[(&str, &str)]) -> Line<'static> {
    let theme = &state.theme;
    let spans = keys.iter().flat_map(|(key, what)| {
        [span(theme, Role::Key, format!(" {key}")), span(theme, Role::Text, format!(" {what} "))]
    });
    Line::from(spans.collect::<Vec<_>>())
}
