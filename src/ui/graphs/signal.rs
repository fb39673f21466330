//! The plotted signals, and their plots.

use strum::EnumCount as _;

use crate::telemetry::Snapshot;

/// A number that changes in flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumCount, strum::EnumIter)]
pub(in crate::ui) enum Signal {
    AltitudeTruth,
    AltitudeEstimate,
    AltitudeTarget,
    GroundSpeed,
    Climb,
    CrossTrack,
    RollDemand,
    Roll,
    PitchDemand,
    Pitch,
    Throttle,
    Motor1,
    Motor2,
    Motor3,
    Motor4,
    Heading,
    Distance,
    HomeDistance,
    North,
    East,
    Volts,
    Amperes,
    Wind,
}

/// The values of all signals; NaN for an unknown one.
pub(super) type Values = [f32; Signal::COUNT];

/// The stroke of a curve, which identifies it without its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum Stroke {
    Solid,
    Dashed,
    Dotted,
}

/// The physical quantity of a plot, which determines its unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum Quantity {
    Length,
    Speed,
    Angle,
    Pulse,
    Share,
    Voltage,
    Current,
}

/// Curves over one axis.
#[derive(Debug)]
pub(in crate::ui) struct Plot {
    pub(in crate::ui) name: &'static str,
    /// The quantity of the values.
    pub(in crate::ui) quantity: Quantity,
    /// The least range of the axis, in SI units, so that noise does not fill the plot.
    pub(in crate::ui) least_range: f64,
    /// The curves, with names.
    pub(in crate::ui) curves: &'static [(Signal, &'static str, Stroke)],
}

/// All plots, from top to bottom.
pub(in crate::ui) const PLOTS: [Plot; 12] = [
    Plot {
        name: "altitude",
        quantity: Quantity::Length,
        least_range: 4.0,
        curves: &[
            (Signal::AltitudeTarget, "target", Stroke::Dotted),
            (Signal::AltitudeTruth, "truth", Stroke::Dashed),
            (Signal::AltitudeEstimate, "estimate", Stroke::Solid),
        ],
    },
    Plot {
        name: "speed",
        quantity: Quantity::Speed,
        least_range: 2.0,
        curves: &[
            (Signal::Wind, "wind", Stroke::Dotted),
            (Signal::Climb, "climb", Stroke::Dashed),
            (Signal::GroundSpeed, "ground", Stroke::Solid),
        ],
    },
    Plot {
        name: "cross-track",
        quantity: Quantity::Length,
        least_range: 2.0,
        curves: &[(Signal::CrossTrack, "error", Stroke::Solid)],
    },
    Plot {
        name: "roll",
        quantity: Quantity::Angle,
        least_range: 10.0,
        curves: &[(Signal::RollDemand, "demand", Stroke::Dotted), (Signal::Roll, "response", Stroke::Solid)],
    },
    Plot {
        name: "pitch",
        quantity: Quantity::Angle,
        least_range: 10.0,
        curves: &[
            (Signal::PitchDemand, "demand", Stroke::Dotted),
            (Signal::Pitch, "response", Stroke::Solid),
        ],
    },
    Plot {
        name: "throttle",
        quantity: Quantity::Pulse,
        least_range: 50.0,
        curves: &[(Signal::Throttle, "mixer", Stroke::Solid)],
    },
    Plot {
        name: "motors",
        quantity: Quantity::Share,
        least_range: 10.0,
        curves: &[
            (Signal::Motor1, "1", Stroke::Solid),
            (Signal::Motor2, "2", Stroke::Dashed),
            (Signal::Motor3, "3", Stroke::Dotted),
            (Signal::Motor4, "4", Stroke::Solid),
        ],
    },
    Plot {
        name: "heading",
        quantity: Quantity::Angle,
        least_range: 20.0,
        curves: &[(Signal::Heading, "estimate", Stroke::Solid)],
    },
    Plot {
        name: "distance",
        quantity: Quantity::Length,
        least_range: 10.0,
        curves: &[
            (Signal::HomeDistance, "home", Stroke::Dashed),
            (Signal::Distance, "waypoint", Stroke::Solid),
        ],
    },
    Plot {
        name: "position",
        quantity: Quantity::Length,
        least_range: 10.0,
        curves: &[(Signal::East, "east", Stroke::Dashed), (Signal::North, "north", Stroke::Solid)],
    },
    Plot {
        name: "battery",
        quantity: Quantity::Voltage,
        least_range: 1.0,
        curves: &[(Signal::Volts, "voltage", Stroke::Solid)],
    },
    Plot {
        name: "current",
        quantity: Quantity::Current,
        least_range: 5.0,
        curves: &[(Signal::Amperes, "battery", Stroke::Solid)],
    },
];

/// Returns the values of a picture.
pub(super) fn values(vehicle: &Snapshot) -> Values {
    let mut values = [f32::NAN; Signal::COUNT];
    let mut set = |signal: Signal, value: Option<f64>| {
        if let Some(value) = value {
            values[signal as usize] = value as f32;
        }
    };
    let (truth, estimate, craft) = (&vehicle.truth, &vehicle.estimate, &vehicle.craft);
    let nav = vehicle.nav.as_ref().filter(|nav| nav.engaged);
    set(Signal::AltitudeTruth, truth.map(|truth| truth.alt));
    set(Signal::AltitudeEstimate, estimate.alt);
    set(Signal::AltitudeTarget, nav.and_then(|nav| nav.target_alt_m));
    set(Signal::GroundSpeed, estimate.ground_speed_mps);
    set(Signal::Climb, estimate.climb_mps);
    set(Signal::CrossTrack, nav.and_then(|nav| nav.xte_m));
    set(Signal::RollDemand, estimate.roll_demand_deg);
    set(Signal::Roll, estimate.roll_deg);
    set(Signal::PitchDemand, estimate.pitch_demand_deg);
    set(Signal::Pitch, estimate.pitch_deg);
    set(Signal::Throttle, craft.throttle_us);
    for (at, signal) in
        [Signal::Motor1, Signal::Motor2, Signal::Motor3, Signal::Motor4].into_iter().enumerate()
    {
        set(signal, craft.motors.map(|motors| motors[at] * 100.0));
    }
    set(Signal::Heading, estimate.heading_deg);
    set(Signal::Distance, nav.and_then(|nav| nav.distance_m));
    set(Signal::HomeDistance, vehicle.nav.as_ref().and_then(|nav| nav.home_distance_m));
    set(Signal::North, truth.map(|truth| truth.n).or(estimate.n));
    set(Signal::East, truth.map(|truth| truth.e).or(estimate.e));
    set(Signal::Volts, craft.battery_v);
    set(Signal::Amperes, craft.battery_a);
    set(Signal::Wind, truth.and_then(|truth| truth.wind_ne).map(|wind| wind.norm()));
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use strum::IntoEnumIterator as _;

    #[test]
    fn every_signal_is_in_one_plot() {
        for signal in Signal::iter() {
            let plots = PLOTS.iter().flat_map(|plot| plot.curves).filter(|curve| curve.0 == signal);
            assert_eq!(plots.count(), 1, "{signal:?}");
        }
    }
}
