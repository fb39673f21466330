//! A setting as one line of text, and its problems.

/// A part of a setting's line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SettingPart {
    /// The name of the setting.
    Name,
    /// The value of the setting.
    Value,
}

/// A problem of a setting, in sentences for people.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}{}{hint}", if hint.is_empty() { "" } else { "; " })]
pub struct SettingFault {
    /// The part with the problem.
    pub part: SettingPart,
    /// The problem, as a sentence without its full stop.
    pub message: String,
    /// The allowed values; may be empty.
    pub hint: String,
}

/// A check of the name and the value of a setting.
pub type SettingCheck = fn(&str, &str) -> Result<(), SettingFault>;

/// Returns a line `name = value`, `set name = value` or `name=value` in its canonical form `name = value`. Returns
/// `None` for any other line, and for a line that the CLI would not pass on unchanged.
pub fn setting_line(line: &str) -> Option<String> {
    let line = line.trim();
    let line = match line.get(..4) {
        Some(prefix) if prefix.eq_ignore_ascii_case("set ") => line[4..].trim_start(),
        _ => line,
    };
    let (name, value) = line.split_once('=')?;
    let (name, value) = (name.trim(), value.trim());
    let is_name = !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    // The CLI cuts a line at a `#`.
    let is_value = !value.is_empty() && !value.contains(|c: char| c.is_control() || c == '#');
    (is_name && is_value).then(|| format!("{name} = {value}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_get_their_canonical_form() {
        for line in ["a_1=5", " set a_1 = 5 ", "SET  a_1=5", "a_1 =5"] {
            assert_eq!(setting_line(line).as_deref(), Some("a_1 = 5"), "{line}");
        }
        assert_eq!(setting_line("name = two words").as_deref(), Some("name = two words"));
    }

    #[test]
    fn what_the_cli_would_not_take_is_refused() {
        for line in ["", "a", "a =", "= 5", "a b = 5", "a = 5 # five", "a = 5\nsave", "é = 1"] {
            assert_eq!(setting_line(line), None, "{line}");
        }
    }
}
