//! The MSP server: takes the code and payload of a request, and returns the payload of the reply and an action.
//!
//! It has no side effects. It reads and writes the [`Configuration`] and gets the state of the running firmware from
//! [`MspFacts`]. Anything beyond both (storing, restarting, RC, motors) goes to the caller as an [`MspAction`]. The
//! link is responsible for the framing of requests and replies.
//!
//! ```text
//! code ── TABLE ──▶ handler ──▶ Outcome { reply, action, notice }
//!                     │ one of: a layout of settings, read or written field by field; or a function
//! ```
//!
//! A payload that is longer than expected is read as far as needed. If it is shorter, a setting without any byte keeps
//! its value, and everything else reads as zero.

mod commands;
mod craft;
mod flash;
mod gps;
mod identity;
mod layout;
mod modes;
mod multiple;
mod observation;
mod power;
mod receiver;
mod server;
mod setting;
mod simplified;
mod state;
mod table;
mod text;
mod tuning;

pub use flash::flash_reply;
pub use observation::{MspFacts, UtcTime};
pub use table::{MESSAGES, Message};

use super::config::Configuration;
use crate::geo::LatLon;
use crate::msp::{PaddedReader, Writer};
use crate::signals::{PerMotor, RcFrame};
use crate::telemetry::FirmwareNotice;

/// The answer to a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The payload of the reply; `None` if the request is unknown or refused.
    pub reply: Option<Vec<u8>>,
    /// The action for the owner of the firmware, after the reply is sent.
    pub action: Option<MspAction>,
    /// A notice for the user about the written value.
    pub notice: Option<FirmwareNotice>,
}

/// An action that a message requests from the owner of the firmware.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MspAction {
    /// Stores the configuration.
    Save,
    /// Restarts from the stored configuration and closes the links.
    Reboot,
    /// Stores the configuration that was just reset, restarts and closes the links.
    SaveAndReboot,
    /// An RC frame in the order of the receiver's wire. Channels that were not sent are 0.
    RawRc(RcFrame),
    /// A position for the GPS provider MSP.
    RawGps {
        /// `true` if it is a fix.
        fix: bool,
        /// The number of satellites.
        sats: u8,
        /// The position, degrees × 10⁷.
        position: LatLon,
        /// The altitude above mean sea level, m.
        alt_amsl_m: u16,
        /// The ground speed, cm/s.
        speed_cms: u16,
    },
    /// Reads the flash memory for logs. The owner writes the bytes, at most `length` from `address` on, behind the reply.
    ReadFlash {
        /// The first byte.
        address: u32,
        /// The most bytes of the reply.
        length: u16,
    },
    /// Erases the flash memory for logs.
    EraseFlash,
    /// Runs the motors of the disarmed craft at these outputs, µs.
    MotorTest(PerMotor<u16>),
    /// Calibrates the accelerometer.
    CalibrateAcc,
    /// Calibrates the magnetometer.
    CalibrateMag,
    /// Holds this heading, degrees.
    HoldHeading(i16),
    /// Sets the time of day.
    SetClock {
        /// The seconds since 1970, UTC.
        unix_s: u32,
        /// The milliseconds of the second.
        millis: u16,
    },
    /// Turns runaway take-off prevention on or off until the next restart.
    RunawayPrevention(bool),
}

/// A request that the server does not carry out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Refused;

/// One request in progress.
#[derive(Debug)]
struct Call<'a> {
    configuration: &'a mut Configuration,
    facts: &'a MspFacts,
    request: PaddedReader<'a>,
    reply: Writer,
    action: Option<MspAction>,
    notice: Option<FirmwareNotice>,
}

impl Call<'_> {
    /// Returns the number, word position or port of a setting of the active profile.
    fn setting(&self, name: &str) -> i64 {
        self.configuration.settings.number(name)
    }

    /// Sets a number of the active profile, limited to the setting's range.
    fn set(&mut self, name: &str, number: i64) {
        layout::put(&mut self.configuration.settings, name, number);
    }
}

#[doc(hidden)]
pub fn handle(code: u16, request: &[u8], configuration: &mut Configuration, facts: &MspFacts) -> Outcome {
    let refused = Outcome { reply: None, action: None, notice: None };
    let Some(message) = table::find(code) else { return refused };
    let mut call = Call {
        configuration,
        facts,
        request: PaddedReader::new(request),
        reply: Writer::default(),
        action: None,
        notice: None,
    };
    match message.handler.run(&mut call) {
        Ok(()) => Outcome { reply: Some(call.reply.into_bytes()), action: call.action, notice: call.notice },
        Err(Refused) => refused,
    }
}
