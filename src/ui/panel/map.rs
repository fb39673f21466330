//! 1 Map: metres, north up.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::Widget as _;
use ratatui::widgets::canvas::{Canvas, Context, Line as CanvasLine};

use crate::geo::GRAVITY;
use crate::plan::{FlightPlan, HoldPattern, Waypoint, WaypointType};
use crate::telemetry::NavTelemetry;
use crate::ui::map::{self, Ground, MapMode, Viewport, ground, round_length};
use crate::ui::state::{AppState, Pane};
use crate::ui::theme::Role;

mod labels;

use labels::Labels;

/// Dots of a dash and of the gap behind it.
const DASH_DOTS: f64 = 3.0;
/// A line of more dashes than this is drawn solid: the rest lies outside anyhow.
const MAX_DASHES: f64 = 400.0;
/// Eight directions, clockwise from north.
const ARROWS: [&str; 8] = ["↑", "↗", "→", "↘", "↓", "↙", "←", "↖"];

/// A waypoint on the ground.
struct Spot {
    index: usize,
    place: Ground,
    wp: Waypoint,
}

/// Everything the map shows, placed on the ground.
struct Scene {
    view: Viewport,
    spots: Vec<Spot>,
    home: Ground,
    craft: Option<Ground>,
    believed: Option<Ground>,
    current: Option<usize>,
}

/// The title: how the map chooses its place.
pub(crate) fn title(state: &AppState) -> String {
    let name = Pane::Map.title();
    let source = match &state.view.vehicle.active_plan {
        Some(_) if state.view.vehicle.nav.source != crate::telemetry::PlanSource::Stored => {
            format!(" — {} plan", state.view.vehicle.nav.source)
        }
        _ => String::new(),
    };
    match state.map.mode {
        MapMode::Fit => format!("{name}{source}"),
        MapMode::Follow(_) => format!("{name}{source} — follows"),
        MapMode::Free { .. } => format!("{name}{source} — 0 fits"),
    }
}

/// Draws the inside.
pub(crate) fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) {
    if area.width < 8 || area.height < 4 {
        return;
    }
    let scene = scene(state, area);
    Canvas::default()
        .marker(state.theme.marker())
        .x_bounds(scene.view.east_bounds())
        .y_bounds(scene.view.north_bounds())
        .paint(|context| paint(state, &scene, context))
        .render(area, buffer);
    write(state, &scene, buffer);
}

fn scene(state: &AppState, area: Rect) -> Scene {
    let vehicle = &state.view.vehicle;
    let plan = state.shown_plan();
    let origin = map::origin(state);
    let home =
        origin.zip(vehicle.craft.home).map_or_else(Ground::default, |(frame, home)| ground(&frame, home));
    let spots = origin.map_or_else(Vec::new, |frame| spots(plan, &frame, home));
    let estimate = &vehicle.estimate;
    let believed = estimate.n.zip(estimate.e).map(|(n, e)| Ground::new(n, e));
    Scene {
        view: Viewport::of(state, area),
        spots,
        home,
        craft: map::craft(&state.view),
        believed: believed.filter(|place| place.n.is_finite() && place.e.is_finite()),
        current: vehicle.nav.engaged.then_some(usize::from(vehicle.nav.wp)),
    }
}

/// The positional waypoints; a TAKEOFF stands at home, wherever its record points.
fn spots(plan: &FlightPlan, frame: &crate::geo::LocalFrame, home: Ground) -> Vec<Spot> {
    let positional = plan.waypoints.iter().enumerate().filter(|(_, wp)| wp.kind.is_positional());
    positional
        .map(|(index, wp)| {
            let place = if wp.kind == WaypointType::Takeoff { home } else { ground(frame, wp.position) };
            Spot { index, place, wp: *wp }
        })
        .collect()
}

/// The pencil of a layer: strokes of one colour in the metres of the map.
struct Pencil<'a, 'c> {
    context: &'a mut Context<'c>,
    colour: Color,
    dot_m: f64,
}

impl Pencil<'_, '_> {
    fn line(&mut self, a: Ground, b: Ground) {
        if a.n.is_finite() && a.e.is_finite() && b.n.is_finite() && b.e.is_finite() {
            self.context.draw(&CanvasLine::new(a.e, a.n, b.e, b.n, self.colour));
        }
    }

