//! The client of a flight controller's serial port: MSP messages and command lines, one after the other.
//!
//! ```text
//! ask() ─▶ queue ─▶ one exchange ─▶ take_output() ═══▶ flight controller
//!                        ▲                                   ║
//!                        └── push(bytes), poll(now) ◀════════╝        answers: next_answer()
//! ```
//!
//! Like every protocol here it is told the time, never waits and holds a bounded amount. Answers come in the order of the
//! requests, exactly one each. Whatever goes wrong on the line (lost, damaged or late answers, a command line that somebody
//! left open) costs the request that it hit: after one that was given up, a message whose answer is known to be the newest
//! is exchanged before anything else is asked.

mod ask;
mod exchange;
mod framed_line;
mod line_text;
mod message_line;
pub mod polling;
mod prompt_line;
mod request;
pub mod telemetry;

pub use ask::{Answer, Ask, AskId, CliAccess, Unanswered};
pub use line_text::printable as sent_line;

use std::collections::VecDeque;
use std::time::Duration;

use exchange::{Exchange, LineProgress};
use framed_line::FramedLine;
use message_line::{MessageLine, Page};
use prompt_line::PromptLine;
use request::{Request, Waiting};

use super::msp::{Decoder, Frame};

/// Most requests that wait; one more is not taken.
const MAX_QUEUE: usize = 256;
/// `API_VERSION`, which every flight controller answers.
const API_VERSION: u16 = 1;
/// Opens the framed command line.
const STX: u8 = 0x02;
/// Ends a command line that an earlier client left open; releases that know the word do not restart.
const LEAVE_CLI: &[u8] = b"\nexit noreboot\n";

#[derive(Debug)]
pub struct FcClient {
    connected: bool,
    access: CliAccess,
    /// A command line that an earlier client left open may be left, which restarts some releases.
    may_leave_cli: bool,
    armed: bool,
    /// The prompt is open.
    in_prompt: bool,
    /// Whether lines by message are known; `None` before the first.
    knows_messages: Option<bool>,
    /// Every request so far was answered, so that the next answer belongs to the next request.
    in_step: bool,
    /// The flight controller echoes: what is sent is taken for typing.
    echoes: Echo,
    queue: VecDeque<(AskId, Ask)>,
    exchange: Option<(Option<AskId>, Exchange)>,
    decoder: Decoder,
    output: Vec<u8>,
    answers: VecDeque<(AskId, Answer)>,
}

/// Whether requests come back as typing does at a prompt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Echo {
    /// The newest bytes, oldest first.
    tail: [u8; 3],
    seen: bool,
    /// The prompt was left because of it.
    answered: bool,
}

impl Echo {
    fn note(&mut self, byte: u8) {
        self.tail = [self.tail[1], self.tail[2], byte];
        self.seen |= matches!(&self.tail, b"$M<" | b"$X<");
    }
}

impl Default for FcClient {
    fn default() -> Self {
        Self {
            connected: false,
            access: CliAccess::default(),
            may_leave_cli: true,
            armed: false,
            in_prompt: false,
            knows_messages: None,
            in_step: false,
            echoes: Echo::default(),
            queue: VecDeque::new(),
            exchange: None,
            decoder: Decoder::client(),
            output: Vec::new(),
            answers: VecDeque::new(),
        }
    }
}

impl FcClient {
    /// There is a new connection, over which nothing was said yet.
    pub fn connected(&mut self) {
        self.disconnected();
        self.connected = true;
        self.armed = false;
        self.knows_messages = None;
        self.echoes = Echo::default();
    }

    /// The connection is gone. A line that restarts the flight controller is answered by that, all else is not answered.
    pub fn disconnected(&mut self) {
        if let Some((id, exchange)) = self.exchange.take() {
            let answer = exchange.when_link_closes().unwrap_or(Answer::NotAnswered(Unanswered::LinkLost));
            self.answer(id, answer);
        }
        while let Some((id, _)) = self.queue.pop_front() {
            self.answer(Some(id), Answer::NotAnswered(Unanswered::LinkLost));
        }
        self.connected = false;
        self.lose_step();
        self.output.clear();
    }

    /// How lines reach the command line from now on.
    pub fn set_cli(&mut self, access: CliAccess) {
        self.access = access;
    }

    /// Whether a command line that an earlier client left open may be left from now on; some releases restart on that. Where
    /// it may not, requests are answered by [`Unanswered::InCli`].
    pub fn set_may_leave_cli(&mut self, may: bool) {
        self.may_leave_cli = may;
    }

    /// Whether the craft is armed, as far as is known: then its command line does not open.
    pub fn set_armed(&mut self, armed: bool) {
        self.armed = armed;
    }

