//! `betadeck replay`: recorded flights on the screen, and as files for other programs.

mod log_export;
mod opened;
mod outputs;
mod recording_export;
mod report;

use std::path::Path;
use std::sync::Arc;

use super::last_plan;
use super::screen::{self, Screen, SecondFlight, Source};
use crate::args::{PlanArg, RecordInstant, ReplayArgs, ReviewArgs, TerrainArgs};
use crate::files::file_identity;
use crate::headless::setup;
use crate::plan::format::PlanFile;
use crate::process::error;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::recording::Setup;
use crate::replay::{Overview, PastFlights};
use crate::screen_files::screen_file::{ScreenFile, ScreenStart, Subject};
use crate::session::{ReplayConfig, ReplayStart};
use crate::signals::SimTime;
use crate::ui::keymap::Keymap;
use crate::ui::{KeptPlace, KeptScreen, KeptScreens};
use opened::Opened;

/// Writes the files of the options, or shows the flights. With `--plain` it does both.
pub(super) fn run(args: &ReplayArgs, repeat: &[String], keymap: Keymap) -> Result<u8, AppError> {
    if !args.exports() {
        screen::require_terminal(args.plain)?;
    }
    let (first, second) = match &args.files[..] {
        [first] => (first, None),
        [first, second, ..] => (first, Some(second)),
        [] => return Err(AppError::internal("no file to replay")),
    };
    let mut flights = opened::open(first)?;
    let flown = opened::setup(first);
    let second = second.map(|path| opened::open(path)).transpose()?;
    if args.exports() {
        let stop = interrupt_flag()?;
        outputs::claim(args)?;
        let is_whole = match &mut flights {
            Opened::Logs(logs) => log_export::run(args, repeat, logs, &stop)?,
            Opened::Recording(recording) => recording_export::run(args, repeat, recording, &stop)?,
        };
        if !is_whole {
            return Ok(error::INTERRUPTED);
        }
        if !args.plain {
            return Ok(0);
        }
    }
    let terrain = TerrainArgs::default();
    let directory = Some(setup::state_directory(args.state_dir.as_deref())?);
    let mut notices = Vec::new();
    let (screen_file, mut kept) = kept_screen(args, first, directory.as_deref(), &mut notices);
    let left = place_left(args, &mut kept);
    let config = ReplayConfig {
        flights: flights.into(),
        number: left.map(|left| left.flight).or(args.number()),
        is_left: left.is_some(),
        start: args.at.map(start).or(left.and_then(|left| left.at_us).map(SimTime).map(ReplayStart::Clock)),
        speed: 1.0,
        notices: Vec::new(),
    };
    let (chosen, plan) = last_plan::read(kept.before(), None, &mut notices).unzip();
    let of_flight = || flown.as_ref().map(Setup::plan).filter(|plan| !plan.plan.waypoints.is_empty());
    let settings = flown.as_ref().and_then(|flown| flown.flight().ok()).map(|flight| flight.boot_lines);
    let screen = Screen {
        plan: plan
            .or_else(of_flight)
            .unwrap_or_else(|| PlanFile { name: "new".to_owned(), ..PlanFile::default() }),
        path: chosen.as_ref().and_then(PlanArg::path),
        backdrop: Vec::new(),
        directory,
        screen_file,
        kept,
        was_used: true,
        given_settings: screen::given_settings(&settings.unwrap_or_default()),
        notices,
        review: ReviewArgs::default(),
        tiles: None,
        plain: args.plain,
        display: &args.display,
        terrain: &terrain,
        source: Source::Replay(config),
        other: second.map(beside),
    };
    screen::show(screen, keymap)
}

/// Reads the kept screen of a file.
fn kept_screen(
    args: &ReplayArgs,
    file: &Path,
    state: Option<&Path>,
    notices: &mut Vec<String>,
) -> (ScreenFile, KeptScreens) {
    let of = Subject::Record(file_identity::of(file).unwrap_or_default());
    ScreenFile::open(state, of, ScreenStart { plain: args.plain, fresh: args.fresh_screen }, notices)
}

/// Returns the place that was left, unless the options name another.
fn place_left(args: &ReplayArgs, kept: &mut KeptScreens) -> Option<KeptPlace> {
    let is_wanted =
        |left: &KeptPlace| args.at.is_none() && args.number().is_none_or(|number| number == left.flight);
    let left = kept.before().and_then(KeptScreen::place).filter(is_wanted);
    if left.is_none() {
        kept.forget_place();
    }
    left
}

fn start(at: RecordInstant) -> ReplayStart {
    match at {
        RecordInstant::Start(seconds) => ReplayStart::Seconds(seconds),
        RecordInstant::Boot(seconds) => ReplayStart::Clock(SimTime::from_secs_f64(seconds)),
    }
}

/// Returns the first flight of a file, to be read beside another one.
fn beside(flights: Opened) -> SecondFlight {
    let mut flights: Box<dyn PastFlights> = flights.into();
    let name = flights.name().to_owned();
    let read = move || -> Result<Arc<Overview>, String> {
        flights.read(&mut |_| true)?;
        let mut refused = format!("{} has no flight.", flights.name());
        for number in 0..flights.count() {
            match flights.open(number) {
                Ok(flight) => return Ok(flight.overview()),
                Err(why) => refused = why,
            }
        }
        Err(refused)
    };
    SecondFlight { name, read: Box::new(read) }
}

/// Returns the name of a file for messages and for the screen.
fn shown_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    crate::text::printable::name(&name.to_string_lossy())
}
