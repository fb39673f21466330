//! The requests of user interfaces and links to the session, and the replies.

use std::sync::Arc;

use super::reply::ReplyTo;
use crate::fc::{CraftSettings, RemoteView, UploadReport, UploadView};
use crate::link::endpoint::EndpointStatus;
use crate::lookahead::VehicleCopy;
use crate::plan::FlightPlan;
use crate::replay::{Curve, CurvesRequest};
use crate::session::replay_view::ReplayView;
use crate::signals::{RcFrame, SimTime};
use crate::sim::WorldCommand;
use crate::telemetry::{LinkState, LostTime, Snapshot};
use crate::timeline::{RecordedFlight, TimelineView};
use crate::vehicle::{Vehicle, VehicleCommand};

/// Notice that the recording is not the whole flight.
pub const BEGINNING_LOST: &str =
    "The recording does not reach back to where this flight began: put the craft back home and fly again.";

/// Refusal of changes by clients of the doors while an earlier instant is shown.
pub const REWOUND_FOR_CLIENTS: &str =
    "An earlier instant is shown on the screen: changes are refused until you leave it there";

/// The instant to show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Seek {
    /// The instant at this time.
    Time(SimTime),
    /// This many seconds later; earlier if negative.
    Seconds(f64),
    /// The previous event: any event, or only state changes of the autopilot.
    Back {
        /// `true` to count only state changes of the autopilot.
        states_only: bool,
    },
    /// Shortly before the link loss, the disarming or another alarm that led to the shown crash or fall.
    BeforeMishap,
    /// The next event. From the newest instant on, the flight continues until there is one.
    Forward {
        /// `true` to count only state changes of the autopilot.
        states_only: bool,
    },
    /// The newest instant. Time continues if it did before.
    Newest,
}

/// A request to the session. Requests are handled between two ticks, in the order of sending.
#[derive(Debug)]
pub enum Command {
    /// Pauses (`true`) or resumes.
    Pause(bool),
    /// Advances this many ticks while paused.
    Step(u32),
    /// Shows another instant of the flight. The flight waits meanwhile.
    Seek(Seek),
    /// Continues the flight from the earlier instant that is shown. The part after it is discarded.
    FlyOn,
    /// Runs at this multiple of real time; [`f64::INFINITY`] = as fast as possible.
    Speed(f64),
    /// Changes the vehicle. A refusal is a notice.
    Vehicle(VehicleCommand),
    /// Runs a CLI line of the console session. The reply is its output.
    Cli {
        /// The line, without line end.
        line: String,
        reply: ReplyTo<CliOutput>,
    },
    /// Uploads a plan to the craft as a ground station does. The reply is the craft's answer.
    Upload {
        /// The name of the plan, for recordings.
        name: String,
        plan: Box<FlightPlan>,
        /// Setting lines that come with the plan file, without `set `.
        settings: Vec<String>,
        /// Receives a report, or the sentence of the first refusal.
        reply: ReplyTo<Result<UploadReport, String>>,
    },
    /// Reads the plan of the craft as a ground station does.
    Download {
        /// Receives the plan, or the sentence of the refusal.
        reply: ReplyTo<Result<Box<FlightPlan>, String>>,
    },
    /// Reads all settings of the craft, those of the shown instant while the flight is rewound.
    ReadSettings {
        /// Receives the settings, or the sentence of the refusal.
        reply: ReplyTo<Result<Box<CraftSettings>, String>>,
    },
    /// Saves the configuration of the craft, plan included, without a restart.
    Save {
        /// Receives `Ok`, or the reason as a sentence.
        reply: ReplyTo<Result<(), String>>,
    },
    /// Starts the scripted pilot that flies the whole mission: arm, climb to the session's altitude, engage.
    StartPilot,
    /// Permits changes to the remote craft over the connection with this number, until it ends.
    PermitChanges(u32),
    /// Changes the air, the noise or a fault.
    World {
        change: Box<WorldCommand>,
        /// Receives `Ok`, or the reason.
        reply: ReplyTo<Result<(), String>>,
    },
    /// Copies the vehicle as shown between two ticks, for a forecast. The reply is the copy, or the reason
    /// why there is none.
    CopyVehicle {
        /// `true` if the forecast continues the present flight. An executable can be flown ahead only so.
        continues: bool,
        reply: ReplyTo<Result<VehicleCopy, String>>,
    },
    /// Copies the recorded flight of the shown instant up to its end. The reply is the copy, or the reason
    /// why there is none.
    RecordedFlight(ReplyTo<Result<Box<RecordedFlight>, String>>),
    /// Shows another flight of the recorded file: this many further.
    ShowFlight(isize),
    /// Reads a part of the recorded series. The reply is their curves, or the reason why there are none.
    Curves {
        request: CurvesRequest,
        reply: ReplyTo<Result<Vec<Curve>, String>>,
    },
    /// Copies the recording of the flight so far: the bytes of a file. The reply is the copy, or the reason why there is
    /// none.
    CopyRecording(ReplyTo<Result<Vec<u8>, String>>),
    Quit,
}