    fn dashed(&mut self, a: Ground, b: Ground) {
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

    /// A circle; every second piece only if `broken`.
    fn circle(&mut self, centre: Ground, radius_m: f64, broken: bool) {
        if !(radius_m.is_finite() && radius_m > self.dot_m) {
            return;
        }
        let pieces = (radius_m / self.dot_m).clamp(16.0, 240.0) as u32 * 2;
        let at = |piece: u32| {
            let angle = f64::from(piece) / f64::from(pieces) * std::f64::consts::TAU;
            Ground::new(centre.n + radius_m * angle.cos(), centre.e + radius_m * angle.sin())
        };
        for piece in (0..pieces).filter(|piece| !broken || piece % 4 < 2) {
            self.line(at(piece), at(piece + 1));
        }
    }
}

fn paint(state: &AppState, scene: &Scene, context: &mut Context<'_>) {
    let settings = &state.view.vehicle.settings;
    let theme = &state.theme;
    let dot_m = scene.view.scale / 2.0;
    let mut layer = |role: Role, strokes: &mut dyn FnMut(&mut Pencil<'_, '_>)| {
        strokes(&mut Pencil { context: &mut *context, colour: theme.colour(role), dot_m });
        context.layer();
    };
    layer(Role::Fence, &mut |pencil| {
        if let Some(fence_m) = settings.fence_m {
            pencil.circle(scene.home, fence_m, true);
        }
    });
    layer(Role::Dim, &mut |pencil| {
        legs(scene, pencil);
        for (at, spot) in scene.spots.iter().enumerate() {
            figure(state, scene, at, spot, pencil);
        }
    });
    layer(Role::Track, &mut |pencil| {
        let points = state.track.points();
        for pair in points.windows(2) {
            pencil.line(Ground::new(pair[0].n, pair[0].e), Ground::new(pair[1].n, pair[1].e));
        }
        // From the last point kept to where the craft is.
        if let (Some(last), Some(craft)) = (points.last(), scene.craft) {
            pencil.line(Ground::new(last.n, last.e), craft);
        }
    });
    layer(Role::Target, &mut |pencil| {
        if let Some((from, to)) = current_leg(state, scene) {
            pencil.dashed(from, to);
        }
    });
}

/// The legs in flight order, from home.
fn legs(scene: &Scene, pencil: &mut Pencil<'_, '_>) {
    let mut from = scene.home;
    for spot in &scene.spots {
        pencil.dashed(from, spot.place);
        from = spot.place;
    }
}

/// Where the current leg starts and ends.
fn current_leg(state: &AppState, scene: &Scene) -> Option<(Ground, Ground)> {
    let nav: &NavTelemetry = &state.view.vehicle.nav;
    let to = scene.spots.iter().find(|spot| Some(spot.index) == scene.current)?.place;
    let from = map::origin(state).zip(nav.leg_start).map(|(frame, start)| ground(&frame, start));
    Some((from.or(scene.craft)?, to))
}

/// What is flown at a waypoint: the radius that ends the leg, the hold pattern, the cut corner.
fn figure(state: &AppState, scene: &Scene, at: usize, spot: &Spot, pencil: &mut Pencil<'_, '_>) {
    let settings = &state.view.vehicle.settings;
    match (spot.wp.kind, spot.wp.pattern) {
        (WaypointType::Hold, HoldPattern::Orbit) => pencil.circle(spot.place, settings.orbit_radius_m, false),
        (WaypointType::Hold, HoldPattern::Figure8) => {
            let radius = settings.figure8_width_m / 2.0;
            for side in [-radius, radius] {
                pencil.circle(Ground::new(spot.place.n, spot.place.e + side), radius, false);
            }
        }
        (WaypointType::Hold | WaypointType::Land | WaypointType::Takeoff, _) => {
            pencil.circle(spot.place, settings.hold_radius_m, false);
        }
        (WaypointType::Flyby, _) => {
            let previous = at.checked_sub(1).map_or(scene.home, |before| scene.spots[before].place);
            match scene.spots.get(at + 1) {
                Some(next) => {
                    let radius = turn_radius(&spot.wp, settings.max_velocity_mps, settings.max_angle_deg);
                    cut_corner(previous, spot.place, next.place, radius, pencil);
                }
                None => pencil.circle(spot.place, settings.arrival_radius_m, false),
            }
        }
        (WaypointType::Flyover, _) => pencil.circle(spot.place, settings.arrival_radius_m, false),
        (WaypointType::AltChange | WaypointType::Delay | WaypointType::YawRate, _) => {}
    }
}

/// Radius of a coordinated turn at the speed of the leg, m: R = V² / (g·tan θ).
fn turn_radius(wp: &Waypoint, max_velocity_mps: f64, max_angle_deg: f64) -> f64 {
    let speed = match wp.speed_cms {
        0 => max_velocity_mps,
        cms => f64::from(cms) / 100.0,
    };
    speed * speed / (GRAVITY * max_angle_deg.to_radians().tan()).max(0.1)
}

/// The curve that leaves one leg and joins the next at `radius` from the corner.
fn cut_corner(from: Ground, corner: Ground, to: Ground, radius: f64, pencil: &mut Pencil<'_, '_>) {
    const PIECES: u32 = 12;
    let along = |end: Ground| {
        let length = corner.distance(end);
        if length > 0.1 { corner.towards(end, (radius / length).min(1.0)) } else { corner }
    };
    let (a, b) = (along(from), along(to));
    let at = |piece: u32| {
        let t = f64::from(piece) / f64::from(PIECES);
        a.towards(corner, t).towards(corner.towards(b, t), t)
    };
    for piece in 0..PIECES {
        pencil.line(at(piece), at(piece + 1));
    }
}

/// Writes what is text: marks, numbers, craft, scale, wind.
fn write(state: &AppState, scene: &Scene, buffer: &mut Buffer) {
    let theme = &state.theme;
    let vehicle = &state.view.vehicle;
    let mut labels = Labels::new(theme, scene.view, buffer);
    frame_notes(state, &mut labels);
    let home_known = vehicle.truth.is_some() || vehicle.craft.home.is_some();
    if home_known {
        labels.mark(scene.home, "⌂", Role::Title);
    }
    for spot in &scene.spots {
        let role = if Some(spot.index) == scene.current { Role::Target } else { Role::Title };
        labels.mark(spot.place, glyph(spot.wp.kind), role);
    }
    if let Some(aim) = vehicle.nav.aim_ne.filter(|_| vehicle.nav.engaged) {
        labels.mark(Ground::new(aim.x, aim.y), "◌", Role::Target);
    }
    if let (Some(believed), Some(craft)) = (scene.believed, scene.craft)
        && believed.distance(craft) > 2.0
    {
        labels.mark(believed, "+", Role::Warn);
    }
    if let Some(craft) = scene.craft {
        let heading = vehicle.truth.as_ref().map_or(vehicle.estimate.heading_deg, |truth| truth.heading_deg);
        let crashed = vehicle.truth.as_ref().is_some_and(|truth| truth.crashed);
        let (mark, role) = if crashed { ("✗", Role::Fault) } else { (arrow(heading), Role::Craft) };
        labels.mark(craft, mark, role);
    }
    // The current waypoint chooses its place first.
    let mut order: Vec<&Spot> = scene.spots.iter().collect();
    order.sort_by_key(|spot| Some(spot.index) != scene.current);
    for spot in order {
        let role = if Some(spot.index) == scene.current { Role::Target } else { Role::Title };
        let number = spot.index.to_string();
        labels.beside(spot.place, &format!("{number} {}", spot.wp.kind), &number, role);
    }
    if home_known {
        labels.beside(scene.home, "home", "H", Role::Dim);
    }
    if scene.craft.is_none() && scene.spots.is_empty() {
        labels.middle("No position yet: waiting for GPS.", Role::Dim);
    }
}

/// The mark of a waypoint.
fn glyph(kind: WaypointType) -> &'static str {
    match kind {
        WaypointType::Flyover => "◆",
        WaypointType::Flyby => "◇",
        WaypointType::Hold => "◎",
        WaypointType::Land => "▼",
        WaypointType::Takeoff => "▲",
        WaypointType::AltChange | WaypointType::Delay | WaypointType::YawRate => "·",
    }
}

