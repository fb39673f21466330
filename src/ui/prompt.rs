//! The popups as lines of text, and lines of input as answers, for use without a screen.

mod field;
mod file;
mod flights;
mod form;
mod graphs;

use crate::flight::forecast::WHAT_IFS;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::app_state::AppState;
use super::popup::{Popup, diff_view, what_if};
use super::update::{compare, run_line, update};
use super::{command, permission};
use crate::ui::acts::setting_changes::reset_question;
use crate::ui::model::editor::{EditorPopup, OpenPlan, Question};
use crate::ui::model::effect::Effect;
use crate::ui::model::files::ConversionLosses;
use crate::ui::model::message::Msg;

/// The last line of a list of choices.
const NONE: &str = "A number chooses, an empty line leaves it.";

/// The result of an answer.
#[derive(Debug, Default)]
pub(super) struct Answered {
    pub(super) effects: Vec<Effect>,
    /// The change, if the question stays open.
    pub(super) reported: Option<String>,
}

impl From<Vec<Effect>> for Answered {
    fn from(effects: Vec<Effect>) -> Self {
        Self { effects, reported: None }
    }
}

/// Returns `true` if the next line is an answer.
pub(super) fn is_open(state: &mut AppState) -> bool {
    state.shared.editor.popup.is_some() || !state.popups.is_empty() || field::is_open(state)
}

/// Returns the current question, one sentence or choice per line; `None` if there is none, or if its choices are not
/// known yet.
pub(super) fn question(state: &mut AppState) -> Option<Vec<String>> {
    of_popup(state).or_else(|| field::question(state))
}

fn of_popup(state: &AppState) -> Option<Vec<String>> {
    match &state.shared.editor.popup {
        Some(EditorPopup::Form(open)) => return Some(form::question(state, open)),
        Some(EditorPopup::Browser(browser)) => return file::question(browser),
        Some(EditorPopup::Question(question)) => return Some(decision(state, question)),
        Some(EditorPopup::Losses(open)) => return Some(differences(&open.losses)),
        None => {}
    }
    match state.popups.last()? {
        Popup::GoTo(go_to) => {
            let title =
                if state.shared.flies_older_plan() { "Continue on the new plan from" } else { "Go now to" };
            let waypoints = go_to.waypoints().map(|(index, kind)| format!("{index} {kind}"));
            Some(list(format!("{title} which waypoint?"), waypoints))
        }
        Popup::WhatIf { .. } => {
            let titles = WHAT_IFS.into_iter().map(|what_if| what_if.title).chain([what_if::GO_NO_GO.into()]);
            let choices = (1..).zip(titles).map(|(number, title)| format!("{number} {title}"));
            Some(list(what_if::title(command::flight::flies(&state.shared)).replace(':', "?"), choices))
        }
        Popup::Quit => Some(vec!["The craft is armed and flying ends here. Quit? y yes, n no.".to_owned()]),
        Popup::ResetSettings => Some(vec![format!("{} Go on? y yes, n no.", reset_question(&state.shared))]),
        Popup::Permission => Some(vec![format!("{} y yes, n no.", permission::question(&state.shared))]),
        Popup::Flights(open) => flights::question(state, open),
        Popup::Diff(view) => {
            let lines = diff_view::lines(&state.shared, view);
            Some(lines.into_iter().chain([diff_view::answers(&state.shared)]).collect())
        }
        Popup::Plots { .. } => Some(graphs::plots(state)),
        Popup::Signals(_) => Some(graphs::signals(state)),
        Popup::Help(_)
        | Popup::Guards { .. }
        | Popup::Layout
        | Popup::Actions(_)
        | Popup::CommandLine
        | Popup::Palette(_)
        | Popup::MapMenu(_) => None,
    }
}

fn differences(losses: &ConversionLosses) -> Vec<String> {
    let ConversionLosses { conversion, lines, summary } = losses;
    let title = format!("{}: {summary}.", conversion.title());
    let question = format!("{} {}.", conversion.question(), yes_or_no(losses));
    [title].into_iter().chain(lines.iter().cloned()).chain([question]).collect()
}

fn yes_or_no(losses: &ConversionLosses) -> String {
    format!("y {}, n leave it", losses.conversion.action())
}

