//! The lines of the map: fence, legs, hold patterns, flown track.

use crate::ui::acts::{ghost_path, map_edit};
use ratatui::style::Color;
use ratatui::widgets::canvas::{Context, Line as CanvasLine};

use crate::flight::sweep::Fate;
use crate::plan::{Approach, HoldPattern, Waypoint};
use crate::telemetry::snapshot::SettingsView;
use crate::telemetry::{FirmwareProfile, GuardName, NavTelemetry};
use crate::ui::acts::origin::origin;
use crate::ui::acts::viewport::Viewport;
use crate::ui::model::map_point::{MapPoint, to_map};
use crate::ui::model::map_state::{MapItem, Moving};
use crate::ui::model::other_flight::OtherFlight;
use crate::ui::model::survey;
use crate::ui::model::track::TrackPoint;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use super::track_line::TrackLine;
use super::{PlacedWaypoint, Scene};

/// The number of dots of a dash and of the gap after it.
const DASH_DOTS: f64 = 3.0;
/// The distance between two dots of a predicted path, in dots.
const DOT_GAP: f64 = 4.0;
/// One piece in this many is drawn of the part of a ring that is not flown.
const RING_GAP: u32 = 6;
/// A line of more dashes than this is drawn solid, because most of it is outside the window.
const MAX_DASHES: f64 = 400.0;

/// Draws the lines of a layer in one colour, in metres from the middle of the window.
struct LinePainter<'a, 'c> {
    context: &'a mut Context<'c>,
    view: Viewport,
    colour: Color,
    dot_m: f64,
}

impl LinePainter<'_, '_> {
    fn line(&mut self, a: MapPoint, b: MapPoint) {
        if a.n.is_finite() && a.e.is_finite() && b.n.is_finite() && b.e.is_finite() {
            let (a, b) = (self.view.relative(a), self.view.relative(b));
            self.context.draw(&CanvasLine::new(a.e, a.n, b.e, b.n, self.colour));
        }
    }

    fn track(&mut self, points: &[TrackPoint]) {
        self.context.draw(&TrackLine { points, view: self.view, colour: self.colour, dot_m: self.dot_m });
    }

    /// Draws a dot every few dots along a path.
    fn dotted(&mut self, way: impl Iterator<Item = MapPoint>) {
        let gap_m = DOT_GAP * self.dot_m;
        let mut last: Option<MapPoint> = None;
        for place in way {
            let Some(mut from) = last else {
                last = Some(place);
                continue;
            };
            let distance_m = from.distance(place);
            let dots = (distance_m / gap_m).min(MAX_DASHES) as u32;
            let start = from;
            for dot in 1..=dots {
                from = start.towards(place, f64::from(dot) * gap_m / distance_m);
                self.line(from, from);
            }
            last = Some(from);
        }
    }

    fn dashed(&mut self, a: MapPoint, b: MapPoint) {
        let dashes = a.distance(b) / (2.0 * DASH_DOTS * self.dot_m);
        if !(1.0..MAX_DASHES).contains(&dashes) {
            self.line(a, b);
            return;
        }
        let count = dashes.round();
        for dash in 0..count as u32 {
            let from = f64::from(dash) / count;
            self.line(a.towards(b, from), a.towards(b, from + 0.5 / count));
        }
    }

    /// Draws a circle, dashed if `broken`.
    fn circle(&mut self, centre: MapPoint, radius_m: f64, broken: bool) {
        self.arcs(centre, radius_m, |piece, _| !broken || piece % 4 < 2);
    }

    /// Draws the ring of an orbit, clockwise from north. If its time is shorter than a lap, the part that is not flown
    /// is faint.
    fn ring(&mut self, centre: MapPoint, radius_m: f64, laps: f64) {
        self.arcs(centre, radius_m, |piece, pieces| {
            f64::from(piece) < laps * f64::from(pieces) || piece % RING_GAP == 0
        });
    }

    /// Draws the pieces of a circle that `is_wanted` accepts. It receives the number of a piece, clockwise from north,
    /// and the number of all pieces.
    fn arcs(&mut self, centre: MapPoint, radius_m: f64, is_wanted: impl Fn(u32, u32) -> bool) {
        if !(radius_m.is_finite() && radius_m > self.dot_m) {
            return;
        }
        let pieces = (radius_m / self.dot_m).clamp(16.0, 240.0) as u32 * 2;
        let at = |piece: u32| {
            let angle = f64::from(piece) / f64::from(pieces) * std::f64::consts::TAU;
            MapPoint::new(centre.n + radius_m * angle.cos(), centre.e + radius_m * angle.sin())
        };
        for piece in (0..pieces).filter(|&piece| is_wanted(piece, pieces)) {
            self.line(at(piece), at(piece + 1));
        }
    }
}

