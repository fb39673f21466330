//! The popups of the editor.

use super::browser::Browser;
use super::form::{Form, FormKind};
use super::question::Question;

/// A popup of the editor, which receives the keys.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum EditorPopup {
    Form(Form),
    Browser(Browser),
    Question(Question),
}

impl EditorPopup {
    /// Returns `true` for the form of the generator.
    pub(super) fn generates(&self) -> bool {
        matches!(self, Self::Form(form) if form.kind == FormKind::Generate)
    }

    /// Inserts pasted text into the active field. Returns `true` if there is one.
    pub(in crate::ui) fn paste(&mut self, text: &str) -> bool {
        match self {
            Self::Form(form) => form.paste(text),
            Self::Browser(browser) => {
                browser.text.insert(text);
                browser.at = None;
                true
            }
            Self::Question(_) => false,
        }
    }
}
