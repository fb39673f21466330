//! Decimal numbers in the files of other programs.

/// Reads a finite number with a decimal point.
///
/// # Errors
///
/// Returns the reason with the value: `alt 40,5 has a decimal comma: write a point`.
pub(super) fn decimal(what: &str, text: &str) -> Result<f64, String> {
    let text = text.trim();
    if text.is_empty() {
        return Err(format!("{what} is missing"));
    }
    if text.contains(',') {
        return Err(format!("{what} {text} has a decimal comma: write a point"));
    }
    let is_plain = text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    let number = text.parse::<f64>().ok().filter(|number| is_plain && number.is_finite());
    number.ok_or_else(|| format!("{what} {text} is not a number"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_point_and_an_end() {
        assert_eq!(decimal("alt", " -1.5 "), Ok(-1.5));
        assert_eq!(decimal("alt", "1e2"), Ok(100.0));
        assert_eq!(decimal("alt", "40,5").unwrap_err(), "alt 40,5 has a decimal comma: write a point");
        for text in ["NaN", "inf", "-infinity", "1e999", "0x10", "4O", "1.2.3", "-"] {
            assert_eq!(decimal("alt", text).unwrap_err(), format!("alt {text} is not a number"));
        }
        assert_eq!(decimal("alt", "").unwrap_err(), "alt is missing");
    }
}
