//! The messages before a flight with a remote firmware.

use super::{Beside, Output, Recorded};
use crate::args::FlyArgs;
use crate::events::Event;
use crate::files::recording_file::Recorder;
use crate::launch::reported;
use crate::plan::format::PlanFile;
use crate::process::error;
use crate::process::error::AppError;
use crate::report::sentence;
use crate::runner::Subscriber;
use crate::text::printable;
use crate::vehicle::Vehicle;

/// The messages before a flight with a remote firmware. The files begin with the flight.
#[derive(Debug)]
pub(in crate::headless::fly) struct Prelude<'a> {
    args: &'a FlyArgs,
    /// The first events, for the outputs that begin with the flight.
    held: Vec<Event>,
    problem: Option<AppError>,
}

impl<'a> Prelude<'a> {
    /// Creates the messages before the flight of these options.
    pub(in crate::headless::fly) fn new(args: &'a FlyArgs) -> Self {
        Self { args, held: Vec::new(), problem: None }
    }

    /// Reports an event: as a sentence on standard output, or, if other output goes there, on standard error until the
    /// flight begins.
    pub(in crate::headless::fly) fn write(&mut self, event: &Event) -> Result<(), AppError> {
        self.held.push(event.clone());
        if !self.args.has_sentences() {
            reported::tell(event);
        } else if let Some(line) = sentence::line(event) {
            error::write_stdout(format!("{}\n", printable::line(&line)).as_bytes())?;
        }
        Ok(())
    }

    /// Returns the error with which an event could not be reported, if there was one.
    pub(in crate::headless::fly) fn check(&mut self) -> Result<(), AppError> {
        self.problem.take().map_or(Ok(()), Err)
    }

    /// Opens the outputs at the beginning of the flight.
    pub(in crate::headless::fly) fn open(
        self,
        vehicle: &Vehicle,
        plan: &PlanFile,
        beside: Beside,
        recorder: Option<Recorder>,
    ) -> Result<Output, AppError> {
        let files = Recorded { recorder, log: None };
        let mut output = Output::open(self.args, vehicle, plan, beside, files)?;
        let is_told = self.args.has_sentences();
        for event in &self.held {
            if is_told {
                output.record(event);
            } else {
                output.write(event)?;
            }
        }
        output.flush()?;
        Ok(output)
    }
}

impl Subscriber<Vehicle> for Prelude<'_> {
    fn event(&mut self, event: &Event) {
        if let Err(problem) = self.write(event) {
            self.problem.get_or_insert(problem);
        }
    }

    fn goes_on(&self) -> bool {
        self.problem.is_none()
    }
}
