//! Default mouse handling of popups: a click on a shown key presses that key, a click on a row moves the
//! selection there and then chooses it, a click outside closes.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::Modifier;

use crate::ui::acts::screen_layout;
use crate::ui::app_state::AppState;
use crate::ui::draw::draw;
use crate::ui::model::effect::Effect;
use crate::ui::model::keymap::KeyPress;
use crate::ui::popup::Popup;
use crate::ui::theme::Role;

/// A click in a popup or beside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Click {
    Key(KeyEvent),
    /// A row of a list, so many rows below the selected one.
    Row(isize),
    Outside,
    Nothing,
}

/// Handles a mouse event for the popup opened last.
pub(super) fn mouse(state: &mut AppState, event: MouseEvent) -> Vec<Effect> {
    match event.kind {
        MouseEventKind::ScrollUp => press(state, KeyCode::Up),
        MouseEventKind::ScrollDown => press(state, KeyCode::Down),
        MouseEventKind::Down(MouseButton::Left) => match click(state, (event.column, event.row)) {
            Some(Click::Key(key)) => super::key(state, key),
            Some(Click::Row(0)) => press(state, KeyCode::Enter),
            Some(Click::Row(below)) => {
                let key = if below < 0 { KeyCode::Up } else { KeyCode::Down };
                (0..below.unsigned_abs()).flat_map(|_| press(state, key)).collect()
            }
            Some(Click::Outside) if closes_outside(state) => press(state, KeyCode::Esc),
            Some(Click::Outside | Click::Nothing) | None => Vec::new(),
        },
        _ => Vec::new(),
    }
}

/// Presses the key of the popup at a cell. Returns `None` if there is no key.
pub(super) fn press_shown(state: &mut AppState, cell: (u16, u16)) -> Option<Vec<Effect>> {
    match click(state, cell)? {
        Click::Key(key) => Some(super::key(state, key)),
        Click::Row(_) | Click::Outside | Click::Nothing => None,
    }
}

fn press(state: &mut AppState, code: KeyCode) -> Vec<Effect> {
    super::key(state, KeyEvent::new(code, KeyModifiers::NONE))
}

/// Returns `true` for a popup that asks nothing and holds nothing that was typed.
fn closes_outside(state: &AppState) -> bool {
    let question = matches!(
        state.popups.last(),
        None | Some(Popup::Quit | Popup::Permission | Popup::ResetSettings | Popup::Layout)
    );
    !question
}

fn click(state: &mut AppState, (column, row): (u16, u16)) -> Option<Click> {
    let with = picture(state)?;
    let beside = screen_layout::screen(&state.shared).and_then(|screen| screen.form);
    let place = match beside.filter(|_| state.popups.is_empty()) {
        Some(place) => place,
        None => difference(&with, &below(state)?)?,
    };
    if place.width < 3 || !place.contains((column, row).into()) {
        return Some(Click::Outside);
    }
    if let Some(key) = key_at(state, &with, place, (column, row)) {
        return Some(Click::Key(key));
    }
    // The rows of the editor's popups have their own use.
    if state.popups.is_empty() {
        return Some(Click::Nothing);
    }
    let is_selected =
        |y: &u16| (place.left()..place.right()).any(|x| with[(x, *y)].modifier.contains(Modifier::REVERSED));
    let Some(selected) = (place.top()..place.bottom()).find(is_selected) else { return Some(Click::Nothing) };
    let has_text =
        |y: u16| (place.left() + 1..place.right().saturating_sub(1)).any(|x| with[(x, y)].symbol() != " ");
    let inside = place.top() < row && row + 1 < place.bottom();
    let is_list = inside && (selected.min(row)..=selected.max(row)).all(has_text);
    Some(if is_list { Click::Row(isize::from(row as i16 - selected as i16)) } else { Click::Nothing })
}

/// Returns the picture of the screen.
fn picture(state: &AppState) -> Option<Buffer> {
    let (width, height) = state.shared.size;
    let mut terminal = Terminal::new(TestBackend::new(width, height)).ok()?;
    terminal.draw(|frame| draw(state, frame)).ok()?;
    Some(terminal.backend().buffer().clone())
}

/// Returns the picture without the popup opened last.
fn below(state: &mut AppState) -> Option<Buffer> {
    if let Some(popup) = state.popups.pop() {
        let without = picture(state);
        state.popups.push(popup);
        return without;
    }
    let popup = state.shared.editor.popup.take();
    let without = picture(state);
    state.shared.editor.popup = popup;
    without
}

/// Returns the smallest area outside which two pictures are equal.
fn difference(a: &Buffer, b: &Buffer) -> Option<Rect> {
    let area = a.area.intersection(b.area);
    let differing = area.positions().filter(|&at| a[at] != b[at]);
    differing.map(|at| Rect::new(at.x, at.y, 1, 1)).reduce(Rect::union)
}

/// Returns the key at a cell: the one that is written there, or the one before the words there.
fn key_at(state: &AppState, picture: &Buffer, place: Rect, (column, row): (u16, u16)) -> Option<KeyEvent> {
    let theme = &state.shared.theme;
    let is_key = |cell: &Cell| {
        cell.fg == theme.colour(Role::Key)
            && cell.modifier.contains(Modifier::BOLD)
            && !cell.modifier.contains(Modifier::REVERSED)
    };
    let is_within = |x: &u16| place.left() < *x && *x + 1 < place.right();
    let is_blank = |x: u16| picture[(x, row)].symbol() == " ";
    let keyed = |x: &u16| is_key(&picture[(*x, row)]) && !is_blank(*x);
    // The words of a key end where two blanks are.
    let last = (place.left()..=column).rev().filter(is_within).find(|x| keyed(x))?;
    let are_words = (last..column).all(|x| !(is_blank(x) && is_blank(x + 1)) || keyed(&x));
    if !are_words {
        return None;
    }
    let first = (place.left()..=last).rev().filter(is_within).take_while(|x| keyed(x)).last()?;
    let end = (last..place.right()).take_while(|x| keyed(x)).last()?;
    let name: String = (first..=end).map(|x| picture[(x, row)].symbol()).collect();
    pressed(&name)
}

/// Returns the key of a shown name.
fn pressed(name: &str) -> Option<KeyEvent> {
    let name = match name {
        "↑" => "Up",
        "↓" => "Down",
        "←" => "Left",
        "→" => "Right",
        "PgUp" => "PageUp",
        "PgDn" => "PageDown",
        "Del" => "Delete",
        "Ins" => "Insert",
        other => other,
    };
    KeyPress::parse(name).map(KeyPress::event)
}
