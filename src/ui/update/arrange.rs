//! Resizes and swaps panels, and chooses layouts.

use crate::ui::acts::{named_layouts, screen_layout};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseEvent};

use super::view::focus;
use crate::ui::acts::screen_layout::{Border, Screen};
use crate::ui::app_state::AppState;
use crate::ui::model::action::Action;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::layout::Arrangement;
use crate::ui::model::panel_table::Panel;
use crate::ui::popup::Popup;
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;

/// The columns and the rows of a step.
const STEP: (i32, i32) = (2, 1);

/// Handles a key while the user arranges the panels. `found` is the action of the key at other times.
pub(super) fn key(state: &mut AppState, event: KeyEvent, found: Option<Action>) -> Vec<Effect> {
    if found == Some(Action::Layout) {
        state.popups.pop();
        return Vec::new();
    }
    if event.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT) {
        return Vec::new();
    }
    let shared = &mut state.shared;
    match event.code {
        KeyCode::Left | KeyCode::Char('h') => resize(shared, true, -STEP.0),
        KeyCode::Right | KeyCode::Char('l') => resize(shared, true, STEP.0),
        KeyCode::Down | KeyCode::Char('j') => resize(shared, false, -STEP.1),
        KeyCode::Up | KeyCode::Char('k') => resize(shared, false, STEP.1),
        KeyCode::Tab => go_on(state, 1),
        KeyCode::BackTab => go_on(state, -1),
        KeyCode::Char('s') => swap(shared),
        KeyCode::Char('z') => shared.zoomed = !shared.zoomed,
        KeyCode::Char('0') => shared.arrangement = Arrangement::default(),
        KeyCode::Char(digit @ '1'..='9') => {
            let index = digit as usize - '1' as usize;
            let layout =
                named_layouts::names(shared).nth(index).and_then(|name| named_layouts::find(shared, name));
            if let Some(layout) = layout {
                layout.show(shared);
            }
        }
        KeyCode::Char('w') => {
            state.command_line.field = TextField::new("layout save ");
            state.popups.push(Popup::CommandLine);
        }
        KeyCode::Esc | KeyCode::Enter | KeyCode::Char('q') => {
            state.popups.pop();
        }
        _ => {}
    }
    Vec::new()
}

/// Makes the focused panel wider or higher by a number of cells.
fn resize(state: &mut Shared, is_width: bool, by: i32) {
    let Some(screen) = screen_layout::screen(state) else { return };
    let Some(area) = screen.panel(state.focus) else { return };
    // A border across the whole of the panel's side.
    let is_beside = |border: &&Border| {
        let cells = border.cells;
        let spans = if is_width {
            cells.y <= area.y && area.bottom() <= cells.bottom()
        } else {
            cells.x <= area.x && area.right() <= cells.right()
        };
        border.is_upright == is_width && spans
    };
    // The panel may be in the part whose size the border sets, or on the other side of it.
    let is_after = |border: &&Border| {
        if is_width { area.x == border.cells.x + 1 } else { area.y == border.cells.y + 1 }
    };
    let is_before = |border: &&Border| {
        if is_width { area.right() == border.cells.x + 1 } else { area.bottom() == border.cells.y + 1 }
    };
    let beside = || screen.borders.iter().filter(is_beside);
    let (border, sign) = match (beside().find(is_after), beside().find(is_before)) {
        (Some(border), _) => (border, 1),
        (None, Some(border)) => (border, -1),
        (None, None) => {
            let text = if state.zoomed {
                "Only this panel is shown: `z` shows all."
            } else {
                "No other panel is beside it."
            };
            state.say(Severity::Info, text.to_owned());
            return;
        }
    };
    let size = i32::from(border.size()) + sign * by;
    state.arrangement.set_size(border.split, size.clamp(1, i32::from(border.whole)) as u16, border.whole);
}

/// Gives the focus to the next visible panel.
fn go_on(state: &mut AppState, step: isize) {
    if let Some(panel) = visible_neighbour(&state.shared, step) {
        focus(state, panel);
    }
}

fn visible_neighbour(state: &Shared, step: isize) -> Option<Panel> {
    let screen = screen_layout::screen(state)?;
    let count = screen.panels.len();
    let at = screen.panels.iter().position(|(panel, _)| *panel == state.focus)?;
    screen.panels.get((at + count).wrapping_add_signed(step) % count).map(|(panel, _)| *panel)
}

/// Gives the focused panel the place of the next visible one. The focus moves with it.
fn swap(state: &mut Shared) {
    match visible_neighbour(state, 1) {
        Some(other) if other != state.focus => state.arrangement.swap(state.focus, other),
        _ => state.say(Severity::Info, "There is no other panel on the screen.".to_owned()),
    }
}

/// Returns the border at a cell of the screen.
pub(super) fn border_at(screen: &Screen, column: u16, row: u16) -> Option<Border> {
    screen.borders.iter().find(|border| border.cells.contains((column, row).into())).copied()
}

