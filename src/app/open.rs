//! `betadeck open`: the screen at an instant of a flight of a scenario, a campaign or a recording, which is flown first, by
//! the embedded firmware or by a remote one.

mod of_campaign;
mod of_recording;

use super::doors::LiveArgs;
use super::screen::{self, LiveFlight, Screen, Source};
use crate::args::{DoorArgs, FlightArgs, Instant, OpenArgs, PhysicsArgs, ReviewArgs};
use crate::events::Event;
use crate::fc::KeptFlight;
use crate::files::flight_recorder::RecordedStart;
use crate::headless::{check, setup};
use crate::launch;
use crate::launch::run::{OnEvent, Stopped, unless_interrupted};
use crate::launch::{Beside, RemoteFirmware, reported};
use crate::lookahead::FlyAgain;
use crate::plan::format::PlanFile;
use crate::process::error;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::recording::Setup;
use crate::runner::{Runner, Subscriber};
use crate::scenario::{self, Air, Case, CaseFlight, Scenario};
use crate::screen_files::screen_file::{ScreenFile, ScreenStart, Subject};
use crate::session::{FlownBefore, SessionView};
use crate::signals::SimTime;
use crate::storage::Store;
use crate::text::did_you_mean;
use crate::timeline::Timeline;
use crate::ui::keymap::Keymap;
use crate::ui::settings::GivenSetting;
use crate::ui::{KeptScreen, KeptScreens};
use crate::vehicle::{Vehicle, VehicleCommand};

/// The pictures for each simulated second of the finished flight. Tracks and graphs are made from them.
const PICTURES_HZ: u64 = 5;

/// The record of a flight for the screen.
#[derive(Default)]
struct Recorded {
    events: Vec<Event>,
    past: Vec<SessionView>,
}

impl Subscriber<CaseFlight<'_>> for Recorded {
    fn event(&mut self, event: &Event) {
        self.events.push(event.clone());
    }

    fn after_tick(&mut self, flight: &CaseFlight<'_>) {
        self.look(flight.vehicle());
    }
}

impl Recorded {
    /// Records a picture of the vehicle if one is due.
    fn look(&mut self, vehicle: &Vehicle) {
        if vehicle.time().0.is_multiple_of(1_000_000 / PICTURES_HZ) {
            self.past.push(SessionView::from_recorded(vehicle));
        }
    }
}

/// Flies the case to its end and opens the screen at the instant.
pub(super) fn run(args: &OpenArgs, keymap: Keymap) -> Result<u8, AppError> {
    screen::require_terminal(args.plain)?;
    let mut notices = Vec::new();
    if let Some(recording) = of_recording::read(args)? {
        return of_recording::run(args, &recording, keymap);
    }
    let Opened { mut case, air, name, firmware, wanted } = match of_campaign::read(args)? {
        Some(opened) => opened,
        None => of_scenario(args, &mut notices)?,
    };
    if let Some(profile) = args.profile {
        case.use_profile(profile);
    }
    let flown = match &firmware {
        None => fly(&case, &air)?,
        Some(firmware) => {
            match unless_interrupted(on_its_own_thread(|| fly_remote(&case, &air, firmware)))? {
                Some(flown) => flown,
                None => return Ok(error::INTERRUPTED),
            }
        }
    };
    notices.extend(wanted.map(|wanted| wanted.compared(flown.hash)));
    let flown_hash = flown.hash;
    let Flown { flight, timeline, recorded: Recorded { events, past }, kept_flight, .. } = flown;
    let end = flight.vehicle().time();
    let again = kept_flight.map(FlyAgain::of);
    let kept = Kept::open(args, flown_hash, &mut notices);
    let show = kept.instant_or(instant(args.at, flight.trace().engaged_at, end)?, end);
    notices.push(format!("{name}, seed {}, was flown to its end: {}.", air.seed, ways_to_go(args.plain)));
    let recorded = recorded_start(&case, &air, flight.vehicle());
    let finished = Finished {
        plan: case.setup.plan.clone(),
        given_settings: screen::given_settings(&case.setup.boot_lines),
        vehicle: flight.into_vehicle(),
        recorded,
        flown: FlownBefore { timeline, events, show, again },
        past,
        kept,
        notices,
    };
    open_screen(args, finished, keymap)
}

/// Returns the ways to go on from the end of a flight: by keys, or without a screen by commands.
fn ways_to_go(plain: bool) -> &'static str {
    if plain {
        "`time.event-back` and `time.earlier` go back, `sim.pause` plays it, `time.fly-on` flies on from here"
    } else {
        "`,` and `<` go back, Space plays it, `b` flies on from here"
    }
}

