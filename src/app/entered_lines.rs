//! The text of a history file: entered lines, the oldest first.

/// Lines of a field that are recalled.
pub const RECALLED: usize = 500;
/// Longest line that is kept, bytes.
pub const LONGEST: usize = 4096;

/// Whether a line can be kept.
pub fn is_kept(line: &str) -> bool {
    !line.trim().is_empty() && line.len() <= LONGEST && !line.contains(char::is_control)
}

/// The newest lines of a file, the oldest of them first. What no field can have entered is left out.
pub fn recalled(text: &str) -> Vec<&str> {
    let mut lines: Vec<&str> = text.lines().rev().filter(|line| is_kept(line)).take(RECALLED).collect();
    lines.reverse();
    lines
}
