//! The file browser: a text field above the plan files and directories of a directory.

use std::path::{Path, PathBuf};

use crossterm::event::{KeyCode, KeyEvent};

use crate::plan::format::Format;
use crate::ui::model::backdrop::BackdropLayer;
use crate::ui::model::files::{Entry, Listing};
use crate::ui::model::plan_id::PlanId;
use crate::ui::text_field::TextField;

/// The purpose of the chosen file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// To open a plan.
    Open,
    /// To save a plan.
    Save(PlanId),
    /// To put a file under a plan on the map.
    Backdrop(PlanId),
}

impl Purpose {
    /// Returns `true` if an existing file is chosen.
    fn opens(self) -> bool {
        !matches!(self, Self::Save(_))
    }

    /// Returns `true` if a file of this name can be chosen from the list.
    pub(in crate::ui) fn takes(self, name: &str) -> bool {
        match self {
            Self::Open | Self::Save(_) => Format::is_plan_name(name),
            Self::Backdrop(_) => BackdropLayer::is_map_name(name),
        }
    }
}

/// An open browser.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Browser {
    pub purpose: Purpose,
    /// The typed text: a name, the beginning of one, or a path.
    pub text: TextField,
    /// The directory; empty until it has been read.
    pub listing: Listing,
    /// The entry under the cursor among the visible ones; `None` if the typed text counts.
    pub at: Option<usize>,
}

/// A place in the browser.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum BrowserPlace {
    /// The path of the directory.
    Directory,
    /// This column of the typed text, in a row of so many columns.
    Text { column: u16, width: u16 },
    /// The visible entry with this index.
    Entry(usize),
}

/// The effect of a key or a click.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::ui) enum BrowserKey {
    Edited,
    List(PathBuf),
    /// Nothing was typed or selected, so there is nothing to choose.
    NothingChosen,
    /// The user chose this file.
    Chosen(PathBuf),
    Cancel,
}

impl Browser {
    pub(in crate::ui) fn new(purpose: Purpose, name: &str) -> Self {
        Self { purpose, text: TextField::selected(name), listing: Listing::default(), at: None }
    }

    /// Returns the entries that match the typed text; all of them while saving.
    pub fn visible(&self) -> Vec<&Entry> {
        let typed = self.text.value().to_lowercase();
        let filters = self.purpose.opens() && !typed.contains('/');
        let fits = |entry: &&Entry| !filters || entry.name.to_lowercase().contains(&typed);
        self.listing.entries.iter().filter(fits).collect()
    }

    pub(in crate::ui) fn key(&mut self, event: KeyEvent) -> BrowserKey {
        let last = self.visible().len().checked_sub(1);
        match event.code {
            KeyCode::Esc => return BrowserKey::Cancel,
            KeyCode::Enter => return self.enter(),
            KeyCode::Down => self.at = last.map(|last| self.at.map_or(0, |at| (at + 1).min(last))),
            KeyCode::Up => self.at = self.at.and_then(|at| at.checked_sub(1)),
            KeyCode::PageDown => self.at = last.map(|last| self.at.map_or(0, |at| (at + 10).min(last))),
            KeyCode::PageUp => self.at = self.at.and_then(|at| at.checked_sub(10)),
            KeyCode::Left if self.text.is_empty() => return self.parent(),
            KeyCode::Tab => {
                let typed = self.text.value();
                // While saving, the user has typed a name: it is completed, never replaced.
                let completes = |entry: &&&Entry| {
                    self.purpose.opens() || !typed.is_empty() && entry.name.starts_with(typed)
                };
                if let Some(name) = self.visible().iter().find(completes).map(|entry| entry.name.clone()) {
                    self.text = TextField::new(name);
                    self.at = None;
                }
            }
            _ => {
                if self.text.key(event) {
                    self.at = None;
                }
            }
        }
        BrowserKey::Edited
    }

    /// Handles a click: the first one selects an entry, a click on the selected one chooses it. A click on the directory goes
    /// to the one above.
    pub(in crate::ui) fn click(&mut self, place: BrowserPlace) -> BrowserKey {
        match place {
            BrowserPlace::Directory => return self.parent(),
            BrowserPlace::Text { column, width } => {
                self.text.click(column, width);
                self.at = None;
            }
            BrowserPlace::Entry(at) if self.at == Some(at) => return self.enter(),
            BrowserPlace::Entry(at) => self.at = Some(at),
        }
        BrowserKey::Edited
    }

