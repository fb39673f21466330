//! The table of actions: name, title, help and default keys.

use super::{Action, Context, EditAction, Spec, panels};
use crate::ui::panel;

mod general;
mod lists;
mod map;
mod plan;

pub(super) const fn spec(
    action: Action,
    name: &'static str,
    title: &'static str,
    help: &'static str,
    keys: &'static [&'static str],
    context: Context,
) -> Spec {
    Spec { action, name, title, help, keys, context }
}

const fn edit(
    action: EditAction,
    name: &'static str,
    title: &'static str,
    help: &'static str,
    keys: &'static [&'static str],
    context: Context,
) -> Spec {
    spec(Action::Edit(action), name, title, help, keys, context)
}

/// The parts of the table, in the order help shows them.
const PARTS: [&[Spec]; 8] = [
    general::FLIGHT,
    &SHOW,
    general::SCREEN,
    panels::MAP,
    map::ROWS,
    plan::ROWS,
    panels::OTHERS,
    lists::ROWS,
];

/// The actions that show a panel.
const SHOW: [Spec; panel::ROWS.len()] = {
    let mut rows = [general::FLIGHT[0]; panel::ROWS.len()];
    let mut at = 0;
    while at < rows.len() {
        let panel::Row { panel, action: (name, title, help), keys, .. } = &panel::ROWS[at];
        rows[at] = spec(Action::Show(*panel), name, title, help, keys, Context::Global);
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
