//! The values of a waypoint as text: one reader for each value, shared by the formats.

use strum::IntoEnumIterator as _;

use crate::plan::{HoldPattern, WaypointType};
use crate::text::did_you_mean;

/// A mistake in a value, and the allowed values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FieldError {
    /// `latitude 4O.4 is not a number`.
    pub message: String,
    /// `allowed: …`.
    pub hint: String,
}

impl FieldError {
    fn new(message: String, hint: impl Into<String>) -> Self {
        Self { message, hint: hint.into() }
    }
}

/// Reads decimal degrees as degrees × 10⁷: an optional sign, at least one digit, optionally a point and more digits.
/// Digits after the seventh are cut, not rounded. Returns `None` for any other text and beyond ±214.7483647.
pub fn degrees_e7(text: &str) -> Option<i32> {
    let (negative, digits) = match text.as_bytes().first()? {
        b'-' => (true, &text[1..]),
        b'+' => (false, &text[1..]),
        _ => (false, text),
    };
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let all_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    if whole.is_empty() || !all_digits(whole) || !all_digits(fraction) {
        return None;
    }
    let whole: i64 = whole.parse().ok()?;
    let fraction: i64 = format!("{fraction:0<7.7}").parse().ok()?;
    let size = whole.checked_mul(10_000_000)?.checked_add(fraction)?;
    i32::try_from(if negative { -size } else { size }).ok()
}

/// Returns `true` if the text is a decimal number of any size.
fn is_decimal(text: &str) -> bool {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let all_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    !whole.is_empty() && all_digits(whole) && all_digits(fraction)
}

fn degrees(what: &str, text: &str, limit_e7: u32, hint: &str) -> Result<i32, FieldError> {
    match degrees_e7(text) {
        Some(value) if value.unsigned_abs() <= limit_e7 => Ok(value),
        None if !is_decimal(text) => Err(FieldError::new(format!("{what} {text} is not a number"), hint)),
        _ => Err(FieldError::new(format!("{what} {text} is out of range"), hint)),
    }
}

/// Reads a latitude, degrees × 10⁷.
pub(super) fn latitude(text: &str) -> Result<i32, FieldError> {
    degrees("latitude", text, 900_000_000, "allowed: -90.0000000 to 90.0000000")
}

/// Reads a longitude, degrees × 10⁷.
pub(super) fn longitude(text: &str) -> Result<i32, FieldError> {
    degrees("longitude", text, 1_800_000_000, "allowed: -180.0000000 to 180.0000000")
}

/// Reads an altitude, cm.
pub(super) fn altitude_cm(text: &str) -> Result<i32, FieldError> {
    let hint = "allowed: whole centimetres above home, such as 5000 for 50 m";
    if let Ok(value) = text.parse() {
        return Ok(value);
    }
    if is_decimal(text) && !text.contains('.') {
        let hint = format!("allowed: {} to {} cm", i32::MIN, i32::MAX);
        return Err(FieldError::new(format!("altitude {text} is out of range"), hint));
    }
    // The firmware answers `waypoint insert` with the altitude in metres, and people paste that back.
    let echoed = text.strip_suffix('m').and_then(|metres| metres.parse::<f64>().ok()).map(|m| m * 100.0);
    if let Some(cm) = echoed.filter(|cm| cm.abs() < f64::from(i32::MAX)) {
        return Err(FieldError::new(
            format!("altitude {text} is in metres"),
            format!("write whole centimetres: {cm:.0}"),
        ));
    }
    Err(FieldError::new(format!("altitude {text} is not a whole number"), hint))
}

/// Reads a value of 0…65535.
fn unsigned(what: &str, text: &str, unit: &str) -> Result<u16, FieldError> {
    let hint = format!("allowed: 0 to 65535 {unit}");
    match text.parse() {
        Ok(value) => Ok(value),
        Err(_) if is_decimal(text) && !text.contains('.') => {
            Err(FieldError::new(format!("{what} {text} is out of range"), hint))
        }
        Err(_) => Err(FieldError::new(format!("{what} {text} is not a whole number"), hint)),
    }
}

/// Reads a speed, cm/s.
pub(super) fn speed_cms(text: &str) -> Result<u16, FieldError> {
    unsigned("speed", text, "cm/s (0 = default)")
}

/// Reads a duration, deciseconds.
pub(super) fn duration_ds(text: &str) -> Result<u16, FieldError> {
    unsigned("duration", text, "deciseconds (0 = endless)")
}

pub(super) fn waypoint_type(text: &str) -> Result<WaypointType, FieldError> {
    text.parse().map_err(|_| {
        FieldError::new(
            format!("{text} is not a waypoint type"),
            did_you_mean::hint(text, WaypointType::iter().map(Into::into)),
        )
    })
}

pub(super) fn pattern(text: &str) -> Result<HoldPattern, FieldError> {
    text.parse().map_err(|_| {
        FieldError::new(
            format!("{text} is not a hold pattern"),
            did_you_mean::hint(text, HoldPattern::iter().map(Into::into)),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_are_cut_not_rounded() {
        for (text, value) in [
            ("40.4640000", Some(404_640_000)),
            ("-79.5175", Some(-795_175_000)),
            ("+27.1234567891", Some(271_234_567)),
            ("-0.00000019", Some(-1)),
            ("5.", Some(50_000_000)),
            ("153", Some(1_530_000_000)),
            ("0000000000000000000000000005", Some(50_000_000)),
            ("214.7483647", Some(i32::MAX)),
            ("214.7483648", None),
            (".5", None),
            ("", None),
            ("-", None),
            ("1e3", None),
            ("4O.4", None),
            ("1.2.3", None),
            ("99999999999999999999999", None),
        ] {
            assert_eq!(degrees_e7(text), value, "{text}");
        }
    }

    #[test]
    fn messages_name_the_value_and_the_range() {
        let say = |error: FieldError| format!("{} | {}", error.message, error.hint);
        assert_eq!(
            say(latitude("4O.4640000").unwrap_err()),
            "latitude 4O.4640000 is not a number | allowed: -90.0000000 to 90.0000000"
        );
        assert_eq!(
            say(longitude("999").unwrap_err()),
            "longitude 999 is out of range | allowed: -180.0000000 to 180.0000000"
        );
        assert_eq!(
            say(altitude_cm("40.00m").unwrap_err()),
            "altitude 40.00m is in metres | write whole centimetres: 4000"
        );
        assert!(say(altitude_cm("99999999999").unwrap_err()).contains("out of range"));
        assert!(say(altitude_cm("5.5").unwrap_err()).contains("not a whole number"));
        assert!(say(speed_cms("70000").unwrap_err()).contains("allowed: 0 to 65535 cm/s"));
        assert!(say(duration_ds("-1").unwrap_err()).contains("duration -1 is out of range"));
        assert!(say(waypoint_type("FLYOVR").unwrap_err()).contains("did you mean FLYOVER?"));
        assert!(say(pattern("CIRCLE").unwrap_err()).ends_with("| allowed: NONE, ORBIT, FIGURE8"));
    }

    #[test]
    fn words_ignore_case() {
        assert_eq!(waypoint_type("alt_change"), Ok(WaypointType::AltChange));
        assert_eq!(pattern("figure8"), Ok(HoldPattern::Figure8));
    }
}
