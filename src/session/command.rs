//! What a user interface or a link can ask of the session, and what it gets back.

use std::sync::Arc;

pub use crate::sim::{COMMAND_WORDS as WORLD_WORDS, FAULTS, FaultInfo, SWITCHES as WORLD_SWITCHES};

use super::remote::RemoteView;
use super::upload::UploadReport;
use crate::plan::FlightPlan;
use crate::signals::{RcFrame, SimTime};
use crate::telemetry::{EndpointStatus, InFlightCommand, LinkState, LostTime, Snapshot};
use crate::timeline::{RecordedFlight, TimelineView};
use crate::vehicle::Vehicle;

/// Why time cannot be paused, stepped or made faster with an external simulator.
pub const TIME_IS_EXTERNAL: &str = "The simulator sets the time: pause it or change its speed there.";

/// Why time cannot be paused, stepped or made faster with a flight controller outside.
pub const TIME_IS_THE_FIRMWARES: &str =
    "The firmware outside runs on the wall clock: time cannot be paused, stepped or made faster.";

/// Why the craft cannot be put back home with an external simulator.
pub const PLACE_IS_EXTERNAL: &str =
    "The simulator places the craft: reset its world there, and the firmware starts anew by itself.";

/// Why a flight cannot be taken back whose flight controller runs somewhere else.
pub const NOT_RECORDED: &str = "The flight controller runs elsewhere: its time cannot be taken back.";

/// Why what was recorded is not the whole flight.
pub const BEGINNING_LOST: &str =
    "The recording does not reach back to where this flight began: put the craft back home and fly again.";

/// Why nothing is steered while an earlier instant is shown.
pub const REWOUND: &str = "An earlier instant is shown: `b` flies on from here, `e` goes back to the end.";

/// Why clients of the doors change nothing while an earlier instant is shown.
pub const REWOUND_FOR_CLIENTS: &str =
    "An earlier instant is shown on the screen: changes are refused until it is left there";

/// Why a plan is not uploaded while another is.
pub const UPLOADING: &str = "another upload is under way: wait for its end, then upload again";

/// Which instant to show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Seek {
    /// The instant at this time.
    Time(SimTime),
    /// So many seconds later; negative: earlier.
    Seconds(f64),
    /// The event before; of the autopilot's states alone, or any.
    Back {
        /// Only its states count.
        states_only: bool,
    },
    /// Shortly before the link loss, the disarming or another alarm that led to the shown crash or fall.
    BeforeMishap,
    /// The event after; from the newest instant on, the flight goes on until there is one.
    Forward {
        /// Only the autopilot's states count.
        states_only: bool,
    },
    /// The newest instant; time goes on if it did before.
    Newest,
}

/// A request to the session. Requests are carried out between two ticks, in the order they were sent.
#[derive(Debug)]
pub enum Command {
    /// Pause (`true`) or go on.
    Pause(bool),
    /// Advance this many ticks while paused.
    Step(u32),
    /// Show another instant of the flight, which waits meanwhile.
    Seek(Seek),
    /// Fly on from the earlier instant that is shown: what came after it is left behind.
    FlyOn,
    /// Run at this many times real time; [`f64::INFINITY`] = as fast as possible.
    Speed(f64),
    /// The virtual sticks: sent 50 times a simulated second until replaced.
    Sticks(RcFrame),
    /// Cut (`true`) or restore the RC link of the virtual sticks.
    CutRc(bool),
    /// Run a CLI line of the console session; the reply is its output.
    Cli {
        /// The line, without line end.
        line: String,
        reply: tokio::sync::oneshot::Sender<CliOutput>,
    },
    /// Hand a plan to the craft the way a ground station does; the reply says what the craft answered.
    Upload {
        plan: Box<FlightPlan>,
        /// Setting lines that come with the plan file, without `set `.
        settings: Vec<String>,
        /// Gets what was done, or the sentence of the first refusal.
        reply: tokio::sync::oneshot::Sender<Result<UploadReport, String>>,
    },
    /// Read the plan of the craft the way a ground station does.
    Download {
        /// Gets the plan, or the sentence of the refusal.
        reply: tokio::sync::oneshot::Sender<Result<Box<FlightPlan>, String>>,
    },
    /// Save the configuration of the craft, plan included, without a restart.
    Save {
        /// Gets `Ok` or why not, as a sentence.
        reply: tokio::sync::oneshot::Sender<Result<(), String>>,
    },
    /// Start (`true`) or stop the scripted pilot that flies the whole mission: arm, climb, engage.
    Pilot(bool),
    /// Go to a waypoint, hold here, go on.
    InFlight(InFlightCommand),
    /// Fly home and land.
    ReturnHome,
    /// Take [`Command::ReturnHome`] back: the AUTOPILOT switch decides again.
    CancelReturn,
    /// Put the craft back home, disarmed; plan and settings are kept.
    ResetCraft,
    /// Let the craft outside be changed over the connection of this number, until that ends.
    PermitChanges(u32),
    /// Change the air, the noise or a fault: `wind=5@270`, `fault=motor,,2:0.8`, `end=all`…
    World {
        line: String,
        /// Gets `Ok` or why not.
        reply: tokio::sync::oneshot::Sender<Result<(), String>>,
    },
    /// Copy the vehicle as it is shown between two ticks, for a forecast; the reply is the copy, or why there can be none.
    CopyVehicle(tokio::sync::oneshot::Sender<Result<VehicleCopy, String>>),
    /// Copy the recorded flight to which the shown instant belongs, to its end; or why there is none.
    RecordedFlight(tokio::sync::oneshot::Sender<Result<Box<RecordedFlight>, String>>),
    Quit,
}

