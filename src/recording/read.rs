//! Reads a recording within bounds.

use std::io::BufRead;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::error::ReadError;
use super::event::{Happened, RecordedEvent};
use super::lines::{Rest, each};
use super::picture::{Picture, Pictures, Scene};
use super::record::{End, FORMAT, Header, Record};
use super::setup::Setup;
use crate::signals::SimTime;
use crate::telemetry::{EventKind, FirmwareEvent, NavEvent};
use crate::vehicle::VehicleCommand;

/// The most memory of inputs, and of events, bytes.
const MAX_INPUTS: usize = 64 << 20;
const MAX_EVENTS: usize = 16 << 20;

/// A recorded flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    pub header: Header,
    /// The start of the flight.
    pub(super) setup: Option<Setup>,
    /// The inputs since boot with their times, oldest first.
    pub(super) inputs: Vec<(SimTime, VehicleCommand)>,
    /// The reason why it is not flown again, the end of a sentence.
    pub(super) gap: Option<String>,
    /// The beginning of the flight that the recording is about.
    pub begin: SimTime,
    /// The events since then, oldest first.
    pub events: Vec<RecordedEvent>,
    pub pictures: Pictures,
    pub end: Option<End>,
    /// The state of the file after the last line that was read.
    pub rest: Rest,
    /// The number of lines that this version does not know, or that did not fit.
    pub left_out: usize,
}

impl Recording {
    /// Reads a recording up to its last whole line.
    ///
    /// # Errors
    /// Fails if it is no recording of a version that is read, or if the source cannot be read.
    pub fn read(source: impl BufRead) -> Result<Self, ReadError> {
        let mut reading = Reading::default();
        let rest = each(source, |line| reading.take(line))?;
        let Some(header) = reading.header else { return Err(ReadError::NoRecording) };
        header.check()?;
        let recording = Self {
            header,
            setup: reading.setup,
            inputs: reading.inputs,
            gap: reading.gap,
            begin: reading.begin,
            events: reading.events,
            pictures: reading.pictures,
            end: reading.end,
            rest,
            left_out: reading.left_out,
        };
        let is_empty = recording.pictures.all().is_empty() && recording.only_pictures().is_some();
        if is_empty { Err(ReadError::Empty) } else { Ok(recording) }
    }

    /// Returns the reason why this recording cannot be flown again, the end of a sentence, if there is one.
    pub fn only_pictures(&self) -> Option<String> {
        match (&self.setup, &self.gap) {
            (_, Some(gap)) => Some(gap.clone()),
            (None, None) => Some("the start of the flight is not in it".to_owned()),
            (Some(setup), None) => setup.only_pictures().map(str::to_owned),
        }
    }

    /// Returns the start of the flight, if it is known.
    pub fn setup(&self) -> Option<&Setup> {
        self.setup.as_ref()
    }

    /// Returns the time of the last thing that was recorded.
    pub fn end_time(&self) -> SimTime {
        let picture = self.pictures.all().last().map(Picture::time);
        let input = self.inputs.last().map(|(time, _)| *time);
        self.end.as_ref().map(|end| end.t).or(picture.max(input)).unwrap_or(self.begin)
    }

    /// Returns sentences about the parts of the file that could not be read.
    pub fn notices(&self) -> Vec<String> {
        let rest = match self.rest {
            Rest::Whole => None,
            Rest::CutShort => Some("The recording ends early: it was cut short."),
            Rest::Damaged => Some("The recording is damaged: what follows is lost."),
            Rest::TooLong => Some("The recording is too long: only its beginning is read."),
        };
        let left_out = match self.left_out {
            0 => None,
            count => {
                Some(format!("Lines of the recording that are not known or too many are left out: {count}."))
            }
        };
        rest.map(str::to_owned).into_iter().chain(left_out).collect()
    }
}

