//! A flight controller at one end of a serial line and the client at the other, in one simulated time.

use std::time::Duration;

use betadeck::fc::client::{Answer, Ask, AskId, FcClient};
use betadeck::firmware::cli::{CliMode, Interpreter};
use betadeck::firmware::config::Configuration;
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::link::proto::command_line::LineSource;
use betadeck::link::proto::serial_session::{SerialRequest, SerialSession};

/// A tick of the simulated time.
const TICK: Duration = Duration::from_millis(10);
/// The longest time that an answer may take.
const LONGEST: Duration = Duration::from_secs(60);

/// The differences of the flight controller from a normal one.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Manners {
    /// STX and `#` are dropped, as while armed.
    pub(crate) cli_is_shut: bool,
    /// Only STX is dropped, as by old releases.
    pub(crate) no_framing: bool,
    /// `save` restarts and closes the link without ETX, as the real one does.
    pub(crate) save_restarts: bool,
    /// Lines by message are unknown.
    pub(crate) no_message_lines: bool,
}

/// The flight controller's end.
pub(crate) struct Board {
    pub(crate) firmware: Firmware,
    pub(crate) manners: Manners,
    /// The codes of the messages that it answered.
    pub(crate) asked: Vec<u16>,
    /// The lines that it ran.
    pub(crate) ran: Vec<String>,
    session: SerialSession,
    interpreter: Interpreter,
    closed: bool,
}

impl Board {
    fn new(manners: Manners) -> Self {
        Self {
            firmware: Firmware::new(Configuration::default(), FirmwareOptions::default()),
            manners,
            asked: Vec::new(),
            ran: Vec::new(),
            session: SerialSession::default(),
            interpreter: Interpreter::default(),
            closed: false,
        }
    }

    /// Returns the answer to these bytes.
    fn answer(&mut self, bytes: &[u8], now: Duration) -> Vec<u8> {
        let bytes: Vec<u8> =
            bytes.iter().copied().filter(|byte| !(self.manners.no_framing && *byte == 0x02)).collect();
        self.session.push(&bytes);
        while let Some(request) = self.session.next(now) {
            match request {
                SerialRequest::Msp(frame) => {
                    self.asked.push(frame.code);
                    let reply = self.firmware.run_msp(frame.code, &frame.payload, None).reply;
                    self.session.reply(&frame, reply);
                }
                SerialRequest::EnterCli { interactive } => {
                    let mode = if interactive || self.manners.save_restarts {
                        CliMode::Interactive
                    } else {
                        CliMode::Framed
                    };
                    self.interpreter = Interpreter::new(mode);
                    self.session.admit(!self.manners.cli_is_shut, now);
                }
                SerialRequest::Line { line, source } => {
                    if source == LineSource::Message {
                        self.asked.push(0x3012);
                        if self.manners.no_message_lines {
                            let error = [b'$', b'X', b'!', 0, 0x12, 0x30, 0, 0, 0];
                            let crc = crc::Crc::<u8>::new(&crc::CRC_8_DVB_S2).checksum(&error[3..8]);
                            return [&error[..8], &[crc]].concat();
                        }
                    }
                    let mut own = Interpreter::new(CliMode::Message);
                    let interpreter =
                        if source == LineSource::Message { &mut own } else { &mut self.interpreter };
                    let reply = self.firmware.run_cli(interpreter, &line);
                    self.ran.push(line);
                    self.closed |= self.session.answer(&reply.into());
                    if self.closed {
                        break;
                    }
                }
                SerialRequest::Restart => self.closed = true,
                SerialRequest::Complete { .. }
                | SerialRequest::Flush
                | SerialRequest::LeftCli
                | SerialRequest::Ignored { .. } => {}
                // The door closes the connection, and the client opens it again.
                SerialRequest::Foreign => self.session = SerialSession::default(),
            }
        }
        self.session.take_output()
    }
}

/// The client, the line and the board.
pub(crate) struct Bench {
    pub(crate) client: FcClient,
    pub(crate) board: Board,
    pub(crate) now: Duration,
    /// The damage of the line to the bytes that go to the client.
    pub(crate) damage: Box<dyn FnMut(Vec<u8>) -> Vec<u8>>,
    /// Every byte that was sent to the board.
    pub(crate) sent: Vec<u8>,
    next_id: u64,
}

impl Bench {
    pub(crate) fn new(manners: Manners) -> Self {
        let mut bench = Self {
            client: FcClient::default(),
            board: Board::new(manners),
            now: Duration::from_secs(100),
            damage: Box::new(|bytes| bytes),
            sent: Vec::new(),
            next_id: 0,
        };
        bench.client.connected();
        bench
    }

    /// Runs one tick. A closed link is opened again in the same tick.
    pub(crate) fn tick(&mut self) {
        self.now += TICK;
        self.client.poll(self.now);
        let output = self.client.take_output();
        self.sent.extend(&output);
        let answer = self.board.answer(&output, self.now);
        let answer = (self.damage)(answer);
        self.client.push(&answer, self.now);
        if std::mem::take(&mut self.board.closed) {
            self.client.disconnected();
            self.board.firmware.restart_in_place();
            self.board.session = SerialSession::default();
            self.client.connected();
        }
    }

    /// Sends a request and waits for the answer.
    pub(crate) fn ask(&mut self, ask: Ask) -> Answer {
        self.next_id += 1;
        let id = AskId(self.next_id);
        self.client.ask(id, ask);
        let end = self.now + LONGEST;
        while self.now < end {
            if let Some((of, answer)) = self.client.next_answer() {
                assert_eq!(of, id);
                return answer;
            }
            self.tick();
        }
        panic!("never answered");
    }

    pub(crate) fn msp(&mut self, code: u16) -> Option<Vec<u8>> {
        match self.ask(Ask::Msp { code, payload: Vec::new() }) {
            Answer::Msp(payload) => payload,
            other => panic!("{code}: {other:?}"),
        }
    }

    /// Runs a line that must succeed. Returns its output.
    pub(crate) fn line(&mut self, line: &str) -> String {
        match self.ask(Ask::Line(line.to_owned())) {
            Answer::Line { text, failed: false, restarted: false } => text,
            other => panic!("{line}: {other:?}"),
        }
    }
}
