//! The command line: one definition for parsing, `--help`, completions and the manual page.
//!
//! A value comes from the first of these sources: the command line, the environment (`BETADECK_…`), the configuration
//! file, the default. This module only turns texts into values: it reads no file, no environment and no clock.
#![allow(
    rustdoc::bare_urls,
    rustdoc::broken_intra_doc_links,
    reason = "the comments of options are the text of --help"
)]

mod backdrop;
mod betaloop;
mod campaign;
mod check;
mod compare;
mod config_file;
mod connect;
mod convert;
mod display;
mod doors;
mod firmware;
mod flight;
mod fly;
mod forecast;
mod generate;
mod help;
mod lab;
mod layers;
mod mission;
mod open;
mod physics;
mod plan_arg;
mod recordings;
mod repeat;
mod replay;
mod rescue;
mod review;
mod terrain;
mod trouble;
mod value;

use std::ffi::OsString;
use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};

use crate::text::did_you_mean;

pub use backdrop::BackdropArgs;
pub use betaloop::{Betaloop, BetaloopError};
pub use campaign::{CampaignArgs, CampaignCommand, CampaignOutputArgs, MergeArgs, ShardArg};
pub use check::{CheckArgs, MAX_ALLOWED_FLIGHTS};
pub use compare::CompareArgs;
pub use config_file::{ConfigCommand, KeyHelp, Origin, origins, template};
pub use connect::ConnectArgs;
pub use convert::ConvertArgs;
pub use display::{CharsetChoice, DisplayArgs, ThemeChoice, UnitsChoice};
pub use doors::{DoorArgs, MavlinkIdentity, MavlinkPlace, ServeArgs, SitlArgs, UdpPorts, sitl_usage_error};
pub use firmware::{FirmwareArgs, FirmwareChoice, FirmwareLinkArgs, FirmwarePortArgs, firmware_options};
pub use flight::FlightArgs;
pub use fly::FlyArgs;
pub use forecast::{Charge, ForecastArgs};
pub use generate::{completions, man_page};
pub use lab::LabArgs;
pub use layers::{ENVIRONMENT_PREFIX, Layers};
pub use mission::MissionArgs;
pub use open::OpenArgs;
pub use physics::{FdmDialect, PhysicsArgs, PhysicsChoice, SimulatorArgs};
pub use plan_arg::{PlanArg, PlanArgError, is_descriptor};
pub use recordings::{FlightsArgs, RecordingArgs};
pub use replay::ReplayArgs;
pub use rescue::RescueArgs;
pub use review::ReviewArgs;
pub use terrain::TerrainArgs;
pub use trouble::TroubleArgs;
pub use value::{AttitudeChoice, Instant, OnOff, OutputFile, RecordInstant, Seeds, Speed};

/// Flies the Betaflight waypoint autopilot in a simulated quadcopter
///
/// An embedded flight controller, a quadcopter in the wind and a ground station in one program. Without a command the
/// terminal user interface opens with PLAN loaded.
#[derive(Debug, Parser)]
#[command(
    name = "betadeck",
    version,
    before_help = help::examples(&[
        ("betadeck", "the ground station with the demo plan"),
        ("betadeck my-plan.toml", "the ground station with your plan"),
        ("betadeck fly square", "fly the demo plan as fast as the machine allows"),
    ]),
    after_help = help::LAYERS,
    args_conflicts_with_subcommands = true,
    max_term_width = 100
)]
pub struct Cli {
    /// The command; `None` for the terminal user interface.
    #[command(subcommand)]
    pub command: Option<Command>,

    /// The options of the terminal user interface.
    #[command(flatten)]
    pub tui: TuiArgs,

    /// The words after the program's name that give the same run, with the values of all layers but without outputs.
    #[arg(skip)]
    pub repeat: Vec<String>,
}

/// The options of the terminal user interface.
#[derive(Debug, clap::Args)]
pub struct TuiArgs {
    /// Plan to load: a built-in plan's name or a file (*.toml, *.txt, - for standard input) [default: square]
    pub plan: Option<PlanArg>,

    /// No screen: events as sentences on standard output, commands of the `:` line on standard input
    ///
    /// Needs no terminal. After the end of the input the flight goes on, until `quit` or a signal ends it.
    #[arg(long, help_heading = "Screen")]
    pub plain: bool,

