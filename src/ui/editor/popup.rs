//! What of the editor lies over the panels.

use super::browser::Browser;
use super::form::{Form, FormKind};
use super::question::Question;

/// A popup of the editor; it gets the keys.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum EditorPopup {
    Form(Form),
    /// A file to choose.
    Browser(Browser),
    Question(Question),
}

impl EditorPopup {
    /// Whether a plan is generated from its values.
    pub(super) fn generates(&self) -> bool {
        matches!(self, Self::Form(form) if form.kind == FormKind::Generate)
    }

    /// Inserts pasted text where one types; whether one does.
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
