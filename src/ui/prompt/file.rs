//! The file browser without a screen: numbered entries, or a name.

use crossterm::event::KeyCode;

use super::{Answered, press};
use crate::ui::app_state::AppState;
use crate::ui::model::editor::{Browser, EditorPopup, Purpose};
use crate::ui::text_field::TextField;

/// Returns the question; `None` until the directory has been read.
pub(super) fn question(browser: &Browser) -> Option<Vec<String>> {
    let directory = &browser.listing.directory;
    if directory.as_os_str().is_empty() {
        return None;
    }
    let what = match browser.purpose {
        Purpose::Open => "Open which plan of",
        Purpose::Save(_) => "Save as which file in",
        Purpose::Backdrop(_) => "Show which map of",
    };
    let entries = (1..).zip(&browser.listing.entries).map(|(number, entry)| {
        let slash = if entry.is_directory { "/" } else { "" };
        format!("{number} {}{slash}", entry.name)
    });
    let title = format!("{what} {}?", directory.display());
    let end = "A number or a name chooses, `..` is the directory above, an empty line leaves it.".to_owned();
    Some(std::iter::once(title).chain(entries).chain([end]).collect())
}

/// Handles a number or a name.
pub(super) fn answer(state: &mut AppState, line: &str) -> Result<Answered, String> {
    let Some(EditorPopup::Browser(browser)) = &mut state.shared.editor.popup else {
        return Ok(Answered::default());
    };
    if line.is_empty() {
        return Ok(press(state, KeyCode::Esc).into());
    }
    let numbered = line.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
    browser.at = numbered.filter(|&at| at < browser.listing.entries.len());
    // A typed text would filter the entries that the number refers to.
    browser.text = if browser.at.is_some() { TextField::default() } else { TextField::new(line) };
    Ok(press(state, KeyCode::Enter).into())
}