/// Handles a line as the answer to the question.
///
/// # Errors
/// Returns the possible answers in a sentence; the question stays open.
pub(super) fn answer(state: &mut AppState, line: &str) -> Result<Answered, String> {
    let line = line.trim();
    let quits = line == "quit" || line == "app.quit";
    let loses_edits = state.shared.editor.loses_edits();
    match &state.shared.editor.popup {
        Some(EditorPopup::Form(_)) => return form::answer(state, line),
        Some(EditorPopup::Browser(_)) => return file::answer(state, line),
        // The journals keep the edits for the next start.
        Some(EditorPopup::Question(question)) if quits && question.offers_later(loses_edits) => {
            return Ok(vec![Effect::Quit].into());
        }
        Some(EditorPopup::Question(question)) => {
            let answers = question.answers(loses_edits);
            let found = answers.iter().find(|(key, what)| line == key.to_string() || line == *what);
            let key = match found {
                Some((key, _)) => *key,
                None if line.is_empty() => 'n',
                None => return Err(format!("Answer {}.", choices(question, loses_edits))),
            };
            return Ok(press(state, KeyCode::Char(key)).into());
        }
        Some(EditorPopup::Losses(open)) => {
            let key = match line {
                "y" | "yes" => 'y',
                "" | "n" | "no" => 'n',
                _ => return Err(format!("Answer {}.", yes_or_no(&open.losses))),
            };
            return Ok(press(state, KeyCode::Char(key)).into());
        }
        None => {}
    }
    let is_list = matches!(
        state.popups.last(),
        Some(
            Popup::GoTo(_)
                | Popup::WhatIf { .. }
                | Popup::Plots { .. }
                | Popup::Signals(_)
                | Popup::Flights(_)
        )
    );
    if quits && is_list {
        state.popups.clear();
        return Ok(run_line(state, line)?.into());
    }
    match state.popups.last() {
        Some(Popup::Quit) if quits || line == "y" || line == "yes" => {
            return Ok(press(state, KeyCode::Char('y')).into());
        }
        Some(Popup::Quit) if !matches!(line, "n" | "no" | "") => {
            return Err("Answer y to end, n to fly on.".to_owned());
        }
        Some(Popup::Permission | Popup::ResetSettings) if line == "y" || line == "yes" => {
            return Ok(press(state, KeyCode::Char('y')).into());
        }
        Some(Popup::Permission | Popup::ResetSettings) if matches!(line, "n" | "no" | "") => {
            return Ok(press(state, KeyCode::Char('n')).into());
        }
        Some(Popup::Permission | Popup::ResetSettings) => {
            return Err("Answer y to go on, n to change nothing.".to_owned());
        }
        Some(Popup::Flights(_)) => return flights::answer(state, line),
        Some(Popup::Diff(_)) if !line.is_empty() => {
            let against = diff_view::named(&state.shared, line)?;
            return Ok(compare(state, against).into());
        }
        Some(Popup::Plots { .. }) if !line.is_empty() => return graphs::choose_plot(state, line),
        Some(Popup::Signals(_)) if !line.is_empty() => return graphs::choose_signal(state, line),
        None => return Ok(field::answer(state, line).into()),
        Some(Popup::GoTo(_) | Popup::WhatIf { .. }) if !line.is_empty() => {
            let effects = match state.popups.last() {
                Some(Popup::GoTo(_)) => command::flight::go_to_waypoint(&state.shared, line)?,
                _ => command::flight::ask_what_if(&mut state.shared, line)?,
            };
            state.popups.pop();
            return Ok(effects.into());
        }
        _ => {}
    }
    state.popups.pop();
    Ok(Answered::default())
}

fn list(title: String, choices: impl Iterator<Item = String>) -> Vec<String> {
    std::iter::once(title).chain(choices).chain([NONE.to_owned()]).collect()
}

fn decision(state: &AppState, question: &Question) -> Vec<String> {
    let loses_edits = state.shared.editor.loses_edits();
    let text = match question {
        Question::Replace { path, changed: true, .. } => {
            format!("{} was changed elsewhere since it was read.", path.display())
        }
        Question::Replace { path, changed: false, .. } => format!("{} exists.", path.display()),
        Question::MovesTarget { change: text, .. } | Question::FliesWhich { difference: text, .. } => {
            text.clone()
        }
        Question::Unsaved { id, .. } => {
            let title = state.shared.editor.plan_of(*id).map_or_else(String::new, OpenPlan::title);
            question.unsaved(&title, loses_edits)
        }
    };
    let later = if question.offers_later(loses_edits) { "; quit once more ends, too" } else { "" };
    vec![format!("{text} Answer {}{later}.", choices(question, loses_edits))]
}

/// Returns the choices of a question, such as `s save, d discard, n stay`.
fn choices(question: &Question, loses_edits: bool) -> String {
    let answers = question.answers(loses_edits).iter().map(|(key, what)| format!("{key} {what}"));
    answers.collect::<Vec<_>>().join(", ")
}

fn press(state: &mut AppState, code: KeyCode) -> Vec<Effect> {
    update(state, Msg::Key(KeyEvent::new(code, KeyModifiers::NONE)))
}
#[cfg(test)]
mod tests;