/// A finished flight for the screen.
struct Finished {
    plan: PlanFile,
    /// The settings that the scenario or the recording gave the craft.
    given_settings: Vec<GivenSetting>,
    vehicle: Vehicle,
    recorded: RecordedStart,
    flown: FlownBefore,
    past: Vec<SessionView>,
    kept: Kept,
    notices: Vec<String>,
}

/// The kept screen of a finished flight.
struct Kept {
    file: ScreenFile,
    screens: KeptScreens,
}

impl Kept {
    /// Reads the screen of the flight with this number, without its place if the options name an instant.
    fn open(args: &OpenArgs, number: u64, notices: &mut Vec<String>) -> Self {
        // Without a home directory nothing is kept.
        let directory = setup::state_directory(args.state_dir.as_deref()).ok();
        let start = ScreenStart { plain: args.plain, fresh: args.fresh_screen };
        let (file, mut screens) =
            ScreenFile::open(directory.as_deref(), Subject::Flown(number), start, notices);
        if args.at.is_some() {
            screens.forget_place();
        }
        Self { file, screens }
    }

    /// Returns the instant to show: the one that was left, else `otherwise`.
    fn instant_or(&self, otherwise: SimTime, end: SimTime) -> SimTime {
        let left = self.screens.before().and_then(KeptScreen::place).and_then(|place| place.at_us);
        left.map_or(otherwise, |at_us| SimTime(at_us).min(end))
    }
}

fn open_screen(args: &OpenArgs, finished: Finished, keymap: Keymap) -> Result<u8, AppError> {
    let Finished { plan, given_settings, vehicle, recorded, flown, past, kept, notices } = finished;
    let doors = DoorArgs { no_ports: true, ..DoorArgs::default() };
    let (physics, flight_args) = (PhysicsArgs::default(), FlightArgs::default());
    let screen = Screen {
        plan,
        path: None,
        backdrop: Vec::new(),
        directory: None,
        screen_file: kept.file,
        kept: kept.screens,
        was_used: true,
        given_settings,
        notices,
        review: ReviewArgs::default(),
        tiles: None,
        plain: args.plain,
        display: &args.display,
        terrain: &flight_args.terrain,
        source: Source::Flight(Box::new(LiveFlight {
            vehicle,
            store: Store::in_memory(),
            warnings: Vec::new(),
            recorded,
            recordings_most: 0,
            flown: Some((flown, past)),
            live: LiveArgs {
                doors: &doors,
                connect: None,
                firmware: None,
                physics: &physics,
                flight: &flight_args,
                has_screen: true,
            },
        })),
        other: None,
    };
    screen::show(screen, keymap)
}

/// The flight that is opened, with its start on the screen.
struct Opened {
    case: Case,
    air: Air,
    /// The name of the flight, for the screen.
    name: String,
    firmware: Option<RemoteFirmware>,
    /// The flight as it was flown before, if it is one of a campaign.
    wanted: Option<of_campaign::FlownInCampaign>,
}

/// Reads the scenario and the firmware of the options.
fn of_scenario(args: &OpenArgs, notices: &mut Vec<String>) -> Result<Opened, AppError> {
    let scenario =
        check::load_one(&args.scenario, args.seed.as_ref().map(std::slice::from_ref), args.any_folder)?;
    let (case, air) = choose(&scenario, args)?;
    let beside = Beside {
        ports: (&args.firmware_ports).into(),
        flight: &FlightArgs::default(),
        physics: &PhysicsArgs::default(),
    };
    let firmware = launch::choose(&args.firmware, beside, notices)?;
    notices.extend(args.firmware_ports.idle_options(firmware.is_some()));
    let name = if case.name.is_empty() {
        format!("Scenario {}", scenario.name)
    } else {
        format!("Scenario {}, {}", scenario.name, case.name)
    };
    Ok(Opened { case: case.clone(), air, name, firmware, wanted: None })
}

/// A flight that is over, with its record.
struct Flown<'a> {
    flight: CaseFlight<'a>,
    timeline: Timeline,
    recorded: Recorded,
    /// The flight of a firmware in simulated time, which can be flown again.
    kept_flight: Option<KeptFlight>,
    /// Equal for flights that are the same to the last bit.
    hash: u64,
}

fn recording(flight: &mut CaseFlight<'_>) -> Result<(Timeline, Recorded), AppError> {
    let timeline = Timeline::new(flight.vehicle_mut());
    let timeline = timeline.ok_or_else(|| AppError::internal("the flight of a scenario is not recorded"))?;
    Ok((timeline, Recorded::default()))
}

