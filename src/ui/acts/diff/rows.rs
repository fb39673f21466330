//! The rows of two plans, of two documents, and of two sets of settings.

use strum::IntoEnumIterator as _;

use super::{DiffRow, Mark};
use crate::fc::{CraftSetting, same_value};
use crate::plan::edit::PlanDocument;
use crate::plan::{FlightPlan, Waypoint, differences};
use crate::ui::acts::setting_list::planned;
use crate::ui::model::editor::Column;
use crate::ui::model::settings::comparison::Comparison;
use crate::ui::shared::Shared;
use crate::ui::units::Units;

/// The value of a version that does not have the thing.
const NONE: &str = "—";

/// Returns the rows of two documents: their texts, the waypoints, the settings.
pub(super) fn of_documents(other: &PlanDocument, current: &PlanDocument, units: Units) -> Vec<DiffRow> {
    let home = |document: &PlanDocument| {
        document.home.map_or_else(String::new, |home| {
            let amsl =
                home.amsl_m.map_or_else(String::new, |amsl_m| format!(" {}", units.length_text(amsl_m, 1)));
            format!("{}{amsl}", home.position)
        })
    };
    let texts = [
        text_row("name", other.name.clone(), current.name.clone()),
        text_row("description", other.description.clone(), current.description.clone()),
        text_row("home", home(other), home(current)),
    ];
    let mut names: Vec<&str> = Vec::new();
    for name in other.settings.iter().chain(&current.settings).map(|line| parts(line).0) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let value = |document: &PlanDocument, name: &str| {
        let lines = document.settings.iter().rev().map(|line| parts(line));
        lines.into_iter().find(|line| line.0 == name).map_or_else(String::new, |line| line.1.to_owned())
    };
    let settings =
        names.into_iter().filter_map(|name| text_row(name, value(other, name), value(current, name)));
    let waypoints = of_plans(&other.plan, &current.plan, units);
    texts.into_iter().flatten().chain(waypoints).chain(settings).collect()
}

/// Returns the rows of two plans: one for each waypoint, and below it one for each value that differs.
pub(super) fn of_plans(other: &FlightPlan, current: &FlightPlan, units: Units) -> Vec<DiffRow> {
    let mut rows = Vec::new();
    for pair in differences::pairs(other, current) {
        let there = pair.from.and_then(|at| other.waypoints.get(at));
        let here = pair.to.and_then(|at| current.waypoints.get(at));
        let Some(either) = here.or(there) else { continue };
        let mark = match (there, here) {
            (Some(there), Some(here)) if there == here => Mark::Same,
            (Some(_), Some(_)) => Mark::Changed,
            (None, _) => Mark::Added,
            (_, None) => Mark::Removed,
        };
        let numbers = match (pair.from, pair.to) {
            (Some(from), Some(to)) if from != to => format!("WP{from}→{to}"),
            (Some(number), _) | (None, Some(number)) => format!("WP{number}"),
            (None, None) => String::new(),
        };
        let shown = |wp: Option<&Waypoint>| wp.map_or_else(|| NONE.to_owned(), |wp| outline(wp, units));
        let label = format!("{numbers} {}", either.kind);
        let waypoint = pair.to;
        let (there_shown, here_shown) = (shown(there), shown(here));
        rows.push(DiffRow { mark, label, other: there_shown, current: here_shown, waypoint, is_part: false });
        let Some((there, here)) = there.zip(here) else { continue };
        for column in Column::iter() {
            let [from, to] = [there, here].map(|wp| value(column, wp, units));
            if from != to {
                let label = column.name().to_owned();
                let mark = Mark::Changed;
                rows.push(DiffRow { mark, label, other: from, current: to, waypoint, is_part: true });
            }
        }
    }
    rows
}

/// Returns the rows of the settings that the open plan sets, with the values of the craft.
pub(super) fn of_plan_settings(state: &Shared) -> Vec<DiffRow> {
    let of = |line: &String| {
        let (name, current) = parts(line);
        let setting = state.settings.find(name)?;
        let is_same = same_value(&setting.value, current);
        let other = if is_same { current.to_owned() } else { setting.value.clone() };
        text_row(name, other, current.to_owned())
    };
    state.editor.document().settings.iter().filter_map(of).collect()
}

/// Returns the rows of settings beside other values of them. A setting without another value is left out.
pub(super) fn of_settings(state: &Shared, all: &[CraftSetting], comparison: Comparison) -> Vec<DiffRow> {
    let of = |setting: &CraftSetting| {
        let other = comparison.other(state, setting)?;
        let mark = if same_value(&other, &setting.value) { Mark::Same } else { Mark::Changed };
        let (label, current) = (setting.name.clone(), setting.value.clone());
        Some(DiffRow { mark, label, other, current, waypoint: None, is_part: false })
    };
    let is_planned =
        |setting: &&CraftSetting| comparison != Comparison::Plan || planned(state, &setting.name).is_some();
    all.iter().filter(is_planned).filter_map(of).collect()
}

