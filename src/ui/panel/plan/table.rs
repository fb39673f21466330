//! The waypoint table.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use strum::IntoEnumIterator as _;

use crate::geo::distance_bearing;
use crate::plan::edit::fix::waypoint_of;
use crate::plan::review::Finding;
use crate::plan::{FlightPlan, TimeUse, Waypoint};
use crate::ui::area::row;
use crate::ui::drawing;
use crate::ui::formatting::{compass, cut};
use crate::ui::model::editor::Column;
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;
use crate::ui::units::Units;

use super::legs;

/// The width from which all columns have room.
const WIDE: u16 = 75;
/// The width of mark and number before the first column.
const NUMBER: u16 = 4;

/// Returns the head and the width of a column.
fn column(column: Column, wide: bool, units: Units) -> (String, u16) {
    let (head, width) = match (column, wide) {
        (Column::Type, _) => ("type", 11),
        (Column::Latitude, _) => ("latitude", 12),
        (Column::Longitude, _) => ("longitude", 13),
        (Column::Altitude, true) => return (format!("alt {}", units.length_unit()), 9),
        (Column::Altitude, false) => return (format!("alt {}", units.length_unit()), 7),
        (Column::Speed, true) => (units.speed_unit(), 7),
        (Column::Speed, false) => (units.speed_unit(), 5),
        (Column::Time, true) => ("time s", 8),
        (Column::Time, false) => ("s", 5),
        (Column::Pattern, _) => (" pattern", 9),
    };
    (head.to_owned(), width)
}

/// Returns the columns that fit, with head, first cell and width. The one with the cursor is always among them.
fn columns(state: &Shared, width: u16) -> Vec<(Column, String, u16, u16)> {
    let wide = width >= WIDE;
    let mut shown: Vec<Column> = Column::iter().collect();
    let total =
        |shown: &[Column]| NUMBER + shown.iter().map(|&c| column(c, wide, state.units).1).sum::<u16>();
    // Pattern and speed go first: most plans can be read without them.
    for spare in [Column::Pattern, Column::Speed, Column::Time, Column::Latitude, Column::Longitude] {
        if total(&shown) > width && state.editor.column() != spare {
            shown.retain(|&column| column != spare);
        }
    }
    let mut at = NUMBER;
    shown
        .into_iter()
        .map(|shown| {
            let (head, width) = column(shown, wide, state.units);
            at += width;
            (shown, head, at - width, width)
        })
        .collect()
}

/// Returns the first cell of the columns about legs, if there is room for them.
fn legs_at(state: &Shared, width: u16) -> Option<u16> {
    let end = columns(state, width).last().map_or(NUMBER, |(_, _, x, width)| x + width);
    (width >= WIDE && end + legs::WIDTHS.iter().sum::<u16>() <= width).then_some(end)
}

/// Returns `true` if the table has the columns about legs.
pub(super) fn has_legs(state: &Shared, width: u16) -> bool {
    legs_at(state, width).is_some()
}

/// Returns the number of waypoints that differ between two plans.
pub(super) fn differences(plan: &FlightPlan, other: &FlightPlan) -> usize {
    let (a, b) = (&plan.waypoints, &other.waypoints);
    std::iter::zip(a, b).filter(|(a, b)| a != b).count() + a.len().abs_diff(b.len())
}

/// Returns the difference between a waypoint of the craft's plan and of the open one, if there is one.
pub(super) fn difference(state: &Shared, index: usize) -> Option<String> {
    let stored = state.view.vehicle.stored_plan.as_ref().filter(|plan| !plan.waypoints.is_empty())?;
    let ours = state.plan().waypoints.get(index)?;
    let Some(theirs) = stored.waypoints.get(index) else {
        return Some(format!("● The craft has no WP{index}."));
    };
    if ours == theirs {
        return None;
    }
    let mut parts = Vec::new();
    if ours.kind.uses_position() && theirs.kind.uses_position() {
        let (distance_m, bearing) = distance_bearing(ours.position, theirs.position);
        if distance_m > 0.05 {
            let distance = state.units.length_text(distance_m, 1);
            parts.push(format!("{distance} {:03.0}° from here", compass(bearing.to_degrees())));
        }
    }
    for column in Column::iter().filter(|column| !matches!(column, Column::Latitude | Column::Longitude)) {
        let theirs_shown = value(column, theirs, state.units);
        if column.is_used(theirs.kind) && theirs_shown != value(column, ours, state.units) {
            parts.push(format!("{} {theirs_shown}", column.name()));
        }
    }
    Some(format!("● On the craft WP{index} is: {}.", parts.join(", ")))
}

