//! A sentence of the session for the user, with its severity.

/// A sentence for the user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notice {
    pub text: String,
    pub is_warning: bool,
}

impl Notice {
    /// Returns a notice about something that went wrong or will.
    pub fn warning(text: String) -> Self {
        Self { text, is_warning: true }
    }
}

impl From<String> for Notice {
    fn from(text: String) -> Self {
        Self { text, is_warning: false }
    }
}

impl From<&str> for Notice {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}
