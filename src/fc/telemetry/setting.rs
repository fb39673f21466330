//! The output of `get`.

/// Returns the settings in an output of `get`, each with its value as text.
pub fn settings(output: &str) -> impl Iterator<Item = (&str, &str)> {
    output.lines().filter_map(|line| {
        let (name, value) = line.split_once(" =")?;
        let name = name.trim();
        let is_name =
            !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
        is_name.then(|| (name, value.trim()))
    })
}

/// Returns the value of one setting in an output of `get`, which lists all settings whose names contain the
/// requested word. Returns `None` if the firmware does not have the setting.
pub fn setting<'a>(output: &'a str, name: &str) -> Option<&'a str> {
    settings(output).find(|(found, _)| found.eq_ignore_ascii_case(name)).map(|(_, value)| value)
}
