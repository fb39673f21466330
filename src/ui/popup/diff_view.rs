//! The popup that shows two versions beside each other: two plans, with a map, or two sets of settings.

use crossterm::event::{KeyCode, KeyEvent, MouseButton, MouseEvent, MouseEventKind};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span};

use crate::ui::acts::diff::{Against, Diff, DiffRow, Mark};
use crate::ui::acts::{diff, screen_layout};
use crate::ui::area::{line, row, span};
use crate::ui::formatting::cut;
use crate::ui::model::settings::comparison::Comparison;
use crate::ui::panel::map::compared;
use crate::ui::popup::frame::{framed, key_line};
use crate::ui::search::{Search, has_all};
use crate::ui::shared::Shared;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::Role;

/// The rows above the popup and below it.
const FREE: u16 = 2;
/// The inner width from which the map is beside the rows. In a narrower popup it is below them.
const WIDE: u16 = 110;
/// The least width of the rows beside the map.
const MIN_BESIDE: u16 = 78;
/// The greatest width of the labels.
const LABEL: usize = 24;
/// The rows of a page.
const PAGE: isize = 10;

/// The open comparison.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DiffView {
    against: Against,
    selected: usize,
    /// `true` to leave out equal rows.
    only_differences: bool,
    /// The words that a shown row has.
    pub(in crate::ui) search: Search,
    /// `true` if the map has the whole place.
    is_map: bool,
    /// `true` if the map had the whole place before the search.
    had_map: bool,
}

/// The result of a key or of the mouse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum DiffKey {
    Open,
    Left,
    /// Another comparison is shown, whose values may have to be read.
    Other(Against),
    /// Go to this waypoint in the table of the plan.
    Waypoint(usize),
}

impl DiffView {
    pub(in crate::ui) fn new(against: Against) -> Self {
        Self {
            against,
            selected: 0,
            only_differences: false,
            search: Search::default(),
            is_map: false,
            had_map: false,
        }
    }

    /// Shows another comparison.
    pub(in crate::ui) fn show(&mut self, against: Against) -> DiffKey {
        (self.against, self.selected) = (against, 0);
        DiffKey::Other(against)
    }

    /// Handles a key.
    pub(in crate::ui) fn key(&mut self, state: &Shared, event: KeyEvent) -> DiffKey {
        match event.code {
            KeyCode::Up => self.scroll(state, -1),
            KeyCode::Down => self.scroll(state, 1),
            KeyCode::PageUp => self.scroll(state, -PAGE),
            KeyCode::PageDown => self.scroll(state, PAGE),
            KeyCode::Enter if self.search.is_typing => self.search.is_typing = false,
            KeyCode::Esc if self.search.is_on() => {
                (self.search, self.selected) = (Search::default(), 0);
                self.is_map |= std::mem::take(&mut self.had_map);
            }
            _ if self.search.is_typing => {
                self.search.key(event);
                self.selected = 0;
            }
            KeyCode::Char('/') => {
                // The rows have the place while they are searched.
                (self.search, self.selected) = (Search::begun(), 0);
                self.had_map |= std::mem::take(&mut self.is_map);
            }
            KeyCode::Esc | KeyCode::Char('q' | 'V') => return DiffKey::Left,
            KeyCode::Char('k') => self.scroll(state, -1),
            KeyCode::Char('j') => self.scroll(state, 1),
            KeyCode::Char(' ') => self.scroll(state, PAGE),
            KeyCode::Home => self.scroll(state, isize::MIN),
            KeyCode::End => self.scroll(state, isize::MAX),
            KeyCode::Char('n') => self.next(state, false),
            KeyCode::Char('N') => self.next(state, true),
            KeyCode::Char('f') => {
                (self.only_differences, self.selected) = (!self.only_differences, 0);
            }
            KeyCode::Char('m') => self.is_map = !self.is_map,
            KeyCode::Tab => return self.next_tab(state, 1),
            KeyCode::BackTab => return self.next_tab(state, -1),
            KeyCode::Left | KeyCode::Char('h') => return self.other_version(state, false),
            KeyCode::Right | KeyCode::Char('l') => return self.other_version(state, true),
            KeyCode::Enter => {
                let rows = self.rows(state);
                let waypoint = rows.get(self.selected).and_then(|row| row.waypoint);
                return waypoint.map_or(DiffKey::Open, DiffKey::Waypoint);
            }
            _ => {}
        }
        DiffKey::Open
    }

