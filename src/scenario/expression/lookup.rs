//! Searches for instants in a flight, and the instants inside expressions that were looked up so far.
//!
//! During a flight each lookup goes on where it was at the previous sample. It begins again only if an instant that it
//! uses has changed, so that it finds what a lookup in the whole flight up to now would find.

use std::cell::RefCell;
use std::collections::BTreeMap;

use super::evaluate::Evaluator;
use super::{Anchor, Instant, Number, Occurrence, Place};

/// A search for an instant in a flight, also during the flight. It looks at each sample or happening only once.
#[derive(Debug)]
pub struct Search<'a> {
    instant: &'a Instant,
    after: Option<Box<Search<'a>>>,
    progress: Progress,
}

/// The state of a search.
#[derive(Debug)]
struct Progress {
    /// The number of samples or happenings looked at.
    looked_at: usize,
    /// The number of matches so far.
    seen: usize,
    /// The wanted match.
    wanted: Occurrence,
    /// `true` if the condition held at the previous sample.
    held: bool,
    /// The time of the match without the offset, µs since boot.
    found_us: Option<i64>,
}

impl<'a> Search<'a> {
    /// Creates a search that has looked at nothing yet.
    pub fn new(instant: &'a Instant) -> Self {
        let after = instant.after.as_deref().map(|after| Box::new(Search::new(after)));
        Self { instant, after, progress: Progress::new(instant.occurrence) }
    }

    /// Looks for the next match after the one that was found.
    pub(in crate::scenario) fn go_on(&mut self) {
        self.progress.found_us = None;
        self.progress.wanted = Occurrence::Nth(self.progress.seen + 1);
    }

    /// Looks at the new part of the flight. Returns the time of the instant if it is known, µs since boot.
    pub fn advance(&mut self, evaluator: &Evaluator<'_>) -> Option<i64> {
        if self.progress.found_us.is_none() {
            let earliest = match &mut self.after {
                None => i64::MIN,
                Some(after) => after.advance(evaluator)?,
            };
            self.progress.look(self.instant, earliest, evaluator);
        }
        self.progress.result(self.instant)
    }
}

impl Progress {
    /// Creates the state of a search that has looked at nothing yet.
    fn new(wanted: Occurrence) -> Self {
        Self { looked_at: 0, seen: 0, wanted, held: false, found_us: None }
    }

    /// Returns the time of the instant if it is known, µs since boot.
    fn result(&self, instant: &Instant) -> Option<i64> {
        self.found_us.map(|us| us + (instant.offset_s * 1e6).round() as i64)
    }

    /// Looks at the new part of the flight. Matches before `earliest`, µs since boot, do not count.
    fn look(&mut self, instant: &Instant, earliest: i64, evaluator: &Evaluator<'_>) {
        let trace = evaluator.trace();
        match &instant.anchor {
            Anchor::Boot => self.found_us = Some(0),
            Anchor::Last => self.found_us = Some(trace.end().0 as i64),
            Anchor::Happening(pattern) => {
                for happening in trace.happenings.get(self.looked_at..).unwrap_or_default() {
                    let time = happening.time.0 as i64;
                    self.looked_at += 1;
                    if time >= earliest && pattern.matches(happening) && self.is_it(time) {
                        break;
                    }
                }
            }
            Anchor::When(condition) => {
                for index in self.looked_at..trace.samples.len() {
                    let time = trace.samples[index].time.0 as i64;
                    self.looked_at = index + 1;
                    if time < earliest {
                        continue;
                    }
                    let holds = evaluator.holds(condition, index) == Some(true);
                    let became = holds && !self.held;
                    self.held = holds;
                    if became && self.is_it(time) {
                        break;
                    }
                }
            }
        }
    }

    /// Counts a match. Returns `true` if the search is over.
    fn is_it(&mut self, time_us: i64) -> bool {
        self.seen += 1;
        match self.wanted {
            Occurrence::Nth(nth) if nth == self.seen => {
                self.found_us = Some(time_us);
                true
            }
            Occurrence::Nth(_) => false,
            Occurrence::Last => {
                self.found_us = Some(time_us);
                false
            }
        }
    }
}

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
