//! The popups of the plan editor: forms, the file browser, questions.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

mod browser;
mod form;

pub(crate) use browser::place_at;
pub(crate) use form::field_at;

use crate::ui::area::{line, row, span};
use crate::ui::model::editor::{EditorPopup, LossList, OpenPlan, Question};
use crate::ui::model::files::ConversionLosses;
use crate::ui::popup::frame::popup;
use crate::ui::shared::Shared;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::Role;

/// The width of the inside of a form and of a browser.
const WIDTH: u16 = 72;

/// Draws the open popup in the middle, or a form at its place beside the map. Returns the position of the cursor.
pub(crate) fn draw(
    state: &Shared,
    area: Rect,
    beside: Option<Rect>,
    buffer: &mut Buffer,
) -> Option<Position> {
    match state.editor.popup.as_ref()? {
        EditorPopup::Form(open) => form::draw(state, open, area, beside, buffer),
        EditorPopup::Browser(open) => browser::draw(state, open, area, buffer),
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

fn question(state: &Shared, question: &Question, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let title_of = |id| state.editor.plan_of(id).map_or_else(String::new, OpenPlan::title);
    let (title, text) = match question {
        Question::Replace { path, changed: true, .. } => {
            ("Changed on disk", format!("{} was changed elsewhere since it was read.", path.display()))
        }
        Question::Replace { path, changed: false, .. } => ("Replace?", format!("{} exists.", path.display())),
        Question::MovesTarget { change, .. } => ("Upload in flight?", change.clone()),
        Question::FliesWhich { difference, .. } => ("Fly which plan?", difference.clone()),
        Question::Unsaved { id, .. } => {
            ("Unsaved", question.unsaved(&title_of(*id), state.editor.loses_edits()))
        }
    };
    let lines = wrapped(&format!("▲ {text}"), 58);
    let inside = popup(theme, area, (60, lines.len() as u16 + 2), title, buffer);
    for (at, text) in lines.iter().enumerate() {
        row(buffer, inside, at as u16, theme, Role::Warn, &format!(" {text}"));
    }
    let answers: Vec<(String, &str)> = question
        .answers(state.editor.loses_edits())
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
