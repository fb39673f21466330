//! The popups of the editor.

use crate::ui::model::editor::browser::Browser;
use crate::ui::model::editor::form::{Form, FormKind};
use crate::ui::model::editor::question::Question;
use crate::ui::model::files::ConversionLosses;

/// A popup of the editor, which receives the keys.
#[derive(Debug, Clone, PartialEq, Eq, strum::VariantNames)]
pub enum EditorPopup {
    Form(Form),
    Browser(Browser),
    Question(Question),
    Losses(LossList),
}

/// The differences between a file and a plan, which the user accepts or not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LossList {
    pub losses: ConversionLosses,
    /// The first shown line.
    pub scroll: usize,
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
            Self::Question(_) | Self::Losses(_) => false,
        }
    }
}
