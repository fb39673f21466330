//! Instants: an event, the choice among several such events, and an offset in time.

use strum::IntoEnumIterator as _;

use super::condition::read_condition;
use super::cursor::{Cursor, SyntaxError};
use super::evaluate::Evaluator;
use super::number::read_number;
use super::place::waypoints;
use super::{Anchor, Instant, Number, Occurrence, Scope};
use crate::scenario::happening::{EVENTS, EventName, Pattern, REFUSALS, mode_word};
use crate::telemetry::quantity::Dimension;
use crate::telemetry::{Mode, NavState, PlanSource, TransitionReason};

/// The origins of a plan with their words.
pub(super) const SOURCES: [(&str, PlanSource); 3] =
    [("stored", PlanSource::Stored), ("rth", PlanSource::Rth), ("emergency", PlanSource::Emergency)];

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

/// Reads an instant: `5 s after ORBITING 2`, `contact`, `when north > 70 m`.
///
/// # Errors
/// Returns the mistake in the text.
pub fn read_instant(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<Instant, SyntaxError> {
    cursor.nested(|cursor| {
        let offset_s = if cursor.rest().starts_with(|c: char| c.is_ascii_digit()) {
            let start = cursor.at();
            let seconds = duration(cursor, scope, start)?;
            direction(cursor)? * seconds
        } else {
            0.0
        };
        let mut instant = read_anchor(cursor, scope)?;
        instant.offset_s += offset_s;
        Ok(instant)
    })
}

/// Reads a span of time counted from an instant: `12.5..18 s after engaged`.
///
/// # Errors
/// Returns the mistake in the text.
pub fn read_span_from(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<(f64, f64, Instant), SyntaxError> {
    let start = cursor.at();
    let low = read_number(cursor, scope)?;
    cursor.expect("..")?;
    let high = read_number(cursor, scope)?;
    let (low, high) = super::number::share_unit(low, high);
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
    let instant = read_instant(cursor, scope)?;
    Ok(if sign > 0.0 { (from, to, instant) } else { (-to, -from, instant) })
}

fn duration(cursor: &mut Cursor<'_>, scope: &Scope, start: usize) -> Result<f64, SyntaxError> {
    match read_number(cursor, scope)? {
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
        Anchor::When(read_condition(cursor, scope)?)
    } else {
        Anchor::Happening(read_pattern(cursor, scope)?)
    };
    let after = if cursor.take_keyword("after") {
        Some(Box::new(cursor.nested(|cursor| read_instant(cursor, scope))?))
    } else {
        None
    };
    Ok(Instant { anchor, occurrence, after, offset_s: 0.0 })
}

/// Reads the pattern of a happening: `ARRIVED 2`, `LANDING of emergency`, `disarmed LANDING`, `notice "text"`.
///
/// # Errors
/// Returns the mistake in the text.
pub fn read_pattern(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<Pattern, SyntaxError> {
    let Some(word) = cursor.peek_word() else {
        return Err(cursor.unknown("an event or a state", event_words()));
    };
    cursor.term()?;
    if NavState::iter().any(|state| word == <&str>::from(state)) {
        let state = read_state_word(cursor)?;
        let start = cursor.at();
        let index = cursor.take_index();
        let source = read_source(cursor)?;
        check_waypoint(cursor, scope, start, index, source)?;
        let reason = if cursor.take_keyword("by") { Some(read_reason(cursor)?) } else { None };
        return Ok(Pattern::State { state, wp: index, source, reason });
    }
    let Some(info) = EVENTS.iter().find(|info| info.name == word) else {
        return Err(cursor.unknown("an event or a state", event_words()));
    };
    cursor.take_word(word);
    let allowed = if info.event == EventName::Input { scope.inputs.clone() } else { info.event.words() };
    let mut words = Vec::new();
    while let Some(word) = cursor.peek_argument() {
        let Some(known) = allowed.iter().find(|known| known.eq_ignore_ascii_case(word)) else {
            // Words of the surrounding sentence do not belong to the event.
            if ["after", "before", "and", "or", "by", "of"].contains(&word) {
                break;
            }
            let what = format!("a word for {}", info.name);
            return Err(cursor.unknown(&what, allowed.iter().map(String::as_str)));
        };
        cursor.term()?;
        cursor.take_word(word);
        words.push(known.clone());
    }
    let text = cursor.take_quoted()?.map(str::to_owned);
    Ok(Pattern::Event { name: info.event, words, text })
}

fn event_words() -> impl Iterator<Item = &'static str> + Clone {
    let states: Vec<&'static str> = NavState::iter().map(<&str>::from).collect();
    EVENTS.iter().map(|info| info.name).chain(states)
}

/// Reads the words for the cause of a transition.
fn read_reason(cursor: &mut Cursor<'_>) -> Result<String, SyntaxError> {
    let start = cursor.clone();
    let Some(reason) =
        cursor.take_quoted()?.or_else(|| cursor.peek_argument().inspect(|word| cursor.take_word(word)))
    else {
        return Err(cursor.error("the reason is missing", "write by resume, or by 'turn radius'"));
    };
    let reasons = || TransitionReason::WORDS.into_iter().chain(REFUSALS);
    if reasons().any(|known| known.eq_ignore_ascii_case(reason)) {
        return Ok(reason.to_owned());
    }
    Err(start.unknown("the reason of a transition", reasons()))
}

/// Reads the name of a state.
pub(super) fn read_state_word(cursor: &mut Cursor<'_>) -> Result<NavState, SyntaxError> {
    let word = cursor.peek_word().unwrap_or_default();
    let Some(state) = NavState::iter().find(|&state| word == <&str>::from(state)) else {
        return Err(
            cursor.unknown("a state", NavState::iter().map(<&str>::from).collect::<Vec<_>>().into_iter())
        );
    };
    cursor.take_word(word);
    Ok(state)
}

/// Reads the index of a waypoint, if it comes next.
pub(super) fn read_waypoint(
    cursor: &mut Cursor<'_>,
    scope: &Scope,
    source: Option<PlanSource>,
) -> Result<Option<u8>, SyntaxError> {
    let start = cursor.at();
    let index = cursor.take_index();
    check_waypoint(cursor, scope, start, index, source)?;
    Ok(index)
}

/// Checks that the plan has a waypoint. A plan made by the firmware itself has at most two.
fn check_waypoint(
    cursor: &Cursor<'_>,
    scope: &Scope,
    start: usize,
    index: Option<u8>,
    source: Option<PlanSource>,
) -> Result<(), SyntaxError> {
    let Some(index) = index else { return Ok(()) };
    let (count, allowed) = match source {
        Some(PlanSource::Rth) => (2, "a return home has the waypoints 0 and 1".to_owned()),
        Some(PlanSource::Emergency) => (1, "an emergency landing has the waypoint 0".to_owned()),
        Some(PlanSource::Stored) | None => (scope.waypoints.max(2), waypoints(scope)),
    };
    if usize::from(index) < count {
        return Ok(());
    }
    Err(cursor.error_since(start, format!("the plan has no waypoint {index}"), allowed))
}

/// Reads `of rth`, if it comes next.
pub(super) fn read_source(cursor: &mut Cursor<'_>) -> Result<Option<PlanSource>, SyntaxError> {
    if !cursor.take_keyword("of") {
        return Ok(None);
    }
    let word = cursor.peek_word().unwrap_or_default();
    let Some(&(_, source)) = SOURCES.iter().find(|(name, _)| *name == word) else {
        return Err(cursor.unknown("the origin of a plan", SOURCES.iter().map(|(name, _)| *name)));
    };
    cursor.take_word(word);
    Ok(Some(source))
}

/// Reads the name of a mode, as one word: `POS_HOLD`.
pub(in crate::scenario) fn mode_of(cursor: &mut Cursor<'_>) -> Result<Mode, SyntaxError> {
    let word = cursor.peek_word().unwrap_or_default();
    let Some(mode) = Mode::iter().find(|&mode| mode_word(mode).eq_ignore_ascii_case(word)) else {
        let words: Vec<String> = Mode::iter().map(mode_word).collect();
        return Err(cursor.unknown("a mode", words.iter().map(String::as_str)));
    };
    cursor.take_word(word);
    Ok(mode)
}

/// A search for an instant in a flight, also during the flight. It looks at each sample or happening only once.
#[derive(Debug)]
pub struct Search<'a> {
    instant: &'a Instant,
    after: Option<Box<Search<'a>>>,
    progress: Progress,
}

/// The state of a search.
#[derive(Debug)]
pub(super) struct Progress {
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
    pub(super) fn new(wanted: Occurrence) -> Self {
        Self { looked_at: 0, seen: 0, wanted, held: false, found_us: None }
    }

    /// Returns the time of the instant if it is known, µs since boot.
    pub(super) fn result(&self, instant: &Instant) -> Option<i64> {
        self.found_us.map(|us| us + (instant.offset_s * 1e6).round() as i64)
    }

    /// Looks at the new part of the flight. Matches before `earliest`, µs since boot, do not count.
    pub(super) fn look(&mut self, instant: &Instant, earliest: i64, evaluator: &Evaluator<'_>) {
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
