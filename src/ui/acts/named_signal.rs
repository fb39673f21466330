//! The series and signals that can be shown as a graph of their own, by name.

use std::borrow::Cow;

use crate::replay::Series;
use crate::telemetry::signal::{SIGNALS, Signal, SignalInfo};
use crate::ui::shared::Shared;

/// A curve with a name.
#[derive(Debug, Clone, Copy)]
pub(in crate::ui) enum Named<'a> {
    /// A recorded series, with its index in the flight.
    Recorded(usize, &'a Series),
    /// A signal of the table.
    Signal(&'static SignalInfo),
}

impl<'a> Named<'a> {
    /// Returns all of a flight: its recorded series, then the other signals that it may have.
    pub(in crate::ui) fn all(state: &'a Shared) -> Vec<Self> {
        let recorded = state.series();
        let is_new = |info: &&SignalInfo| {
            state.graphs.has(info.signal) && recorded.iter().all(|series| series.name != info.name)
        };
        let signals = SIGNALS.iter().filter(is_new).map(Self::Signal);
        recorded
            .iter()
            .enumerate()
            .map(|(index, series)| Self::Recorded(index, series))
            .chain(signals)
            .collect()
    }

    /// Returns the one with this name, if the flight has it.
    pub(in crate::ui) fn find(state: &'a Shared, name: &str) -> Option<Self> {
        let recorded = state.series().iter().enumerate().find(|(_, series)| series.name == name);
        recorded.map(|(index, series)| Self::Recorded(index, series)).or_else(|| {
            let signal = Signal::find(name).filter(|signal| state.graphs.has(*signal))?;
            Some(Self::Signal(signal.info()))
        })
    }

    pub(in crate::ui) fn name(self) -> &'a str {
        match self {
            Self::Recorded(_, series) => &series.name,
            Self::Signal(info) => info.name,
        }
    }

    /// Returns the unit of the values; empty for counts and shares. A question mark follows it if the values rest on something
    /// that the record lacks.
    pub(in crate::ui) fn unit(self) -> Cow<'a, str> {
        match self {
            Self::Recorded(_, series) if series.is_assumed => Cow::Owned(format!("{}?", series.unit)),
            Self::Recorded(_, series) => Cow::Borrowed(series.unit),
            Self::Signal(info) => Cow::Borrowed(info.dimension.unit().map_or("", |unit| unit.name)),
        }
    }

    /// Returns the meaning, if the table of signals has the name.
    pub(in crate::ui) fn help(self, state: &Shared) -> Option<Cow<'static, str>> {
        let help = Signal::find(self.name())?.info().help;
        // A log has the values that the craft measured.
        let is_measured = matches!(self, Self::Recorded(..)) && state.view.vehicle.truth.is_none();
        Some(if is_measured { help.replacen("true ", "measured ", 1).into() } else { help.into() })
    }

    /// Returns the value at the cursor, in the unit, if it is known.
    pub(in crate::ui) fn value(self, state: &Shared) -> Option<f64> {
        match self {
            Self::Recorded(index, _) => state.series_value(index),
            Self::Signal(info) => {
                let sample = state.graphs.sample_now(&state.view)?;
                Some(sample.value(info.signal)? / scale(info))
            }
        }
    }
}

/// Returns the size of the unit in SI units.
pub(in crate::ui) fn scale(info: &SignalInfo) -> f64 {
    info.dimension.unit().map_or(1.0, |unit| unit.scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    use crate::replay::Overview;
    use crate::session::{ReplayView, SessionView};
    use crate::telemetry::snapshot::TruthView;

    #[test]
    fn a_question_mark_follows_the_unit_of_values_that_rest_on_an_assumption() {
        let known = Series::new("gyroADC[0]", "°/s");
        let assumed = Series { is_assumed: true, ..known.clone() };
        let unit = |series| Named::Recorded(0, series).unit().into_owned();
        assert_eq!((unit(&known), unit(&assumed)), ("°/s".to_owned(), "°/s?".to_owned()));
    }

    #[test]
    fn what_a_log_has_measured_is_not_called_true() {
        let series = vec![Series::new("roll", "°")];
        let overview = Arc::new(Overview { series, ..Overview::default() });
        let replay = Some(Arc::new(ReplayView { overview, ..ReplayView::default() }));
        let mut state = Shared::bare((120, 40), SessionView { replay, ..SessionView::default() });
        let help = |state: &Shared| {
            Named::find(state, "roll").and_then(|named| named.help(state).map(Cow::into_owned))
        };
        assert_eq!(help(&state).as_deref(), Some("measured roll, right positive"));
        Arc::make_mut(&mut state.view.vehicle).truth = Some(TruthView::default());
        assert_eq!(help(&state).as_deref(), Some("true roll, right positive"));
    }
}
