//! The instants inside expressions that were looked up so far.
//!
//! During a flight each lookup goes on where it was at the previous sample. It begins again only if an instant that it
//! uses has changed, so that it finds what a lookup in the whole flight up to now would find.

use std::cell::RefCell;
use std::collections::BTreeMap;

use super::evaluate::Evaluator;
use super::instant::Progress;
use super::{Anchor, Instant, Number, Occurrence, Place};

/// The lookups of a flight by the addresses of their instants, which stay where they are meanwhile.
#[derive(Debug, Default)]
pub struct Lookups(RefCell<BTreeMap<usize, Lookup>>);

#[derive(Debug)]
struct Lookup {
    /// The samples and happenings of the flight at the last look.
    seen: (usize, usize),
    progress: Progress,
    /// The instants that the instant itself uses, in their order.
    used: Vec<Option<i64>>,
    found_us: Option<i64>,
}

impl Lookup {
    fn new(instant: &Instant) -> Self {
        let progress = Progress::new(instant.occurrence);
        Self { seen: (0, 0), progress, used: Vec::new(), found_us: None }
    }
}

impl Lookups {
    /// Returns the time of an instant in the flight so far, µs since boot; `None` if it did not come.
    pub(super) fn find(&self, instant: &Instant, evaluator: &Evaluator<'_>) -> Option<i64> {
        let (samples, happenings) = (&evaluator.trace().samples, &evaluator.trace().happenings);
        let seen = (samples.len(), happenings.len());
        let key = std::ptr::from_ref(instant).addr();
        if let Some(known) = self.0.borrow().get(&key).filter(|known| known.seen == seen) {
            return known.found_us;
        }
        let before = self.0.borrow_mut().remove(&key);
        let mut used = Vec::new();
        instant.each_used(&mut |inner| used.push(evaluator.instant(inner)));
        let mut lookup = before.filter(|before| before.used == used).unwrap_or_else(|| Lookup::new(instant));
        let earliest = instant.after.as_deref().map_or(Some(i64::MIN), |after| evaluator.instant(after));
        let is_final = lookup.found_us.is_some() && matches!(instant.occurrence, Occurrence::Nth(_));
        if let Some(earliest) = earliest.filter(|_| !is_final || instant.anchor == Anchor::Last) {
            lookup.progress.look(instant, earliest, evaluator);
        }
        let found_us = lookup.progress.result(instant);
        self.0.borrow_mut().insert(key, Lookup { seen, used, found_us, ..lookup });
        found_us
    }
}

impl Instant {
    /// Visits the instants that this one uses itself.
    fn each_used(&self, visit: &mut impl FnMut(&Self)) {
        if let Some(after) = &self.after {
            visit(after);
        }
        if let Anchor::When(condition) = &self.anchor {
            condition.each_number(&mut |number| number.each_used(visit));
        }
    }
}

impl Number {
    /// Visits the instants of a number, without those of its parts.
    fn each_used(&self, visit: &mut impl FnMut(&Instant)) {
        let places: [Option<&Place>; 2] = match self {
            Self::Since(instant) | Self::At(_, instant) => return visit(instant),
            Self::Distance(place) | Self::Bearing(place) => [Some(place), None],
            Self::Apart(from, to) | Self::Along(from, to) | Self::Across(from, to) | Self::Past(from, to) => {
                [Some(from), Some(to)]
            }
            _ => [None, None],
        };
        for place in places.into_iter().flatten() {
            if let Place::CraftAt(instant) = place {
                visit(instant);
            }
        }
    }
}
