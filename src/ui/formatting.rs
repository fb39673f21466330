//! Numbers as readable text: right-aligned, of fixed width, with units. An unknown value is a dash.

use std::time::Duration;

use crate::signals::SimTime;

/// Formats `value` with `decimals`, right-aligned in `width` columns, or a dash. A number that does not fit loses its
/// decimals first and then becomes an ellipsis, never a wrong number.
pub(super) fn fixed(value: Option<f64>, width: usize, decimals: usize) -> String {
    let Some(value) = value.filter(|value| value.is_finite()) else {
        return format!("{:>width$}", "—");
    };
    let value = without_negative_zero(value, decimals);
    for decimals in (0..=decimals).rev() {
        let text = format!("{value:>width$.decimals$}");
        if text.len() <= width {
            return text;
        }
    }
    format!("{:>width$}", "…")
}

/// Rounds a direction to whole degrees, 0 to 359.
pub(super) fn compass(degrees: f64) -> f64 {
    degrees.round().rem_euclid(360.0)
}

/// Returns 0 instead of a value that would print as "-0.0".
pub(super) fn without_negative_zero(value: f64, decimals: usize) -> f64 {
    let floor = 0.5 * 0.1_f64.powi(decimals as i32);
    if value.abs() < floor { 0.0 } else { value }
}

/// Like [`fixed`], with a sign always shown.
pub(super) fn signed(value: Option<f64>, width: usize, decimals: usize) -> String {
    match value.filter(|value| value.is_finite()) {
        Some(value) => {
            let value = without_negative_zero(value, decimals);
            let text = format!("{value:>+width$.decimals$}");
            if text.len() <= width { text } else { fixed(Some(value), width, decimals) }
        }
        None => fixed(None, width, decimals),
    }
}

/// Formats minutes, seconds and tenths since boot: `01:12.4`.
pub(super) fn clock(time: SimTime) -> String {
    let tenths = time.0 / 100_000;
    format!("{:02}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10)
}

/// Formats minutes, seconds and milliseconds since boot: `01:12.410`.
pub(super) fn clock_ms(time: SimTime) -> String {
    let ms = time.0 / 1000;
    format!("{:02}:{:02}.{:03}", ms / 60_000, ms / 1000 % 60, ms % 1000)
}

/// Formats a factor of real time: `0.25×`, `8×`, `312×`, `max`.
pub(super) fn factor(times: f64) -> String {
    if times.is_infinite() {
        "max".to_owned()
    } else if times < 9.95 && times.fract() != 0.0 {
        let text = format!("{times:.2}");
        format!("{}×", text.trim_end_matches('0').trim_end_matches('.'))
    } else {
        format!("{times:.0}×")
    }
}

/// Returns `true` if `earlier` is less than `span` before `now`.
pub(super) fn within(now: Duration, earlier: Duration, span: Duration) -> bool {
    now.saturating_sub(earlier) < span
}

/// Cuts `text` to `width` columns, with an ellipsis at the end if something is lost.
pub(super) fn cut(text: &str, width: usize) -> String {
    use unicode_width::{UnicodeWidthChar as _, UnicodeWidthStr as _};
    if text.width() <= width {
        return text.to_owned();
    }
    let mut out = String::new();
    let mut used = 0;
    for c in text.chars() {
        let w = c.width().unwrap_or(0);
        if used + w + 1 > width {
            break;
        }
        used += w;
        out.push(c);
    }
    if width > 0 {
        out.push('…');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_width_and_never_lie() {
        assert_eq!(fixed(Some(62.44), 6, 1), "  62.4");
        assert_eq!(fixed(Some(-0.01), 5, 1), "  0.0");
        assert_eq!(fixed(None, 5, 1), "    —");
        assert_eq!(fixed(Some(f64::NAN), 3, 1), "  —");
        assert_eq!(fixed(Some(12_345.6), 5, 1), "12346");
        assert_eq!(fixed(Some(1e9), 5, 1), "    …");
        assert_eq!(signed(Some(0.3), 5, 1), " +0.3");
        assert_eq!(signed(Some(-0.04), 5, 1), " +0.0");
    }

    #[test]
    fn factors_are_short() {
        assert_eq!(factor(1.0), "1×");
        assert_eq!(factor(0.25), "0.25×");
        assert_eq!(factor(6.1), "6.1×");
        assert_eq!(factor(311.7), "312×");
        assert_eq!(factor(f64::INFINITY), "max");
    }

    #[test]
    fn cutting_marks_the_loss() {
        assert_eq!(cut("abcdef", 4), "abc…");
        assert_eq!(cut("abcd", 4), "abcd");
        assert_eq!(cut("abcd", 0), "");
    }
}