    /// Start with a clean screen: not with the plans, panels and map of the last run
    #[arg(long, help_heading = "Screen")]
    pub fresh_screen: bool,

    /// The screen.
    #[command(flatten)]
    pub display: DisplayArgs,

    /// The backdrop.
    #[command(flatten)]
    pub backdrop: BackdropArgs,

    /// The doors.
    #[command(flatten)]
    pub doors: DoorArgs,

    /// The remote flight controller, if there is no simulation.
    #[command(flatten)]
    pub connect: ConnectArgs,

    /// The choice of the firmware.
    #[command(flatten)]
    pub firmware: FirmwareArgs,

    /// The choice of the physics.
    #[command(flatten)]
    pub physics: PhysicsArgs,

    /// The craft, its position and the air.
    #[command(flatten)]
    pub flight: FlightArgs,

    /// The limits for warnings about waypoints.
    #[command(flatten)]
    pub review: ReviewArgs,

    /// The library of recorded flights.
    #[command(flatten)]
    pub recordings: RecordingArgs,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Flies a plan without a screen and reports; the exit code says whether the mission completed
    #[command(before_help = help::examples(&[
        ("betadeck fly square", "the demo plan, events as sentences"),
        ("betadeck fly plan.toml --wind 5@270 --json - --samples 10", "JSON lines with ten samples a second"),
        ("betadeck fly plan.txt --settings diff.txt --gpx track.gpx", "with your craft's configuration"),
        ("betadeck fly square --rx-loss-at 20 --set ap_rx_loss_policy=LAND", "lose the radio after 20 s"),
    ]), after_help = help::FLY)]
    Fly(Box<FlyArgs>),

    /// Flies scenarios without a screen and judges them: a flight plan is a test
    #[command(before_help = help::examples(&[
        ("betadeck check", "the guide's scenarios and all others that are built in"),
        ("betadeck check tests/ --junit report.xml", "your own, for CI"),
        ("betadeck check guide-7 --seeds 1..20", "one of them with twenty seeds"),
        ("betadeck check --new plan.toml > plan-test.toml", "a scenario from a flight of your plan"),
    ]))]
    Check(Box<CheckArgs>),

    /// Flies a plan or a scenario hundreds of times in different conditions, and answers: how sure, how far off, and why
    #[command(before_help = help::examples(&[
        ("betadeck campaign square --wind 4@270 --turbulence light", "a thousand seeds of the demo plan"),
        ("betadeck campaign my-campaign.toml --out run.jsonl", "what the file varies; killed, it goes on where it was"),
        ("betadeck campaign square --vary wind=6+-2@250+-20 --vary mass_pct=+-3", "a forecast and a scale"),
        ("betadeck campaign square --vs ap_position_p=60", "the same flights with other gains"),
        ("betadeck campaign my-campaign.toml --out part-3.jsonl --shard 3/7", "a seventh of it, on this machine"),
    ]))]
    Campaign(Box<CampaignArgs>),

    /// Go or no-go: flies a plan in the weather to come, and says how likely it completes with charge to spare
    #[command(before_help = help::examples(&[
        ("betadeck forecast my-plan.toml --wind 6+-2@250+-20", "a hundred flights in this wind"),
        ("betadeck forecast my-plan.toml --wind 'table hours.csv' --airframe my-quad.toml --battery 92%", ""),
    ]), after_help = help::FORECAST)]
    Forecast(Box<ForecastArgs>),

    /// Flies a scenario or a recorded flight and opens the screen at one of its instants, paused, to look around in it
    #[command(before_help = help::examples(&[
        ("betadeck open guide-7 --case 'wind-5, noise real' --seed 3 --at 21.4", "a moment that `check` named"),
        ("betadeck open run.jsonl:1234", "a flight of a campaign"),
        ("betadeck open square.flight", "a recorded flight, to the last bit"),
    ]))]
    Open(Box<OpenArgs>),

    /// Shows a recorded flight on the screen: a blackbox log, or a recording; two of them beside each other
    #[command(before_help = help::examples(&[
        ("betadeck replay LOG00001.BFL", "map, horizon, graphs and events, with rewind and speed"),
        ("betadeck replay flights.bbl --log 3 --at 95", "the third flight of a file, 95 s after its beginning"),
        ("betadeck replay before.bbl after.bbl", "both tracks and the differences"),
        ("betadeck replay log.bbl --csv values.csv --samples 100 --gpx track.gpx", "values and track for other programs"),
    ]))]
    Replay(Box<ReplayArgs>),

    /// Lists the recorded flights: date, plan, verdict, duration and file, the newest first
    #[command(before_help = help::examples(&[
        ("betadeck flights", "what the screen recorded"),
        ("betadeck flights --json", "a JSON object for each flight"),
    ]))]
    Flights(FlightsArgs),

    /// Flies a plan on the embedded firmware and on another one, in the same air, and shows the differences
    #[command(before_help = help::examples(&[
        ("betadeck compare square --firmware obj/main/betaflight_SITL.elf", "your build against the embedded firmware"),
        (
            "betadeck compare square --firmware new.elf --firmware old.elf --svg tracks.svg",
            "your build against a release",
        ),
    ]))]
    Compare(Box<CompareArgs>),

    /// Flies a programme of flights on two builds of a SITL executable: what got worse, what changed
    #[command(before_help = help::examples(&[
        ("betadeck lab --base old.elf --head new.elf", "does the change make it fly worse? In at most three minutes"),
        ("betadeck lab new.elf", "which properties does it break?"),
        ("betadeck lab --base old.elf --head new.elf --budget 30min --seed 2", "more flights, and other ones"),
    ]))]
    Lab(Box<LabArgs>),

    /// Flies GPS RESCUE and a lost link from many places with a pilot's settings: does it come home?
    #[command(before_help = help::examples(&[
        ("betadeck rescue diff.txt", "with the answer of your craft to `diff all`"),
        ("betadeck rescue diff.txt --wind 12 --scenario worst.toml", "in more wind; the worst flights, to be opened"),
    ]))]
    Rescue(Box<RescueArgs>),

    /// Runs firmware and physics in real time with all doors open, without a screen
    #[command(before_help = help::examples(&[
        ("betadeck serve", "the Betaflight App connects to ws://localhost:6761, scripts send RC to UDP 9004"),
        ("betadeck serve --json - --no-ports", "events as JSON lines, no door"),
        ("betadeck serve --physics external", "Gazebo, started separately, moves the craft"),
    ]))]
    Serve(Box<ServeArgs>),

    /// Runs the firmware alone, as a drop-in for betaflight_SITL.elf, for an external simulator
    #[command(before_help = help::examples(&[
        ("betadeck sitl", "same ports and files as the executable; start Gazebo beside it"),
        ("betadeck sitl --config quad.txt", "apply CLI lines, save eeprom.bin, exit"),
        ("betadeck sitl --gpx --exit-on-reboot", "in a script's loop"),
    ]))]
    Sitl(Box<SitlArgs>),

    /// Shows flight plans
    #[command(subcommand, disable_help_subcommand = true)]
    Plan(PlanCommand),

    /// Converts a plan file to another format and reports what that format cannot hold
    #[command(before_help = help::examples(&[
        ("betadeck convert square.txt square.toml", "formats by the files' extensions"),
        ("betadeck convert - plan.toml", "from standard input"),
        ("betadeck convert plan.toml - --to txt", "to standard output"),
        ("betadeck convert new.txt plan.toml --force", "replaces the existing plan.toml"),
    ]))]
    Convert(ConvertArgs),

    /// Writes the configuration file, or shows every value with its source
    #[command(subcommand, disable_help_subcommand = true)]
    Config(ConfigCommand),

    /// Writes the files that the commands of the documentation name: a plan, a craft, a scenario, a campaign, logs
    #[command(before_help = help::examples(&[
        ("betadeck examples try", "into the new folder try; then run the commands of a page in it, in their order"),
    ]))]
    Examples {
        /// Folder for the files, which is created; no file is replaced
        #[arg(value_name = "DIR", default_value = ".")]
        folder: PathBuf,
    },

    /// Checks directories, ports, the terminal and versions
    Doctor,

    /// Prints a completion script for a shell
    #[command(before_help = help::examples(&[
        ("betadeck completions bash > ~/.local/share/bash-completion/completions/betadeck", ""),
        ("betadeck completions zsh > ~/.zfunc/_betadeck", ""),
    ]))]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },

    /// Prints the manual page
    #[command(before_help = help::examples(&[("betadeck man | man -l -", "read it")]))]
    Man,
}

