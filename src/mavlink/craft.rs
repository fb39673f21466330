//! The protocol of a craft: what it sends to ground stations, and what it answers.
//!
//! [`CraftProtocol::receive`] takes the bytes of a ground station, [`CraftProtocol::advance`] the state of the craft.
//! [`CraftProtocol::poll_transmit`] returns bytes to send. [`CraftProtocol::poll_request`] returns what the host must carry
//! out; [`CraftProtocol::answer`] takes the outcome.
//!
//! Memory is bounded: 16 peers, a queue of frames for each, 64 requests without an answer, one upload. Telemetry is dropped
//! while a peer does not take it. Answers are not: a peer with too many waiting answers is not read.

mod commands;
mod modes;
mod parameters;
mod peer;
mod rc;
mod receive;
mod request;
mod state;
mod streams;
mod telemetry;
mod transfer;

use std::collections::VecDeque;
use std::time::Duration;

pub use modes::{FlightMode, Identity};
pub use parameters::Parameter;
pub use peer::{Lifetime, PeerId};
pub use rc::{ChannelOverride, RcInput};
pub use request::{Answer, Request, RequestKind, Ticket};
pub use state::{CraftState, MissionProgress};

use super::frame::{ReaderCounts, Version};
use super::message::{self, ExtendedSysState, Heartbeat, MissionCurrent, MissionItemReached};
use super::mission::MissionItem;
use super::value::{CommandResult, MissionResult, Severity};
use parameters::Parameters;
use peer::Peer;
use request::{PendingRequests, Reply, Sender};
use telemetry::Source;
use transfer::{Finished, Upload};

/// The number of peers that are known at a time.
const MAX_PEERS: usize = 16;
/// The number of lines of an answer that are sent as texts.
const MAX_LINES: usize = 50;

/// The options of a craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CraftOptions {
    /// The autopilot that the craft claims to be.
    pub identity: Identity,
    /// The system of the craft.
    pub system: u8,
    /// The component of the autopilot.
    pub component: u8,
    /// The version of the firmware: major, minor, patch.
    pub version: [u8; 3],
    /// The number of items that a mission may have, without a home item.
    pub max_mission: u16,
    /// The number of items that the fences may have; 0 if the craft takes no fences.
    pub max_fence: u16,
    /// `true` if sticks and channels of ground stations are taken.
    pub takes_rc: bool,
    /// `true` if all commands, missions and parameters are denied.
    pub is_read_only: bool,
}

impl Default for CraftOptions {
    fn default() -> Self {
        Self {
            identity: Identity::Generic,
            system: 1,
            component: 1,
            version: [0; 3],
            max_mission: 30,
            max_fence: 0,
            takes_rc: false,
            is_read_only: false,
        }
    }
}

/// A peer, for displays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PeerView {
    /// The number that the host gave.
    pub id: PeerId,
    /// The version that it speaks.
    pub version: Version,
    /// The time of its last bytes.
    pub heard: Duration,
    /// Its frames.
    pub counts: ReaderCounts,
    /// Its frames that are missing.
    pub lost: u64,
    /// Its frames that were not read, because too many answers waited.
    pub unread: u64,
}

/// The protocol of a craft. Times are durations since instants that the host chooses: one for all wall-clock times, and the
/// boot of the craft for simulated times.
#[derive(Debug, Clone)]
pub struct CraftProtocol {
    options: CraftOptions,
    peers: Vec<Peer>,
    refused_peers: u64,
    /// The peer whose output is returned next.
    turn: usize,
    wall: Duration,
    sim: Duration,
    state: CraftState,
    pending: PendingRequests,
    requests: VecDeque<Request>,
    rc: Option<(PeerId, RcInput)>,
    parameters: Parameters,
    mission: Vec<MissionItem>,
    fence: Vec<MissionItem>,
    upload: Option<Upload>,
    finished: Option<Finished>,
}

impl CraftProtocol {
    /// Returns the protocol of a craft without peers.
    pub fn new(options: CraftOptions) -> Self {
        Self {
            options,
            peers: Vec::new(),
            refused_peers: 0,
            turn: 0,
            wall: Duration::ZERO,
            sim: Duration::ZERO,
            state: CraftState::default(),
            pending: PendingRequests::default(),
            requests: VecDeque::new(),
            rc: None,
            parameters: Parameters::default(),
            mission: Vec::new(),
            fence: Vec::new(),
            upload: None,
            finished: None,
        }
    }

