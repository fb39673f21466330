//! Filter and search of the Log panel.

use crossterm::event::{KeyCode, KeyEvent};

use super::shared::Shared;
use super::text_field::TextField;
use crate::ui::model::action::{Action, PanelAction};
use crate::ui::model::event_log::{LogLine, LogState, Severity};
use crate::ui::model::message::{Change, Request};

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
    /// The first visible line, counted from the newest.
    pub scroll: usize,
}

impl LogView {
    /// Returns `true` if a line passes the filter.
    fn passes(&self, line: &LogLine) -> bool {
        FILTERS.get(self.filter).is_none_or(|(least, _)| line.severity >= *least)
    }

    /// Returns `true` if a line passes the filter and has the searched text.
    fn shows(&self, line: &LogLine) -> bool {
        self.passes(line) && (self.search.is_empty() || self.find_in(&line.text).is_some())
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

    /// Returns the shown lines, the newest first.
    pub(super) fn newest_first<'a>(
        &'a self,
        log: &'a LogState,
    ) -> impl DoubleEndedIterator<Item = &'a LogLine> {
        log.newest_first().filter(|line| self.shows(line))
    }

    /// Returns the number of newest lines left out while an earlier instant is shown: all later ones but one.
    pub(super) fn later_above(&self, state: &Shared) -> usize {
        let later =
            self.newest_first(&state.log).take_while(|entry| state.is_later_than_shown(entry.time)).count();
        later.saturating_sub(1)
    }

    /// Selects the next filter; the widest follows the narrowest.
    pub(super) fn cycle_filter(&mut self) {
        self.filter = (self.filter + 1) % FILTERS.len();
        self.scroll = 0;
    }

    pub(super) fn begin_search(&mut self) {
        self.search = TextField::default();
        self.typing = true;
        self.found = None;
    }

    /// Handles a key while the search is typed.
    pub(super) fn search_key(&mut self, state: &Shared, event: KeyEvent) {
        match event.code {
            KeyCode::Esc => self.leave_search(state),
            KeyCode::Enter => self.typing = false,
            _ => {
                if self.search.key(event) {
                    self.found = None;
                    self.scroll = 0;
                    self.show_match(state, false);
                }
            }
        }
    }

    /// Ends the search. The line found last stays in view, among all lines.
    pub(super) fn leave_search(&mut self, state: &Shared) {
        let found = self.found;
        self.end_search();
        let place = self.newest_first(&state.log).position(|line| Some(line.number) == found);
        self.scroll = place.unwrap_or(0).saturating_sub(self.later_above(state));
    }

    pub(super) fn end_search(&mut self) {
        self.search = TextField::default();
        self.typing = false;
        self.found = None;
    }

    /// Scrolls to the next older or newer line with a match, and reports if there is none.
    pub(super) fn next_match(&mut self, state: &Shared, newer: bool) -> Vec<Request> {
        if self.search.is_empty() {
            let text = format!(
                "No search yet: `{}` in the log begins.",
                state.key(Action::Panel(PanelAction::Search))
            );
            vec![Change::Notify(Severity::Info, text).into()]
        } else if !self.show_match(state, newer) {
            let end = if newer { "newer" } else { "older" };
            let text = format!("No {end} line has {:?}.", self.search.value());
            // Not in the log, because that line would then match.
            vec![Change::Say(Severity::Info, text).into()]
        } else {
            Vec::new()
        }
    }

    /// Scrolls to the match after the last one. Returns `true` if there is one.
    fn show_match(&mut self, state: &Shared, newer: bool) -> bool {
        let last = self.found;
        let is_beyond = |number: u64| match (last, newer) {
            (None, _) => true,
            (Some(last), true) => number > last,
            (Some(last), false) => number < last,
        };
        let hit = {
            let mut hits = self
                .newest_first(&state.log)
                .enumerate()
                .filter(|(_, line)| is_beyond(line.number) && self.find_in(&line.text).is_some())
                .map(|(at, line)| (at, line.number));
            if newer { hits.last() } else { hits.next() }
        };
        let Some((at, number)) = hit else { return false };
        self.found = Some(number);
        self.scroll = at.saturating_sub(self.later_above(state));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;

    fn log() -> Shared {
        let mut state = Shared::bare((80, 24), SessionView::default());
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
        let (mut view, state) = (LogView::default(), log());
        for (count, name) in [(4, ""), (2, "warnings and faults"), (1, "faults"), (4, "")] {
            assert_eq!((view.newest_first(&state.log).count(), view.filter_name()), (count, name));
            view.cycle_filter();
        }
    }

    #[test]
    fn matches_are_found_from_the_newest_back_and_forth() {
        let state = log();
        let mut view = LogView { search: TextField::new("WIND"), ..LogView::default() };
        let text = |view: &LogView, state: &Shared| {
            let found = view.found;
            view.newest_first(&state.log)
                .find(|line| Some(line.number) == found)
                .map(|line| line.text.clone())
        };
        assert_eq!(view.newest_first(&state.log).count(), 2, "the lines with the text");
        view.next_match(&state, false);
        assert_eq!((text(&view, &state).as_deref(), view.scroll), (Some("wind two"), 0));
        view.next_match(&state, false);
        assert_eq!((text(&view, &state).as_deref(), view.scroll), (Some("Wind one"), 1));
        view.next_match(&state, false);
        assert_eq!(text(&view, &state).as_deref(), Some("Wind one"), "it is the oldest");
        view.next_match(&state, true);
        assert_eq!(text(&view, &state).as_deref(), Some("wind two"));
        view.leave_search(&state);
        assert_eq!((view.scroll, view.newest_first(&state.log).count()), (1, 4), "it stays in view");
    }

    #[test]
    fn a_match_is_found_in_any_text() {
        let view = LogView { search: TextField::new("é°"), ..LogView::default() };
        assert_eq!(view.find_in("a é° b"), Some(2..6));
        assert_eq!(view.find_in("é"), None);
        assert_eq!(LogView::default().find_in("x"), None);
    }
}