    /// Whether lines by MSP message work; `None` before the first was asked.
    pub fn knows_message_lines(&self) -> Option<bool> {
        self.knows_messages
    }

    /// Whether the interactive command line is open, in which MSP rests.
    pub fn is_in_cli(&self) -> bool {
        self.in_prompt
    }

    /// Whether an MSP message would be asked at once.
    pub fn is_idle(&self) -> bool {
        self.connected && self.exchange.is_none() && self.queue.is_empty() && !self.in_prompt
    }

    /// Asks; it is sent by the next [`Self::poll`] once everything before it is answered.
    pub fn ask(&mut self, id: AskId, ask: Ask) {
        if !self.connected {
            self.answer(Some(id), Answer::NotAnswered(Unanswered::LinkLost));
        } else if self.queue.len() >= MAX_QUEUE {
            self.answer(Some(id), Answer::NotAnswered(Unanswered::TooMany));
        } else {
            self.queue.push_back((id, ask));
        }
    }

    /// Takes bytes from the flight controller. `now` counts from any fixed instant.
    pub fn push(&mut self, bytes: &[u8], now: Duration) {
        if self.connected {
            for &byte in bytes {
                self.take(byte, now);
                // So that it does not matter where the bytes are cut.
                if self.exchange.is_none() {
                    self.poll(now);
                }
            }
            self.poll(now);
        }
    }

    /// Sends what is to be sent by now, and gives up what has waited for too long.
    pub fn poll(&mut self, now: Duration) {
        loop {
            if let Some((_, exchange)) = &mut self.exchange {
                match exchange {
                    Exchange::Synchronise(request) | Exchange::Msp(request) => {
                        match request.poll(now, &mut self.output) {
                            Waiting::Patient => {}
                            // Garbage that began like a long frame may have taken the reply for its payload.
                            Waiting::Repeated => self.decoder = Decoder::client(),
                            Waiting::Overdue => self.give_up(now),
                        }
                    }
                    Exchange::Message(line) => {
                        if line.is_overdue(now) {
                            self.give_up(now);
                        }
                    }
                    Exchange::Framed(line) => {
                        let progress = line.poll(now);
                        self.advance_line(progress, now);
                    }
                    Exchange::Prompt(line) => {
                        let progress = line.poll(now, &mut self.output);
                        self.advance_line(progress, now);
                    }
                }
            }
            if self.exchange.is_some() || self.queue.is_empty() {
                return;
            }
            self.start_next(now);
        }
    }

    /// When [`Self::poll`] has something to do even without bytes.
    pub fn due(&self) -> Option<Duration> {
        match &self.exchange {
            Some((_, exchange)) => Some(exchange.due()),
            None if self.queue.is_empty() => None,
            None => Some(Duration::ZERO),
        }
    }

