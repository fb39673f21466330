//! The text of a history file: entered lines, the oldest first.

/// The number of lines of a field that are recalled.
pub const RECALLED: usize = 500;
/// The longest line that is kept, bytes.
pub const LONGEST: usize = 4096;

/// Returns `true` if a line can be kept.
pub fn is_kept(line: &str) -> bool {
    !line.trim().is_empty() && line.len() <= LONGEST && !line.contains(char::is_control)
}

/// Returns the newest lines of a file, the oldest of them first. Leaves out lines that cannot come from a field.
pub fn recalled(text: &str) -> Vec<&str> {
    let mut lines: Vec<&str> = text.lines().rev().filter(|line| is_kept(line)).take(RECALLED).collect();
    lines.reverse();
    lines
}
