//! Actions of all panels that scroll.

use super::spec;
use crate::ui::action::Context::Lists;
use crate::ui::action::{Action, Spec};

pub(super) const ROWS: &[Spec] = &[
    spec(Action::ScrollUp, "list.up", "up", "Scroll up", &["up", "k"], Lists),
    spec(Action::ScrollDown, "list.down", "down", "Scroll down", &["down", "j"], Lists),
    spec(Action::PageUp, "list.page-up", "page up", "Scroll up a page", &["pageup"], Lists),
    spec(Action::PageDown, "list.page-down", "page down", "Scroll down a page", &["pagedown"], Lists),
    spec(Action::Top, "list.top", "top", "To the first line", &["home"], Lists),
    spec(Action::Bottom, "list.bottom", "end", "To the last line", &["end"], Lists),
];
