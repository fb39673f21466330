//! Starts the session of `betadeck` and `serve`, which flies in real time and serves its doors.
#![allow(clippy::disallowed_methods, reason = "answers are awaited in wall time")]

use std::time::Instant;

use super::doors::{self, Connection, LiveArgs, OpenDoors};
use super::telemetry_recording;
use crate::args::Speed;
use crate::events::SessionEvent;
use crate::fc::{RemoteEnds, RemoteLink};
use crate::headless::setup;
use crate::launch::link::OpenLink;
use crate::launch::{RemoteFirmware, link};
use crate::link::FcStream;
use crate::process::error::AppError;
use crate::session::{self, FlightFeed, FlownBefore, Handle, SessionConfig};
use crate::storage::{FirmwareFolder, Store};
use crate::vehicle::{Vehicle, VehicleCommand};

/// The altitude to which the scripted pilot climbs before it engages, m.
const TAKEOFF_M: f64 = 10.0;

/// Returns the error for a session that ended without a request.
pub(super) fn ended_by_itself() -> AppError {
    AppError::internal("the session ended by itself")
}

/// The sentences with which a session begins.
#[derive(Default)]
pub(super) struct Reports {
    pub(super) notices: Vec<String>,
    /// The problems of the store.
    pub(super) warnings: Vec<String>,
}

/// Opens the doors and starts the session; the sentences are reported first, and `feed` records its flights. With
/// `--no-ports` there are no doors. A returned directory belongs to the remote firmware, and must be kept until the session
/// has ended.
///
/// # Errors
/// Returns an error if there is no socket for the motors of an external simulator, no thread, or no link to the
/// remote firmware.
pub(super) async fn start(
    args: LiveArgs<'_>,
    mut vehicle: Vehicle,
    store: Store,
    Reports { mut notices, warnings }: Reports,
    flown: Option<FlownBefore>,
    feed: Option<FlightFeed>,
) -> Result<(Handle, Option<OpenDoors>, Option<FirmwareFolder>), AppError> {
    let state = setup::store_directory(args.flight)?;
    let firmware =
        args.firmware.map(|firmware| RemoteFirmware { keeps_inputs: args.has_screen, ..firmware.clone() });
    let opened = firmware.map(|firmware| link::open(&firmware, &vehicle, state.as_deref())).transpose()?;
    let mut first_events = Vec::new();
    let (doors, endpoints) = match doors::open(args, opened.as_ref().map(|opened| &opened.link)).await? {
        Some(opened) => {
            notices.extend(opened.notices);
            first_events.push(SessionEvent::Endpoints(opened.addresses));
            (Some(opened.doors), Some(opened.endpoints))
        }
        None => (None, None),
    };
    notices.extend(opened.iter().flat_map(OpenLink::notices));
    let ground_station = doors::bind_ground_station(args.doors, args.connect.is_some(), &mut notices).await;
    if !args.has_screen {
        // RC comes only through the doors. Virtual sticks at rest would hide the loss of a script, or disturb one that
        // sends to a firmware on the wall clock. One in simulated time gets them until the first frame of a script.
        let gets_sticks = opened.as_ref().is_some_and(|opened| opened.link.is_in_steps());
        vehicle.apply(&VehicleCommand::CutRc(!gets_sticks));
    }
    let (remote, directory) = opened.map(|opened| (opened.link, opened.directory)).unzip();
    first_events.extend(warnings.into_iter().map(SessionEvent::Warning));
    first_events.extend(notices.into_iter().map(SessionEvent::Notice));
    let config = SessionConfig {
        vehicle,
        store,
        starter_modes: true,
        speed: args.flight.speed.map_or(1.0, |Speed(speed)| speed),
        takeoff_m: TAKEOFF_M,
        is_recorded: args.has_screen,
        endpoints,
        remote: match args.connect {
            Some(connection) => Some(connect(connection)?),
            None => remote,
        },
        first_events,
    };
    let session = session::start_at(config, flown, feed)
        .map_err(|error| AppError::environment(format!("cannot start a thread: {error}")))?;
    let ground_station = ground_station.map(|door| door.serve(session.orders.clone(), session.view.clone()));
    let doors = OpenDoors::with_ground_station(doors, ground_station);
    Ok((session, doors, directory.flatten()))
}

/// Returns the link to a flight controller and starts to connect.
fn connect(Connection { place, tlog }: Connection<'_>) -> Result<RemoteLink, AppError> {
    let log = tlog.map(telemetry_recording::create).transpose()?;
    let stream = FcStream::open(place.clone());
    let now = Instant::now();
    if place.speaks_mavlink() {
        let stream = match log {
            Some(file) => telemetry_recording::recorded(stream, file),
            None => stream,
        };
        return Ok(RemoteLink::mavlink(stream, now));
    }
    Ok(RemoteLink::new(RemoteEnds { name: place.to_string(), stream, peer: None, child: None }, now))
}
