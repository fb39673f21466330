//! Conditions: comparisons, flags, states and modes, joined by `and`, `or` and `not`.

use std::str::FromStr as _;

use strum::IntoEnumIterator as _;

use super::cursor::{Cursor, SyntaxError};
use super::number::{Typed, share_unit};
use super::pattern::{SOURCES, mode_of, read_state_word, read_waypoint};
use super::{Bound, Comparison, Condition, Scope};
use crate::scenario::flag::Flag;
use crate::telemetry::quantity::Dimension;

impl Scope {
    /// Reads a condition.
    ///
    /// # Errors
    /// Returns the mistake in the text.
    pub fn read_condition(&self, cursor: &mut Cursor<'_>) -> Result<Condition, SyntaxError> {
        cursor.nested(|cursor| {
            let mut any = vec![read_all(cursor, self)?];
            while cursor.take_keyword("or") {
                any.push(read_all(cursor, self)?);
            }
            Ok(if any.len() == 1 { any.remove(0) } else { Condition::Any(any) })
        })
    }
}

fn read_all(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<Condition, SyntaxError> {
    let mut all = vec![read_one(cursor, scope)?];
    while cursor.take_keyword("and") {
        all.push(read_one(cursor, scope)?);
    }
    Ok(if all.len() == 1 { all.remove(0) } else { Condition::All(all) })
}

fn read_one(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<Condition, SyntaxError> {
    if cursor.take_keyword("not") {
        return cursor.nested(|cursor| Ok(Condition::Not(Box::new(read_one(cursor, scope)?))));
    }
    if let Some(condition) = read_word(cursor, scope)? {
        return Ok(condition);
    }
    // A parenthesis begins a condition or a number.
    if cursor.rest().starts_with('(') {
        let mut inner = cursor.clone();
        inner.take("(");
        if let Ok(condition) = scope.read_condition(&mut inner)
            && inner.take(")")
        {
            *cursor = inner;
            return Ok(condition);
        }
        cursor.note_attempt(&inner);
    }
    read_comparison(cursor, scope).map(Condition::Compare)
}

/// Reads a flag, a state, a mode or `flying`, if there is one at this place.
fn read_word(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<Option<Condition>, SyntaxError> {
    let Some(word) = cursor.peek_word() else { return Ok(None) };
    if let Ok(flag) = Flag::from_str(word) {
        cursor.term()?;
        cursor.take_word(word);
        return Ok(Some(Condition::Flag(flag)));
    }
    match word {
        "state" => {
            cursor.term()?;
            cursor.take_word(word);
            let state = read_state_word(cursor)?;
            Ok(Some(Condition::State(state, read_waypoint(cursor, scope, None)?)))
        }
        "mode" => {
            cursor.term()?;
            cursor.take_word(word);
            Ok(Some(Condition::Mode(mode_of(cursor)?)))
        }
        "flying" => {
            cursor.term()?;
            cursor.take_word(word);
            let found = cursor.peek_word().and_then(|word| SOURCES.iter().find(|(name, _)| *name == word));
            let Some(&(name, source)) = found else {
                return Err(cursor.unknown("the origin of a plan", SOURCES.iter().map(|(name, _)| *name)));
            };
            cursor.take_word(name);
            Ok(Some(Condition::Flying(source)))
        }
        _ => Ok(None),
    }
}

/// Reads a number and its bound.
///
/// # Errors
/// Returns the mistake in the text.
pub(super) fn read_comparison(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<Comparison, SyntaxError> {
    let start = cursor.at();
    let left = scope.read_number(cursor).map_err(|mut error| {
        if cursor.at() == start && error.message.ends_with("is not a signal or a measure") {
            let flags: Vec<String> = Flag::iter().map(|flag| flag.to_string()).collect();
            error.hint = format!("{}; or one of {}, state, mode, flying", error.hint, flags.join(", "));
        }
        error
    })?;
    let dimension = left.1;
    let behind = cursor.at();
    let bound = if cursor.take("<=") || cursor.take("≤") {
        Bound::AtMost(same(cursor, scope, dimension)?, false)
    } else if cursor.take(">=") || cursor.take("≥") {
        Bound::AtLeast(same(cursor, scope, dimension)?, false)
    } else if cursor.take("<") {
        Bound::AtMost(same(cursor, scope, dimension)?, true)
    } else if cursor.take(">") {
        Bound::AtLeast(same(cursor, scope, dimension)?, true)
    } else if cursor.take_keyword("in") {
        let from = cursor.at();
        let low = scope.read_number(cursor)?;
        cursor.expect("..")?;
        let high = scope.read_number(cursor)?;
        let (low, high) = share_unit(low, high);
        Bound::Between(fits(cursor, from, low, dimension)?, fits(cursor, from, high, dimension)?)
    } else if cursor.take("=") {
        let from = cursor.at();
        let middle = scope.read_number(cursor)?;
        if cursor.take("+-") || cursor.take("±") {
            let tolerance = scope.read_number(cursor)?;
            let (middle, tolerance) = share_unit(middle, tolerance);
            Bound::Around(fits(cursor, from, middle, dimension)?, fits(cursor, from, tolerance, dimension)?)
        } else if dimension == Dimension::NONE {
            Bound::Equal(fits(cursor, from, middle, dimension)?)
        } else {
            return Err(
                cursor.error("a tolerance is missing", "write = 20 +- 0.5 m: no measured value is exact")
            );
        }
    } else {
        let hint = "write <=, >=, <, >, in 1..2 m, or = 20 +- 0.5 m";
        return Err(if cursor.is_done() {
            cursor.error_since(start, "this number is not compared with anything", hint)
        } else {
            cursor.error("a comparison is expected here", hint)
        });
    };
    match wrong_bound(&bound) {
        None => Ok(Comparison { left: left.0, dimension, bound }),
        Some((message, hint)) => Err(cursor.error_since(behind, message, hint)),
    }
}

/// Returns the mistake in a bound of literals: an empty range, or a number that is not finite.
fn wrong_bound(bound: &Bound) -> Option<(&'static str, &'static str)> {
    let literal = |number: &super::Number| number.constant(&|_| None);
    let numbers = match bound {
        Bound::AtMost(one, _) | Bound::AtLeast(one, _) | Bound::Equal(one) => [one, one],
        Bound::Between(one, other) | Bound::Around(one, other) => [one, other],
    };
    if numbers.into_iter().any(|number| literal(number).is_some_and(|value| !value.is_finite())) {
        return Some(("this number is infinite", "write a number that can be reached"));
    }
    match bound {
        Bound::Between(low, high) => (literal(low)? > literal(high)?)
            .then_some(("nothing is in this range", "write the smaller number first")),
        Bound::Around(_, tolerance) => {
            (literal(tolerance)? < 0.0).then_some(("this tolerance is negative", "write it without the sign"))
        }
        _ => None,
    }
}

/// Reads a number with the given dimension.
fn same(cursor: &mut Cursor<'_>, scope: &Scope, dimension: Dimension) -> Result<super::Number, SyntaxError> {
    let start = cursor.at();
    let number = scope.read_number(cursor)?;
    fits(cursor, start, number, dimension)
}

fn fits(
    cursor: &Cursor<'_>,
    start: usize,
    number: Typed,
    dimension: Dimension,
) -> Result<super::Number, SyntaxError> {
    if number.1 == dimension {
        return Ok(number.0);
    }
    let hint = format!("allowed: {}", dimension.unit_names());
    let message = if number.1 == Dimension::NONE {
        format!("the unit is missing: {dimension} are compared")
    } else {
        format!("{} do not fit: {dimension} are compared", number.1)
    };
    Err(cursor.error_since(start, message, hint))
}
