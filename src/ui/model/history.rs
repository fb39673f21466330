//! The lines entered in a text field, for recall, and the names chosen in the palette.

/// A text field whose lines survive a restart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineField {
    /// The `:` line.
    Command,
    /// The firmware's command line.
    Cli,
    /// The palette: the names of what was chosen.
    Palette,
}

/// The lines entered in earlier runs, the oldest first.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct EnteredLines {
    /// The lines entered in the `:` line.
    pub commands: Vec<String>,
    /// The lines entered in the firmware's command line.
    pub cli: Vec<String>,
    /// The names chosen in the palette.
    pub palette: Vec<String>,
}

const MAX_LINES: usize = 500;

/// The entered lines, the oldest first, and the recalled one.
#[derive(Debug, Default)]
pub(in crate::ui) struct History {
    lines: Vec<String>,
    recalled: Option<usize>,
    /// The text that was being typed when the first line was recalled.
    draft: String,
}

impl History {
    /// Returns a history that begins with these lines.
    pub(in crate::ui) fn of(lines: &[String]) -> Self {
        let mut history = Self::default();
        for line in lines {
            history.remember(line);
        }
        history
    }

    /// Adds an entered line, unless it is blank or equal to the one before. Returns `true` if it was added.
    pub(in crate::ui) fn remember(&mut self, line: &str) -> bool {
        self.recalled = None;
        if line.trim().is_empty() || self.lines.last().is_some_and(|last| last == line) {
            return false;
        }
        if self.lines.len() == MAX_LINES {
            self.lines.remove(0);
        }
        self.lines.push(line.to_owned());
        true
    }

    /// Ends recalling: the text typed next is new.
    pub(in crate::ui) fn forget_place(&mut self) {
        self.recalled = None;
    }

    /// Returns the line before the recalled one, or the newest instead of `typed`; `None` if there is no older one.
    pub(in crate::ui) fn older(&mut self, typed: &str) -> Option<String> {
        let at = match self.recalled {
            None => self.lines.len().checked_sub(1)?,
            Some(at) => at.checked_sub(1)?,
        };
        if self.recalled.is_none() {
            typed.clone_into(&mut self.draft);
        }
        self.recalled = Some(at);
        self.lines.get(at).cloned()
    }

    /// Returns the line after the recalled one, or the typed text after the newest; `None` if no line is recalled.
    pub(in crate::ui) fn newer(&mut self) -> Option<String> {
        let next = self.recalled? + 1;
        if next < self.lines.len() {
            self.recalled = Some(next);
            return self.lines.get(next).cloned();
        }
        self.recalled = None;
        Some(std::mem::take(&mut self.draft))
    }
}

/// The names chosen in the palette, the newest last.
#[derive(Debug, Clone, Default)]
pub struct UsedNames(Vec<String>);

/// The most names that are remembered.
const MAX_USED: usize = 50;

impl UsedNames {
    /// Returns the names chosen in earlier runs, the newest last.
    pub(in crate::ui) fn of(names: &[String]) -> Self {
        let mut used = Self::default();
        for name in names {
            used.remember(name);
        }
        used
    }

    /// Makes a name the newest one.
    pub(in crate::ui) fn remember(&mut self, name: &str) {
        self.0.retain(|used| used != name);
        if self.0.len() == MAX_USED {
            self.0.remove(0);
        }
        self.0.push(name.to_owned());
    }

    /// Returns the weight of a name: the newest one has the greatest, one that was never chosen has none.
    pub(in crate::ui) fn weight(&self, name: &str) -> u32 {
        self.0.iter().position(|used| used == name).map_or(0, |at| (MAX_USED - self.0.len() + at + 1) as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_bounded_and_keeps_no_line_twice_in_a_row() {
        let mut history = History::default();
        for n in 0..MAX_LINES + 3 {
            history.remember(&n.to_string());
            history.remember(&n.to_string());
        }
        history.remember("  ");
        assert_eq!(history.older("").as_deref(), Some("502"));
        for _ in 1..MAX_LINES {
            assert!(history.older("").is_some());
        }
        assert_eq!(history.older(""), None, "500 are kept");
    }

    #[test]
    fn the_newest_name_weighs_most_and_their_number_is_bounded() {
        let mut used = UsedNames::of(&["a", "b", "a"].map(str::to_owned));
        assert!(used.weight("a") > used.weight("b") && used.weight("b") > 0);
        assert_eq!(used.weight("c"), 0);
        for number in 0..200 {
            used.remember(&number.to_string());
        }
        assert_eq!((used.0.len(), used.weight("199")), (MAX_USED, MAX_USED as u32));
    }
}
