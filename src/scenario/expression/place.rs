//! Places on the ground and lines between them.

use super::cursor::{Cursor, SyntaxError};
use super::pattern::{read_source, waypoints};
use super::{Place, Scope};
use crate::telemetry::PlanSource;

/// The forms of a place, for messages.
const PLACES: &str = "write home, wp 2, 60 N 0 E, target, or place at ARRIVED 1";

impl Scope {
    pub(super) fn read_place(&self, cursor: &mut Cursor<'_>) -> Result<Place, SyntaxError> {
        cursor.term()?;
        if cursor.take_keyword("home") {
            return Ok(Place::Home);
        }
        if cursor.take_keyword("target") {
            return Ok(Place::Target);
        }
        if cursor.take_keyword("place") {
            if !cursor.take_keyword("at") {
                return Err(cursor.error("at is expected here", "write place at ARRIVED 1"));
            }
            return cursor.nested(|cursor| Ok(Place::CraftAt(Box::new(self.read_instant(cursor)?))));
        }
        if cursor.take_keyword("wp") {
            let start = cursor.at();
            let Some(index) = cursor.take_index() else {
                return Err(cursor.error("the number of a waypoint is expected here", "write wp 2"));
            };
            let source = read_source(cursor)?.unwrap_or(PlanSource::Stored);
            if source == PlanSource::Stored && usize::from(index) >= self.waypoints {
                return Err(cursor.error_since(
                    start,
                    format!("the plan has no waypoint {index}"),
                    waypoints(self),
                ));
            }
            return Ok(Place::Waypoint(index, source));
        }
        let start = cursor.at();
        let north = read_offset(cursor, "N", "S")?;
        let east = read_offset(cursor, "E", "W")?;
        if !north.is_finite() || !east.is_finite() {
            return Err(cursor.error_since(start, "this place is too far away", PLACES));
        }
        Ok(Place::Offset(north, east))
    }
}

/// Reads `60 N` or `60 S`.
fn read_offset(cursor: &mut Cursor<'_>, positive: &str, negative: &str) -> Result<f64, SyntaxError> {
    let minus = cursor.take("-");
    let Some(size) = cursor.take_decimal() else {
        return Err(cursor.error("a place is expected here", PLACES));
    };
    let size = if minus { -size } else { size };
    let _metres = cursor.take_keyword("m");
    if cursor.take_keyword(positive) {
        Ok(size)
    } else if cursor.take_keyword(negative) {
        Ok(-size)
    } else {
        Err(cursor.error(
            format!("{positive} or {negative} is expected here"),
            "write 60 N 0 E, metres from the boot place",
        ))
    }
}

/// Reads a line from one place to another.
pub(super) fn read_line(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<(Place, Place), SyntaxError> {
    let from = scope.read_place(cursor)?;
    if !cursor.take("->") {
        return Err(cursor.error("-> is expected here", "write the line as wp 0 -> wp 1"));
    }
    Ok((from, scope.read_place(cursor)?))
}
