//! The bar in the lowest frame: the key and the name of every panel. A click shows the panel.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;
use unicode_width::UnicodeWidthStr as _;

use super::drawing;
use super::shared::Shared;
use super::theme::Role;
use crate::ui::acts::screen_layout::Screen;
use crate::ui::area::span;
use crate::ui::model::action::Action;
use crate::ui::model::panel_table::Panel;

/// The width from which names are further apart.
const WIDE: u16 = 80;

/// Returns the row of the bar: the lowest of the frames.
fn row(screen: &Screen) -> u16 {
    screen.timeline.unwrap_or(screen.hints).y.saturating_sub(1)
}

/// Returns each panel that has room, its key, and the cells of key and name.
fn places(state: &Shared, screen: &Screen) -> Vec<(Panel, String, Rect)> {
    let y = row(screen);
    let gap = if screen.hints.width >= WIDE { 2 } else { 1 };
    let end = screen.hints.right().saturating_sub(2);
    let mut x = screen.hints.x + 3;
    let mut places = Vec::new();
    for panel in Panel::ALL {
        // While letters are text, the keys of the panels are text, too.
        let key = state.keymap.shown_keys(Action::Show(panel)).into_iter().next();
        let key = key.filter(|_| !state.focus.takes_text()).unwrap_or_default();
        let blank = u16::from(!key.is_empty());
        let width = key.width() as u16 + blank + panel.name().width() as u16;
        if x + width > end {
            break;
        }
        places.push((panel, key, Rect::new(x, y, width, 1)));
        x += width + gap;
    }
    places
}

pub(super) fn draw(state: &Shared, screen: &Screen, buffer: &mut Buffer) {
    let theme = &state.theme;
    let places = places(state, screen);
    let (Some((_, _, first)), Some((_, _, last))) = (places.first(), places.last()) else { return };
    // A blank separates the names from the frame.
    let whole = Rect::new(first.x - 1, first.y, last.right() - first.x + 2, 1);
    let blank = " ".repeat(usize::from(whole.width));
    drawing::text(buffer, whole.x, whole.y, blank, theme.style(Role::Text));
    for (panel, key, place) in &places {
        let role = if *panel == state.focus { Role::Focus } else { Role::Dim };
        let mut spans = Vec::new();
        if !key.is_empty() {
            spans.extend([span(theme, Role::Key, key.clone()), span(theme, Role::Text, " ")]);
        }
        spans.push(span(theme, role, panel.name()));
        drawing::line(buffer, place.x, place.y, &Line::from(spans), place.width);
    }
}

/// Returns the panel whose name is at a cell.
pub(super) fn panel_at(state: &Shared, screen: &Screen, cell: (u16, u16)) -> Option<Panel> {
    places(state, screen).into_iter().find(|(_, _, place)| place.contains(cell.into())).map(|place| place.0)
}
