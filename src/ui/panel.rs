//! The panels in the order of their numbers, one file each. `draw(state, area, buffer)` fills the inside;
//! `title(state)` returns the title in the frame.

pub(super) mod cli;
pub(super) mod editor_popup;
pub(super) mod graphs;
pub(super) mod help;
mod horizon;
pub(super) mod log;
pub(super) mod map;
pub(super) mod plan;
pub(super) mod rc;
pub(super) mod state;
pub(super) mod state_diagram;
pub(super) mod world;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use super::drawing;
use super::formatting::cut;
use super::theme::{Role, Theme};

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::EnumIter)]
pub enum Panel {
    #[default]
    Map,
    Plan,
    State,
    Rc,
    /// The firmware's command line.
    Cli,
    Graphs,
    /// The air and the faults.
    World,
    Log,
}

impl Panel {
    /// All panels in the order of their numbers.
    pub const ALL: [Self; 8] =
        [Self::Map, Self::Plan, Self::State, Self::Rc, Self::Cli, Self::Graphs, Self::World, Self::Log];

    pub fn name(self) -> &'static str {
        match self {
            Self::Map => "Map",
            Self::Plan => "Plan",
            Self::State => "State",
            Self::Rc => "RC",
            Self::Cli => "CLI",
            Self::Graphs => "Graphs",
            Self::World => "World",
            Self::Log => "Log",
        }
    }

    /// Returns `true` if letters are text in this panel.
    pub fn takes_text(self) -> bool {
        self == Self::Cli
    }
}

/// Returns a span in the style of a role.
pub(super) fn span(theme: &Theme, role: Role, text: impl Into<String>) -> Span<'static> {
    Span::styled(text.into(), theme.style(role))
}

/// Writes `text` in a row of the area, cut to its width.
pub(super) fn row(buffer: &mut Buffer, area: Rect, row: u16, theme: &Theme, role: Role, text: &str) {
    if row < area.height {
        let text = cut(text, usize::from(area.width));
        drawing::text(buffer, area.x, area.y + row, text, theme.style(role));
    }
}

/// Writes a styled line in a row of the area.
pub(super) fn line(buffer: &mut Buffer, area: Rect, row: u16, line: &Line<'_>) {
    if row < area.height {
        drawing::line(buffer, area.x, area.y + row, line, area.width);
    }
}
