//! A form without a screen: its values by number or name, one per line.

use crossterm::event::KeyCode;

use super::{Answered, press};
use crate::ui::acts::findings;
use crate::ui::app_state::AppState;
use crate::ui::model::editor::{EditorPopup, Form, FormField, FormKind};

/// Returns the question: the current values.
pub(super) fn question(state: &AppState, form: &Form) -> Vec<String> {
    let title = match form.kind {
        FormKind::Bulk => "Change waypoints.",
        FormKind::Generate => "Generate a pattern.",
        FormKind::Properties => "Name, home and settings of the plan.",
    };
    let fields = (1..).zip(&form.fields).map(|(number, field)| {
        let hint = hint(field);
        let hint = if hint.is_empty() { hint } else { format!(" ({hint})") };
        format!("{number} {} = {}{hint}", field.label, field.text.value()).replace(" =  ", " = — ")
    });
    let end = "NAME = VALUE or NUMBER = VALUE changes one, `take` takes them all, an empty line leaves it.";
    let lines = std::iter::once(title.to_owned()).chain(fields).chain([end.to_owned()]);
    lines.chain(reported(state, form)).collect()
}

/// Handles a line: a value, `take`, or nothing.
pub(super) fn answer(state: &mut AppState, line: &str) -> Result<Answered, String> {
    match line {
        "" => return Ok(press(state, KeyCode::Esc).into()),
        "take" => {
            let effects = press(state, KeyCode::Enter);
            return match &state.shared.editor.popup {
                Some(EditorPopup::Form(Form { problem: Some(problem), .. })) => Err(problem.clone()),
                _ => Ok(effects.into()),
            };
        }
        _ => {}
    }
    let Some(EditorPopup::Form(mut form)) = state.shared.editor.popup.take() else {
        return Ok(Answered::default());
    };
    let set = set(&mut form, line);
    state.shared.editor.popup = Some(EditorPopup::Form(form.clone()));
    state.shared.editor.follow_generator(findings::home(&state.shared));
    let reported = reported(state, &form);
    let value = set?;
    Ok(Answered {
        effects: Vec::new(),
        reported: Some(std::iter::once(value).chain(reported).collect::<Vec<_>>().join(": ")),
    })
}

/// Sets the value that a line names. Returns it with its name.
fn set(form: &mut Form, line: &str) -> Result<String, String> {
    let (name, value) = line.split_once('=').unwrap_or((line, ""));
    let (name, value) = (name.trim(), value.trim());
    let numbered = name.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
    let at = match numbered {
        Some(at) => Some(at).filter(|at| *at < form.fields.len()),
        None => form.fields.iter().position(|field| field.label == name),
    };
    let Some(field) = at.and_then(|at| form.fields.get(at)).filter(|_| line.contains('=')) else {
        let mut names: Vec<&str> = form.fields.iter().map(|field| field.label.as_str()).collect();
        names.dedup();
        return Err(format!("Write NAME = VALUE with one of {}; `take` takes them all.", names.join(", ")));
    };
    let label = field.label.clone();
    form.set(at.unwrap_or_default(), value)?;
    Ok(format!("{label} = {value}"))
}

/// Returns the unit, or the words of a choice.
fn hint(field: &FormField) -> String {
    if field.choices.is_empty() { field.hint.to_owned() } else { field.choices.join(", ") }
}

/// Returns the result that the form would give now, or the problem.
fn reported(state: &AppState, form: &Form) -> Option<String> {
    let reported = state.shared.editor.form_reported(form);
    Some(reported.unwrap_or_else(|problem| problem)).filter(|reported| !reported.is_empty())
}
