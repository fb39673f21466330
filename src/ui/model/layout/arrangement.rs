//! The changes of the user to the places of the panels: other sizes, and swapped panels.

use serde::{Deserialize, Serialize};

use crate::ui::model::panel_table::Panel;

/// A border between panels that can be moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumIter)]
pub(in crate::ui) enum Split {
    /// Left of the state: the size is its width.
    State,
    /// Left of the third panel at the top of a large screen.
    Side,
    /// Above the panels at the bottom.
    Bottom,
    /// Right of the panel at the bottom left of a large screen.
    Left,
    /// Left of the panel at the bottom right.
    Right,
    /// Above the settings.
    Settings,
}

/// The sizes of the panels, and the panel at each place.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Arrangement {
    /// The sizes in thousandths of the screen, by the order of [`Split`]; `None` = the default size.
    sizes: [Option<u16>; 6],
    /// Pairs of panels, by name, that have each other's places, in the order in which they were swapped.
    swaps: Vec<(String, String)>,
}

/// The most swaps that are kept. More of them than panels are never needed.
const MAX_SWAPS: usize = 2 * Panel::ALL.len();

impl Arrangement {
    /// Returns the size of a part of `whole` cells: `default`, or that of the user, but at least `least`, and so that
    /// `rest` cells remain for the other side.
    pub(in crate::ui) fn size(
        &self,
        split: Split,
        whole: u16,
        default: u16,
        (least, rest): (u16, u16),
    ) -> u16 {
        let cells = self.sizes[split as usize]
            .map_or(default, |share| ((u32::from(share.min(1000)) * u32::from(whole) + 500) / 1000) as u16);
        cells.min(whole.saturating_sub(rest)).max(least.min(whole))
    }

    /// Gives a part of `whole` cells this size.
    pub(in crate::ui) fn set_size(&mut self, split: Split, cells: u16, whole: u16) {
        let share = (u32::from(cells) * 1000 + u32::from(whole) / 2) / u32::from(whole.max(1));
        self.sizes[split as usize] = Some(share.min(1000) as u16);
    }

    /// Gives two panels each other's places.
    pub(in crate::ui) fn swap(&mut self, a: Panel, b: Panel) {
        if a != b && self.swaps.len() < MAX_SWAPS {
            self.swaps.push((a.name().to_owned(), b.name().to_owned()));
            self.tidy();
        }
    }

    /// Returns the panel that is shown at the usual place of another.
    pub(in crate::ui) fn shown_at(&self, place: Panel) -> Panel {
        self.swaps().fold(place, |panel, (a, b)| swapped(panel, a, b))
    }

    /// Returns the panel at whose usual place this one is shown.
    pub(in crate::ui) fn place_of(&self, panel: Panel) -> Panel {
        let swaps: Vec<_> = self.swaps().collect();
        swaps.into_iter().rev().fold(panel, |place, (a, b)| swapped(place, a, b))
    }

    fn swaps(&self) -> impl Iterator<Item = (Panel, Panel)> {
        let panel = |name: &str| Panel::ALL.into_iter().find(|panel| panel.name() == name);
        self.swaps.iter().take(MAX_SWAPS).filter_map(move |(a, b)| Some((panel(a)?, panel(b)?)))
    }

    /// Replaces the swaps by the fewest with the same result.
    fn tidy(&mut self) {
        let wanted = Panel::ALL.map(|place| self.shown_at(place));
        let mut fewest = Self { sizes: self.sizes, swaps: Vec::new() };
        for (place, panel) in Panel::ALL.into_iter().zip(wanted) {
            let there = fewest.shown_at(place);
            if there != panel {
                fewest.swaps.push((there.name().to_owned(), panel.name().to_owned()));
            }
        }
        *self = fewest;
    }
}

fn swapped(panel: Panel, a: Panel, b: Panel) -> Panel {
    match panel {
        panel if panel == a => b,
        panel if panel == b => a,
        panel => panel,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_part_keeps_its_share_of_another_screen_and_room_for_the_rest() {
        let mut arrangement = Arrangement::default();
        assert_eq!(arrangement.size(Split::State, 120, 46, (20, 30)), 46);
        arrangement.set_size(Split::State, 60, 120);
        assert_eq!(arrangement.size(Split::State, 120, 46, (20, 30)), 60);
        assert_eq!(arrangement.size(Split::State, 200, 46, (20, 30)), 100);
        assert_eq!(arrangement.size(Split::State, 80, 46, (20, 50)), 30);
        arrangement.set_size(Split::State, 2, 120);
        assert_eq!(arrangement.size(Split::State, 120, 46, (20, 30)), 20);
        assert_ne!(arrangement, Arrangement::default());
    }

    proptest! {
        #[test]
        fn every_panel_keeps_exactly_one_place(
            swaps in prop::collection::vec((0..Panel::ALL.len(), 0..Panel::ALL.len()), 0..40),
        ) {
            let mut arrangement = Arrangement::default();
            let mut shown = Panel::ALL;
            for (a, b) in swaps {
                let (a, b) = (Panel::ALL[a], Panel::ALL[b]);
                arrangement.swap(a, b);
                shown = shown.map(|panel| swapped(panel, a, b));
                for (place, panel) in Panel::ALL.into_iter().zip(shown) {
                    prop_assert_eq!(arrangement.shown_at(place), panel);
                    prop_assert_eq!(arrangement.place_of(panel), place);
                }
            }
            prop_assert!(arrangement.swaps.len() < Panel::ALL.len());
        }
    }
}
