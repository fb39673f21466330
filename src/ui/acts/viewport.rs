//! The window of the map: converts between metres and cells.
//!
//! Places are metres north and east of the boot place. A cell is taken to be twice as high as wide, so a row spans
//! twice the metres of a column. North is up, or the course of the craft.

pub(in crate::ui) mod moves;

use ratatui::layout::Rect;

use crate::ui::acts::origin::origin;
use crate::ui::model::map_point::{MapPoint, craft, to_map};
use crate::ui::model::map_state::MapMode;
use crate::ui::model::other_flight::OtherFlight;
use crate::ui::shared::Shared;

/// The bearing at the top of the map changes in steps of this many degrees, so that noise does not turn the map.
const TURN_STEP_DEG: f64 = 5.0;
/// The ground speed below which the heading is at the top of the map instead of the course, m/s. The heading is also
/// used for a craft without a simulated truth.
const COURSE_MPS: f64 = 1.0;
/// The craft stays in this share of a window that keeps it in view.
const KEPT_SHARE: f64 = 0.8;
/// The limits of the scale, metres per column.
const SCALE_LIMITS: (f64, f64) = (0.02, 20_000.0);
/// The number of steps of the automatic scale per octave.
const STEPS_PER_OCTAVE: f64 = 4.0;

/// The window of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::ui) struct Viewport {
    /// The cells of the window.
    pub area: Rect,
    pub centre: MapPoint,
    /// Metres per column; a row is twice that.
    pub scale: f64,
    /// The bearing that is up, clockwise from north, rad.
    pub up_rad: f64,
}

impl Viewport {
    /// Returns the window of the map in these cells.
    pub(in crate::ui) fn of(state: &Shared, area: Rect) -> Self {
        let up_rad = up_rad(state);
        match state.map.mode {
            // The whole preview, whatever was shown before.
            _ if state.editor.is_generating() => Self::fit(state, area, up_rad),
            MapMode::Fit => Self::fit(state, area, up_rad),
            MapMode::Follow(scale) => {
                let centre = craft(&state.view).unwrap_or_default();
                Self { area, centre, scale: limited(scale), up_rad }
            }
            MapMode::Free { n, e, scale } => {
                Self { area, centre: MapPoint::new(n, e), scale: limited(scale), up_rad }
            }
            MapMode::Near { n, e, scale } => {
                let view = Self { area, centre: MapPoint::new(n, e), scale: limited(scale), up_rad };
                craft(&state.view).map_or(view, |craft| view.moved_to_keep(craft))
            }
        }
    }

    /// Returns the window that shows plan, home and craft. Its scale changes in steps, so that it stays constant while
    /// the craft flies inside the plan.
    fn fit(state: &Shared, area: Rect, up_rad: f64) -> Self {
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
        let craft = craft(&state.view);
        // A recorded flight is shown as a whole.
        let past = state.view.replay.as_ref().map_or(&[][..], |_| state.track.points());
        let other = state.other.as_ref().map_or(&[][..], OtherFlight::track);
        let flown = past.iter().chain(other).map(|point| MapPoint::new(point.n, point.e));
        let boot = std::iter::once(MapPoint::default());
        Self::around((area, up_rad), craft, boot.chain(places).chain(craft).chain(flown))
    }

