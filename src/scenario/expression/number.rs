//! Numbers: sums, products, functions, signals and literals with their units.

use std::str::FromStr as _;

use strum::IntoEnumIterator as _;

use super::cursor::{Cursor, SyntaxError};
use super::place::read_line;
use super::{Function, Number, Operator, Scope};
use crate::telemetry::quantity::{Dimension, UNITS, Unit};
use crate::telemetry::signal::{SIGNALS, Signal};

/// A number and its dimension.
pub(super) type Typed = (Number, Dimension);

/// The longest name of a case, a measure or an input, characters.
pub const MAX_NAME: usize = 100;
/// The functions whose arguments are places or instants.
const OTHER_FUNCTIONS: [&str; 9] =
    ["distance", "bearing", "apart", "along", "across", "past", "since", "at", "rate"];

impl Scope {
    /// Reads a number.
    ///
    /// # Errors
    /// Returns the mistake in the text, such as units that do not match.
    pub fn read_number(&self, cursor: &mut Cursor<'_>) -> Result<(Number, Dimension), SyntaxError> {
        cursor.nested(|cursor| {
            let start = cursor.at();
            let mut left = read_product(cursor, self)?;
            loop {
                // `+-` begins a tolerance, `->` the end of a line.
                let operator = if cursor.rest().starts_with("+-") || cursor.rest().starts_with("->") {
                    return Ok(left);
                } else if cursor.take("+") {
                    Operator::Add
                } else if cursor.take("-") {
                    Operator::Subtract
                } else {
                    return Ok(left);
                };
                let right = read_product(cursor, self)?;
                left = join_same(cursor, start, operator, left, right)?;
            }
        })
    }
}

/// Joins two numbers in a sum or a difference: both must have the same dimension.
fn join_same(
    cursor: &Cursor<'_>,
    start: usize,
    operator: Operator,
    left: Typed,
    right: Typed,
) -> Result<Typed, SyntaxError> {
    let (left, right) = share_unit(left, right);
    if left.1 != right.1 {
        return Err(cursor.error_since(
            start,
            format!("{} and {} cannot be added", left.1, right.1),
            "both sides need the same unit",
        ));
    }
    Ok((Number::Join(operator, Box::new(left.0), Box::new(right.0)), left.1))
}

/// Gives two literals the same unit if only one of them has a unit: `12..18 s`.
pub(super) fn share_unit(left: Typed, right: Typed) -> (Typed, Typed) {
    match (bare(&left.0), unit_of(&left.0), bare(&right.0), unit_of(&right.0)) {
        (true, _, _, Some(unit)) => (with_unit(left.0, unit), right),
        (_, Some(unit), true, _) => (left, with_unit(right.0, unit)),
        _ => (left, right),
    }
}

pub(in crate::scenario) fn bare(number: &Number) -> bool {
    match number {
        Number::Literal(_, unit) => unit.is_none(),
        Number::Negative(inner) => bare(inner),
        _ => false,
    }
}

fn unit_of(number: &Number) -> Option<&'static Unit> {
    match number {
        Number::Literal(_, unit) => *unit,
        Number::Negative(inner) => unit_of(inner),
        _ => None,
    }
}

fn with_unit(number: Number, unit: &'static Unit) -> Typed {
    let number = match number {
        Number::Literal(value, None) => Number::Literal(value * unit.scale, Some(unit)),
        Number::Negative(inner) => Number::Negative(Box::new(with_unit(*inner, unit).0)),
        other => other,
    };
    (number, unit.dimension)
}

