//! The table of actions: name, title, help and default keys.

use super::{Action, Context, EditAction, PanelAction, Spec, edit, general, panels};
use crate::ui::model::panel_table::{ROWS, Row};

/// A part of the table.
enum Part {
    General(&'static [Spec]),
    Edit(&'static [Spec<EditAction>]),
    Panel(&'static [Spec<PanelAction>]),
}

impl Part {
    const fn len(&self) -> usize {
        match self {
            Self::General(rows) => rows.len(),
            Self::Edit(rows) => rows.len(),
            Self::Panel(rows) => rows.len(),
        }
    }

    const fn row(&self, at: usize) -> Spec {
        match self {
            Self::General(rows) => rows[at],
            Self::Edit(rows) => rows[at].of(Action::Edit(rows[at].action)),
            Self::Panel(rows) => rows[at].of(Action::Panel(rows[at].action)),
        }
    }
}

/// The parts of the table, in the order help shows them.
const PARTS: [Part; 11] = [
    Part::General(general::FLIGHT),
    Part::Edit(edit::EVERYWHERE),
    Part::General(general::TIME),
    Part::General(&SHOW),
    Part::General(general::SCREEN),
    Part::Panel(panels::ON_MAP),
    Part::Edit(edit::MAP),
    Part::Edit(edit::PLAN),
    Part::Panel(panels::OTHERS),
    Part::Panel(panels::ON_SETTINGS),
    Part::General(general::LISTS),
];

/// The actions that show a panel.
const SHOW: [Spec; ROWS.len()] = {
    let mut rows = [general::FLIGHT[0]; ROWS.len()];
    let mut at = 0;
    while at < rows.len() {
        let Row { panel, action: (name, title, help), keys, .. } = &ROWS[at];
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
    let mut all = [PARTS[0].row(0); N];
    let (mut at, mut part) = (0, 0);
    while part < PARTS.len() {
        let mut row = 0;
        while row < PARTS[part].len() {
            all[at] = PARTS[part].row(row);
            at += 1;
            row += 1;
        }
        part += 1;
    }
    all
}
