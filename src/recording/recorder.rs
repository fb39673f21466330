//! Records the flights of a session, each as a recording of its own.
//!
//! A flight begins when the craft is armed, and ends some seconds after it was disarmed, or when it is put back home or
//! restarted. Its recording has all inputs since boot, because it is flown again from there; the events and pictures are
//! those since the flight before it.

use super::ending::Ending;
use super::event::RecordedEvent;
use super::fingerprint::{Fingerprint, FlightPrint};
use super::picture::Seen;
use super::record::{End, Header};
use super::setup::Setup;
use super::write::Writer;
use crate::plan::FlightPlan;
use crate::signals::SimTime;
use crate::telemetry::Snapshot;
use crate::timeline::begins_flight;
use crate::vehicle::VehicleCommand;

/// The time for which a flight is recorded after the disarming, µs.
const AFTERMATH_US: u64 = 5_000_000;
/// The time between two writes, µs.
const FLUSH_US: u64 = 1_000_000;
/// The most compressed inputs since boot, and the longest recording, bytes.
const MAX_HISTORY: usize = 32 << 20;
const MAX_FLIGHT: usize = 64 << 20;
/// The most that is kept of a craft that waits on the ground, bytes.
const MAX_WAITING: usize = 4 << 20;
/// The number of inputs after which they are compressed.
const INPUTS: usize = 1000;
/// The most events that count for the verdict.
const MAX_EVENTS: usize = 10_000;

/// The place of the recordings of finished flights.
pub trait RecordingSink {
    /// Returns the first line of a recording that begins now.
    fn header(&self, plan: &str) -> Header;

    /// Begins a recording with these bytes.
    fn begin(&mut self, header: &Header, bytes: &[u8]);

    fn append(&mut self, bytes: &[u8]);

    /// Ends the recording with these bytes.
    fn end(&mut self, bytes: &[u8]);

    /// Forgets the recording that was begun.
    fn discard(&mut self);
}

/// Records the flights of a session.
#[derive(Debug)]
pub struct Recorder {
    setup: Option<Setup>,
    /// The plan that was uploaded last, with its name.
    named: Option<(String, FlightPlan)>,
    /// The compressed inputs since boot.
    history: Vec<u8>,
    inputs: Writer,
    /// The number of inputs that were recorded.
    count: usize,
    /// The reason why later flights cannot be flown again, the end of a sentence.
    gap: Option<String>,
    flight: Flight,
}

/// The flight since the last one, perhaps still on the ground.
#[derive(Debug)]
struct Flight {
    begin: SimTime,
    /// The length of the inputs before it.
    history: usize,
    bytes: Vec<u8>,
    writer: Writer,
    events: Vec<RecordedEvent>,
    prints: Vec<(SimTime, Option<Fingerprint>)>,
    armed_at: Option<SimTime>,
    disarmed_at: Option<SimTime>,
    plan: String,
    /// The time of the last picture.
    last: SimTime,
    flushed_at: SimTime,
    /// `true` once it has begun in the sink.
    is_begun: bool,
}

impl Flight {
    fn new(begin: SimTime, history: usize) -> Self {
        let mut writer = Writer::part();
        writer.begin(begin);
        Self {
            begin,
            history,
            bytes: Vec::new(),
            writer,
            events: Vec::new(),
            prints: Vec::new(),
            armed_at: None,
            disarmed_at: None,
            plan: String::new(),
            last: begin,
            flushed_at: begin,
            is_begun: false,
        }
    }

    /// Returns the last line.
    fn end(&self) -> End {
        let verdict = Ending::of(&self.events).verdict();
        let mut hash = Some(FlightPrint::default());
        for (time, print) in &self.prints {
            match (&mut hash, print) {
                (Some(hash), Some(print)) => hash.add(*time, *print),
                _ => hash = None,
            }
        }
        let until = self.disarmed_at.unwrap_or(self.last);
        End {
            t: self.last,
            result: verdict.result.to_string(),
            reason: verdict.reason,
            flown_s: self.armed_at.map_or(0.0, |armed| until.seconds_since(armed)),
            hash: hash.map(FlightPrint::text),
        }
    }
}