/// Moves a border to the mouse.
pub(super) fn drag(state: &mut Shared, screen: &Screen, dragged: Border, event: &MouseEvent) {
    let Some(border) = screen.borders.iter().find(|border| border.split == dragged.split) else { return };
    let at = if border.is_upright { event.column } else { event.row };
    state.arrangement.set_size(border.split, border.end.saturating_sub(at).max(1), border.whole);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;
    use crate::ui::model::message::Msg;
    use crate::ui::update::update;

    fn arranging(size: (u16, u16)) -> AppState {
        let mut state = AppState::bare(size, SessionView::default());
        state.popups.push(Popup::Layout);
        state
    }

    fn press(state: &mut AppState, code: KeyCode) {
        key(state, KeyEvent::new(code, KeyModifiers::NONE), None);
    }

    fn area(state: &AppState, panel: Panel) -> ratatui::layout::Rect {
        screen_layout::screen(&state.shared).and_then(|screen| screen.panel(panel)).expect("a visible panel")
    }

    #[test]
    fn a_panel_grows_and_shrinks_on_every_screen_with_several() {
        for size in [(80, 24), (120, 40), (200, 60)] {
            for panel in [Panel::Map, Panel::State, Panel::Log] {
                let mut state = arranging(size);
                focus(&mut state, panel);
                // The other side may be at its least size, so that the first step does nothing.
                let heights = [KeyCode::Up, KeyCode::Up, KeyCode::Down, KeyCode::Down].map(|code| {
                    press(&mut state, code);
                    area(&state, panel).height
                });
                assert!(heights[1] > heights[3], "{size:?} {panel:?}: {heights:?}");
                if panel == Panel::Log && size.0 < 120 {
                    continue;
                }
                let widths = [KeyCode::Right, KeyCode::Left].map(|code| {
                    press(&mut state, code);
                    area(&state, panel).width
                });
                assert_eq!(widths[0], widths[1] + STEP.0 as u16, "{size:?} {panel:?}");
            }
        }
    }

    #[test]
    fn a_swapped_panel_keeps_the_focus_and_each_key_still_shows_its_panel() {
        let mut state = arranging((120, 40));
        let (map, beside) = (area(&state, Panel::Map), area(&state, Panel::State));
        press(&mut state, KeyCode::Char('s'));
        assert_eq!(state.shared.focus, Panel::Map);
        assert_eq!((area(&state, Panel::Map), area(&state, Panel::State)), (beside, map));
        for panel in Panel::ALL {
            focus(&mut state, panel);
            assert!(screen_layout::screen(&state.shared).unwrap().panel(panel).is_some(), "{panel:?}");
        }
        press(&mut state, KeyCode::Char('0'));
        focus(&mut state, Panel::Plan);
        focus(&mut state, Panel::Map);
        assert_eq!(area(&state, Panel::Map), map);
    }

    #[test]
    fn each_key_shows_its_panel_after_any_swaps_on_any_screen() {
        for size in [(60, 20), (80, 24), (120, 40), (200, 60)] {
            let mut state = arranging(size);
            for (a, b) in (0..40).map(|n| (n * 7 % 10, n * 3 % 10)) {
                let count = Panel::ALL.len();
                state.shared.arrangement.swap(Panel::ALL[a % count], Panel::ALL[b % count]);
                for panel in Panel::ALL {
                    focus(&mut state, panel);
                    area(&state, panel);
                }
            }
        }
    }

    fn enter(state: &mut AppState, line: &str) {
        for c in line.chars() {
            update(state, Msg::Key(KeyCode::Char(c).into()));
        }
        update(state, Msg::Key(KeyCode::Enter.into()));
    }

    fn is_arranging(state: &AppState) -> bool {
        matches!(state.popups[..], [Popup::Layout])
    }

    #[test]
    fn a_refused_name_is_explained_and_the_layout_can_be_named_again() {
        let mut state = arranging((80, 24));
        for (name, reason) in
            [("flying", "taken by the program"), ("two words", "1 to 20 letters"), ("", "1 to 20")]
        {
            enter(&mut state, &format!("w{name}"));
            assert!(is_arranging(&state), "{name}: {:?}", state.popups);
            let notice = state.shared.notice.as_ref().expect("a reason");
            assert!(notice.text.contains(reason), "{name}: {}", notice.text);
        }
        update(&mut state, Msg::Key(KeyCode::Char('w').into()));
        update(&mut state, Msg::Key(KeyCode::Esc.into()));
        assert!(is_arranging(&state), "leaving the line leaves the name only");
        enter(&mut state, "wmine");
        assert_eq!(state.popups.len(), 0);
        assert_eq!(state.shared.layouts.names().collect::<Vec<_>>(), ["mine"]);
    }

    #[test]
    fn no_size_hides_a_panel() {
        for size in [(80, 24), (120, 40), (200, 60)] {
            for code in [KeyCode::Left, KeyCode::Right, KeyCode::Up, KeyCode::Down] {
                let mut state = arranging(size);
                for _ in 0..200 {
                    press(&mut state, code);
                }
                for (panel, area) in screen_layout::screen(&state.shared).unwrap().panels {
                    assert!(area.width >= 20 && area.height >= 4, "{size:?} {code:?}: {panel:?} {area:?}");
                }
            }
        }
    }
}
