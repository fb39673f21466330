//! The layouts with names: showing, saving and deleting them.

use crate::ui::model::layout::Slots;
use crate::ui::model::layout::named::{MAX_LAYOUTS, NAME_COLUMNS, NamedLayout, is_name};
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;

impl NamedLayout {
    /// Returns the present layout of the screen.
    pub(in crate::ui) fn present(state: &Shared) -> Self {
        Self {
            arrangement: state.arrangement.clone(),
            places: state.slots.panels().map(|panel| panel.name().to_owned()).to_vec(),
            focus: state.focus.name().to_owned(),
            zoomed: state.zoomed,
        }
    }

    /// Shows the layout. Parts with names of other versions keep what is shown.
    pub(in crate::ui) fn show(&self, state: &mut Shared) {
        let panel = |name: &String| Panel::ALL.into_iter().find(|panel| panel.name() == name);
        state.arrangement = self.arrangement.clone();
        let places: Vec<Panel> = self.places.iter().filter_map(panel).collect();
        if let Some(slots) = <[Panel; 3]>::try_from(places).ok().and_then(Slots::of) {
            state.slots = slots;
        }
        if let Some(focus) = panel(&self.focus) {
            state.focus = focus;
        }
        state.zoomed = self.zoomed;
    }
}

/// Returns the names of all layouts in the order of their keys: those of the program, then those of the user.
pub(in crate::ui) fn names(state: &Shared) -> impl Iterator<Item = &str> {
    NamedLayout::BUILT_IN.into_iter().chain(state.layouts.names())
}

/// Returns the layout with this name.
pub(in crate::ui) fn find(state: &Shared, name: &str) -> Option<NamedLayout> {
    NamedLayout::built_in(name).or_else(|| state.layouts.get(name).cloned())
}

/// Saves the present layout under a name. Returns the line that keeps it, or a sentence if the name cannot be taken.
pub(in crate::ui) fn save(state: &mut Shared, name: &str) -> Result<Option<String>, String> {
    if !is_name(name) {
        return Err(format!("A layout has a name of 1 to {NAME_COLUMNS} letters, digits, `-` and `_`."));
    }
    if NamedLayout::BUILT_IN.contains(&name) || ["save", "delete", "default"].contains(&name) {
        return Err(format!("The name {name} is taken by the program: choose another."));
    }
    if !state.layouts.has_room(name) {
        return Err(format!("There are {MAX_LAYOUTS} layouts: `:layout delete NAME` makes room."));
    }
    let layout = NamedLayout::present(state);
    Ok(state.layouts.insert(name, layout))
}

/// Deletes a layout of the user. Returns the line that keeps this, or a sentence if there is no such layout.
pub(in crate::ui) fn delete(state: &mut Shared, name: &str) -> Result<Option<String>, String> {
    match state.layouts.remove(name) {
        None if NamedLayout::BUILT_IN.contains(&name) => {
            Err(format!("Layout {name} belongs to the program and cannot be deleted."))
        }
        None => Err(format!("There is no saved layout {name}.")),
        line => Ok(line),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;
    use crate::ui::acts::screen_layout::screen;
    use crate::ui::model::layout::Split;

    fn state(size: (u16, u16)) -> Shared {
        Shared::bare(size, SessionView::default())
    }

    #[test]
    fn every_layout_of_the_program_fits_every_screen() {
        for size in [(60, 20), (80, 24), (120, 40), (200, 60), (300, 100)] {
            for name in NamedLayout::BUILT_IN {
                let mut state = state(size);
                find(&state, name).expect("it is built in").show(&mut state);
                let shown = screen(&state).expect("large enough");
                assert!(shown.panel(state.focus).is_some(), "{name} {size:?}");
                for (panel, area) in &shown.panels {
                    assert!(area.width >= 16 && area.height >= 4, "{name} {size:?}: {panel:?} {area:?}");
                }
            }
        }
    }

    #[test]
    fn a_saved_layout_comes_back_and_names_are_words() {
        let mut state = state((120, 40));
        state.arrangement.swap(Panel::Map, Panel::Plan);
        state.arrangement.set_size(Split::Bottom, 20, 40);
        save(&mut state, "mine").unwrap();
        let swapped = screen(&state);
        find(&state, "flying").unwrap().show(&mut state);
        assert_ne!(screen(&state), swapped);
        find(&state, "mine").unwrap().show(&mut state);
        assert_eq!(screen(&state), swapped);
        assert_eq!(names(&state).last(), Some("mine"));
        for name in ["", "two words", "flying", "save", &"x".repeat(30)] {
            assert!(save(&mut state, name).is_err(), "{name}");
        }
    }
}