/// Commands for plans.
#[derive(Debug, Subcommand)]
pub enum PlanCommand {
    /// Prints the built-in plans: name, number of waypoints, and a description
    #[command(before_help = help::examples(&[("betadeck plan list", "all of them, the demo first")]))]
    List,
    /// Prints a plan as a table with distances, times and problems
    #[command(before_help = help::examples(&[
        ("betadeck plan show square", "a built-in plan"),
        ("betadeck plan show plan.txt", "a file"),
    ]))]
    Show {
        /// A built-in plan's name or a file (*.toml, *.txt, - for standard input)
        plan: PlanArg,

        /// The limits for warnings about waypoints.
        #[command(flatten)]
        review: ReviewArgs,

        /// The elevation tiles.
        #[command(flatten)]
        terrain: TerrainArgs,
        /// The zones.
        #[command(flatten)]
        backdrop: BackdropArgs,
    },
}

/// Parses a command line (with the program's name first) over the other layers.
///
/// # Errors
///
/// Returns wrong usage with a suggestion, and also `--help` and `--version`, as a [`clap::Error`]. The caller prints
/// it and exits with its exit code.
pub fn parse(arguments: impl IntoIterator<Item = OsString>, layers: &Layers) -> Result<Cli, clap::Error> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let mut command = Cli::command();
    let matches = command
        .try_get_matches_from_mut(&arguments)
        .map_err(|error| hint_at_command(error, &arguments, &command))?;
    let typed = Cli::from_arg_matches(&matches)?;
    let combination = match &typed.command {
        Some(Command::Fly(fly)) => fly.check(),
        Some(Command::Compare(compare)) => compare.check(),
        Some(Command::Campaign(campaign)) => campaign.check(),
        Some(Command::Convert(convert)) => convert.check(),
        Some(Command::Replay(replay)) => replay.check(),
        Some(
            Command::Serve(_)
            | Command::Sitl(_)
            | Command::Check(_)
            | Command::Lab(_)
            | Command::Rescue(_)
            | Command::Forecast(_)
            | Command::Open(_)
            | Command::Flights(_)
            | Command::Plan(_)
            | Command::Config(_)
            | Command::Examples { .. }
            | Command::Doctor
            | Command::Completions { .. }
            | Command::Man,
        )
        | None => Ok(()),
    };
    combination.map_err(|problem| usage_error(ErrorKind::ValueValidation, &problem))?;
    layers::apply(layers, arguments, &matches, &mut command)
}

