//! The target of the launcher's file, `--betaloop`.

use betadeck::args::{Betaloop, BetaloopError};

/// Reads the text. A named executable can be named again, and nothing else in the file affects it.
pub fn run(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    match Betaloop::read(&text) {
        Ok(file) => {
            assert!(!file.executable.is_empty() && file.executable.trim() == file.executable, "{file:?}");
            assert!(file.unused.is_sorted() && !file.unused.iter().any(String::is_empty), "{file:?}");
            assert_eq!(Betaloop::read(&text), Ok(file.clone()), "reading is repeatable");
            let alone = format!("[Betaloop]\nBetaflightElf = {}\n", file.executable);
            let again = Betaloop::read(&alone).map(|file| file.executable);
            // A value with several lines cannot be written as a file name like this.
            assert!(file.executable.contains(['\n', '\r']) || again == Ok(file.executable), "{alone}");
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            let is_other = error == BetaloopError::NoSection;
            assert!(!is_other || !text.lines().any(|line| line == "[Betaloop]"), "{text}");
        }
    }
}
