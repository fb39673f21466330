//! The table of actions: name, title, help and default keys.

use super::{Action, Context, EditAction, Spec};

mod general;
mod map;
mod panels;
mod plan;

const fn spec(
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
const PARTS: [&[Spec]; 4] = [general::ROWS, map::ROWS, plan::ROWS, panels::ROWS];

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