/// Flies with the embedded firmware.
fn fly<'a>(case: &'a Case, air: &Air) -> Result<Flown<'a>, AppError> {
    let mut flight = CaseFlight::new(case, air).map_err(AppError::input)?;
    let mut subscribers = recording(&mut flight)?;
    let mut runner = Runner::new(flight.vehicle().step_us(), f64::INFINITY, None);
    runner
        .fly(&mut flight, &mut subscribers, || false)
        .map_err(|_| AppError::internal("the flight of a scenario stopped"))?;
    let (timeline, recorded) = subscribers;
    let hash = flight.hash();
    Ok(Flown { flight, timeline, recorded, kept_flight: None, hash })
}

/// Runs a flight on a thread, which the flight may keep to one processor.
fn on_its_own_thread<T: Send>(fly: impl FnOnce() -> Result<T, Stopped> + Send) -> Result<T, Stopped> {
    let flown = std::thread::scope(|scope| scope.spawn(fly).join());
    flown.unwrap_or_else(|_| Err(AppError::internal("a flight panicked").into()))
}

/// Flies with a remote firmware, as `check` does. An executable ends with the flight.
fn fly_remote<'a>(case: &'a Case, air: &Air, firmware: &RemoteFirmware) -> Result<Flown<'a>, Stopped> {
    if scenario::skip(case).is_some() {
        return Err(AppError::input(
            "only the embedded firmware can fly this case: its inputs or its end need knowledge that no other gives",
        )
        .into());
    }
    error::tell("The firmware flies the case first.");
    let firmware = RemoteFirmware { keeps_inputs: true, ..firmware.clone() };
    let mut tell =
        OnEvent(|event: &Event| reported::sentence(event).iter().for_each(|said| error::tell(said)));
    let (mut remote, vehicle) = check::prepare(&firmware, case, air, &interrupt_flag()?, 0, &mut tell)?;
    let mut flight = CaseFlight::from_vehicle(case, vehicle).map_err(AppError::input)?;
    let mut subscribers = recording(&mut flight)?;
    remote.fly(&mut flight, &mut subscribers)?;
    let (timeline, recorded) = subscribers;
    let hash = remote.motor_hash().unwrap_or_else(|| flight.hash());
    Ok(Flown { flight, timeline, recorded, kept_flight: remote.past(), hash })
}

/// Returns the start of the flight for its recording.
fn recorded_start(case: &Case, air: &Air, flown: &Vehicle) -> RecordedStart {
    let mut setup = case.setup_in(air);
    setup.stored.plan = setup.plan.plan.clone();
    setup.remote_controller = flown.embedded().is_none();
    // The pilot starts before the inputs are recorded.
    let pilot = case.pilot.then(|| (SimTime::ZERO, VehicleCommand::StartPilot(case.options.takeoff_m)));
    RecordedStart {
        setup: Ok(Setup::from(&setup)),
        earlier: pilot.into_iter().collect(),
        flown_until: flown.time(),
    }
}

/// Returns the requested case and air.
fn choose<'s>(scenario: &'s Scenario, args: &OpenArgs) -> Result<(&'s Case, Air), AppError> {
    let case = match &args.case {
        None => scenario.cases.first(),
        Some(name) => scenario.cases.iter().find(|case| case.name == *name).or_else(|| {
            let mut named = scenario.cases.iter().filter(|case| case.name.contains(name.as_str()));
            named.next().filter(|_| named.next().is_none())
        }),
    };
    let names = || scenario.cases.iter().map(|case| case.name.as_str());
    let case = case.ok_or_else(|| {
        let name = args.case.as_deref().unwrap_or_default();
        let guess = did_you_mean::suffix(name, names());
        let all = names().collect::<Vec<_>>().join("; ");
        AppError::input(format!("{} has no case {name}{guess}; its cases are: {all}", scenario.name))
    })?;
    let air = case.airs.first().copied().ok_or_else(|| AppError::internal("a case without a flight"))?;
    Ok((case, air))
}

/// Returns the instant as a time since boot.
fn instant(at: Option<Instant>, engaged_at: Option<SimTime>, end: SimTime) -> Result<SimTime, AppError> {
    let seconds = match at {
        None => return Ok(end),
        Some(Instant::Boot(seconds)) => seconds,
        Some(Instant::Engagement(seconds)) => match engaged_at {
            Some(engaged) => engaged.as_secs_f64() + seconds,
            None => {
                return Err(AppError::input("the autopilot never engaged in this flight: write --at boot+T"));
            }
        },
    };
    Ok(SimTime::from_secs_f64(seconds.clamp(0.0, end.as_secs_f64())))
}
