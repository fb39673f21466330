//! The commands that take an argument. To add one, add a row here and its function in the file of its subject.

use super::{display, flight, plan, time, vehicle, world};
use crate::sim::COMMAND_WORDS;
use crate::ui::model::message::Request;
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

/// Makes the list of commands, a row each: name, argument, help, the function that runs it, and the one that completes its
/// argument.
macro_rules! commands {
    ($($name:literal $argument:literal $help:literal $run:path, $complete:path;)*) => {
        const COMMANDS: &[Command] =
            &[$(Command { name: $name, argument: $argument, help: $help, run: $run, complete: $complete }),*];
    };
}

commands! {
    "set" "NAME=VALUE" "A setting of the craft; without a value: shows it" vehicle::set, vehicle::complete_set;
    "cli" "LINE" "A line for the firmware's command line" vehicle::cli, vehicle::complete_cli;
    "profile" "guide or master" "The laws of the embedded autopilot: the test guide's, or those of today's master"
        vehicle::profile, vehicle::complete_profile;
    "open" "FILE" "Open a plan file; without a name: choose one" plan::open, plan::complete;
    "save" "FILE" "Save the plan in this file; without a name: in its own" plan::save, plan::complete;
    "settings-file" "FILE" "Save the changed settings of the craft in a new file, for --settings"
        vehicle::settings_file, plan::complete;
    "scenario" "FILE" "Write the flight just flown as a scenario in this file; without a name: in one named as the plan"
        plan::scenario, plan::complete;
    "record" "FILE" "Write the recording of the flight so far in this file; without a name: in one named as the plan"
        plan::record, plan::complete;
    "log" "FILE" "Write the blackbox log of the flight so far in this file; without a name: in one named as the plan"
        plan::log, plan::complete;
    "backdrop" "FILE or off" "Show a file (GeoJSON, KML, KMZ, GPX) under the plan; off: none; without a name: choose one"
        plan::backdrop, plan::complete_backdrop;
    "go-to" "WAYPOINT" "Go now to a waypoint of the craft's plan; without a number: choose one"
        flight::go_to, flight::complete_go_to;
    "what-if" "NAME[,FOR][,VALUE]" "How the flight would end with this now, such as wind,,14@270; without a name: choose"
        flight::what_if, flight::complete_what_if;
    "where" "FAULT" "Where this fault may be fatal, such as gps-loss,6; without a fault: the one of before"
        flight::where_may, flight::complete_where;
    "speed" "FACTOR or max" "Times real time" time::speed, time::complete_speed;
    "world" "NAME=VALUE" "A rare switch of the simulated world" world::switch, world::complete_switch;
    "theme" "NAME" "The colours: dark, light, high-contrast, 16, mono" display::theme, display::complete_theme;
    "charset" "unicode or ascii" "The characters that the terminal shows" display::charset, display::complete_charset;
    "layout" "NAME" "The places of the panels: flying, editing, debugging, demo, default; save NAME, delete NAME"
        display::layout, display::complete_layout;
    "units" "metric or imperial" "The units of what is shown, not of what is stored"
        display::units, display::complete_units;
}

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
