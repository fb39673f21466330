//! The text of the map: waypoints, craft, home, scale and wind.

use crate::ui::acts::{ghost_path, past_flight};
use ratatui::buffer::Buffer;

use crate::plan::WaypointType;
use crate::ui::acts::map_edit::measure;
use crate::ui::axis::round_length;
use crate::ui::model::map_point::MapPoint;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use super::labels::Labels;
use super::{PlacedWaypoint, Scene, backdrop, off_screen};

/// Eight directions, clockwise from north.
const ARROWS: [&str; 8] = ["↑", "↗", "→", "↘", "↓", "↙", "←", "↖"];

/// Writes the text of the map: marks, numbers, craft, scale, wind.
pub(super) fn write(state: &Shared, scene: &Scene, buffer: &mut Buffer) {
    let theme = &state.theme;
    let vehicle = &state.view.vehicle;
    let mut labels = Labels::new(theme, scene.view, buffer);
    frame_notes(state, &mut labels);
    let ghost = ghost_path::ghost(state).filter(|_| scene.preview.is_empty());
    let sweep = state.survey.sweep().filter(|_| scene.preview.is_empty());
    let ghost_line = state.survey.line().or(ghost.map(|ghost| format!("··· {}", ghost.line)));
    if let Some(line) = &ghost_line {
        labels.top(line, Role::Predicted);
    }
    let home_known = vehicle.truth.is_some() || vehicle.craft.home.is_some();
    if home_known {
        labels.mark(scene.home, "⌂", Role::Title);
    }
    if let Some(place) = scene.planned_home {
        labels.mark(place, "⌂", Role::Dim);
    }
    for (place, mark, role) in sweep.iter().flat_map(|sweep| sweep.marks()) {
        labels.mark(place, mark, role);
    }
    for spot in &scene.spots {
        let role = if Some(spot.index) == scene.current { Role::Target } else { Role::Title };
        labels.mark(spot.place, glyph(spot.wp.kind), role);
    }
    if let Some(aim) = vehicle.nav.as_ref().filter(|nav| nav.engaged).and_then(|nav| nav.aim_ne) {
        labels.mark(MapPoint::new(aim.x, aim.y), "◌", Role::Target);
    }
    if let (Some(believed), Some(craft)) = (scene.believed, scene.craft)
        && believed.distance(craft) > 2.0
    {
        labels.mark(believed, "+", Role::Warn);
    }
    if let Some(place) = state.graphs.cursor_place() {
        labels.mark(place, "╋", Role::Focus);
    }
    if let Some((other, offset_s)) = state.other_flight() {
        let time_s = vehicle.time.as_secs_f64() - offset_s;
        if let Some(place) = other.place_at(time_s) {
            labels.mark(place, "○", Role::Predicted);
        }
        let shown = state.view.replay.as_ref().map_or("this flight", |replay| &replay.file);
        labels.top(&format!("── {shown}   ··· ○ {}", other.name), Role::Predicted);
    }
    if let Some(craft) = scene.craft {
        let heading = vehicle.truth.map(|truth| truth.heading_deg).or(vehicle.estimate.heading_deg);
        let on_map = |heading_deg: f64| arrow(heading_deg - scene.view.up_rad.to_degrees());
        let crashed = vehicle.truth.as_ref().is_some_and(|truth| truth.crashed);
        let (mark, role) =
            if crashed { ("✗", Role::Fault) } else { (heading.map_or("●", on_map), Role::Craft) };
        labels.mark(craft, mark, role);
    }
    if let Some(cursor) = state.map.edit {
        labels.mark(cursor.place, "┼", Role::Focus);
    }
    if let Some(tool) = &state.map.measure {
        labels.mark(tool.cursor, "┼", Role::Focus);
        for place in [tool.from, tool.to].into_iter().flatten() {
            labels.mark(place, "×", Role::Focus);
        }
        if let (Some((_, to)), Some(text)) = (measure::ends(tool), measure::measured(state)) {
            labels.beside(to, &format!(" {text}"), &text, Role::Focus);
        }
    }
    for spot in scene.preview.iter().flatten() {
        labels.mark(spot.place, glyph(spot.wp.kind), Role::Predicted);
    }
    for spot in scene.preview.iter().flatten() {
        let number = spot.index.to_string();
        labels.beside(spot.place, &number, &number, Role::Predicted);
    }
    // The label of the current waypoint is placed first.
    let mut order: Vec<&PlacedWaypoint> = scene.spots.iter().collect();
    order.sort_by_key(|spot| Some(spot.index) != scene.current);
    for spot in order {
        let role = if Some(spot.index) == scene.current { Role::Target } else { Role::Title };
        let number = spot.index.to_string();
        labels.beside(spot.place, &format!("{number} {}", spot.wp.kind), &number, role);
    }
    if home_known {
        labels.beside(scene.home, "home", "H", Role::Dim);
    }
    if let Some(place) = scene.planned_home {
        labels.beside(place, "home of the plan", "plan", Role::Dim);
    }
    off_screen::write(state, scene, home_known, &mut labels);
    backdrop::write_names(state, &mut labels);
    if let Some(why) = past_flight::without_track(state) {
        labels.middle(why, Role::Dim);
    } else if scene.craft.is_none() && scene.spots.is_empty() {
        labels.middle("No position yet: waiting for GPS.", Role::Dim);
    }
    // Again, over the marks, so that it stays readable.
    if let Some(line) = &ghost_line {
        labels.top(line, Role::Predicted);
    }
}

/// Returns the mark of a waypoint.
pub(super) fn glyph(kind: WaypointType) -> &'static str {
    match kind {
        WaypointType::Flyover => "◆",
        WaypointType::Flyby => "◇",
        WaypointType::Hold => "◎",
        WaypointType::Land => "▼",
        WaypointType::Takeoff => "▲",
        WaypointType::AltChange | WaypointType::Delay | WaypointType::YawRate => "·",
    }
}

/// Returns the arrow nearest to a heading.
pub(super) fn arrow(heading_deg: f64) -> &'static str {
    let eighth = (heading_deg / 45.0).round().rem_euclid(8.0);
    ARROWS.get(eighth as usize).copied().unwrap_or("↑")
}

/// Writes the wind at the bottom left, scale bar and north at the bottom right.
fn frame_notes(state: &Shared, labels: &mut Labels<'_>) {
    let vehicle = &state.view.vehicle;
    let units = state.units;
    let wind = match &vehicle.truth {
        Some(truth) => truth.wind_ne.map(|ne| (ne.x.hypot(ne.y), ne.y.atan2(ne.x).to_degrees())),
        None => vehicle.world.wind.map(|wind| (wind.speed_mps, wind.from_deg + 180.0)),
    };
    let up_deg = labels.view().up_rad.to_degrees();
    let wind = match wind {
        None => " wind —".to_owned(),
        Some((speed, _)) if speed < 0.05 => " calm".to_owned(),
        Some((speed, to_deg)) => {
            format!(" wind {} {:4.1} {}", arrow(to_deg - up_deg), units.speed(speed), units.speed_unit())
        }
    };
    let scale = units.length(labels.view().scale);
    let length = round_length(scale * f64::from(labels.view().area.width) / 5.0);
    let columns = (length / scale).round().max(2.0) as usize;
    let (line, unit) = ("─".repeat(columns.saturating_sub(2)), units.length_unit());
    let bar = format!("├{line}┤ {length} {unit}   N {} ", arrow(-up_deg));
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
}
