//! Keys and the mouse for a user interface without a terminal, and the text of its screen.

#![allow(dead_code, reason = "tests share this file and use different parts")]

use betadeck::ui::files::FileRequest;
use betadeck::ui::keymap::KeyPress;
use betadeck::ui::{AppState, Effect, Msg, draw, update};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

use super::fixture;

/// Returns a user interface with a craft that has a fix and waits at home.
pub(crate) fn state_with_fix(size: (u16, u16)) -> AppState {
    let mut state = fixture::state(size, fixture::colour());
    let flight = fixture::SimpleFlight { time_s: 8.0, fix: true, ..fixture::SimpleFlight::default() };
    update(&mut state, Msg::View(fixture::view(&flight)));
    state
}

/// Presses keys by their names in the keymap, separated by blanks. A name that begins with `'` is typed as text.
pub(crate) fn keys(state: &mut AppState, keys: &str) -> Vec<Effect> {
    let mut effects = Vec::new();
    for name in keys.split_whitespace() {
        if let Some(text) = name.strip_prefix('\'') {
            for c in text.chars() {
                effects.extend(press(state, c));
            }
            continue;
        }
        assert!(KeyPress::parse(name).is_some(), "{name}");
        let (modifiers, rest) = match name.split_once('-') {
            Some(("ctrl", rest)) => (KeyModifiers::CONTROL, rest),
            Some(("alt", rest)) => (KeyModifiers::ALT, rest),
            Some(("shift", rest)) => (KeyModifiers::SHIFT, rest),
            _ => (KeyModifiers::NONE, name),
        };
        let code = match rest {
            "up" => KeyCode::Up,
            "down" => KeyCode::Down,
            "left" => KeyCode::Left,
            "right" => KeyCode::Right,
            "enter" => KeyCode::Enter,
            "esc" => KeyCode::Esc,
            "tab" => KeyCode::Tab,
            "backspace" => KeyCode::Backspace,
            function if function.len() == 2 && function.starts_with('f') => {
                KeyCode::F(function[1..].parse().expect("a function key"))
            }
            c => KeyCode::Char(c.chars().next().expect("a key")),
        };
        effects.extend(with_modifiers(state, code, modifiers));
    }
    effects
}

/// Presses a key without modifiers.
pub(crate) fn key(state: &mut AppState, code: KeyCode) -> Vec<Effect> {
    with_modifiers(state, code, KeyModifiers::NONE)
}

/// Types a character.
pub(crate) fn press(state: &mut AppState, c: char) -> Vec<Effect> {
    key(state, KeyCode::Char(c))
}

fn with_modifiers(state: &mut AppState, code: KeyCode, modifiers: KeyModifiers) -> Vec<Effect> {
    update(state, Msg::Key(KeyEvent::new(code, modifiers)))
}

/// Returns the text of the screen, each line in quotes.
pub(crate) fn screen(state: &AppState) -> String {
    drawn(state).to_string()
}

/// Returns the drawn screen.
pub(crate) fn drawn(state: &AppState) -> TestBackend {
    let (width, height) = state.shared.size;
    let mut terminal = Terminal::new(TestBackend::new(width, height)).expect("a test terminal");
    terminal.draw(|frame| draw(state, frame)).expect("drawing in memory");
    terminal.backend().clone()
}

pub(crate) fn journal_lines(effects: &[Effect]) -> usize {
    effects.iter().filter(|effect| matches!(effect, Effect::Files(FileRequest::Journal(..)))).count()
}

/// Sends a mouse event with the left button at a cell.
pub(crate) fn mouse(
    state: &mut AppState,
    kind: fn(MouseButton) -> MouseEventKind,
    (column, row): (u16, u16),
) -> Vec<Effect> {
    mouse_button(state, kind(MouseButton::Left), (column, row))
}

/// Sends any mouse event at a cell.
pub(crate) fn mouse_button(
    state: &mut AppState,
    kind: MouseEventKind,
    (column, row): (u16, u16),
) -> Vec<Effect> {
    update(state, Msg::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE }))
}

/// Returns the cell where a text begins on the screen, or the last one of several.
pub(crate) fn place_of(state: &AppState, text: &str) -> (u16, u16) {
    let seen = screen(state);
    let found =
        seen.lines().enumerate().filter_map(|(row, line)| Some((row, line, line.rfind(text)?))).last();
    let (row, line, at) = found.unwrap_or_else(|| panic!("no {text} in\n{seen}"));
    // Each line of the screen is in quotes.
    (line[..at].chars().count() as u16 - 1, row as u16)
}

/// Returns the cell of a waypoint's number in the altitude profile.
pub(crate) fn place_in_profile(state: &AppState, number: char) -> (u16, u16) {
    let seen = screen(state);
    let rows = seen.lines().enumerate().skip_while(|(_, line)| !line.contains("altitude and distance in"));
    let rows = rows.skip(1).take_while(|(_, line)| !line.contains('└'));
    let place = rows.filter_map(|(row, line)| {
        let cells: Vec<char> = line.chars().collect();
        // After the numbers of the axis.
        let after_axis = cells
            .iter()
            .position(|c| matches!(c, '┤'))
            .or_else(|| cells.iter().skip(2).position(|c| *c == '│').map(|at| at + 2))?;
        let column = cells.iter().rposition(|c| *c == number).filter(|column| *column > after_axis)?;
        Some((column as u16 - 1, row as u16))
    });
    place.last().unwrap_or_else(|| panic!("no {number} in the profile of\n{seen}"))
}
