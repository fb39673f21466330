//! `betadeck --connect`: the ground station for a remote flight controller, without a simulation.

use super::doors::{Connection, LiveArgs};
use super::last_plan;
use super::screen::{self, LiveFlight, Screen, Source};
use crate::args::{ConnectArgs, PlanArg, TuiArgs};
use crate::files::flight_recorder::RecordedStart;
use crate::headless::setup;
use crate::link::FcPlace;
use crate::plan::format::PlanFile;
use crate::process::error::AppError;
use crate::screen_files::backdrop_file;
use crate::screen_files::screen_file::{ScreenFile, ScreenStart, Subject};
use crate::storage::Store;
use crate::ui::keymap::Keymap;
use crate::vehicle::Vehicle;

/// Opens the user interface for the flight controller at `place`, and returns the exit code after the user leaves it.
pub(super) fn run(args: &TuiArgs, place: &FcPlace, keymap: Keymap) -> Result<u8, AppError> {
    let tlog = args.connect.tlog.as_deref();
    if tlog.is_some() && !place.speaks_mavlink() {
        return Err(AppError::input(format!(
            "--tlog records MAVLink, and {place} speaks MSP: connect to a MAVLink craft, such as mavlink:udp:14550"
        )));
    }
    let directory = setup::store_directory(&args.flight)?;
    let mut notices = Vec::new();
    let start = ScreenStart { plain: args.plain, fresh: args.fresh_screen };
    let (screen_file, kept) =
        ScreenFile::open(directory.as_deref(), Subject::Craft(place), start, &mut notices);
    let home = args.flight.home;
    let (chosen, plan) = match &args.plan {
        Some(plan) => (Some(plan.clone()), setup::read_plan(plan, home)?),
        None => match last_plan::read(kept.before(), home, &mut notices) {
            Some((last, plan)) => (Some(last), plan),
            // The plan of the craft is downloaded.
            None => (None, PlanFile { name: "new".to_owned(), ..PlanFile::default() }),
        },
    };
    notices.extend(plan.notices());
    notices.extend(ConnectArgs::idle_options(&args.doors, &args.firmware.link, &args.physics, &args.flight));
    let screen = Screen {
        plan,
        path: chosen.as_ref().and_then(PlanArg::path),
        backdrop: backdrop_file::read_all(&args.backdrop.backdrop)?,
        directory,
        screen_file,
        kept,
        was_used: true,
        given_settings: Vec::new(),
        notices,
        review: args.review,
        tiles: None,
        plain: args.plain,
        display: &args.display,
        terrain: &args.flight.terrain,
        source: Source::Flight(Box::new(LiveFlight {
            vehicle: Vehicle::elsewhere().map_err(AppError::internal)?,
            // The craft keeps its configuration itself.
            store: Store::in_memory(),
            warnings: Vec::new(),
            recorded: RecordedStart::at_boot(Err("a remote flight controller flew it".to_owned())),
            recordings_most: args.recordings.most_bytes(),
            flown: None,
            live: LiveArgs {
                doors: &args.doors,
                connect: Some(Connection { place, tlog }),
                firmware: None,
                physics: &args.physics,
                flight: &args.flight,
                has_screen: true,
            },
        })),
        other: None,
    };
    screen::show(screen, keymap)
}
