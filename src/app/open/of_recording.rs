//! A recorded flight: `betadeck open FILE.flight`. It is flown again from its inputs.

use std::io::{BufReader, Read as _, Seek as _};
use std::path::Path;
use std::sync::atomic::Ordering;

use super::{Finished, Kept, Recorded, instant, open_screen, ways_to_go};
use crate::app::screen;
use crate::args::{OpenArgs, TerrainArgs};
use crate::events::Event;
use crate::files::flight_recorder::RecordedStart;
use crate::files::log_source::has_log;
use crate::files::recording_file::GZIP;
use crate::files::terrain::with_terrain;
use crate::files::{file_identity, input_file};
use crate::flight::FlightSetup;
use crate::process::error;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::recording::{Recording, Repeat, Setup};
use crate::session::FlownBefore;
use crate::signals::SimTime;
use crate::telemetry::{EventKind, FirmwareEvent, NavEvent, NavState};
use crate::text::printable;
use crate::ui::keymap::Keymap;
use crate::ui::settings::GivenSetting;

/// The first bytes of a file in which a blackbox log begins.
const LOOKED_AT: u64 = 64 << 10;
/// The ticks between two looks at a request to stop.
const SLICE: usize = 4096;

/// Reads a recording; `None` if the options name a scenario.
pub(super) fn read(args: &OpenArgs) -> Result<Option<Recording>, AppError> {
    let path = Path::new(&args.scenario);
    if !path.is_file() {
        return Ok(None);
    }
    let mut file = input_file::open_recording(path)?;
    let mut head = Vec::new();
    file.by_ref().take(LOOKED_AT).read_to_end(&mut head).ok();
    if has_log(&head) {
        return Err(AppError::input(format!(
            "{0} is a blackbox log, from which no flight can be flown again; `betadeck replay {0}` shows it",
            args.scenario
        )));
    }
    if !head.starts_with(&GZIP) {
        return Ok(None);
    }
    let given = [
        ("--case", args.case.is_some()),
        ("--seed", args.seed.is_some()),
        ("--firmware", args.firmware.firmware.is_some()),
    ];
    if let Some((option, _)) = given.into_iter().find(|(_, is_given)| *is_given) {
        return Err(AppError::input(format!(
            "{option} has no meaning here: {} has the start of its flight",
            args.scenario
        )));
    }
    let unusable = |error: String| AppError::input(format!("{}: {error}", args.scenario));
    file.rewind().map_err(|error| unusable(error.to_string()))?;
    Recording::read(BufReader::new(file)).map(Some).map_err(|error| unusable(error.to_string()))
}

/// Flies a recording again, and opens the screen at the instant.
pub(super) fn run(args: &OpenArgs, recording: &Recording, keymap: Keymap) -> Result<u8, AppError> {
    let file = Path::new(&args.scenario);
    let name = printable::name(&file.file_name().unwrap_or(file.as_os_str()).to_string_lossy());
    let mut notices = recording.notices();
    let (repeat, given_settings) = begin(recording, &mut notices).map_err(|reason| {
        AppError::input(format!("{name} cannot be flown again: {reason}; `betadeck replay` shows it"))
    })?;
    let Some(flown) = fly(repeat)? else { return Ok(error::INTERRUPTED) };
    let Flown { repeat, recorded, engaged_at } = flown;
    let end = repeat.vehicle().time();
    notices.push(match repeat.differs() {
        None => format!(
            "{name} was flown again, the same to the last bit: {}.",
            ways_to_go(args.plain)
        ),
        Some(at) => format!(
            "{name} flies differently from {:.1} s since boot on, and is shown up to there. Another version of betadeck \
             wrote it, or its files of the terrain are missing.",
            at.as_secs_f64()
        ),
    });
    let kept = Kept::open(args, file_identity::of(file).unwrap_or_default(), &mut notices);
    let show_at = kept.instant_or(instant(args.at, engaged_at, end)?, end);
    let start = RecordedStart {
        setup: recording.setup().cloned().ok_or_else(|| "the start of the flight is not in it".to_owned()),
        earlier: repeat.earlier().to_vec(),
        flown_until: end,
    };
    let (vehicle, timeline) = repeat.finish();
    let timeline =
        timeline.ok_or_else(|| AppError::input(format!("{name} ends before its flight begins")))?;
    let plan = recording.setup().map(Setup::plan).unwrap_or_default();
    let Recorded { events, past } = recorded;
    let flown = FlownBefore { timeline, events, show: show_at, again: None };
    open_screen(
        args,
        Finished { plan, given_settings, vehicle, recorded: start, flown, past, kept, notices },
        keymap,
    )
}

/// Returns the flight at boot, and the settings that its options gave the craft. The error is the reason why it cannot be flown again, the end of a sentence.
fn begin<'r>(
    recording: &'r Recording,
    notices: &mut Vec<String>,
) -> Result<(Repeat<'r>, Vec<GivenSetting>), String> {
    let mut setup: FlightSetup = recording.flight()?;
    if recording.setup().is_some_and(Setup::had_tiles) {
        setup = with_terrain(setup, &TerrainArgs::default(), notices).map_err(|error| error.message)?;
    }
    let given_settings = screen::given_settings(&setup.boot_lines);
    Ok((Repeat::new(recording, setup)?, given_settings))
}

/// A recording that was flown again.
struct Flown<'r> {
    repeat: Repeat<'r>,
    recorded: Recorded,
    engaged_at: Option<SimTime>,
}

/// Flies to the end of the recording. Returns `None` if a signal stopped it.
fn fly(mut repeat: Repeat<'_>) -> Result<Option<Flown<'_>>, AppError> {
    let stop = interrupt_flag()?;
    let (mut recorded, mut engaged_at) = (Recorded::default(), None);
    error::tell("The recorded flight is flown again first.");
    while !repeat.is_over() {
        if stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        for _ in 0..SLICE {
            if repeat.is_over() {
                break;
            }
            repeat.prepare();
            repeat.tick(|event| {
                if engaged_at.is_none() && is_engagement(&event.kind) {
                    engaged_at = Some(event.time);
                }
                recorded.events.push(Event::from(event));
            });
            recorded.look(repeat.vehicle());
        }
    }
    Ok(Some(Flown { repeat, recorded, engaged_at }))
}

fn is_engagement(event: &EventKind) -> bool {
    matches!(event, EventKind::Firmware(FirmwareEvent::Nav(NavEvent::State { from: NavState::Idle, .. })))
}
