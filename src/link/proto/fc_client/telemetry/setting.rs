//! The output of `get`.

/// The settings that an output of `get` shows, each with its value as text.
pub fn settings(output: &str) -> impl Iterator<Item = (&str, &str)> {
    output.lines().filter_map(|line| {
        let (name, value) = line.split_once(" =")?;
        let name = name.trim();
        let is_name =
            !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
        is_name.then(|| (name, value.trim()))
    })
}

/// The value of one setting in an output of `get`, which shows all whose names contain the word that was asked for. `None`
/// when the firmware does not have it.
pub fn setting<'a>(output: &'a str, name: &str) -> Option<&'a str> {
    settings(output).find(|(found, _)| found.eq_ignore_ascii_case(name)).map(|(_, value)| value)
}