pub(super) fn paint(state: &Shared, scene: &Scene, context: &mut Context<'_>) {
    let settings = state.view.vehicle.settings;
    let theme = &state.theme;
    let dot_m = scene.view.scale / 2.0;
    let mut layer = |role: Role, lines: &mut dyn FnMut(&mut LinePainter<'_, '_>)| {
        lines(&mut LinePainter {
            context: &mut *context,
            view: scene.view,
            colour: theme.colour(role),
            dot_m,
        });
        context.layer();
    };
    layer(Role::Fence, &mut |painter| {
        let fence_m = match state.map.moving {
            Some(Moving { item: MapItem::Fence, place, .. }) => Some(scene.home.distance(place)),
            _ if state.shows_edited_plan() || state.view.vehicle.active_plan.is_none() => {
                map_edit::fence_m(state)
            }
            _ => settings.and_then(|settings| settings.fence_m),
        };
        if let Some(fence_m) = fence_m {
            painter.circle(scene.home, fence_m, true);
        }
    });
    layer(Role::Dim, &mut |painter| {
        legs(scene.home, &scene.spots, painter);
        for (at, spot) in scene.spots.iter().enumerate() {
            figure(state, scene, at, spot, painter);
        }
    });
    layer(Role::Title, &mut |painter| {
        let ghost = ghost_path::ghost(state).filter(|_| scene.preview.is_empty());
        for pair in ghost.map_or(&[][..], |ghost| ghost.unchanged).windows(2) {
            let [from, to] = [&pair[0], &pair[1]].map(|point| MapPoint::new(point.n, point.e));
            painter.line(from, to);
        }
    });
    layer(Role::Predicted, &mut |painter| {
        let home_or_last = if state.editor.preview().is_some_and(|(_, first)| first > 0) {
            scene.spots.last().map_or(scene.home, |spot| spot.place)
        } else {
            scene.home
        };
        for (number, spots) in scene.preview.iter().enumerate() {
            legs(if number == 0 { home_or_last } else { scene.home }, spots, painter);
        }
        let is_free = scene.preview.is_empty() && state.survey.sweep().is_none();
        if let Some(ghost) = ghost_path::ghost(state).filter(|_| is_free) {
            painter.dotted(ghost.path.iter().map(|point| MapPoint::new(point.n, point.e)));
        }
    });
    if let Some(sweep) = state.survey.sweep().filter(|_| scene.preview.is_empty()) {
        for fate in [Fate::Home, Fate::Off, Fate::Lost] {
            layer(survey::role(fate), &mut |painter| {
                sweep.legs(fate).for_each(|(from, to)| painter.line(from, to));
            });
        }
    }
    // The track is bright up to the shown instant. The part after it, abandoned branches and earlier flights are faint.
    let (points, later) = state.track.points().split_at(state.track_points_shown());
    layer(Role::Dim, &mut |painter| {
        let past = if state.map.hides_past { &[] } else { state.past_flights.tracks() };
        for track in past.iter().chain(state.abandoned.tracks()).map(Vec::as_slice).chain([later]) {
            painter.track(track);
        }
    });
    layer(Role::Predicted, &mut |painter| {
        let other = state.other.as_ref().map_or(&[][..], OtherFlight::track);
        painter.dotted(other.iter().map(|point| MapPoint::new(point.n, point.e)));
    });
    layer(Role::Track, &mut |painter| {
        painter.track(points);
        // From the last kept point to the craft.
        if let (Some(last), Some(craft)) = (points.last(), scene.craft) {
            painter.line(MapPoint::new(last.n, last.e), craft);
        }
    });
    layer(Role::Focus, &mut |painter| {
        if let Some((from, to)) = state.map.measure.as_ref().and_then(map_edit::measure::ends) {
            painter.dashed(from, to);
        }
    });
    layer(Role::Target, &mut |painter| {
        if let Some((from, to)) = current_leg(state, scene) {
            painter.dashed(from, to);
        }
    });
}

/// Draws the legs of the open plan dashed, and those of another plan dotted.
pub(super) fn paint_two(
    state: &Shared,
    (view, home): (Viewport, MapPoint),
    [other, current]: [&[PlacedWaypoint]; 2],
    context: &mut Context<'_>,
) {
    let dot_m = view.scale / 2.0;
    let [dotted, dashed] = [Role::Predicted, Role::Track].map(|role| state.theme.colour(role));
    let path = std::iter::once(home).chain(other.iter().map(|spot| spot.place));
    LinePainter { context: &mut *context, view, colour: dotted, dot_m }.dotted(path);
    context.layer();
    legs(home, current, &mut LinePainter { context: &mut *context, view, colour: dashed, dot_m });
    context.layer();
}

