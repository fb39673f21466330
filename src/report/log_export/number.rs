//! Numbers of a table, without the general formatter: a log has tens of millions.

use std::io::Write as _;

/// Ten to the power of each number of decimals.
const POWERS: [u64; 9] = [1, 10, 100, 1000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];
/// Numbers from here on have no decimals.
const WHOLE: f64 = (1_u64 << 52) as f64;

/// Appends a number with at most so many decimals, as `{:.*}` rounds it but without zeros at its end; nothing for an unknown
/// one.
pub(super) fn append(text: &mut Vec<u8>, value: f64, decimals: u8) {
    if !value.is_finite() {
        return;
    }
    let power = POWERS.get(usize::from(decimals)).copied().unwrap_or(1);
    let scaled = value.abs() * power as f64;
    let whole = scaled as i64;
    let above = scaled - whole as f64;
    // The product is rounded, but never past a half: only there it does not show to which side the value belongs.
    if power == 1 && decimals > 0 || scaled >= WHOLE || above == 0.5 {
        return append_exactly(text, value, decimals);
    }
    let units = whole as u64 + u64::from(above > 0.5);
    if value < 0.0 && units > 0 {
        text.push(b'-');
    }
    append_units(text, units, power, decimals);
}

/// Appends a time in seconds with six decimals.
pub(super) fn append_seconds(text: &mut Vec<u8>, time_us: u64) {
    text.extend_from_slice(itoa::Buffer::new().format(time_us / 1_000_000).as_bytes());
    text.push(b'.');
    append_digits(text, time_us % 1_000_000, 6);
}

/// Appends a number of units, of which `power` are one, without zeros at its end.
fn append_units(text: &mut Vec<u8>, units: u64, power: u64, decimals: u8) {
    if power == 1 {
        text.extend_from_slice(itoa::Buffer::new().format(units).as_bytes());
        return;
    }
    text.extend_from_slice(itoa::Buffer::new().format(units / power).as_bytes());
    let (mut rest, mut digits) = (units % power, usize::from(decimals));
    if rest == 0 {
        return;
    }
    while rest.is_multiple_of(10) {
        rest /= 10;
        digits -= 1;
    }
    text.push(b'.');
    append_digits(text, rest, digits);
}

/// Appends so many digits of a number, at most eight.
fn append_digits(text: &mut Vec<u8>, mut number: u64, count: usize) {
    let mut digits = [b'0'; 8];
    for digit in digits[..count].iter_mut().rev() {
        *digit = b'0' + (number % 10) as u8;
        number /= 10;
    }
    text.extend_from_slice(&digits[..count]);
}

/// Appends a number by the general formatter.
fn append_exactly(text: &mut Vec<u8>, value: f64, decimals: u8) {
    let from = text.len();
    // A list of bytes takes all text.
    write!(text, "{value:.*}", usize::from(decimals)).ok();
    if decimals > 0 {
        let zeros = text.iter().rev().take_while(|byte| **byte == b'0').count();
        text.truncate(text.len() - zeros.min(usize::from(decimals)));
        if text.last() == Some(&b'.') {
            text.pop();
        }
    }
    if text[from..] == *b"-0" {
        text.remove(from);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn written(value: f64, decimals: u8) -> String {
        let mut text = Vec::new();
        append(&mut text, value, decimals);
        String::from_utf8(text).unwrap()
    }

    /// Writes the number with the general formatter.
    fn formatted(value: f64, decimals: u8) -> String {
        let text = format!("{value:.*}", usize::from(decimals));
        let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        if short == "-0" { "0".to_owned() } else { short.to_owned() }
    }

    #[test]
    fn numbers_are_short_and_without_a_negative_zero() {
        assert_eq!(written(1.25, 3), "1.25");
        assert_eq!(written(-0.0001, 3), "0");
        assert_eq!(written(-0.0, 0), "0");
        assert_eq!(written(-0.5, 0), "0");
        assert_eq!(written(1200.0, 0), "1200");
        assert_eq!(written(40.464_000_1, 7), "40.4640001");
        assert_eq!(written(2.5, 0), "2");
        assert_eq!(written(f64::NAN, 3), "");
        let mut text = Vec::new();
        append_seconds(&mut text, 61_000_250);
        assert_eq!(text, b"61.000250");
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_general_formatter(
            raw in any::<i32>(),
            small in -100_000..100_000,
            any in any::<f64>(),
            factor in prop::sample::select(vec![1.0, 100.0, 0.1, 0.01, 0.5, 0.25, 0.0625, 1e-7, 9.80665 / 2048.0, 0.1 / 3.0]),
            offset in prop::sample::select(vec![0.0, -11.1, 0.005]),
            decimals in 0..=9_u8,
        ) {
            let values = [any, any / 1e300, f64::from(raw) * factor + offset, f64::from(small) * factor + offset];
            for value in values.into_iter().filter(|value| value.is_finite()) {
                prop_assert_eq!(written(value, decimals), formatted(value, decimals), "{} {}", value, decimals);
            }
        }
    }
}
