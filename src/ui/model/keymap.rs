//! Keys as text and as events, and the action of a key for the current focus.

use std::fmt;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use crate::ui::model::action::{ACTIONS, Action, Context, spec_of};
use crate::ui::model::panel_table::Panel;

mod remap;

pub use remap::KeyLine;

/// A key with its modifiers. Shift is part of the character if there is one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeyPress {
    code: KeyCode,
    modifiers: KeyModifiers,
}

impl KeyPress {
    /// Returns the key of an event.
    pub fn of(event: &KeyEvent) -> Self {
        let mut modifiers =
            event.modifiers & (KeyModifiers::CONTROL | KeyModifiers::ALT | KeyModifiers::SHIFT);
        let code = match event.code {
            KeyCode::BackTab => {
                modifiers |= KeyModifiers::SHIFT;
                KeyCode::Tab
            }
            KeyCode::Char(c) => {
                // Not all terminals report shift beside the capital letter.
                let c = if modifiers.contains(KeyModifiers::SHIFT) { c.to_ascii_uppercase() } else { c };
                modifiers -= KeyModifiers::SHIFT;
                KeyCode::Char(c)
            }
            code => code,
        };
        Self { code, modifiers }
    }

    /// Returns the event that a terminal sends for it.
    pub fn event(self) -> KeyEvent {
        KeyEvent::new(self.code, self.modifiers)
    }

    /// Returns `true` if the key triggers its action of this context while `focus` has the focus.
    fn applies(self, context: Context, focus: Panel) -> bool {
        // Function keys are never text, nor are characters with Alt.
        let is_no_text = match self.code {
            KeyCode::F(_) => true,
            KeyCode::Char(_) => self.modifiers.contains(KeyModifiers::ALT),
            _ => false,
        };
        context.applies(focus) || is_no_text && context == Context::Global
    }

    /// Parses a key from text: `a`, `F`, `space`, `ctrl-c`, `shift-tab`, `f1`. Names may be written in capitals, too.
    pub fn parse(text: &str) -> Option<Self> {
        let lower = text.to_ascii_lowercase();
        // A single character means itself: `F` is not `f`.
        let mut rest = if text.chars().nth(1).is_some() { lower.as_str() } else { text };
        let mut modifiers = KeyModifiers::NONE;
        for (prefix, modifier) in
            [("ctrl-", KeyModifiers::CONTROL), ("alt-", KeyModifiers::ALT), ("shift-", KeyModifiers::SHIFT)]
        {
            if let Some(after) = rest.strip_prefix(prefix) {
                modifiers |= modifier;
                rest = after;
            }
        }
        let mut chars = rest.chars();
        let code = match (rest, chars.next(), chars.next()) {
            ("space", ..) => KeyCode::Char(' '),
            ("tab", ..) => KeyCode::Tab,
            ("esc", ..) => KeyCode::Esc,
            ("enter", ..) => KeyCode::Enter,
            ("up", ..) => KeyCode::Up,
            ("down", ..) => KeyCode::Down,
            ("left", ..) => KeyCode::Left,
            ("right", ..) => KeyCode::Right,
            ("home", ..) => KeyCode::Home,
            ("end", ..) => KeyCode::End,
            ("pageup", ..) => KeyCode::PageUp,
            ("pagedown", ..) => KeyCode::PageDown,
            ("insert", ..) => KeyCode::Insert,
            ("delete", ..) => KeyCode::Delete,
            ("backspace", ..) => KeyCode::Backspace,
            // Capitals are distinct, but terminals send Ctrl with small letters only.
            (_, Some(c), None) if modifiers.contains(KeyModifiers::CONTROL) => KeyCode::Char(c),
            (_, Some(_), None) if modifiers.contains(KeyModifiers::SHIFT) => {
                modifiers -= KeyModifiers::SHIFT;
                KeyCode::Char(text.chars().last()?.to_ascii_uppercase())
            }
            (_, Some(_), None) => KeyCode::Char(text.chars().last()?),
            (_, Some('f'), Some(_)) => KeyCode::F(rest[1..].parse().ok()?),
            _ => return None,
        };
        Some(Self { code, modifiers })
    }
}

