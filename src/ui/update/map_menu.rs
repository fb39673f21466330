//! Opens the menu of a place on the map and carries out a choice.

use super::{map_edit, view};
use crate::geo::LatLon;
use crate::session::Command;
use crate::telemetry::InFlightCommand;
use crate::ui::action::{self, Action};
use crate::ui::app_state::AppState;
use crate::ui::editor::Column;
use crate::ui::map_edit::{item_at, position};
use crate::ui::map_point::origin::origin;
use crate::ui::map_point::to_map;
use crate::ui::map_state::MapItem;
use crate::ui::message::Effect;
use crate::ui::panel::Panel;
use crate::ui::popup::map_menu::{MapChoice, Outcome};
use crate::ui::popup::{MapMenu, Popup};
use crate::ui::viewport::Viewport;
use crate::vehicle::VehicleCommand;

/// Opens the menu for a cell of the map.
pub(super) fn open(state: &mut AppState, view: &Viewport, at: (u16, u16)) {
    let Some(frame) = origin(&state.shared) else { return };
    let place = view.place(at.0, at.1);
    let choices = match item_at(&state.shared, place, view.scale) {
        Some(MapItem::Waypoint(index)) => {
            let can_go =
                action::enabled(&state.shared, Action::GoTo).is_ok() && state.shared.plan_is_on_craft();
            let go_to = u8::try_from(index).ok().filter(|_| can_go).map(MapChoice::GoTo);
            let edits = [MapChoice::EditWaypoint(index), MapChoice::DeleteWaypoint(index)];
            edits.into_iter().chain(go_to).collect()
        }
        _ => vec![MapChoice::AddWaypoint, MapChoice::SetHome, MapChoice::SetFence],
    };
    state.popups.push(Popup::MapMenu(MapMenu::new(position(&frame, place), at, choices)));
}

/// Carries out the choice of a key or a click.
pub(super) fn take(state: &mut AppState, place: LatLon, outcome: Outcome) -> Vec<Effect> {
    let choice = match outcome {
        Outcome::Choosing => return Vec::new(),
        Outcome::Left => {
            state.popups.pop();
            return Vec::new();
        }
        Outcome::Chosen(choice) => choice,
    };
    state.popups.pop();
    let Some(frame) = origin(&state.shared) else { return Vec::new() };
    let place = to_map(&frame, place);
    match choice {
        MapChoice::AddWaypoint => map_edit::add_at(&mut state.shared, place),
        MapChoice::SetHome => map_edit::put(&mut state.shared, MapItem::Home, place),
        MapChoice::SetFence => map_edit::put(&mut state.shared, MapItem::Fence, place),
        MapChoice::EditWaypoint(index) => {
            state.shared.editor.go_to_cell(index, Column::default());
            view::focus(&mut state.shared, Panel::Plan)
        }
        MapChoice::DeleteWaypoint(index) => {
            state.shared.editor.cancel();
            state.shared.editor.go_to_row(index);
            state.shared.editor.delete()
        }
        MapChoice::GoTo(index) => {
            vec![Effect::Send(Command::Vehicle(VehicleCommand::InFlight(InFlightCommand::GoTo(index))))]
        }
    }
}
