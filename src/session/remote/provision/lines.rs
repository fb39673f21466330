//! The command lines that say how a flight controller is to be set.

use crate::session::landing_gains::landing_gain;

/// What a setting's line begins with.
const SET: &str = "set ";

/// Command lines, by who wants them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ProvisionLines {
    /// The guide's and the plan's.
    pub usual: Vec<String>,
    /// The user's, which have the last word.
    pub of_user: Vec<String>,
}

impl ProvisionLines {
    /// Whether there is nothing to be set.
    pub fn is_empty(&self) -> bool {
        self.usual.is_empty() && self.of_user.is_empty()
    }

    /// All of them; of two for the same the last counts.
    pub(super) fn in_order(&self) -> impl Iterator<Item = &str> {
        self.usual.iter().chain(&self.of_user).map(String::as_str)
    }

    /// Replaces the gains of the guide that let some firmware fall in LAND; gives the settings that stand there now.
    pub(super) fn replace_falling_gains(&mut self) -> Vec<String> {
        let mut replaced = Vec::new();
        for line in &mut self.usual {
            if let Some(setting) = line.strip_prefix(SET).and_then(landing_gain) {
                *line = format!("{SET}{setting}");
                if !replaced.contains(&setting) {
                    replaced.push(setting);
                }
            }
        }
        replaced
    }
}