/// Returns the row of a text; `None` if neither version has it.
fn text_row(label: &str, other: String, current: String) -> Option<DiffRow> {
    let mark = match (other.is_empty(), current.is_empty()) {
        (true, true) => return None,
        (true, false) => Mark::Added,
        (false, true) => Mark::Removed,
        (false, false) if other == current => Mark::Same,
        (false, false) => Mark::Changed,
    };
    let or_none = |text: String| if text.is_empty() { NONE.to_owned() } else { text };
    let (other, current) = (or_none(other), or_none(current));
    Some(DiffRow { mark, label: label.to_owned(), other, current, waypoint: None, is_part: false })
}

/// Returns the place and the altitude of a waypoint, or what else it has.
fn outline(wp: &Waypoint, units: Units) -> String {
    let value = |column: Column| Some(value(column, wp, units)).filter(|_| column.is_used(wp.kind));
    let shown = [Column::Latitude, Column::Longitude, Column::Altitude].map(value);
    let shown: Vec<String> = shown.into_iter().flatten().collect();
    if shown.is_empty() {
        value(Column::Time).unwrap_or_else(|| wp.kind.to_string())
    } else {
        shown.join(" ")
    }
}

/// Returns a value with its unit.
fn value(column: Column, wp: &Waypoint, units: Units) -> String {
    if !column.is_used(wp.kind) {
        return NONE.to_owned();
    }
    let text = column.text(wp, units);
    match column {
        Column::Altitude => format!("{text} {}", units.length_unit()),
        Column::Speed if wp.kind.has_yaw_rate() => format!("{text} °/s"),
        Column::Speed if wp.speed.own_mps().is_none() => "default".to_owned(),
        Column::Speed => format!("{text} {}", units.speed_unit()),
        Column::Time => format!("{text} s"),
        Column::Type | Column::Latitude | Column::Longitude | Column::Pattern => text,
    }
}

/// Returns name and value of `name = value`.
fn parts(line: &str) -> (&str, &str) {
    let (name, value) = line.split_once('=').unwrap_or((line, ""));
    (name.trim(), value.trim())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Altitude;

    fn document(altitudes: &[f64]) -> PlanDocument {
        let waypoint =
            |metres: &f64| Waypoint { altitude: Altitude::above_home(*metres), ..Waypoint::default() };
        let plan = FlightPlan { waypoints: altitudes.iter().map(waypoint).collect() };
        PlanDocument { plan, ..PlanDocument::default() }
    }

    fn lines(rows: &[DiffRow]) -> Vec<String> {
        let line =
            |row: &DiffRow| format!("{} {}: {} | {}", row.mark.symbol(), row.label, row.other, row.current);
        rows.iter().map(line).collect()
    }

    #[test]
    fn texts_waypoints_and_settings_of_two_documents_are_beside_each_other() {
        let settings = |lines: &[&str]| lines.iter().map(|line| (*line).to_owned()).collect::<Vec<_>>();
        let other = PlanDocument {
            name: "a".to_owned(),
            settings: settings(&["x = 1", "y = 2"]),
            ..document(&[50.0, 60.0])
        };
        let current = PlanDocument {
            name: "b".to_owned(),
            settings: settings(&["y=2", "z = 3"]),
            ..document(&[50.0, 40.0, 60.0])
        };
        let rows = of_documents(&other, &current, Units::Metric);
        let place = "0.0000000 0.0000000";
        assert_eq!(
            lines(&rows),
            [
                "≠ name: a | b".to_owned(),
                format!("= WP0 FLYOVER: {place} 50 m | {place} 50 m"),
                format!("+ WP1 FLYOVER: — | {place} 40 m"),
                format!("= WP1→2 FLYOVER: {place} 60 m | {place} 60 m"),
                "- x: 1 | —".to_owned(),
                "= y: 2 | 2".to_owned(),
                "+ z: — | 3".to_owned(),
            ]
        );
    }

    #[test]
    fn values_that_differ_are_below_their_waypoint_in_the_units_of_the_screen() {
        let rows = of_plans(&document(&[50.0]).plan, &document(&[62.5]).plan, Units::Metric);
        assert_eq!(lines(&rows)[1..], ["≠ altitude: 50 m | 62.5 m"]);
        assert!(rows[1].is_part && rows[1].waypoint == Some(0));
        let rows = of_plans(&document(&[50.0]).plan, &document(&[62.5]).plan, Units::Imperial);
        assert!(lines(&rows)[1].contains(" ft"), "{rows:?}");
    }
}
