//! Wraps text to a width.

/// Wraps `text` to lines of at most `width` columns at blanks. A longer word is broken anywhere. A character that is
/// wider than a line has a line of its own.
pub(super) fn wrapped(text: &str, width: usize) -> Vec<String> {
    use unicode_width::{UnicodeWidthChar as _, UnicodeWidthStr as _};
    let mut lines: Vec<String> = Vec::new();
    let mut current = String::new();
    let mut used = 0;
    for word in text.split_whitespace() {
        if !current.is_empty() && used + 1 + word.width() > width {
            lines.push(std::mem::take(&mut current));
            used = 0;
        }
        if !current.is_empty() {
            current.push(' ');
            used += 1;
        }
        for c in word.chars() {
            let columns = c.width().unwrap_or(0);
            if used > 0 && used + columns > width {
                lines.push(std::mem::take(&mut current));
                used = 0;
            }
            current.push(c);
            used += columns;
        }
    }
    if !current.is_empty() {
        lines.push(current);
    }
    lines
}

/// Wraps `text` to lines of at most `width` columns and keeps its blanks. The lines after the first are indented.
pub(super) fn folded(text: &str, width: usize) -> Vec<String> {
    use unicode_width::UnicodeWidthChar as _;
    const INDENT: &str = "  ";
    let mut lines: Vec<String> = Vec::new();
    let mut current = String::new();
    let mut used = 0;
    // The byte after the last blank of `current`, where the line is broken.
    let mut blank = None;
    for c in text.chars() {
        let columns = c.width().unwrap_or(0);
        if used + columns > width && used > INDENT.len() {
            let rest = current.split_off(blank.unwrap_or(current.len()));
            lines.push(std::mem::take(&mut current));
            current = format!("{INDENT}{rest}");
            used = current.chars().filter_map(char::width).sum();
            blank = None;
        }
        current.push(c);
        used += columns;
        if c == ' ' && current.trim_start().len() > 1 {
            blank = Some(current.len());
        }
    }
    lines.push(current);
    lines
}

/// Returns how many of these entries, each with its number of rows, fit into a height; at least one.
pub(super) fn fitting(rows: impl Iterator<Item = usize>, height: usize) -> usize {
    let mut left = height;
    let fits = |rows: &usize| match left.checked_sub(*rows) {
        Some(rest) => {
            left = rest;
            true
        }
        None => false,
    };
    rows.take_while(fits).count().max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folding_keeps_every_character_and_the_width() {
        assert_eq!(folded("as it  is", 20), ["as it  is"]);
        assert_eq!(folded("waypoint insert 0 1", 12), ["waypoint ", "  insert 0 1"]);
        assert_eq!(folded("abcdefgh", 4), ["abcd", "  ef", "  gh"]);
        assert_eq!(folded("", 4), [""]);
        use unicode_width::UnicodeWidthStr as _;
        for width in 4..12 {
            for line in folded("  set  ap_x = 一二三 😀 yyyyyyyyyyyyyyyy z", width) {
                assert!(line.width() <= width, "{width}: {line}");
            }
        }
    }

    #[test]
    fn entries_fit_from_the_first_on() {
        assert_eq!(fitting([1, 2, 3, 1].into_iter(), 4), 2);
        assert_eq!(fitting([9, 1].into_iter(), 4), 1);
        assert_eq!(fitting(std::iter::empty(), 4), 1);
    }

    #[test]
    fn text_wraps_at_blanks_and_never_exceeds_the_width() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("abcdefgh", 3), ["abc", "def", "gh"]);
        assert_eq!(wrapped("一二 三", 3), ["一", "二", "三"]);
        assert!(wrapped("", 3).is_empty());
    }
}