    /// Handles the mouse: a click selects a tab or a row, a click outside closes, the wheel moves.
    pub(in crate::ui) fn mouse(&mut self, state: &Shared, event: MouseEvent) -> DiffKey {
        match event.kind {
            MouseEventKind::ScrollUp => self.scroll(state, -1),
            MouseEventKind::ScrollDown => self.scroll(state, 1),
            MouseEventKind::Down(MouseButton::Left) => {
                let place = place(Rect::new(0, 0, state.size.0, state.size.1));
                if !place.contains((event.column, event.row).into()) {
                    return DiffKey::Left;
                }
                let parts = Parts::of(screen_layout::inner(place), self, self.has_map(state));
                if event.row == parts.tabs.y {
                    let tab = self.tab_at(state, event.column.saturating_sub(parts.tabs.x));
                    return tab.map_or(DiffKey::Open, |tab| self.show(tab));
                }
                if parts.list.contains((event.column, event.row).into()) {
                    let rows = self.rows(state).len();
                    let at = self.first(rows, parts.list.height) + usize::from(event.row - parts.list.y);
                    self.selected = if at < rows { at } else { self.selected };
                }
            }
            _ => {}
        }
        DiffKey::Open
    }

    fn rows(&self, state: &Shared) -> Vec<DiffRow> {
        Diff::of(state, self.against).map_or_else(|_| Vec::new(), |diff| self.shown(diff.rows))
    }

    /// Returns the rows that are shown. The value of a row before it is found by the words of both, and keeps that row.
    fn shown(&self, mut rows: Vec<DiffRow>) -> Vec<DiffRow> {
        rows.retain(|row| !self.only_differences || row.mark != Mark::Same);
        let words = self.search.words();
        if words.is_empty() {
            return rows;
        }
        let groups = rows.chunk_by(|_, next| next.is_part);
        let found = groups.flat_map(|group| {
            let head = group.first().map(text_of).unwrap_or_default();
            let is_found = |row: &&DiffRow| has_all(&format!("{head} {}", text_of(row)), &words);
            let parts: Vec<&DiffRow> = group.iter().skip(1).filter(is_found).collect();
            let is_shown = !parts.is_empty() || has_all(&head, &words);
            group.iter().take(usize::from(is_shown)).chain(parts)
        });
        found.cloned().collect()
    }

    fn has_map(&self, state: &Shared) -> bool {
        Diff::of(state, self.against).is_ok_and(|diff| diff.plan.is_some())
    }

    fn scroll(&mut self, state: &Shared, by: isize) {
        let last = self.rows(state).len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(by).min(last);
    }

    /// Selects the next difference, of a search the next match, or the one before; the first follows the last.
    fn next(&mut self, state: &Shared, back: bool) {
        let rows = self.rows(state);
        let is_searched = self.search.is_on();
        let is_wanted = |at: &usize| {
            rows.get(*at).is_some_and(|row| is_searched || (row.mark != Mark::Same && !row.is_part))
        };
        let found = if back {
            (0..self.selected).rev().chain((self.selected..rows.len()).rev()).find(is_wanted)
        } else {
            (self.selected + 1..rows.len()).chain(0..rows.len()).find(is_wanted)
        };
        self.selected = found.unwrap_or(self.selected);
    }

    fn next_tab(&mut self, state: &Shared, step: isize) -> DiffKey {
        let tabs = diff::possible(state);
        let at = tabs.iter().position(|tab| is_same_tab(*tab, self.against)).unwrap_or(0);
        let to = at.checked_add_signed(step).unwrap_or(tabs.len() - 1);
        self.show(tabs[if to < tabs.len() { to } else { 0 }])
    }

    /// Compares with the revision before or after, or with other values of the settings.
    fn other_version(&mut self, state: &Shared, later: bool) -> DiffKey {
        match self.against {
            Against::Revision(from) => match diff::other_revision(state, from, later) {
                Some(revision) => self.show(Against::Revision(revision)),
                None => DiffKey::Open,
            },
            Against::Settings(comparison) => {
                let other = if later { comparison.other_next() } else { comparison.other_previous() };
                self.show(Against::Settings(other))
            }
            Against::Craft | Against::File => DiffKey::Open,
        }
    }

    /// Returns the first shown row.
    fn first(&self, rows: usize, height: u16) -> usize {
        let height = usize::from(height.max(1));
        self.selected.saturating_sub(height / 2).min(rows.saturating_sub(height))
    }

    fn tabs(&self, state: &Shared) -> Vec<(Against, String)> {
        let of = |tab: Against| {
            let is_shown = is_same_tab(tab, self.against);
            let mark = if is_shown { '▸' } else { ' ' };
            (if is_shown { self.against } else { tab }, format!("{mark}{}  ", name(tab)))
        };
        diff::possible(state).into_iter().map(of).collect()
    }

    fn tab_at(&self, state: &Shared, column: u16) -> Option<Against> {
        let mut end = 0;
        self.tabs(state).into_iter().find_map(|(tab, text)| {
            end += text.chars().count();
            (usize::from(column) < end).then_some(tab)
        })
    }
}

/// Returns the text of a row that is searched, in lower case.
fn text_of(row: &DiffRow) -> String {
    format!("{} {} {}", row.label, row.other, row.current).to_lowercase()
}

