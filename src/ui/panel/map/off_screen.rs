//! Arrows at the edge of the map to craft and home outside of it.

use crate::ui::acts::viewport::Viewport;
use crate::ui::model::map_point::MapPoint;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use super::Scene;
use super::labels::Labels;
use super::marks::arrow;

/// Writes an arrow for each of them, with the distance from the middle of the map.
pub(super) fn write(state: &Shared, scene: &Scene, is_home_known: bool, labels: &mut Labels<'_>) {
    let view = *labels.view();
    let home = is_home_known.then_some(scene.home);
    let mut marks: Vec<((u16, u16), String, String, Role)> = Vec::new();
    for (place, name, role) in [(scene.craft, "craft", Role::Craft), (home, "home", Role::Title)] {
        let Some(place) = place.filter(|&place| view.screen_cell(place).is_none()) else { continue };
        let Some(mut cell) = edge(&view, place) else { continue };
        if marks.iter().any(|(taken, ..)| *taken == cell) {
            cell = next_on_edge(&view, cell);
        }
        let (north, east) = (place.n - view.centre.n, place.e - view.centre.e);
        let distance = state.units.length_text(north.hypot(east), 0);
        labels.mark(view.place(cell.0, cell.1), arrow((east.atan2(north) - view.up_rad).to_degrees()), role);
        marks.push((cell, format!("{name} {distance}"), distance, role));
    }
    // A label leaves the cells of all marks free.
    for ((column, row), long, short, role) in marks {
        labels.beside(view.place(column, row), &long, &short, role);
    }
}

/// Returns the next cell at the edge. The bottom line is left free.
fn next_on_edge(view: &Viewport, (column, row): (u16, u16)) -> (u16, u16) {
    let area = view.area;
    let step = |at: u16, end: u16| if at + 1 < end { at + 1 } else { at.saturating_sub(1) };
    if column == area.left() || column + 1 == area.right() {
        (column, step(row, area.bottom() - 1))
    } else {
        (step(column, area.right()), row)
    }
}

/// Returns the cell at the edge in the direction of a place. The bottom line is left free.
fn edge(view: &Viewport, place: MapPoint) -> Option<(u16, u16)> {
    let (width, height) = (f64::from(view.area.width), f64::from(view.area.height));
    let middle = (width / 2.0, height / 2.0);
    let (column, row) = view.cell(place);
    let (across, down) = (column - middle.0, row - middle.1);
    let reach = |way: f64, back: f64, on: f64| if way < 0.0 { back / -way } else { on / way };
    let share = reach(across, middle.0 - 0.5, width - 0.5 - middle.0).min(reach(
        down,
        middle.1 - 0.5,
        height - 1.5 - middle.1,
    ));
    if !share.is_finite() || share < 0.0 {
        return None;
    }
    let cell =
        |middle: f64, way: f64, cells: f64| (middle + way * share.min(1.0)).clamp(0.0, cells - 1.0) as u16;
    let (column, row) = (cell(middle.0, across, width), cell(middle.1, down, height - 1.0));
    Some((view.area.x + column, view.area.y + row))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use ratatui::layout::Rect;

    proptest! {
        #[test]
        fn the_edge_is_in_the_window_and_above_its_last_line(
            n in -1e6..1e6_f64, e in -1e6..1e6_f64, width in 8_u16..200, height in 4_u16..60,
        ) {
            let area = Rect::new(2, 3, width, height);
            let view = Viewport { area, centre: MapPoint::new(5.0, -3.0), scale: 0.5, up_rad: 0.7 };
            prop_assume!(view.screen_cell(MapPoint::new(n, e)).is_none());
            let first = edge(&view, MapPoint::new(n, e)).unwrap();
            let next = next_on_edge(&view, first);
            prop_assert_ne!(first, next);
            for (column, row) in [first, next] {
                prop_assert!(area.contains((column, row).into()) && row < area.bottom() - 1);
                let at_side = column == area.left() || column == area.right() - 1;
                prop_assert!(at_side || row == area.top() || row == area.bottom() - 2, "{column} {row}");
            }
        }
    }
}
