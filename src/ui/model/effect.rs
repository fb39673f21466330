//! The effects that the user interface requests from the shell.

use std::path::PathBuf;
use std::time::Duration;

use super::files::FileRequest;
use super::plan_id::PlanId;
use crate::lookahead::{ForecastJob, SurveyJob};
use crate::plan::FlightPlan;
use crate::replay::CurvesRequest;
use crate::session::command::Command;
use crate::vehicle::VehicleCommand;

/// A form in which the flight just flown is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlightForm {
    /// A test for `betadeck check`.
    Scenario,
    /// The blackbox log of the craft.
    Log,
}

impl FlightForm {
    /// Returns the word for such a file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Scenario => "scenario",
            Self::Log => "log",
        }
    }
}

/// A request that the shell carries out.
#[derive(Debug)]
pub enum Effect {
    Send(Command),
    /// Run a CLI line; the reply comes back as `Msg::CliReply`.
    Cli(String),
    /// Read all settings of the craft; the reply comes back as `Msg::SettingsReply`.
    ReadSettings,
    /// Run a line that sets a setting; the reply comes back as `Msg::SetReply`.
    Set(String),
    /// Change the world, such as `wind=5@270`; the reply comes back as `Msg::WorldReply`.
    World(String),
    /// Upload a plan to the craft; the reply comes back as `Msg::UploadReply`.
    Upload {
        /// The identifier of the plan.
        id: PlanId,
        /// The name of the plan.
        name: String,
        plan: Box<FlightPlan>,
        /// The setting lines of the plan, without `set `.
        settings: Vec<String>,
    },
    /// Read a part of the recorded series; the curves come back as `Msg::Curves`.
    Curves(CurvesRequest),
    /// Fly ahead on a copy of the vehicle; the forecast comes back as `Msg::Forecast`.
    Forecast(ForecastJob),
    /// Fly many flights on copies of the vehicle; the steps come back as `Msg::Survey`.
    Survey(SurveyJob),
    /// End the survey; this revision is the newest now.
    EndSurvey(u64),
    Files(FileRequest),
    /// Read the plan of the craft into this open plan; the reply comes back as `Msg::DownloadReply`.
    Download(PlanId),
    /// Save the configuration in the craft's flash, as a ground station does; the reply comes back as
    /// `Msg::SaveReply`.
    SaveToFlash,
    /// Write the flight just flown to this file, or to one named after the plan; the reply comes back as
    /// `Msg::FlightWritten`.
    WriteFlight {
        form: FlightForm,
        file: Option<PathBuf>,
        /// The name of the plan.
        plan: String,
    },
    /// Write the recording of the flight so far to this file, or to one named after the plan; the reply comes back as
    /// `Msg::FlightWritten`.
    WriteRecording {
        file: Option<PathBuf>,
        /// The name of the plan.
        plan: String,
    },
    /// Read the library of recorded flights after a while; the list comes back as `Msg::Flights`.
    ListFlights {
        after: Duration,
    },
    /// Delete a recorded flight; the reply comes back as `Msg::FlightDeleted`.
    DeleteFlight(PathBuf),
    /// Show a recorded flight on this terminal, or two beside each other; `Msg::FlightsShown` when the user leaves them.
    ShowFlights {
        files: Vec<PathBuf>,
        /// `true` to fly the flight again from its inputs.
        again: bool,
    },
    /// Copy text to the terminal's clipboard.
    Copy(String),
    /// Draw the whole screen again, not only the part that changed.
    Redraw,
    /// Restore the terminal and stop until the shell continues the program.
    Suspend,
    /// Restore the terminal and end the program.
    Quit,
}

impl From<VehicleCommand> for Effect {
    fn from(command: VehicleCommand) -> Self {
        Self::Send(Command::Vehicle(command))
    }
}
