//! The help popup, from the action table: the keys of the focused panel and the general ones. A search finds all keys.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

use crate::ui::acts::screen_layout;
use crate::ui::area::{line, span};
use crate::ui::model::action::{ACTIONS, Action, Context, Spec};
use crate::ui::model::panel_table::Panel;
use crate::ui::popup::Outcome;
use crate::ui::popup::frame::{framed, place};
use crate::ui::search::Search;
use crate::ui::shared::Shared;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::{Role, Theme};

/// The width of the keys.
const KEYS: usize = 12;
/// The lines of a page.
const PAGE: isize = 10;

/// The position in the help, and the search.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Help {
    scroll: usize,
    /// The words that a line must have.
    pub(in crate::ui) search: Search,
}

/// A line of the help, and the action that it explains.
type Entry = (Line<'static>, Option<Action>);

impl Help {
    /// Handles a key. `None` means a key that closes the help and may trigger its action.
    pub(in crate::ui) fn key(&mut self, event: KeyEvent) -> Option<Outcome<Action>> {
        let is_searched = self.search.is_on();
        match event.code {
            KeyCode::Up => self.scroll_by(-1),
            KeyCode::Down => self.scroll_by(1),
            KeyCode::PageUp => self.scroll_by(-PAGE),
            KeyCode::PageDown => self.scroll_by(PAGE),
            KeyCode::Esc if is_searched => *self = Self::default(),
            KeyCode::Enter if self.search.is_typing => self.search.is_typing = false,
            _ if self.search.is_typing => {
                self.search.key(event);
                self.scroll = 0;
            }
            KeyCode::Char('/') => *self = Self { search: Search::begun(), scroll: 0 },
            KeyCode::Char('k') => self.scroll_by(-1),
            KeyCode::Char('j') => self.scroll_by(1),
            KeyCode::Char(' ') => self.scroll_by(PAGE),
            KeyCode::Char('n') if is_searched => self.scroll_by(1),
            KeyCode::Char('N') if is_searched => self.scroll_by(-1),
            _ => return None,
        }
        Some(Outcome::Open)
    }

    /// Scrolls by lines. The picture stops at the last one.
    pub(in crate::ui) fn scroll_by(&mut self, lines: isize) {
        self.scroll = self.scroll.saturating_add_signed(lines).min(2 * ACTIONS.len());
    }

    /// Handles a click: a line runs its action, a click outside closes the help.
    pub(in crate::ui) fn click(&self, state: &Shared, (column, row): (u16, u16)) -> Outcome<Action> {
        let area = Rect::new(0, 0, state.size.0, state.size.1);
        let entries = self.entries(state, area.width);
        let (place, first) = self.place(&entries, area);
        if !place.contains((column, row).into()) {
            return Outcome::Left;
        }
        let at = row.checked_sub(screen_layout::inner(place).y).map(|at| first + usize::from(at));
        let action = at.and_then(|at| entries.get(at)).and_then(|(_, action)| *action);
        action.map_or(Outcome::Open, Outcome::Chosen)
    }

    /// Returns the place of the popup and its first shown line.
    fn place(&self, entries: &[Entry], area: Rect) -> (Rect, usize) {
        let width = entries.iter().map(|(line, _)| line.width()).max().unwrap_or(0).max(40) as u16 + 1;
        let height = area.height.saturating_sub(4).min(entries.len() as u16).max(1);
        let place = place(area, (width, height));
        let shown = usize::from(screen_layout::inner(place).height);
        (place, self.scroll.min(entries.len().saturating_sub(shown)))
    }

    fn entries(&self, state: &Shared, width: u16) -> Vec<Entry> {
        let theme = &state.theme;
        let columns = usize::from(width.saturating_sub(2));
        let words = self.search.words();
        let is_found = |keys: &str, text: &str| {
            let text = text.to_lowercase();
            words.iter().all(|word| text.contains(word.as_str()) || keys.to_lowercase() == *word)
        };
        let is_in = |section: Option<Panel>, context: Context| match (section, context) {
            (None, Context::Global | Context::Always) => true,
            (Some(panel), Context::In(own)) => panel == own,
            (Some(panel), Context::Lists) => panel == state.focus && context.applies(panel),
            _ => false,
        };
        // A search also finds the keys of the panels without the focus.
        let others = Panel::ALL.into_iter().filter(|panel| !words.is_empty() && *panel != state.focus);
        let sections = [Some(state.focus), None].into_iter().chain(others.map(Some));
        let mut entries: Vec<Entry> = Vec::new();
        for section in sections {
            let title = section
                .map_or_else(|| "Everywhere".to_owned(), |panel| format!("In {}", state.panel_title(panel)));
            let keys = |spec: &Spec| state.keymap.shown_keys(spec.action).join(" ");
            let rows: Vec<&Spec> = ACTIONS
                .iter()
                .filter(|spec| is_in(section, spec.context))
                .filter(|spec| is_found(&keys(spec), &format!("{} {} {}", spec.name, spec.title, spec.help)))
                .collect();
            if rows.is_empty() {
                continue;
            }
            entries.push((Line::from(span(theme, Role::Title, title)), None));
            for spec in rows {
                let lines = explained(theme, &keys(spec), spec.help, columns);
                entries.extend(lines.into_iter().map(|line| (line, Some(spec.action))));
            }
        }
        let mouse = MOUSE.iter().filter(|(what, text)| is_found(what, text));
        let mut mouse = mouse.peekable();
        if mouse.peek().is_some() {
            entries.push((Line::from(span(theme, Role::Title, "Mouse")), None));
        }
        for (what, text) in mouse {
            let lines = explained(theme, what, text, columns);
            entries.extend(lines.into_iter().map(|line| (line, None)));
        }
        if entries.is_empty() {
            let text = "Nothing found: fewer letters find more.";
            entries.push((Line::from(span(theme, Role::Dim, text)), None));
        }
        entries
    }
}

/// The uses of the mouse.
const MOUSE: [(&str, &str); 8] = [
    ("click", "Focus a panel, set a channel; run a hint, or a line of this help"),
    ("top lines", "A click finds any command"),
    ("windows", "A click on a key presses it, on a row chooses it, outside closes"),
    ("double", "Add a waypoint on the map"),
    ("drag", "Move the map"),
    ("right", "What can be done at a place of the map, and with a setting"),
    ("wheel", "Zoom the map at the pointer, scroll the others"),
    ("Shift", "Lets the terminal select text"),
];

/// Draws the popup. Returns the position of the cursor while a search is typed.
pub(in crate::ui) fn draw(state: &Shared, help: &Help, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let theme = &state.theme;
    let entries = help.entries(state, area.width);
    let (place, first) = help.place(&entries, area);
    let title = help.search.title("Keys", "any other key closes, ↑ ↓ scroll");
    let inside = framed(theme, place, &title, buffer);
    for (at, (text, _)) in entries.iter().skip(first).take(usize::from(inside.height)).enumerate() {
        line(buffer, inside, at as u16, text);
    }
    help.search.draw_in_border(theme, place, buffer)
}

/// Returns keys and their explanation, in as many lines as it takes at this width.
fn explained(theme: &Theme, keys: &str, text: &str, columns: usize) -> Vec<Line<'static>> {
    let rows = wrapped(text, columns.saturating_sub(KEYS.max(keys.chars().count()) + 2).max(1));
    let keys = std::iter::once(keys).chain(std::iter::repeat(""));
    std::iter::zip(keys, rows)
        .map(|(keys, text)| {
            Line::from(vec![
                span(theme, Role::Key, format!("{keys:>KEYS$}  ")),
                span(theme, Role::Text, text),
            ])
        })
        .collect()
}
