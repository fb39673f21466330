//! The palette: every action and command, found by a few letters of its name, title or help.

use crate::ui::acts::{availability, screen_layout};
use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

use crate::ui::area::{line, row, span};
use crate::ui::command::{self, Command};
use crate::ui::formatting::cut;
use crate::ui::fuzzy;
use crate::ui::model::action::{ACTIONS, Action, Spec};
use crate::ui::model::history::UsedNames;
use crate::ui::popup::Outcome;
use crate::ui::popup::frame::{place, popup};
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;
use crate::ui::theme::Role;

/// The inner size on a screen that has room for it.
const SIZE: (u16, u16) = (72, 16);
/// The width of a name.
const NAME: usize = 21;
/// The number of rows around the list: the search line above it and the reason below it.
const AROUND: u16 = 2;
/// The share of its weight that a name chosen before adds to its score for a query.
const USED_SHARE: u32 = 4;
/// The weight of letters found in the title or the name.
const IN_NAME: u32 = 4;
/// The weight of each letter of a word found in the help: more than letters scattered over a name.
const IN_HELP: u32 = 6;

/// The search text, and the selected row.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Palette {
    pub query: TextField,
    /// The selected row of the list.
    pub selected: usize,
}

impl Palette {
    /// Moves the selection by rows, within the list.
    pub(in crate::ui) fn scroll(&mut self, used: &UsedNames, by: isize) {
        let last = entries(self.query.value(), used).len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(by).min(last);
    }
}

/// A row of the palette.
#[derive(Debug, Clone, Copy)]
pub(in crate::ui) enum Entry {
    Action(&'static Spec),
    /// A command with an argument.
    Command(Command),
}

impl Entry {
    pub(in crate::ui) fn name(&self) -> &'static str {
        match self {
            Self::Action(spec) => spec.name,
            Self::Command(command) => command.name,
        }
    }

    fn help(&self) -> &'static str {
        match self {
            Self::Action(spec) => spec.help,
            Self::Command(command) => command.help,
        }
    }

    fn keys(&self, state: &Shared) -> String {
        match self {
            Self::Action(spec) => state.keymap.shown_keys(spec.action).join(" "),
            Self::Command(command) => format!(":{}", command.name),
        }
    }

    /// Returns the reason if it is refused now.
    fn refusal(&self, state: &Shared) -> Option<String> {
        match self {
            Self::Action(spec) => availability::enabled(state, spec.action).err(),
            Self::Command(_) => None,
        }
    }

    /// Scores a query; each of its words must occur.
    fn score(&self, query: &str) -> Option<u32> {
        let title = match self {
            Self::Action(spec) => spec.title,
            Self::Command(command) => command.argument,
        };
        let help = self.help().to_lowercase();
        query.split_whitespace().try_fold(0, |sum, word| {
            let named = [title, self.name()].into_iter().filter_map(|text| fuzzy::score(word, text)).max();
            let helped = help.contains(&word.to_lowercase()).then_some(word.chars().count() as u32 * IN_HELP);
            named.map(|score| score * IN_NAME).max(helped).map(|score| sum + score)
        })
    }
}

/// Returns the rows that match a query, the best first. What was chosen before comes before what was not.
pub(in crate::ui) fn entries(query: &str, used: &UsedNames) -> Vec<Entry> {
    let actions = ACTIONS.iter().filter(|spec| spec.action != Action::Palette).map(Entry::Action);
    let all = actions.chain(command::all().map(Entry::Command));
    // A full name typed must stay the first one, so habits weigh less than letters.
    let weight = |entry: &Entry| used.weight(entry.name()) / if query.is_empty() { 1 } else { USED_SHARE };
    let mut scored: Vec<(u32, Entry)> =
        all.filter_map(|entry| Some((entry.score(query)? + weight(&entry), entry))).collect();
    // Stable: entries with equal scores stay in the order of the table.
    scored.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
    scored.into_iter().map(|(_, entry)| entry).collect()
}

/// Handles a key while the palette is open.
pub(in crate::ui) fn key(palette: &mut Palette, used: &UsedNames, event: KeyEvent) -> Outcome<Entry> {
    let found = entries(palette.query.value(), used);
    let last = found.len().saturating_sub(1);
    match event.code {
        KeyCode::Esc => return Outcome::Left,
        KeyCode::Enter => match found.get(palette.selected) {
            Some(entry) => return Outcome::Chosen(*entry),
            None => return Outcome::Open,
        },
        KeyCode::Up => palette.selected = palette.selected.saturating_sub(1),
        KeyCode::Down => palette.selected = (palette.selected + 1).min(last),
        KeyCode::PageUp => palette.selected = palette.selected.saturating_sub(10),
        KeyCode::PageDown => palette.selected = (palette.selected + 10).min(last),
        _ => {
            let before = palette.query.value().to_owned();
            palette.query.key(event);
            if palette.query.value() != before {
                palette.selected = 0;
            }
        }
    }
    Outcome::Open
}

