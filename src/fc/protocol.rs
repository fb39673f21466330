//! The protocol with a remote flight controller: MSP and the command line, or MAVLink.

use std::time::Duration;

use super::mavlink_craft::MavlinkCraft;
use super::observer::Simulated;
use super::remote::{Event, Input};
use super::{Access, Provision, Remote, RemoteView};
use crate::geo::LocalFrame;
use crate::vehicle::RemoteController;

/// The protocol with a flight controller.
#[derive(Debug)]
pub enum Protocol {
    /// MSP and the command line of Betaflight.
    Msp(Box<Remote>),
    Mavlink(Box<MavlinkCraft>),
}

impl Protocol {
    /// Returns the protocol with a firmware like Betaflight.
    pub fn msp(&self) -> Option<&Remote> {
        match self {
            Self::Msp(remote) => Some(remote),
            Self::Mavlink(_) => None,
        }
    }

    /// Configures a firmware like Betaflight once it is identified, before it counts as ready.
    pub fn provision(&mut self, provision: Provision) {
        if let Self::Msp(remote) = self {
            remote.provision(provision);
        }
    }

    /// Takes an input.
    pub(super) fn handle(&mut self, input: Input<'_>, now: Duration) {
        match self {
            Self::Msp(remote) => remote.handle(input, now),
            Self::Mavlink(craft) => craft.handle(input, now),
        }
    }

    /// Sends the requests that are due, and gives up what has waited too long.
    pub(super) fn handle_timeout(&mut self, now: Duration) {
        match self {
            Self::Msp(remote) => remote.handle_timeout(now),
            Self::Mavlink(craft) => craft.handle_timeout(now),
        }
    }

    /// Returns the bytes to send.
    pub(super) fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        match self {
            Self::Msp(remote) => remote.poll_transmit(),
            Self::Mavlink(craft) => craft.poll_transmit(),
        }
    }

    /// Returns the oldest event.
    pub(super) fn poll_event(&mut self) -> Option<Event> {
        match self {
            Self::Msp(remote) => remote.poll_event(),
            Self::Mavlink(craft) => craft.poll_event(),
        }
    }

    /// Returns the time at which the next call is due even without an input, if one is.
    pub(super) fn timeout(&self) -> Option<Duration> {
        match self {
            Self::Msp(remote) => remote.timeout(),
            Self::Mavlink(craft) => Some(craft.timeout()),
        }
    }

    /// Permits changes over a connection.
    pub fn permit_changes(&mut self, connection: u32) {
        match self {
            Self::Msp(remote) => remote.permit_changes(connection),
            Self::Mavlink(craft) => craft.permit_changes(connection),
        }
    }

    /// Returns the view for the display.
    pub fn view(&self) -> RemoteView {
        match self {
            Self::Msp(remote) => remote.view(),
            Self::Mavlink(craft) => craft.view(),
        }
    }

    /// Returns the permitted access.
    pub fn access(&self) -> Access {
        match self {
            Self::Msp(remote) => remote.access(),
            Self::Mavlink(craft) => craft.access(),
        }
    }

    /// Returns the number of the current connection.
    pub fn connection(&self) -> u32 {
        match self {
            Self::Msp(remote) => remote.connection(),
            Self::Mavlink(craft) => craft.connection(),
        }
    }

    /// Returns the frame at the first known place of the craft.
    pub(super) fn first_fix(&mut self) -> Option<LocalFrame> {
        match self {
            Self::Msp(remote) => remote.observer().first_fix(),
            Self::Mavlink(craft) => craft.first_fix(),
        }
    }

    /// Delivers new telemetry and the events that it shows.
    pub(super) fn deliver(
        &mut self,
        mailbox: &mut RemoteController,
        frame: Option<&LocalFrame>,
        simulated: Option<Simulated>,
        now: Duration,
    ) {
        match self {
            Self::Msp(remote) => remote.deliver(mailbox, frame, simulated),
            Self::Mavlink(craft) => craft.deliver(mailbox, frame, now),
        }
    }
}
