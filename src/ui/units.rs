//! Metric or imperial: what is shown, never what is stored or sent.

use crate::telemetry::GuardUnit;

/// Feet in a metre.
const FEET: f64 = 1.0 / 0.3048;
/// Miles an hour in a metre a second.
const MILES_AN_HOUR: f64 = 3600.0 / 1609.344;

/// The units of lengths and speeds on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Units {
    /// Metres, metres a second.
    #[default]
    Metric,
    /// Feet, miles an hour.
    Imperial,
}

impl Units {
    /// A length in metres as it is shown.
    pub fn length(self, metres: f64) -> f64 {
        match self {
            Self::Metric => metres,
            Self::Imperial => metres * FEET,
        }
    }

    /// A speed in metres a second as it is shown.
    pub fn speed(self, metres_a_second: f64) -> f64 {
        match self {
            Self::Metric => metres_a_second,
            Self::Imperial => metres_a_second * MILES_AN_HOUR,
        }
    }

    /// A length as it is shown or typed, in metres.
    pub fn metres(self, shown: f64) -> f64 {
        shown / self.length(1.0)
    }

    /// A speed as it is shown or typed, in metres a second.
    pub fn metres_per_second(self, shown: f64) -> f64 {
        shown / self.speed(1.0)
    }

    /// A length with its unit and this many digits behind the point.
    pub fn length_text(self, metres: f64, digits: usize) -> String {
        format!("{:.digits$} {}", self.length(metres), self.length_unit())
    }

    /// A speed with its unit and this many digits behind the point.
    pub fn speed_text(self, metres_a_second: f64, digits: usize) -> String {
        format!("{:.digits$} {}", self.speed(metres_a_second), self.speed_unit())
    }

    /// A length moved by whole steps of what is shown: metres or feet.
    pub(super) fn step_length(self, metres: f64, steps: i32) -> f64 {
        match self {
            Self::Metric => metres + f64::from(steps),
            // What is stored is whole centimetres: without rounding, steps of a foot would drift.
            Self::Imperial => self.metres(tenths(self.length(metres)) + f64::from(steps)),
        }
    }

    /// A speed moved by steps of half a metre a second, or of a mile an hour.
    pub(super) fn step_speed(self, metres_a_second: f64, steps: i32) -> f64 {
        match self {
            Self::Metric => metres_a_second + 0.5 * f64::from(steps),
            Self::Imperial => self.metres_per_second(tenths(self.speed(metres_a_second)) + f64::from(steps)),
        }
    }

    /// What a guard's values are multiplied by, and the unit they are then in.
    pub fn of_guard(self, unit: GuardUnit) -> (f64, &'static str) {
        match unit {
            GuardUnit::Metres => (self.length(1.0), self.length_unit()),
            GuardUnit::MetresPerSecond => (self.speed(1.0), self.speed_unit()),
            GuardUnit::None | GuardUnit::Waypoints | GuardUnit::Seconds | GuardUnit::Microseconds => {
                (1.0, unit.into())
            }
        }
    }

    /// Name of the unit of lengths in sentences.
    pub(super) fn length_name(self) -> &'static str {
        match self {
            Self::Metric => "metres",
            Self::Imperial => "feet",
        }
    }

    /// Name of the unit of lengths.
    pub fn length_unit(self) -> &'static str {
        match self {
            Self::Metric => "m",
            Self::Imperial => "ft",
        }
    }

    /// Name of the unit of speeds.
    pub fn speed_unit(self) -> &'static str {
        match self {
            Self::Metric => "m/s",
            Self::Imperial => "mph",
        }
    }
}

fn tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imperial_values_are_those_of_the_definitions() {
        assert!((Units::Imperial.length(0.3048) - 1.0).abs() < 1e-12);
        assert!((Units::Imperial.speed(0.44704) - 1.0).abs() < 1e-12);
        assert_eq!(Units::Imperial.length_text(30.48, 0), "100 ft");
        assert!((Units::Imperial.metres_per_second(Units::Imperial.speed(3.7)) - 3.7).abs() < 1e-12);
        assert_eq!((Units::Metric.length(3.5), Units::Metric.speed(3.5)), (3.5, 3.5));
    }
}
