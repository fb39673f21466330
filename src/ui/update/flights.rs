//! The list of recorded flights: what its keys request, and the answers.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::ui::app_state::AppState;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::flights::LibraryFlight;
use crate::ui::popup::flights_list::FlightsKey;
use crate::ui::popup::{FlightsList, Popup};

/// The time between two looks at the library while its list is open.
const REFRESH: Duration = Duration::from_secs(2);

/// Opens the list.
pub(super) fn open(state: &mut AppState) -> Vec<Effect> {
    state.popups.push(Popup::Flights(FlightsList::default()));
    ask(state, Duration::ZERO)
}

/// Asks for the list of the library after a while, unless an answer is awaited.
fn ask(state: &mut AppState, after: Duration) -> Vec<Effect> {
    if state.shared.flights.ask() { vec![Effect::ListFlights { after }] } else { Vec::new() }
}

/// Carries out the result of a key or of the mouse.
pub(super) fn take(state: &mut AppState, result: FlightsKey) -> Vec<Effect> {
    match result {
        FlightsKey::Open => Vec::new(),
        FlightsKey::Left => {
            state.popups.pop();
            Vec::new()
        }
        FlightsKey::Show { files, again } => vec![Effect::ShowFlights { files, again }],
        FlightsKey::Delete(file) => vec![Effect::DeleteFlight(file)],
        FlightsKey::Refused(reason) => state.shared.only_notify(Severity::Warn, reason),
    }
}

/// Takes the list of the library.
pub(super) fn listed(state: &mut AppState, list: Result<Vec<LibraryFlight>, String>) -> Vec<Effect> {
    let flights = &mut state.shared.flights;
    let Some(Popup::Flights(open)) = state.popups.last_mut() else {
        flights.take(list);
        return Vec::new();
    };
    let selected = open.selected(flights).map(|flight| flight.file.clone());
    flights.take(list);
    open.follow(flights, selected);
    ask(state, REFRESH)
}

/// Reports that a flight was deleted, or why it stays.
pub(super) fn deleted(state: &mut AppState, file: &Path, result: Result<(), String>) -> Vec<Effect> {
    match result {
        Ok(()) => {
            state.shared.flights.forget(file);
            if let Some(Popup::Flights(open)) = state.popups.last_mut() {
                open.follow(&state.shared.flights, None);
            }
            state.shared.only_notify(Severity::Good, format!("{} is deleted.", name(file)))
        }
        Err(reason) => {
            state.shared.only_notify(Severity::Fault, format!("{} is not deleted: {reason}.", name(file)))
        }
    }
}

/// Reports that flights could not be shown.
pub(super) fn shown(state: &mut AppState, result: Result<(), String>) -> Vec<Effect> {
    match result {
        Ok(()) => Vec::new(),
        Err(reason) => state.shared.only_notify(Severity::Fault, reason),
    }
}

fn name(file: &Path) -> String {
    let name = file.file_name().map(PathBuf::from).unwrap_or_default();
    crate::text::printable::name(&name.display().to_string())
}
