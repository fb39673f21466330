//! The values with which the settings of the craft are compared.

/// The values beside those of the craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Comparison {
    /// All settings, with the values of a fresh craft.
    #[default]
    All,
    /// Only those that differ from a fresh craft.
    Defaults,
    /// Only those that differ from the settings of the open plan.
    Plan,
    /// Only those that differ from what a restart brings back, or from the first reading.
    Saved,
}

impl Comparison {
    /// Returns the next comparison; the first follows the last.
    pub(in crate::ui) fn next(self) -> Self {
        match self {
            Self::All => Self::Defaults,
            Self::Defaults => Self::Plan,
            Self::Plan => Self::Saved,
            Self::Saved => Self::All,
        }
    }

    /// Returns the next comparison with only differences; the first follows the last.
    pub(in crate::ui) fn other_next(self) -> Self {
        match self.next() {
            Self::All => Self::Defaults,
            other => other,
        }
    }

    /// Returns the comparison with only differences before this one; the last comes before the first.
    pub(in crate::ui) fn other_previous(self) -> Self {
        self.other_next().other_next()
    }
}
