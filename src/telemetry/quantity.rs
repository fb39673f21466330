//! Dimensions and units of the signals of a flight, and of the numbers that are compared with them.

use std::fmt;

use crate::math;

/// Base units of a [`Dimension`], in the order of its exponents.
const BASES: usize = 6;

/// A dimension, as exponents of metre, second, degree, RC microsecond, volt and ampere. Percentages and counts have
/// none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Dimension([i8; BASES]);

impl Dimension {
    /// A count or a share.
    pub const NONE: Self = Self([0; BASES]);
    /// Length, m.
    pub const LENGTH: Self = Self([1, 0, 0, 0, 0, 0]);
    /// Time, s.
    pub const TIME: Self = Self([0, 1, 0, 0, 0, 0]);
    /// Metres per second.
    pub const SPEED: Self = Self([1, -1, 0, 0, 0, 0]);
    /// Metres per second squared.
    pub const ACCELERATION: Self = Self([1, -2, 0, 0, 0, 0]);
    /// Angle, degrees.
    pub const ANGLE: Self = Self([0, 0, 1, 0, 0, 0]);
    /// Microseconds of an RC channel.
    pub const PULSE: Self = Self([0, 0, 0, 1, 0, 0]);
    /// Voltage, V.
    pub const VOLTAGE: Self = Self([0, 0, 0, 0, 1, 0]);
    /// Current, A.
    pub const CURRENT: Self = Self([0, 0, 0, 0, 0, 1]);
    /// Charge, A·s.
    pub const CHARGE: Self = Self([0, 1, 0, 0, 0, 1]);

    /// Returns the dimension of a product, or of a quotient with `sign` −1.
    pub fn combine(self, other: Self, sign: i8) -> Self {
        Self(std::array::from_fn(|i| self.0[i].saturating_add(other.0[i].saturating_mul(sign))))
    }
}

/// A unit in its written form after a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// The written form.
    pub name: &'static str,
    /// The dimension.
    pub dimension: Dimension,
    /// Size in SI units and degrees.
    pub scale: f64,
    /// The name in words.
    pub help: &'static str,
}

const fn unit(name: &'static str, dimension: Dimension, scale: f64, help: &'static str) -> Unit {
    Unit { name, dimension, scale, help }
}

/// All units. Results are shown in the first unit of their dimension.
pub const UNITS: &[Unit] = &[
    unit("m", Dimension::LENGTH, 1.0, "metres"),
    unit("cm", Dimension::LENGTH, 0.01, "centimetres"),
    unit("km", Dimension::LENGTH, 1000.0, "kilometres"),
    unit("s", Dimension::TIME, 1.0, "seconds"),
    unit("ms", Dimension::TIME, 0.001, "milliseconds"),
    unit("min", Dimension::TIME, 60.0, "minutes"),
    unit("m/s", Dimension::SPEED, 1.0, "metres per second"),
    unit("km/h", Dimension::SPEED, 1.0 / 3.6, "kilometres per hour"),
    unit("m/s2", Dimension::ACCELERATION, 1.0, "metres per second squared"),
    unit("deg", Dimension::ANGLE, 1.0, "degrees"),
    unit("°", Dimension::ANGLE, 1.0, "degrees"),
    unit("deg/s", Dimension::ANGLE.per_second(), 1.0, "degrees per second"),
    unit("°/s", Dimension::ANGLE.per_second(), 1.0, "degrees per second"),
    unit("us", Dimension::PULSE, 1.0, "microseconds of an RC channel"),
    unit("µs", Dimension::PULSE, 1.0, "microseconds of an RC channel"),
    unit("V", Dimension::VOLTAGE, 1.0, "volts"),
    unit("A", Dimension::CURRENT, 1.0, "amperes"),
    unit("mAh", Dimension::CHARGE, 3.6, "milliampere hours"),
    unit("%", Dimension::NONE, 0.01, "per cent"),
];

impl Dimension {
    const fn per_second(self) -> Self {
        let mut exponents = self.0;
        exponents[1] -= 1;
        Self(exponents)
    }

