//! Draws the backdrop of the open plan and the coordinate grid, under everything else.

use ratatui::buffer::Buffer;
use unicode_width::UnicodeWidthStr as _;

use crate::geo::{LatLon, LocalFrame};
use crate::plan::feature::Zone;
use crate::ui::acts::map_edit;
use crate::ui::acts::origin::origin;
use crate::ui::acts::viewport::Viewport;
use crate::ui::formatting::cut;
use crate::ui::model::backdrop::{BackdropLayer, Window};
use crate::ui::model::map_point::{MapPoint, to_map};
use crate::ui::raster::Raster;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use super::grid;
use super::labels::Labels;

/// Half a turn, 1e-7 degrees.
const HALF_TURN_E7: f64 = 1.8e9;
/// The most columns of a name.
const NAME_COLUMNS: usize = 24;
/// The most names for which room is looked for.
const MAX_NAMES: usize = 256;

/// Draws the grid, the lines, and the zones over them.
pub(super) fn paint(state: &Shared, view: &Viewport, buffer: &mut Buffer) {
    let layers = state.editor.plan().backdrop();
    if layers.is_empty() && !state.map.grid {
        return;
    }
    let Some(frame) = origin(state) else { return };
    let theme = &state.theme;
    if state.map.grid {
        let mut raster = Raster::new(view.area);
        grid::paint(&frame, view, &mut raster);
        raster.write(theme.style(Role::Backdrop), theme.charset, buffer);
    }
    for (of_zones, role) in [(false, Role::Backdrop), (true, Role::Zone)] {
        let mut raster = Raster::new(view.area);
        for layer in layers {
            lines(layer, of_zones, &frame, view, &mut raster);
        }
        raster.write(theme.style(role), theme.charset, buffer);
    }
}

fn lines(layer: &BackdropLayer, of_zones: bool, frame: &LocalFrame, view: &Viewport, raster: &mut Raster) {
    let to_dots = ToDots::new(frame, view);
    for run in layer.lines(of_zones).runs(view.scale / 2.0, window(frame, view)) {
        let mut from: Option<(f64, (f64, f64))> = None;
        for &position in run {
            let east = to_dots.east_e7(position);
            let dot = to_dots.dot(position);
            // A longer step goes around the other side of the globe.
            let start = from.filter(|(from_east, _)| (east - from_east).abs() < HALF_TURN_E7);
            if start.is_some() || run.len() == 1 {
                raster.line(start.map_or(dot, |(_, from)| from), dot);
            }
            from = Some((east, dot));
        }
    }
}

/// Converts positions to dots of the window, as [`to_map`] and [`Viewport::dot`] do, with four products each.
struct ToDots {
    origin: LatLon,
    /// The dots to the right and down for 1e-7 degrees to the east, and for 1e-7 degrees to the north.
    per_east: (f64, f64),
    per_north: (f64, f64),
    /// The dot of the origin.
    at: (f64, f64),
}

impl ToDots {
    fn new(frame: &LocalFrame, view: &Viewport) -> Self {
        let degree = to_map(frame, LatLon::from_degrees(frame.lat_deg + 0.5, frame.lon_deg + 0.5));
        let at = view.dot(MapPoint::default());
        let per_e7 = |end: (f64, f64)| ((end.0 - at.0) / 0.5e7, (end.1 - at.1) / 0.5e7);
        let per_east = per_e7(view.dot(MapPoint::new(0.0, degree.e)));
        let per_north = per_e7(view.dot(MapPoint::new(degree.n, 0.0)));
        let origin = LatLon::from_degrees(frame.lat_deg, frame.lon_deg);
        Self { origin, per_east, per_north, at }
    }

    /// Returns the angle from the origin to the east, the shorter way, 1e-7 degrees.
    fn east_e7(&self, position: LatLon) -> f64 {
        let east = f64::from(position.lon_e7) - f64::from(self.origin.lon_e7);
        if east > HALF_TURN_E7 {
            east - 2.0 * HALF_TURN_E7
        } else if east <= -HALF_TURN_E7 {
            east + 2.0 * HALF_TURN_E7
        } else {
            east
        }
    }

    fn dot(&self, position: LatLon) -> (f64, f64) {
        let north = f64::from(position.lat_e7) - f64::from(self.origin.lat_e7);
        let east = self.east_e7(position);
        let along = |at: f64, per_east: f64, per_north: f64| at + east * per_east + north * per_north;
        (
            along(self.at.0, self.per_east.0, self.per_north.0),
            along(self.at.1, self.per_east.1, self.per_north.1),
        )
    }
}

/// Returns the window of the map on the globe, with a margin of a cell.
fn window(frame: &LocalFrame, view: &Viewport) -> Window {
    let metres_per_degree = to_map(frame, LatLon::from_degrees(frame.lat_deg + 0.5, frame.lon_deg + 0.5));
    let (north_m, east_m) = view.reach();
    let half = |reach_m: f64, per_half_degree: f64| {
        (reach_m + 2.0 * view.scale) / per_half_degree.abs().max(1e-6) * 0.5e7
    };
    Window {
        centre: map_edit::position(frame, view.centre),
        half_lat_e7: half(north_m, metres_per_degree.n),
        half_lon_e7: half(east_m, metres_per_degree.e),
    }
}

/// Writes the names for which there is room, those of zones first, and those of the grid.
pub(super) fn write_names(state: &Shared, labels: &mut Labels<'_>) {
    let Some(frame) = origin(state) else { return };
    let view = *labels.view();
    if state.map.grid {
        grid::write(&frame, labels);
    }
    let window = window(&frame, &view);
    let all = || state.editor.plan().backdrop().iter().flat_map(BackdropLayer::names);
    let seen = |of_zones: bool| {
        all().filter(move |name| name.zone.is_some() == of_zones && window.shows(name.position))
    };
    for name in seen(true).chain(seen(false)).take(MAX_NAMES) {
        let text = cut(&name.text, NAME_COLUMNS);
        let role = match name.zone {
            Some(Zone::Exclusion | Zone::Inclusion) => Role::Zone,
            None => Role::Dim,
        };
        let place = to_map(&frame, name.position);
        let width = text.width() as i32;
        // Beside a point, else over the middle or near it.
        let offsets = if name.is_point {
            vec![(1, 0), (-width, 0), (1, -1), (1, 1), (-width, -1), (-width, 1)]
        } else {
            [0, -1, 1, -2, 2, -3, 3].map(|down| (-width / 2, down)).to_vec()
        };
        labels.on_free_ground(place, &text, &offsets, role);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use ratatui::layout::Rect;

    proptest! {
        #[test]
        fn positions_become_the_dots_of_their_places(
            lat in -80.0..80.0_f64, lon in -180.0..180.0_f64, n in -900.0..900.0_f64, e in -900.0..900.0_f64,
            scale in 0.1..50.0_f64, up_rad in -4.0..4.0_f64,
        ) {
            let frame = LocalFrame::new(lat, lon, 0.0);
            let view = Viewport { area: Rect::new(1, 2, 120, 40), centre: MapPoint::new(30.0, -20.0), scale, up_rad };
            let position = map_edit::position(&frame, MapPoint::new(n, e));
            let (dot, same) = (ToDots::new(&frame, &view).dot(position), view.dot(to_map(&frame, position)));
            let rounded = 0.05 / scale;
            prop_assert!((dot.0 - same.0).abs() < rounded && (dot.1 - same.1).abs() < rounded, "{dot:?} {same:?}");
        }
    }
}