impl fmt::Display for KeyPress {
    /// Formats the key for hint bar and help.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (modifier, name) in
            [(KeyModifiers::CONTROL, "Ctrl-"), (KeyModifiers::ALT, "Alt-"), (KeyModifiers::SHIFT, "Shift-")]
        {
            if self.modifiers.contains(modifier) {
                f.write_str(name)?;
            }
        }
        match self.code {
            KeyCode::Char(' ') => f.write_str("Space"),
            KeyCode::Char(c) if self.modifiers.contains(KeyModifiers::CONTROL) => {
                write!(f, "{}", c.to_ascii_uppercase())
            }
            KeyCode::Char(c) => write!(f, "{c}"),
            KeyCode::Up => f.write_str("↑"),
            KeyCode::Down => f.write_str("↓"),
            KeyCode::Left => f.write_str("←"),
            KeyCode::Right => f.write_str("→"),
            KeyCode::PageUp => f.write_str("PgUp"),
            KeyCode::PageDown => f.write_str("PgDn"),
            KeyCode::Insert => f.write_str("Ins"),
            KeyCode::Delete => f.write_str("Del"),
            KeyCode::F(number) => write!(f, "F{number}"),
            code => write!(f, "{code:?}"),
        }
    }
}

/// The actions of the keys.
#[derive(Debug, Clone)]
pub struct Keymap {
    bindings: Vec<(Context, KeyPress, Action)>,
    /// `true` if sentences name the commands in place of the keys, because nobody presses keys.
    names_commands: bool,
}

impl Default for Keymap {
    /// Returns the default keys of the action table.
    fn default() -> Self {
        let bindings = ACTIONS
            .iter()
            .flat_map(|spec| {
                spec.keys.iter().filter_map(|key| Some((spec.context, KeyPress::parse(key)?, spec.action)))
            })
            .collect();
        Self { bindings, names_commands: false }
    }
}

impl Keymap {
    /// Returns the same keys for input that is lines of text: sentences name commands, and no key is shown.
    #[must_use]
    pub(in crate::ui) fn without_a_screen(self) -> Self {
        Self { names_commands: true, ..self }
    }

    /// Returns the keys of an action as text; none where commands are named.
    pub fn shown_keys(&self, action: Action) -> Vec<String> {
        let bindings = self.bindings.iter().filter(|_| !self.names_commands);
        bindings.filter(|binding| binding.2 == action).map(|binding| binding.1.to_string()).collect()
    }

    /// Returns the first key that triggers an action while `focus` has the focus.
    pub(in crate::ui) fn shown_key_in(&self, action: Action, focus: Panel) -> Option<String> {
        let mut bindings = self.bindings.iter().filter(|_| !self.names_commands);
        let found = bindings.find(|(context, key, of)| *of == action && key.applies(*context, focus))?;
        Some(found.1.to_string())
    }

    /// Returns the first key of an action, or the command that triggers it if it has no key.
    pub fn key(&self, action: Action) -> String {
        let first = self.shown_keys(action).into_iter().next();
        let name = || spec_of(action).map_or("", |spec| spec.name);
        let command = || if self.names_commands { name().to_owned() } else { format!(":{}", name()) };
        first.unwrap_or_else(command)
    }

    /// Replaces the default keys in backquotes in a sentence of the session with the current keys.
    pub fn in_force(&self, sentence: &str) -> String {
        let mut parts = sentence.split('`');
        let mut reported = parts.next().unwrap_or_default().to_owned();
        let mut is_quoted = true;
        for part in parts {
            let pressed = KeyPress::parse(part).filter(|_| is_quoted);
            let is_default = |key: &&str| pressed.is_some() && KeyPress::parse(key) == pressed;
            // Sentences from other modules name the keys of the plan editor, too.
            let named = |wanted: fn(Context) -> bool| {
                ACTIONS
                    .iter()
                    .filter(|spec| wanted(spec.context))
                    .find(|spec| spec.keys.iter().any(is_default))
            };
            let action = named(|context| matches!(context, Context::Global | Context::Always))
                .or_else(|| named(|context| context == Context::In(Panel::Plan)));
            let text = action.map_or_else(|| part.to_owned(), |spec| self.key(spec.action));
            reported.push('`');
            reported.push_str(&text);
            is_quoted = !is_quoted;
        }
        reported
    }

