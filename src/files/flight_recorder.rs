//! Records the flights of the screen in the library, on a thread of its own. The flight never waits for it.

use std::path::Path;
use std::thread::JoinHandle;
use std::time::Duration;

use crate::files::flight_library::Library;
use crate::files::recording_file::{header, recorded};
use crate::process::error::AppError;
use crate::recording::{Header, Recorder, RecordingSink, Setup};
use crate::session::{self, FeedReceiver, FlightFeed, FlightPart};
use crate::signals::SimTime;
use crate::vehicle::VehicleCommand;

/// The longest time between two writes of a flight that goes on.
const FLUSH: Duration = Duration::from_secs(1);

/// The start of the flights of a session.
pub(crate) struct RecordedStart {
    /// The start, or the reason why the flights are recorded as pictures, the end of a sentence.
    pub(crate) setup: Result<Setup, String>,
    /// The inputs of a flight before the session that its timeline does not have.
    pub(crate) earlier: Vec<(SimTime, VehicleCommand)>,
    /// The time until which that flight was flown.
    pub(crate) flown_until: SimTime,
}

impl RecordedStart {
    /// Returns the start of flights from boot.
    pub(crate) fn at_boot(setup: Result<Setup, String>) -> Self {
        Self { setup, earlier: Vec::new(), flown_until: SimTime::ZERO }
    }
}

/// The recorder of a running session.
pub(crate) struct FlightRecorder {
    /// The session's end.
    pub(crate) feed: FlightFeed,
    /// The thread, which ends after the session.
    pub(crate) thread: JoinHandle<()>,
}

/// The place of the recordings: the library, if there is one.
struct LibrarySink<R> {
    library: Option<Library>,
    report: R,
}

impl<R: FnMut(String)> LibrarySink<R> {
    /// Does something with the library. After a failure, the flight is recorded no further.
    fn with(&mut self, act: impl FnOnce(&mut Library) -> Result<(), String>) {
        if let Some(Err(problem)) = self.library.as_mut().map(act) {
            (self.report)(format!("The flight is not recorded any further: {problem}."));
        }
    }
}

impl<R: FnMut(String)> RecordingSink for LibrarySink<R> {
    fn header(&self, plan: &str) -> Header {
        header(plan)
    }

    fn begin(&mut self, header: &Header, bytes: &[u8]) {
        self.with(|library| library.begin(header, bytes));
    }

    fn append(&mut self, bytes: &[u8]) {
        self.with(|library| library.append(bytes));
    }

    fn end(&mut self, bytes: &[u8]) {
        self.with(|library| library.end(bytes));
    }

    fn discard(&mut self) {
        if let Some(library) = &mut self.library {
            library.discard();
        }
    }
}

/// Starts to record a session. The recordings go to the library in the state directory, bounded to `most_bytes`; with a
/// bound of 0 there is none. Problems are reported as sentences.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub(crate) fn start(
    start: RecordedStart,
    state: Option<&Path>,
    most_bytes: u64,
    report: impl FnMut(String) + Send + 'static,
) -> Result<FlightRecorder, AppError> {
    let RecordedStart { setup, earlier, flown_until } = start;
    let recorder = Recorder::new(setup).after(flown_until, &earlier);
    let library = state.filter(|_| most_bytes > 0).map(|state| Library::new(state, most_bytes));
    let sink = LibrarySink { library, report };
    let (feed, parts) = session::flight_feed(earlier.len() as u64);
    let thread = std::thread::Builder::new()
        .name("flight-recorder".to_owned())
        .spawn(move || run(&parts, recorder, sink))
        .map_err(|error| AppError::environment(format!("cannot start a thread: {error}")))?;
    Ok(FlightRecorder { feed, thread })
}

fn run(parts: &FeedReceiver, mut recorder: Recorder, mut sink: impl RecordingSink) {
    while let Ok(part) = parts.next(FLUSH) {
        match part {
            None => recorder.flush(&mut sink),
            Some(FlightPart::Input(time, input)) => recorder.input(time, &input, &mut sink),
            Some(FlightPart::Gap) => recorder.lose_inputs(),
            Some(FlightPart::Event(event)) => {
                recorded(&event).into_iter().for_each(|event| recorder.event(event));
            }
            Some(FlightPart::Picture(seen)) => recorder.picture(*seen, &mut sink),
            Some(FlightPart::Branch { at, inputs }) => {
                recorder.branch(at, usize::try_from(inputs).unwrap_or(usize::MAX), &mut sink);
            }
            Some(FlightPart::Plan(name, plan)) => recorder.plan(name, *plan),
            Some(FlightPart::Copy(reply)) => reply.send(Ok(recorder.copy(&mut sink))),
        }
    }
    recorder.finish(&mut sink);
}
