//! Lines of other builds. They have no effect here, but dump and diff print them, so that a real craft's file stays
//! complete.

use super::super::settings::Scope;

/// The most characters kept, far more than a whole `dump all` of any build contains.
const MAX_CHARACTERS: usize = 1 << 17;
/// The cost of a line in addition to its own characters.
const LINE_COST: usize = 64;

/// A line that is kept but has no effect here.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeptLine {
    /// The section that the line came in.
    pub scope: Scope,
    /// The profile of that section.
    pub instance: u8,
    /// The name of the foreign setting; empty for a foreign command.
    pub name: String,
    /// The value of the setting, or the whole command line.
    pub text: String,
}

impl KeptLine {
    /// Returns the line as it is typed.
    pub fn command(&self) -> String {
        if self.name.is_empty() { self.text.clone() } else { format!("set {} = {}", self.name, self.text) }
    }

    fn cost(&self) -> usize {
        self.name.len() + self.text.len() + LINE_COST
    }
}

/// All kept lines, section by section, in the order in which they came.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct KeptLines {
    lines: Vec<KeptLine>,
    /// The total cost of all lines.
    cost: usize,
}

impl KeptLines {
    /// Keeps a line. A setting replaces its earlier value; without a value it removes it. A command that is already
    /// kept is not repeated. Returns `false` if there is no room.
    pub fn keep(&mut self, mut line: KeptLine) -> bool {
        // Stored in the form in which it would be typed again.
        line.text = line.text.replace(char::is_control, " ").trim().to_owned();
        // Compares from the end, because lines of a family start alike and a file may have very many of them.
        let is_same = |a: &str, b: &str| a.len() == b.len() && a.bytes().rev().eq(b.bytes().rev());
        let same_place = |old: &KeptLine| {
            old.scope == line.scope
                && old.instance == line.instance
                && is_same(&old.name, &line.name)
                && (!line.name.is_empty() || is_same(&old.text, &line.text))
        };
        if line.text.is_empty() {
            if let Some(at) = self.lines.iter().position(same_place) {
                self.cost -= self.lines.remove(at).cost();
            }
            return true;
        }
        let cost = self.cost + line.cost();
        if let Some(old) = self.lines.iter_mut().find(|old| same_place(old)) {
            let cost = cost - old.cost();
            if cost > MAX_CHARACTERS {
                return false;
            }
            self.cost = cost;
            old.text = line.text;
            return true;
        }
        let room = cost <= MAX_CHARACTERS;
        if room {
            self.cost = cost;
            let place = |line: &KeptLine| (line.scope, line.instance);
            let end = self.lines.partition_point(|old| place(old) <= place(&line));
            self.lines.insert(end, line);
        }
        room
    }

    /// Iterates over all lines in order.
    pub fn iter(&self) -> impl Iterator<Item = &KeptLine> {
        self.lines.iter()
    }

    /// Iterates over the lines of one section.
    pub fn of(&self, scope: Scope, instance: u8) -> impl Iterator<Item = &KeptLine> {
        self.lines.iter().filter(move |line| line.scope == scope && line.instance == instance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(instance: u8, name: &str, text: &str) -> KeptLine {
        KeptLine { scope: Scope::Profile, instance, name: name.to_owned(), text: text.to_owned() }
    }

    #[test]
    fn settings_replace_their_value_and_commands_are_not_repeated() {
        let mut kept = KeptLines::default();
        for kept_line in [
            line(1, "dyn_idle_min_rpm", "30"),
            line(0, "dyn_idle_min_rpm", "20"),
            line(1, "", "led 0 0,0::C:0"),
            line(1, "", "led 0 0,0::C:0"),
            line(1, "dyn_idle_min_rpm", " 4\t0\t\r"),
        ] {
            assert!(kept.keep(kept_line));
        }
        let commands: Vec<String> = kept.iter().map(KeptLine::command).collect();
        assert_eq!(commands, ["set dyn_idle_min_rpm = 20", "set dyn_idle_min_rpm = 4 0", "led 0 0,0::C:0"]);
    }

    #[test]
    fn a_name_that_is_cleared_leaves_no_empty_line() {
        let mut kept = KeptLines::default();
        assert!(kept.keep(line(0, "pilot_name", "")));
        assert_eq!(kept.iter().count(), 0);
        assert!(kept.keep(line(0, "pilot_name", "ACE")) && kept.keep(line(0, "pilot_name", " ")));
        assert_eq!(kept, KeptLines::default());
    }

    #[test]
    fn the_room_is_limited() {
        let mut kept = KeptLines::default();
        let stored = (0..10_000)
            .take_while(|at| kept.keep(line(0, "", &format!("led {at} {}", "x".repeat(200)))))
            .count();
        assert!((300..1000).contains(&stored), "{stored}");
    }

    #[test]
    fn a_new_value_needs_room_too() {
        let mut kept = KeptLines::default();
        assert!(kept.keep(line(0, "a", "short")));
        let half = "x".repeat(MAX_CHARACTERS / 2);
        assert!(kept.keep(line(0, "b", &half)));
        assert!(!kept.keep(line(0, "a", &half)));
        assert_eq!(kept.iter().next().map(KeptLine::command).as_deref(), Some("set a = short"));
        assert!(kept.keep(line(0, "b", "short")) && kept.keep(line(0, "a", &half)));
    }
}
