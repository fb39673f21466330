//! The numbers of the flown estimate in a line, for the foot of the Plan panel.

use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr as _;

use crate::session::{Forecast, ForecastEnd, ForecastResult};
use crate::ui::app_state::AppState;
use crate::ui::formatting::cut;
use crate::ui::panel::span;
use crate::ui::theme::Role;

/// `612 m   flown estimate 03:41   battery 38 %   worst xte 0.9 m   fence 58 m`, as much of it as `width` columns take;
/// first of all why the plan would not be flown to its end.
pub(in crate::ui) fn line(state: &AppState, width: u16) -> Line<'static> {
    let theme = &state.theme;
    let width = usize::from(width);
    let forecast = &state.forecast;
    if state.plan().waypoints.is_empty() {
        return Line::default();
    }
    if let Some(reason) = forecast.estimate_refusal() {
        return Line::from(span(theme, Role::Warn, cut(&format!("No flown estimate: {reason}"), width)));
    }
    let Some(estimate) = forecast.estimate() else {
        return Line::from(span(theme, Role::Dim, cut("flown estimate …", width)));
    };
    let (mark, role) = match estimate.end {
        ForecastEnd::Flight(ForecastResult::Complete) => ("", Role::Text),
        ForecastEnd::Endless | ForecastEnd::TooLong => ("▲ ", Role::Warn),
        ForecastEnd::Flight(_) | ForecastEnd::Grounded => ("✗ ", Role::Fault),
    };
    let role = if forecast.is_estimating() { Role::Dim } else { role };
    if !mark.is_empty() {
        return Line::from(span(theme, role, cut(&format!("{mark}flown: {}", estimate.line()), width)));
    }
    let mut spans: Vec<Span<'static>> = Vec::new();
    let mut used = 0;
    let waiting = if forecast.is_estimating() { "…" } else { "" };
    for (long, short) in numbers(estimate, waiting) {
        let gap = if spans.is_empty() { "" } else { "   " };
        let text = [long, short].into_iter().find(|text| used + gap.len() + text.width() <= width);
        let Some(text) = text else { break };
        used += gap.len() + text.width();
        spans.push(span(theme, role, format!("{gap}{text}")));
    }
    Line::from(spans)
}

/// The numbers, each in a long and a short form, the most important ones first.
fn numbers(estimate: &Forecast, waiting: &str) -> Vec<(String, String)> {
    let along_m = estimate.path.last().map_or(0.0, |end| end.along_m);
    let seconds = estimate.time_s.round() as u32;
    let time = format!("{:02}:{:02}{waiting}", seconds / 60, seconds % 60);
    let used_pct = estimate.battery_used_pct;
    let metres = |name: &str, value: Option<f64>, decimals: usize| match value {
        Some(value) => format!("{name} {value:.decimals$} m"),
        None => format!("{name} —"),
    };
    let xte_m = estimate.worst_xte.map(|worst| worst.xte_m);
    let (xte, short_xte) = (metres("worst xte", xte_m, 1), metres("xte", xte_m, 1));
    let fence = metres("fence", estimate.fence_margin_m, 0);
    vec![
        (format!("{along_m:.0} m"), format!("{along_m:.0} m")),
        (format!("flown estimate {time}"), time),
        (format!("battery {used_pct:.0} %"), format!("{used_pct:.0} %")),
        (xte, short_xte),
        (fence.clone(), fence),
    ]
}