    /// Returns the window of an area that shows these places. The craft is never pushed out.
    pub(in crate::ui) fn around(
        (area, up_rad): (Rect, f64),
        craft: Option<MapPoint>,
        places: impl Iterator<Item = MapPoint>,
    ) -> Self {
        let turned = |place: MapPoint| place.turned(up_rad);
        let mut places = places.map(turned);
        let mut low = places.next().unwrap_or_default();
        let mut high = low;
        for place in places {
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
        if let Some(craft) = craft.map(turned) {
            let half_e = columns.min(0.9 * f64::from(area.width)) / 2.0 * scale;
            let half_n = rows.min(0.9 * f64::from(area.height)) * scale;
            centre.e = centre.e.clamp(craft.e - half_e, craft.e + half_e);
            centre.n = centre.n.clamp(craft.n - half_n, craft.n + half_n);
        }
        Self { area, centre: centre.turned(-up_rad), scale, up_rad }
    }

    /// Returns column and row of a place, in cells from the top left of the area; they may be outside of it.
    pub(in crate::ui) fn cell(&self, place: MapPoint) -> (f64, f64) {
        let relative = self.relative(place);
        let column = f64::from(self.area.width) / 2.0 + relative.e / self.scale;
        let row = f64::from(self.area.height) / 2.0 - relative.n / (2.0 * self.scale);
        (column, row)
    }

    /// Returns the screen cell of a place, if it is inside.
    pub(in crate::ui) fn screen_cell(&self, place: MapPoint) -> Option<(u16, u16)> {
        let (column, row) = self.cell(place);
        let inside = column >= 0.0
            && row >= 0.0
            && column < f64::from(self.area.width)
            && row < f64::from(self.area.height);
        inside.then(|| (self.area.x + column as u16, self.area.y + row as u16))
    }

    /// Returns column and row of a place, in dots of lines from the middle of the top left dot. A cell has two columns and
    /// four rows of dots.
    pub(in crate::ui) fn dot(&self, place: MapPoint) -> (f64, f64) {
        let relative = self.relative(place);
        let ([left, right], [bottom, top]) = (self.across(), self.upward());
        let (columns, rows) =
            (f64::from(self.area.width) * 2.0 - 1.0, f64::from(self.area.height) * 4.0 - 1.0);
        ((relative.e - left) / (right - left) * columns, (top - relative.n) / (top - bottom) * rows)
    }

    /// Returns the place under the middle of a screen cell.
    pub(in crate::ui) fn place(&self, column: u16, row: u16) -> MapPoint {
        let dc = f64::from(column) + 0.5 - f64::from(self.area.x) - f64::from(self.area.width) / 2.0;
        let dr = f64::from(row) + 0.5 - f64::from(self.area.y) - f64::from(self.area.height) / 2.0;
        self.beside(self.centre, dc, dr)
    }

    /// Returns the place a number of columns to the right of another and a number of rows below it.
    pub(in crate::ui) fn beside(&self, place: MapPoint, columns: f64, rows: f64) -> MapPoint {
        let step = MapPoint::new(-rows * 2.0 * self.scale, columns * self.scale).turned(-self.up_rad);
        MapPoint::new(place.n + step.n, place.e + step.e)
    }

    /// Returns the distance of a place above the centre and to the right of it, m.
    pub(in crate::ui) fn relative(&self, place: MapPoint) -> MapPoint {
        MapPoint::new(place.n - self.centre.n, place.e - self.centre.e).turned(self.up_rad)
    }

    /// Returns the limits of the window to the left and to the right of its centre, m.
    pub(in crate::ui) fn across(&self) -> [f64; 2] {
        let half = f64::from(self.area.width) / 2.0 * self.scale;
        [-half, half]
    }

    /// Returns the limits of the window below its centre and above it, m.
    pub(in crate::ui) fn upward(&self) -> [f64; 2] {
        let half = f64::from(self.area.height) * self.scale;
        [-half, half]
    }

    /// Returns the greatest distances to the north and to the east of the centre in the window, m.
    pub(in crate::ui) fn reach(&self) -> (f64, f64) {
        let ([_, right], [_, top]) = (self.across(), self.upward());
        let (sin, cos) = self.up_rad.sin_cos();
        (top * cos.abs() + right * sin.abs(), right * cos.abs() + top * sin.abs())
    }

    /// Returns the window moved as little as keeps a place in its inner part.
    fn moved_to_keep(self, place: MapPoint) -> Self {
        let relative = self.relative(place);
        let ([_, right], [_, top]) = (self.across(), self.upward());
        let too_far = |distance: f64, limit: f64| distance - distance.clamp(-limit, limit);
        let (up, across) = (too_far(relative.n, KEPT_SHARE * top), too_far(relative.e, KEPT_SHARE * right));
        let centre = self.beside(self.centre, across / self.scale, -up / (2.0 * self.scale));
        Self { centre, ..self }
    }

    /// Returns the mode that shows this window whatever the craft does.
    pub(in crate::ui) fn free(&self) -> MapMode {
        MapMode::Free { n: self.centre.n, e: self.centre.e, scale: self.scale }
    }

    /// Returns the mode that shows this window, moved so that the craft stays in it.
    pub(in crate::ui) fn near(&self) -> MapMode {
        MapMode::Near { n: self.centre.n, e: self.centre.e, scale: self.scale }
    }

    /// Returns the window moved by a number of columns and rows.
    pub(in crate::ui) fn panned(&self, columns: f64, rows: f64) -> MapMode {
        Self { centre: self.beside(self.centre, columns, rows), ..*self }.free()
    }

    /// Returns the window with its scale times `factor`; `fixed` keeps its place on the screen.
    pub(in crate::ui) fn zoomed(&self, factor: f64, fixed: MapPoint) -> Self {
        let scale = limited(self.scale * factor);
        let ratio = scale / self.scale;
        Self { centre: fixed.towards(self.centre, ratio), scale, ..*self }
    }
}

/// Returns the bearing that is up on the map, rad. North is up while the user edits or measures, so that the map does
/// not turn under the cursor.
fn up_rad(state: &Shared) -> f64 {
    if !state.map.course_up || state.edits_on_map() || state.map.measure.is_some() {
        return 0.0;
    }
    let vehicle = &state.view.vehicle;
    let moves = vehicle.truth.as_ref().filter(|truth| truth.ground_speed_mps() >= COURSE_MPS);
    let course = moves.map(|truth| truth.ve.atan2(truth.vn).to_degrees());
    let heading = vehicle.truth.as_ref().map(|truth| truth.heading_deg).or(vehicle.estimate.heading_deg);
    let up_deg = course.or(heading).filter(|up_deg| up_deg.is_finite()).unwrap_or(0.0);
    ((up_deg / TURN_STEP_DEG).round() * TURN_STEP_DEG).to_radians()
}

fn limited(scale: f64) -> f64 {
    if scale.is_finite() { scale.clamp(SCALE_LIMITS.0, SCALE_LIMITS.1) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::plan::Waypoint;
    use crate::session::SessionView;
    use crate::telemetry::snapshot::TruthView;

    fn viewport() -> Viewport {
        Viewport {
            area: Rect::new(3, 5, 40, 20),
            centre: MapPoint::new(10.0, -20.0),
            scale: 2.0,
            up_rad: 0.0,
        }
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
    fn a_turned_map_has_its_bearing_at_the_top() {
        let view = Viewport { up_rad: 90_f64.to_radians(), ..viewport() };
        let ahead = view.cell(MapPoint::new(view.centre.n, view.centre.e + 8.0));
        assert!((ahead.0 - 20.0).abs() < 1e-9 && (ahead.1 - 8.0).abs() < 1e-9, "{ahead:?}: east is up");
        let place = view.place(13, 9);
        assert_eq!(view.screen_cell(place), Some((13, 9)));
        let (north_m, east_m) = view.reach();
        assert!((north_m - 40.0).abs() < 1e-9 && (east_m - 40.0).abs() < 1e-9, "{north_m} {east_m}");
    }

    #[test]
    fn a_window_moves_only_as_far_as_keeps_the_craft_in_view() {
        let view = viewport();
        assert_eq!(view.moved_to_keep(MapPoint::new(12.0, -25.0)), view);
        let moved = view.moved_to_keep(MapPoint::new(10.0, 100.0));
        assert!((moved.centre.e - (100.0 - KEPT_SHARE * 40.0)).abs() < 1e-9, "{moved:?}");
        assert!((moved.centre.n - view.centre.n).abs() < 1e-9);
    }

    #[test]
    fn zoom_keeps_the_place_under_the_pointer() {
        let view = viewport();
        let fixed = view.place(7, 22);
        let after = view.zoomed(0.5, fixed);
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
}
