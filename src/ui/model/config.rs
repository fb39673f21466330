//! The configuration of the user interface at start.

use std::sync::Arc;

use crate::campaign::ForecastAnswer;
use crate::events::Event;
use crate::terrain::Tiles;
use crate::ui::model::console::CliHelp;
use crate::ui::model::editor::OpenPlan;
use crate::ui::model::history::EnteredLines;
use crate::ui::model::kept_screen::KeptScreens;
use crate::ui::model::keymap::Keymap;
use crate::ui::model::layout::SavedLayouts;
use crate::ui::model::settings::GivenSetting;
use crate::ui::theme::Theme;
use crate::ui::units::Units;

/// The configuration of the user interface at start.
#[derive(Debug)]
pub struct UiConfig {
    pub theme: Theme,
    /// Units of the shown values.
    pub units: Units,
    /// Altitude above home above which a waypoint gets a warning, m.
    pub max_altitude_m: f64,
    /// The ground.
    pub ground: GroundConfig,
    pub keymap: Keymap,
    /// Completion and help of the CLI panel.
    pub cli: CliHelp,
    /// The settings that options gave the craft.
    pub given_settings: Vec<GivenSetting>,
    /// Returns an event as a sentence; empty for events that nobody needs to read.
    pub sentence: fn(&Event) -> String,
    /// Returns the answer of many flights of the plan with this name as a sentence: go or no-go.
    pub go_sentence: fn(&str, &ForecastAnswer) -> String,
    /// The plan that is open at start.
    pub plan: OpenPlan,
    /// `true` to use the mouse.
    pub mouse: bool,
    /// Lines entered in earlier runs.
    pub entered: EnteredLines,
    /// The layouts that the user saved.
    pub layouts: SavedLayouts,
    /// The screen of the run before.
    pub kept: KeptScreens,
    /// `true` to point to the tutorial on the first screen.
    pub is_first_start: bool,
}

/// The elevation tiles at start.
#[derive(Debug, Clone, Default)]
pub struct GroundConfig {
    /// Clearance above the ground below which a leg gets a warning, m.
    pub clearance_m: f64,
    pub tiles: Option<Arc<Tiles>>,
    /// `true` if more of them can be read.
    pub can_read: bool,
}

#[cfg(test)]
impl UiConfig {
    pub(in crate::ui) fn bare() -> Self {
        use crate::plan::edit::{History, PlanDocument};
        use crate::ui::model::plan_id::PlanId;

        Self {
            theme: Theme::default(),
            units: Units::default(),
            max_altitude_m: crate::plan::estimate::MAX_ALTITUDE_M,
            ground: GroundConfig::default(),
            keymap: Keymap::default(),
            cli: CliHelp::default(),
            given_settings: Vec::new(),
            sentence: |_| String::new(),
            go_sentence: |_, _| String::new(),
            plan: OpenPlan::new(PlanId::default(), None, History::new(PlanDocument::default(), true)),
            mouse: false,
            entered: EnteredLines::default(),
            layouts: SavedLayouts::default(),
            kept: KeptScreens::none(),
            is_first_start: false,
        }
    }
}
