//! `betadeck`: the screen with an embedded or remote firmware.

use super::doors::LiveArgs;
use super::screen::{self, LiveFlight, Screen, Source};
use super::{connect, last_plan};
use crate::args::{PlanArg, TuiArgs};
use crate::files::flight_recorder::RecordedStart;
use crate::files::terrain::with_terrain;
use crate::headless::setup;
use crate::launch;
use crate::launch::Beside;
use crate::plan::builtin::{BuiltinPlan, DEMO};
use crate::plan::format::PlanFile;
use crate::process::error::AppError;
use crate::recording::Setup;
use crate::screen_files::backdrop_file;
use crate::screen_files::screen_file::{ScreenFile, ScreenStart, Subject};
use crate::ui::KeptScreen;
use crate::ui::keymap::Keymap;

/// Opens the user interface, and returns the exit code after the user leaves it.
pub(super) fn run(args: &TuiArgs, keymap: Keymap) -> Result<u8, AppError> {
    screen::require_terminal(args.plain)?;
    if let Some(place) = &args.connect.connect {
        return connect::run(args, place, keymap);
    }
    let backdrop = backdrop_file::read_all(&args.backdrop.backdrop)?;
    let directory = setup::store_directory(&args.flight)?;
    let mut notices = Vec::new();
    let start = ScreenStart { plain: args.plain, fresh: args.fresh_screen };
    let (screen_file, kept) = ScreenFile::open(directory.as_deref(), Subject::Flight, start, &mut notices);
    let (chosen, plan) = first_plan(args, kept.before(), &mut notices)?;
    notices.extend(plan.notices());
    let mut store = setup::open_store(&args.flight)?;
    let mut warnings: Vec<String> = setup::storage_notice(&store).into_iter().collect();
    let beside =
        Beside { ports: (&args.doors, &args.physics).into(), flight: &args.flight, physics: &args.physics };
    let firmware = launch::choose(&args.firmware, beside, &mut notices)?;
    notices.extend(args.physics.idle_options(&args.flight, firmware.is_some()));
    let (stored, was_stored) = setup::stored_before(&mut store, &mut warnings);
    // The plan's settings go to the craft with the upload.
    let on_the_ground = PlanFile { settings: Vec::new(), ..plan.clone() };
    let mut setup = setup::for_session(&args.flight, &args.physics, &args.doors, on_the_ground, stored)?;
    // The screen asks for the missing tiles again, and names them.
    setup = with_terrain(setup, &args.flight.terrain, &mut Vec::new())?;
    let tiles = setup.world.terrain.clone();
    let given_settings = screen::given_settings(&setup.boot_lines);
    setup.remote_controller = firmware.is_some();
    let recorded = RecordedStart::at_boot(Ok(Setup::from(&setup)));
    let vehicle = setup::build(setup, &mut notices)?;
    let screen = Screen {
        plan,
        path: chosen.path(),
        backdrop,
        directory,
        screen_file,
        kept,
        was_used: was_stored,
        given_settings,
        notices,
        review: args.review,
        tiles,
        plain: args.plain,
        display: &args.display,
        terrain: &args.flight.terrain,
        source: Source::Flight(Box::new(LiveFlight {
            vehicle,
            store,
            warnings,
            recorded,
            recordings_most: args.recordings.most_bytes(),
            flown: None,
            live: LiveArgs {
                doors: &args.doors,
                connect: None,
                firmware: firmware.as_ref(),
                physics: &args.physics,
                flight: &args.flight,
                has_screen: true,
            },
        })),
        other: None,
    };
    screen::show(screen, keymap)
}

/// Returns the plan that is open at start: that of the command line, else the one that was shown last, else the demo.
fn first_plan(
    args: &TuiArgs,
    kept: Option<&KeptScreen>,
    notices: &mut Vec<String>,
) -> Result<(PlanArg, PlanFile), AppError> {
    if let Some(plan) = &args.plan {
        return Ok((plan.clone(), setup::read_plan(plan, args.flight.home)?));
    }
    if let Some(last) = last_plan::read(kept, args.flight.home, notices) {
        return Ok(last);
    }
    let demo = BuiltinPlan::find(DEMO).ok_or_else(|| AppError::internal("the demo plan is missing"))?;
    let demo = PlanArg::Builtin(demo);
    let file = setup::read_plan(&demo, None)?;
    Ok((demo, file))
}
