//! The coordinates of KML: `LON,LAT,ALT` separated by blanks, and the `gx:coord` with blanks between its numbers.

use super::collector::{Counter, push};
use crate::plan::feature::Vertex;

/// The longest text of one vertex, bytes.
const LONGEST: usize = 256;

/// The hint for a vertex that cannot be read.
pub(super) const HINT: &str =
    "write LON,LAT,ALT with decimal points, not decimal commas, and blanks between the points";

/// Reads the vertices of a text that arrives in pieces.
#[derive(Debug, Default)]
pub(super) struct Tuples {
    pub(super) vertices: Vec<Vertex>,
    /// The beginning of a vertex that the next piece may continue.
    open: String,
}

impl Tuples {
    /// Reads a piece of the text.
    ///
    /// # Errors
    ///
    /// Returns the message for the first vertex that cannot be read, and its byte in the piece.
    pub(super) fn take(&mut self, piece: &str, counter: &mut Counter) -> Result<(), (usize, String)> {
        // A list that grows would need twice the memory for a moment.
        let blanks = piece.as_bytes().windows(2).filter(|pair| is_end_of_word(pair)).count();
        self.vertices.reserve_exact((blanks + 1).min(counter.left()));
        let mut at = 0;
        while let Some(length) = piece[at..].find(char::is_whitespace) {
            let word = &piece[at..at + length];
            let read = if self.open.is_empty() {
                self.word(word, counter)
            } else {
                let whole = std::mem::take(&mut self.open) + word;
                self.word(&whole, counter)
            };
            read.map_err(|message| (at, message))?;
            let rest = &piece[at + length..];
            at = piece.len() - rest.trim_start().len();
        }
        let rest = &piece[at..];
        if self.open.len() + rest.len() > LONGEST {
            return Err((at, format!("a point has more than {LONGEST} characters")));
        }
        self.open.push_str(rest);
        Ok(())
    }

    /// Reads the last vertex.
    ///
    /// # Errors
    ///
    /// Returns the message if it cannot be read.
    pub(super) fn end(mut self, counter: &mut Counter) -> Result<Vec<Vertex>, String> {
        let last = std::mem::take(&mut self.open);
        self.word(&last, counter)?;
        Ok(self.vertices)
    }

    fn word(&mut self, word: &str, counter: &mut Counter) -> Result<(), String> {
        if !word.is_empty() {
            push(&mut self.vertices, tuple(word, word.split(','), counter)?);
        }
        Ok(())
    }
}

fn is_end_of_word(pair: &[u8]) -> bool {
    matches!(pair, [word, blank] if !word.is_ascii_whitespace() && blank.is_ascii_whitespace())
}

/// Reads `LON LAT ALT`.
///
/// # Errors
///
/// Returns the message if it cannot be read.
pub(super) fn gx_coord(text: &str, counter: &mut Counter) -> Result<Vertex, String> {
    tuple(text, text.split_whitespace(), counter)
}

fn tuple<'t>(
    text: &str,
    mut parts: impl Iterator<Item = &'t str>,
    counter: &mut Counter,
) -> Result<Vertex, String> {
    let (lon, lat, altitude) = (parts.next(), parts.next(), parts.next().filter(|part| !part.is_empty()));
    let (Some(lon), Some(lat), None) = (lon, lat, parts.next()) else {
        return Err(format!("{text} is not a point"));
    };
    let lon = number("longitude", lon)?;
    let lat = number("latitude", lat)?;
    let altitude = altitude.map(|text| number("altitude", text)).transpose()?;
    counter.vertex(lat, lon, altitude)
}

/// Reads a number of a file.
///
/// # Errors
///
/// Returns the message with the value. It names a decimal comma.
pub(super) fn number(what: &str, text: &str) -> Result<f64, String> {
    let text = text.trim();
    text.parse().map_err(|_| {
        if text.contains(',') && text.replacen(',', ".", 1).parse::<f64>().is_ok() {
            format!("{what} {text} has a decimal comma: write a decimal point")
        } else {
            format!("{what} {text} is not a number")
        }
    })
}
