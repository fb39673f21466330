//! Everything that happens to the vehicle, with its time.

use std::net::SocketAddr;

use crate::signals::SimTime;
use crate::telemetry::FirmwareEvent;

/// An event and when it happened.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Simulated time since boot.
    pub time: SimTime,
    /// What happened.
    pub kind: EventKind,
}

/// What happened.
#[derive(Debug, Clone, PartialEq)]
pub enum EventKind {
    /// The vehicle was started.
    Boot {
        /// Seed of all randomness.
        seed: u64,
        /// Steps a second.
        rate_hz: u32,
        /// Name of the airframe.
        airframe: String,
        /// Whether outside doors can influence the flight, so that it is not repeatable.
        live: bool,
    },
    /// The flight controller.
    Firmware(FirmwareEvent),
    /// A fault began or ended.
    Fault {
        /// Its name.
        name: &'static str,
        /// Whether it began.
        on: bool,
        /// Its value as text.
        value: String,
    },
    /// The craft touched the ground.
    Contact {
        /// Sink rate, m/s.
        impact_mps: f64,
    },
    /// The craft came to rest on the ground.
    Touchdown {
        /// Sink rate at the contact, m/s.
        impact_mps: f64,
        /// Greatest specific force since the contact, m/s².
        peak_mps2: f64,
    },
    /// The craft crashed.
    Crash {
        /// What went wrong, as a sentence.
        cause: String,
    },
    /// The doors were opened.
    Doors(Box<DoorPlaces>),
    /// A notice for the user, as a sentence.
    Notice(String),
}

/// Where other programs reach the vehicle; `None` = that door is closed.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct DoorPlaces {
    /// The websocket of the Betaflight App.
    pub ws: Option<SocketAddr>,
    /// Command line and MSP over TCP.
    pub tcp: Option<SocketAddr>,
    /// States from an external simulator, UDP.
    pub fdm: Option<SocketAddr>,
    /// RC from scripts, UDP.
    pub rc: Option<SocketAddr>,
}
