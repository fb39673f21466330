//! The columns of a table of samples.

use crate::telemetry::quantity::{Dimension, Unit};
use crate::telemetry::signal::{Observed, SIGNALS, Signal};

/// A column.
#[derive(Debug, Clone, Copy)]
pub(super) enum Column {
    Signal(Signal),
    /// The state of the state machine.
    State,
    /// True latitude, degrees.
    Latitude,
    /// True longitude, degrees.
    Longitude,
}

/// The first columns. The other signals follow in the order of their table.
const FIRST: [Column; 6] = [
    Column::Signal(Signal::Time),
    Column::Signal(Signal::BootTime),
    Column::State,
    Column::Signal(Signal::Waypoint),
    Column::Latitude,
    Column::Longitude,
];

/// Returns all columns. Each true value is followed by the value that the flight controller estimates or reports.
pub(super) fn all() -> Vec<Column> {
    let mut columns: Vec<Column> = FIRST.to_vec();
    let mut placed: Vec<Signal> = columns.iter().filter_map(Column::signal).collect();
    for info in SIGNALS {
        for signal in [Some(info.signal), info.counterpart()].into_iter().flatten() {
            if !placed.contains(&signal) {
                placed.push(signal);
                columns.push(Column::Signal(signal));
            }
        }
    }
    columns
}

impl Column {
    fn signal(&self) -> Option<Signal> {
        match self {
            Self::Signal(signal) => Some(*signal),
            Self::State | Self::Latitude | Self::Longitude => None,
        }
    }

    /// Returns the name with the unit: `altitude (m)`.
    pub(super) fn header(&self) -> String {
        match self {
            Self::Signal(signal) => {
                let info = signal.info();
                match info.dimension.unit() {
                    Some(Unit { name, .. }) => format!("{} ({name})", info.name),
                    None => info.name.to_owned(),
                }
            }
            Self::State => "state".to_owned(),
            Self::Latitude => "lat (deg)".to_owned(),
            Self::Longitude => "lon (deg)".to_owned(),
        }
    }

    /// Returns the value at an instant in the unit of the header; empty if it is not known.
    pub(super) fn cell(&self, observed: &Observed<'_>) -> String {
        match self {
            Self::Signal(signal) => {
                let dimension = signal.info().dimension;
                let scale = dimension.unit().map_or(1.0, |unit| unit.scale);
                // Shares and motor commands run from 0 to 1.
                let decimals = if dimension == Dimension::NONE { 5 } else { 3 };
                number(signal.read(observed).map(|value| value / scale), decimals)
            }
            Self::State => observed.nav.map(|nav| nav.state.to_string()).unwrap_or_default(),
            Self::Latitude => number(observed.truth.map(|truth| truth.lat_deg), 8),
            Self::Longitude => number(observed.truth.map(|truth| truth.lon_deg), 8),
        }
    }
}

/// Returns a number with at most so many decimals; empty for an unknown one.
fn number(value: Option<f64>, decimals: i32) -> String {
    let Some(value) = value.filter(|value| value.is_finite()) else { return String::new() };
    let scale = 10_f64.powi(decimals);
    // Adding zero turns a negative zero into a plain one. A value too large to scale stays unchanged.
    let rounded = (value * scale).round() / scale + 0.0;
    if rounded.is_finite() { rounded.to_string() } else { value.to_string() }
}
