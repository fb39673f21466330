//! Lines of other builds: no effect here, printed again by dump and diff so that a real craft's file stays complete.

use super::super::settings::Scope;

/// The most characters kept, far above what a whole `dump all` of any build contains.
const MAX_CHARACTERS: usize = 1 << 18;
/// What a line costs beside its own characters.
const LINE_COST: usize = 64;

/// One kept line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeptLine {
    /// Section it came in.
    pub scope: Scope,
    /// Profile of that section.
    pub instance: u8,
    /// Name of the foreign setting; empty for a foreign command.
    pub name: String,
    /// Value of the setting, or the whole command line.
    pub text: String,
}

impl KeptLine {
    /// The line as it is typed.
    #[must_use]
    pub fn command(&self) -> String {
        if self.name.is_empty() { self.text.clone() } else { format!("set {} = {}", self.name, self.text) }
    }
}

/// All kept lines, section by section, in the order in which they came.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct KeptLines(Vec<KeptLine>);

impl KeptLines {
    /// Keeps a line: a setting replaces its earlier value, a command already kept is not repeated. `false` when there
    /// is no room.
    pub fn keep(&mut self, mut line: KeptLine) -> bool {
        line.text = line.text.replace(char::is_control, " ");
        let same_place = |old: &&mut KeptLine| {
            old.scope == line.scope
                && old.instance == line.instance
                && old.name == line.name
                && (!line.name.is_empty() || old.text == line.text)
        };
        if let Some(old) = self.0.iter_mut().find(same_place) {
            old.text = line.text;
            return true;
        }
        let cost = |line: &KeptLine| line.name.len() + line.text.len() + LINE_COST;
        let room = self.0.iter().map(cost).sum::<usize>() + cost(&line) <= MAX_CHARACTERS;
        if room {
            let place = |line: &KeptLine| (line.scope, line.instance);
            let end = self.0.partition_point(|old| place(old) <= place(&line));
            self.0.insert(end, line);
        }
        room
    }

    /// All lines in order.
    pub fn iter(&self) -> impl Iterator<Item = &KeptLine> {
        self.0.iter()
    }

    /// The lines of one section.
    pub fn of(&self, scope: Scope, instance: u8) -> impl Iterator<Item = &KeptLine> {
        self.0.iter().filter(move |line| line.scope == scope && line.instance == instance)
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
            line(1, "dyn_idle_min_rpm", "40\t\r"),
        ] {
            assert!(kept.keep(kept_line));
        }
        let commands: Vec<String> = kept.iter().map(KeptLine::command).collect();
        assert_eq!(commands, ["set dyn_idle_min_rpm = 20", "set dyn_idle_min_rpm = 40  ", "led 0 0,0::C:0"]);
    }

    #[test]
    fn the_room_is_limited() {
        let mut kept = KeptLines::default();
        let stored = (0..10_000)
            .take_while(|at| kept.keep(line(0, "", &format!("led {at} {}", "x".repeat(200)))))
            .count();
        assert!((500..2000).contains(&stored), "{stored}");
    }
}
