//! The messages to the user interface, and the requests of panels, popups and commands.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use crossterm::event::{KeyEvent, MouseEvent};

use crate::events::Event;
use crate::fc::{CraftSettings, UploadReport};
use crate::lookahead::{ForecastReply, SurveyReply};
use crate::plan::{Altitude, FlightPlan};
use crate::replay::{Curve, CurvesRequest, Overview};
use crate::session::command::{CliOutput, SessionView};
use crate::telemetry::snapshot::WorldView;
use crate::ui::model::action::Action;
use crate::ui::model::editor::Column;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::files::FileReply;
use crate::ui::model::flights::LibraryFlight;
use crate::ui::model::map_point::MapPoint;
use crate::ui::model::map_state::{MapItem, MapMode};
use crate::ui::model::plan_id::PlanId;
use crate::ui::model::settings::SettingsChange;
use crate::ui::model::settings::comparison::Comparison;

/// An input of the user interface.
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
        /// The number of its waypoints.
        count: usize,
        /// The report of the upload, or the sentence of the first refusal.
        result: Result<UploadReport, String>,
    },
    /// The session answered a change of the world.
    WorldReply {
        /// The requested change.
        line: String,
        /// The error is the sentence of the refusal.
        result: Result<(), String>,
    },
    /// A forecast, or the reason for its refusal.
    Forecast(ForecastReply),
    /// A step of a survey.
    Survey(SurveyReply),
    /// The craft answered a download.
    DownloadReply {
        /// The open plan that receives it.
        id: PlanId,
        /// The plan of the craft, or the sentence of the refusal.
        result: Result<Box<FlightPlan>, String>,
    },
    /// The settings of the craft, or the sentence of the refusal.
    SettingsReply(Result<Box<CraftSettings>, String>),
    /// The firmware answered a line that sets a setting; `None` when it went away instead.
    SetReply {
        line: String,
        output: Option<CliOutput>,
    },
    /// The craft saved its configuration. The error is the reason for a failure, a sentence.
    SaveReply(Result<(), String>),
    /// The flight was written. The result is a sentence with the place, or with the reason for a failure.
    FlightWritten {
        /// The word for the written file.
        what: &'static str,
        result: Result<String, String>,
    },
    Files(FileReply),
    /// The library of recorded flights was read. The error is a sentence.
    Flights(Result<Vec<LibraryFlight>, String>),
    /// A recorded flight was deleted. The error is the end of a sentence.
    FlightDeleted {
        file: PathBuf,
        result: Result<(), String>,
    },
    /// The user has left recorded flights. The error is the reason why they could not be shown, a sentence.
    FlightsShown(Result<(), String>),
    /// A second flight was read, to be shown beside the first.
    OtherFlight {
        /// The name of its file, safe to print.
        name: String,
        /// The flight, or the reason why it cannot be shown, a sentence.
        result: Result<Arc<Overview>, String>,
    },
    /// A part of the recorded series was read.
    Curves {
        request: CurvesRequest,
        result: Result<Vec<Curve>, String>,
    },
    /// A command could not be delivered because the session does not keep up.
    Busy,
}

/// A request of a panel, a popup or a command, which the user interface itself carries out.
#[derive(Debug)]
pub enum Request {
    /// Carry out an action that is enabled.
    Act(Action),
    Effect(Effect),
    Change(Change),
    Open(NewPopup),
    /// Note that the user has chosen a value: a digit begins to type it.
    Chosen,
    /// Open the `:` line with this text.
    Type(String),
    /// Run a line of the firmware's command line.
    Cli {
        line: String,
        /// `true` if the answer is also shown as a notice.
        is_reported: bool,
    },
}

/// A popup that a panel opens.
#[derive(Debug)]
pub enum NewPopup {
    /// The explanations of guards and abbreviations.
    Guards,
    /// The choice of plots for the graphs.
    Plots,
    /// The search of the signals.
    Signals,
    /// "Give all changed settings their defaults?"
    ResetSettings,
    /// The settings of the craft beside others.
    Settings(Comparison),
}

/// A change of the state that all panels share.
#[derive(Debug)]
pub enum Change {
    /// Show a notice for a moment and keep it in the log.
    Notify(Severity, String),
    /// Show a notice for a moment.
    Say(Severity, String),
    /// Move the window of the map.
    MapWindow(MapMode),
    /// Move the cursor on the map by columns and rows; without a cursor, the map.
    MapArrow(f64, f64),
    /// Pick up an item of the map with the mouse.
    PickUp(MapItem, MapPoint),
    /// Move the item picked up.
    DragTo(MapPoint),
    /// Put down the item picked up.
    PutDown,
    /// Begin to measure on the map, or end it.
    Measure,
    /// Set a point of the measured line.
    MeasurePoint(MapPoint),
    /// Move the second point of the measured line.
    MeasureTo(MapPoint),
    /// Show or hide the grid of coordinates.
    MapGrid,
    /// Turn the course of the craft up, or north.
    CourseUp,
    /// Show or hide the tracks of earlier flights.
    PastTracks,
    /// Move the cursor on the map by waypoints; without a cursor, the map.
    MapWaypoint(isize),
    /// Choose a file for the backdrop of the open plan.
    ChooseBackdrop,
    /// Remove the backdrop of the open plan.
    NoBackdrop,
    /// Add a waypoint at a place of the map.
    AddWaypoint(MapPoint),
    /// Move the cursor of the plan by rows.
    PlanRows(isize),
    /// Put the cursor of the plan on a cell.
    PlanCell(usize, Column),
    /// Show another altitude of a waypoint while it is dragged.
    DragAltitude(usize, Altitude),
    /// Give the dragged waypoint its altitude.
    DropAltitude,
    /// Move the cursor of the graphs by steps.
    GraphsCursor(f64),
    /// Show the newest instant in the graphs.
    NoGraphsCursor,
    /// Show a longer time span in the graphs, or a shorter one.
    GraphsSpan(isize),
    /// Move a channel of the virtual sticks to a pulse width, µs.
    Channel(usize, u16),
    /// Record the sticks, or end that.
    Record,
    /// Play the recorded sticks, or stop.
    Play,
    /// Change the settings of the craft.
    Settings(SettingsChange),
    /// Show this world until the session confirms it, so that the next press of a key counts from it.
    World(Box<WorldView>),
}

impl From<Change> for Request {
    fn from(change: Change) -> Self {
        Self::Change(change)
    }
}

impl From<Effect> for Request {
    fn from(effect: Effect) -> Self {
        Self::Effect(effect)
    }
}

/// Returns effects as requests.
pub(in crate::ui) fn requests(effects: Vec<Effect>) -> Vec<Request> {
    effects.into_iter().map(Request::from).collect()
}