/// The output of a CLI line.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct CliOutput {
    /// Text, lines separated by CRLF.
    pub text: String,
    /// The remedy for a refusal, or the remaining steps. Not part of the firmware's output.
    pub advice: Option<String>,
    /// `true` if the firmware restarted (save, exit, defaults).
    pub restarted: bool,
}

/// The state that is published after each slice of simulation.
#[derive(Debug, Clone, Default)]
pub struct SessionView {
    pub vehicle: Arc<Snapshot>,
    pub paused: bool,
    /// The requested multiple of real time; infinite = as fast as possible.
    pub speed_wanted: f64,
    /// The multiple of real time achieved over the last second.
    pub speed_achieved: f64,
    /// The real time that was lost.
    pub lost_time: LostTime,
    /// The frame of the virtual sticks.
    pub sticks: RcFrame,
    /// `true` while the virtual sticks are cut.
    pub rc_cut: bool,
    /// The current upload to a remote flight controller.
    pub upload: Option<UploadView>,
    /// The activity of the scripted pilot in a word or two; `None` unless it is flying.
    pub pilot: Option<&'static str>,
    /// The endpoints at which other programs reach the craft.
    pub endpoints: Vec<EndpointStatus>,
    /// The link to the external simulator; `None` if the physics is embedded.
    pub simulator: Option<LinkState>,
    /// The remote flight controller, if there is one.
    pub remote: Option<RemoteView>,
    /// The recording; `None` if the flight cannot be rewound.
    pub timeline: Option<TimelineView>,
    /// The recorded flight that is shown; `None` if a vehicle flies.
    pub replay: Option<Arc<ReplayView>>,
    /// The number of commands that were carried out before this view.
    pub commands_taken: u64,
    /// The number of events that were sent before this view. It shows their outcome.
    pub events_sent: u64,
}

impl SessionView {
    /// Returns the view that a session would have shown of this vehicle, for a flight that was flown before
    /// the session began.
    pub fn from_recorded(vehicle: &Vehicle) -> Self {
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
            timeline: None,
            replay: None,
            commands_taken: 0,
            events_sent: 0,
        }
    }

    /// Returns `true` if an earlier instant is shown while the flight waits.
    pub fn is_rewound(&self) -> bool {
        self.timeline.as_ref().is_some_and(|timeline| timeline.rewound)
    }

    /// Returns `true` if the craft is armed. While an earlier instant is shown, the newest one counts. A
    /// recorded flight has no live craft.
    pub fn is_armed_now(&self) -> bool {
        match &self.timeline {
            _ if self.replay.is_some() => false,
            Some(timeline) if timeline.rewound => timeline.head_is_armed,
            Some(_) | None => self.vehicle.craft.is_armed(),
        }
    }
}
