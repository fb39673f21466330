//! Telemetry logs of ground stations (`.tlog`) as recorded flights.

use std::io::{self, Write as _};
use std::time::Duration;

use crate::blackbox::decode::LogSource as _;
use crate::fc::MavlinkCraft;
use crate::fc::remote::{Event, Input};
use crate::files::log_source::FileSource;
use crate::files::recording_file::header;
use crate::mavlink::message::Message;
use crate::mavlink::tlog::{LogReader, Record};
use crate::mavlink::value::MissionKind;
use crate::recording::{End, Happened, RecordedEvent, Seen, Writer};
use crate::signals::SimTime;
use crate::vehicle::Vehicle;

/// The time between two pictures.
const PICTURE: Duration = Duration::from_millis(100);
/// The longest silence of a log that is shown. After a longer one the craft is lost, and time jumps.
const SILENCE: Duration = Duration::from_secs(10);
/// The number of bytes that are read at once.
const CHUNK: usize = 64 * 1024;

/// Returns `true` if a log begins with these first bytes of a file.
pub(crate) fn is_log(mut head: &[u8]) -> bool {
    let mut reader = LogReader::default();
    reader.next_record(&mut head).is_some() && reader.skipped() == 0
}

/// Returns the flights of a log as one recording, in a file without a name.
///
/// # Errors
/// Fails if the log cannot be read or the file cannot be written.
pub(crate) fn recording(name: &str, log: &mut FileSource) -> io::Result<FileSource> {
    let mut flight = Flight::new(name).map_err(io::Error::other)?;
    let (mut reader, mut chunk, mut offset) = (LogReader::default(), vec![0; CHUNK], 0);
    loop {
        let length = log.read_at(offset, &mut chunk)?;
        offset += length as u64;
        let mut bytes = &chunk[..length];
        while let Some(record) = reader.next_record(&mut bytes) {
            flight.take(&record);
        }
        if length == 0 {
            break;
        }
    }
    while let Some(record) = reader.last_record() {
        flight.take(&record);
    }
    let bytes = flight.finish();
    let mut file = tempfile::tempfile()?;
    file.write_all(&bytes)?;
    Ok(FileSource::new(file, bytes.len() as u64))
}

/// A log that becomes a recording.
struct Flight {
    craft: MavlinkCraft,
    /// The vehicle whose mailbox the craft fills. Its own time is not used.
    vehicle: Vehicle,
    writer: Writer,
    /// The time of the first record, since 1970.
    began: Option<Duration>,
    /// The time of the next picture, since the first record.
    due: Duration,
}

impl Flight {
    fn new(name: &str) -> Result<Self, String> {
        let mut writer = Writer::new(header(name));
        writer.gap("a telemetry log has no inputs");
        writer.begin(SimTime::ZERO);
        Ok(Self {
            craft: MavlinkCraft::new(name.to_owned()),
            vehicle: Vehicle::elsewhere().map_err(|error| error.to_string())?,
            writer,
            began: None,
            due: Duration::ZERO,
        })
    }

    fn take(&mut self, record: &Record) {
        let began = *self.began.get_or_insert(record.time);
        // A clock may be set back.
        let now = record.time.saturating_sub(began);
        if now > self.due + SILENCE {
            self.picture();
            self.due = now;
        }
        while self.due <= now {
            self.picture();
        }
        // The mission is read with the ground station that asks for it here.
        if let Message::MissionRequestList(request) = record.frame.message
            && request.mission_type == MissionKind::Mission.code()
        {
            self.craft.read_mission(now);
        }
        if let Some(bytes) = record.frame.encode() {
            self.craft.handle(Input::Received(&bytes), now);
        }
    }

    /// Writes the state at the time of the next picture, and the events since the last one.
    fn picture(&mut self) {
        let time = SimTime(self.due.as_micros() as u64);
        self.craft.handle_timeout(self.due);
        // A log has no place for orders.
        while self.craft.poll_transmit().is_some() {}
        let mut event = |what| self.writer.event(&RecordedEvent { time, what });
        while let Some(happened) = self.craft.poll_event() {
            if let Event::Notice(notice) = happened {
                event(Happened::Notice(notice.to_string()));
            }
        }
        if let (Some(place), None) = (self.craft.first_fix(), self.vehicle.local_frame()) {
            self.vehicle.set_origin(place);
        }
        let frame = self.vehicle.local_frame().copied();
        if let Some(mailbox) = self.vehicle.remote_mut() {
            self.craft.deliver(mailbox, frame.as_ref(), self.due);
        }
        self.vehicle.tick();
        self.vehicle.drain_events(|happened| event(happened.kind.into()));
        let mut seen = Seen::of(&self.vehicle);
        seen.snapshot.time = time;
        self.writer.picture(seen);
        self.due += PICTURE;
    }

    fn finish(mut self) -> Vec<u8> {
        self.picture();
        let t = SimTime(self.due.as_micros() as u64);
        self.writer.finish(End {
            t,
            result: "recorded".to_owned(),
            reason: "a ground station recorded the telemetry".to_owned(),
            flown_s: t.seconds_since(SimTime::ZERO),
            hash: None,
        })
    }
}
