//! `betadeck`: the terminal user interface with the whole program.
#![allow(clippy::disallowed_methods, reason = "the composition root reads the environment")]

use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;

use tokio::sync::mpsc::UnboundedSender;

use super::doors::{LiveArgs, OpenDoors};
use super::flight_shelf::Shelf;
use super::{input_lines, scenario_file};

use super::live::{self, Reports};
use crate::args::{CharsetChoice, DisplayArgs, ReviewArgs, TerrainArgs, ThemeChoice, UnitsChoice};
use crate::campaign::Forecast;
use crate::files::flight_recorder::{FlightRecorder, RecordedStart};
use crate::files::terrain::TerrainFiles;
use crate::files::{flight_recorder, flown_log, recording_file};
use crate::firmware::cli;
use crate::flight::setup::{BootLines, check_setting};
use crate::plan::format::PlanFile;
use crate::process::error::AppError;
use crate::process::{error, runtime, stop_signal};
use crate::replay::Overview;
use crate::report::campaign::forecast_notice;
use crate::report::sentence;
use crate::screen_files::layout_file::LayoutFile;
use crate::screen_files::line_history::LineHistory;
use crate::screen_files::plan_files::PlanFiles;
use crate::screen_files::screen_file::ScreenFile;
use crate::session::{FlownBefore, Handle, ReplayConfig, SessionView, start_replay};
use crate::storage::{FirmwareFolder, Store};
use crate::terrain::Tiles;
use crate::ui::backdrop::BackdropLayer;
use crate::ui::files::{FileReply, Opened};
use crate::ui::flights::FlightShelf;
use crate::ui::keymap::Keymap;
use crate::ui::settings::GivenSetting;
use crate::ui::theme::{Charset, Palette};
use crate::ui::{
    self, CliHelp, Ending, EnteredLines, FilesLink, GroundConfig, KeptScreens, OpenPlan, OtherReceiver,
    SessionLink, Theme, Tui, UiConfig, Units,
};
use crate::vehicle::Vehicle;

/// The start of the user interface.
pub(super) struct Screen<'a> {
    /// The first open plan.
    pub(super) plan: PlanFile,
    pub(super) path: Option<&'a Path>,
    /// The files under the first plan; none = the remembered ones.
    pub(super) backdrop: Vec<BackdropLayer>,
    /// The directory for edits.
    pub(super) directory: Option<PathBuf>,
    /// The files with the kept screen.
    pub(super) screen_file: ScreenFile,
    /// The screen of the run before.
    pub(super) kept: KeptScreens,
    /// `true` if the program was used before. The first steps are then known.
    pub(super) was_used: bool,
    /// The settings that options or the scenario gave the craft.
    pub(super) given_settings: Vec<GivenSetting>,
    /// The first messages for the user.
    pub(super) notices: Vec<String>,
    /// The limits for warnings about waypoints.
    pub(super) review: ReviewArgs,
    /// The elevation tiles that were read.
    pub(super) tiles: Option<Arc<Tiles>>,
    /// `true` for sentences instead of a screen.
    pub(super) plain: bool,
    pub(super) display: &'a DisplayArgs,
    /// The elevation tiles that can be read.
    pub(super) terrain: &'a TerrainArgs,
    pub(super) source: Source<'a>,
    /// A second flight, beside the first.
    pub(super) other: Option<SecondFlight>,
}

/// The session that the user interface shows.
pub(super) enum Source<'a> {
    Flight(Box<LiveFlight<'a>>),
    /// A recorded flight.
    Replay(ReplayConfig),
}

/// A vehicle that flies.
pub(super) struct LiveFlight<'a> {
    pub(super) vehicle: Vehicle,
    /// The store for `save`, and its problems as sentences.
    pub(super) store: Store,
    pub(super) warnings: Vec<String>,
    /// The start of the flights for their recordings.
    pub(super) recorded: RecordedStart,
    /// The bound of the library of recorded flights, bytes; 0 = none.
    pub(super) recordings_most: u64,
    /// A finished flight, and pictures of it.
    pub(super) flown: Option<(FlownBefore, Vec<SessionView>)>,
    /// The doors, the physics and the flight.
    pub(super) live: LiveArgs<'a>,
}

/// A second flight, which is read while the first is shown.
pub(super) struct SecondFlight {
    /// The name of its file, safe to print.
    pub(super) name: String,
    /// Reads it. An error is a sentence.
    pub(super) read: Box<dyn FnOnce() -> Result<Arc<Overview>, String> + Send>,
}

/// Returns `true` if the environment says that the terminal takes no escape sequences.
pub(super) fn is_dumb() -> bool {
    std::env::var_os("TERM").is_some_and(|term| term == "dumb")
}

