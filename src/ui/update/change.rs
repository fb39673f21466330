//! Changes the state that all panels share, as a panel requests it.

use crate::ui::acts::map_edit::{actions as map_edit, measure};
use crate::ui::acts::stick_keys::{toggle_playing, toggle_recording};
use crate::ui::acts::{plan_edits as plan, setting_changes, transmitter};
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::message::Change;
use crate::ui::shared::Shared;

/// Carries out a change.
pub(super) fn change(state: &mut Shared, change: Change) -> Vec<Effect> {
    match change {
        Change::Notify(severity, text) => state.notify(severity, text),
        Change::Say(severity, text) => state.say(severity, text),
        Change::MapWindow(mode) => state.map.mode = mode,
        Change::MapArrow(columns, rows) => map_edit::arrow(state, columns, rows),
        Change::PickUp(item, place) => map_edit::pick_up(state, item, place, true),
        Change::DragTo(place) => {
            if let Some(moving) = &mut state.map.moving {
                moving.place = place;
                moving.moved = true;
            }
        }
        Change::PutDown => return map_edit::put_down(state),
        Change::Measure => measure::toggle(state),
        Change::MeasurePoint(place) => measure::set_point(state, Some(place)),
        Change::MeasureTo(place) => measure::drag_to(state, place),
        Change::MapGrid => state.map.grid = !state.map.grid,
        Change::CourseUp => {
            state.map.course_up = !state.map.course_up;
            let text = if state.map.course_up {
                "The course of the craft is up, or its heading while it stands."
            } else {
                "North is up."
            };
            state.say(Severity::Info, text);
        }
        Change::PastTracks => {
            state.map.hides_past = !state.map.hides_past;
            let text = match (state.map.hides_past, state.past_flights.tracks().len()) {
                (true, 0) => "Tracks of earlier flights will be hidden; there is none yet.",
                (false, 0) => "Tracks of earlier flights will be shown; there is none yet.",
                (true, _) => "The tracks of earlier flights are hidden.",
                (false, _) => "The tracks of earlier flights are shown.",
            };
            state.say(Severity::Info, text);
        }
        Change::MapWaypoint(by) => return map_edit::to_waypoint(state, by),
        Change::ChooseBackdrop => return plan::choose_backdrop(state),
        Change::NoBackdrop => return plan::remove_backdrop(state),
        Change::AddWaypoint(place) => return map_edit::add_at(state, place),
        Change::PlanRows(rows) => state.editor.move_cursor(rows, 0),
        Change::PlanCell(row, column) => state.editor.go_to_cell(row, column),
        Change::DragAltitude(index, altitude) => state.editor.dragged_altitude = Some((index, altitude)),
        Change::DropAltitude => {
            let Some((index, altitude)) = state.editor.dragged_altitude.take() else { return Vec::new() };
            return state.editor.edit(&format!("altitude of WP{index}"), |document| {
                if let Some(wp) = document.plan.waypoints.get_mut(index) {
                    wp.altitude = altitude;
                }
            });
        }
        Change::GraphsCursor(steps) => state.graphs.move_cursor(steps),
        Change::NoGraphsCursor => state.graphs.leave_cursor(),
        Change::GraphsSpan(by) => state.graphs.change_span(by),
        Change::Channel(channel, us) => return transmitter::set(state, channel, us),
        Change::Record => return toggle_recording(state),
        Change::Play => return toggle_playing(state),
        Change::Settings(requested) => return setting_changes::change(state, requested),
        Change::World(world) => std::sync::Arc::make_mut(&mut state.view.vehicle).world = *world,
    }
    Vec::new()
}
