//! The kept screen and the saved layouts of the state directory.

use betadeck::ui::{KeptScreen, SavedLayouts, Unread};

/// Reads the text as a kept screen and as saved layouts.
pub fn run(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    match KeptScreen::parse(&text) {
        Ok(screen) => assert!(screen.plans().count() <= text.len()),
        Err(Unread::Later) => assert!(text.contains("version"), "only a version can be later"),
        Err(Unread::Damaged) => {}
    }
    let (layouts, left_out) = SavedLayouts::from_lines(&text);
    // A damaged line takes no other with it, and is counted.
    let damaged: Vec<&str> = text.lines().flat_map(|line| [line, "{\"name\":"]).collect();
    let (same, more_left_out) = SavedLayouts::from_lines(&damaged.join("\n"));
    assert_eq!((same, more_left_out.len()), (layouts, left_out.len() + damaged.len() / 2));
}