    /// Returns the unit for values of this dimension; `None` for counts and for dimensions without a unit.
    pub fn unit(self) -> Option<&'static Unit> {
        UNITS.iter().find(|unit| unit.dimension == self && unit.name != "%")
    }

    /// Returns the units that may follow a number of this dimension, for messages.
    pub fn unit_names(self) -> String {
        let names: Vec<_> =
            UNITS.iter().filter(|unit| unit.dimension == self).map(|unit| unit.name).collect();
        if self == Self::NONE { "a plain number or %".to_owned() } else { names.join(", ") }
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(unit) = self.unit() {
            return f.write_str(unit.help);
        }
        if *self == Self::NONE {
            return f.write_str("a plain number");
        }
        let names = ["m", "s", "deg", "us", "V", "A"];
        let parts: Vec<String> = std::iter::zip(names, self.0)
            .filter(|&(_, exponent)| exponent != 0)
            .map(
                |(name, exponent)| if exponent == 1 { name.to_owned() } else { format!("{name}^{exponent}") },
            )
            .collect();
        f.write_str(&parts.join(" "))
    }
}

/// Returns a value in its unit, for people: `1.82 m`.
pub fn shown(value: f64, dimension: Dimension) -> String {
    in_unit(value, dimension, decimals)
}

fn in_unit(value: f64, dimension: Dimension, decimals: impl Fn(f64) -> usize) -> String {
    let number = |value| number_with(value, decimals(value));
    let Some(unit) = dimension.unit() else { return number(value) };
    let space = if unit.name == "°" { "" } else { " " };
    format!("{}{space}{}", number(value / unit.scale), unit.name)
}

/// Returns a value and a limit in their unit, with the decimal that tells them apart.
pub fn shown_apart(value: f64, limit: f64, dimension: Dimension) -> [String; 2] {
    let scale = dimension.unit().map_or(1.0, |unit| unit.scale);
    let apart = math::decimals_apart(value / scale, limit / scale, 0);
    [value, limit].map(|of| in_unit(of, dimension, |of| decimals(of).max(apart)))
}

/// Returns the number of decimals that are useful.
fn decimals(value: f64) -> usize {
    match value.abs() {
        size if size >= 100.0 => 1,
        size if size >= 0.095 => 2,
        _ => 3,
    }
}

fn number_with(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    // −0.000 becomes 0.
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_rounds_to_its_limit_shows_the_digit_that_decides() {
        let shown = |value| shown_apart(value, 50.0, Dimension::LENGTH);
        assert_eq!(shown(50.0004), ["50.0004 m", "50.0000 m"]);
        assert_eq!(shown(50.0), ["50.00 m", "50.00 m"]);
        assert_eq!(shown(51.0), ["51.00 m", "50.00 m"]);
        assert_eq!(shown_apart(0.990_000_1, 0.99, Dimension::NONE), ["0.9900001", "0.9900000"]);
    }

    #[test]
    fn values_are_shown_in_their_units() {
        for (value, dimension, text) in [
            (1.8249, Dimension::LENGTH, "1.82 m"),
            (123.456, Dimension::SPEED, "123.5 m/s"),
            (-0.0001, Dimension::LENGTH, "0.000 m"),
            (0.0123, Dimension::ANGLE, "0.012 deg"),
            (720.0, Dimension::CHARGE, "200.0 mAh"),
            (3.0, Dimension::NONE, "3.00"),
        ] {
            assert_eq!(shown(value, dimension), text);
        }
    }

    #[test]
    fn products_and_quotients_have_their_dimension() {
        assert_eq!(Dimension::LENGTH.combine(Dimension::TIME, -1), Dimension::SPEED);
        assert_eq!(Dimension::SPEED.combine(Dimension::TIME, 1), Dimension::LENGTH);
        assert_eq!(Dimension::LENGTH.combine(Dimension::LENGTH, 1).to_string(), "m^2");
        assert_eq!(Dimension::CURRENT.combine(Dimension::TIME, 1), Dimension::CHARGE);
    }
}
