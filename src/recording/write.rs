//! Writes a recording as bytes, bit by bit.

use std::io::Write as _;
use std::mem;

use flate2::write::GzEncoder;
use flate2::{Compression, GzBuilder};
use serde::Serialize as _;

use super::event::RecordedEvent;
use super::input::Input;
use super::number::Rounded;
use super::picture::{Scene, Seen, parts};
use super::record::{Begin, End, Header, Record};
use super::setup::Setup;
use super::summary::LAST_MEMBER;
use crate::signals::SimTime;
use crate::vehicle::VehicleCommand;

/// The text of a member from which the next one begins, bytes: a quarter of a minute of flight. The checksum of a member
/// tells whether it is damaged.
const MEMBER: usize = 128 << 10;

/// Makes the bytes of a recording, or of a part of one. Parts can be joined in the order in which they were written.
pub struct Writer {
    encoder: GzEncoder<Vec<u8>>,
    /// The text in the present member, bytes.
    text: usize,
    scene: Option<Scene>,
    line: Vec<u8>,
}

impl std::fmt::Debug for Writer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Writer").field("text", &self.text).finish_non_exhaustive()
    }
}

impl Default for Writer {
    fn default() -> Self {
        Self { encoder: member(None), text: 0, scene: None, line: Vec::new() }
    }
}

fn member(name: Option<&[u8]>) -> GzEncoder<Vec<u8>> {
    let builder = GzBuilder::new().operating_system(255);
    let builder = match name {
        Some(name) => builder.filename(name),
        None => builder,
    };
    // The level has a mark in the header of a member, unless it is the default.
    builder.write(Vec::new(), Compression::default())
}

impl Writer {
    /// Returns a writer for a part of a recording that is not the first.
    pub fn part() -> Self {
        Self::default()
    }

    /// Returns a writer that has written the first line.
    pub fn new(header: Header) -> Self {
        let mut writer = Self::default();
        writer.record(&Record::Flight(header));
        // A list of recordings reads only this member.
        writer.end_member();
        writer
    }

    /// Writes the start of the flight.
    pub fn setup(&mut self, setup: &Setup) {
        self.record(&Record::Setup(Box::new(setup.clone())));
    }

    /// Writes a command that the vehicle took before the tick at `time`.
    pub fn input(&mut self, time: SimTime, command: &VehicleCommand) {
        self.record(&Record::Input(time, Input::from(command)));
    }

    /// Writes the instant at which the flight begins that the recording is about.
    pub fn begin(&mut self, t: SimTime) {
        self.record(&Record::Begin(Begin { t }));
    }

    pub fn event(&mut self, event: &RecordedEvent) {
        self.record(&Record::Event(event.time, event.what.clone()));
    }

    /// Writes a picture.
    pub fn picture(&mut self, seen: Seen) {
        let (scene, shot) = parts(seen);
        if self.scene.as_ref() != Some(&scene) {
            self.rounded(&Record::Scene(Box::new(scene.clone())));
            self.scene = Some(scene);
        }
        self.rounded(&Record::Picture(Box::new(shot)));
    }

    /// Writes that the flight continues from the earlier instant `t`, with `inputs` commands since boot.
    pub fn branch(&mut self, t: SimTime, inputs: usize) {
        self.record(&Record::Branch { t, inputs });
    }

    /// Writes that commands are missing from here on, and the reason, the end of a sentence.
    pub fn gap(&mut self, reason: impl Into<String>) {
        self.record(&Record::Gap(reason.into()));
    }

    /// Writes the end, and returns the remaining bytes.
    pub fn finish(mut self, end: End) -> Vec<u8> {
        self.end_member();
        let mut bytes = self.take();
        self.encoder = member(Some(LAST_MEMBER));
        self.record(&Record::End(end));
        self.end_member();
        bytes.append(&mut self.take());
        bytes
    }

    /// Returns the bytes of all lines so far, without those returned before.
    pub fn flush(&mut self) -> Vec<u8> {
        if self.text >= MEMBER {
            self.end_member();
        } else if self.text > 0 {
            // Writing to memory cannot fail.
            let _infallible = self.encoder.flush();
        }
        self.take()
    }

    /// Ends the part: returns its bytes like [`Self::flush`], so that another part can follow.
    pub fn end_part(&mut self) -> Vec<u8> {
        self.end_member();
        self.scene = None;
        self.take()
    }

    fn take(&mut self) -> Vec<u8> {
        mem::take(self.encoder.get_mut())
    }

    /// Ends the present member, if it has lines, and begins another.
    fn end_member(&mut self) {
        if self.text == 0 {
            return;
        }
        let bytes = mem::replace(&mut self.encoder, member(None)).finish().unwrap_or_default();
        // The header of the next member follows once it has a line.
        let begun = mem::replace(self.encoder.get_mut(), bytes);
        debug_assert!(begun.is_empty(), "a member without a line has no bytes");
        self.text = 0;
    }

    fn record(&mut self, record: &Record) {
        self.line.clear();
        // Plain data with text keys always has a JSON form.
        if serde_json::to_writer(&mut self.line, record).is_ok() {
            self.end_line();
        }
    }

    /// Writes a line with the numbers of pictures.
    fn rounded(&mut self, record: &Record) {
        self.line.clear();
        if record.serialize(&mut serde_json::Serializer::with_formatter(&mut self.line, Rounded)).is_ok() {
            self.end_line();
        }
    }

    fn end_line(&mut self) {
        self.line.push(b'\n');
        let _infallible = self.encoder.write_all(&self.line);
        self.text += self.line.len();
    }
}