impl Recorder {
    /// Returns a recorder for a vehicle at boot. Without a setup, its flights are recorded as pictures; the error is the
    /// reason, the end of a sentence.
    pub fn new(setup: Result<Setup, String>) -> Self {
        let (setup, gap) = match setup {
            Ok(setup) => (Some(setup), None),
            Err(reason) => (None, Some(reason)),
        };
        let named = setup.as_ref().map(Setup::plan).map(|plan| (plan.name, plan.plan));
        Self {
            setup,
            named,
            history: Vec::new(),
            inputs: Writer::part(),
            count: 0,
            gap,
            flight: Flight::new(SimTime::ZERO, 0),
        }
    }

    /// Returns the same recorder for a vehicle that has flown before, with the inputs of that flight up to the first one
    /// that [`Self::input`] will get.
    pub fn after(mut self, flown_until: SimTime, inputs: &[(SimTime, VehicleCommand)]) -> Self {
        for (time, input) in inputs {
            self.inputs.input(*time, input);
        }
        self.count = inputs.len();
        self.history.extend(self.inputs.end_part());
        self.flight = Flight::new(flown_until, self.history.len());
        self
    }

    /// Notes the name of a plan that is uploaded.
    pub fn plan(&mut self, name: String, plan: FlightPlan) {
        self.named = Some((name, plan));
    }

    /// Records a command that the vehicle took before the tick at `time`.
    pub fn input(&mut self, time: SimTime, command: &VehicleCommand, sink: &mut dyn RecordingSink) {
        if begins_flight(command) && time > self.flight.begin {
            self.next_flight(time, sink);
        }
        self.inputs.input(time, command);
        self.flight.writer.input(time, command);
        self.count += 1;
        if self.count.is_multiple_of(INPUTS) {
            self.history.extend(self.inputs.flush());
        }
    }

    /// Notes that commands are missing from here on.
    pub fn lose_inputs(&mut self) {
        self.lack("more inputs came than could be recorded");
    }

    fn lack(&mut self, reason: &str) {
        if self.gap.is_none() {
            self.gap = Some(reason.to_owned());
            self.flight.writer.gap(reason);
        }
    }

    pub fn event(&mut self, event: RecordedEvent) {
        self.flight.writer.event(&event);
        if self.flight.events.len() < MAX_EVENTS {
            self.flight.events.push(event);
        }
    }

    /// Records a picture. With it, a flight begins or ends.
    pub fn picture(&mut self, seen: Seen, sink: &mut dyn RecordingSink) {
        let (time, is_armed) = (seen.snapshot.time, seen.snapshot.craft.is_armed());
        let begins = is_armed && !self.flight.is_begun;
        if begins {
            self.flight.plan = self.plan_name(&seen.snapshot);
        }
        let flight = &mut self.flight;
        flight.prints.push((time, seen.print));
        flight.writer.picture(seen);
        flight.last = time;
        if is_armed {
            flight.armed_at.get_or_insert(time);
            flight.disarmed_at = None;
        } else if flight.armed_at.is_some() {
            flight.disarmed_at.get_or_insert(time);
        }
        if begins {
            self.begin_recording(sink);
        } else if time.0 >= self.flight.flushed_at.0 + FLUSH_US || time < self.flight.flushed_at {
            self.flush(sink);
        }
        let flight = &self.flight;
        let is_over = flight.disarmed_at.is_some_and(|since| time.0 >= since.0 + AFTERMATH_US);
        let is_long = flight.bytes.len() > if flight.is_begun { MAX_FLIGHT } else { MAX_WAITING };
        if is_over && flight.is_begun || is_long {
            self.next_flight(time, sink);
        }
    }

