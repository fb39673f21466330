//! Texts in Markdown.

/// Returns text for a cell of a table.
pub(super) fn cell(text: &str) -> String {
    line(text).replace('|', "\\|")
}

/// Returns text with Markdown's special characters escaped.
pub(super) fn line(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\r' => escaped.push(' '),
            '\\' | '*' | '_' | '`' | '[' | ']' => escaped.extend(['\\', c]),
            '<' => escaped.push_str("&lt;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// Returns a command as Markdown code, even if it has back quotes.
pub(super) fn code(command: &str) -> String {
    let command = command.replace('\n', " ");
    let longest = command.split(|c| c != '`').map(str::len).max().unwrap_or_default();
    let fence = "`".repeat(longest + 1);
    if longest == 0 { format!("`{command}`") } else { format!("{fence} {command} {fence}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_ends_where_the_command_does() {
        assert_eq!(code("betadeck fly square"), "`betadeck fly square`");
        assert_eq!(code("betadeck fly '``a`'"), "``` betadeck fly '``a`' ```");
    }
}
