mod hostile;
mod links;
mod reports;

use std::time::Duration;

use super::super::craft::*;
use super::super::frame::{Frame, Version};
use super::super::message::*;
use super::super::state::*;
use super::super::value::*;
use super::super::wire::{Series, Text};
use super::*;

/// A station with a craft that is played message by message.
struct Played {
    station: StationProtocol,
    now: Duration,
    version: Version,
    sequence: u8,
}

impl Played {
    fn new() -> Self {
        let station = StationProtocol::new(StationOptions::default());
        Self { station, now: Duration::from_secs(50), version: Version::V2, sequence: 0 }
    }

    /// Returns a station that is connected to a craft with this heartbeat.
    fn connected(heartbeat: Heartbeat) -> Self {
        let mut played = Self::new();
        played.hear(heartbeat);
        assert_eq!(played.events()[0], Event::Connected { system: 1, component: 1 });
        played
    }

    fn hear(&mut self, message: impl Into<Message>) {
        self.hear_from(1, message);
    }

    fn hear_from(&mut self, system: u8, message: impl Into<Message>) {
        self.sequence = self.sequence.wrapping_add(1);
        let (version, sequence, message) = (self.version, self.sequence, message.into());
        let frame = Frame { version, sequence, system, component: 1, message };
        self.station.receive(self.now, &frame.encode().unwrap());
    }

    /// Lets time pass with heartbeats of the craft. Returns what the station sends.
    fn pass(&mut self, time: Duration, heartbeat: Option<Heartbeat>) -> Vec<Message> {
        let end = self.now + time;
        let mut sent = self.sent();
        while self.now < end {
            self.now += Duration::from_millis(100);
            if let Some(heartbeat) = heartbeat {
                self.hear(heartbeat);
            }
            self.station.advance(self.now);
            sent.extend(self.sent());
        }
        sent
    }

    fn sent(&mut self) -> Vec<Message> {
        let message = |bytes: Vec<u8>| FrameReader::default().next_frame(&mut &bytes[..]).unwrap().message;
        std::iter::from_fn(|| self.station.poll_transmit()).map(message).collect()
    }

    fn events(&mut self) -> Vec<Event> {
        std::iter::from_fn(|| self.station.poll_event()).collect()
    }
}

fn heartbeat(autopilot: u8, system_type: u8, base_mode: u8, custom_mode: u32) -> Heartbeat {
    Heartbeat { custom_mode, r#type: system_type, autopilot, base_mode, system_status: 4, mavlink_version: 3 }
}

const ARDUCOPTER: (u8, u8, u8, u32) = (3, 2, 81, 5);

fn arducopter() -> Heartbeat {
    let (autopilot, system_type, base_mode, custom_mode) = ARDUCOPTER;
    heartbeat(autopilot, system_type, base_mode, custom_mode)
}

fn commands(messages: &[Message]) -> Vec<CommandLong> {
    let command =
        |message: &Message| if let Message::CommandLong(long) = message { Some(*long) } else { None };
    messages.iter().filter_map(command).collect()
}
