//! The client of a flight controller's serial port: exchanges MSP messages and command lines, one after the
//! other.
//!
//! ```text
//! ask() ─▶ queue ─▶ one exchange ─▶ take_output() ═══▶ flight controller
//!                        ▲                                   ║
//!                        └── push(bytes), poll(now) ◀════════╝        answers: next_answer()
//! ```
//!
//! Like every protocol here it gets the time from the caller, never waits and holds a bounded amount. Each
//! request gets exactly one answer, in the order of the requests. Any failure on the line (lost, damaged or
//! late answers, a command line that another client left open) costs only the request that it hit. After a
//! request was given up, the client first exchanges a message whose answer is certainly new; then it
//! continues with the queue.

mod ask;
mod exchange;
mod framed_line;
mod line_progress;
mod line_text;
mod message_line;
mod prompt_line;
mod request;

pub use ask::{Answer, Ask, AskId, CliAccess, Unanswered};
pub use line_text::printable as sent_line;

use std::collections::VecDeque;
use std::time::Duration;

use exchange::Exchange;
use framed_line::FramedLine;
use line_progress::LineProgress;
use message_line::{MessageLine, Page};
use prompt_line::PromptLine;
use request::{Request, Waiting};

use crate::msp::{Decoder, Frame, code};

/// The maximum number of requests that may wait. Further requests are refused.
const MAX_QUEUE: usize = 256;
/// Opens the framed command line.
const STX: u8 = 0x02;
/// Ends a command line that an earlier client left open. Releases that support the word do not restart.
const LEAVE_CLI: &[u8] = b"\nexit noreboot\n";
/// Leaves the prompt. Releases that do not support the word restart.
const LEAVE_PROMPT: &str = "exit noreboot";

#[derive(Debug, Clone)]
pub struct FcClient {
    connected: bool,
    access: CliAccess,
    /// `true` if the client may leave a command line that an earlier client left open. Some releases restart
    /// on that.
    may_leave_cli: bool,
    armed: bool,
    /// `true` while the prompt is open.
    in_prompt: bool,
    /// `Some(true)` if the firmware supports lines by message; `None` before the first.
    knows_messages: Option<bool>,
    /// `true` while every request so far was answered, so that the next answer belongs to the next request.
    in_step: bool,
    /// Detects that the flight controller echoes, which means that it takes requests for typing.
    echoes: Echo,
    queue: VecDeque<(AskId, Ask)>,
    exchange: Option<(Option<AskId>, Exchange)>,
    decoder: Decoder,
    output: Vec<u8>,
    answers: VecDeque<(AskId, Answer)>,
}

/// Detects requests that come back as typing does at a prompt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Echo {
    /// The newest bytes, oldest first.
    tail: [u8; 3],
    seen: bool,
    /// `true` once the prompt was left because of the echo.
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
    /// Begins a new connection that has carried nothing yet.
    pub fn connected(&mut self) {
        self.disconnected();
        self.connected = true;
        self.armed = false;
        self.knows_messages = None;
        self.echoes = Echo::default();
    }

    /// Ends the connection. A closed link answers a line that restarts the flight controller; all other
    /// requests fail.
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

    /// Sets the way in which lines reach the command line.
    pub fn set_cli(&mut self, access: CliAccess) {
        self.access = access;
    }

    /// Allows or forbids leaving a command line that an earlier client left open; some releases restart on
    /// that. While it is forbidden, such requests fail with [`Unanswered::InCli`].
    pub fn set_may_leave_cli(&mut self, may: bool) {
        self.may_leave_cli = may;
    }

    /// Sets the known arming state. The command line of an armed craft does not open.
    pub fn set_armed(&mut self, armed: bool) {
        self.armed = armed;
    }

    /// Returns `true` while the interactive command line is open, which suspends MSP.
    pub fn is_in_cli(&self) -> bool {
        self.in_prompt
    }

    /// Returns `true` if a new MSP message would be sent at once.
    pub fn is_idle(&self) -> bool {
        self.connected && self.exchange.is_none() && self.queue.is_empty() && !self.in_prompt
    }

    /// Queues a request. [`Self::poll`] sends it once all earlier requests are answered.
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
                // Makes the result independent of how the bytes are split.
                if self.exchange.is_none() {
                    self.poll(now);
                }
            }
            self.poll(now);
        }
    }

    /// Sends the requests that are due and gives up those that have waited too long.
    pub fn poll(&mut self, now: Duration) {
        loop {
            if let Some((_, exchange)) = &mut self.exchange {
                match exchange {
                    Exchange::Synchronise(request) | Exchange::Msp(request) => {
                        match request.poll(now, &mut self.output) {
                            Waiting::Patient => {}
                            // Garbage that looked like the start of a long frame may have swallowed the reply
                            // as its payload.
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

    /// Returns the time at which [`Self::poll`] must run even without bytes.
    pub fn due(&self) -> Option<Duration> {
        match &self.exchange {
            Some((_, exchange)) => Some(exchange.due()),
            None if self.queue.is_empty() => None,
            None => Some(Duration::ZERO),
        }
    }

    /// Takes the bytes to send.
    pub fn take_output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.output)
    }

    /// Takes the oldest answer.
    pub fn next_answer(&mut self) -> Option<(AskId, Answer)> {
        self.answers.pop_front()
    }

    fn answer(&mut self, id: Option<AskId>, answer: Answer) {
        if let Some(id) = id {
            self.answers.push_back((id, answer));
        }
    }

    /// Ends the current exchange.
    fn finish(&mut self, answer: Answer) {
        if let Some((id, _)) = self.exchange.take() {
            self.answer(id, answer);
        }
    }

    /// Marks that late answers may arrive from now on.
    fn lose_step(&mut self) {
        self.in_step = false;
        self.in_prompt = false;
        self.decoder = Decoder::client();
    }

    fn start_next(&mut self, now: Duration) {
        if !self.in_step && !self.in_prompt {
            // Every flight controller answers this message.
            let request = Request::send(code::API_VERSION, &[], now, &mut self.output);
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
            Ask::LeavePrompt if !self.in_prompt => Some(line_text::answer(String::new(), false)),
            Ask::LeavePrompt => self.start_prompt(id, LEAVE_PROMPT.to_owned(), now),
            Ask::Typed(line) => {
                let line = line_text::printable(&line);
                if self.armed && !self.in_prompt {
                    return self.fall_back(id, &line, now);
                }
                self.start_prompt(id, line, now)
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

    /// Runs a line by message. Returns the answer at once if that is impossible.
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

    /// Gives up the current message.
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
