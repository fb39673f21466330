//! The picture of the list.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

use super::{SettingsPanel, details};
use crate::fc::CraftSetting;
use crate::ui::acts::setting_list::{Row, planned, rows};
use crate::ui::area::{line, row, span};
use crate::ui::formatting::cut;
use crate::ui::model::panel_table::Panel;
use crate::ui::model::settings::comparison::Comparison;
use crate::ui::shared::Shared;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::Role;

/// The width of pointer and marks.
const MARKS: usize = 4;
/// The width of a value and of the value beside it, and the same where there is little room.
const VALUE: usize = 14;
const NARROW: usize = 10;
/// The width of a unit and of a range.
const UNIT: usize = 8;
const RANGE: usize = 24;
/// The widths from which the unit, the compared value, the range and the description have a column.
const WITH_UNIT: usize = 40;
const WITH_WIDE_VALUES: usize = 50;
const WITH_OTHER: usize = 62;
const WITH_RANGE: usize = 100;
const WITH_HELP: usize = 130;

/// The columns at a width of the inside.
#[derive(Debug, Clone, Copy)]
struct Columns {
    name: usize,
    /// The width of a value.
    value: usize,
    unit: bool,
    other: bool,
    range: bool,
    help: bool,
}

impl Columns {
    fn of(width: usize, comparison: Comparison) -> Self {
        let is_narrow = width < WITH_OTHER;
        // In a comparison the other value is what the list is for.
        let other = !is_narrow || comparison != Comparison::All;
        let unit = width >= WITH_UNIT && !(is_narrow && other);
        let value = if is_narrow && other || width < WITH_WIDE_VALUES { NARROW } else { VALUE };
        let (range, help) = (width >= WITH_RANGE, width >= WITH_HELP);
        let taken = MARKS
            + value
            + if unit { UNIT + 1 } else { 0 }
            + if other { value + 1 } else { 0 }
            + if range { RANGE + 1 } else { 0 };
        let name = width.saturating_sub(taken + 1).clamp(10, 33);
        Self { name, value, unit, other, range, help }
    }
}

/// Returns the rows of the list, without the head, the search and the details.
fn list_area(area: Rect) -> Rect {
    let rest = area.height.saturating_sub(1 + details::rows(area));
    Rect { y: area.y + area.height.min(1), height: rest, ..area }
}

