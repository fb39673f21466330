//! The program: from arguments to the tasks of one mode.
//!
//! One file a mode, with its parts in the layer of its name: `tui`, `connect` and `serve` open the screen or the links,
//! `open` shows a flight of a scenario or a campaign, `replay` shows and exports recorded flights. The modes without a
//! screen are in the room `headless`.

mod config;
pub mod configuration_file;
mod connect;
mod convert;
mod doctor;
mod doors;
mod examples;
mod flight_shelf;
mod flights;
mod input_lines;
mod keys;
mod last_plan;
mod layers;
mod live;
mod open;
mod plan;
mod replay;
mod scenario_file;
mod screen;
mod serve;
mod sitl;
mod telemetry_recording;
mod tui;
mod usage;

use std::ffi::OsString;

use crate::args::{self, Cli, Command, PlanCommand};
use crate::files::output_file;
use crate::link::launch_firmware;
use crate::process::build::Build;
use crate::process::error::{self, AppError};
use crate::ui::keymap::Keymap;
use crate::{headless, storage};

/// Runs the program with the given command line (program name first) and returns its exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>, build: Build) -> u8 {
    build.record();
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    // The hook reports the panic itself, after the terminal is restored.
    std::panic::catch_unwind(|| outcome(arguments)).unwrap_or(error::INTERNAL)
}

/// Runs the typed command and returns its exit code.
fn outcome(arguments: Vec<OsString>) -> u8 {
    if let Some(code) = launch_firmware(&arguments) {
        return code;
    }
    let arguments = usage::with_printable_name(arguments);
    let is_sitl = arguments.get(1).is_some_and(|command| command == "sitl");
    let outside = layers::read();
    // Help, completions and the doctor work with a broken configuration file, too.
    let known = outside.as_ref().cloned().unwrap_or_default();
    let outcome = match args::parse(arguments.clone(), &known.layers) {
        Ok(cli) if !reads_layers(cli.command.as_ref()) => dispatch(cli, Keymap::default()),
        Ok(cli) => outside
            .and_then(|outside| keys::keymap(&outside.layers.file_name, &outside.keys))
            .and_then(|keymap| dispatch(cli, keymap)),
        Err(error) if is_sitl && let Some(usage_error) = args::sitl_usage_error(&error) => {
            Err(AppError { code: error::FAILED, message: usage_error })
        }
        Err(error) => {
            usage::print(&error, &arguments, &known.layers);
            if error.use_stderr() {
                // Without the right options it is not known which of them this command may replace.
                for file in output_file::named_outputs(&arguments) {
                    error::tell(&format!(
                        "note: {file} is as it was before this command: nothing was written"
                    ));
                }
            }
            Ok(u8::try_from(error.exit_code()).unwrap_or(error::USAGE))
        }
    };
    match outcome {
        Ok(code) => code,
        Err(error) => {
            error::tell(&error.message);
            error.code
        }
    }
}

/// Returns `true` if the command uses the configuration file.
fn reads_layers(command: Option<&Command>) -> bool {
    match command {
        None
        | Some(
            Command::Fly(_)
            | Command::Compare(_)
            | Command::Serve(_)
            | Command::Sitl(_)
            | Command::Open(_)
            | Command::Replay(_)
            | Command::Flights(_),
        ) => true,
        Some(
            Command::Check(_)
            | Command::Lab(_)
            | Command::Rescue(_)
            | Command::Campaign(_)
            | Command::Forecast(_)
            | Command::Plan(_)
            | Command::Convert(_)
            | Command::Config(_)
            | Command::Examples { .. }
            | Command::Doctor
            | Command::Completions { .. }
            | Command::Man,
        ) => false,
    }
}

/// Returns `true` if the command may start a firmware in a folder of its own.
fn may_start_firmware(command: Option<&Command>) -> bool {
    match command {
        None
        | Some(
            Command::Fly(_)
            | Command::Check(_)
            | Command::Lab(_)
            | Command::Campaign(_)
            | Command::Compare(_)
            | Command::Serve(_),
        ) => true,
        Some(
            Command::Sitl(_)
            | Command::Rescue(_)
            | Command::Forecast(_)
            | Command::Open(_)
            | Command::Replay(_)
            | Command::Flights(_)
            | Command::Plan(_)
            | Command::Convert(_)
            | Command::Config(_)
            | Command::Examples { .. }
            | Command::Doctor
            | Command::Completions { .. }
            | Command::Man,
        ) => false,
    }
}

fn dispatch(cli: Cli, keymap: Keymap) -> Result<u8, AppError> {
    if may_start_firmware(cli.command.as_ref()) {
        storage::sweep();
    }
    match cli.command {
        None => tui::run(&cli.tui, keymap),
        Some(Command::Fly(args)) => headless::fly::run(&args, &cli.repeat),
        Some(Command::Check(args)) => headless::check::run(&args, &cli.repeat),
        Some(Command::Lab(args)) => headless::lab::run(&args, &cli.repeat),
        Some(Command::Rescue(args)) => headless::rescue::run(&args),
        Some(Command::Campaign(args)) => headless::campaign::run(&args, &cli.repeat),
        Some(Command::Forecast(args)) => headless::campaign::forecast(&args, &cli.repeat),
        Some(Command::Open(args)) => open::run(&args, keymap),
        Some(Command::Replay(args)) => replay::run(&args, &cli.repeat, keymap),
        Some(Command::Flights(args)) => flights::run(&args),
        Some(Command::Compare(args)) => headless::compare::run(&args, &cli.repeat),
        Some(Command::Sitl(args)) => sitl::run(&args),
        Some(Command::Serve(args)) => serve::run(&args),
        Some(Command::Plan(PlanCommand::List)) => plan::list(),
        Some(Command::Plan(PlanCommand::Show { plan, review, backdrop, terrain })) => {
            plan::show(&plan, review, &backdrop, &terrain)
        }
        Some(Command::Convert(args)) => convert::run(&args),
        Some(Command::Config(command)) => config::run(command),
        Some(Command::Examples { folder }) => examples::run(&folder),
        Some(Command::Doctor) => doctor::run(),
        Some(Command::Completions { shell }) => error::write_stdout(&args::completions(shell)),
        Some(Command::Man) => error::write_stdout(&args::man_page().map_err(AppError::internal)?),
    }
}
