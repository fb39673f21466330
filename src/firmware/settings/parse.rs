//! Strict parsing of a setting's value: text that is not fully understood is refused.

use super::{Kind, PORT_NAMES, Setting, Value};

/// The reason why a value was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum AssignError {
    /// No setting has this name.
    #[error("no such setting")]
    UnknownName,
    /// The setting does not accept the value.
    #[error("not an allowed value")]
    InvalidValue,
    /// The text has more characters than the setting holds.
    #[error("the text is longer than {max} characters")]
    TextTooLong {
        /// The most characters.
        max: usize,
    },
}

/// Parses `text` as a value of `setting`.
pub(super) fn parse(setting: &Setting, text: &str) -> Result<Value, AssignError> {
    let text = text.trim();
    match setting.kind {
        Kind::Number { .. } => check(setting, Value::Number(integer(text).ok_or(AssignError::InvalidValue)?)),
        Kind::Choice { words, .. } => word(words, text),
        Kind::Port { .. } => word(&PORT_NAMES, text),
        Kind::Array { .. } => {
            let numbers: Option<Vec<i64>> = text.split(',').map(|part| integer(part.trim())).collect();
            check(setting, Value::Array(numbers.ok_or(AssignError::InvalidValue)?))
        }
        Kind::Text { .. } if text == "-" => Ok(Value::Text(String::new())),
        Kind::Text { .. } if text.is_empty() => Err(AssignError::InvalidValue),
        Kind::Text { .. } => check(setting, Value::Text(text.to_owned())),
    }
}

/// Refuses a value that the setting cannot hold.
pub(super) fn check(setting: &Setting, value: Value) -> Result<Value, AssignError> {
    let fits = match (&value, setting.kind) {
        (Value::Number(number), Kind::Number { min, max, .. }) => (min..=max).contains(number),
        (Value::Number(at), Kind::Choice { words, .. }) => position_in(words, *at),
        (Value::Number(at), Kind::Port { .. }) => position_in(&PORT_NAMES, *at),
        (Value::Array(numbers), Kind::Array { default }) => {
            let (min, max) = setting.width.bounds();
            numbers.len() == default.len() && numbers.iter().all(|number| (min..=max).contains(number))
        }
        (Value::Text(text), Kind::Text { max }) => {
            if text.chars().count() > max {
                return Err(AssignError::TextTooLong { max });
            }
            text.bytes().all(|byte| (b' '..=b'~').contains(&byte) && byte != b'#')
                && text.trim() == text
                && text != "-"
        }
        _ => false,
    };
    if fits { Ok(value) } else { Err(AssignError::InvalidValue) }
}

fn position_in(words: &[&str], at: i64) -> bool {
    usize::try_from(at).is_ok_and(|at| at < words.len())
}

fn word(words: &[&str], text: &str) -> Result<Value, AssignError> {
    let at =
        words.iter().position(|word| word.eq_ignore_ascii_case(text)).ok_or(AssignError::InvalidValue)?;
    Ok(Value::Number(at as i64))
}

/// Parses an optional sign followed by digits only.
fn integer(text: &str) -> Option<i64> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    text.parse().ok()
}
