//! Edits on the map.

use super::edit;
use crate::ui::action::Context::In;
use crate::ui::action::{EditAction, Spec};
use crate::ui::panel::Panel;

pub(super) const ROWS: &[Spec] = &[
    edit(
        EditAction::OnMap,
        "map.edit",
        "edit",
        "Edit waypoints on the map with a cursor, or stop it",
        &["p"],
        In(Panel::Map),
    ),
    edit(
        EditAction::Pick,
        "map.pick",
        "pick",
        "Pick up the waypoint at the cursor, or put it down",
        &["enter"],
        In(Panel::Map),
    ),
    edit(
        EditAction::AddOnMap,
        "map.insert",
        "insert",
        "Add a waypoint at the cursor",
        &["i"],
        In(Panel::Map),
    ),
    edit(
        EditAction::DeleteOnMap,
        "map.delete",
        "delete",
        "Delete the waypoint at the cursor",
        &["d", "delete"],
        In(Panel::Map),
    ),
];
