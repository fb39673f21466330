//! Handles keys while a popup is open.

use crate::ui::acts::setting_changes;
use crossterm::event::{KeyCode, KeyEvent};

use super::{act, arrange, diff, flights, map_menu, permission, run_line};
use crate::telemetry::InFlightCommand;
use crate::ui::app_state::AppState;
use crate::ui::command;
use crate::ui::model::action::Action;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::files::FileRequest;
use crate::ui::model::history::LineField;
use crate::ui::panel::graphs;
use crate::ui::popup::palette::Entry;
use crate::ui::popup::signal_list::SignalKey;
use crate::ui::popup::what_if::Choice;
use crate::ui::popup::{Outcome, Popup, command_line, guards, palette, signal_list, what_if};
use crate::vehicle::VehicleCommand;

/// Handles a key for the popup opened last; `found` is the action of the key without a popup.
pub(super) fn key(state: &mut AppState, event: KeyEvent, found: Option<Action>) -> Vec<Effect> {
    match state.popups.last_mut() {
        None => Vec::new(),
        Some(Popup::GoTo(question)) => {
            let outcome = question.key(event);
            let go_to = |index| VehicleCommand::InFlight(InFlightCommand::GoTo(index)).into();
            chosen(&mut state.popups, outcome).map(go_to).into_iter().collect()
        }
        Some(Popup::MapMenu(menu)) => {
            let (outcome, place) = (menu.key(event), menu.place);
            map_menu::take(state, place, outcome)
        }
        Some(Popup::WhatIf { selected }) => {
            let outcome = what_if::key(selected, event);
            match chosen(&mut state.popups, outcome) {
                None => Vec::new(),
                Some(Choice::GoNoGo) => act(state, Action::GoNoGo),
                Some(Choice::WhatIf(what_if)) => command::flight::fly_what_if(&mut state.shared, what_if),
            }
        }
        Some(Popup::Guards { selected }) => {
            let mut chosen = *selected;
            let stays = guards::key(&mut chosen, event);
            let chosen = guards::limit(&state.shared, chosen);
            match state.popups.last_mut() {
                Some(Popup::Guards { selected }) if stays => *selected = chosen,
                _ => {
                    state.popups.pop();
                }
            }
            Vec::new()
        }
        Some(Popup::Actions(menu)) => {
            let outcome = menu.key(event, found);
            chosen(&mut state.popups, outcome).map_or_else(Vec::new, |action| act(state, action))
        }
        Some(Popup::ResetSettings) => match event.code {
            KeyCode::Char('y' | 'Y') => {
                state.popups.pop();
                let reset = setting_changes::reset_all(&state.shared);
                setting_changes::change(&mut state.shared, reset)
            }
            KeyCode::Char('n' | 'N' | 'q') | KeyCode::Esc => {
                state.popups.pop();
                Vec::new()
            }
            _ => Vec::new(),
        },
        Some(Popup::Layout) => arrange::key(state, event, found),
        Some(Popup::Quit) => quit_key(state, event),
        Some(Popup::Permission) => match event.code {
            KeyCode::Char('y' | 'Y') => permission::permit(state),
            KeyCode::Char('n' | 'N' | 'q') | KeyCode::Esc => {
                permission::decline(state);
                Vec::new()
            }
            _ => Vec::new(),
        },
        Some(Popup::Plots { selected }) => {
            match event.code {
                KeyCode::Up | KeyCode::Char('k') => *selected = selected.saturating_sub(1),
                KeyCode::Down | KeyCode::Char('j') => {
                    *selected = (*selected + 1).min(graphs::choices(&state.shared).saturating_sub(1));
                }
                KeyCode::Enter | KeyCode::Char(' ') => state.shared.graphs.toggle(*selected),
                KeyCode::Esc => {
                    state.popups.pop();
                }
                _ => {}
            }
            Vec::new()
        }
        Some(Popup::Signals(list)) => {
            match signal_list::key(list, &state.shared, event) {
                SignalKey::Open => {}
                SignalKey::Left => {
                    state.popups.pop();
                }
                SignalKey::Toggle(name) => state.shared.graphs.toggle_series(&name),
            }
            Vec::new()
        }
        Some(Popup::Flights(list)) => {
            let result = list.key(&state.shared.flights, event);
            flights::take(state, result)
        }
        Some(Popup::Diff(view)) => {
            let result = view.key(&state.shared, event);
            diff::take(state, result)
        }
        Some(Popup::CommandLine) => {
            let outcome = command_line::key(&mut state.command_line, &state.shared, event);
            enter(state, outcome)
        }
        Some(Popup::Palette(palette)) => {
            let outcome = palette::key(palette, &state.shared.used, event);
            take_entry(state, outcome)
        }
        Some(Popup::Help(help)) => match help.key(event) {
            Some(outcome) => {
                chosen(&mut state.popups, outcome).map_or_else(Vec::new, |action| act(state, action))
            }
            None => {
                state.popups.pop();
                match found {
                    // Any other key closes the help and triggers its action, so that the user can try keys while
                    // reading.
                    None | Some(Action::Help | Action::Back | Action::Quit) => Vec::new(),
                    Some(action) => act(state, action),
                }
            }
        },
    }
}

/// Runs the line entered in the `:` line.
pub(super) fn enter(state: &mut AppState, outcome: Outcome<(String, bool)>) -> Vec<Effect> {
    let Some((line, is_new)) = chosen(&mut state.popups, outcome) else { return Vec::new() };
    let layout = state.popups.pop_if(|below| matches!(below, Popup::Layout));
    let mut effects = run_line(state, &line).unwrap_or_else(|sentence| {
        let sentence = state.shared.keymap.in_force(&sentence);
        state.shared.notify(Severity::Warn, sentence);
        // The user names the layout again.
        state.popups.extend(layout);
        Vec::new()
    });
    if is_new {
        // Before the line's own effects, so that `quit` is kept, too.
        effects.insert(0, Effect::Files(FileRequest::KeepLine(LineField::Command, line)));
    }
    effects
}

/// Runs the entry chosen in the palette, and remembers it.
pub(super) fn take_entry(state: &mut AppState, outcome: Outcome<Entry>) -> Vec<Effect> {
    let Some(entry) = chosen(&mut state.popups, outcome) else { return Vec::new() };
    state.shared.used.remember(entry.name());
    let mut effects = match entry {
        Entry::Action(spec) => act(state, spec.action),
        Entry::Command(command) => {
            open_command_line(state, &format!("{} ", command.name));
            Vec::new()
        }
    };
    let name = entry.name().to_owned();
    effects.insert(0, Effect::Files(FileRequest::KeepLine(LineField::Palette, name)));
    effects
}

/// Returns the choice in the popup opened last, which closes unless it stays open.
pub(super) fn chosen<T>(popups: &mut Vec<Popup>, outcome: Outcome<T>) -> Option<T> {
    let choice = match outcome {
        Outcome::Open => return None,
        Outcome::Left => None,
        Outcome::Chosen(choice) => Some(choice),
    };
    popups.pop();
    choice
}

/// Opens the `:` line with this text.
pub(super) fn open_command_line(state: &mut AppState, text: &str) {
    state.command_line.open(text);
    state.popups.push(Popup::CommandLine);
}

fn quit_key(state: &mut AppState, event: KeyEvent) -> Vec<Effect> {
    match event.code {
        KeyCode::Char('y' | 'Y') => {
            state.popups.pop();
            super::plan_popup::quit(&mut state.shared)
        }
        KeyCode::Char('n' | 'N') | KeyCode::Esc => {
            state.popups.pop();
            Vec::new()
        }
        _ => Vec::new(),
    }
}