/// Returns the first shown waypoint for this number of rows.
fn first_row(state: &Shared, rows: usize) -> usize {
    let count = state.plan().waypoints.len();
    state.editor.row().saturating_sub(rows / 2).min(count.saturating_sub(rows))
}

/// Returns the waypoint and the column at a cell of the screen.
pub(super) fn cell_at(state: &Shared, area: Rect, (x, y): (u16, u16)) -> Option<(usize, Column)> {
    let rows = area.height.saturating_sub(1);
    let row = y.checked_sub(area.y + 1).filter(|&row| row < rows)?;
    let index = first_row(state, usize::from(rows)) + usize::from(row);
    let inside = x.checked_sub(area.x)?;
    let hit = columns(state, area.width)
        .into_iter()
        .find(|&(_, _, from, width)| (from..from + width).contains(&inside));
    (index < state.plan().waypoints.len()).then(|| (index, hit.map_or(Column::Type, |(column, ..)| column)))
}

/// Draws the table. Returns the position of the cursor while a cell is typed.
pub(super) fn draw(
    state: &Shared,
    findings: &[Finding],
    area: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = &state.theme;
    let waypoints = &state.plan().waypoints;
    let columns = columns(state, area.width);
    row(buffer, area, 0, theme, Role::Title, "  #");
    for (_, head, x, width) in &columns {
        let (x, width) = (*x, *width);
        let text = aligned(head, width, head == "type" || head == " pattern");
        drawing::text(
            buffer,
            area.x + x,
            area.y,
            cut(&text, usize::from(area.width.saturating_sub(x))),
            theme.style(Role::Title),
        );
    }
    let legs = legs_at(state, area.width).map(|x| (x, legs::rows(state)));
    let write_legs = |y: u16, cells: &[String; 4], role: Role, buffer: &mut Buffer| {
        let Some(mut x) = legs.as_ref().map(|(x, _)| *x) else { return };
        for (cell, width) in cells.iter().zip(legs::WIDTHS) {
            drawing::text(buffer, area.x + x, y, aligned(cell, width, false), theme.style(role));
            x += width;
        }
    };
    write_legs(area.y, &legs::heads(state), Role::Title, buffer);
    let rows = usize::from(area.height.saturating_sub(1));
    let focused = state.focus == Panel::Plan;
    let cursor_row = state.editor.row();
    let first = first_row(state, rows);
    let mut cursor = None;
    for (at, (index, wp)) in waypoints.iter().enumerate().skip(first).take(rows).enumerate() {
        let y = area.y + 1 + at as u16;
        let selected = state.editor.selection().is_some_and(|selection| selection.contains(&index));
        let (mark, role) = mark(state, findings, index, wp);
        let role = if selected { Role::Selected } else { role };
        row(buffer, Rect { y, height: 1, ..area }, 0, theme, role, &format!("{mark}{index:>2} "));
        if let Some(cells) = legs.as_ref().and_then(|(_, rows)| rows.get(index)) {
            write_legs(y, cells, if selected { Role::Selected } else { Role::Dim }, buffer);
        }
        for &(column, _, x, width) in &columns {
            let left = matches!(column, Column::Type | Column::Pattern);
            let here = focused && index == cursor_row && column == state.editor.column();
            let cell = Rect { x: area.x + x, y, width: width.min(area.width.saturating_sub(x)), height: 1 };
            if let Some(field) = state.editor.field().filter(|_| here) {
                let bad = field.problem.is_some();
                buffer.set_style(cell, theme.style(if bad { Role::Fault } else { Role::Focus }));
                let inside = Rect { x: cell.x + 1, width: cell.width.saturating_sub(1), ..cell };
                cursor = field.text.draw(theme, inside.intersection(area), buffer);
                continue;
            }
            let mut text = aligned(&value(column, wp, state.units), width, left);
            if here {
                text = in_brackets(&text, left);
            }
            let role = if here { Role::Focus } else { role };
            drawing::text(buffer, cell.x, y, cut(&text, usize::from(cell.width)), theme.style(role));
        }
    }
    cursor
}

