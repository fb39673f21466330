//! Every action of a key, by name: the one table for keymap, hint bar, help, palette and the `:` line.

use crate::ui::model::panel_table::Panel;

mod edit;
mod general;
mod panels;
mod rows;
mod table;

pub use edit::EditAction;
pub use general::Action;
pub use panels::PanelAction;
pub use table::ACTIONS;

/// The context in which a key triggers its action.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Context {
    /// Everywhere but in text fields.
    Global,
    /// Everywhere, in text fields too.
    Always,
    /// While this panel has the focus.
    In(Panel),
    /// While a panel that scrolls has the focus.
    Lists,
}

/// A row of the table, or of the part of it for one kind of actions.
#[derive(Debug, Clone, Copy)]
pub struct Spec<A = Action> {
    pub action: A,
    /// Stable name for keymaps and scripts, such as `rc.cut`.
    pub name: &'static str,
    /// A word or two for the hint bar.
    pub title: &'static str,
    /// A sentence for the help.
    pub help: &'static str,
    /// Default keys as text.
    pub keys: &'static [&'static str],
    /// The context in which the keys trigger the action.
    pub context: Context,
}

impl<A: Copy> Spec<A> {
    /// Returns the row in the whole table, where this is its action.
    const fn of(&self, action: Action) -> Spec {
        Spec {
            action,
            name: self.name,
            title: self.title,
            help: self.help,
            keys: self.keys,
            context: self.context,
        }
    }
}

/// Returns the row of an action.
pub fn spec_of(action: Action) -> Option<&'static Spec> {
    ACTIONS.iter().find(|spec| spec.action == action)
}

impl Context {
    /// Returns `true` if keys of this context apply while `focus` has the focus. In a text field letters are text.
    pub fn applies(self, focus: Panel) -> bool {
        match self {
            Self::Always => true,
            Self::Global => !focus.takes_text(),
            Self::In(panel) => panel == focus,
            Self::Lists => focus.is_list(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_action_has_a_key_and_a_name_of_its_own() {
        for spec in ACTIONS {
            assert!(!spec.keys.is_empty(), "{} has no key", spec.name);
            assert_eq!(ACTIONS.iter().filter(|other| other.name == spec.name).count(), 1, "{}", spec.name);
        }
    }
}