/// The arrow nearest to a heading.
fn arrow(heading_deg: f64) -> &'static str {
    let eighth = (heading_deg / 45.0).round().rem_euclid(8.0);
    ARROWS.get(eighth as usize).copied().unwrap_or("↑")
}

/// Wind at the bottom left, scale bar and north at the bottom right.
fn frame_notes(state: &AppState, labels: &mut Labels<'_>) {
    let vehicle = &state.view.vehicle;
    let (speed, to_deg) = match &vehicle.truth {
        Some(truth) => (truth.wind_n.hypot(truth.wind_e), truth.wind_e.atan2(truth.wind_n).to_degrees()),
        None => (vehicle.world.wind_mps, vehicle.world.wind_from_deg + 180.0),
    };
    let wind = match state.view.simulator {
        // It does not tell.
        Some(_) => String::new(),
        None if speed < 0.05 => " calm".to_owned(),
        None => format!(" wind {} {speed:4.1} m/s", arrow(to_deg)),
    };
    let scale = labels.view().scale;
    let length = round_length(scale * f64::from(labels.view().area.width) / 5.0);
    let columns = (length / scale).round().max(2.0) as usize;
    let bar = format!("├{}┤ {length} m   N ↑ ", "─".repeat(columns.saturating_sub(2)));
    labels.bottom(&wind, &bar);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_point_where_the_craft_heads() {
        assert_eq!(arrow(0.0), "↑");
        assert_eq!(arrow(359.0), "↑");
        assert_eq!(arrow(-90.0), "←");
        assert_eq!(arrow(135.0), "↘");
        assert_eq!(arrow(f64::NAN), "↑");
    }

    #[test]
    fn the_turn_radius_is_that_of_a_coordinated_turn() {
        let wp = Waypoint { speed_cms: 500, ..Waypoint::default() };
        assert!((turn_radius(&wp, 10.0, 25.0) - 5.47).abs() < 0.01);
    }
}
