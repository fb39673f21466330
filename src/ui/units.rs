//! Metric or imperial units for display. Stored and sent values are always metric.

use crate::telemetry::GuardUnit;

use super::formatting::without_negative_zero;

/// Feet per metre.
const FEET: f64 = 1.0 / 0.3048;
/// Miles per hour in a metre per second.
const MILES_AN_HOUR: f64 = 3600.0 / 1609.344;
/// The metric units that are converted, the longer one first.
const METRIC: [&str; 2] = [" m/s", " m"];

/// The units of lengths and speeds on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Units {
    /// Metres, metres per second.
    #[default]
    Metric,
    /// Feet, miles per hour.
    Imperial,
}

impl Units {
    /// Converts a length from metres to the shown unit.
    pub fn length(self, metres: f64) -> f64 {
        match self {
            Self::Metric => metres,
            Self::Imperial => metres * FEET,
        }
    }

    /// Converts a speed from metres per second to the shown unit.
    pub fn speed(self, metres_a_second: f64) -> f64 {
        match self {
            Self::Metric => metres_a_second,
            Self::Imperial => metres_a_second * MILES_AN_HOUR,
        }
    }

    /// Converts a shown or typed length to metres.
    pub fn metres(self, shown: f64) -> f64 {
        shown / self.length(1.0)
    }

    /// Converts a shown or typed speed to metres per second.
    pub fn metres_per_second(self, shown: f64) -> f64 {
        shown / self.speed(1.0)
    }

    /// Formats a length with its unit and this many decimals.
    pub fn length_text(self, metres: f64, digits: usize) -> String {
        format!("{:.digits$} {}", without_negative_zero(self.length(metres), digits), self.length_unit())
    }

    /// Formats a speed with its unit and this many decimals.
    pub fn speed_text(self, metres_a_second: f64, digits: usize) -> String {
        format!(
            "{:.digits$} {}",
            without_negative_zero(self.speed(metres_a_second), digits),
            self.speed_unit()
        )
    }

    /// Returns a length changed by whole steps of the shown unit: metres or feet.
    pub(super) fn step_length(self, metres: f64, steps: i32) -> f64 {
        match self {
            Self::Metric => metres + f64::from(steps),
            // Stored values are whole centimetres: without rounding, steps of a foot would drift.
            Self::Imperial => self.metres(tenths(self.length(metres)) + f64::from(steps)),
        }
    }

    /// Returns a speed changed by steps of 0.5 m/s or 1 mph.
    pub(super) fn step_speed(self, metres_a_second: f64, steps: i32) -> f64 {
        match self {
            Self::Metric => metres_a_second + 0.5 * f64::from(steps),
            Self::Imperial => self.metres_per_second(tenths(self.speed(metres_a_second)) + f64::from(steps)),
        }
    }

    /// Returns the factor for a guard's values, and the unit after multiplication.
    pub fn of_guard(self, unit: GuardUnit) -> (f64, &'static str) {
        match unit {
            GuardUnit::Metres => (self.length(1.0), self.length_unit()),
            GuardUnit::MetresPerSecond => (self.speed(1.0), self.speed_unit()),
            GuardUnit::None | GuardUnit::Waypoints | GuardUnit::Seconds | GuardUnit::Microseconds => {
                (1.0, unit.into())
            }
        }
    }

    /// Returns the name of the unit of lengths for sentences.
    pub(super) fn length_name(self) -> &'static str {
        match self {
            Self::Metric => "metres",
            Self::Imperial => "feet",
        }
    }

    /// Returns the symbol of the unit of lengths.
    pub fn length_unit(self) -> &'static str {
        match self {
            Self::Metric => "m",
            Self::Imperial => "ft",
        }
    }

    /// Returns the symbol of the unit of speeds.
    pub fn speed_unit(self) -> &'static str {
        match self {
            Self::Metric => "m/s",
            Self::Imperial => "mph",
        }
    }

    /// Returns a sentence with its lengths and speeds in the shown units, with as many decimals. Text in backquotes is for
    /// the craft, and stays as it is.
    pub(in crate::ui) fn in_sentence(self, text: String) -> String {
        if self == Self::Metric || !text.contains(METRIC[1]) {
            return text;
        }
        let mut shown = String::with_capacity(text.len());
        let mut is_quoted = false;
        let mut rest = text.as_str();
        while let Some(at) = rest.find(|c: char| c == '`' || c.is_ascii_digit()) {
            let (before, from) = rest.split_at(at);
            shown.push_str(before);
            let is_number = |c: char| c.is_ascii_digit() || c == '.';
            let end = from.find(|c| !is_number(c)).unwrap_or(from.len()).max(1);
            let (number, after) = from.split_at(end);
            let is_word = shown.ends_with(|c: char| c.is_alphanumeric() || c == '_');
            is_quoted ^= number == "`";
            match self.quantity(number, after).filter(|_| !is_quoted && !is_word) {
                Some((quantity, unit)) => {
                    shown.push_str(&quantity);
                    rest = &after[unit..];
                }
                None => {
                    shown.push_str(number);
                    rest = after;
                }
            }
        }
        shown + rest
    }

    /// Returns a metric quantity in the shown unit, and the length of its metric unit; `None` for any other number.
    fn quantity(self, number: &str, after: &str) -> Option<(String, usize)> {
        let value: f64 = number.parse().ok()?;
        let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let unit = METRIC.iter().find(|unit| {
            let beyond = after.strip_prefix(**unit).map(|beyond| beyond.chars().next());
            beyond.is_some_and(|next| next.is_none_or(|c| !c.is_alphanumeric() && !"/²³·".contains(c)))
        })?;
        let quantity = if *unit == METRIC[0] {
            self.speed_text(value, decimals)
        } else {
            self.length_text(value, decimals)
        };
        Some((quantity, unit.len()))
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

    #[test]
    fn sentences_name_lengths_and_speeds_in_the_shown_units() {
        for (metric, imperial) in [
            ("reached (arrival 2.0 m ≤ 2.0 m).", "reached (arrival 6.6 ft ≤ 6.6 ft)."),
            (
                "Geofence: 174.0 m from home, the fence is 150 m: landing",
                "Geofence: 570.9 ft from home, the fence is 492 ft: landing",
            ),
            ("came down at 0.53 m/s, peak 58.9 m/s².", "came down at 1.19 mph, peak 58.9 m/s²."),
            ("-0.4 m, +3.0 m/s", "-1.3 ft, +6.7 mph"),
            (
                "`set x = 5 m` stays; 2 minutes, 3 ms, WP1 m, 5 km, 12 m",
                "`set x = 5 m` stays; 2 minutes, 3 ms, WP1 m, 5 km, 39 ft",
            ),
            ("at 1.2.3 m, 7.", "at 1.2.3 m, 7."),
        ] {
            assert_eq!(Units::Imperial.in_sentence(metric.to_owned()), imperial);
            assert_eq!(Units::Metric.in_sentence(metric.to_owned()), metric);
        }
    }
}