    /// What is to be sent, taken away.
    pub fn take_output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.output)
    }

    /// The oldest answer that was not taken yet.
    pub fn next_answer(&mut self) -> Option<(AskId, Answer)> {
        self.answers.pop_front()
    }

    fn answer(&mut self, id: Option<AskId>, answer: Answer) {
        if let Some(id) = id {
            self.answers.push_back((id, answer));
        }
    }

    /// Ends the exchange that is under way.
    fn finish(&mut self, answer: Answer) {
        if let Some((id, _)) = self.exchange.take() {
            self.answer(id, answer);
        }
    }

    /// Late answers may come from now on.
    fn lose_step(&mut self) {
        self.in_step = false;
        self.in_prompt = false;
        self.decoder = Decoder::client();
    }

    fn start_next(&mut self, now: Duration) {
        if !self.in_step && !self.in_prompt {
            let request = Request::send(API_VERSION, &[], now, &mut self.output);
            self.exchange = Some((None, Exchange::Synchronise(request)));
            return;
        }
        let Some((id, ask)) = self.queue.pop_front() else { return };
        let answer = match ask {
            Ask::Msp { .. } | Ask::MessageLine(_) if self.in_prompt => {
                Some(Answer::NotAnswered(Unanswered::InCli))
            }
            Ask::Msp { code, payload } => {
                let request = Request::send(code, &payload, now, &mut self.output);
                self.exchange = Some((Some(id), Exchange::Msp(request)));
                None
            }
            Ask::Line(line) | Ask::MessageLine(line) if line_text::is_empty(&line) => {
                Some(line_text::answer(String::new(), false))
            }
            Ask::MessageLine(line) => self.start_message(id, &line_text::printable(&line), now),
            Ask::Line(line) => {
                let line = line_text::printable(&line);
                match self.access {
                    _ if self.in_prompt => self.start_prompt(id, line, now),
                    _ if self.armed => return self.fall_back(id, &line, now),
                    CliAccess::Interactive => self.start_prompt(id, line, now),
                    CliAccess::Framed => {
                        self.output.push(STX);
                        let framed = FramedLine::new(line, now);
                        self.exchange = Some((Some(id), Exchange::Framed(framed)));
                        None
                    }
                }
            }
        };
        if let Some(answer) = answer {
            self.answer(Some(id), answer);
        }
    }

    fn start_prompt(&mut self, id: AskId, line: String, now: Duration) -> Option<Answer> {
        let prompt = PromptLine::new(line, self.in_prompt, now, &mut self.output);
        self.exchange = Some((Some(id), Exchange::Prompt(prompt)));
        None
    }

    /// Runs a line by message; the answer at once when that cannot be.
    fn start_message(&mut self, id: AskId, line: &str, now: Duration) -> Option<Answer> {
        if self.knows_messages == Some(false) || !MessageLine::fits(line) {
            return Some(Answer::NotAnswered(Unanswered::CliClosed));
        }
        let message = MessageLine::send(line, now, &mut self.output);
        self.exchange = Some((Some(id), Exchange::Message(message)));
        None
    }

    /// Runs a line by message because the command line does not open.
    fn fall_back(&mut self, id: AskId, line: &str, now: Duration) {
        if let Some(answer) = self.start_message(id, line, now) {
            self.answer(Some(id), answer);
        }
    }

    fn take(&mut self, byte: u8, now: Duration) {
        match &mut self.exchange {
            Some((_, Exchange::Framed(line)))
                if line.is_open() || (byte == STX && self.decoder.is_between_frames()) =>
            {
                let progress = line.push(byte, now, &mut self.output);
                self.advance_line(progress, now);
                return;
            }
            Some((_, Exchange::Prompt(line))) => return line.push(byte, now),
            _ if self.in_prompt => return,
            _ => {}
        }
        self.echoes.note(byte);
        if let Some(frame) = self.decoder.push(byte) {
            self.take_frame(frame, now);
        }
    }

    fn take_frame(&mut self, frame: Frame, now: Duration) {
        match &mut self.exchange {
            Some((_, Exchange::Synchronise(request))) => {
                if request.answer(frame).is_some() {
                    self.in_step = true;
                    self.echoes = Echo::default();
                    self.exchange = None;
                }
            }
            Some((_, Exchange::Msp(request))) => {
                if let Some(payload) = request.answer(frame) {
                    self.finish(Answer::Msp(payload));
                }
            }
            Some((_, Exchange::Message(line))) => match line.answer(frame, now, &mut self.output) {
                Page::NotMine => {}
                Page::More => self.knows_messages = Some(true),
                Page::Last(answer) => {
                    self.knows_messages = Some(true);
                    self.finish(answer);
                }
                Page::Unknown => {
                    self.knows_messages = Some(false);
                    self.finish(Answer::NotAnswered(Unanswered::CliClosed));
                }
                Page::Lost => self.finish(Answer::NotAnswered(Unanswered::Silent)),
            },
            Some((_, Exchange::Framed(_) | Exchange::Prompt(_))) | None => {}
        }
    }

    fn advance_line(&mut self, progress: LineProgress, now: Duration) {
        match progress {
            LineProgress::Waiting => {}
            LineProgress::Answered { text, open } => {
                self.in_prompt = open;
                self.finish(line_text::answer(text, false));
            }
            LineProgress::Restarting { text } => {
                self.lose_step();
                self.finish(line_text::answer(text, true));
            }
            LineProgress::Silent => {
                self.lose_step();
                self.finish(Answer::NotAnswered(Unanswered::Silent));
            }
            LineProgress::NotOpened => {
                self.lose_step();
                let Some((Some(id), exchange)) = self.exchange.take() else { return };
                if let Some(line) = exchange.into_line() {
                    self.fall_back(id, &line, now);
                }
            }
        }
    }

    /// Gives up the message that was asked.
    fn give_up(&mut self, now: Duration) {
        self.lose_step();
        let Some((id, exchange)) = self.exchange.take() else { return };
        if !matches!(exchange, Exchange::Synchronise(_)) {
            self.answer(id, Answer::NotAnswered(Unanswered::Silent));
        } else if self.echoes.seen && !self.echoes.answered && self.may_leave_cli {
            self.echoes.answered = true;
            self.output.extend(LEAVE_CLI);
            self.start_next(now);
        } else if let Some((id, _)) = self.queue.pop_front() {
            let is_open = self.echoes.seen && !self.echoes.answered;
            let why = if is_open { Unanswered::InCli } else { Unanswered::Silent };
            self.answer(Some(id), Answer::NotAnswered(why));
        }
    }
}