fn read_product(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<Typed, SyntaxError> {
    let (mut left, mut dimension) = read_factor(cursor, scope)?;
    loop {
        let (operator, sign) = if cursor.take("*") {
            (Operator::Multiply, 1)
        } else if cursor.take("/") {
            (Operator::Divide, -1)
        } else if cursor.take("%") {
            (Operator::Remainder, 0)
        } else {
            return Ok((left, dimension));
        };
        let (right, other) = read_factor(cursor, scope)?;
        if sign != 0 {
            dimension = dimension.combine(other, sign);
        }
        left = Number::Join(operator, Box::new(left), Box::new(right));
    }
}

fn read_factor(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<Typed, SyntaxError> {
    if cursor.take("-") {
        return cursor.nested(|cursor| {
            let (number, dimension) = read_factor(cursor, scope)?;
            Ok((Number::Negative(Box::new(number)), dimension))
        });
    }
    if cursor.take("(") {
        let inner = scope.read_number(cursor)?;
        cursor.expect(")")?;
        return Ok(inner);
    }
    cursor.term()?;
    if let Some(value) = cursor.take_decimal() {
        let Some(unit) = take_unit(cursor) else {
            return Ok((Number::Literal(value, None), Dimension::NONE));
        };
        return Ok((Number::Literal(value * unit.scale, Some(unit)), unit.dimension));
    }
    let Some(word) = cursor.peek_word() else {
        return Err(cursor.error("a number is expected here", "write a signal such as altitude, or 5 m"));
    };
    if cursor.rest()[word.len()..].trim_start().starts_with('(') {
        return read_call(cursor, scope, word);
    }
    named(cursor, scope, word)
}

/// Takes the unit after a number: the longest one that matches.
fn take_unit(cursor: &mut Cursor<'_>) -> Option<&'static Unit> {
    let rest = cursor.rest();
    let unit = UNITS
        .iter()
        .filter(|unit| rest.starts_with(unit.name))
        .filter(|unit| {
            // `5 min` is not `5 m in`, and `60 N` has no unit.
            let next = rest[unit.name.len()..].chars().next();
            !(unit.name.ends_with(char::is_alphanumeric)
                && next.is_some_and(|c| c.is_alphanumeric() || c == '_'))
        })
        .max_by_key(|unit| unit.name.len())?;
    cursor.take(unit.name);
    Some(unit)
}

fn named(cursor: &mut Cursor<'_>, scope: &Scope, word: &str) -> Result<Typed, SyntaxError> {
    let field = scope.fields.iter().find(|field| field.info().0 == word);
    let number = if let Some(&field) = field {
        (Number::Field(field), field.info().1)
    } else if let Some(signal) = Signal::find(word) {
        (Number::Signal(signal), signal.info().dimension)
    } else {
        let known = of_case(cursor.rest(), scope).or_else(|| scope.names.get_key_value(word));
        let Some((name, dimension)) = known else {
            let fields = scope.fields.iter().map(|field| field.info().0);
            let names = scope.names.keys().map(String::as_str);
            let known = names.chain(fields).chain(SIGNALS.iter().map(|info| info.name));
            return Err(cursor.unknown("a signal or a measure", known));
        };
        cursor.take_word(name);
        return Ok((Number::Name(name.clone()), *dimension));
    };
    cursor.take_word(word);
    Ok(number)
}

/// Returns the longest known name with a dot at the beginning: a measure of a case, whose name may have any characters.
fn of_case<'s>(rest: &str, scope: &'s Scope) -> Option<(&'s String, &'s Dimension)> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    let ends = rest.char_indices().map(|(at, _)| at).chain([rest.len()]).take(2 * MAX_NAME + 2);
    let ends = ends.filter(|&end| !rest[end..].starts_with(is_part));
    ends.filter_map(|end| scope.names.get_key_value(&rest[..end]))
        .filter(|(name, _)| name.contains('.'))
        .max_by_key(|(name, _)| name.len())
}

fn read_call(cursor: &mut Cursor<'_>, scope: &Scope, word: &str) -> Result<Typed, SyntaxError> {
    let names = || Function::iter().map(<&str>::from).chain(OTHER_FUNCTIONS);
    let function = Function::from_str(word).ok();
    if function.is_none() && !OTHER_FUNCTIONS.contains(&word) {
        return Err(cursor.unknown("a function", names()));
    }
    cursor.take_word(word);
    cursor.expect("(")?;
    let typed = cursor.nested(|cursor| match function {
        Some(function) => read_arguments(cursor, scope, function),
        None => read_other(cursor, scope, word),
    })?;
    cursor.expect(")")?;
    Ok(typed)
}

fn read_arguments(cursor: &mut Cursor<'_>, scope: &Scope, function: Function) -> Result<Typed, SyntaxError> {
    let start = cursor.at();
    let first = scope.read_number(cursor)?;
    match function {
        Function::Abs => Ok((Number::Call(function, vec![first.0]), first.1)),
        Function::Wrap if first.1 != Dimension::ANGLE => {
            Err(cursor.error_since(start, "wrap is of an angle", format!("this is {}", first.1)))
        }
        Function::Wrap => Ok((Number::Call(function, vec![first.0]), first.1)),
        Function::Min | Function::Max | Function::Hypot => {
            cursor.expect(",")?;
            let second = scope.read_number(cursor)?;
            let (first, second) = share_unit(first, second);
            if first.1 != second.1 {
                return Err(cursor.error_since(
                    start,
                    format!("{} and {} cannot be compared", first.1, second.1),
                    "both need the same unit",
                ));
            }
            Ok((Number::Call(function, vec![first.0, second.0]), first.1))
        }
    }
}

fn read_other(cursor: &mut Cursor<'_>, scope: &Scope, word: &str) -> Result<Typed, SyntaxError> {
    Ok(match word {
        "distance" => (Number::Distance(scope.read_place(cursor)?), Dimension::LENGTH),
        "bearing" => (Number::Bearing(scope.read_place(cursor)?), Dimension::ANGLE),
        "apart" => {
            let from = scope.read_place(cursor)?;
            cursor.expect(",")?;
            (Number::Apart(from, scope.read_place(cursor)?), Dimension::LENGTH)
        }
        "along" | "across" | "past" => {
            let (from, to) = read_line(cursor, scope)?;
            let number = match word {
                "along" => Number::Along(from, to),
                "across" => Number::Across(from, to),
                _ => Number::Past(from, to),
            };
            (number, Dimension::LENGTH)
        }
        "since" => (Number::Since(Box::new(scope.read_instant(cursor)?)), Dimension::TIME),
        "at" => {
            let (number, dimension) = scope.read_number(cursor)?;
            cursor.expect(",")?;
            (Number::At(Box::new(number), Box::new(scope.read_instant(cursor)?)), dimension)
        }
        _ => {
            let before = cursor.terms();
            let (number, dimension) = scope.read_number(cursor)?;
            cursor.count_twice(before)?;
            (Number::Rate(Box::new(number)), dimension.combine(Dimension::TIME, -1))
        }
    })
}

/// Reads a number with its unit whose value is known before the flight: a parameter.
///
/// # Errors
/// Returns the mistake in the text.
pub fn read_quantity(cursor: &mut Cursor<'_>) -> Result<(f64, Dimension), SyntaxError> {
    let (number, dimension) = Scope::default().read_number(cursor)?;
    cursor.finish()?;
    let value = number.constant(&|_| None).filter(|value| value.is_finite()).ok_or_else(|| {
        cursor.error_since(0, "this is not known before the flight", "write a number with its unit")
    })?;
    Ok((value, dimension))
}

impl Number {
    /// Returns the value of a number of literals and known names; `None` if it has other parts.
    pub fn constant(&self, names: &impl Fn(&str) -> Option<f64>) -> Option<f64> {
        match self {
            Self::Literal(value, _) => Some(*value),
            Self::Name(name) => names(name),
            Self::Negative(inner) => inner.constant(names).map(|value| -value),
            Self::Join(operator, left, right) => {
                Some(operator.apply(left.constant(names)?, right.constant(names)?))
            }
            _ => None,
        }
    }
}

impl Operator {
    pub(super) fn apply(self, left: f64, right: f64) -> f64 {
        match self {
            Self::Add => left + right,
            Self::Subtract => left - right,
            Self::Multiply => left * right,
            Self::Divide => left / right,
            Self::Remainder => left.rem_euclid(right),
        }
    }
}