    /// Returns the action of a key while `focus` has the focus. The panel's own actions come before the general ones.
    pub fn action(&self, key: KeyPress, focus: Panel) -> Option<Action> {
        let own = |context: &Context| matches!(context, Context::In(_) | Context::Lists);
        let mut hits = self.bindings.iter().filter(|(context, k, _)| *k == key && k.applies(*context, focus));
        let first = hits.next()?;
        let best = if own(&first.0) { first } else { hits.find(|hit| own(&hit.0)).unwrap_or(first) };
        Some(best.2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::model::action::PanelAction;

    #[test]
    fn every_default_key_parses_and_none_is_used_twice_in_one_place() {
        for spec in ACTIONS {
            for key in spec.keys {
                assert!(KeyPress::parse(key).is_some(), "{key} of {}", spec.name);
                let same = |other: &&crate::ui::model::action::Spec| {
                    other.context == spec.context && other.keys.contains(key)
                };
                assert_eq!(ACTIONS.iter().filter(same).count(), 1, "{key} of {}", spec.name);
            }
        }
    }

    #[test]
    fn letters_are_text_in_the_cli_and_panels_come_before_the_rest() {
        let keymap = Keymap::default();
        let key = |text| KeyPress::parse(text).expect("a key");
        assert_eq!(keymap.action(key("a"), Panel::Map), Some(Action::Arm));
        assert_eq!(keymap.action(key("a"), Panel::Cli), None);
        assert_eq!(keymap.action(key("ctrl-c"), Panel::Cli), Some(Action::Cancel));
        assert_eq!(keymap.action(key("f1"), Panel::Cli), Some(Action::Show(Panel::Map)));
        assert_eq!(keymap.action(key("up"), Panel::Rc), Some(Action::Panel(PanelAction::ChannelUp)));
        assert_eq!(keymap.action(key("up"), Panel::Log), Some(Action::ScrollUp));
    }

    #[test]
    fn sentences_name_the_keys_in_force() {
        let line = |action: &str, key: &str| KeyLine {
            line: 1,
            action: action.to_owned(),
            keys: vec![key.to_owned()],
        };
        let lines = [line("flight.arm", "f10"), line("app.palette", "ctrl-k"), line("flight.home", "")];
        let keymap = Keymap::remapped(&lines).expect("no conflict");
        assert_eq!(
            keymap.in_force("`a` disarms, `save` stays, `Ctrl-P` lists; a `b"),
            "`F10` disarms, `save` stays, `Ctrl-K` lists; a `b"
        );
        assert_eq!(keymap.key(Action::Arm), "F10");
    }

    #[test]
    fn keys_are_shown_as_they_stand_on_the_keyboard() {
        for (text, shown) in [
            ("a", "a"),
            ("space", "Space"),
            ("shift-left", "Shift-←"),
            ("ctrl-c", "Ctrl-C"),
            ("f10", "F10"),
            ("pagedown", "PgDn"),
            ("esc", "Esc"),
            ("shift-tab", "Shift-Tab"),
            ("alt-G", "Alt-G"),
            ("alt-shift-g", "Alt-G"),
            ("Ctrl-P", "Ctrl-P"),
        ] {
            assert_eq!(KeyPress::parse(text).map(|key| key.to_string()).as_deref(), Some(shown));
        }
    }

    #[test]
    fn shift_is_reported_by_the_capital_letter() {
        let plain = KeyEvent::new(KeyCode::Char('F'), KeyModifiers::NONE);
        let shifted = KeyEvent::new(KeyCode::Char('F'), KeyModifiers::SHIFT);
        let kitty = KeyEvent::new(KeyCode::Char('f'), KeyModifiers::SHIFT);
        assert_eq!(KeyPress::of(&plain), KeyPress::of(&shifted));
        assert_eq!(KeyPress::of(&plain), KeyPress::of(&kitty));
    }
}
