//! Instants: an event, the choice among several such events, and an offset in time.

use super::cursor::{Cursor, SyntaxError};
use super::number::share_unit;
use super::pattern::read_pattern;
use super::{Anchor, Instant, Number, Occurrence, Scope};
use crate::telemetry::quantity::Dimension;

const ORDINALS: [(&str, Occurrence); 6] = [
    ("first", Occurrence::Nth(1)),
    ("second", Occurrence::Nth(2)),
    ("third", Occurrence::Nth(3)),
    ("fourth", Occurrence::Nth(4)),
    ("fifth", Occurrence::Nth(5)),
    ("last", Occurrence::Last),
];

/// The longest offset before or after an event, s.
const MAX_OFFSET_S: f64 = 1e6;

impl Scope {
    /// Reads an instant: `5 s after ORBITING 2`, `contact`, `when north > 70 m`.
    ///
    /// # Errors
    /// Returns the mistake in the text.
    pub fn read_instant(&self, cursor: &mut Cursor<'_>) -> Result<Instant, SyntaxError> {
        cursor.nested(|cursor| {
            let offset_s = if cursor.rest().starts_with(|c: char| c.is_ascii_digit()) {
                let start = cursor.at();
                let seconds = duration(cursor, self, start)?;
                direction(cursor)? * seconds
            } else {
                0.0
            };
            let mut instant = read_anchor(cursor, self)?;
            instant.offset_s += offset_s;
            Ok(instant)
        })
    }
}

/// Reads a span of time counted from an instant: `12.5..18 s after engaged`.
///
/// # Errors
/// Returns the mistake in the text.
pub fn read_span_from(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<(f64, f64, Instant), SyntaxError> {
    let start = cursor.at();
    let low = scope.read_number(cursor)?;
    cursor.expect("..")?;
    let high = scope.read_number(cursor)?;
    let (low, high) = share_unit(low, high);
    let (Number::Literal(from, _), Number::Literal(to, _)) = (&low.0, &high.0) else {
        return Err(cursor.error_since(
            start,
            "two times are expected here",
            "write 12.5..18 s after engaged",
        ));
    };
    if low.1 != Dimension::TIME || high.1 != Dimension::TIME {
        return Err(cursor.error_since(start, "these are not times", "write 12.5..18 s after engaged"));
    }
    if from > to {
        return Err(cursor.error_since(
            start,
            "this time ends before it begins",
            "write the smaller number first",
        ));
    }
    let (from, to) = (*from, *to);
    let sign = direction(cursor)?;
    let instant = scope.read_instant(cursor)?;
    Ok(if sign > 0.0 { (from, to, instant) } else { (-to, -from, instant) })
}

fn duration(cursor: &mut Cursor<'_>, scope: &Scope, start: usize) -> Result<f64, SyntaxError> {
    match scope.read_number(cursor)? {
        (Number::Literal(seconds, Some(_)), Dimension::TIME) if seconds > MAX_OFFSET_S => Err(
            cursor.error_since(start, "no flight is this long", format!("allowed: up to {MAX_OFFSET_S} s"))
        ),
        (Number::Literal(seconds, Some(_)), Dimension::TIME) => Ok(seconds),
        _ => Err(cursor.error_since(start, "this is not a time", "write 5 s after engaged")),
    }
}

fn direction(cursor: &mut Cursor<'_>) -> Result<f64, SyntaxError> {
    if cursor.take_keyword("after") {
        Ok(1.0)
    } else if cursor.take_keyword("before") {
        Ok(-1.0)
    } else {
        Err(cursor.error("after or before is expected here", "write 5 s after engaged"))
    }
}

fn read_anchor(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<Instant, SyntaxError> {
    let mut occurrence = Occurrence::Nth(1);
    if let Some(&(name, nth)) =
        cursor.peek_word().and_then(|word| ORDINALS.iter().find(|(name, _)| *name == word))
    {
        cursor.take_word(name);
        occurrence = nth;
    } else if cursor.take_keyword("nth") {
        match cursor.take_index() {
            Some(nth) if nth > 0 => occurrence = Occurrence::Nth(usize::from(nth)),
            _ => return Err(cursor.error("a number from 1 is expected here", "write nth 7 ARRIVED 0")),
        }
    }
    let anchor = if cursor.take_keyword("boot") {
        Anchor::Boot
    } else if cursor.take_keyword("last_sample") {
        Anchor::Last
    } else if cursor.take_keyword("when") {
        Anchor::When(scope.read_condition(cursor)?)
    } else {
        Anchor::Happening(read_pattern(cursor, scope)?)
    };
    let after = if cursor.take_keyword("after") {
        Some(Box::new(cursor.nested(|cursor| scope.read_instant(cursor))?))
    } else {
        None
    };
    Ok(Instant { anchor, occurrence, after, offset_s: 0.0 })
}
