//! Every action and every command with a value in a pseudo-terminal: by its key at 80x24, and by the mouse at 200x60.
//!
//! A group is a walk through one program. Each step of a walk names an action and what the screen must show of it, which it
//! did not show before.

mod by_keys;
mod by_mouse;
mod editing;
mod flight;
mod lines;
mod map;
mod panels;
mod screen;
mod seen;
mod settings;
mod time;
mod walk;

use betadeck::ui::action::ACTIONS;
use betadeck::ui::command;

use by_keys::Keys;
use by_mouse::Mouse;
use walk::{Group, Step, walk};

#[test]
fn the_walks_have_every_action_and_every_command_once() {
    let steps = || GROUPS.iter().flat_map(|group| group.steps);
    let named = |name: &str| steps().filter(|step| matches!(step, Step::Act(act, _) if *act == name)).count();
    for spec in ACTIONS {
        assert_eq!(named(spec.name), 1, "{}", spec.name);
    }
    let lines =
        |name: &str| steps().filter(|step| matches!(step, Step::Line(line, ..) if *line == name)).count();
    for command in command::all() {
        assert_eq!(lines(command.name), 1, ":{}", command.name);
    }
    let unknown = steps().find(|step| match step {
        Step::Act(name, _) | Step::Again(name, _) => ACTIONS.iter().all(|spec| spec.name != *name),
        Step::Line(name, ..) => command::all().all(|command| command.name != *name),
        _ => false,
    });
    assert!(unknown.is_none(), "{unknown:?}");
}

/// Makes the tests of a group.
macro_rules! walks {
    ($($group:ident)*) => {
        mod every_command_is_answered_by_its_key_at_80x24 {
            $(#[test]
            fn $group() {
                super::walk(&super::$group::GROUP, (80, 24), &mut super::Keys);
            })*
        }

        mod every_command_is_answered_by_the_mouse_alone_at_200x60 {
            $(#[test]
            fn $group() {
                super::walk(&super::$group::GROUP, (200, 60), &mut super::Mouse::default());
            })*
        }

        /// All groups.
        const GROUPS: &[&Group] = &[$(&$group::GROUP),*];
    };
}

walks! { editing map panels settings flight time screen lines }
