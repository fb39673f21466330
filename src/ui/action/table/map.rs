//! Actions of the Map panel.

use super::{edit, spec};
use crate::ui::action::Context::In;
use crate::ui::action::{Action, EditAction, Spec};
use crate::ui::panel::Panel;

pub(super) const ROWS: &[Spec] = &[
    spec(Action::PanUp, "map.up", "up", "Pan up", &["up", "k"], In(Panel::Map)),
    spec(Action::PanDown, "map.down", "down", "Pan down", &["down", "j"], In(Panel::Map)),
    spec(Action::PanLeft, "map.left", "left", "Pan left", &["left", "h"], In(Panel::Map)),
    spec(Action::PanRight, "map.right", "right", "Pan right", &["right", "l"], In(Panel::Map)),
    spec(
        Action::ZoomIn,
        "map.zoom-in",
        "zoom in",
        "Zoom in (or the mouse wheel)",
        &["+", "="],
        In(Panel::Map),
    ),
    spec(Action::ZoomOut, "map.zoom-out", "zoom out", "Zoom out", &["-"], In(Panel::Map)),
    spec(Action::Follow, "map.follow", "follow", "Keep the craft in the middle", &["f"], In(Panel::Map)),
    spec(Action::Fit, "map.fit", "fit", "Show the whole plan", &["0"], In(Panel::Map)),
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
