//! The frame of a popup.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Block, Clear, Widget as _};

use crate::ui::acts::screen_layout;
use crate::ui::area::span;
use crate::ui::theme::{Role, Theme};

/// Draws an empty frame in the middle for a popup of this inner size. Returns the inside.
pub(in crate::ui) fn popup(
    theme: &Theme,
    area: Rect,
    size: (u16, u16),
    title: &str,
    buffer: &mut Buffer,
) -> Rect {
    framed(theme, place(area, size), title, buffer)
}

/// Returns the place in the middle for a popup of this inner size.
pub(in crate::ui) fn place(area: Rect, size: (u16, u16)) -> Rect {
    let width = (size.0 + 2).min(area.width);
    let height = (size.1 + 2).min(area.height);
    Rect::new(area.x + (area.width - width) / 2, area.y + (area.height - height) / 2, width, height)
}

/// Draws an empty frame. Returns the inside.
pub(in crate::ui) fn framed(theme: &Theme, place: Rect, title: &str, buffer: &mut Buffer) -> Rect {
    Clear.render(place, buffer);
    Block::bordered()
        .border_style(theme.style(Role::Focus))
        .title(Line::from(span(theme, Role::Focus, title)))
        .render(place, buffer);
    screen_layout::inner(place)
}

/// Returns a line of keys, each followed by its effect.
pub(in crate::ui) fn key_line(theme: &Theme, keys: &[(&str, &str)]) -> Line<'static> {
    let spans =
        keys.iter().flat_map(|&(key, does)| [span(theme, Role::Key, key), span(theme, Role::Text, does)]);
    Line::from(spans.collect::<Vec<_>>())
}
