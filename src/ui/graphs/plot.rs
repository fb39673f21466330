//! The plots of the Graphs panel and their curves.

use crate::telemetry::quantity::Dimension;
use crate::telemetry::signal::Signal;

/// The stroke of a curve, which identifies it without its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum Stroke {
    Solid,
    Dashed,
    Dotted,
}

/// Curves over one axis.
#[derive(Debug)]
pub(in crate::ui) struct Plot {
    pub(in crate::ui) name: &'static str,
    /// The least range of the axis, in SI units or degrees, so that noise does not fill the plot.
    pub(in crate::ui) least_range: f64,
    /// The curves, with names.
    pub(in crate::ui) curves: &'static [(Signal, &'static str, Stroke)],
}

/// All plots, from top to bottom.
pub(in crate::ui) const PLOTS: [Plot; 12] = [
    Plot {
        name: "altitude",
        least_range: 4.0,
        curves: &[
            (Signal::TargetAltitude, "target", Stroke::Dotted),
            (Signal::Altitude, "truth", Stroke::Dashed),
            (Signal::EstAltitude, "estimate", Stroke::Solid),
        ],
    },
    Plot {
        name: "speed",
        least_range: 2.0,
        curves: &[
            (Signal::Wind, "wind", Stroke::Dotted),
            (Signal::EstClimb, "climb", Stroke::Dashed),
            (Signal::EstSpeed, "ground", Stroke::Solid),
        ],
    },
    Plot { name: "cross-track", least_range: 2.0, curves: &[(Signal::CrossTrack, "error", Stroke::Solid)] },
    Plot {
        name: "roll",
        least_range: 10.0,
        curves: &[
            (Signal::RollSetpoint, "demand", Stroke::Dotted),
            (Signal::EstRoll, "response", Stroke::Solid),
        ],
    },
    Plot {
        name: "pitch",
        least_range: 10.0,
        curves: &[
            (Signal::PitchSetpoint, "demand", Stroke::Dotted),
            (Signal::EstPitch, "response", Stroke::Solid),
        ],
    },
    Plot { name: "throttle", least_range: 50.0, curves: &[(Signal::Throttle, "mixer", Stroke::Solid)] },
    Plot {
        name: "motors",
        least_range: 0.1,
        curves: &[
            (Signal::Motor1, "1", Stroke::Solid),
            (Signal::Motor2, "2", Stroke::Dashed),
            (Signal::Motor3, "3", Stroke::Dotted),
            (Signal::Motor4, "4", Stroke::Solid),
        ],
    },
    Plot { name: "heading", least_range: 20.0, curves: &[(Signal::EstHeading, "estimate", Stroke::Solid)] },
    Plot {
        name: "distance",
        least_range: 10.0,
        curves: &[
            (Signal::HomeDistance, "home", Stroke::Dashed),
            (Signal::WpDistance, "waypoint", Stroke::Solid),
        ],
    },
    Plot {
        name: "position",
        least_range: 10.0,
        curves: &[(Signal::East, "east", Stroke::Dashed), (Signal::North, "north", Stroke::Solid)],
    },
    Plot {
        name: "battery",
        least_range: 1.0,
        curves: &[(Signal::ReportedBattery, "voltage", Stroke::Solid)],
    },
    Plot {
        name: "current",
        least_range: 5.0,
        curves: &[(Signal::ReportedCurrent, "battery", Stroke::Solid)],
    },
];

impl Plot {
    /// Returns the dimension of the values.
    pub(in crate::ui) fn dimension(&self) -> Dimension {
        self.curves.first().map_or(Dimension::NONE, |(signal, ..)| signal.info().dimension)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curves_of_a_plot_share_a_dimension_and_no_signal_is_drawn_twice() {
        let mut drawn = Vec::new();
        for plot in &PLOTS {
            for (signal, name, _) in plot.curves {
                assert_eq!(signal.info().dimension, plot.dimension(), "{} {name}", plot.name);
                assert!(!drawn.contains(signal), "{signal:?}");
                drawn.push(*signal);
            }
        }
        assert_eq!(drawn.len(), 23);
    }
}