    fn parent(&self) -> BrowserKey {
        let parent = self.listing.directory.parent().unwrap_or(Path::new("/"));
        BrowserKey::List(parent.to_owned())
    }

    fn enter(&mut self) -> BrowserKey {
        let visible = self.visible();
        let typed = self.text.value().trim().to_owned();
        // A filter that leaves one entry selects it, unless the text is the exact name of that entry.
        let only = match visible[..] {
            [only] if self.purpose.opens() && !typed.is_empty() => Some(0).filter(|_| only.name != typed),
            _ => None,
        };
        if let Some(entry) = self.at.or(only).and_then(|at| visible.get(at).copied()) {
            let path = self.listing.directory.join(&entry.name);
            return if entry.is_directory { self.list(path) } else { BrowserKey::Chosen(path) };
        }
        if typed.is_empty() {
            return BrowserKey::NothingChosen;
        }
        let is_directory = self.listing.entries.iter().any(|entry| entry.is_directory && entry.name == typed);
        // An absolute path replaces the directory.
        let path = self.listing.directory.join(&typed);
        if is_directory || typed.ends_with('/') || typed == ".." {
            return self.list(path);
        }
        match (self.purpose, path.extension()) {
            (Purpose::Save(_), None) => BrowserKey::Chosen(path.with_extension("toml")),
            _ => BrowserKey::Chosen(path),
        }
    }

    fn list(&mut self, path: PathBuf) -> BrowserKey {
        if self.purpose.opens() {
            self.text = TextField::default();
        }
        self.at = None;
        BrowserKey::List(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crossterm::event::KeyModifiers;

    fn press(browser: &mut Browser, code: KeyCode) -> BrowserKey {
        browser.key(KeyEvent::new(code, KeyModifiers::NONE))
    }

    fn browser(purpose: Purpose, name: &str) -> Browser {
        let entry = |name: &str, is_directory| Entry { name: name.to_owned(), is_directory };
        let entries = vec![entry("deep", true), entry("orbit.toml", false), entry("square.toml", false)];
        Browser { listing: Listing { directory: "/plans".into(), entries }, ..Browser::new(purpose, name) }
    }

    #[test]
    fn typing_filters_and_enter_takes_what_is_left() {
        let mut open = browser(Purpose::Open, "");
        press(&mut open, KeyCode::Char('q'));
        assert_eq!(open.visible().len(), 1);
        assert_eq!(press(&mut open, KeyCode::Enter), BrowserKey::Chosen("/plans/square.toml".into()));
        let mut open = browser(Purpose::Open, "");
        press(&mut open, KeyCode::Down);
        assert_eq!(press(&mut open, KeyCode::Enter), BrowserKey::List("/plans/deep".into()));
        assert_eq!(press(&mut open, KeyCode::Backspace), BrowserKey::Edited);
        assert_eq!(press(&mut open, KeyCode::Left), BrowserKey::List("/".into()));
        let mut open = browser(Purpose::Open, "/etc/x.txt");
        assert_eq!(press(&mut open, KeyCode::Enter), BrowserKey::Chosen("/etc/x.txt".into()));
    }

    #[test]
    fn tab_completes_a_name_and_replaces_none_that_is_typed_to_save() {
        for (purpose, typed, completed) in [
            (Purpose::Open, "q", "square.toml"),
            (Purpose::Save(PlanId(1)), "mine", "mine"),
            (Purpose::Save(PlanId(1)), "sq", "square.toml"),
            (Purpose::Save(PlanId(1)), "", ""),
        ] {
            let mut open = browser(purpose, typed);
            press(&mut open, KeyCode::Tab);
            assert_eq!(open.text.value(), completed);
        }
    }

    #[test]
    fn a_name_without_an_ending_is_saved_as_toml() {
        let mut save = browser(Purpose::Save(PlanId(1)), "mine");
        assert_eq!(press(&mut save, KeyCode::Enter), BrowserKey::Chosen("/plans/mine.toml".into()));
        let mut save = browser(Purpose::Save(PlanId(1)), "mine.txt");
        assert_eq!(press(&mut save, KeyCode::Enter), BrowserKey::Chosen("/plans/mine.txt".into()));
        let mut save = browser(Purpose::Save(PlanId(1)), "");
        assert_eq!(press(&mut save, KeyCode::Enter), BrowserKey::NothingChosen);
        assert_eq!(press(&mut save, KeyCode::Esc), BrowserKey::Cancel);
    }
}
