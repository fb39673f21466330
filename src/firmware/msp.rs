//! The MSP server: a request's code and payload in, the reply's payload and things to do out.
//!
//! Pure: it reads and writes the [`Configuration`], is told about the running firmware by [`MspFacts`], and leaves
//! what reaches beyond both (storing, restarting, RC, motors) to the caller as an [`MspAction`]. How requests and
//! replies are framed on a link is the link's business.
//!
//! ```text
//! code ── TABLE ──▶ handler ──▶ Outcome { reply, action, notice }
//!                     │ one of: a layout of settings, read or written field by field; or a function
//! ```
//!
//! A payload that is longer than expected is read as far as needed. Where it is shorter, a setting of which no byte
//! came keeps its value, and anything else reads as zero.

mod commands;
mod craft;
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
mod wire;

pub use observation::{BatteryReading, BatteryState, GpsReading, HomeReading, MspFacts, UtcTime};
pub use table::{Access, MESSAGES, Message};

use super::config::Configuration;
use crate::geo::LatLon;
use crate::signals::RcFrame;
use crate::telemetry::FirmwareNotice;
use wire::{Reader, Writer};

/// The answer to a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Payload of the reply; `None` when the request is unknown or refused.
    pub reply: Option<Vec<u8>>,
    /// What the owner of the firmware has to do, after the reply is out.
    pub action: Option<MspAction>,
    /// Something the user should know about the value that was written.
    pub notice: Option<FirmwareNotice>,
}

/// Something a message asks the owner of the firmware to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MspAction {
    Save,
    /// Restart from the stored configuration and close the links.
    Reboot,
    /// The configuration was reset: store it, restart, close the links.
    SaveAndReboot,
    /// An RC frame in the order of the receiver's wire; channels that were not sent are 0.
    RawRc(RcFrame),
    /// A position for the GPS provider MSP.
    RawGps {
        /// Whether it is a fix.
        fix: bool,
        sats: u8,
        position: LatLon,
        /// Altitude above mean sea level, m.
        alt_amsl_m: u16,
        /// Ground speed, cm/s.
        speed_cms: u16,
    },
    /// Run the motors of the disarmed craft at these outputs, µs.
    MotorTest([u16; 4]),
    CalibrateAcc,
    CalibrateMag,
    /// Hold this heading, degrees.
    HoldHeading(i16),
    /// The time of day.
    SetClock {
        /// Seconds since 1970, UTC.
        unix_s: u32,
        /// Milliseconds of the second.
        millis: u16,
    },
    /// Turn runaway take-off prevention on or off until the next restart.
    RunawayPrevention(bool),
}

/// A request that the server does not carry out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Refused;

/// One request being answered.
#[derive(Debug)]
struct Call<'a> {
    configuration: &'a mut Configuration,
    facts: &'a MspFacts,
    request: Reader<'a>,
    reply: Writer,
    action: Option<MspAction>,
    notice: Option<FirmwareNotice>,
}

impl Call<'_> {
    /// The number, word position or port of a setting of the active profile.
    fn setting(&self, name: &str) -> i64 {
        self.configuration.settings.number(name)
    }

    /// Sets a number of the active profile, brought into the setting's range.
    fn set(&mut self, name: &str, number: i64) {
        layout::put(&mut self.configuration.settings, name, number);
    }
}

pub fn handle(code: u16, request: &[u8], configuration: &mut Configuration, facts: &MspFacts) -> Outcome {
    let refused = Outcome { reply: None, action: None, notice: None };
    let Some(message) = table::find(code) else { return refused };
    let mut call = Call {
        configuration,
        facts,
        request: Reader::new(request),
        reply: Writer::default(),
        action: None,
        notice: None,
    };
    match message.handler.run(&mut call) {
        Ok(()) => Outcome { reply: Some(call.reply.into_bytes()), action: call.action, notice: call.notice },
        Err(Refused) => refused,
    }
}
