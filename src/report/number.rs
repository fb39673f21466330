//! Numbers for machine-readable output, rounded to a fixed number of decimals. This keeps lines short and makes the
//! bytes of equal flights equal.

use serde::{Serialize, Serializer};

/// A number that serialises with at most `D` decimals; infinity and NaN serialise as `null`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Decimals<const D: i32>(pub f64);

/// Metres, metres per second, seconds, volts: to the thousandth.
pub(super) type Milli = Decimals<3>;

/// Degrees of angles, microseconds of RC pulses: to the hundredth.
pub(super) type Centi = Decimals<2>;

/// Degrees of latitude and longitude: to about a millimetre.
pub(super) type Place = Decimals<8>;

impl<const D: i32> From<f64> for Decimals<D> {
    fn from(value: f64) -> Self {
        Self(value)
    }
}

impl<const D: i32> Serialize for Decimals<D> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if !self.0.is_finite() {
            return serializer.serialize_none();
        }
        let scale = 10_f64.powi(D);
        // Adding zero turns a negative zero into a plain one. A value too large to scale stays unchanged.
        let rounded = (self.0 * scale).round() / scale + 0.0;
        serializer.serialize_f64(if rounded.is_finite() { rounded } else { self.0 })
    }
}

/// Returns a direction, degrees clockwise from north, from 0 to just below 360, also after rounding.
pub(super) fn compass<const D: i32>(degrees: f64) -> Decimals<D> {
    let turn = degrees.rem_euclid(360.0);
    let scale = 10_f64.powi(D);
    if (turn * scale).round() >= 360.0 * scale { Decimals(0.0) } else { Decimals(turn) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn print<const D: i32>(value: f64) -> String {
        serde_json::to_string(&Decimals::<D>(value)).unwrap()
    }

    #[test]
    fn numbers_are_short_and_never_negative_zero() {
        assert_eq!(print::<3>(1.0 / 3.0), "0.333");
        assert_eq!(print::<3>(-0.000_1), "0.0");
        assert_eq!(print::<8>(-79.518_2), "-79.5182");
        assert_eq!(print::<3>(f64::NAN), "null");
        assert_eq!(print::<3>(f64::INFINITY), "null");
        assert_eq!(print::<3>(f64::MAX), "1.7976931348623157e+308");
    }

    #[test]
    fn directions_stay_below_360_degrees() {
        let print = |degrees| serde_json::to_string(&compass::<3>(degrees)).unwrap();
        for (degrees, text) in [
            (359.999_4, "359.999"),
            (359.999_6, "0.0"),
            (360.0, "0.0"),
            (-1e-17, "0.0"),
            (-90.0, "270.0"),
            (725.5, "5.5"),
            (f64::NAN, "null"),
        ] {
            assert_eq!(print(degrees), text, "{degrees}");
        }
    }
}
