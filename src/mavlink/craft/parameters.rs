//! The parameters of a craft.

use std::time::Duration;

use super::super::message::{ParamRequestRead, ParamValue};
use super::super::wire::Text;

/// The type of all parameters, `MAV_PARAM_TYPE_REAL32`.
const REAL32: u8 = 9;
/// The time between two parameters of a list, so that it does not displace telemetry.
const PACE: Duration = Duration::from_millis(5);
/// The number of parameters that one call sends at most, when the last call is long ago.
const BURST: usize = 10;

/// A parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// The name, at most 16 bytes. Longer names are cut.
    pub name: String,
    /// The value.
    pub value: f32,
}

/// The progress of a list.
#[derive(Debug, Clone, Copy)]
pub(super) struct ListCursor {
    /// The index of the next parameter.
    next: usize,
    /// The wall-clock time at which it is due.
    due: Duration,
}

/// The table of parameters.
#[derive(Debug, Clone, Default)]
pub(super) struct Parameters(Vec<(Text<16>, f32)>);

impl Parameters {
    pub(super) fn new(table: &[Parameter]) -> Self {
        let limit = usize::from(u16::MAX);
        Self(
            table.iter().take(limit).map(|parameter| (Text::new(&parameter.name), parameter.value)).collect(),
        )
    }

    /// Returns the message about a parameter.
    pub(super) fn message(&self, index: usize) -> Option<ParamValue> {
        let &(param_id, param_value) = self.0.get(index)?;
        let (param_count, param_index) = (self.0.len() as u16, index as u16);
        Some(ParamValue { param_value, param_count, param_index, param_id, param_type: REAL32 })
    }

    pub(super) fn find(&self, name: &Text<16>) -> Option<usize> {
        self.0.iter().position(|(known, _)| known.as_bytes() == name.as_bytes())
    }

    /// Returns the index of the parameter that a ground station asks for.
    pub(super) fn asked(&self, request: &ParamRequestRead) -> Option<usize> {
        usize::try_from(request.param_index).ok().or_else(|| self.find(&request.param_id))
    }

    pub(super) fn name(&self, index: usize) -> String {
        self.0.get(index).map_or_else(String::new, |(name, _)| name.to_string())
    }

    /// Replaces a value. Returns `false` if it is the same.
    pub(super) fn set(&mut self, index: usize, value: f32) -> bool {
        let Some((_, old)) = self.0.get_mut(index) else { return false };
        std::mem::replace(old, value) != value
    }

    /// Returns the indices of the parameters that differ from those of an older table with the same names, or none if the
    /// names differ.
    pub(super) fn changes_since(&self, old: &Self) -> Vec<usize> {
        let pairs = || self.0.iter().zip(&old.0);
        if self.0.len() != old.0.len() || pairs().any(|(new, old)| new.0 != old.0) {
            return Vec::new();
        }
        pairs().enumerate().filter(|(_, (new, old))| new.1 != old.1).map(|(at, _)| at).collect()
    }

    /// Returns the messages of a list that are due, and the progress after them; `None` at the end.
    pub(super) fn due(&self, cursor: ListCursor, now: Duration) -> (Vec<ParamValue>, Option<ListCursor>) {
        if self.0.is_empty() {
            // Without an answer a ground station asks for seconds.
            return (vec![ParamValue { param_type: REAL32, ..ParamValue::default() }], None);
        }
        let Some(late) = now.checked_sub(cursor.due) else { return (Vec::new(), Some(cursor)) };
        let count = BURST.min((late.as_millis() / PACE.as_millis()) as usize + 1);
        let next = cursor.next + count;
        let due = if count < BURST { cursor.due.saturating_add(PACE * count as u32) } else { now };
        let messages = (cursor.next..next).filter_map(|at| self.message(at)).collect();
        (messages, (next < self.0.len()).then_some(ListCursor { next, due }))
    }
}

impl ListCursor {
    pub(super) fn new(now: Duration) -> Self {
        Self { next: 0, due: now }
    }
}