/// Returns the start of a recorded flight, without reading the flight; `None` if the source does not begin with one.
pub fn read_setup(source: impl BufRead) -> Option<Setup> {
    let mut setup = None;
    let read = each(source, |line| match serde_json::from_slice::<Record>(line) {
        Ok(Record::Flight(_)) => ControlFlow::Continue(()),
        Ok(Record::Setup(read)) => {
            setup = Some(*read);
            ControlFlow::Break(())
        }
        _ => ControlFlow::Break(()),
    });
    read.ok().and(setup)
}

/// A recording that is being read.
#[derive(Debug, Default)]
struct Reading {
    header: Option<Header>,
    setup: Option<Setup>,
    inputs: Vec<(SimTime, VehicleCommand)>,
    input_bytes: usize,
    gap: Option<String>,
    begin: SimTime,
    events: Vec<RecordedEvent>,
    event_bytes: usize,
    scene: Arc<Scene>,
    /// `true` until a picture has the present scene.
    new_scene: bool,
    pictures: Pictures,
    end: Option<End>,
    left_out: usize,
}

impl Reading {
    /// Takes a line. Breaks if it shows that this is no recording that can be read.
    fn take(&mut self, line: &[u8]) -> ControlFlow<()> {
        match serde_json::from_slice::<Record>(line) {
            Ok(Record::Flight(header)) if self.header.is_none() => {
                let is_later = header.format > FORMAT;
                self.header = Some(header);
                return if is_later { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
            }
            _ if self.header.is_none() => return ControlFlow::Break(()),
            Ok(record) => self.keep(record),
            Err(_) => {
                self.left_out += 1;
                // A flight without one of its inputs is another flight.
                if line.starts_with(b"{\"input\"") || line.starts_with(b"{\"setup\"") {
                    self.lack("another version of betadeck wrote it");
                }
            }
        }
        ControlFlow::Continue(())
    }

    fn lack(&mut self, reason: impl Into<String>) {
        self.gap.get_or_insert_with(|| reason.into());
    }

    fn keep(&mut self, record: Record) {
        match record {
            // There is one at the top.
            Record::Flight(_) => self.left_out += 1,
            Record::Setup(setup) => self.setup = Some(*setup),
            Record::Input(time, input) => match input.command() {
                Ok(command) => self.keep_input(time, command),
                Err(problem) => self.lack(format!("an input makes no sense: {problem}")),
            },
            Record::Begin(begin) => self.begin = begin.t,
            Record::Event(time, what) => {
                let event = RecordedEvent { time, what };
                self.event_bytes += event_bytes(&event);
                if self.event_bytes <= MAX_EVENTS {
                    self.events.push(event);
                } else {
                    self.left_out += 1;
                }
            }
            Record::Scene(scene) => (self.scene, self.new_scene) = (Arc::new(*scene), true),
            Record::Picture(shot) => {
                let picture = Picture::new(*shot, &self.scene);
                self.pictures.push(picture, std::mem::take(&mut self.new_scene));
            }
            Record::Branch { t, inputs } => {
                self.inputs.truncate(inputs);
                self.events.retain(|event| event.time <= t);
                self.pictures.forget_after(t);
                self.end = None;
            }
            Record::Gap(reason) => self.lack(reason),
            Record::End(end) => self.end = Some(end),
        }
    }

    fn keep_input(&mut self, time: SimTime, command: VehicleCommand) {
        if self.inputs.last().is_some_and(|(last, _)| time < *last) {
            return self.lack("its inputs are not in order");
        }
        self.input_bytes += size_of::<SimTime>() + command.bytes();
        if self.input_bytes > MAX_INPUTS {
            return self.lack("it has more inputs than are read");
        }
        self.inputs.push((time, command));
    }
}

/// Returns the approximate memory of an event, bytes.
fn event_bytes(event: &RecordedEvent) -> usize {
    let heap = match &event.what {
        Happened::Notice(text) => text.len(),
        Happened::Vehicle(EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Plan { plan, .. }))) => {
            size_of_val(&**plan)
        }
        Happened::Vehicle(EventKind::Boot { airframe, .. }) => airframe.len(),
        Happened::Vehicle(_) => 0,
    };
    size_of::<RecordedEvent>() + heap
}
