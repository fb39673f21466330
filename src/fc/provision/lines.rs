//! The command lines that configure a flight controller.

use crate::flight::setup::replacement;

/// The prefix of a setting's line.
const SET: &str = "set ";

/// Command lines, by their source.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ProvisionLines {
    /// The lines of the guide and of the plan.
    pub usual: Vec<String>,
    /// The user's lines, which override the others.
    pub of_user: Vec<String>,
}

impl ProvisionLines {
    /// Returns `true` if there are no lines.
    pub fn is_empty(&self) -> bool {
        self.usual.is_empty() && self.of_user.is_empty()
    }

    /// Returns all lines in order. Of two lines for the same setting the last one counts.
    pub(super) fn in_order(&self) -> impl Iterator<Item = &str> {
        self.usual.iter().chain(&self.of_user).map(String::as_str)
    }

    /// Replaces the gains of the guide that make some firmware fall in LAND. Returns the replacements.
    pub(super) fn replace_settings(&mut self) -> Vec<String> {
        let mut replaced = Vec::new();
        for line in &mut self.usual {
            if let Some(setting) = line.strip_prefix(SET).and_then(replacement) {
                *line = format!("{SET}{setting}");
                if !replaced.contains(&setting) {
                    replaced.push(setting);
                }
            }
        }
        replaced
    }
}
