//! The numbers of pictures: four decimals, which is less than a display shows, and compresses well.

use std::io::{self, Write};

use serde_json::ser::Formatter;

/// The factor of the last decimal.
const SCALE: f64 = 1e4;
/// The size from which a number has its usual form.
const LARGE: f64 = 1e11;

/// Writes compact JSON with rounded numbers.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Rounded;

impl Formatter for Rounded {
    fn write_f64<W: ?Sized + Write>(&mut self, writer: &mut W, value: f64) -> io::Result<()> {
        if value.abs() >= LARGE {
            return write!(writer, "{value}");
        }
        let scaled = (value * SCALE).round() as i64;
        if scaled < 0 {
            writer.write_all(b"-")?;
        }
        let (whole, part) = (scaled.unsigned_abs() / SCALE as u64, scaled.unsigned_abs() % SCALE as u64);
        if part == 0 {
            return write!(writer, "{whole}");
        }
        let digits = format!("{part:04}");
        write!(writer, "{whole}.{}", digits.trim_end_matches('0'))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Serialize as _;

    fn written(value: f64) -> String {
        let mut out = Vec::new();
        value.serialize(&mut serde_json::Serializer::with_formatter(&mut out, Rounded)).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn a_number_has_at_most_four_decimals() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (-0.00001, "0"),
            (12.5, "12.5"),
            (-0.1 - 0.2, "-0.3"),
            (3.00005, "3.0001"),
            (1e11, "100000000000"),
            (f64::NAN, "null"),
        ] {
            assert_eq!(written(value), text);
        }
    }

    proptest::proptest! {
        #[test]
        fn a_number_is_read_within_its_last_decimal(value in -1e10..1e10_f64) {
            let read: f64 = serde_json::from_str(&written(value)).unwrap();
            // Half a unit of the last decimal, and the rounding of the product and of the reading.
            let most = 0.5 / SCALE + 4.0 * f64::EPSILON * value.abs();
            proptest::prop_assert!((read - value).abs() <= most, "{value} {read}");
        }
    }
}
