//! The comparison as a table for people.

use std::fmt::Write as _;

use super::Comparison;
use super::cells::{flights, incomplete, notes, rows};

/// The greatest width of a sentence, characters.
const WIDTH: usize = 110;

pub(super) fn table(comparison: &Comparison) -> String {
    let mut text = format!("{}\n", comparison.title());
    for (letter, side) in ["A", "B"].iter().zip(&comparison.sides) {
        let _ = writeln!(text, "{letter}: {}, {}", side.name, flights(side));
    }
    text.push('\n');
    let mut lines = vec![["", "", "A", "B", "B − A"].map(str::to_owned)];
    lines.extend(rows(comparison).into_iter().map(|row| {
        let difference = marked(row.difference, row.is_beyond);
        [row.title, row.unit.to_owned(), row.a, row.b, difference]
    }));
    text.push_str(&aligned(&lines));
    for sentence in incomplete(comparison) {
        let _ = writeln!(text, "{sentence}");
    }
    text.push('\n');
    for note in notes(comparison) {
        text.push_str(&wrapped(&note));
    }
    text
}

/// Returns the difference with a mark if it is greater than the spread, and with its width in any case.
fn marked(difference: String, is_beyond: Option<bool>) -> String {
    difference
        + match is_beyond {
            Some(true) => " *",
            Some(false) => "  ",
            None => "",
        }
}

/// Returns a text in lines.
fn wrapped(text: &str) -> String {
    let (mut lines, mut length) = (String::new(), 0);
    for word in text.split(' ') {
        let word_length = word.chars().count();
        if length > 0 && length + 1 + word_length > WIDTH {
            lines.push('\n');
            length = 0;
        } else if length > 0 {
            lines.push(' ');
            length += 1;
        }
        lines.push_str(word);
        length += word_length;
    }
    lines.push('\n');
    lines
}

/// Aligns columns to their widest cell: names left, values right.
fn aligned(lines: &[[String; 5]]) -> String {
    let width = |column: usize| {
        let cells = lines.iter().filter_map(|line| line.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let [title, unit, a, b, difference] = [0, 1, 2, 3, 4].map(width);
    let mut text = String::new();
    for [name, of, first, second, apart] in lines {
        let line = format!("{name:<title$}  {of:<unit$}  {first:>a$}  {second:>b$}  {apart:>difference$}");
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}
