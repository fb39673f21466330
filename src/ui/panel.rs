//! The panels: one table, and one file each with the panel's own state and its [`Content`].
//!
//! A new panel is a file here with its state in this file, its variant and row in `model/panel_table.rs`, and its keys in
//! `model/action/panels.rs`.

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

use crate::ui::model::panel_table::Panel;
pub(super) use content::{Content, Hint};

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
