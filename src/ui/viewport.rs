//! The window of the map: converts between metres and cells.
//!
//! Places are metres north and east of the boot place. A cell is taken to be twice as high as wide, so a row spans
//! twice the metres of a column.

pub(super) mod moves;

use ratatui::layout::Rect;

use super::map_point::origin::origin;
use super::map_point::{MapPoint, craft, to_map};
use super::map_state::MapMode;
use super::other_flight::OtherFlight;
use super::shared::Shared;

/// The limits of the scale, metres per column.
const SCALE_LIMITS: (f64, f64) = (0.02, 20_000.0);
/// The number of steps of the automatic scale per octave.
const STEPS_PER_OCTAVE: f64 = 4.0;

/// The window of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Viewport {
    /// The cells of the window.
    pub area: Rect,
    pub centre: MapPoint,
    /// Metres per column; a row is twice that.
    pub scale: f64,
}

impl Viewport {
    /// Returns the window of the map in these cells.
    pub(super) fn of(state: &Shared, area: Rect) -> Self {
        match state.map.mode {
            // The whole preview, whatever was shown before.
            _ if state.editor.is_generating() => Self::fit(state, area),
            MapMode::Fit => Self::fit(state, area),
            MapMode::Follow(scale) => {
                let centre = craft(&state.view).unwrap_or_default();
                Self { area, centre, scale: limited(scale) }
            }
            MapMode::Free { n, e, scale } => {
                Self { area, centre: MapPoint::new(n, e), scale: limited(scale) }
            }
        }
    }

    /// Returns the window that shows plan, home and craft. Its scale changes in steps, so that it stays constant while
    /// the craft flies inside the plan.
    fn fit(state: &Shared, area: Rect) -> Self {
        let origin = origin(state);
        let home = state.view.vehicle.craft.home;
        let places = origin.iter().flat_map(|frame| {
            // The open plan, too, so that the map does not jump when a return home or a landing takes over.
            let plans = [state.shown_plan(), state.plan()];
            let waypoints =
                plans.into_iter().flat_map(|plan| &plan.waypoints).filter(|wp| wp.kind.uses_position());
            let preview = state.editor.preview().map_or(&[][..], |(plans, _)| plans).iter().flatten();
            let waypoints = waypoints.chain(preview).map(|wp| wp.position);
            waypoints.chain(home).map(|position| to_map(frame, position))
        });
        let mut low = MapPoint::default();
        let mut high = MapPoint::default();
        let craft = craft(&state.view);
        // A recorded flight is shown as a whole.
        let past = state.view.replay.as_ref().map_or(&[][..], |_| state.track.points());
        let other = state.other.as_ref().map_or(&[][..], OtherFlight::track);
        let flown = past.iter().chain(other).map(|point| MapPoint::new(point.n, point.e));
        for place in places.chain(craft).chain(flown) {
            low = MapPoint::new(low.n.min(place.n), low.e.min(place.e));
            high = MapPoint::new(high.n.max(place.n), high.e.max(place.e));
        }
        // Room for numbers at the sides, and for scale bar and wind below.
        let columns = f64::from(area.width.saturating_sub(16).max(8));
        let rows = f64::from(area.height.saturating_sub(4).max(3));
        let scale = ((high.e - low.e) / columns).max((high.n - low.n) / rows / 2.0).max(0.25);
        let stepped = ((scale.log2() * STEPS_PER_OCTAVE).ceil() / STEPS_PER_OCTAVE).exp2();
        let scale = limited(stepped);
        let mut centre = low.towards(high, 0.5);
        // A plan too far away for the widest scale must not push the craft out.
        if let Some(craft) = craft {
            let half_e = columns.min(0.9 * f64::from(area.width)) / 2.0 * scale;
            let half_n = rows.min(0.9 * f64::from(area.height)) * scale;
            centre.e = centre.e.clamp(craft.e - half_e, craft.e + half_e);
            centre.n = centre.n.clamp(craft.n - half_n, craft.n + half_n);
        }
        Self { area, centre, scale }
    }

    /// Returns column and row of a place, in cells from the top left of the area; they may be outside of it.
    pub(super) fn cell(&self, place: MapPoint) -> (f64, f64) {
        let column = f64::from(self.area.width) / 2.0 + (place.e - self.centre.e) / self.scale;
        let row = f64::from(self.area.height) / 2.0 - (place.n - self.centre.n) / (2.0 * self.scale);
        (column, row)
    }

    /// Returns the screen cell of a place, if it is inside.
    pub(super) fn screen_cell(&self, place: MapPoint) -> Option<(u16, u16)> {
        let (column, row) = self.cell(place);
        let inside = column >= 0.0
            && row >= 0.0
            && column < f64::from(self.area.width)
            && row < f64::from(self.area.height);
        inside.then(|| (self.area.x + column as u16, self.area.y + row as u16))
    }

    /// Returns column and row of a place, in dots of lines from the middle of the top left dot. A cell has two columns and
    /// four rows of dots.
    pub(super) fn dot(&self, place: MapPoint) -> (f64, f64) {
        let [west, east] = self.east_bounds();
        let [south, north] = self.north_bounds();
        let (columns, rows) =
            (f64::from(self.area.width) * 2.0 - 1.0, f64::from(self.area.height) * 4.0 - 1.0);
        ((place.e - west) / (east - west) * columns, (north - place.n) / (north - south) * rows)
    }

