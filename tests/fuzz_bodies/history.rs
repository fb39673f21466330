//! Files of the lines that were entered in text fields.

use betadeck::screen_files::entered_lines::{LONGEST, RECALLED, is_kept, recalled};

/// Recalls the lines of the text: the newest that can have been entered, in their order.
pub fn run(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let lines = recalled(&text);
    assert!(lines.len() <= RECALLED);
    for line in &lines {
        assert!(line.len() <= LONGEST && !line.trim().is_empty() && !line.contains(char::is_control));
    }
    let kept: Vec<&str> = text.lines().filter(|line| is_kept(line)).collect();
    assert!(kept.ends_with(&lines) && lines.len() == kept.len().min(RECALLED));
    // The file that replaces a long one holds the same lines.
    let rewritten: String = lines.iter().map(|line| format!("{line}\n")).collect();
    assert_eq!(recalled(&rewritten), lines);
    // An appended line is the newest, whatever the file ends with.
    let appended = format!("{text}\nspeed 2\n");
    assert_eq!(recalled(&appended).last(), Some(&"speed 2"));
}