/// A copy of the vehicle to fly forecasts with.
#[derive(Debug)]
pub struct VehicleCopy {
    pub(super) vehicle: Box<Vehicle>,
    /// Altitude to which the scripted pilot climbs, m.
    pub(super) takeoff_m: f64,
}

/// Output of a CLI line.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct CliOutput {
    /// Text, lines separated by CRLF.
    pub text: String,
    /// The way out of a refusal, or what is still to do; not part of what the firmware says.
    pub advice: Option<String>,
    /// Whether the firmware restarted (save, exit, defaults).
    pub restarted: bool,
}

/// What is published after each slice of simulation.
#[derive(Debug, Clone, Default)]
pub struct SessionView {
    pub vehicle: Arc<Snapshot>,
    pub paused: bool,
    /// Requested times real time; infinite = as fast as possible.
    pub speed_wanted: f64,
    /// Achieved over the last second.
    pub speed_achieved: f64,
    /// Real time that was lost.
    pub lost_time: LostTime,
    /// The frame of the virtual sticks.
    pub sticks: RcFrame,
    /// The virtual sticks are cut.
    pub rc_cut: bool,
    /// An upload to a remote flight controller that is under way.
    pub upload: Option<UploadView>,
    /// The scripted pilot is flying, and what it is doing in a word or two.
    pub pilot: Option<&'static str>,
    /// Where other programs reach the craft.
    pub endpoints: Vec<EndpointStatus>,
    /// Whether the external simulator speaks; `None` when the physics is our own.
    pub simulator: Option<LinkState>,
    /// The flight controller, when it runs outside.
    pub remote: Option<RemoteView>,
    /// Files or doors influence the flight: not repeatable.
    pub live: bool,
    /// The recording; `None` when the flight cannot be taken back.
    pub timeline: Option<TimelineView>,
}

/// How far an upload is, in lines of the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UploadView {
    /// How many lines were sent.
    pub sent: usize,
    /// How many there are, reading the plan back among them.
    pub total: usize,
}

impl SessionView {
    /// What a session would have shown of this vehicle: for a flight that was flown before it began.
    pub fn of_recorded(vehicle: &Vehicle) -> Self {
        Self {
            vehicle: Arc::new(vehicle.snapshot()),
            paused: true,
            speed_wanted: 1.0,
            speed_achieved: 0.0,
            lost_time: LostTime::default(),
            sticks: vehicle.transmitter().sticks(),
            rc_cut: vehicle.transmitter().is_cut(),
            upload: None,
            pilot: vehicle.transmitter().pilot_doing(),
            endpoints: Vec::new(),
            simulator: None,
            remote: None,
            live: false,
            timeline: None,
        }
    }

    /// Whether an earlier instant is shown while the flight waits.
    pub fn is_rewound(&self) -> bool {
        self.timeline.as_ref().is_some_and(|timeline| timeline.rewound)
    }

    /// Whether the craft is armed, at the newest instant while an earlier one is shown.
    pub fn is_armed_now(&self) -> bool {
        match &self.timeline {
            Some(timeline) if timeline.rewound => timeline.head_is_armed,
            Some(_) | None => self.vehicle.craft.is_armed(),
        }
    }
}