/// Refuses the screen without a terminal, or on one that cannot show it.
pub(super) fn require_terminal(plain: bool) -> Result<(), AppError> {
    if plain {
        return Ok(());
    }
    if is_dumb() {
        return Err(AppError::environment(
            "this terminal cannot place characters (TERM=dumb): add `--plain` for sentences instead of a screen, or set \
             TERM to its kind",
        ));
    }
    if std::io::stdout().is_terminal() && std::io::stdin().is_terminal() {
        return Ok(());
    }
    Err(AppError::environment(
        "the user interface needs a terminal: run betadeck in one, add `--plain` for sentences instead of a screen, or \
         fly with `betadeck fly PLAN`",
    ))
}

/// Shows the screen until the user leaves it.
pub(super) fn show(screen: Screen<'_>, keymap: Keymap) -> Result<u8, AppError> {
    let mut notices = screen.notices;
    let mut files = PlanFiles::new(screen.directory.as_deref());
    files.keep_screen_in(screen.screen_file);
    let is_replay = matches!(screen.source, Source::Replay(_));
    if is_replay {
        // The edits of another run do not belong to a recorded flight.
        files.without_journals();
    }
    let ground = TerrainFiles::new(screen.terrain)?;
    let has_ground = ground.is_somewhere();
    files.read_ground(ground, screen.tiles.clone().unwrap_or_default());
    let opened = files.start_with(screen.path, screen.plan.into());
    notices.extend(opened.notes);
    if opened.recovered {
        notices.push("Unsaved edits of this plan were restored: `u` undoes them.".to_owned());
    }
    let mut backdrop = files.begin_with_backdrop(opened.id, screen.backdrop);
    let recovered = files.recovered();
    for opened in &recovered {
        backdrop.extend(files.begin_with_backdrop(opened.id, Vec::new()));
    }
    // Edits of a built-in plan have no file.
    let is_edited = |plan: &&Opened| {
        let same_name = plan.history.document().name == opened.history.document().name;
        plan.file.is_none() && opened.file.is_none() && same_name
    };
    let edited = recovered.iter().rev().find(is_edited).map(|plan| plan.id);
    let before = screen.kept.before();
    let reopened = before.map_or_else(Vec::new, |before| files.open_kept(before, opened.id, edited));
    let history = LineHistory::new(screen.directory.as_deref());
    notices.extend(history.problems());
    let entered = history.read();
    let layouts = LayoutFile::new(screen.directory.as_deref()).read(&mut notices);
    let is_first_start = !screen.was_used && screen.directory.is_some() && entered == EnteredLines::default();
    let config = UiConfig {
        theme: theme(screen.display),
        units: units(screen.display),
        max_altitude_m: screen.review.max_altitude_m(),
        ground: GroundConfig {
            clearance_m: screen.review.clearance_m(),
            tiles: screen.tiles,
            can_read: has_ground,
        },
        keymap,
        cli: CliHelp {
            complete: |line| cli::complete(line).lines(line),
            hint: |line| cli::hint(line, None),
            check_setting,
        },
        given_settings: screen.given_settings,
        sentence: |event| sentence::text(&event.kind).unwrap_or_default(),
        go_sentence: |name, answer| forecast_notice(name, answer, Forecast::GO_FROM),
        plan: OpenPlan::new(opened.id, opened.file, opened.history),
        mouse: true,
        entered,
        layouts,
        kept: screen.kept,
        is_first_start,
    };
    let problem = |error| AppError::environment(format!("cannot use the terminal: {error}"));
    let (requests, asked) = std::sync::mpsc::channel();
    let (done, kept) = tokio::sync::watch::channel(0);
    let (answers, replies) = tokio::sync::mpsc::unbounded_channel();
    if is_replay || screen.directory.is_none() {
        answers.send(FileReply::KeepsNothing).ok();
    }
    for lost in files.take_losses() {
        answers.send(FileReply::EditsLost(lost)).ok();
    }
    for opened in recovered {
        answers.send(FileReply::Opened(Box::new(opened))).ok();
    }
    for reply in backdrop.into_iter().chain(reopened) {
        answers.send(reply).ok();
    }
    let unrecorded = answers.clone();
    let files_thread = std::thread::Builder::new()
        .name("plan-files".to_owned())
        .spawn(move || files.run(&asked, &answers, &done))
        .map_err(no_thread)?;
    let files = FilesLink::new(requests, replies, kept);
    let shelf = screen.directory.as_deref().map(|state| Arc::new(Shelf::new(state, screen.display)));
    let shelf = shelf.map(|shelf| -> Arc<dyn FlightShelf> { shelf });
    let runtime = runtime::with_threads(1)?;
    let ending = runtime.block_on(async {
        let started = start(screen.source, notices, screen.directory.as_deref(), unrecorded).await?;
        let Started { session, recorder, doors, past, directory: _directory } = started;
        let link = SessionLink {
            commands: session.commands,
            view: session.view,
            events: session.events,
            past,
            other: screen.other.map(read_beside).transpose()?,
            shelf,
            write_scenario: scenario_file::write,
            write_log: flown_log::write,
            write_recording: recording_file::write,
        };
        // This comes before the first frame, because a person who sees the frame may already send a signal.
        let stop = stop_signal::stop_in_time().map_err(problem)?;
        let ending = if screen.plain {
            let input = input_lines::read()?;
            let cannot_write = |error| AppError::environment(format!("cannot write the output: {error}"));
            ui::run_plain(link, files, config, input, std::io::stdout(), stop).await.map_err(cannot_write)
        } else {
            let tui = Tui::enter(config.mouse).map_err(problem)?;
            ui::run(tui, link, files, config, stop).await.map_err(problem)
        };
        // The session ends with its last sender, or by itself.
        let why = session.thread.join();
        // The flight under way ends its recording.
        drop(recorder.map(JoinHandle::join));
        if let Some(doors) = doors {
            doors.close().await;
        }
        match why {
            // A file of recorded flights is an input.
            Ok(Some(why)) if is_replay => Err(AppError::input(why)),
            Ok(Some(why)) => Err(AppError::environment(why)),
            Ok(None) | Err(_) => ending,
        }
    })?;
    runtime.shutdown_background();
    // The last edits are written before the program ends.
    drop(files_thread.join());
    match ending {
        Ending::Quit => Ok(0),
        // If the terminal closes, there is also a signal. It is chance which of the two is seen first.
        Ending::Signal | Ending::TerminalLost => Ok(error::INTERRUPTED),
        Ending::SessionEnded => Err(live::ended_by_itself()),
    }
}