fn is_same_tab(a: Against, b: Against) -> bool {
    std::mem::discriminant(&a) == std::mem::discriminant(&b)
}

fn name(against: Against) -> &'static str {
    match against {
        Against::Craft => "craft",
        Against::File => "file",
        Against::Revision(_) => "revision",
        Against::Settings(_) => "settings",
    }
}

/// The places inside the popup.
struct Parts {
    tabs: Rect,
    list: Rect,
    map: Rect,
    foot: Rect,
}

impl Parts {
    fn of(inside: Rect, view: &DiffView, has_map: bool) -> Self {
        let height = inside.height.saturating_sub(4);
        let body = Rect { y: inside.y + 2, height, ..inside };
        let none = Rect { width: 0, ..body };
        let (list, map) = match (has_map, view.is_map, inside.width >= WIDE) {
            (false, ..) => (body, none),
            (true, true, _) => (none, Rect { y: inside.y + 1, height: height + 1, ..body }),
            (true, false, true) => {
                let width = (body.width * 3 / 5).max(MIN_BESIDE);
                let map = Rect { x: body.x + width + 1, width: body.width - width - 1, ..body };
                (Rect { width, ..body }, Rect { y: inside.y + 1, height: height + 1, ..map })
            }
            (true, false, false) => {
                let rows = height / 2;
                let map = Rect { y: body.y + rows, height: height - rows, ..body };
                (Rect { height: rows, ..body }, map)
            }
        };
        let foot = Rect { y: body.y + height, height: inside.height.min(2), ..inside };
        Self { tabs: Rect { height: inside.height.min(1), ..inside }, list, map, foot }
    }
}

/// Returns the place of the popup.
fn place(area: Rect) -> Rect {
    Rect { y: area.y + FREE.min(area.height), height: area.height.saturating_sub(FREE + 1), ..area }
}

/// Draws the comparison. Returns the position of the cursor while a search is typed.
pub(in crate::ui) fn draw(
    state: &Shared,
    view: &DiffView,
    area: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = &state.theme;
    let title = view.search.title("Differences", "Tab other, Esc closes");
    let inside = framed(theme, place(area), &title, buffer);
    let diff = Diff::of(state, view.against);
    let has_map = diff.as_ref().is_ok_and(|diff| diff.plan.is_some());
    let parts = Parts::of(inside, view, has_map);
    let tabs = view.tabs(state).into_iter().map(|(tab, text)| {
        let role = if tab == view.against { Role::Focus } else { Role::Dim };
        span(theme, role, text)
    });
    let mut tabs: Vec<Span<'_>> = tabs.collect();
    let diff = match diff {
        Ok(diff) => diff,
        Err(why) => {
            for (at, text) in wrapped(&why, usize::from(inside.width)).iter().enumerate() {
                row(buffer, inside, 2 + at as u16, theme, Role::Dim, text);
            }
            line(buffer, parts.tabs, 0, &Line::from(tabs));
            return None;
        }
    };
    tabs.push(span(theme, Role::Text, diff.label.as_str()));
    line(buffer, parts.tabs, 0, &Line::from(tabs));
    let count = |rows: &[DiffRow]| rows.iter().filter(|row| !row.is_part).count();
    let (all, summary) = (count(&diff.rows), diff.summary(usize::from(inside.width)));
    let (other, current) = (diff.other.clone(), diff.current.clone());
    if let Some(plan) = diff.plan.as_ref().filter(|_| parts.map.width > 0) {
        compared::draw_compared(state, plan, (&other, &current), parts.map, buffer);
    }
    let rows = view.shown(diff.rows);
    let summary =
        if view.search.is_on() { format!("{} of {all} rows found.", count(&rows)) } else { summary };
    if parts.list.width > 0 {
        let head = Rect { y: inside.y + 1, height: 1, ..parts.list };
        let columns = Columns::of(usize::from(parts.list.width));
        row(buffer, head, 0, theme, Role::Title, &columns.text(' ', "", &other, &current));
        draw_rows(state, view, &rows, &columns, parts.list, buffer);
    }
    row(buffer, parts.foot, 0, theme, Role::Text, &summary);
    let more = match view.against {
        Against::Revision(_) => " revision  ",
        Against::Settings(_) => " other values  ",
        Against::Craft | Against::File => "",
    };
    let keys = [
        ("n N", if view.search.is_on() { " match  " } else { " difference  " }),
        ("f", if view.only_differences { " all  " } else { " only differences  " }),
        ("m", if view.is_map { " rows  " } else { " map  " }),
        ("← →", more),
        ("Enter", " to the waypoint"),
    ];
    let mut room = usize::from(inside.width);
    let fits = |(key, does): &(&str, &str)| {
        let is_possible = match *key {
            "← →" => !more.is_empty(),
            "m" | "Enter" => has_map,
            _ => true,
        };
        let width = key.chars().count() + does.trim_end().chars().count();
        let is_shown = is_possible && width <= room;
        room = room.saturating_sub(if is_shown { key.chars().count() + does.chars().count() } else { 0 });
        is_shown
    };
    let keys: Vec<(&str, &str)> = if view.search.is_typing {
        [("↑ ↓", " choose  "), ("Enter", " keep the search  "), ("Esc", " end it")].to_vec()
    } else {
        keys.into_iter().filter(fits).collect()
    };
    line(buffer, parts.foot, 1, &key_line(theme, &keys));
    view.search.draw_in_border(theme, place(area), buffer)
}

