//! Filter and search of the Log panel.

use crossterm::event::{KeyCode, KeyEvent};

use super::action::Action;
use super::app_state::AppState;
use super::event_log::{LogLine, Severity};
use super::message::Effect;
use super::text_field::TextField;

/// The filters, the widest first, with their names in the title.
const FILTERS: [(Severity, &str); 3] =
    [(Severity::Info, ""), (Severity::Warn, "warnings and faults"), (Severity::Fault, "faults")];

/// Search and filter of the Log panel.
#[derive(Debug, Default)]
pub struct LogView {
    pub search: TextField,
    /// `true` while the search is being typed.
    pub typing: bool,
    /// The number of the line found last, as in [`LogLine::number`].
    pub found: Option<u64>,
    filter: usize,
}

impl LogView {
    /// Returns `true` if a line passes the filter.
    fn shows(&self, line: &LogLine) -> bool {
        FILTERS.get(self.filter).is_none_or(|(least, _)| line.severity >= *least)
    }

    /// Returns the name of the filter; empty if it shows all lines.
    pub fn filter_name(&self) -> &'static str {
        FILTERS.get(self.filter).map_or("", |(_, name)| name)
    }

    /// Returns the byte range of the first match in a text; `None` if there is no match or no search.
    pub fn find_in(&self, text: &str) -> Option<std::ops::Range<usize>> {
        let wanted = self.search.value();
        if wanted.is_empty() {
            return None;
        }
        let is_here =
            |at: usize| text.get(at..at + wanted.len()).is_some_and(|part| part.eq_ignore_ascii_case(wanted));
        text.char_indices().map(|(at, _)| at).find(|&at| is_here(at)).map(|at| at..at + wanted.len())
    }
}

/// Returns the shown lines, the newest first.
pub(super) fn newest_first(state: &AppState) -> impl DoubleEndedIterator<Item = &LogLine> {
    state.log.newest_first().filter(|line| state.log_view.shows(line))
}

/// Returns the number of newest lines left out while an earlier instant is shown: all later ones but one.
pub(super) fn later_above(state: &AppState) -> usize {
    let later = newest_first(state).take_while(|entry| state.is_later_than_shown(entry.time)).count();
    later.saturating_sub(1)
}

/// Selects the next filter; the widest follows the narrowest.
pub(super) fn cycle_filter(state: &mut AppState) -> Vec<Effect> {
    state.log_view.filter = (state.log_view.filter + 1) % FILTERS.len();
    state.scrolls.log = 0;
    Vec::new()
}

pub(super) fn begin_search(state: &mut AppState) -> Vec<Effect> {
    state.log_view.search = TextField::default();
    state.log_view.typing = true;
    state.log_view.found = None;
    Vec::new()
}

/// Handles a key while the search is typed.
pub(super) fn search_key(state: &mut AppState, event: KeyEvent) -> Vec<Effect> {
    match event.code {
        KeyCode::Esc => end_search(state),
        KeyCode::Enter => state.log_view.typing = false,
        _ => {
            if state.log_view.search.key(event) {
                state.log_view.found = None;
                show_match(state, false);
            }
        }
    }
    Vec::new()
}

pub(super) fn end_search(state: &mut AppState) {
    state.log_view.search = TextField::default();
    state.log_view.typing = false;
    state.log_view.found = None;
}

/// Scrolls to the next older or newer line with a match, and reports if there is none.
pub(super) fn next_match(state: &mut AppState, newer: bool) -> Vec<Effect> {
    if state.log_view.search.is_empty() {
        let text = format!("No search yet: `{}` in the log begins.", state.key(Action::Search));
        state.notify(Severity::Info, text);
    } else if !show_match(state, newer) {
        let end = if newer { "newer" } else { "older" };
        let text = format!("No {end} line has {:?}.", state.log_view.search.value());
        // Not in the log, because that line would then match.
        state.say(Severity::Info, text);
    }
    Vec::new()
}

/// Scrolls to the match after the last one. Returns `true` if there is one.
fn show_match(state: &mut AppState, newer: bool) -> bool {
    let last = state.log_view.found;
    let is_beyond = |number: u64| match (last, newer) {
        (None, _) => true,
        (Some(last), true) => number > last,
        (Some(last), false) => number < last,
    };
    let hit = {
        let mut hits = newest_first(state)
            .enumerate()
            .filter(|(_, line)| is_beyond(line.number) && state.log_view.find_in(&line.text).is_some())
            .map(|(at, line)| (at, line.number));
        if newer { hits.last() } else { hits.next() }
    };
    let Some((at, number)) = hit else { return false };
    state.log_view.found = Some(number);
    state.scrolls.log = at.saturating_sub(later_above(state));
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;

    fn log() -> AppState {
        let mut state = AppState::bare((80, 24), SessionView::default());
        for (severity, text) in [
            (Severity::Info, "Wind one"),
            (Severity::Warn, "the fix is gone"),
            (Severity::Fault, "wind two"),
            (Severity::Good, "over"),
        ] {
            state.notify(severity, text);
        }
        state
    }

    #[test]
    fn the_filter_leaves_what_is_serious_enough() {
        let mut state = log();
        for (count, name) in [(4, ""), (2, "warnings and faults"), (1, "faults"), (4, "")] {
            assert_eq!((newest_first(&state).count(), state.log_view.filter_name()), (count, name));
            cycle_filter(&mut state);
        }
    }

    #[test]
    fn matches_are_found_from_the_newest_back_and_forth() {
        let mut state = log();
        state.log_view.search = TextField::new("WIND");
        let text = |state: &AppState| {
            let found = state.log_view.found;
            newest_first(state).find(|line| Some(line.number) == found).map(|line| line.text.clone())
        };
        next_match(&mut state, false);
        assert_eq!((text(&state).as_deref(), state.scrolls.log), (Some("wind two"), 1));
        next_match(&mut state, false);
        assert_eq!((text(&state).as_deref(), state.scrolls.log), (Some("Wind one"), 3));
        next_match(&mut state, false);
        assert_eq!(text(&state).as_deref(), Some("Wind one"), "it is the oldest");
        next_match(&mut state, true);
        assert_eq!(text(&state).as_deref(), Some("wind two"));
    }

    #[test]
    fn a_match_is_found_in_any_text() {
        let view = LogView { search: TextField::new("é°"), ..LogView::default() };
        assert_eq!(view.find_in("a é° b"), Some(2..6));
        assert_eq!(view.find_in("é"), None);
        assert_eq!(LogView::default().find_in("x"), None);
    }
}
