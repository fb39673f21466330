//! Makes text safe to show in a terminal.
//!
//! Names, keys, notes and messages come from files and from links. This module removes characters that a
//! terminal would execute instead of show (control characters), and those that would show a reader other
//! letters than the text has (writing direction, invisible tags).

use std::borrow::Cow;
use std::fmt::Write as _;

/// The replacement of a character that is not shown.
const PLACEHOLDER: char = '?';
/// The maximum number of characters of a line. Longer text is no sentence.
const MAX_LINE: usize = 400;
/// The maximum number of characters of a name inside a line.
const MAX_NAME: usize = 60;

/// Returns `true` if a terminal shows this character as it is.
pub fn is_printable(c: char) -> bool {
    !matches!(c,
        '\0'..='\u{1f}' | '\u{7f}'..='\u{9f}'
        // Marks and overrides of the writing direction.
        | '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
        // Characters without width between letters.
        | '\u{ad}' | '\u{180e}' | '\u{200b}' | '\u{2060}'..='\u{2064}' | '\u{115f}' | '\u{1160}' | '\u{3164}' | '\u{ffa0}'
        // Line and paragraph separators, the byte order mark, annotations and tags.
        | '\u{2028}' | '\u{2029}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

/// Returns a single line of printable text.
pub fn line(text: &str) -> Cow<'_, str> {
    let is_short = text.len() <= MAX_LINE || text.chars().nth(MAX_LINE).is_none();
    if is_short && text.chars().all(is_printable) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(cut(text, MAX_LINE))
}

/// Returns a printable name for the inside of a line.
pub fn name(text: &str) -> String {
    cut(text, MAX_NAME)
}

/// Returns printable text of several lines. Tabs between words become spaces.
pub fn lines(text: &str) -> Cow<'_, str> {
    let is_clean = |part: &str| matches!(line(part), Cow::Borrowed(_));
    if text.split('\n').all(|part| is_clean(part.strip_suffix('\r').unwrap_or(part))) {
        return Cow::Borrowed(text);
    }
    let mut clean = String::with_capacity(text.len());
    for (at, part) in text.split('\n').enumerate() {
        if at > 0 {
            clean.push('\n');
        }
        let (part, end) = part.strip_suffix('\r').map_or((part, ""), |part| (part, "\r"));
        clean.push_str(&line(&part.replace('\t', " ")));
        clean.push_str(end);
    }
    Cow::Owned(clean)
}

/// Returns a line of JSON in which unprintable characters are escaped. This changes nothing for its readers.
pub fn json(text: &str) -> Cow<'_, str> {
    if text.chars().all(is_printable) {
        return Cow::Borrowed(text);
    }
    let mut clean = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_printable(c) {
            clean.push(c);
        } else {
            for unit in c.encode_utf16(&mut [0; 2]) {
                // Writing to a string cannot fail.
                let _infallible = write!(clean, "\\u{unit:04x}");
            }
        }
    }
    Cow::Owned(clean)
}

fn cut(text: &str, most: usize) -> String {
    let shown = |c: char| if is_printable(c) { c } else { PLACEHOLDER };
    let mut clean: String = text.chars().take(most).map(shown).collect();
    if text.chars().nth(most).is_some() {
        clean.pop();
        clean.push('\u{2026}');
    }
    clean
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_a_terminal_obeys_is_not_shown() {
        assert_eq!(line("a\u{1b}[31mb\u{202e}c\u{7}"), "a?[31mb?c?");
        assert_eq!(lines("a\tb\r\n\u{9b}2J\n"), "a b\r\n?2J\n");
        assert_eq!(line("Zürich \u{200d} 飛行"), "Zürich \u{200d} 飛行");
    }

    #[test]
    fn a_name_longer_than_a_line_is_cut() {
        let cut = name(&"x".repeat(10_000));
        assert_eq!(cut.chars().count(), MAX_NAME);
        assert!(cut.ends_with("x\u{2026}"));
        assert_eq!(line(&"x".repeat(10_000)).chars().count(), MAX_LINE);
        assert_eq!(line(&"x".repeat(MAX_LINE)).chars().count(), MAX_LINE);
    }

    proptest! {
        #[test]
        fn no_text_reaches_a_terminal_raw(text in any::<String>()) {
            prop_assert!(line(&text).chars().all(is_printable));
            prop_assert!(name(&text).chars().all(is_printable));
            let shown = lines(&text);
            prop_assert!(shown.chars().all(|c| is_printable(c) || matches!(c, '\r' | '\n')));
            prop_assert_eq!(shown.matches('\n').count(), text.matches('\n').count());
        }

        #[test]
        fn escaped_json_means_the_same(text in any::<String>()) {
            let plain = serde_json::to_string(&text).expect("a string");
            let escaped = json(&plain);
            prop_assert!(escaped.chars().all(is_printable));
            prop_assert_eq!(serde_json::from_str::<String>(&escaped).expect("JSON"), text);
        }
    }
}
