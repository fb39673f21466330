//! The messages that the user interface gets, and the effects that it asks for.

use std::path::PathBuf;
use std::time::Duration;

use crossterm::event::{KeyEvent, MouseEvent};

use super::editor::{FileReply, FileRequest, PlanId};
use crate::plan::FlightPlan;
use crate::session::command::{CliOutput, Command, SessionView};
use crate::session::{Event, ForecastJob, ForecastReply, UploadReport};

/// Something that happened outside.
#[derive(Debug)]
pub enum Msg {
    /// Wall-clock time since the user interface started; sent ahead of the messages that it dates.
    Clock(Duration),
    /// A key was pressed.
    Key(KeyEvent),
    /// The mouse was used.
    Mouse(MouseEvent),
    Paste(String),
    /// The terminal has this many columns and rows.
    Resize(u16, u16),
    /// The session published a picture.
    View(SessionView),
    /// Something happened to the vehicle.
    Event(Event),
    /// The firmware answered a CLI line; `None` when it went away instead.
    CliReply(Option<CliOutput>),
    /// The craft answered an upload.
    UploadReply {
        /// The plan that was uploaded.
        id: PlanId,
        /// How many waypoints it had.
        count: usize,
        /// What was done, or the sentence of the first refusal.
        result: Result<UploadReport, String>,
    },
    /// The session answered a change of the world.
    WorldReply {
        /// What was to change.
        line: String,
        /// The sentence of the refusal otherwise.
        result: Result<(), String>,
    },
    /// A forecast, or why there is none.
    Forecast(ForecastReply),
    /// The craft answered a download.
    DownloadReply {
        /// The plan that takes it in.
        id: PlanId,
        /// The plan of the craft, or the sentence of the refusal.
        result: Result<Box<FlightPlan>, String>,
    },
    /// The craft saved its configuration: the sentence of why not otherwise.
    SaveReply(Result<(), String>),
    /// The flight was written as a scenario, a sentence tells where; or why not.
    ScenarioReply(Result<String, String>),
    Files(FileReply),
    /// A command could not be delivered because the session does not keep up.
    Busy,
}

/// Something to be done outside.
#[derive(Debug)]
pub enum Effect {
    Send(Command),
    /// Run a CLI line; the reply comes back as [`Msg::CliReply`].
    Cli(String),
    /// Change the world, `wind=5@270`; the reply comes back as [`Msg::WorldReply`].
    World(String),
    /// Hand a plan to the craft; the reply comes back as [`Msg::UploadReply`].
    Upload {
        /// Which plan it is.
        id: PlanId,
        plan: Box<FlightPlan>,
        /// Setting lines that come with it, without `set `.
        settings: Vec<String>,
    },
    /// Fly ahead on a copy of the vehicle; the forecast comes back as [`Msg::Forecast`].
    Forecast(ForecastJob),
    Files(FileRequest),
    /// Read the plan of the craft for this open plan; it comes back as [`Msg::DownloadReply`].
    Download(PlanId),
    /// Save the configuration in the craft's flash, as a ground station does; a notice tells how it went.
    SaveToFlash,
    /// Write the flight just flown as a scenario into this file, or into one with the name of the plan; it comes back as
    /// [`Msg::ScenarioReply`].
    WriteScenario {
        file: Option<PathBuf>,
        /// The name of the plan.
        plan: String,
    },
    /// Give text to the terminal's clipboard.
    Copy(String),
    /// Give the terminal back until the shell continues the program.
    Suspend,
    /// Give the terminal back and end.
    Quit,
}
