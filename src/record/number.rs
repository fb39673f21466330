//! Numbers for machine-readable output: rounded to a fixed number of decimals, so that lines stay short and equal
//! flights give equal bytes.

use serde::{Serialize, Serializer};

/// A number that serialises with at most `D` decimals; what is not finite serialises as `null`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Decimals<const D: i32>(pub f64);

/// Metres, metres per second, seconds, volts: to the thousandth.
pub(super) type Milli = Decimals<3>;

/// Degrees of angles, microseconds of RC pulses: to the hundredth.
pub(super) type Centi = Decimals<2>;

/// Degrees of latitude and longitude: to about a millimetre.
pub(super) type Place = Decimals<8>;

impl<const D: i32> Serialize for Decimals<D> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if !self.0.is_finite() {
            return serializer.serialize_none();
        }
        let scale = 10_f64.powi(D);
        // Adding zero turns a negative zero into a plain one; a value too big to scale is kept as it is.
        let rounded = (self.0 * scale).round() / scale + 0.0;
        serializer.serialize_f64(if rounded.is_finite() { rounded } else { self.0 })
    }
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
}
