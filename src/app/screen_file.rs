//! The file of the state directory with the screen of the run before.

use std::path::{Path, PathBuf};

use super::set_aside;
use crate::storage::state_file;
use crate::ui::{KeptScreen, KeptScreens, Unread};

/// The name of the file.
const NAME: &str = "screen.json";
/// The most bytes of the file that are read.
const MOST_BYTES: u64 = 1 << 20;

/// The file, if there is a state directory.
#[derive(Debug, Clone)]
pub(super) struct ScreenFile(Option<PathBuf>);

impl ScreenFile {
    pub(super) fn new(state: Option<&Path>) -> Self {
        Self(state.map(|state| state.join(NAME)))
    }

    /// Reads the screen of the run before. A file that cannot be used is a sentence for `notices`, and the screen starts
    /// clean. A damaged file is set aside; otherwise the file stays, and this run keeps no screen.
    pub(super) fn read(&self, notices: &mut Vec<String>) -> KeptScreens {
        let Some(path) = self.0.as_deref() else { return KeptScreens::none() };
        let contents = match state_file::read(path, MOST_BYTES) {
            Ok(None) => return KeptScreens::after(None),
            Ok(Some(contents)) => contents,
            Err(error) => {
                notices.push(unkept(path, &format!("cannot be read: {error}")));
                return KeptScreens::none();
            }
        };
        let text = String::from_utf8(contents).map_err(|_| Unread::Damaged);
        match text.and_then(|text| KeptScreen::parse(&text)) {
            Ok(before) => KeptScreens::after(Some(before)),
            Err(Unread::Later) => {
                notices.push(unkept(path, "was written by a later version of betadeck"));
                KeptScreens::none()
            }
            Err(Unread::Damaged) => {
                let kept = set_aside::copy(path);
                let now = set_aside::place(&kept, path);
                notices.push(format!("The screen starts clean: {} is damaged. {now}.", path.display()));
                if kept.is_ok() { KeptScreens::after(None) } else { KeptScreens::none() }
            }
        }
    }

    /// Replaces the kept screen. A screen that cannot be kept is no loss, so a failure is not reported.
    pub(super) fn write(&self, text: &str) {
        if let Some(path) = &self.0 {
            state_file::replace(path, text.as_bytes()).ok();
        }
    }
}

/// Returns the sentence about a file that stays as it is.
fn unkept(path: &Path, why: &str) -> String {
    format!("The screen starts clean, and is not kept after this run: {} {why}.", path.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_screen_is_kept_until_the_next_run() {
        let directory = tempfile::tempdir().unwrap();
        let file = ScreenFile::new(Some(directory.path()));
        let mut notices = Vec::new();
        assert!(file.read(&mut notices).before().is_none());
        file.write(r#"{"version": 1, "focus": "Graphs"}"#);
        assert!(file.read(&mut notices).before().is_some());
        assert_eq!(notices, [""; 0]);
        let none = ScreenFile::new(None);
        none.write("{}");
        assert!(none.read(&mut notices).before().is_none());
    }

    #[test]
    fn a_damaged_screen_is_set_aside_and_one_of_a_later_version_stays() {
        let directory = tempfile::tempdir().unwrap();
        let file = ScreenFile::new(Some(directory.path()));
        let mut notices = Vec::new();
        file.write("{ damaged");
        assert!(file.read(&mut notices).is_kept());
        let bad = directory.path().join("screen.bad");
        assert_eq!(std::fs::read_to_string(&bad).unwrap(), "{ damaged");
        assert!(notices[0].contains("screen.json is damaged. It is kept as"), "{notices:?}");
        file.write("{}");
        assert_eq!(
            std::fs::read_to_string(&bad).unwrap(),
            "{ damaged",
            "a new screen replaces the damaged one only"
        );
        file.write(r#"{"version": 99}"#);
        assert!(!file.read(&mut notices).is_kept());
        assert!(notices[1].contains("later version"), "{notices:?}");
    }
}
