//! Patterns of happenings, and the words for states, modes, origins and waypoints.

use strum::IntoEnumIterator as _;

use super::Scope;
use super::cursor::{Cursor, SyntaxError};
use crate::scenario::happening::{EVENTS, EventName, Pattern, REFUSALS, mode_word};
use crate::telemetry::{Mode, NavState, PlanSource, TransitionReason};

/// The origins of a plan with their words.
pub(super) const SOURCES: [(&str, PlanSource); 3] =
    [("stored", PlanSource::Stored), ("rth", PlanSource::Rth), ("emergency", PlanSource::Emergency)];

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

/// Returns the allowed indices of the plan, for messages.
pub(super) fn waypoints(scope: &Scope) -> String {
    match scope.waypoints {
        0 => "it is empty".to_owned(),
        count => format!("allowed: 0 to {}", count - 1),
    }
}
