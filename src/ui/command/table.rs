//! The commands that take an argument. To add one, add a row here and its function in the file of its subject.

use super::{display, flight, plan, time, vehicle, world};
use crate::sim::COMMAND_WORDS;
use crate::ui::message::Request;
use crate::ui::shared::Shared;

/// A command that takes an argument.
#[derive(Debug, Clone, Copy)]
pub struct Command {
    pub name: &'static str,
    /// The form of the argument; capitals are placeholders.
    pub argument: &'static str,
    /// The effect of the command, in one sentence.
    pub help: &'static str,
    /// Runs the command with its name and argument. Returns a sentence if it refuses.
    pub run: fn(&mut Shared, &str, &str) -> Result<Vec<Request>, String>,
    /// Returns the possible completions of the typed argument.
    pub complete: fn(&Shared, &str, &str) -> Vec<String>,
}

const COMMANDS: &[Command] = &[
    Command {
        name: "set",
        argument: "NAME=VALUE",
        help: "A setting of the craft; without a value: shows it",
        run: vehicle::set,
        complete: vehicle::complete_set,
    },
    Command {
        name: "cli",
        argument: "LINE",
        help: "A line for the firmware's command line",
        run: vehicle::cli,
        complete: vehicle::complete_cli,
    },
    Command {
        name: "open",
        argument: "FILE",
        help: "Open a plan file; without a name: choose one",
        run: plan::open,
        complete: plan::complete,
    },
    Command {
        name: "save",
        argument: "FILE",
        help: "Save the plan in this file; without a name: in its own",
        run: plan::save,
        complete: plan::complete,
    },
    Command {
        name: "scenario",
        argument: "FILE",
        help: "Write the flight just flown as a scenario in this file; without a name: in one named as the plan",
        run: plan::scenario,
        complete: plan::complete,
    },
    Command {
        name: "go-to",
        argument: "WAYPOINT",
        help: "Go now to a waypoint of the craft's plan; without a number: choose one",
        run: flight::go_to,
        complete: flight::complete_go_to,
    },
    Command {
        name: "what-if",
        argument: "NAME",
        help: "How the flight would end with a fault now; without a name: choose one",
        run: flight::what_if,
        complete: flight::complete_what_if,
    },
    Command {
        name: "speed",
        argument: "FACTOR or max",
        help: "Times real time",
        run: time::speed,
        complete: time::complete_speed,
    },
    Command {
        name: "world",
        argument: "NAME=VALUE",
        help: "A rare switch of the simulated world",
        run: world::switch,
        complete: world::complete_switch,
    },
    Command {
        name: "theme",
        argument: "NAME",
        help: "The colours: dark, light, high-contrast, 16, mono",
        run: display::theme,
        complete: display::complete_theme,
    },
    Command {
        name: "charset",
        argument: "unicode or ascii",
        help: "The characters that the terminal shows",
        run: display::charset,
        complete: display::complete_charset,
    },
    Command {
        name: "units",
        argument: "metric or imperial",
        help: "The units of what is shown, not of what is stored",
        run: display::units,
        complete: display::complete_units,
    },
];

/// Returns all commands with an argument: those of the table, and the words that change the world.
pub fn all() -> impl Iterator<Item = Command> {
    // The reset of the craft is an action, because the firmware is notified of it.
    let words = COMMAND_WORDS.iter().filter(|word| !word.value.is_empty());
    let world_commands = words.map(|word| Command {
        name: word.name,
        argument: word.value,
        help: word.help,
        run: world::change,
        complete: world::complete,
    });
    COMMANDS.iter().copied().chain(world_commands)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_has_a_name_of_its_own_and_says_what_it_does() {
        for command in all() {
            assert_eq!(all().filter(|other| other.name == command.name).count(), 1, "{}", command.name);
            assert!(!command.help.is_empty() && !command.argument.is_empty(), "{}", command.name);
        }
        assert!(all().any(|command| command.name == "wind") && all().all(|command| command.name != "reset"));
    }
}