/// Returns the problems in the environment and the configuration file, one sentence each.
pub fn layer_problems(layers: &Layers) -> Vec<String> {
    let mut command = Cli::command();
    command.build();
    let (known, mut problems) = layers.without_unknown(&command);
    // One at a time, because parsing ends at the first problem.
    for single in known.singles() {
        let lines = [
            &["betadeck"][..],
            &["betadeck", "fly", "square"],
            &["betadeck", "compare", "square"],
            &["betadeck", "serve"],
            &["betadeck", "sitl"],
        ];
        let wrong = lines.iter().find_map(|line| parse(line.iter().map(OsString::from), &single).err());
        if let Some(error) = wrong {
            let text = error.to_string();
            problems.push(text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned());
        }
    }
    problems
}

/// Returns a problem as one sentence. The problem is not in an option, so a usage line would not help.
fn usage_error(kind: ErrorKind, problem: &str) -> clap::Error {
    clap::Error::raw(kind, format!("{problem}\n"))
}

/// Suggests the intended command. Otherwise a misspelt command counts as a plan, and the words after it as too many
/// arguments.
fn hint_at_command(error: clap::Error, arguments: &[OsString], command: &clap::Command) -> clap::Error {
    let first = arguments.get(1).and_then(|argument| argument.to_str()).unwrap_or_default();
    let names = command.get_subcommands().map(clap::Command::get_name);
    let is_plan = first.starts_with('-') || first.parse::<PlanArg>().is_ok();
    match did_you_mean::closest(first, names) {
        Some(name) if name != first && !is_plan && error.use_stderr() => command.clone().error(
            ErrorKind::InvalidSubcommand,
            format!("{first} is neither a command nor a plan; did you mean betadeck {name}?"),
        ),
        _ => error,
    }
}

#[cfg(test)]
mod tests;