    /// Returns the place under the middle of a screen cell.
    pub(super) fn place(&self, column: u16, row: u16) -> MapPoint {
        let dc = f64::from(column) + 0.5 - f64::from(self.area.x) - f64::from(self.area.width) / 2.0;
        let dr = f64::from(row) + 0.5 - f64::from(self.area.y) - f64::from(self.area.height) / 2.0;
        MapPoint::new(self.centre.n - dr * 2.0 * self.scale, self.centre.e + dc * self.scale)
    }

    /// Returns the east limits of the window, m.
    pub(super) fn east_bounds(&self) -> [f64; 2] {
        let half = f64::from(self.area.width) / 2.0 * self.scale;
        [self.centre.e - half, self.centre.e + half]
    }

    /// Returns the north limits of the window, m.
    pub(super) fn north_bounds(&self) -> [f64; 2] {
        let half = f64::from(self.area.height) * self.scale;
        [self.centre.n - half, self.centre.n + half]
    }

    /// Returns the window moved by a number of columns and rows.
    pub(super) fn panned(&self, columns: f64, rows: f64) -> MapMode {
        MapMode::Free {
            n: self.centre.n - rows * 2.0 * self.scale,
            e: self.centre.e + columns * self.scale,
            scale: self.scale,
        }
    }

    /// Returns the window with its scale times `factor`; `fixed` keeps its place on the screen.
    pub(super) fn zoomed(&self, factor: f64, fixed: MapPoint) -> MapMode {
        let scale = limited(self.scale * factor);
        let ratio = scale / self.scale;
        let centre = fixed.towards(self.centre, ratio);
        MapMode::Free { n: centre.n, e: centre.e, scale }
    }
}

fn limited(scale: f64) -> f64 {
    if scale.is_finite() { scale.clamp(SCALE_LIMITS.0, SCALE_LIMITS.1) } else { 1.0 }
}

/// Returns the longest round length (1, 2, 5 times a power of ten) not above `metres`.
pub(super) fn round_length(metres: f64) -> f64 {
    let decade = 10_f64.powf(metres.max(1e-3).log10().floor());
    [5.0, 2.0].into_iter().map(|step| step * decade).find(|&length| length <= metres).unwrap_or(decade)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::plan::Waypoint;
    use crate::session::SessionView;
    use crate::telemetry::snapshot::TruthView;

    fn viewport() -> Viewport {
        Viewport { area: Rect::new(3, 5, 40, 20), centre: MapPoint::new(10.0, -20.0), scale: 2.0 }
    }

    #[test]
    fn cells_and_places_are_inverse_and_north_is_up() {
        let view = viewport();
        let place = view.place(13, 9);
        assert_eq!(view.screen_cell(place), Some((13, 9)));
        let north = view.cell(MapPoint::new(place.n + 4.0, place.e));
        let here = view.cell(place);
        assert!((here.1 - north.1 - 1.0).abs() < 1e-9, "a row is two columns of metres");
        let east = view.cell(MapPoint::new(place.n, place.e + 2.0));
        assert!((east.0 - here.0 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn zoom_keeps_the_place_under_the_pointer() {
        let view = viewport();
        let fixed = view.place(7, 22);
        let MapMode::Free { n, e, scale } = view.zoomed(0.5, fixed) else {
            panic!("zoom leaves the map free")
        };
        let after = Viewport { centre: MapPoint::new(n, e), scale, ..view };
        let (a, b) = (view.cell(fixed), after.cell(fixed));
        assert!((a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9);
    }

    #[test]
    fn the_fitted_map_shows_the_craft_however_far_plan_and_craft_are() {
        let mut state = Shared::bare((80, 24), SessionView::default());
        let far = LatLon::new(470_000_000, 80_000_000);
        for position in [LatLon::new(404_640_000, -795_175_000), far] {
            state.editor.edit("one waypoint", |document| {
                document.plan.waypoints.clear();
                document.plan.waypoints.push(Waypoint { position, ..Waypoint::default() });
            });
            for (n, e) in [(0.0, 0.0), (900.0, -30.0), (-4e6, 3e6), (2e7, 2e7)] {
                let truth = TruthView { lat_deg: 40.4635, lon_deg: -79.5182, n, e, ..TruthView::default() };
                std::sync::Arc::make_mut(&mut state.view.vehicle).truth = Some(truth);
                for (width, height) in [(8, 4), (20, 9), (53, 19), (180, 50)] {
                    let view = Viewport::of(&state, Rect::new(1, 3, width, height));
                    let cell = view.screen_cell(MapPoint::new(n, e));
                    assert!(cell.is_some(), "{width}x{height}, {n} {e}: {view:?}");
                }
            }
        }
    }

    #[test]
    fn scale_bars_are_round() {
        assert!((round_length(34.0) - 20.0).abs() < 1e-9);
        assert!((round_length(50.0) - 50.0).abs() < 1e-9);
        assert!((round_length(999.0) - 500.0).abs() < 1e-9);
        assert!((round_length(1.2) - 1.0).abs() < 1e-9);
    }
}