    /// Notes that the flight continues from an earlier instant, with this many inputs since boot.
    pub fn branch(&mut self, at: SimTime, inputs: usize, sink: &mut dyn RecordingSink) {
        self.inputs.branch(at, inputs);
        if at < self.flight.begin {
            return self.next_flight(at, sink);
        }
        let flight = &mut self.flight;
        flight.writer.branch(at, inputs);
        flight.events.retain(|event| event.time <= at);
        flight.prints.retain(|(time, _)| *time <= at);
        flight.last = at;
        flight.disarmed_at = None;
        flight.armed_at = flight.armed_at.filter(|armed| *armed <= at);
        if flight.is_begun && flight.armed_at.is_none() {
            flight.is_begun = false;
            sink.discard();
        }
    }

    /// Writes what there is.
    pub fn flush(&mut self, sink: &mut dyn RecordingSink) {
        self.flight.flushed_at = self.flight.last;
        let bytes = self.flight.writer.flush();
        if self.flight.is_begun {
            sink.append(&bytes);
        }
        self.flight.bytes.extend(bytes);
    }

    /// Returns the recording of the flight so far.
    pub fn copy(&mut self, sink: &mut dyn RecordingSink) -> Vec<u8> {
        self.flush(sink);
        // The end is a member of its own, so the present one ends here.
        let closing = self.flight.writer.end_part();
        if self.flight.is_begun {
            sink.append(&closing);
        }
        self.flight.bytes.extend(closing);
        let plan = if self.flight.plan.is_empty() { self.named_plan() } else { self.flight.plan.clone() };
        let mut bytes = self.beginning(&sink.header(&plan));
        bytes.extend(Writer::part().finish(self.flight.end()));
        bytes
    }

    /// Ends the recording at the end of the session.
    pub fn finish(mut self, sink: &mut dyn RecordingSink) {
        self.end(sink);
    }

    fn named_plan(&self) -> String {
        self.named.as_ref().map_or_else(String::new, |(name, _)| name.clone())
    }

    /// Returns the name of the plan that the craft has stored.
    fn plan_name(&self, snapshot: &Snapshot) -> String {
        match (&snapshot.stored_plan, &self.named) {
            (Some(stored), Some((name, plan))) if stored == plan => name.clone(),
            (Some(stored), _) if !stored.waypoints.is_empty() => {
                format!("{} waypoints", stored.waypoints.len())
            }
            _ => "no plan".to_owned(),
        }
    }

    /// Returns the bytes of the present flight, from the first line on.
    fn beginning(&self, header: &Header) -> Vec<u8> {
        let mut bytes = Writer::new(header.clone()).flush();
        let mut start = Writer::part();
        if let Some(setup) = &self.setup {
            start.setup(setup);
        }
        if let Some(gap) = &self.gap {
            start.gap(gap.as_str());
        }
        bytes.extend(start.end_part());
        bytes.extend(self.history.get(..self.flight.history).unwrap_or_default());
        bytes.extend(&self.flight.bytes);
        bytes
    }

    /// Begins the recording of the present flight.
    fn begin_recording(&mut self, sink: &mut dyn RecordingSink) {
        self.flush(sink);
        self.flight.is_begun = true;
        let header = sink.header(&self.flight.plan);
        sink.begin(&header, &self.beginning(&header));
    }

    fn end(&mut self, sink: &mut dyn RecordingSink) {
        if self.flight.is_begun {
            let mut bytes = self.flight.writer.end_part();
            bytes.extend(Writer::part().finish(self.flight.end()));
            sink.end(&bytes);
        }
    }

    /// Ends the present flight, and begins another one at `begin`.
    fn next_flight(&mut self, begin: SimTime, sink: &mut dyn RecordingSink) {
        self.end(sink);
        self.history.extend(self.inputs.end_part());
        if self.history.len() > MAX_HISTORY {
            self.lack("more inputs came before it than are kept");
        }
        if self.gap.is_some() {
            self.history = Vec::new();
        }
        self.flight = Flight::new(begin, self.history.len());
    }
}