/// A session that was started, with all that must be kept until it ends.
struct Started {
    session: Handle,
    /// The recorder, which ends after the session.
    recorder: Option<JoinHandle<()>>,
    doors: Option<OpenDoors>,
    past: Vec<SessionView>,
    directory: Option<FirmwareFolder>,
}

/// Starts the session, and the recorder of its flights in the state directory. A problem of the recorder is reported to
/// `unrecorded`.
async fn start(
    source: Source<'_>,
    notices: Vec<String>,
    state: Option<&Path>,
    unrecorded: UnboundedSender<FileReply>,
) -> Result<Started, AppError> {
    match source {
        Source::Flight(flight) => {
            let LiveFlight { vehicle, store, warnings, recorded, recordings_most, flown, live } = *flight;
            let report = move |problem| {
                unrecorded.send(FileReply::NotRecorded(problem)).ok();
            };
            let FlightRecorder { feed, thread } =
                flight_recorder::start(recorded, state, recordings_most, report)?;
            let (flown, past) = flown.unzip();
            let (session, doors, directory) =
                live::start(live, vehicle, store, Reports { notices, warnings }, flown, Some(feed)).await?;
            let past = past.unwrap_or_default();
            Ok(Started { session, recorder: Some(thread), doors, past, directory })
        }
        Source::Replay(config) => {
            let session = start_replay(ReplayConfig { notices, ..config }).map_err(no_thread)?;
            Ok(Started { session, recorder: None, doors: None, past: Vec::new(), directory: None })
        }
    }
}

/// Begins to read the second flight.
fn read_beside(flight: SecondFlight) -> Result<OtherReceiver, AppError> {
    let (sender, receiver) = tokio::sync::oneshot::channel();
    let SecondFlight { name, read } = flight;
    let read = move || {
        // The screen may have left meanwhile.
        sender.send((name, read())).ok();
    };
    std::thread::Builder::new().name("second-flight".to_owned()).spawn(read).map_err(no_thread)?;
    Ok(receiver)
}

#[expect(clippy::needless_pass_by_value, reason = "a map_err argument")]
fn no_thread(error: std::io::Error) -> AppError {
    AppError::environment(format!("cannot start a thread: {error}"))
}

/// Returns the theme of the environment, changed by the options; `NO_COLOR` wins.
fn theme(args: &DisplayArgs) -> Theme {
    let mut theme = Theme::from_environment(|name| std::env::var(name).ok());
    let palette = args.theme.map(|choice| match choice {
        ThemeChoice::Dark => Palette::Dark,
        ThemeChoice::Light => Palette::Light,
        ThemeChoice::HighContrast => Palette::HighContrast,
        ThemeChoice::Sixteen => Palette::Ansi16,
        ThemeChoice::Mono => Palette::Mono,
    });
    if let Some(palette) = palette.filter(|_| !theme.no_colour) {
        theme.palette = palette;
    }
    match args.charset {
        None | Some(CharsetChoice::Auto) => {}
        Some(CharsetChoice::Unicode) => theme.charset = Charset::Unicode,
        Some(CharsetChoice::Ascii) => theme.charset = Charset::Ascii,
    }
    theme
}

fn units(args: &DisplayArgs) -> Units {
    match args.units {
        None | Some(UnitsChoice::Metric) => Units::Metric,
        Some(UnitsChoice::Imperial) => Units::Imperial,
    }
}

/// Returns the settings that the boot lines set, with their sources.
pub(super) fn given_settings(boot_lines: &[BootLines]) -> Vec<GivenSetting> {
    let given = boot_lines.iter().flat_map(|lines| {
        let given = |name: &str| GivenSetting { name: name.to_owned(), source: lines.source.clone() };
        lines.setting_names().map(given)
    });
    given.collect()
}
