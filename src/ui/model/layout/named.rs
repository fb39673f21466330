//! Layouts with names: the sizes and places of the panels, and the panel with the focus.

use serde::{Deserialize, Serialize};

use crate::ui::model::layout::arrangement::{Arrangement, Split};
use crate::ui::model::panel_table::Panel;

/// The most columns of a name.
pub(in crate::ui) const NAME_COLUMNS: usize = 20;
/// The most layouts that the user saves.
pub(in crate::ui) const MAX_LAYOUTS: usize = 64;

/// A layout.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct NamedLayout {
    pub(in crate::ui) arrangement: Arrangement,
    /// The names of the panels in the places that several panels share: main, left, right.
    pub(in crate::ui) places: Vec<String>,
    /// The name of the panel with the focus.
    pub(in crate::ui) focus: String,
    pub(in crate::ui) zoomed: bool,
}

impl NamedLayout {
    /// The names of the layouts of the program, in the order of their keys.
    pub(crate) const BUILT_IN: [&str; 4] = ["flying", "editing", "debugging", "demo"];

    /// Returns the layout of the program with this name.
    pub(in crate::ui) fn built_in(name: &str) -> Option<Self> {
        let (places, focus, sizes): (_, _, &[(Split, u16)]) = match name {
            "flying" => ([Panel::Map, Panel::Log, Panel::Plan], Panel::Map, &[]),
            "editing" => (
                [Panel::Plan, Panel::Log, Panel::Plan],
                Panel::Plan,
                &[(Split::Bottom, 45), (Split::State, 30), (Split::Right, 62)],
            ),
            "debugging" => (
                [Panel::Graphs, Panel::Graphs, Panel::World],
                Panel::Graphs,
                &[(Split::Bottom, 50), (Split::Right, 40)],
            ),
            "demo" => {
                ([Panel::Map, Panel::Log, Panel::Rc], Panel::Map, &[(Split::Bottom, 24), (Split::State, 33)])
            }
            _ => return None,
        };
        let mut arrangement = Arrangement::default();
        for (split, per_cent) in sizes {
            arrangement.set_size(*split, *per_cent, 100);
        }
        Some(Self {
            arrangement,
            places: places.map(|panel| panel.name().to_owned()).to_vec(),
            focus: focus.name().to_owned(),
            zoomed: false,
        })
    }
}

/// Returns `true` if a layout of the user can have this name.
pub(in crate::ui) fn is_name(name: &str) -> bool {
    let is_word = !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || matches!(c, '-' | '_'));
    is_word && name.chars().count() <= NAME_COLUMNS
}