/// Returns the mark before a waypoint: it has a finding, is being flown, or differs from the craft's.
fn mark(state: &Shared, findings: &[Finding], index: usize, wp: &Waypoint) -> (char, Role) {
    let vehicle = &state.view.vehicle;
    let wrong = findings.iter().find(|finding| waypoint_of(finding) == Some(index));
    let flying =
        vehicle.nav.as_ref().filter(|nav| nav.engaged && vehicle.active_plan.as_ref() == Some(state.plan()));
    let stored = vehicle.stored_plan.as_ref().filter(|plan| !plan.waypoints.is_empty());
    match wrong {
        Some(finding) if finding.is_refusal() => ('✗', Role::Fault),
        Some(_) => ('▲', Role::Warn),
        None if flying.is_some_and(|nav| usize::from(nav.wp) == index) => ('▸', Role::Target),
        None if stored.is_some_and(|plan| plan.waypoints.get(index) != Some(wp)) => ('●', Role::Text),
        None => (' ', Role::Text),
    }
}

/// Returns the value as the table shows it.
fn value(column: Column, wp: &Waypoint, units: Units) -> String {
    if !column.is_used(wp.kind) {
        return "—".to_owned();
    }
    match column {
        Column::Altitude => format!("{:.1}", units.length(wp.altitude.above_home_m())),
        Column::Speed if wp.kind.has_yaw_rate() => format!("{}°", wp.yaw_rate_dps),
        Column::Speed if wp.speed.own_mps().is_none() => "—".to_owned(),
        Column::Speed => format!("{:.1}", units.speed(wp.speed.mps())),
        Column::Time if wp.duration.is_zero() && wp.kind.capability().time == TimeUse::Stay => "∞".to_owned(),
        Column::Time => format!("{:.1}", wp.duration.get()),
        _ => column.text(wp, units),
    }
}

fn aligned(text: &str, width: u16, left: bool) -> String {
    let width = usize::from(width);
    if left { format!(" {text:<0$}", width.saturating_sub(1)) } else { format!("{text:>width$}") }
}

/// Returns the value under the cursor in brackets, padded to its column.
fn in_brackets(text: &str, left: bool) -> String {
    let inside = text.trim();
    let blank = text.chars().count().saturating_sub(inside.chars().count() + 2);
    if left { format!("[{inside}]{}", " ".repeat(blank)) } else { format!("{}[{inside}]", " ".repeat(blank)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{HoldPattern, WaypointType};

    #[test]
    fn what_a_waypoint_does_not_use_is_a_dash() {
        let takeoff = Waypoint { kind: WaypointType::Takeoff, ..Waypoint::default() };
        assert_eq!(value(Column::Latitude, &takeoff, Units::Metric), "—");
        let hold = Waypoint { kind: WaypointType::Hold, pattern: HoldPattern::Orbit, ..Waypoint::default() };
        assert_eq!(
            (value(Column::Time, &hold, Units::Metric), value(Column::Pattern, &hold, Units::Metric)),
            ("∞".into(), "ORBIT".into())
        );
        let rate = Waypoint { kind: WaypointType::YawRate, yaw_rate_dps: 20, ..Waypoint::default() };
        assert_eq!(value(Column::Speed, &rate, Units::Metric), "20°");
    }
}
