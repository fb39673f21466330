//! The library of recorded flights without a screen: numbered flights.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::{Answered, list, press};
use crate::text::printable;
use crate::ui::app_state::AppState;
use crate::ui::model::flights::LibraryFlight;
use crate::ui::model::message::Msg;
use crate::ui::popup::{FlightsList, Popup};
use crate::ui::update::update;

/// The answers.
const ANSWERS: &str = "A number shows a flight, `again N` flies it again, `compare N M` shows two, `delete N` deletes one, an \
                       empty line leaves it.";

/// Returns the question; `None` until the library has been read.
pub(super) fn question(state: &AppState, open: &FlightsList) -> Option<Vec<String>> {
    let flights = &state.shared.flights;
    if let Some(question) = open.question(flights) {
        return Some(vec![format!("{question} y yes, n no.")]);
    }
    let rows = match flights.list.as_ref()? {
        Err(problem) => return Some(vec![problem.clone(), "An empty line leaves it.".to_owned()]),
        Ok(rows) => (1..).zip(rows).map(|(number, flight)| row(number, flight)),
    };
    let mut lines = list("Recorded flights, the newest first:".to_owned(), rows);
    lines.pop();
    lines.push(ANSWERS.to_owned());
    Some(lines)
}

fn row(number: usize, flight: &LibraryFlight) -> String {
    let LibraryFlight { verdict, duration, reason, .. } = flight;
    let reason = if reason.is_empty() { String::new() } else { format!(": {reason}") };
    let text = format!("{number} {} {duration} {verdict}{reason}", flight.name());
    printable::line(&text).into_owned()
}

/// Handles an answer.
///
/// # Errors
/// Returns the possible answers in a sentence; the question stays open.
pub(super) fn answer(state: &mut AppState, line: &str) -> Result<Answered, String> {
    let flights = &state.shared.flights;
    let Some(Popup::Flights(open)) = state.popups.last_mut() else { return Ok(Answered::default()) };
    if open.deleting.is_some() {
        let key = match line {
            "y" | "yes" => 'y',
            "" | "n" | "no" => 'n',
            _ => return Err("Answer y to delete it, n to keep it.".to_owned()),
        };
        return Ok(press(state, KeyCode::Char(key)).into());
    }
    if line.is_empty() {
        return Ok(press(state, KeyCode::Esc).into());
    }
    let words: Vec<&str> = line.split_whitespace().collect();
    let at = |number: &str| {
        let at = number.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
        at.filter(|at| *at < flights.all().len()).ok_or_else(|| ANSWERS.to_owned())
    };
    open.marked.clear();
    let code = match words[..] {
        [number] | ["again", number] | ["delete", number] => {
            open.selected = at(number)?;
            match words[0] {
                "delete" => KeyCode::Delete,
                "again" => {
                    let again = KeyEvent::new(KeyCode::Char('o'), KeyModifiers::CONTROL);
                    return Ok(update(state, Msg::Key(again)).into());
                }
                _ => KeyCode::Enter,
            }
        }
        ["compare", first, second] => {
            for at in [at(first)?, at(second)?] {
                open.selected = at;
                open.mark(flights);
            }
            KeyCode::Enter
        }
        _ => return Err(ANSWERS.to_owned()),
    };
    Ok(press(state, code).into())
}