/// Returns the first shown row for a list of this many rows on the screen.
fn first_row(palette: &Palette, rows: u16) -> usize {
    (palette.selected + 1).saturating_sub(usize::from(rows))
}

/// Handles a click on a screen of this size: a row is chosen, a click outside closes the palette.
pub(in crate::ui) fn click(
    palette: &Palette,
    used: &UsedNames,
    size: (u16, u16),
    (column, row): (u16, u16),
) -> Outcome<Entry> {
    let place = place(Rect::new(0, 0, size.0, size.1), SIZE);
    if !place.contains((column, row).into()) {
        return Outcome::Left;
    }
    let inside = screen_layout::inner(place);
    let rows = inside.height.saturating_sub(AROUND);
    let at = row.checked_sub(inside.y + 1).filter(|at| *at < rows);
    let found = entries(palette.query.value(), used);
    let entry = at.and_then(|at| found.get(first_row(palette, rows) + usize::from(at)));
    entry.map_or(Outcome::Open, |entry| Outcome::Chosen(*entry))
}

/// Draws the palette. Returns the position of the cursor.
pub(in crate::ui) fn draw(
    state: &Shared,
    palette: &Palette,
    area: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = &state.theme;
    let inside = popup(theme, area, SIZE, "Commands — Enter runs, Esc closes", buffer);
    let found = entries(palette.query.value(), &state.used);
    let rows = inside.height.saturating_sub(AROUND);
    let first = first_row(palette, rows);
    let width = usize::from(inside.width);
    for (at, entry) in found.iter().enumerate().skip(first).take(usize::from(rows)) {
        let refused = entry.refusal(state).is_some();
        let is_selected = at == palette.selected;
        let role = match (is_selected, refused) {
            (true, _) => Role::Selected,
            (false, true) => Role::Dim,
            (false, false) => Role::Text,
        };
        let keys = cut(&entry.keys(state), width.saturating_sub(NAME + 4));
        let room = width.saturating_sub(NAME + 4 + keys.chars().count());
        let mark = if refused { '✗' } else { ' ' };
        let text = format!("{mark} {:<NAME$} {:<room$} ", cut(entry.name(), NAME), cut(entry.help(), room));
        let key_role = if is_selected { Role::Selected } else { Role::Key };
        let spans = vec![span(theme, role, text), span(theme, key_role, keys)];
        line(buffer, inside, 1 + (at - first) as u16, &Line::from(spans));
    }
    let (role, text) = match found.get(palette.selected) {
        Some(entry) => match entry.refusal(state) {
            Some(reason) => (Role::Warn, format!("✗ {reason}")),
            None => (Role::Dim, entry.help().to_owned()),
        },
        None => (Role::Dim, "Nothing found: fewer letters find more.".to_owned()),
    };
    row(buffer, inside, inside.height.saturating_sub(1), theme, role, &text);
    row(buffer, inside, 0, theme, Role::Key, "> ");
    let field =
        Rect { x: inside.x + 2, width: inside.width.checked_sub(2)?, height: inside.height.min(1), ..inside };
    palette.query.draw(theme, field, buffer)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(query: &str) -> Option<&'static str> {
        entries(query, &UsedNames::default()).first().map(Entry::name)
    }

    #[test]
    fn a_few_letters_find_an_action_by_name_title_or_help() {
        assert_eq!(first("arm"), Some("flight.arm"));
        assert_eq!(first("rtime"), Some("sim.real-time"));
        assert_eq!(first("cut rc"), Some("rc.cut"));
        assert_eq!(first("wind"), Some("wind"));
        assert!(entries("asks if", &UsedNames::default()).iter().any(|entry| entry.name() == "flight.fly"));
        assert_eq!(first("zzzz"), None);
    }

    #[test]
    fn without_a_query_it_lists_every_action_but_itself_and_every_command() {
        assert_eq!(entries("", &UsedNames::default()).len(), ACTIONS.len() - 1 + command::all().count());
    }

    #[test]
    fn what_was_chosen_before_comes_first() {
        let mut used = UsedNames::of(&["map.fit", "wind", "map.fit"].map(str::to_owned));
        let first = |used: &UsedNames, query: &str| entries(query, used)[0].name();
        assert_eq!((first(&used, ""), entries("", &used)[1].name()), ("map.fit", "wind"));
        used.remember("flight.arm");
        assert_eq!(first(&used, ""), "flight.arm");
        assert_eq!(first(&used, "rc.cut"), "rc.cut", "a habit does not hide what is typed");
    }
}
