//! The map without a screen: distances and bearings of the craft, home, the fence and the waypoints.

use crate::plan::Waypoint;
use crate::ui::acts::map_edit;
use crate::ui::acts::origin::origin;
use crate::ui::formatting::compass;
use crate::ui::model::map_point;
use crate::ui::model::map_point::{MapPoint, to_map};
use crate::ui::panel::in_words::number;
use crate::ui::shared::Shared;

/// Returns the map as lines of text.
pub(super) fn lines(state: &Shared) -> Vec<String> {
    let vehicle = &state.view.vehicle;
    let frame = origin(state);
    let home =
        frame.zip(vehicle.craft.home).map_or(MapPoint::default(), |(frame, home)| to_map(&frame, home));
    let craft = map_point::craft(&state.view);
    let mut lines = vec![match craft {
        Some(place) => format!("Craft: {}{}.", from(state, home, place, "home"), motion(state)),
        None => "Craft: no position yet.".to_owned(),
    }];
    if let Some(fence_m) = map_edit::fence_m(state) {
        let left = craft.map(|craft| fence_m - craft.distance(home));
        let left = left.map_or_else(String::new, |left_m| match left_m {
            left_m if left_m < 0.0 => {
                format!(", the craft is {} outside", state.units.length_text(-left_m, 0))
            }
            left_m => format!(", the craft is {} inside", state.units.length_text(left_m, 0)),
        });
        lines.push(format!("Fence: {} around home{left}.", state.units.length_text(fence_m, 0)));
    }
    let current = vehicle.nav.as_ref().filter(|nav| nav.engaged).map(|nav| usize::from(nav.wp));
    let (start, name) = craft.map_or((home, "home"), |craft| (craft, "the craft"));
    for (index, waypoint) in state.shown_plan().waypoints.iter().enumerate() {
        let place = frame.filter(|_| waypoint.kind.uses_position());
        let place = place.map(|frame| to_map(&frame, waypoint.position));
        let place = place.map_or_else(String::new, |place| format!(": {}", from(state, start, place, name)));
        let flown = if current == Some(index) { ", flown now" } else { "" };
        lines.push(format!("WP{index} {}{place}{}{flown}.", waypoint.kind, altitude(state, waypoint)));
    }
    lines
}

fn altitude(state: &Shared, waypoint: &Waypoint) -> String {
    let above_home_m = waypoint.altitude.above_home_m();
    format!(", {} above home", state.units.length_text(above_home_m, 1))
}

/// Returns distance and bearing of a place from another one, which has a name.
fn from(state: &Shared, start: MapPoint, place: MapPoint, name: &str) -> String {
    let (n, e) = (place.n - start.n, place.e - start.e);
    let distance = state.units.length_text(n.hypot(e), 1);
    format!("{distance} {:03.0}° from {name}", compass(e.atan2(n).to_degrees()))
}

/// Returns altitude, heading, speed and climb of the craft.
fn motion(state: &Shared) -> String {
    let (estimate, truth) = (&state.view.vehicle.estimate, &state.view.vehicle.truth);
    let units = state.units;
    let alt_m = truth.as_ref().map(|truth| truth.alt).or(estimate.alt);
    let heading_deg = truth.as_ref().map(|truth| truth.heading_deg).or(estimate.heading_deg);
    let parts = [
        alt_m.map(|alt_m| format!("{} above home", units.length_text(alt_m, 1))),
        heading_deg.map(|degrees| format!("heading {:03.0}°", compass(degrees))),
        estimate.ground_speed_mps.map(|mps| units.speed_text(mps, 1)),
        estimate
            .climb_mps
            .map(|mps| format!("climb {} {}", number(Some(units.speed(mps)), 1), units.speed_unit())),
    ];
    parts.into_iter().flatten().map(|part| format!(", {part}")).collect()
}
