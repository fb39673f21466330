//! The table of actions: name, title, help and default keys.

use super::{Action, Context, Spec, edit, general, panels};
use crate::ui::panel;

/// Makes an enum with a variant for each row, and a list of the rows of each group. A row has the context of its keys,
/// a stable name, a title, a help and the keys. `wrap` makes a member of the enum an [`Action`].
macro_rules! actions {
    ($(#[$meta:meta])* $name:ident [$wrap:path] { $($other:tt)* }
        $($group:ident { $($action:ident $context:ident $id:literal $title:literal $help:literal [$($key:literal),+];)* })*
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name {
            $($(#[doc = $help] $action,)*)*
            $($other)*
        }

        $(pub(super) const $group: &[super::Spec] = &[$(super::Spec {
            action: $wrap($name::$action),
            name: $id,
            title: $title,
            help: $help,
            keys: &[$($key),+],
            context: $context,
        }),*];)*
    };
}
pub(super) use actions;

/// The parts of the table, in the order help shows them.
const PARTS: [&[Spec]; 11] = [
    general::FLIGHT,
    edit::EVERYWHERE,
    general::TIME,
    &SHOW,
    general::SCREEN,
    panels::ON_MAP,
    edit::MAP,
    edit::PLAN,
    panels::OTHERS,
    panels::ON_SETTINGS,
    general::LISTS,
];

/// The actions that show a panel.
const SHOW: [Spec; panel::ROWS.len()] = {
    let mut rows = [general::FLIGHT[0]; panel::ROWS.len()];
    let mut at = 0;
    while at < rows.len() {
        let panel::Row { panel, action: (name, title, help), keys, .. } = &panel::ROWS[at];
        rows[at] = Spec { action: Action::Show(*panel), name, title, help, keys, context: Context::Global };
        at += 1;
    }
    rows
};

pub const ACTIONS: &[Spec] = &joined::<{ count() }>();

const fn count() -> usize {
    let (mut count, mut part) = (0, 0);
    while part < PARTS.len() {
        count += PARTS[part].len();
        part += 1;
    }
    count
}

/// Joins the parts into one list.
const fn joined<const N: usize>() -> [Spec; N] {
    let mut all = [PARTS[0][0]; N];
    let (mut at, mut part) = (0, 0);
    while part < PARTS.len() {
        let mut row = 0;
        while row < PARTS[part].len() {
            all[at] = PARTS[part][row];
            at += 1;
            row += 1;
        }
        part += 1;
    }
    all
}
