//! One ground station, or several behind one address.

use std::collections::VecDeque;
use std::time::Duration;

use super::super::frame::{Frame, FrameReader, Version};
use super::super::message::{Message, Statustext};
use super::super::value::Severity;
use super::super::wire::Text;
use super::parameters::ListCursor;
use super::streams::Streams;

/// The number of frames that wait for a ground station above which telemetry is dropped.
const MAX_TELEMETRY: usize = 256;
/// The number of waiting frames above which nothing more is read from a ground station.
const MAX_UNREAD_REPLIES: usize = 512;
/// The number of frames that wait at most.
const MAX_FRAMES: usize = 1024;
/// The length of a text, bytes. A longer one is cut.
const MAX_TEXT: usize = 250;
/// The length of a part of a text, bytes.
const CHUNK: usize = 50;
/// A ground station whose life nobody reports is forgotten after this silence.
const SILENCE: Duration = Duration::from_secs(10);

/// The number that the host gives to an address or a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PeerId(pub u32);

/// How long a peer is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lifetime {
    /// Until 10 s of silence, as for an address of datagrams.
    UntilSilent,
    /// Until [`CraftProtocol::disconnect`](super::CraftProtocol::disconnect), as for a connection.
    UntilDisconnected,
}

/// A peer with everything that belongs to it.
#[derive(Debug, Clone)]
pub(super) struct Peer {
    pub(super) id: PeerId,
    pub(super) lifetime: Lifetime,
    /// The wall-clock time of the last bytes.
    pub(super) heard: Duration,
    pub(super) reader: FrameReader,
    /// The version of the last frame. Answers have it, too.
    pub(super) version: Version,
    pub(super) streams: Streams,
    /// The parameters that it still gets.
    pub(super) list: Option<ListCursor>,
    /// `true` if its missions have a home item before the first item.
    pub(super) has_home_item: bool,
    /// `true` if its heartbeat claims to be of the family of ArduPilot.
    pub(super) is_ardupilot_style: bool,
    /// Frames that were not read, because too many answers waited.
    pub(super) unread: u64,
    outbox: VecDeque<Vec<u8>>,
    sequence: u8,
    next_text: u16,
    sender: (u8, u8),
}

impl Peer {
    /// Returns a peer to which this system and component send.
    pub(super) fn new(id: PeerId, lifetime: Lifetime, now: Duration, sender: (u8, u8)) -> Self {
        Self {
            id,
            lifetime,
            heard: now,
            reader: FrameReader::default(),
            version: Version::V2,
            streams: Streams::default(),
            list: None,
            has_home_item: false,
            is_ardupilot_style: false,
            unread: 0,
            outbox: VecDeque::new(),
            sequence: 0,
            next_text: 1,
            sender,
        }
    }

    pub(super) fn is_silent(&self, now: Duration) -> bool {
        self.lifetime == Lifetime::UntilSilent && now.saturating_sub(self.heard) >= SILENCE
    }

    /// Returns `true` if the answers to a further frame have room.
    pub(super) fn has_room_for_answers(&self) -> bool {
        self.outbox.len() < MAX_UNREAD_REPLIES
    }

    /// Returns `true` if telemetry is not dropped.
    pub(super) fn has_room_for_telemetry(&self) -> bool {
        self.outbox.len() < MAX_TELEMETRY
    }

    /// Queues an answer.
    pub(super) fn send(&mut self, message: impl Into<Message>) {
        if self.outbox.len() >= MAX_FRAMES {
            return;
        }
        let ((system, component), message) = (self.sender, message.into());
        let frame = Frame { version: self.version, sequence: self.sequence, system, component, message };
        if let Some(bytes) = frame.encode() {
            self.sequence = self.sequence.wrapping_add(1);
            self.outbox.push_back(bytes);
        }
    }

    /// Queues a message that may be dropped.
    pub(super) fn send_telemetry(&mut self, message: impl Into<Message>) {
        if self.has_room_for_telemetry() {
            self.send(message);
        }
    }

    /// Queues a text, in chunks if it is long.
    pub(super) fn send_text(&mut self, severity: Severity, text: &str) {
        let bytes = &text.as_bytes()[..text.floor_char_boundary(MAX_TEXT)];
        let mut chunks: Vec<&[u8]> = bytes.chunks(CHUNK).collect();
        // A chunk without a zero byte is not the last one.
        if chunks.len() > 1 && bytes.len().is_multiple_of(CHUNK) {
            chunks.push(&[]);
        }
        let id = if chunks.len() > 1 { self.next_text } else { 0 };
        if id > 0 {
            self.next_text = self.next_text.checked_add(1).unwrap_or(1);
        }
        for (chunk_seq, chunk) in (0..).zip(chunks) {
            // Version 1 has no numbers of chunks.
            if self.has_room_for_answers() && (self.version == Version::V2 || !chunk.is_empty()) {
                let (severity, text) = (severity.code(), Text::from_bytes(chunk));
                self.send(Statustext { severity, text, id, chunk_seq });
            }
        }
    }

    /// Returns the next frame to send.
    pub(super) fn next_output(&mut self) -> Option<Vec<u8>> {
        self.outbox.pop_front()
    }
}
