//! A client's stream to a firmware: MSP of every version, the command line opened by `#` and between STX and
//! ETX, and garbage. [`PAUSE`] in the bytes marks a quiet moment.

use std::time::Duration;

use betadeck::firmware::cli::{CliMode, Interpreter, complete};
use betadeck::firmware::config::Configuration;
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::link::proto::command_line::{Completion, LineSource};
use betadeck::link::proto::serial_session::{SerialRequest, SerialSession};
use betadeck::msp::{Decoder, Dropped, Form, Frame, Kind, MAX_REPLY, MAX_REQUEST};

use super::craft;

/// The mark of a quiet moment. It is long enough for a `#` before it to mean the command line.
const PAUSE: &[u8] = &[0x1e, 0x1e];
/// The length of the quiet moment.
const QUIET: Duration = Duration::from_millis(150);
/// More bytes than garbage can still announce for a frame.
const MAX_REQUEST_FRAME: usize = MAX_REQUEST + 16;

/// Sends the bytes in one piece, byte by byte and in pieces. The answers are the same. Then sends a sensible
/// request.
pub fn run(data: &[u8]) {
    decoders(data);
    let whole = talk(data, usize::MAX);
    assert_eq!(talk(data, 1), whole, "byte by byte");
    let piece = data.first().map_or(7, |byte| usize::from(*byte) % 61 + 2);
    assert_eq!(talk(data, piece), whole, "in pieces of {piece}");
    craft::Checked::default().assert_sound(whole.configuration);
}

/// Everything that was requested and answered.
#[derive(Debug, PartialEq, Default)]
struct Talk {
    asks: Vec<SerialRequest>,
    output: Vec<u8>,
    dropped: Dropped,
    configuration: Configuration,
}

/// A client and the craft that it is connected to.
struct Client {
    session: SerialSession,
    firmware: Firmware,
    interpreter: Interpreter,
    talk: Talk,
    now: Duration,
    closed: bool,
}

fn talk(data: &[u8], piece: usize) -> Talk {
    let mut client = Client {
        session: SerialSession::default(),
        firmware: Firmware::new(Configuration::default(), FirmwareOptions::default()),
        interpreter: Interpreter::default(),
        talk: Talk::default(),
        now: Duration::ZERO,
        closed: false,
    };
    for burst in bursts(data) {
        for bytes in burst.chunks(piece.min(burst.len().max(1))) {
            client.send(bytes);
        }
        client.now += QUIET;
        client.send(&[]);
    }
    if !client.closed {
        client.assert_still_answers();
    }
    client.talk.dropped = client.session.dropped();
    craft::assert_flies(&mut client.firmware);
    client.talk.configuration = client.firmware.configuration().clone();
    client.talk
}

/// Returns the bytes between pauses.
fn bursts(data: &[u8]) -> Vec<&[u8]> {
    let mut bursts = Vec::new();
    let mut rest = data;
    while let Some(at) = rest.windows(PAUSE.len()).position(|window| window == PAUSE) {
        bursts.push(&rest[..at]);
        rest = &rest[at + PAUSE.len()..];
    }
    bursts.push(rest);
    bursts
}

impl Client {
    fn send(&mut self, bytes: &[u8]) {
        if self.closed {
            return;
        }
        self.session.push(bytes);
        while let Some(ask) = self.session.next(self.now) {
            self.answer(&ask);
            // Only the time to send depends on the pieces.
            if ask != SerialRequest::Flush {
                self.talk.asks.push(ask);
            }
            let output = self.session.take_output();
            assert!(output.len() <= craft::MAX_TEXT, "{} bytes at once", output.len());
            self.talk.output.extend(output);
            if self.closed {
                return;
            }
        }
        let output = self.session.take_output();
        self.talk.output.extend(output);
    }

    fn answer(&mut self, ask: &SerialRequest) {
        match ask {
            SerialRequest::Msp(frame) => {
                assert!(frame.payload.len() <= MAX_REQUEST && frame.kind == Kind::Request);
                let reply = self.firmware.run_msp(frame.code, &frame.payload, None).reply;
                self.session.reply(frame, reply);
            }
            SerialRequest::EnterCli { interactive } => {
                let admitted = !self.firmware.is_armed();
                if *interactive {
                    self.firmware.cli_opened();
                }
                self.session.admit(admitted, self.now);
                assert_eq!(self.session.is_in_cli(), admitted);
                self.interpreter =
                    Interpreter::new(if *interactive { CliMode::Interactive } else { CliMode::Framed });
            }
            SerialRequest::Line { line, source } => {
                let mut own = Interpreter::new(CliMode::Message);
                let interpreter =
                    if *source == LineSource::Message { &mut own } else { &mut self.interpreter };
                let reply = self.firmware.run_cli(interpreter, line);
                self.closed = self.session.answer(&reply.into());
            }
            SerialRequest::Complete { line } => {
                let found = complete(line);
                let tail = found.tail(line).to_owned();
                self.session.complete(Completion { tail, words: found.candidates });
            }
            SerialRequest::Restart => {
                self.firmware.restart_in_place();
                self.closed = true;
            }
            SerialRequest::LeftCli => self.firmware.cli_closed(),
            SerialRequest::Foreign => self.closed = true,
            SerialRequest::Ignored { .. } | SerialRequest::Flush => {}
        }
    }

    /// Asserts that after enough silence and filler bytes a request is answered, whatever came before.
    fn assert_still_answers(&mut self) {
        self.now += Duration::from_secs(3);
        // Ends a frame that garbage began, a batch of framed lines, and an interactive session that it
        // opened.
        self.send(&[b' '; MAX_REQUEST_FRAME]);
        if self.closed {
            // An incomplete character is no text.
            return;
        }
        self.send(b"\x03");
        if self.session.is_in_cli() {
            self.send(b"\rexit noreboot\r");
        }
        if self.closed {
            // The buffer still held an `exit`.
            return;
        }
        assert!(!self.session.is_in_cli());
        let asked = self.talk.asks.len();
        self.talk.output.clear();
        let mut request = Vec::new();
        Frame::request(Form::V2, 1, &[]).encode(&mut request);
        self.send(&request);
        assert_eq!(self.talk.asks.len(), asked + 1, "{:?}", &self.talk.asks[asked..]);
        let mut decoder = Decoder::client();
        let replies: Vec<Frame> = self.talk.output.iter().filter_map(|byte| decoder.push(*byte)).collect();
        assert!(matches!(&replies[..], [Frame { kind: Kind::Reply, code: 1, .. }]), "{replies:?}");
    }
}

/// Runs both sides' decoders on the bare bytes. Payloads are bounded, and each frame found is found again in
/// its own bytes.
fn decoders(data: &[u8]) {
    for (make, limit) in [(Decoder::server as fn() -> Decoder, MAX_REQUEST), (Decoder::client, MAX_REPLY)] {
        let mut decoder = make();
        for frame in data.iter().filter_map(|byte| decoder.push(*byte)) {
            assert!(frame.payload.len() <= limit);
            let mut again = make();
            let mut bytes = Vec::new();
            frame.encode(&mut bytes);
            let found: Vec<Frame> = bytes.iter().filter_map(|byte| again.push(*byte)).collect();
            assert_eq!(found, [frame]);
            assert!(again.is_between_frames() && again.dropped() == Dropped::default());
        }
    }
}
