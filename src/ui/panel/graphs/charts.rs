//! The charts of the shown graphs: plots of signals, differences of two flights, series and signals by name.

use crate::replay::Picture;
use crate::telemetry::quantity::Dimension;
use crate::telemetry::signal::Signal;
use crate::ui::acts::named_signal::{Named, scale};
use crate::ui::curve::{Point, Stroke};
use crate::ui::formatting::cut;
use crate::ui::model::graphs::{Graph, Plot};
use crate::ui::model::other_flight::OtherFlight;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use super::chart::{Chart, Strand};

/// The greatest width of a flight's name.
const NAME: usize = 12;

/// Returns the chart of a graph for a time, s; `None` if the flight does not have it.
pub(super) fn chart(state: &Shared, graph: Graph<'_>, window: (f64, f64)) -> Option<Chart> {
    match graph {
        Graph::Plot(plot) => Some(of_plot(state, plot, window)),
        Graph::Difference(plot) => of_difference(state, plot, window),
        Graph::Named(name) => of_name(state, name, window),
    }
}

/// Returns the factor and the unit for the values of a plot, and the number of decimals.
fn unit(state: &Shared, dimension: Dimension) -> (f64, &'static str, usize) {
    let units = state.units;
    match dimension {
        Dimension::LENGTH => (units.length(1.0), units.length_unit(), 1),
        Dimension::SPEED => (units.speed(1.0), units.speed_unit(), 1),
        Dimension::ANGLE => (1.0, "°", 1),
        Dimension::PULSE => (1.0, "µs", 0),
        Dimension::VOLTAGE => (1.0, "V", 2),
        Dimension::CURRENT => (1.0, "A", 1),
        _ => (100.0, "%", 0),
    }
}

/// Returns the role of the curve at this index of its plot; the last one is the most important.
fn role(plot: &Plot, at: usize) -> Role {
    match plot.curves.len() - 1 - at {
        0 => Role::Track,
        1 => Role::Target,
        2 => Role::Key,
        _ => Role::Warn,
    }
}

/// Returns the most important signal of a plot.
fn main_signal(plot: &Plot) -> Option<Signal> {
    plot.curves.last().map(|(signal, ..)| *signal)
}

fn of_plot(state: &Shared, plot: &Plot, (from, to): (f64, f64)) -> Chart {
    let (factor, unit, decimals) = unit(state, plot.dimension());
    let now = state.graphs.sample_now(&state.view);
    let samples: Vec<&Picture> = state.graphs.samples(from, to).collect();
    let value_in = |sample: &Picture, signal| sample.value(signal).map(|value| value * factor);
    let known = plot.curves.iter().enumerate().filter(|(_, (signal, ..))| state.graphs.has(*signal));
    let own = known.map(|(at, (signal, name, stroke))| Strand {
        name: (*name).to_owned(),
        role: role(plot, at),
        stroke: *stroke,
        points: samples.iter().map(|sample| point(sample.time_s(), value_in(sample, *signal))).collect(),
        now: now.as_ref().and_then(|sample| value_in(sample, *signal)),
    });
    // The other flight is drawn first, below the shown one.
    let other = state.other_flight().zip(main_signal(plot)).map(|((other, offset_s), signal)| Strand {
        name: cut(&other.name, NAME),
        role: Role::Predicted,
        stroke: Stroke::Dashed,
        points: other
            .pictures(from - offset_s, to - offset_s)
            .iter()
            .map(|picture| point(picture.time_s() + offset_s, value_in(picture, signal)))
            .collect(),
        now: now
            .and_then(|now| other.picture_at(now.time_s() - offset_s))
            .and_then(|picture| value_in(picture, signal)),
    });
    Chart {
        title: format!("{} {unit}", plot.name),
        least_range: plot.least_range * factor,
        decimals: Some(decimals),
        strands: other.into_iter().chain(own).collect(),
    }
}

fn point(time_s: f64, value: Option<f64>) -> Point {
    (time_s, value.map(|value| (value, value)))
}

fn of_difference(state: &Shared, plot: &Plot, (from, to): (f64, f64)) -> Option<Chart> {
    let (other, offset_s) = state.other_flight()?;
    let signal = main_signal(plot)?;
    let (factor, unit, decimals) = unit(state, plot.dimension());
    let between = |own: &Picture| {
        let difference = difference(own, other, offset_s, signal)?;
        let is_direction = signal == Signal::EstHeading;
        Some(if is_direction { shortest_turn(difference) } else { difference } * factor)
    };
    let now = state.graphs.sample_now(&state.view);
    let points = state.graphs.samples(from, to).map(|own| point(own.time_s(), between(own))).collect();
    Some(Chart {
        title: format!("Δ {} {unit}", plot.name),
        least_range: plot.least_range * factor / 2.0,
        decimals: Some(decimals),
        strands: vec![Strand {
            name: format!("shown − {}", cut(&other.name, NAME)),
            role: Role::Warn,
            stroke: Stroke::Solid,
            points,
            now: now.as_ref().and_then(between),
        }],
    })
}

/// Returns the value of a signal minus that of the other flight at the same time.
fn difference(own: &Picture, other: &OtherFlight, offset_s: f64, signal: Signal) -> Option<f64> {
    let other = other.picture_at(own.time_s() - offset_s)?;
    Some(own.value(signal)? - other.value(signal)?)
}

/// Returns an angle from −180 to 180 degrees.
fn shortest_turn(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

fn of_name(state: &Shared, name: &str, (from, to): (f64, f64)) -> Option<Chart> {
    let named = Named::find(state, name)?;
    let points = match named {
        Named::Recorded(index, _) => {
            let curve = state.graphs.curve(index);
            curve.map(|curve| curve.between(from, to).collect()).unwrap_or_default()
        }
        Named::Signal(info) => {
            let value = |sample: &Picture| sample.value(info.signal).map(|value| value / scale(info));
            state.graphs.samples(from, to).map(|sample| point(sample.time_s(), value(sample))).collect()
        }
    };
    Some(Chart {
        title: format!("{name} {}", named.unit()),
        least_range: 1e-3,
        decimals: None,
        strands: vec![Strand {
            name: "now".to_owned(),
            role: Role::Track,
            stroke: Stroke::Solid,
            points,
            now: named.value(state),
        }],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_differ_by_the_shorter_turn() {
        assert!((shortest_turn(350.0) + 10.0).abs() < 1e-9);
        assert!((shortest_turn(-350.0) - 10.0).abs() < 1e-9);
        assert!((shortest_turn(90.0) - 90.0).abs() < 1e-9);
    }
}