/// The widths of the columns.
struct Columns {
    label: usize,
    value: usize,
}

impl Columns {
    fn of(width: usize) -> Self {
        let label = LABEL.min(width / 4);
        Self { label, value: width.saturating_sub(label + 5) / 2 }
    }

    /// Returns a row: mark, label, other value, current value.
    fn text(&self, mark: char, label: &str, other: &str, current: &str) -> String {
        let Self { label: labels, value } = *self;
        let (label, other, current) = (cut(label, labels), cut(other, value), cut(current, value));
        format!("{mark} {label:<labels$} {other:<value$} {current}")
    }
}

fn draw_rows(
    state: &Shared,
    view: &DiffView,
    rows: &[DiffRow],
    columns: &Columns,
    area: Rect,
    buffer: &mut Buffer,
) {
    let theme = &state.theme;
    if rows.is_empty() {
        let text = if view.search.is_on() { "None has these words." } else { "Nothing differs." };
        row(buffer, area, 0, theme, Role::Dim, text);
    }
    let first = view.first(rows.len(), area.height);
    for (at, found) in rows.iter().enumerate().skip(first).take(usize::from(area.height)) {
        let role = match found.mark {
            _ if at == view.selected => Role::Selected,
            Mark::Same => Role::Dim,
            Mark::Changed => Role::Warn,
            Mark::Added => Role::Ok,
            Mark::Removed => Role::Fault,
        };
        let label = if found.is_part { format!("  {}", found.label) } else { found.label.clone() };
        let text = columns.text(found.mark.symbol(), &label, &found.other, &found.current);
        let width = usize::from(area.width);
        row(buffer, area, (at - first) as u16, theme, role, &format!("{text:<width$}"));
    }
}

/// Returns the words that choose another comparison, a sentence.
pub(in crate::ui) fn answers(state: &Shared) -> String {
    let tabs = diff::possible(state).into_iter().map(|tab| match tab {
        Against::Revision(_) => "revision NUMBER".to_owned(),
        Against::Settings(_) => "settings (defaults, plan or saved)".to_owned(),
        Against::Craft | Against::File => name(tab).to_owned(),
    });
    format!("Compare with: {}; an empty line leaves it.", tabs.collect::<Vec<_>>().join(", "))
}

/// Returns the comparison that these words choose.
///
/// # Errors
/// Returns the words that are possible, a sentence.
pub(in crate::ui) fn named(state: &Shared, line: &str) -> Result<Against, String> {
    let mut words = line.split_whitespace();
    let (word, rest) = (words.next().unwrap_or_default(), words.next());
    let tab = diff::possible(state).into_iter().find(|tab| name(*tab) == word);
    let found = match (tab, rest) {
        (Some(Against::Revision(_)), Some(number)) => {
            let last = state.editor.plan().history().len();
            number.parse().ok().filter(|revision| *revision <= last).map(Against::Revision)
        }
        (Some(Against::Settings(_)), Some(rest)) => match rest {
            "defaults" => Some(Comparison::Defaults),
            "plan" => Some(Comparison::Plan),
            "saved" => Some(Comparison::Saved),
            _ => None,
        }
        .map(Against::Settings),
        (tab, None) => tab,
        (_, Some(_)) => None,
    };
    found.ok_or_else(|| answers(state))
}

/// Returns the comparison as lines of text.
pub(in crate::ui) fn lines(state: &Shared, view: &DiffView) -> Vec<String> {
    let diff = match Diff::of(state, view.against) {
        Ok(diff) => diff,
        Err(why) => return vec![why],
    };
    let label = if diff.label.is_empty() { String::new() } else { format!(" ({})", diff.label) };
    let head = format!("{}{label} | {}: {}", diff.other, diff.current, diff.summary(usize::MAX));
    let differing = diff.rows.iter().filter(|row| row.mark != Mark::Same);
    let line = |row: &DiffRow| {
        let indent = if row.is_part { "  " } else { "" };
        format!("{indent}{} {}: {} | {}", row.mark.symbol(), row.label, row.other, row.current)
    };
    std::iter::once(head).chain(differing.map(line)).collect()
}
