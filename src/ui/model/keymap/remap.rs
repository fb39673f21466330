//! The user's own keys, and checks of them.

use crossterm::event::{KeyCode, KeyModifiers};

use super::{KeyPress, Keymap};
use crate::text::did_you_mean;
use crate::ui::model::action::{ACTIONS, Context, Spec};
use crate::ui::model::panel_table::Panel;

/// A line of the configuration file: an action and the keys that replace its default ones.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyLine {
    /// The line number in the file, from 1.
    pub line: usize,
    /// Name of the action.
    pub action: String,
    /// Its keys as text; "" for no key.
    pub keys: Vec<String>,
}

impl Keymap {
    /// Returns the default keymap with these changes.
    ///
    /// # Errors
    /// Returns a sentence for each problem, with the number of its line.
    pub fn remapped(lines: &[KeyLine]) -> Result<Self, Vec<(usize, String)>> {
        let mut map = Self::default();
        let mut problems = Vec::new();
        let mut changed: Vec<(usize, &'static Spec)> = Vec::new();
        for line in lines {
            let Some(spec) = ACTIONS.iter().find(|spec| spec.name == line.action) else {
                let guess = did_you_mean::suffix(&line.action, ACTIONS.iter().map(|spec| spec.name));
                problems.push((line.line, format!("there is no action {}{guess}", line.action)));
                continue;
            };
            map.bindings.retain(|binding| binding.2 != spec.action);
            changed.push((line.line, spec));
            for text in line.keys.iter().filter(|text| !text.is_empty()) {
                match KeyPress::parse(text) {
                    None => problems.push((
                        line.line,
                        format!(
                            "{text:?} is no key; write a character or a name such as space, enter, f1, ctrl-a or \
                             shift-up"
                        ),
                    )),
                    Some(key) if spec.context == Context::Always && key.is_text() => problems.push((
                        line.line,
                        format!("{} works while text is typed, so that {text} cannot be its key", spec.name),
                    )),
                    Some(key) => map.bindings.push((spec.context, key, spec.action)),
                }
            }
        }
        problems.extend(map.conflicts(&changed));
        if problems.is_empty() { Ok(map) } else { Err(problems) }
    }

    /// Returns a sentence for each key that has two meanings in one place because of the changes.
    fn conflicts(&self, changed: &[(usize, &'static Spec)]) -> Vec<(usize, String)> {
        let mut problems = Vec::new();
        for (at, (context, key, action)) in self.bindings.iter().enumerate() {
            let Some((line, spec)) = changed.iter().find(|(_, spec)| spec.action == *action) else {
                continue;
            };
            let same_place = |other: &Spec| clash(*context, other.context);
            for (before, (_, other_key, other)) in self.bindings.iter().enumerate() {
                let Some(other) = ACTIONS.iter().find(|spec| spec.action == *other) else { continue };
                // Of two changed actions only the later one reports the conflict.
                let reported_there =
                    before > at && changed.iter().any(|(_, spec)| spec.action == other.action);
                if key == other_key && other.action != *action && same_place(other) && !reported_there {
                    problems.push((
                        *line,
                        format!(
                            "{key} means {} and {}: give one of them another key, or none with \"\"",
                            spec.name, other.name
                        ),
                    ));
                }
            }
        }
        problems
    }
}

/// Returns `true` if keys of the two contexts meet on one level. A panel's own keys come before the general ones.
fn clash(one: Context, other: Context) -> bool {
    let is_general = |context| matches!(context, Context::Global | Context::Always);
    match (is_general(one), is_general(other)) {
        (true, true) => true,
        (false, false) => Panel::ALL.into_iter().any(|panel| one.applies(panel) && other.applies(panel)),
        _ => false,
    }
}

impl KeyPress {
    /// Returns `true` if a text field takes it as text.
    fn is_text(&self) -> bool {
        matches!(self.code, KeyCode::Char(_))
            && !self.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_have_no_conflict() {
        let all: Vec<_> = ACTIONS.iter().map(|spec| (1, spec)).collect();
        assert_eq!(Keymap::default().conflicts(&all), []);
    }

    #[test]
    fn two_changed_actions_with_one_key_are_reported_once() {
        let line =
            |line, action: &str| KeyLine { line, action: action.to_owned(), keys: vec!["f10".to_owned()] };
        let problems = Keymap::remapped(&[line(4, "flight.arm"), line(5, "map.fit"), line(6, "sim.step")])
            .expect_err("a conflict");
        assert_eq!(problems.len(), 1, "a panel's own key is none: {problems:?}");
        assert!(problems[0].1.starts_with("F10 means sim.step and flight.arm"), "{problems:?}");
        assert_eq!(problems[0].0, 6);
    }
}
