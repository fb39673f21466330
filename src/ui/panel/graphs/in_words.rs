//! The graphs without a screen: the value of each curve at the cursor, and its least and greatest value in the shown time.

use super::chart::Chart;
use super::charts;
use crate::ui::panel::in_words::number;
use crate::ui::shared::Shared;

/// Returns the shown graphs as lines of text.
pub(super) fn lines(state: &Shared) -> Vec<String> {
    let window = state.graphs.window(state.graphs.cursor_s(&state.view));
    let graphs = state.graphs.graphs(state.other_flight().is_some());
    let charts: Vec<Chart> = graphs.filter_map(|graph| charts::chart(state, graph, window)).collect();
    if charts.is_empty() {
        return vec!["No graph is chosen.".to_owned()];
    }
    charts.iter().flat_map(of_chart).collect()
}

fn of_chart(chart: &Chart) -> impl Iterator<Item = String> {
    let decimals = chart.decimals.unwrap_or(2);
    let number = move |value: Option<f64>| number(value, decimals);
    // The most important curve is the last.
    chart.strands.iter().rev().map(move |strand| {
        let known = strand.points.iter().filter_map(|(_, range)| *range);
        let least = known.clone().map(|(least, _)| least).reduce(f64::min);
        let greatest = known.map(|(_, greatest)| greatest).reduce(f64::max);
        if least.is_none() {
            return format!("{}, {}: not known.", chart.title.trim(), strand.name);
        }
        let now = strand.now.map_or_else(|| "none now".to_owned(), |value| number(Some(value)));
        format!(
            "{}, {}: {now}, from {} to {}.",
            chart.title.trim(),
            strand.name,
            number(least),
            number(greatest)
        )
    })
}
