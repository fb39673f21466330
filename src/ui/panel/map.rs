//! 1 Map: metres, north up.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget as _;
use ratatui::widgets::canvas::Canvas;

use crate::geo::LocalFrame;
use crate::plan::{FlightPlan, Waypoint, WaypointType};
use crate::telemetry::PlanSource;
use crate::ui::action::Action;
use crate::ui::map_edit;
use crate::ui::map_point::origin::origin;
use crate::ui::map_point::{self, MapPoint, to_map};
use crate::ui::map_state::{MapItem, MapMode, Moving};
use crate::ui::panel::Panel;
use crate::ui::shared::Shared;
use crate::ui::viewport::Viewport;

mod labels;
mod lines;
mod marks;
mod track_line;

/// A waypoint on the ground.
struct PlacedWaypoint {
    index: usize,
    place: MapPoint,
    wp: Waypoint,
}

/// The contents of the map, placed on the ground.
struct Scene {
    view: Viewport,
    spots: Vec<PlacedWaypoint>,
    home: MapPoint,
    /// Home of the open plan, if it differs from that of the craft.
    planned_home: Option<MapPoint>,
    craft: Option<MapPoint>,
    believed: Option<MapPoint>,
    current: Option<usize>,
}

/// Returns the title with the source of the plan and the map mode.
pub(crate) fn title(state: &Shared) -> String {
    let name = state.panel_title(Panel::Map);
    let source = match &state.view.vehicle.active_plan {
        Some(_) => state.view.vehicle.nav.as_ref().map_or(PlanSource::Stored, |nav| nav.source),
        None => PlanSource::Stored,
    };
    let source = match source {
        PlanSource::Stored => String::new(),
        injected => format!(" — {injected} plan"),
    };
    if state.edits_on_map() {
        let place = state.map.moving.map(|moving| moving.place).or(state.map.edit.map(|cursor| cursor.place));
        let moving = state.map.moving.map(|moving| moving.item);
        let measured = place.and_then(|place| map_edit::measured(state, place, moving)).unwrap_or_default();
        return format!("{name} — edit · {measured}");
    }
    match state.map.mode {
        MapMode::Fit => format!("{name}{source}"),
        MapMode::Follow(_) => format!("{name}{source} — follows"),
        MapMode::Free { .. } => format!("{name}{source} — {} fits", state.key(Action::Fit)),
    }
}

pub(crate) fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    if area.width < 8 || area.height < 4 {
        return;
    }
    let scene = scene(state, area);
    Canvas::default()
        .marker(state.theme.marker())
        .x_bounds(scene.view.east_bounds())
        .y_bounds(scene.view.north_bounds())
        .paint(|context| lines::paint(state, &scene, context))
        .render(area, buffer);
    marks::write(state, &scene, buffer);
}

fn scene(state: &Shared, area: Rect) -> Scene {
    let vehicle = &state.view.vehicle;
    let plan = state.shown_plan();
    let frame = origin(state);
    let at_boot_place = MapPoint::default();
    let craft_home =
        frame.zip(vehicle.craft.home).map_or(at_boot_place, |(frame, home)| to_map(&frame, home));
    let planned_home = map_edit::home(state).unwrap_or(craft_home);
    // While editing, the map shows home of the edited plan and the fence around it.
    let mut home = if state.edits_on_map() { planned_home } else { craft_home };
    let mut spots = frame.map_or_else(Vec::new, |frame| spots(plan, &frame, home));
    match state.map.moving {
        Some(Moving { item: MapItem::Waypoint(index), place, .. }) => {
            for spot in spots.iter_mut().filter(|spot| spot.index == index) {
                spot.place = place;
            }
        }
        Some(Moving { item: MapItem::Home, place, .. }) => home = place,
        Some(Moving { item: MapItem::Fence, .. }) | None => {}
    }
    let estimate = &vehicle.estimate;
    let believed = estimate.n.zip(estimate.e).map(|(n, e)| MapPoint::new(n, e));
    Scene {
        view: Viewport::of(state, area),
        spots,
        home,
        planned_home: (planned_home.distance(home) > 1.0 && !state.edits_on_map()).then_some(planned_home),
        craft: map_point::craft(&state.view),
        believed: believed.filter(|place| place.n.is_finite() && place.e.is_finite()),
        current: vehicle.nav.as_ref().filter(|nav| nav.engaged).map(|nav| usize::from(nav.wp)),
    }
}

/// Returns the positional waypoints. A TAKEOFF is at home, whatever position its record has.
fn spots(plan: &FlightPlan, frame: &LocalFrame, home: MapPoint) -> Vec<PlacedWaypoint> {
    let positional = plan.waypoints.iter().enumerate().filter(|(_, wp)| wp.kind.is_positional());
    positional
        .map(|(index, wp)| {
            let place = if wp.kind == WaypointType::Takeoff { home } else { to_map(frame, wp.position) };
            PlacedWaypoint { index, place, wp: *wp }
        })
        .collect()
}
