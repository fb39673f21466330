//! Shortens a line for a message. Files may have lines of any length, which neither people nor terminals can
//! read.

/// The maximum number of characters that are shown of a line.
const MOST: usize = 200;
/// The maximum number of characters before the position.
const BEFORE: usize = 100;
/// The maximum number of characters of a text from a file in a sentence.
const SENTENCE: usize = 300;

/// A line, or the part of it around a position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceSnippet {
    /// The text. Spaces replace control characters, and `…` marks a cut.
    pub text: String,
    /// The column of the position in the text, in characters, from 1.
    pub column: usize,
}

/// Returns the part of a line that is shown for a column, in characters, from 1.
pub fn source_snippet(line: &str, column: usize) -> SourceSnippet {
    let shown = |c: char| if c.is_control() { ' ' } else { c };
    let is_short = line.chars().nth(MOST).is_none();
    let first = if is_short { 0 } else { column.saturating_sub(BEFORE + 1) };
    let mut text = if first > 0 { "…".to_owned() } else { String::new() };
    let mut rest = line.chars().skip(first);
    text.extend(rest.by_ref().take(MOST).map(shown));
    if rest.next().is_some() {
        text.push('…');
    }
    SourceSnippet { text, column: column - first + usize::from(first > 0) }
}

/// Shortens a sentence about a file by cutting out its middle if it is too long.
pub fn shortened(sentence: String) -> String {
    let Some((start, _)) = sentence.char_indices().nth(SENTENCE / 2) else { return sentence };
    match sentence.char_indices().nth_back(SENTENCE / 2 - 1) {
        Some((end, _)) if end > start => format!("{}…{}", &sentence[..start], &sentence[end..]),
        _ => sentence,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_line_is_shown_whole() {
        assert_eq!(source_snippet("a\tb", 3), SourceSnippet { text: "a b".to_owned(), column: 3 });
        assert_eq!(source_snippet("", 1), SourceSnippet { text: String::new(), column: 1 });
        assert_eq!(source_snippet(&"x".repeat(MOST), 150).text, "x".repeat(MOST));
    }

    #[test]
    fn a_long_line_is_cut_around_the_place() {
        let line: String = ('a'..='z').cycle().take(1_000_000).collect();
        for column in [1, 100, 101, 102, 5000, 999_999, 1_000_000, 1_000_001] {
            let SourceSnippet { text, column: place } = source_snippet(&line, column);
            assert!(text.chars().count() <= MOST + 2, "{column}");
            assert_eq!(text.chars().nth(place - 1).filter(|c| *c != '…'), line.chars().nth(column - 1));
        }
        assert_eq!(source_snippet(&line, 5000).column, BEFORE + 2);
    }

    #[test]
    fn a_long_sentence_keeps_its_ends() {
        assert_eq!(shortened("é is no number".to_owned()), "é is no number");
        let long = shortened(format!("latitude {} is not a number", "é".repeat(1_000_000)));
        assert!(long.starts_with("latitude éé") && long.ends_with("éé is not a number"), "{long}");
        assert_eq!(long.chars().count(), SENTENCE + 1);
        assert_eq!(shortened("é".repeat(SENTENCE)), "é".repeat(SENTENCE));
    }
}
