//! Keys and pasted text while the CLI panel has the focus.

use crossterm::event::{KeyCode, KeyEvent};

use crate::ui::action::Action;
use crate::ui::app_state::AppState;
use crate::ui::editor::FileRequest;
use crate::ui::event_log::Severity;
use crate::ui::history::LineField;
use crate::ui::message::Effect;
use crate::ui::panel::Panel;
use crate::ui::popup::Popup;

use super::view::{focus_neighbour, scroll_panel};

/// Handles a key while the CLI has the focus.
pub(super) fn cli_key(state: &mut AppState, event: KeyEvent) -> Vec<Effect> {
    match event.code {
        KeyCode::Enter => {
            let entered = state.cli.enter();
            let keep = entered.map(|line| Effect::Files(FileRequest::KeepLine(LineField::Cli, line)));
            let mut effects = run_cli(state);
            effects.extend(keep);
            return effects;
        }
        KeyCode::Tab => {
            if state.cli.input.is_empty() {
                return focus_neighbour(&mut state.shared, 1);
            }
            state.cli.complete(state.shared.cli_help);
        }
        KeyCode::Up => state.cli.older(),
        KeyCode::Down => state.cli.newer(),
        KeyCode::PageUp => scroll_panel(state, Panel::Cli, -10),
        KeyCode::PageDown => scroll_panel(state, Panel::Cli, 10),
        _ => {
            if state.cli.input.key(event) {
                state.cli.candidates.clear();
                state.cli.scroll = 0;
            }
        }
    }
    Vec::new()
}

/// Inserts pasted text into the field with the focus; a field of a single line gets the first line.
pub(super) fn paste(state: &mut AppState, text: &str) -> Vec<Effect> {
    let field = match state.popups.last_mut() {
        Some(Popup::CommandLine) => Some(&mut state.command_line.field),
        Some(Popup::Palette(palette)) => Some(&mut palette.query),
        Some(
            Popup::Help { .. }
            | Popup::GoTo(_)
            | Popup::MapMenu(_)
            | Popup::Plots { .. }
            | Popup::WhatIf { .. }
            | Popup::Guards { .. }
            | Popup::Permission
            | Popup::Quit,
        ) => None,
        None => super::fields::open(state),
    };
    if let Some(field) = field {
        field.insert(text.lines().next().unwrap_or_default());
        return Vec::new();
    }
    let first_line = text.lines().next().unwrap_or_default();
    if state.popups.is_empty()
        && state.shared.editor.popup.as_mut().is_some_and(|popup| popup.paste(first_line))
    {
        return Vec::new();
    }
    let is_covered = !state.popups.is_empty() || state.shared.editor.popup.is_some();
    if matches!(state.shared.focus, Panel::Plan | Panel::Map) && !is_covered {
        return super::plan::paste_text(&mut state.shared, text);
    }
    if state.shared.focus != Panel::Cli || is_covered {
        let [cli, plan] = [Panel::Cli, Panel::Plan].map(|panel| state.shared.key(Action::Show(panel)));
        let text = format!("Pasted text goes to the CLI ({cli}) or, as waypoints, to the plan ({plan}).");
        state.shared.notify(Severity::Info, text);
        return Vec::new();
    }
    state.cli.paste(text);
    run_cli(state)
}

/// Runs the next waiting line, if the firmware is free.
pub(super) fn run_cli(state: &mut AppState) -> Vec<Effect> {
    state.cli.next_to_run().map(Effect::Cli).into_iter().collect()
}
