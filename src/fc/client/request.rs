//! One MSP message and its reply.

use std::time::Duration;

use crate::msp::{Form, Frame, Kind, code};

/// The wait for the reply to a read-only message, for each attempt.
const READ_PATIENCE: Duration = Duration::from_secs(1);
/// The wait for the reply to any other message: a board is silent while it stores its settings.
const WRITE_PATIENCE: Duration = Duration::from_secs(4);
/// The highest code of version 1; 255 marks a tunnelled frame.
const LAST_V1: u16 = 254;
/// Messages without payload that have an effect.
const COMMANDS: [u16; 8] = [
    code::REBOOT,
    code::SET_ARMING_DISABLED,
    code::ACC_CALIBRATION,
    code::MAG_CALIBRATION,
    code::RESET_CONF,
    code::SET_RESET_CURR_PID,
    code::EEPROM_WRITE,
    code::BETAFLIGHT_BIND,
];

/// A message that was sent.
#[derive(Debug, Clone)]
pub(super) struct Request {
    frame: Frame,
    /// The time of the last transmission.
    sent: Duration,
    patience: Duration,
    /// `true` if it is read-only and may be sent once more.
    repeats: bool,
}

/// The state of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Waiting {
    /// Its reply may still come.
    Patient,
    /// It was sent again.
    Repeated,
    /// It must be given up.
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

    /// Sends the same message with another payload.
    pub(super) fn send_next(&mut self, payload: Vec<u8>, now: Duration, output: &mut Vec<u8>) {
        self.frame.payload = payload;
        self.frame.encode(output);
        self.sent = now;
    }

    /// Returns the reply in a frame; `None` if the frame belongs to another message.
    pub(super) fn answer(&self, frame: Frame) -> Option<Option<Vec<u8>>> {
        if (frame.form, frame.code) != (self.frame.form, self.frame.code) {
            return None;
        }
        Some((frame.kind == Kind::Reply).then_some(frame.payload))
    }

    /// Sends the message once more when the reply is overdue, if that does no harm.
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

    /// Returns the time at which the reply is overdue.
    pub(super) fn due(&self) -> Duration {
        self.sent + self.patience
    }
}
