//! The table of commands and `help`.

use super::session::Session;
use super::{bench, craft, dump, get_set, leave, modes, names, profiles, receiver, serial, status, waypoint};

/// A command of the command line, with its help.
#[derive(Debug, Clone, Copy)]
pub struct Command {
    /// The name, in lower case.
    pub name: &'static str,
    /// The description, in a few words.
    pub description: Option<&'static str>,
    /// The arguments, one alternative per line.
    pub arguments: &'static [&'static str],
    /// The function that runs the command with the rest of the line.
    pub(super) run: fn(&mut Session<'_>, &str),
}

const fn command(
    name: &'static str,
    description: &'static str,
    arguments: &'static [&'static str],
    run: fn(&mut Session<'_>, &str),
) -> Command {
    Command { name, description: Some(description), arguments, run }
}

const DUMP_ARGUMENTS: &[&str] = &["[master|profile|rates|hardware|all] {defaults|bare}"];

/// All commands in the order of `help`.
#[rustfmt::skip]
pub const COMMANDS: &[Command] = &[
    command("adjrange", "show or set in-flight adjustments (kept, not executed)", &["<index> <unused> <range channel> <start> <end> <function> <select channel> [<center> <scale>]"], modes::adjrange),
    command("aux", "show or set which switch turns which mode on", &["<index> <mode> <aux> <start> <end> <logic>"], modes::aux),
    command("batch", "enclose lines that are saved only if all of them worked", &["start | end"], leave::batch),
    command("bl", "restart (there is no boot loader here)", &["[rom]"], leave::bl),
    command("board_name", "show or set the name of the board", &["[board name]"], names::board_name),
    command("defaults", "reset everything to defaults, save and restart", &["{nosave}"], leave::defaults),
    command("diff", "print the differences from the defaults", DUMP_ARGUMENTS, dump::diff),
    command("dump", "print the whole configuration", DUMP_ARGUMENTS, dump::dump),
    command("env", "print the figures of status as NAME=VALUE", &["[prefix]"], status::env),
    command("exit", "leave without saving", &["[noreboot]"], leave::exit),
    command("feature", "show features, turn one on or off", &["list", "<->[name]"], craft::feature),
    command("get", "show settings with their range and default", &["[name]"], get_set::get),
    command("gpspassthrough", "connect this link to the GPS (not here)", &[], bench::gpspassthrough),
    command("help", "list commands", &["[search string]"], help),
    command("manufacturer_id", "show or set the manufacturer of the board", &["[manufacturer id]"], names::manufacturer_id),
    command("map", "show or set the order of the receiver's channels", &["[<map>]"], receiver::map),
    command("mcu_id", "show the processor's number", &[], status::mcu_id),
    command("mixer", "show or set the airframe type", &["list", "<name>"], craft::mixer),
    command("mmix", "show or set the custom motor mix", &[], craft::mmix),
    command("motor", "run a motor on the bench", &["<index> [<value>]"], bench::motor),
    command("options", "show the build options as numbers", &[], status::options),
    Command { name: "play_sound", description: None, arguments: &["[<index>]"], run: bench::play_sound },
    command("battery_profile", "show or select the battery profile", &["[<index>]"], profiles::battery_profile),
    command("profile", "show or select the PID profile", &["[<index>]"], profiles::profile),
    command("rateprofile", "show or select the rate profile", &["[<index>]"], profiles::rateprofile),
    command("rc_smoothing_info", "show the measurements of RC smoothing", &[], status::rc_smoothing_info),
    command("reboot", "restart without saving", &[], leave::reboot),
    command("rxfail", "show or set the behaviour of channels after signal loss", &[], receiver::rxfail),
    command("rxrange", "show or set the pulse range of the stick channels", &[], receiver::rxrange),
    command("save", "store the configuration and restart", &["[noreboot]"], leave::save),
    command("sensor_hardware", "list the sensors available for each kind", &["[gyro|acc|baro|mag|rangefinder|opticalflow|pitot]"], status::sensor_hardware),
    command("serial", "show or set the functions of the serial ports", &[], serial::serial),
    command("serialpassthrough", "connect this link to another port (not here)", &["<id1> [<baud1>] [<mode1>] [none|reset] [<id2>] [<baud2>] [<mode2>]"], bench::serialpassthrough),
    command("set", "change a setting", &["[<name>=<value>]"], get_set::set),
    command("signature", "show the signature of the board", &["[signature]"], names::signature),
    command("simplified_tuning", "accepted for real configurations, no effect here", &["apply | disable"], profiles::simplified_tuning),
    command("status", "show the vehicle's state and why it does not arm", &[], status::status),
    command("tasks", "show the tasks with their rates", &[], status::tasks),
    command("version", "show the firmware version", &[], status::version),
    command("waypoint", "show and edit the flight plan", &["list | status | insert <idx> <lat.ddddddd> <lon.ddddddd> <alt> <spd> <type> <dur> <pat> | update <idx> <lat.ddddddd> <lon.ddddddd> <alt> <spd> <type> <dur> <pat> | remove <idx> | clear"], waypoint::waypoint),
];

/// Returns the command of this name, in any case.
pub(super) fn by_name(word: &str) -> Option<&'static Command> {
    COMMANDS.iter().find(|command| command.name.eq_ignore_ascii_case(word))
}

/// `help [text]`: lists the commands whose name or description contains the text.
fn help(session: &mut Session<'_>, text: &str) {
    let wanted = text.to_ascii_lowercase();
    let matches = |command: &&Command| {
        command.name.contains(&wanted)
            || command.description.is_some_and(|text| text.to_ascii_lowercase().contains(&wanted))
    };
    let mut found = false;
    for command in COMMANDS.iter().filter(matches) {
        found = true;
        session.raw(command.name);
        if let Some(description) = command.description {
            session.raw(format_args!(" - {description}"));
        }
        session.line("");
        for arguments in command.arguments {
            session.line(format_args!("\t{arguments}"));
        }
    }
    if !found {
        session.error(format_args!("NO MATCHES FOR '{text}'"));
    }
}