    /// Makes a peer known before it sends anything. Returns `false` if there are too many peers.
    pub fn connect(&mut self, now: Duration, peer: PeerId, lifetime: Lifetime) -> bool {
        if let Some(known) = self.peer(peer) {
            known.lifetime = lifetime;
            return true;
        }
        if self.peers.len() >= MAX_PEERS {
            self.refused_peers += 1;
            return false;
        }
        let sender = (self.options.system, self.options.component);
        self.peers.push(Peer::new(peer, lifetime, now, sender));
        true
    }

    /// Forgets a peer, its requests and its transfer.
    pub fn disconnect(&mut self, peer: PeerId) {
        self.peers.retain(|known| known.id != peer);
        self.pending.forget(peer);
        self.upload.take_if(|upload| upload.from.peer == peer);
        self.finished.take_if(|finished| finished.from.peer == peer);
        self.requests.retain(|request| request.peer != peer);
        self.rc.take_if(|(sender, _)| *sender == peer);
    }

    /// Takes bytes of a peer. An unknown peer becomes known until it is silent, unless there are too many.
    pub fn receive(&mut self, now: Duration, peer: PeerId, bytes: &[u8]) {
        self.wall = now;
        if self.peer(peer).is_none() && !self.connect(now, peer, Lifetime::UntilSilent) {
            return;
        }
        let Some(known) = self.peer(peer) else { return };
        known.heard = now;
        let mut reader = std::mem::take(&mut known.reader);
        let mut rest = bytes;
        while let Some(frame) = reader.next_frame(&mut rest) {
            let Some(known) = self.peer(peer) else { return };
            if known.has_room_for_answers() {
                known.version = frame.version;
                self.handle(peer, &frame);
            } else {
                known.unread += 1;
            }
        }
        if let Some(known) = self.peer(peer) {
            known.reader = reader;
        }
    }

    /// Takes the time and the state of the craft, and queues everything that is due to all peers. Wants to be called at least
    /// 50 times a second. `now` is wall-clock time, `sim` the simulated time since boot.
    pub fn advance(&mut self, now: Duration, sim: Duration, state: &CraftState) {
        let urgent = [Heartbeat::ID, MissionCurrent::ID, ExtendedSysState::ID];
        let shown = |protocol: &Self| urgent.map(|id| protocol.source(false).message(id));
        let before = shown(self);
        (self.wall, self.sim, self.state) = (now, sim, *state);
        let after = shown(self);
        for ((id, before), after) in urgent.into_iter().zip(before).zip(after) {
            if before != after {
                self.peers.iter_mut().for_each(|peer| peer.streams.make_due(id));
            }
        }
        let silent: Vec<PeerId> =
            self.peers.iter().filter(|peer| peer.is_silent(now)).map(|peer| peer.id).collect();
        silent.into_iter().for_each(|peer| self.disconnect(peer));
        self.advance_upload();
        let mut peers = std::mem::take(&mut self.peers);
        for peer in &mut peers {
            if let Some(cursor) = peer.list.filter(|_| peer.has_room_for_telemetry()) {
                let (messages, list) = self.parameters.due(cursor, now);
                peer.list = list;
                messages.into_iter().for_each(|message| peer.send(message));
            }
            let source = self.source(self.has_home_item(peer));
            let due: Vec<u32> = peer.streams.due(now, sim).collect();
            due.into_iter()
                .filter_map(|id| source.message(id))
                .for_each(|message| peer.send_telemetry(message));
        }
        self.peers = peers;
    }

    /// Returns the next bytes to send, one frame, and their peer. All peers take turns.
    pub fn poll_transmit(&mut self) -> Option<(PeerId, Vec<u8>)> {
        for _ in 0..self.peers.len() {
            self.turn = (self.turn + 1) % self.peers.len();
            let peer = &mut self.peers[self.turn];
            if let Some(bytes) = peer.next_output() {
                return Some((peer.id, bytes));
            }
        }
        None
    }

    /// Returns the next request.
    pub fn poll_request(&mut self) -> Option<Request> {
        self.requests.pop_front()
    }

    /// Returns the newest sticks or channels since the last call. The host decides when they are too old.
    pub fn poll_rc(&mut self) -> Option<(PeerId, RcInput)> {
        self.rc.take()
    }

