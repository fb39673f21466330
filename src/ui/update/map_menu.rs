//! Carries out a choice of the menu of a place on the map.

use super::popup::chosen;
use super::view;
use crate::geo::LatLon;
use crate::telemetry::InFlightCommand;
use crate::ui::acts::map_edit::{actions as map_edit, measure};
use crate::ui::acts::origin::origin;
use crate::ui::app_state::AppState;
use crate::ui::model::editor::Column;
use crate::ui::model::effect::Effect;
use crate::ui::model::map_point::to_map;
use crate::ui::model::map_state::MapItem;
use crate::ui::model::panel_table::Panel;
use crate::ui::popup::Outcome;
use crate::ui::popup::map_menu::MapChoice;
use crate::vehicle::VehicleCommand;

/// Carries out the choice of a key or a click.
pub(super) fn take(state: &mut AppState, place: LatLon, outcome: Outcome<MapChoice>) -> Vec<Effect> {
    let (Some(choice), Some(frame)) = (chosen(&mut state.popups, outcome), origin(&state.shared)) else {
        return Vec::new();
    };
    let place = to_map(&frame, place);
    match choice {
        MapChoice::AddWaypoint => map_edit::add_at(&mut state.shared, place),
        MapChoice::SetHome => map_edit::put(&mut state.shared, MapItem::Home, place),
        MapChoice::SetFence => map_edit::put(&mut state.shared, MapItem::Fence, place),
        MapChoice::EditWaypoint(index) => {
            state.shared.editor.go_to_cell(index, Column::default());
            view::focus(state, Panel::Plan)
        }
        MapChoice::DeleteWaypoint(index) => {
            state.shared.editor.cancel();
            state.shared.editor.go_to_row(index);
            state.shared.editor.delete()
        }
        MapChoice::Measure => {
            measure::begin_at(&mut state.shared, place);
            Vec::new()
        }
        MapChoice::GoTo(index) => {
            vec![VehicleCommand::InFlight(InFlightCommand::GoTo(index)).into()]
        }
    }
}