/// Draws the legs in flight order, from a place on.
fn legs(mut from: MapPoint, spots: &[PlacedWaypoint], painter: &mut LinePainter<'_, '_>) {
    for spot in spots {
        painter.dashed(from, spot.place);
        from = spot.place;
    }
}

/// Returns the start and end of the current leg.
fn current_leg(state: &Shared, scene: &Scene) -> Option<(MapPoint, MapPoint)> {
    let nav: &NavTelemetry = state.view.vehicle.nav.as_ref()?;
    let to = scene.spots.iter().find(|spot| Some(spot.index) == scene.current)?.place;
    let from = origin(state).zip(nav.leg_start).map(|(frame, start)| to_map(&frame, start));
    Some((from.or(scene.craft)?, to))
}

/// Draws the figure at a waypoint: the radius that ends the leg, the hold pattern, the cut corner.
fn figure(
    state: &Shared,
    scene: &Scene,
    at: usize,
    spot: &PlacedWaypoint,
    painter: &mut LinePainter<'_, '_>,
) {
    let Some(settings) = &state.view.vehicle.settings else { return };
    let uses = spot.wp.kind.capability();
    match (uses.approach, spot.wp.pattern) {
        (_, HoldPattern::Orbit) if uses.pattern => {
            let laps = settings.orbit_laps(&spot.wp).unwrap_or(1.0);
            painter.ring(spot.place, settings.orbit_radius_m, laps);
        }
        (_, HoldPattern::Figure8) if uses.pattern => {
            let radius = settings.figure8_width_m / 2.0;
            for side in [-radius, radius] {
                painter.circle(MapPoint::new(spot.place.n, spot.place.e + side), radius, false);
            }
        }
        (Approach::Level | Approach::Stop | Approach::Climb, _) => {
            painter.circle(spot.place, settings.hold_radius_m, false);
        }
        (Approach::Turn | Approach::Pass, _) if settings.profile == FirmwareProfile::Master => {
            let gate_m = gate_m(state).filter(|_| scene.current == Some(spot.index));
            painter.circle(spot.place, gate_m.unwrap_or(settings.arrival_radius_m), false);
        }
        (Approach::Turn, _) => {
            let previous = at.checked_sub(1).map_or(scene.home, |before| scene.spots[before].place);
            match scene.spots.get(at + 1) {
                Some(next) => {
                    let radius = turn_radius(&spot.wp, settings);
                    cut_corner(previous, spot.place, next.place, radius, painter);
                }
                None => painter.circle(spot.place, settings.arrival_radius_m, false),
            }
        }
        (Approach::Pass, _) => painter.circle(spot.place, settings.arrival_radius_m, false),
        (Approach::Modify(_), _) => {}
    }
}

/// Returns the radius within which the current waypoint of a leg of master is reached, m.
fn gate_m(state: &Shared) -> Option<f64> {
    let guards = &state.view.vehicle.nav.as_ref()?.guards;
    guards.iter().find(|guard| guard.name == GuardName::Gate).map(|guard| guard.limit)
}

/// Returns the turn radius at the speed of the leg, m.
fn turn_radius(wp: &Waypoint, settings: &SettingsView) -> f64 {
    settings.turn_radius_m(wp.speed.own_mps().unwrap_or(settings.max_velocity_mps))
}

/// Draws the curve that leaves one leg and joins the next at `radius` from the corner.
fn cut_corner(
    from: MapPoint,
    corner: MapPoint,
    to: MapPoint,
    radius: f64,
    painter: &mut LinePainter<'_, '_>,
) {
    const PIECES: u32 = 12;
    let along = |end: MapPoint| {
        let length = corner.distance(end);
        if length > 0.1 { corner.towards(end, (radius / length).min(1.0)) } else { corner }
    };
    let (a, b) = (along(from), along(to));
    let at = |piece: u32| {
        let t = f64::from(piece) / f64::from(PIECES);
        a.towards(corner, t).towards(corner.towards(b, t), t)
    };
    for piece in 0..PIECES {
        painter.line(at(piece), at(piece + 1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::LegSpeed;

    #[test]
    fn the_turn_radius_is_that_of_a_coordinated_turn() {
        let wp = Waypoint { speed: LegSpeed::from_mps(5.0), ..Waypoint::default() };
        let settings =
            SettingsView { max_velocity_mps: 10.0, max_angle_deg: 25.0, ..SettingsView::default() };
        assert!((turn_radius(&wp, &settings) - 5.47).abs() < 0.01);
    }
}
