//! The plots of the Graphs panel and their curves.

use crate::telemetry::quantity::Dimension;
use crate::telemetry::signal::Signal;
use crate::ui::curve::Stroke;

/// Curves over one axis.
#[derive(Debug)]
pub(in crate::ui) struct Plot {
    pub(in crate::ui) name: &'static str,
    /// The least range of the axis, in SI units or degrees, so that noise does not fill the plot.
    pub(in crate::ui) least_range: f64,
    /// The curves, with names.
    pub(in crate::ui) curves: &'static [(Signal, &'static str, Stroke)],
}

/// Makes the list of plots, a row each: name, least range, and the signal, name and stroke of each curve.
macro_rules! plots {
    ($(#[$meta:meta])* $list:ident: $($name:literal $range:literal [$($signal:ident $curve:literal $stroke:ident),+];)*) => {
        $(#[$meta])*
        pub(in crate::ui) const $list: &[Plot] = &[$(Plot {
            name: $name,
            least_range: $range,
            curves: &[$((Signal::$signal, $curve, Stroke::$stroke)),+],
        }),*];
    };
}

plots! {
    /// All plots, from top to bottom.
    PLOTS:
    "altitude" 4.0 [TargetAltitude "target" Dotted, Altitude "truth" Dashed, EstAltitude "estimate" Solid];
    "speed" 2.0 [Wind "wind" Dotted, EstClimb "climb" Dashed, EstSpeed "ground" Solid];
    "cross-track" 2.0 [CrossTrack "error" Solid];
    "roll" 10.0 [RollSetpoint "demand" Dotted, EstRoll "response" Solid];
    "pitch" 10.0 [PitchSetpoint "demand" Dotted, EstPitch "response" Solid];
    "throttle" 50.0 [Throttle "mixer" Solid];
    "motors" 0.1 [Motor1 "1" Solid, Motor2 "2" Dashed, Motor3 "3" Dotted, Motor4 "4" Solid];
    "heading" 20.0 [EstHeading "estimate" Solid];
    "distance" 10.0 [HomeDistance "home" Dashed, WpDistance "waypoint" Solid];
    "position" 10.0 [East "east" Dashed, North "north" Solid];
    "battery" 1.0 [ReportedBattery "voltage" Solid];
    "current" 5.0 [ReportedCurrent "battery" Solid];
}

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
        for plot in PLOTS {
            for (signal, name, _) in plot.curves {
                assert_eq!(signal.info().dimension, plot.dimension(), "{} {name}", plot.name);
                assert!(!drawn.contains(signal), "{signal:?}");
                drawn.push(*signal);
            }
        }
        assert_eq!(drawn.len(), 23);
    }
}
