//! The numbers of the flown estimate in a line, for the foot of the Plan panel.

use ratatui::text::Line;
use unicode_width::UnicodeWidthStr as _;

use super::settings_in_force;
use crate::flight::forecast::{FlightResult, Forecast, ForecastEnd};
use crate::plan::estimate::SettingSource;
use crate::ui::area::span;
use crate::ui::formatting::cut;
use crate::ui::shared::Shared;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::{Role, Theme};
use crate::ui::units::Units;

/// `612 m   flown estimate 03:41   battery 38 %   worst xte 0.9 m   fence 58 m`, as much of it as `width` columns take;
/// or, in two lines at most, the reason why the plan would not be flown to its end.
pub(in crate::ui) fn lines(state: &Shared, width: u16) -> Vec<Line<'static>> {
    let theme = &state.theme;
    let width = usize::from(width);
    let forecast = &state.forecast;
    if state.plan().waypoints.is_empty() {
        return Vec::new();
    }
    if let Some(reason) = forecast.estimate_refusal() {
        return said(theme, Role::Warn, &format!("No flown estimate: {reason}"), width);
    }
    let Some(estimate) = forecast.estimate() else {
        return said(theme, Role::Dim, "flown estimate …", width);
    };
    let (mark, role) = match estimate.end {
        ForecastEnd::Flight(FlightResult::Complete) => ("", Role::Text),
        ForecastEnd::Endless | ForecastEnd::TooLong => ("▲ ", Role::Warn),
        ForecastEnd::Flight(_) | ForecastEnd::Grounded => ("✗ ", Role::Fault),
    };
    let role = if forecast.is_estimating() { Role::Dim } else { role };
    if !mark.is_empty() {
        let end = estimate.line(|metres| state.units.length_text(metres, 0));
        return said(theme, role, &format!("{mark}flown: {end}"), width);
    }
    let document = state.editor.document();
    // A fence that only the craft has is not confused with another.
    let fence_from = match settings_in_force::assumptions(state, document).fence_from {
        SettingSource::Craft if !settings_in_force::sets_a_fence(document) => SettingSource::Unsaid,
        from => from,
    };
    let waiting = if forecast.is_estimating() { "…" } else { "" };
    let numbers = numbers(estimate, state.units, fence_from, waiting);
    let long = numbers.each_ref().map(|(long, _)| long.as_str()).join("   ");
    let short = numbers.each_ref().map(|(_, short)| short.as_str()).join("  ");
    let shortest = short.replace(" left", "");
    let forms = [long, short, shortest];
    let text = forms.iter().find(|form| form.width() <= width).unwrap_or(&forms[2]);
    vec![Line::from(span(theme, role, cut(text, width)))]
}

/// A sentence in at most two lines.
fn said(theme: &Theme, role: Role, text: &str, width: usize) -> Vec<Line<'static>> {
    let mut lines = wrapped(text, width);
    if lines.len() > 2 {
        let rest = lines.split_off(1).join(" ");
        lines.push(cut(&rest, width));
    }
    lines.into_iter().map(|line| Line::from(span(theme, role, line))).collect()
}

/// The numbers, each in a long and a short form, the most important ones first; `waiting` marks those of an older plan.
fn numbers(
    estimate: &Forecast,
    units: Units,
    fence_from: SettingSource,
    waiting: &str,
) -> [(String, String); 5] {
    let along_m = estimate.path.last().map_or(0.0, |end| end.along_m);
    let seconds = estimate.time_s.round() as u32;
    let time = format!("{:02}:{:02}{waiting}", seconds / 60, seconds % 60);
    let used_pct = estimate.battery_used_pct;
    let metres = |value: Option<f64>, decimals: usize| match value {
        Some(value) => units.length_text(value, decimals),
        None => "—".to_owned(),
    };
    let xte = metres(estimate.worst_xte.map(|worst| worst.xte_m), 1);
    let left = if estimate.fence_margin_m.is_some() { " left" } else { "" };
    let fence = format!("fence {}{left}", metres(estimate.fence_margin_m, 0));
    let whose = |craft, plan| match fence_from {
        _ if estimate.fence_margin_m.is_none() => "",
        SettingSource::Unsaid => "",
        SettingSource::Craft => craft,
        SettingSource::Plan => plan,
    };
    let (long, short) = (whose(" (craft)", " (plan, set at the upload)"), whose(" (craft)", " (plan)"));
    let length = metres(Some(along_m), 0);
    let fence = (format!("{fence}{long}"), format!("{fence}{short}"));
    let xte = (format!("worst xte {xte}"), format!("xte {xte}"));
    // A narrow line cuts off the last number.
    let [next, last] = if fence_from == SettingSource::Unsaid { [xte, fence] } else { [fence, xte] };
    [
        (length.clone(), length),
        (format!("flown estimate {time}"), format!("flown {time}")),
        (format!("battery {used_pct:.0} %"), format!("bat {used_pct:.0} %")),
        next,
        last,
    ]
}
