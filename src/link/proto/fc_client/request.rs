//! One MSP message and its reply.

use std::time::Duration;

use crate::link::proto::msp::{Form, Frame, Kind};

/// How long the reply to a message that only asks is awaited, each time.
const READ_PATIENCE: Duration = Duration::from_secs(1);
/// How long the reply to any other message is awaited: a board that stores its settings is silent while it does.
const WRITE_PATIENCE: Duration = Duration::from_secs(4);
/// The highest code of version 1; 255 marks a tunnelled frame.
const LAST_V1: u16 = 254;
/// Messages without payload that do something: restart, disarming, calibrations, reset of settings, storing, binding.
const COMMANDS: [u16; 8] = [68, 99, 205, 206, 208, 219, 250, 0x3000];

/// A message that was sent.
#[derive(Debug)]
pub(super) struct Request {
    frame: Frame,
    /// When it was sent last.
    sent: Duration,
    patience: Duration,
    /// It may be sent once more: it only asks.
    repeats: bool,
}

/// What became of a request by some instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Waiting {
    /// Its reply may still come.
    Patient,
    /// It was sent again.
    Repeated,
    /// It is to be given up.
    Overdue,
}

impl Request {
    /// Sends a message in the form that its code needs.
    pub(super) fn send(code: u16, payload: &[u8], now: Duration, output: &mut Vec<u8>) -> Self {
        let only_asks = payload.is_empty() && !COMMANDS.contains(&code);
        let form = if code > LAST_V1 { Form::V2 } else { Form::V1 };
        let frame = Frame::request(form, code, payload);
        frame.encode(output);
        let patience = if only_asks { READ_PATIENCE } else { WRITE_PATIENCE };
        Self { frame, sent: now, patience, repeats: only_asks }
    }

    /// The same message with another payload.
    pub(super) fn send_next(&mut self, payload: Vec<u8>, now: Duration, output: &mut Vec<u8>) {
        self.frame.payload = payload;
        self.frame.encode(output);
        self.sent = now;
    }

    /// What a frame answers; `None` when it belongs to another message.
    pub(super) fn answer(&self, frame: Frame) -> Option<Option<Vec<u8>>> {
        if (frame.form, frame.code) != (self.frame.form, self.frame.code) {
            return None;
        }
        Some((frame.kind == Kind::Reply).then_some(frame.payload))
    }

    /// Sends it once more when the reply is late, if that does no harm.
    pub(super) fn poll(&mut self, now: Duration, output: &mut Vec<u8>) -> Waiting {
        if now < self.due() {
            Waiting::Patient
        } else if self.repeats {
            self.repeats = false;
            self.sent = now;
            self.frame.encode(output);
            Waiting::Repeated
        } else {
            Waiting::Overdue
        }
    }

    /// When the reply is late.
    pub(super) fn due(&self) -> Duration {
        self.sent + self.patience
    }
}
