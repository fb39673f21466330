//! The choice of graphs, which comes back with the next start.

use serde::{Deserialize, Serialize};

use super::{FIRST_SPAN, GraphsState, PLOTS, SPANS_S};

/// The most names of signals that are taken from a file.
const MAX_NAMES: usize = 64;

/// The shown graphs and the time span.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(in crate::ui) struct ChosenGraphs {
    /// The names of the shown plots.
    plots: Vec<String>,
    /// The names of the signals that are shown as graphs of their own.
    signals: Vec<String>,
    /// The shown time span, s.
    span_s: f64,
}

impl Default for ChosenGraphs {
    fn default() -> Self {
        GraphsState::default().chosen()
    }
}

impl GraphsState {
    /// Returns the choice of graphs.
    pub(in crate::ui) fn chosen(&self) -> ChosenGraphs {
        let shown = PLOTS.iter().zip(&self.shown).filter(|(_, shown)| **shown);
        ChosenGraphs {
            plots: shown.map(|(plot, _)| plot.name.to_owned()).collect(),
            signals: self.series.clone(),
            span_s: self.span_s(),
        }
    }

    /// Shows these graphs. Unknown names are left out.
    pub(in crate::ui) fn choose(&mut self, chosen: &ChosenGraphs) {
        self.shown = std::array::from_fn(|plot| chosen.plots.iter().any(|name| *name == PLOTS[plot].name));
        self.series = chosen.signals.iter().take(MAX_NAMES).cloned().collect();
        let same = |span: &f64| (span - chosen.span_s).abs() < 1e-9;
        // The shortest ones are only for recorded flights, whose series may not be read yet.
        self.span = SPANS_S.iter().position(same).unwrap_or(FIRST_SPAN);
        self.is_restored = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chosen_graphs_come_back() {
        let mut graphs = GraphsState::default();
        graphs.toggle(0);
        graphs.toggle(7);
        graphs.toggle_series("force");
        graphs.change_span(2);
        let mut again = GraphsState::default();
        again.choose(&graphs.chosen());
        assert_eq!(again.chosen(), graphs.chosen());
        assert!(!again.is_shown(0) && again.is_shown(7) && again.shows_series("force"));
    }

    #[test]
    fn chosen_graphs_stay_when_the_recorded_flight_is_read() {
        let series = vec![crate::replay::Series::new("debug[0]", "")];
        let overview = crate::replay::Overview { series, ..crate::replay::Overview::default() };
        let mut graphs = GraphsState::default();
        graphs.load(&overview);
        graphs.toggle(2);
        graphs.change_span(-5);
        let mut again = GraphsState::default();
        again.choose(&graphs.chosen());
        again.load(&overview);
        assert_eq!(again.chosen(), graphs.chosen());
    }
}
