//! The places that several panels share.

use crate::ui::model::panel_table::{Panel, Place};

/// The contents of the places that several panels share: the panel that had the focus last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slots {
    /// From 80x24: map (with the log below), or one of RC, CLI, plan, graphs, world, settings instead of both.
    pub(in crate::ui) main: Panel,
    /// From 120x34, bottom left: log, CLI or graphs. From 180x48, bottom left: log or graphs.
    pub(in crate::ui) left: Panel,
    /// From 120x34, bottom right: RC, plan, world or settings. From 180x48, top right: RC, world or settings.
    pub(in crate::ui) right: Panel,
}

impl Default for Slots {
    fn default() -> Self {
        Self { main: Panel::Map, left: Panel::Log, right: Panel::Plan }
    }
}

impl Slots {
    /// Returns the panels of the places: main, left, right.
    pub(in crate::ui) fn panels(self) -> [Panel; 3] {
        [self.main, self.left, self.right]
    }

    /// Returns places with these panels: main, left, right. `None` if a panel has another place.
    pub(in crate::ui) fn of([main, left, right]: [Panel; 3]) -> Option<Self> {
        let fits = !matches!(main.place(), Place::Beside | Place::Below)
            && matches!(left.place(), Place::Left | Place::Below)
            && right.place() == Place::Right;
        fits.then_some(Self { main, left, right })
    }

    /// Remembers that a panel got the focus.
    pub fn visit(&mut self, panel: Panel) {
        match panel.place() {
            Place::Main => self.main = panel,
            Place::Beside => {}
            Place::Below => {
                self.main = Panel::Map;
                self.left = panel;
            }
            Place::Left => {
                self.main = panel;
                self.left = panel;
            }
            Place::Right => {
                self.main = panel;
                self.right = panel;
            }
        }
    }
}
