//! The panels: one table, and one file each with the panel's own state and its [`Content`].
//!
//! A new panel is a file here, its variant, row and state in this file, and its keys in `action/panels.rs`.

pub(super) mod cli;
mod content;
pub(super) mod editor_popup;
pub(super) mod graphs;
mod horizon;
pub(super) mod in_words;
mod log;
pub(super) mod map;
mod plan;
pub(super) mod rc;
mod settings;
mod state;
mod state_diagram;
mod world;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use super::drawing;
use super::formatting::cut;
use super::theme::{Role, Theme};
pub(super) use content::{Content, Hint};

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
    /// All settings of the craft.
    Settings,
}

/// The place of a panel on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// Top left, large.
    Main,
    /// Beside it, on every screen with room for two panels.
    Beside,
    /// Below it: the place at the bottom left, and on a small screen below the map.
    Below,
    /// The place at the bottom left, and on a small screen the whole left.
    Left,
    /// The place at the right, and on a small screen the whole left.
    Right,
}

/// A row of the table of panels.
#[derive(Debug)]
pub(super) struct Row {
    pub(super) panel: Panel,
    pub(super) name: &'static str,
    /// Name, title and help of the action that shows it.
    pub(super) action: (&'static str, &'static str, &'static str),
    /// The keys that show it.
    pub(super) keys: &'static [&'static str],
    pub(super) place: Place,
    /// `true` if the keys of lists scroll it.
    pub(super) is_list: bool,
}

const fn row_of(
    panel: Panel,
    name: &'static str,
    action: (&'static str, &'static str, &'static str),
    keys: &'static [&'static str],
    place: Place,
    is_list: bool,
) -> Row {
    Row { panel, name, action, keys, place, is_list }
}

/// All panels in the order of their numbers.
pub(super) const ROWS: [Row; 9] = [
    row_of(Panel::Map, "Map", ("view.map", "map", "Map panel"), &["1", "f1"], Place::Main, false),
    row_of(Panel::Plan, "Plan", ("view.plan", "plan", "Plan panel"), &["2", "f2"], Place::Right, true),
    row_of(Panel::State, "State", ("view.state", "state", "State panel"), &["3", "f3"], Place::Beside, true),
    row_of(Panel::Rc, "RC", ("view.rc", "RC", "RC panel"), &["4", "f4"], Place::Right, false),
    row_of(Panel::Cli, "CLI", ("view.cli", "CLI", "CLI panel"), &["5", "f5"], Place::Left, false),
    row_of(
        Panel::Graphs,
        "Graphs",
        ("view.graphs", "graphs", "Graphs panel"),
        &["6", "f6"],
        Place::Left,
        false,
    ),
    row_of(Panel::World, "World", ("view.world", "world", "World panel"), &["7", "f7"], Place::Right, false),
    row_of(Panel::Log, "Log", ("view.log", "log", "Log panel"), &["8", "f8"], Place::Below, true),
    row_of(
        Panel::Settings,
        "Settings",
        ("view.settings", "settings", "Settings panel"),
        &["9", "f9"],
        Place::Right,
        true,
    ),
];

/// The states of the panels.
#[derive(Debug, Default)]
pub struct Panels {
    map: map::MapPanel,
    plan: plan::PlanPanel,
    pub state: state::StatePanel,
    pub rc: rc::RcPanel,
    pub cli: cli::CliPanel,
    graphs: graphs::GraphsPanel,
    pub world: world::WorldPanel,
    pub log: log::LogPanel,
    settings: settings::SettingsPanel,
}

impl Panels {
    /// Returns the states at start, with the lines entered in the CLI in earlier runs.
    pub(super) fn new(cli: &[String]) -> Self {
        Self { cli: cli::CliPanel::with_history(cli), ..Self::default() }
    }

    pub(super) fn of(&self, panel: Panel) -> &dyn Content {
        match panel {
            Panel::Map => &self.map,
            Panel::Plan => &self.plan,
            Panel::State => &self.state,
            Panel::Rc => &self.rc,
            Panel::Cli => &self.cli,
            Panel::Graphs => &self.graphs,
            Panel::World => &self.world,
            Panel::Log => &self.log,
            Panel::Settings => &self.settings,
        }
    }

    pub(super) fn of_mut(&mut self, panel: Panel) -> &mut dyn Content {
        match panel {
            Panel::Map => &mut self.map,
            Panel::Plan => &mut self.plan,
            Panel::State => &mut self.state,
            Panel::Rc => &mut self.rc,
            Panel::Cli => &mut self.cli,
            Panel::Graphs => &mut self.graphs,
            Panel::World => &mut self.world,
            Panel::Log => &mut self.log,
            Panel::Settings => &mut self.settings,
        }
    }
}

impl Panel {
    /// All panels in the order of their numbers.
    pub const ALL: [Self; ROWS.len()] = {
        let mut all = [Self::Map; ROWS.len()];
        let mut at = 0;
        while at < ROWS.len() {
            all[at] = ROWS[at].panel;
            at += 1;
        }
        all
    };

    /// Returns its row. The table has one for each panel.
    fn row(self) -> &'static Row {
        ROWS.iter().find(|row| row.panel == self).unwrap_or(&ROWS[0])
    }

    pub fn name(self) -> &'static str {
        self.row().name
    }

    pub(super) fn place(self) -> Place {
        self.row().place
    }

    /// Returns `true` if the keys of lists scroll it.
    pub(super) fn is_list(self) -> bool {
        self.row().is_list
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
