//! 8 Log: every event and notice, the newest on top, with search and filter.

use crossterm::event::KeyEvent;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span};

use super::{Content, Hint};
use crate::ui::formatting::clock_ms;
use crate::ui::log_view::LogView;
use crate::ui::model::action::{Action, PanelAction};
use crate::ui::model::event_log::{LogLine, Severity};
use crate::ui::model::message::Request;
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;
use crate::ui::theme::Role;

use super::content::scrolled;
use crate::ui::area::{line, row, span};
use crate::ui::text_wrap::{fitting, wrapped};

/// The width of time and mark before the text.
const STAMP: usize = 12;

/// The number of lines shown in words.
const LINES_IN_WORDS: usize = 20;

/// The state of the Log panel.
#[derive(Debug, Default)]
pub struct LogPanel {
    pub view: LogView,
}

impl Content for LogPanel {
    /// Returns the title with the number of lines above the first shown one, the filter and the search.
    fn title(&self, state: &Shared) -> String {
        let view = &self.view;
        let mut title = state.panel_title(Panel::Log).to_owned();
        let newer = match view.scroll {
            0 => String::new(),
            newer => format!("{newer} newer above"),
        };
        let search = if view.search.is_empty() || view.typing {
            String::new()
        } else {
            format!("/{}", view.search.value())
        };
        for part in [view.filter_name(), &search, &newer] {
            if !part.is_empty() {
                title.push_str(" — ");
                title.push_str(part);
            }
        }
        title
    }

    /// Draws the inside. Returns the position of the cursor while a search is typed.
    fn draw(&self, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let view = &self.view;
        let theme = &state.theme;
        let list = list(view, state, area);
        draw_lines(view, state, list, buffer);
        if list.height == area.height {
            return None;
        }
        row(buffer, area, list.height, theme, Role::Key, "/");
        let field =
            Rect { x: area.x + 1, y: area.y + list.height, width: area.width.checked_sub(1)?, height: 1 };
        view.search.draw(theme, field.intersection(area), buffer)
    }

    /// Returns the first lines of the list; the keys of lists scroll it.
    fn in_words(&self, state: &Shared) -> Vec<String> {
        let view = &self.view;
        if view.newest_first(&state.log).next().is_none() {
            return vec![no_lines(view, state)];
        }
        let lines = view.newest_first(&state.log).skip(view.scroll + view.later_above(state));
        lines.take(LINES_IN_WORDS).map(|line| in_words(state, line)).collect()
    }

    fn hints(&self, _: &Shared) -> Vec<Hint> {
        vec![
            (&[Action::Panel(PanelAction::Search)], "search"),
            (&[Action::Panel(PanelAction::Filter)], "filter"),
        ]
    }

    fn act(&mut self, state: &Shared, action: PanelAction) -> Vec<Request> {
        match action {
            PanelAction::Search => {
                self.view.begin_search();
                return vec![Request::Act(Action::Show(Panel::Log))];
            }
            PanelAction::NextMatch => return self.view.next_match(state, false),
            PanelAction::PreviousMatch => return self.view.next_match(state, true),
            PanelAction::Filter => self.view.cycle_filter(),
            _ => {}
        }
        Vec::new()
    }

    fn key(&mut self, state: &Shared, event: KeyEvent) -> Vec<Request> {
        self.view.search_key(state, event);
        Vec::new()
    }

    fn field(&mut self) -> Option<&mut TextField> {
        self.view.typing.then_some(&mut self.view.search)
    }

    fn close_field(&mut self) {
        self.view.end_search();
    }

    fn go_back(&mut self, state: &Shared) -> Option<Vec<Request>> {
        let has_search = !self.view.search.is_empty();
        has_search.then(|| {
            self.view.leave_search(state);
            Vec::new()
        })
    }

    fn scroll(&mut self, state: &Shared, area: Rect, by: isize) -> Vec<Request> {
        let last = last_scroll(&self.view, state, area);
        scrolled(&mut self.view.scroll, by, last);
        Vec::new()
    }
}

/// Returns the width of the text.
fn text_width(area: Rect) -> usize {
    usize::from(area.width).saturating_sub(STAMP)
}

/// Returns the area of the lines, without the row of a search that is being typed.
fn list(view: &LogView, state: &Shared, area: Rect) -> Rect {
    let search = u16::from(view.typing && state.focus == Panel::Log);
    Rect { height: area.height.saturating_sub(search), ..area }
}

/// Returns the greatest scroll position, at which the oldest line is the last on the screen.
fn last_scroll(view: &LogView, state: &Shared, area: Rect) -> usize {
    let rows = view.newest_first(&state.log).rev().map(|entry| wrapped(&entry.text, text_width(area)).len());
    let fitting = fitting(rows, usize::from(list(view, state, area).height));
    view.newest_first(&state.log).count().saturating_sub(fitting)
}

/// Returns the reason for an empty list.
fn no_lines(view: &LogView, state: &Shared) -> String {
    match (state.log.len(), view.filter_name()) {
        (0, _) => "Nothing has happened yet.".to_owned(),
        _ if !view.search.is_empty() => format!("No line has {:?}.", view.search.value()),
        (_, filter) => {
            format!("No {filter}: `{}` shows everything.", state.key(Action::Panel(PanelAction::Filter)))
        }
    }
}

/// Returns a line with its time and, if it is a warning or a fault, that word.
fn in_words(state: &Shared, line: &LogLine) -> String {
    let branch = if line.left_behind { "left branch: " } else { "" };
    let later = if state.is_later_than_shown(line.time) { "later: " } else { "" };
    let severity = match line.severity {
        Severity::Info | Severity::Step | Severity::Good => "",
        Severity::Warn => "warning: ",
        Severity::Fault => "fault: ",
    };
    format!("{} {branch}{later}{severity}{}", clock_ms(line.time), line.text)
}

fn draw_lines(view: &LogView, state: &Shared, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let mut entries = view.newest_first(&state.log).peekable();
    if entries.peek().is_none() {
        row(buffer, area, 0, theme, Role::Dim, &no_lines(view, state));
        return;
    }
    let first = (view.scroll + view.later_above(state)).min(last_scroll(view, state, area));
    let text_width = text_width(area);
    let mut at = 0;
    for entry in entries.skip(first) {
        let (mut mark, role) = match entry {
            LogLine { left_behind: true, .. } => ("╎", Role::Dim),
            later if state.is_later_than_shown(later.time) => (later.severity.glyph(), Role::Dim),
            LogLine { severity, .. } => (severity.glyph(), severity.role()),
        };
        let mut stamp = format!("{} ", clock_ms(entry.time));
        let is_found = view.found == Some(entry.number);
        for part in wrapped(&entry.text, text_width) {
            if at == area.height {
                return;
            }
            let mut spans = vec![
                span(theme, if is_found { Role::Focus } else { Role::Dim }, stamp),
                span(theme, role, format!("{mark} ")),
            ];
            spans.extend(highlighted(view, state, role, &part));
            line(buffer, area, at, &Line::from(spans));
            at += 1;
            (stamp, mark) = (" ".repeat(STAMP - 2), " ");
        }
    }
}

/// Returns a text with the match marked.
fn highlighted(view: &LogView, state: &Shared, role: Role, text: &str) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let Some(found) = view.find_in(text) else { return vec![span(theme, role, text)] };
    let (before, rest) = text.split_at(found.start);
    let (hit, after) = rest.split_at(found.len());
    vec![span(theme, role, before), span(theme, Role::Selected, hit), span(theme, role, after)]
}
