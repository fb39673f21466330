//! 1 Map: metres, with north or the course of the craft up.

use crate::ui::acts::{availability, map_edit};
use std::time::Duration;

use crossterm::event::{KeyModifiers, MouseEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::widgets::Widget as _;
use ratatui::widgets::canvas::Canvas;

use super::{Content, Hint};
use crate::geo::LocalFrame;
use crate::plan::{Waypoint, WaypointType};
use crate::telemetry::PlanSource;
use crate::ui::acts::map_edit::measure;
use crate::ui::acts::origin::origin;
use crate::ui::acts::viewport::moves::ZOOM_STEP;
use crate::ui::acts::viewport::{Viewport, moves};
use crate::ui::model::action::{Action, EditAction, PanelAction};
use crate::ui::model::map_point;
use crate::ui::model::map_point::{MapPoint, to_map};
use crate::ui::model::map_state::{MapItem, MapMode, Moving};
use crate::ui::model::message::{Change, Request};
use crate::ui::model::panel_table::Panel;
use crate::ui::popup::map_menu::MapChoice;
use crate::ui::popup::{MapMenu, Popup};
use crate::ui::shared::Shared;

mod backdrop;
pub(in crate::ui) mod compared;
mod grid;
mod in_words;
mod labels;
mod lines;
mod marks;
mod off_screen;
mod track_line;

/// Two presses at a cell within this time are a double click.
const DOUBLE_CLICK: Duration = Duration::from_millis(500);

/// The mouse on the map; the window and the edit are shared.
#[derive(Debug, Default)]
pub(super) struct MapPanel {
    /// The cell where the mouse picked up the map, and the middle of the map then.
    dragged: Option<(u16, u16, MapPoint)>,
    /// The cell where free ground was pressed last, and the time.
    pressed: Option<(u16, u16, Duration)>,
}

impl Content for MapPanel {
    /// Returns the title with the source of the plan and the map mode.
    fn title(&self, state: &Shared) -> String {
        let name = state.panel_title(Panel::Map);
        let source = match &state.view.vehicle.active_plan {
            Some(_) => state.view.vehicle.nav.as_ref().map_or(PlanSource::Stored, |nav| nav.source),
            None => PlanSource::Stored,
        };
        let source = match source {
            PlanSource::Stored => String::new(),
            injected => format!(" — {injected} plan"),
        };
        if state.map.measure.is_some() {
            let point = state.key(Action::Edit(EditAction::Pick));
            let measured =
                measure::measured(state).unwrap_or_else(|| format!("{point} sets the first point"));
            return format!("{name} — measure · {measured}");
        }
        if state.edits_on_map() {
            let place =
                state.map.moving.map(|moving| moving.place).or(state.map.edit.map(|cursor| cursor.place));
            let moving = state.map.moving.map(|moving| moving.item);
            let measured =
                place.and_then(|place| map_edit::measured(state, place, moving)).unwrap_or_default();
            return format!("{name} — edit · {measured}");
        }
        if state.shows_revision() {
            let history = state.editor.plan().history();
            return match history.at() {
                0 => format!("{name} — plan as opened"),
                at => format!("{name} — revision {at} of {}", history.len()),
            };
        }
        match state.map.mode {
            MapMode::Fit => format!("{name}{source}"),
            MapMode::Follow(_) => format!("{name}{source} — follows"),
            MapMode::Near { .. } => {
                let fits = state.key(Action::Panel(PanelAction::Fit));
                format!("{name}{source} — keeps the craft in view · {fits} fits")
            }
            MapMode::Free { .. } => {
                format!("{name}{source} — {} fits", state.key(Action::Panel(PanelAction::Fit)))
            }
        }
    }

    fn draw(&self, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        draw(state, area, buffer);
        None
    }

    fn in_words(&self, state: &Shared) -> Vec<String> {
        in_words::lines(state)
    }

    fn hints(&self, state: &Shared) -> Vec<Hint> {
        if let Some(tool) = &state.map.measure {
            let is_second = tool.from.is_some() && tool.to.is_none();
            let point = if is_second { "second point" } else { "first point" };
            return vec![
                (&[Action::Edit(EditAction::Pick)], point),
                (&[Action::Panel(PanelAction::Measure)], "done"),
            ];
        }
        if state.map.edit.is_some() {
            let pick = if state.map.moving.is_some() { "put down" } else { "pick" };
            return vec![
                (&[Action::Edit(EditAction::Pick)], pick),
                (&[Action::Edit(EditAction::AddOnMap)], "insert"),
                (&[Action::Edit(EditAction::DeleteOnMap)], "delete"),
                (&[Action::Panel(PanelAction::NextWaypoint)], "next"),
                (&[Action::Edit(EditAction::Undo)], "undo"),
                (&[Action::Edit(EditAction::OnMap)], "done"),
            ];
        }
        if !state.zoomed {
            return Vec::new();
        }
        vec![
            (&[Action::Panel(PanelAction::ZoomIn), Action::Panel(PanelAction::ZoomOut)], "zoom"),
            (&[Action::Panel(PanelAction::Follow)], "follow"),
            (&[Action::Panel(PanelAction::Fit)], "fit"),
            (&[Action::Panel(PanelAction::CourseUp)], "course up"),
            (&[Action::Panel(PanelAction::Measure)], "measure"),
            (&[Action::Panel(PanelAction::Grid)], "grid"),
            (&[Action::Panel(PanelAction::Backdrop)], "backdrop"),
        ]
    }

    fn act(&mut self, state: &Shared, action: PanelAction) -> Vec<Request> {
        let change = match action {
            PanelAction::PanUp => Some(Change::MapArrow(0.0, -1.0)),
            PanelAction::PanDown => Some(Change::MapArrow(0.0, 1.0)),
            PanelAction::PanLeft => Some(Change::MapArrow(-1.0, 0.0)),
            PanelAction::PanRight => Some(Change::MapArrow(1.0, 0.0)),
            PanelAction::ZoomIn => moves::zoomed(state, 1.0 / ZOOM_STEP).map(Change::MapWindow),
            PanelAction::ZoomOut => moves::zoomed(state, ZOOM_STEP).map(Change::MapWindow),
            PanelAction::Follow => moves::following(state).map(Change::MapWindow),
            PanelAction::Fit => Some(Change::MapWindow(MapMode::Fit)),
            PanelAction::Measure => Some(Change::Measure),
            PanelAction::Grid => Some(Change::MapGrid),
            PanelAction::CourseUp => Some(Change::CourseUp),
            PanelAction::PastTracks => Some(Change::PastTracks),
            PanelAction::NextWaypoint => Some(Change::MapWaypoint(1)),
            PanelAction::PreviousWaypoint => Some(Change::MapWaypoint(-1)),
            PanelAction::Backdrop => Some(Change::ChooseBackdrop),
            _ => None,
        };
        change.map(Request::Change).into_iter().collect()
    }

    fn wheel(&mut self, state: &Shared, area: Rect, event: &MouseEvent, direction: isize) -> Vec<Request> {
        let factor = if direction < 0 { 1.0 / ZOOM_STEP } else { ZOOM_STEP };
        let view = Viewport::of(state, area);
        let window = match state.map.mode {
            MapMode::Follow(scale) => MapMode::Follow(scale * factor),
            MapMode::Fit | MapMode::Free { .. } | MapMode::Near { .. } => {
                view.zoomed(factor, view.place(event.column, event.row)).free()
            }
        };
        vec![Change::MapWindow(window).into()]
    }

    /// Picks up a waypoint, home or the fence under the mouse, or starts dragging the map. A press with Ctrl, or a second
    /// press within a moment, adds a waypoint.
    fn press(&mut self, state: &Shared, area: Rect, event: &MouseEvent) -> Vec<Request> {
        let view = Viewport::of(state, area);
        let place = view.place(event.column, event.row);
        if state.map.measure.is_some() {
            return vec![Change::MeasurePoint(place).into()];
        }
        if event.modifiers.contains(KeyModifiers::CONTROL) {
            return vec![Change::AddWaypoint(place).into()];
        }
        let item = map_edit::item_at(state, place, view.scale);
        let is_waypoint = matches!(item, Some(MapItem::Waypoint(_)));
        // Home and fence move only in edit mode, because they are in areas where the map is dragged, too.
        let item = item.filter(|item| matches!(item, MapItem::Waypoint(_)) || state.map.edit.is_some());
        match item.filter(|_| state.view.vehicle.active_plan.is_none() || state.map.edit.is_some()) {
            Some(item) => vec![Change::PickUp(item, place).into()],
            None => {
                let (column, row) = (event.column, event.row);
                let is_second = self.pressed.take().is_some_and(|(before_column, before_row, at)| {
                    (before_column, before_row) == (column, row)
                        && state.now.saturating_sub(at) < DOUBLE_CLICK
                });
                if is_second && !is_waypoint {
                    return vec![Change::AddWaypoint(place).into()];
                }
                self.pressed = Some((column, row, state.now));
                self.dragged = Some((column, row, view.centre));
                Vec::new()
            }
        }
    }

    fn drag(&mut self, state: &Shared, area: Rect, event: &MouseEvent) -> Vec<Request> {
        let view = Viewport::of(state, area);
        if state.map.measure.is_some() {
            return vec![Change::MeasureTo(view.place(event.column, event.row)).into()];
        }
        if state.map.moving.is_some() {
            // The window stays still meanwhile.
            let place = view.place(event.column, event.row);
            return vec![Change::MapWindow(view.free()).into(), Change::DragTo(place).into()];
        }
        if let Some((column, row, centre)) = self.dragged {
            let columns = f64::from(column) - f64::from(event.column);
            let rows = f64::from(row) - f64::from(event.row);
            if columns != 0.0 || rows != 0.0 {
                return vec![Change::MapWindow(Viewport { centre, ..view }.panned(columns, rows)).into()];
            }
        }
        Vec::new()
    }

    fn release(&mut self, state: &Shared) -> Vec<Request> {
        self.dragged = None;
        let is_moved = state.map.moving.is_some_and(|moving| moving.by_mouse);
        if is_moved { vec![Change::PutDown.into()] } else { Vec::new() }
    }

    fn menu(&mut self, state: &Shared, area: Rect, event: &MouseEvent) -> Option<Popup> {
        let frame = origin(state)?;
        let view = Viewport::of(state, area);
        let at = (event.column, event.row);
        let place = view.place(at.0, at.1);
        let choices = match map_edit::item_at(state, place, view.scale) {
            Some(MapItem::Waypoint(index)) => {
                let can_go = availability::enabled(state, Action::GoTo).is_ok() && state.plan_is_on_craft();
                let go_to = u8::try_from(index).ok().filter(|_| can_go).map(MapChoice::GoTo);
                let edits = [MapChoice::EditWaypoint(index), MapChoice::DeleteWaypoint(index)];
                edits.into_iter().chain(go_to).chain([MapChoice::Measure]).collect()
            }
            _ => {
                vec![MapChoice::AddWaypoint, MapChoice::SetHome, MapChoice::SetFence, MapChoice::Measure]
            }
        };
        Some(Popup::MapMenu(MapMenu::new(map_edit::position(&frame, place), at, choices)))
    }
}

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
    /// The plans that the open generator form would give.
    preview: Vec<Vec<PlacedWaypoint>>,
}

fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    if area.width < 8 || area.height < 4 {
        return;
    }
    let scene = scene(state, area);
    backdrop::paint(state, &scene.view, buffer);
    Canvas::default()
        .marker(state.theme.marker())
        .x_bounds(scene.view.across())
        .y_bounds(scene.view.upward())
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
    // With the edited plan, the map shows its home and the fence around it.
    let mut home = if state.shows_edited_plan() { planned_home } else { craft_home };
    let mut spots = frame.map_or_else(Vec::new, |frame| spots_of(&plan.waypoints, 0, &frame, home));
    let (preview, first) = state.editor.preview().unwrap_or_default();
    let preview = frame
        .iter()
        .flat_map(|frame| preview.iter().map(move |waypoints| spots_of(waypoints, first, frame, home)));
    let preview = preview.collect();
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
        planned_home: (planned_home.distance(home) > 1.0 && !state.shows_edited_plan())
            .then_some(planned_home),
        craft: map_point::craft(&state.view),
        believed: believed.filter(|place| place.n.is_finite() && place.e.is_finite()),
        preview,
        current: vehicle.nav.as_ref().filter(|nav| nav.engaged).map(|nav| usize::from(nav.wp)),
    }
}

/// Returns the positional waypoints. A TAKEOFF is at home, whatever position its record has.
fn spots_of(waypoints: &[Waypoint], first: usize, frame: &LocalFrame, home: MapPoint) -> Vec<PlacedWaypoint> {
    let positional = (first..).zip(waypoints).filter(|(_, wp)| wp.kind.is_positional());
    positional
        .map(|(index, wp)| {
            let place = if wp.kind == WaypointType::Takeoff { home } else { to_map(frame, wp.position) };
            PlacedWaypoint { index, place, wp: *wp }
        })
        .collect()
}
