//! A text field of a panel without a screen: the next line is its text.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::press;
use crate::ui::app_state::AppState;
use crate::ui::model::effect::Effect;
use crate::ui::model::message::Msg;
use crate::ui::model::panel_table::Panel;
use crate::ui::update::update;

/// Returns `true` if a value of the plan is being typed.
fn is_cell(state: &AppState) -> bool {
    state.shared.focus == Panel::Plan && state.shared.editor.field().is_some()
}

/// Returns `true` if the focused panel has an open text field. The command line of the firmware has a command instead.
pub(super) fn is_open(state: &mut AppState) -> bool {
    let focus = state.shared.focus;
    is_cell(state) || !focus.takes_text() && state.panels.of_mut(focus).field().is_some()
}

/// Returns the question: the text of the field, and the allowed values or the problem with the last one.
pub(super) fn question(state: &mut AppState) -> Option<Vec<String>> {
    if !is_open(state) {
        return None;
    }
    let editor = &state.shared.editor;
    let (text, help) = match editor.field().filter(|_| is_cell(state)) {
        Some(cell) => {
            let kind = state.shared.plan().waypoints.get(editor.row()).map(|wp| wp.kind).unwrap_or_default();
            let column = editor.column();
            let hint = || format!("{} ({}).", column.name(), column.hint(kind, state.shared.units));
            (cell.text.value().to_owned(), cell.problem.clone().unwrap_or_else(hint))
        }
        None => {
            let field = state.panels.of_mut(state.shared.focus).field()?;
            (field.value().to_owned(), "A value.".to_owned())
        }
    };
    let now = if text.is_empty() { String::new() } else { format!(" Now {text}.") };
    Some(vec![format!("{help}{now} A line sets it, an empty line leaves it.")])
}

/// Handles a line as the text of the field.
pub(super) fn answer(state: &mut AppState, line: &str) -> Vec<Effect> {
    if line.is_empty() {
        return press(state, KeyCode::Esc);
    }
    let clear = KeyEvent::new(KeyCode::Char('u'), KeyModifiers::CONTROL);
    let mut effects = update(state, Msg::Key(KeyEvent::new(KeyCode::End, KeyModifiers::NONE)));
    effects.extend(update(state, Msg::Key(clear)));
    for key in line.chars() {
        effects.extend(press(state, KeyCode::Char(key)));
    }
    effects.extend(press(state, KeyCode::Enter));
    effects
}
