//! The `[keys]` of the configuration file.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::process::error::AppError;
use crate::ui::keymap::{KeyLine, Keymap};

/// Reads the lines of the table, `"flight.arm" = "a"`. The name may also be written without quotes.
pub(super) fn read(file_name: &str, text: &str) -> Result<Vec<KeyLine>, AppError> {
    // The reader of the options reports syntax errors.
    let Ok(document) = DeTable::parse(text) else { return Ok(Vec::new()) };
    let keys = document.get_ref().iter().find(|(name, _)| name.get_ref().as_ref() == "keys");
    let Some((name, table)) = keys else { return Ok(Vec::new()) };
    let mut lines = Vec::new();
    let mut problems = Vec::new();
    match table.get_ref() {
        DeValue::Table(table) => collect(table, "", text, &mut lines, &mut problems),
        _ => problems.push((
            line_of(text, name.span().start),
            "keys is a table: write [keys] and below it \"flight.arm\" = \"a\"".to_owned(),
        )),
    }
    if problems.is_empty() { Ok(lines) } else { Err(input_error(file_name, &problems)) }
}

/// Returns the default keymap, changed by the lines.
pub(super) fn keymap(file_name: &str, lines: &[KeyLine]) -> Result<Keymap, AppError> {
    Keymap::remapped(lines).map_err(|problems| input_error(file_name, &problems))
}

fn collect(
    table: &DeTable<'_>,
    prefix: &str,
    text: &str,
    lines: &mut Vec<KeyLine>,
    problems: &mut Vec<(usize, String)>,
) {
    for (name, value) in table {
        let action = format!("{prefix}{}", name.get_ref());
        let line = line_of(text, name.span().start);
        let string = |value: &Spanned<DeValue<'_>>| value.get_ref().as_str().map(str::to_owned);
        let keys = match value.get_ref() {
            DeValue::Table(inner) => {
                collect(inner, &format!("{action}."), text, lines, problems);
                continue;
            }
            DeValue::Array(keys) => keys.iter().map(string).collect(),
            _ => string(value).map(|key| vec![key]),
        };
        match keys {
            Some(keys) => lines.push(KeyLine { line, action, keys }),
            None => problems.push((
                line,
                format!("{action} needs a key such as \"a\", or a list such as [\"a\", \"f2\"]"),
            )),
        }
    }
}

fn line_of(text: &str, at: usize) -> usize {
    1 + text.bytes().take(at).filter(|&byte| byte == b'\n').count()
}

fn input_error(file_name: &str, problems: &[(usize, String)]) -> AppError {
    let mut problems: Vec<&(usize, String)> = problems.iter().collect();
    problems.sort_by_key(|(line, _)| *line);
    let lines = problems.iter().map(|(line, problem)| format!("{file_name}:{line}: {problem}"));
    AppError::input(lines.collect::<Vec<_>>().join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::Panel;
    use crate::ui::action::Action;
    use crate::ui::keymap::KeyPress;

    fn read_map(text: &str) -> Result<Keymap, String> {
        let lines = read("config.toml", text).map_err(|error| error.message)?;
        keymap("config.toml", &lines).map_err(|error| error.message)
    }

    #[test]
    fn quoted_names_bare_names_and_lists_are_read() {
        let text = "wind = \"5@270\"\n[keys]\n\"flight.arm\" = \"A\"\nsim.step = [\"f10\", \"f11\"]\nflight.throttle = \"\"\n";
        let map = read_map(text).expect("a keymap");
        let action = |key| map.action(KeyPress::parse(key).expect("a key"), Panel::Log);
        assert_eq!(action("A"), Some(Action::Arm));
        assert_eq!((action("a"), action("t")), (None, None), "a replaced key and an unbound one");
        assert_eq!((action("f10"), action("f11")), (Some(Action::Step), Some(Action::Step)));
    }

    #[test]
    fn problems_name_their_lines() {
        for (text, wanted) in [
            ("keys = 3", "config.toml:1: keys is a table"),
            ("\n[keys]\nflight.arm = 3", "config.toml:3: flight.arm needs a key"),
            (
                "[keys]\nflight.amr = \"a\"",
                "config.toml:2: there is no action flight.amr; did you mean flight.arm?",
            ),
            ("[keys]\nflight.arm = \"hyper-a\"", "config.toml:2: \"hyper-a\" is no key"),
            ("[keys]\nflight.arm = \"g\"", "config.toml:2: g means flight.arm and flight.autopilot"),
            ("[keys]\napp.palette = \"p\"", "config.toml:2: app.palette works while text is typed"),
        ] {
            let error = read_map(text).expect_err(text);
            assert!(error.starts_with(wanted), "{text}: {error}");
        }
        let both = read_map("[keys]\nflight.arm = \"nokey\"\nmap.nothing = \"z\"").expect_err("two problems");
        assert_eq!(both.lines().count(), 2, "{both}");
    }
}