    /// Takes the outcome of a request, with lines that its sender gets as texts: reasons of a refusal, or the differences
    /// between the plan of the sender and the plan of the craft. A ticket that is no longer known is ignored.
    pub fn answer(&mut self, ticket: Ticket, answer: Answer, lines: &[String]) {
        let Some(pending) = self.pending.take(ticket) else { return };
        let (from, is_accepted) = (pending.from, answer.command() == CommandResult::Accepted);
        match pending.reply {
            Reply::Command(command, _) => {
                self.acknowledge(from, command, answer.command());
                self.make_due(MissionCurrent::ID);
            }
            Reply::Mission(kind) => self.finish(from, kind, answer.mission()),
            Reply::Current if is_accepted => self.make_due(MissionCurrent::ID),
            Reply::Current => self.end_transfer(from, 0, MissionResult::Error),
            Reply::Parameter(index) => {
                let is_new = match answer {
                    Answer::Parameter(value) => self.parameters.set(index, value),
                    Answer::Command(_) | Answer::Mission(_) => false,
                };
                let sender = (!is_new).then_some(from.peer);
                self.send_parameter(index, sender);
            }
            Reply::Silence => {}
        }
        let severity = if is_accepted { Severity::Notice } else { Severity::Warning };
        if let Some(peer) = self.peer(from.peer) {
            lines.iter().take(MAX_LINES).for_each(|line| peer.send_text(severity, line));
        }
    }

    /// Sends a text to all peers: at most 250 bytes, the rest is cut.
    pub fn status_text(&mut self, severity: Severity, text: &str) {
        self.peers.iter_mut().for_each(|peer| peer.send_text(severity, text));
    }

    /// Reports to all peers that a mission item was reached. Items count from 0, without a home item.
    pub fn item_reached(&mut self, item: u16) {
        let mut peers = std::mem::take(&mut self.peers);
        for peer in &mut peers {
            let seq = item.saturating_add(u16::from(self.has_home_item(peer)));
            peer.send_telemetry(MissionItemReached { seq });
        }
        self.peers = peers;
    }

    /// Sets the mission that ground stations download, without a home item.
    pub fn set_mission(&mut self, items: Vec<MissionItem>) {
        self.mission = items;
        self.make_due(MissionCurrent::ID);
    }

    /// Sets the fences that ground stations download.
    pub fn set_fence(&mut self, items: Vec<MissionItem>) {
        self.fence = items;
    }

    /// Sets the table of parameters. If only values differ from the table before, all peers get them.
    pub fn set_parameters(&mut self, table: &[Parameter]) {
        let old = std::mem::replace(&mut self.parameters, Parameters::new(table));
        for index in self.parameters.changes_since(&old) {
            self.send_parameter(index, None);
        }
    }

    /// Returns the peers.
    pub fn peers(&self) -> impl Iterator<Item = PeerView> {
        self.peers.iter().map(|peer| PeerView {
            id: peer.id,
            version: peer.version,
            heard: peer.heard,
            counts: peer.reader.counts(),
            lost: peer.reader.losses().values().map(|loss| loss.lost).sum(),
            unread: peer.unread,
        })
    }

    /// Returns the number of times that a peer was refused because there are too many.
    pub fn refused_peers(&self) -> u64 {
        self.refused_peers
    }

    fn peer(&mut self, id: PeerId) -> Option<&mut Peer> {
        self.peers.iter_mut().find(|peer| peer.id == id)
    }

    fn has_home_item(&self, peer: &Peer) -> bool {
        self.options.identity == Identity::Ardupilot || peer.has_home_item
    }

    fn source(&self, has_home_item: bool) -> Source<'_> {
        Source {
            identity: self.options.identity,
            state: &self.state,
            sim: self.sim,
            mission_length: self.mission.len(),
            has_home_item,
        }
    }

    fn send(&mut self, to: PeerId, message: impl Into<message::Message>) {
        if let Some(peer) = self.peer(to) {
            peer.send(message);
        }
    }

    fn make_due(&mut self, id: u32) {
        self.peers.iter_mut().for_each(|peer| peer.streams.make_due(id));
    }

    /// Sends a parameter to one peer, or to all.
    fn send_parameter(&mut self, index: usize, to: Option<PeerId>) {
        let Some(message) = self.parameters.message(index) else { return };
        for peer in self.peers.iter_mut().filter(|peer| to.is_none_or(|to| to == peer.id)) {
            peer.send(message);
        }
    }

    /// Passes a request to the host. Returns `false` if too many requests wait.
    fn ask(&mut self, from: Sender, reply: Reply, kind: RequestKind) -> bool {
        let ticket = self.pending.add(from, reply);
        self.requests.extend(ticket.map(|ticket| Request { ticket, peer: from.peer, kind }));
        ticket.is_some()
    }
}

#[cfg(test)]
mod tests;
