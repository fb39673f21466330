//! The journals of edited plans.

use betadeck::plan::edit::{Journal, JournalLine};

/// Reads the text as a journal. A valid one can be written and read again, and every edit in it undone and
/// redone.
pub fn run(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let read = |text: &str| Journal::read_whole_part(text).map(|(journal, _)| journal);
    let Some(journal) = read(&text) else { return };
    assert!(journal.history.at() <= journal.history.len());
    let written: String = journal.lines().iter().map(JournalLine::to_text).collect();
    let again = read(&written).unwrap_or_else(|| panic!("{written}"));
    assert_eq!(again.history.document(), journal.history.document(), "{written}");
    assert_eq!(again.history.is_saved(), journal.history.is_saved(), "{written}");
    assert_eq!((again.history.at(), again.history.len()), (journal.history.at(), journal.history.len()));
    assert_eq!(again.lines(), journal.lines());

    let mut walked = journal.clone();
    while walked.history.undo().is_some() {}
    assert!(walked.history.go_to(journal.history.at()));
    assert_eq!(walked.history.document(), journal.history.document());
    for revision in 0..=journal.history.len() {
        assert!(walked.history.go_to(revision), "{revision} of {}", journal.history.len());
    }
    // Lines of another document change nothing.
    let before = walked.history.document().clone();
    assert!(!walked.take(JournalLine::Moved(journal.history.len() + 1)));
    assert_eq!(*walked.history.document(), before);
}