/// Returns the first shown row, so that the selected one is visible.
fn first(panel: &SettingsPanel, rows: &[Row<'_>], height: usize) -> usize {
    let selected = panel.selected_row(rows).unwrap_or(0);
    // The first setting is shown below its heading.
    selected.saturating_sub(height / 2).min(rows.len().saturating_sub(height))
}

/// Returns the row of the list at a line of the screen.
pub(super) fn row_at(panel: &SettingsPanel, state: &Shared, area: Rect, screen_row: u16) -> Option<usize> {
    let list = list_area(area);
    let rows = rows(state, &panel.choice);
    let at = usize::from(screen_row.checked_sub(list.y).filter(|at| *at < list.height)?);
    let at = first(panel, &rows, usize::from(list.height)) + at;
    matches!(rows.get(at), Some(Row::Setting(_))).then_some(at)
}

/// Returns `true` if a column of the screen is right of the names.
pub(super) fn is_value(panel: &SettingsPanel, area: Rect, column: u16) -> bool {
    let columns = Columns::of(usize::from(area.width), panel.choice.comparison);
    usize::from(column.saturating_sub(area.x)) > MARKS + columns.name
}

/// Draws the panel. Returns the position of the cursor while something is typed.
pub(super) fn draw(
    panel: &SettingsPanel,
    state: &Shared,
    area: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = &state.theme;
    let rows = rows(state, &panel.choice);
    let list = list_area(area);
    let cursor = head(panel, state, area, buffer);
    if rows.is_empty() {
        let lines = wrapped(&empty(panel, state), usize::from(area.width));
        for (at, text) in lines.iter().enumerate() {
            row(buffer, list, at as u16, theme, Role::Dim, text);
        }
        return cursor;
    }
    let columns = Columns::of(usize::from(area.width), panel.choice.comparison);
    let selected = panel.selected_row(&rows);
    let first = first(panel, &rows, usize::from(list.height));
    let mut field = None;
    for (at, shown) in rows.iter().enumerate().skip(first).take(usize::from(list.height)) {
        let screen_row = (at - first) as u16;
        match shown {
            Row::Heading(title) => {
                row(buffer, list, screen_row, theme, Role::Title, &format!("─ {title} "));
            }
            Row::Setting(setting) => {
                let is_selected = state.focus == Panel::Settings && selected == Some(at);
                line(buffer, list, screen_row, &picture(panel, state, setting, columns, is_selected));
                if let Some(edit) = panel.edit.as_ref().filter(|edit| edit.name == setting.name) {
                    let x = list.x + (MARKS + columns.name) as u16;
                    let place =
                        Rect::new(x, list.y + screen_row, columns.value as u16 + 1, 1).intersection(list);
                    row(buffer, place, 0, theme, Role::Text, &" ".repeat(columns.value + 1));
                    field = edit.field.draw(theme, place, buffer);
                }
            }
        }
    }
    details::draw(panel, state, area, buffer);
    field.or(cursor)
}

/// Draws the head of the columns, or the search while it is typed. Returns the position of its cursor.
fn head(panel: &SettingsPanel, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let theme = &state.theme;
    if panel.is_typing {
        row(buffer, area, 0, theme, Role::Key, "/");
        let place = Rect { x: area.x + 1, width: area.width.checked_sub(1)?, height: 1, ..area };
        return panel.search.draw(theme, place.intersection(area), buffer);
    }
    let columns = Columns::of(usize::from(area.width), panel.choice.comparison);
    let Columns { name, value: width, unit, other, range, help } = columns;
    let mut text = format!("{:MARKS$}{:<name$}{:<width$}", "", "name", "value");
    if unit {
        text.push_str(&format!(" {:<UNIT$}", "unit"));
    }
    if other {
        text.push_str(&format!(" {:<width$}", panel.choice.comparison.name(state)));
    }
    if range {
        text.push_str(&format!(" {:<RANGE$}", "allowed"));
    }
    if help {
        text.push_str(" description");
    }
    row(buffer, area, 0, theme, Role::Dim, &text);
    None
}

/// Returns the line of a setting.
fn picture(
    panel: &SettingsPanel,
    state: &Shared,
    setting: &CraftSetting,
    columns: Columns,
    is_selected: bool,
) -> Line<'static> {
    let theme = &state.theme;
    let settings = &state.settings;
    let pointer = if is_selected { '▸' } else { ' ' };
    let mark = match (settings.is_pending(&setting.name), setting.is_changed()) {
        (true, _) => '…',
        (false, true) => '●',
        (false, false) => ' ',
    };
    let origin = match (planned(state, &setting.name), settings.given_by(&setting.name)) {
        (Some(_), _) => 'p',
        (None, Some(_)) => 'o',
        (None, None) => ' ',
    };
    let role = match (is_selected, setting.is_changed(), setting.is_carried) {
        (true, ..) => Role::Focus,
        (false, true, _) => Role::Active,
        (false, false, true) => Role::Dim,
        (false, false, false) => Role::Text,
    };
    let Columns { name, value: width, unit, other, range, help } = columns;
    let value = cut(&setting.value, width);
    let mut spans = vec![
        span(theme, role, format!("{pointer}{mark}{origin} ")),
        span(theme, role, format!("{:<name$}", cut(&setting.name, name - 1))),
        span(theme, role, format!("{value:<width$}")),
    ];
    if unit {
        spans.push(span(theme, Role::Dim, format!(" {:<UNIT$}", cut(setting.unit, UNIT))));
    }
    if other {
        let other = panel.choice.comparison.other(state, setting);
        let other = other.map_or_else(|| "—".to_owned(), |other| cut(&other, width));
        let role = if panel.choice.comparison == Comparison::All { Role::Dim } else { Role::Title };
        spans.push(span(theme, role, format!(" {other:<width$}")));
    }
    if range {
        let allowed = cut(&setting.allowed.to_string(), RANGE);
        spans.push(span(theme, Role::Dim, format!(" {allowed:<RANGE$}")));
    }
    if help {
        spans.push(span(theme, Role::Dim, format!(" {}", setting.help)));
    }
    Line::from(spans)
}

/// Returns the reason for an empty list.
fn empty(panel: &SettingsPanel, state: &Shared) -> String {
    if state.settings.craft().is_none() {
        return match state.settings.refusal() {
            Some(why) => why.to_owned(),
            None => "The settings are being read …".to_owned(),
        };
    }
    if !panel.choice.query.is_empty() && panel.choice.comparison != Comparison::All {
        return format!("No setting with {:?} differs.", panel.choice.query);
    }
    if !panel.choice.query.is_empty() {
        return format!("No setting has {:?} in its name or description.", panel.choice.query);
    }
    match panel.choice.comparison {
        Comparison::All => "This firmware reports no settings.".to_owned(),
        Comparison::Defaults => "Every setting has its default.".to_owned(),
        Comparison::Plan if state.editor.document().settings.is_empty() => {
            "The open plan sets no settings.".to_owned()
        }
        Comparison::Plan => "The craft has all settings of the open plan.".to_owned(),
        Comparison::Saved if state.view.remote.is_some() => {
            "Nothing was changed since the settings were read first.".to_owned()
        }
        Comparison::Saved => "Everything is saved in the craft's flash.".to_owned(),
    }
}
