//! Missions and fences of a craft: uploads, downloads and deletions.

use std::time::Duration;

use super::super::message::{Message, MissionAck, MissionCount, MissionRequest, MissionRequestInt};
use super::super::mission::{Address, MissionItem};
use super::super::value::{MissionKind, MissionResult, Severity, command, position_frame};
use super::request::{Reply, RequestKind, Sender};
use super::telemetry::wire_position;
use super::{CraftProtocol, Identity, PeerId, Version};

/// The time after which an item is asked for again.
const PATIENCE: Duration = Duration::from_millis(1500);
/// The number of times that an item is asked for again.
const MAX_RETRIES: u8 = 5;

/// The number of repeated requests after which the old request is tried.
const OLD_AFTER: u8 = 2;

/// An upload in progress.
#[derive(Debug, Clone)]
pub(super) struct Upload {
    pub(super) from: Sender,
    kind: MissionKind,
    count: u16,
    items: Vec<MissionItem>,
    /// The wall-clock time of the last request for an item.
    asked: Duration,
    retries: u8,
    /// `true` if items are asked for by the old request.
    is_old: bool,
    /// `true` if an item of the new form has arrived.
    has_int: bool,
}

/// The last upload that ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct Finished {
    pub(super) from: Sender,
    kind: MissionKind,
    /// The number of the last item.
    last: u16,
    /// The result; `None` until the host has decided.
    result: Option<MissionResult>,
}

impl CraftProtocol {
    /// Handles a message of the mission protocol. Other messages are ignored.
    pub(super) fn mission_message(&mut self, from: Sender, message: &Message) {
        match *message {
            Message::MissionRequestList(list)
                if self.is_for_us(list.target_system, list.target_component) =>
            {
                self.send_count(from, list.mission_type);
            }
            Message::MissionRequestInt(asked)
                if self.is_for_us(asked.target_system, asked.target_component) =>
            {
                self.send_item(from, asked.mission_type, asked.seq, true);
            }
            Message::MissionRequest(asked) if self.is_for_us(asked.target_system, asked.target_component) => {
                self.send_item(from, asked.mission_type, asked.seq, false);
            }
            Message::MissionCount(count) if self.is_for_us(count.target_system, count.target_component) => {
                self.begin_upload(from, count.mission_type, count.count);
            }
            Message::MissionItemInt(item) if self.is_for_us(item.target_system, item.target_component) => {
                self.take_item(from, item.mission_type, item.seq, Ok(MissionItem::from_int(&item)), true);
            }
            Message::MissionItemFloat(item) if self.is_for_us(item.target_system, item.target_component) => {
                self.take_item(from, item.mission_type, item.seq, MissionItem::from_float(&item), false);
            }
            Message::MissionClearAll(clear)
                if self.is_for_us(clear.target_system, clear.target_component) =>
            {
                self.clear(from, clear.mission_type);
            }
            Message::MissionSetCurrent(set) if self.is_for_us(set.target_system, set.target_component) => {
                self.set_current(from, set.seq);
            }
            Message::MissionAck(ack) => self.take_end(from, ack.r#type),
            Message::MissionRequestPartialList(part)
                if self.is_for_us(part.target_system, part.target_component) =>
            {
                self.end_transfer(from, part.mission_type, MissionResult::Unsupported);
            }
            Message::MissionWritePartialList(part)
                if self.is_for_us(part.target_system, part.target_component) =>
            {
                self.end_transfer(from, part.mission_type, MissionResult::Unsupported);
            }
            _ => {}
        }
    }

    /// Asks for a missing item again, and gives up an upload that does not go on.
    pub(super) fn advance_upload(&mut self) {
        let now = self.wall;
        let Some(upload) = &mut self.upload else { return };
        if now.saturating_sub(upload.asked) < PATIENCE {
            return;
        }
        upload.asked = now;
        if upload.retries < MAX_RETRIES {
            upload.retries += 1;
            // An old ground station knows only the old request.
            upload.is_old |= upload.retries >= OLD_AFTER && !upload.has_int;
            self.request_item();
        } else if let Some(upload) = self.upload.take() {
            self.end_transfer(upload.from, upload.kind.code(), MissionResult::Cancelled);
        }
    }

    /// Takes the decision of the host about a mission or fences.
    pub(super) fn finish(&mut self, to: Sender, kind: MissionKind, result: MissionResult) {
        if let Some(finished) = self.finished.as_mut().filter(|finished| finished.from == to) {
            finished.result = Some(result);
        }
        self.end_transfer(to, kind.code(), result);
    }

    pub(super) fn end_transfer(&mut self, to: Sender, kind: u8, result: MissionResult) {
        let (target_system, target_component) = (to.system, to.component);
        let end = MissionAck {
            target_system,
            target_component,
            r#type: result.code(),
            mission_type: kind,
            opaque_id: 0,
        };
        self.send(to.peer, end);
    }

    /// Returns the mission item that a peer means by a number.
    pub(super) fn item_of(&self, peer: PeerId, seq: u16) -> Option<u16> {
        let item = seq.saturating_sub(self.home_items(peer) as u16);
        (usize::from(item) < self.mission.len()).then_some(item)
    }

    /// Returns the number of home items in the missions of a peer: 1 or 0.
    fn home_items(&self, peer: PeerId) -> usize {
        let has_one = self.peers.iter().any(|known| known.id == peer && self.has_home_item(known));
        usize::from(has_one)
    }

    /// Returns the item that a peer gets for a number.
    fn item(&self, peer: PeerId, kind: MissionKind, seq: u16) -> Option<MissionItem> {
        let seq = usize::from(seq);
        match kind {
            MissionKind::Mission => match seq.checked_sub(self.home_items(peer)) {
                None => Some(self.home_item()),
                Some(at) => self.mission.get(at).copied(),
            },
            MissionKind::Fence => self.fence.get(seq).copied(),
            MissionKind::Rally | MissionKind::All => None,
        }
    }

    fn home_item(&self) -> MissionItem {
        let home = self.state.home.unwrap_or_default();
        let (x, y, _) = wire_position(&home);
        MissionItem {
            frame: position_frame::GLOBAL,
            command: command::NAV_WAYPOINT,
            x,
            y,
            z: home.alt_amsl as f32,
            autocontinue: true,
            ..MissionItem::default()
        }
    }

    fn send_count(&mut self, to: Sender, kind: u8) {
        let count = match MissionKind::from_code(kind) {
            Some(MissionKind::Mission) if self.mission.is_empty() => 0,
            Some(MissionKind::Mission) => self.mission.len() + self.home_items(to.peer),
            Some(MissionKind::Fence) => self.fence.len(),
            Some(MissionKind::Rally) => 0,
            Some(MissionKind::All) | None => {
                return self.end_transfer(to, kind, MissionResult::Unsupported);
            }
        };
        let (target_system, target_component) = (to.system, to.component);
        let count = u16::try_from(count).unwrap_or(u16::MAX);
        self.send(
            to.peer,
            MissionCount { count, target_system, target_component, mission_type: kind, opaque_id: 0 },
        );
    }

    /// Sends an item in the form in which it was asked for.
    fn send_item(&mut self, to: Sender, kind: u8, seq: u16, is_int: bool) {
        let item = MissionKind::from_code(kind).and_then(|kind| self.item(to.peer, kind, seq));
        let address = Address { system: to.system, component: to.component, kind, seq };
        match item {
            None => self.end_transfer(to, kind, MissionResult::InvalidSequence),
            Some(item) if is_int => self.send(to.peer, item.to_int(address)),
            Some(item) => self.send(to.peer, item.to_float(address)),
        }
    }

    /// Returns the greatest number of items of an upload.
    fn limit(&self, kind: Option<MissionKind>) -> Result<(MissionKind, u16), MissionResult> {
        match kind {
            _ if self.options.is_read_only => Err(MissionResult::Denied),
            // The home item comes in addition.
            Some(MissionKind::Mission) => {
                Ok((MissionKind::Mission, self.options.max_mission.saturating_add(1)))
            }
            Some(MissionKind::Fence) => Ok((MissionKind::Fence, self.options.max_fence)),
            Some(MissionKind::Rally) => Ok((MissionKind::Rally, 0)),
            Some(MissionKind::All) | None => Err(MissionResult::Unsupported),
        }
    }

    fn begin_upload(&mut self, from: Sender, code: u8, count: u16) {
        if self.upload.as_ref().is_some_and(|upload| upload.from != from) {
            // One transfer at a time: the other sender has to try again.
            return;
        }
        self.upload = None;
        let (kind, limit) = match self.limit(MissionKind::from_code(code)) {
            Ok(limit) => limit,
            Err(result) => return self.end_transfer(from, code, result),
        };
        if count > limit {
            let result = if limit == 0 { MissionResult::Unsupported } else { MissionResult::NoSpace };
            return self.end_transfer(from, code, result);
        }
        let is_old = self.peers.iter().any(|peer| peer.id == from.peer && peer.version == Version::V1);
        let upload = Upload {
            from,
            kind,
            count,
            items: Vec::new(),
            asked: self.wall,
            retries: 0,
            is_old,
            has_int: false,
        };
        if count == 0 {
            return self.decide(upload);
        }
        self.upload = Some(upload);
        self.request_item();
    }

    fn request_item(&mut self) {
        let Some(upload) = &self.upload else { return };
        let (to, seq, mission_type) = (upload.from, upload.items.len() as u16, upload.kind.code());
        let (target_system, target_component) = (to.system, to.component);
        let request: Message = if upload.is_old {
            MissionRequest { seq, target_system, target_component, mission_type }.into()
        } else {
            MissionRequestInt { seq, target_system, target_component, mission_type }.into()
        };
        self.send(to.peer, request);
    }

    /// Takes the end of a transfer by the ground station: a cancelled upload.
    fn take_end(&mut self, from: Sender, result: u8) {
        let Some(upload) = self.upload.as_mut().filter(|upload| upload.from == from) else { return };
        if upload.is_old && result == MissionResult::Unsupported.code() {
            // MAVSDK refuses the old request so.
            upload.is_old = false;
            upload.has_int = true;
            self.request_item();
        } else if result != MissionResult::Accepted.code() {
            self.upload = None;
        }
    }

    fn take_item(
        &mut self,
        from: Sender,
        code: u8,
        seq: u16,
        item: Result<MissionItem, MissionResult>,
        is_int: bool,
    ) {
        let is_meant = |upload: &&mut Upload| {
            upload.from == from && upload.kind.code() == code && usize::from(seq) == upload.items.len()
        };
        let now = self.wall;
        let Some(upload) = self.upload.as_mut().filter(is_meant) else {
            // The last item again: the end of the transfer was lost.
            let finished =
                self.finished.filter(|end| end.from == from && end.kind.code() == code && end.last == seq);
            if let Some(result) = finished.and_then(|finished| finished.result) {
                self.end_transfer(from, code, result);
            }
            return;
        };
        match item {
            Ok(item) => upload.items.push(item),
            Err(result) => {
                self.upload = None;
                return self.end_transfer(from, code, result);
            }
        }
        (upload.asked, upload.retries) = (now, 0);
        upload.has_int |= is_int;
        upload.is_old &= !is_int;
        if upload.items.len() < usize::from(upload.count) {
            self.request_item();
        } else if let Some(upload) = self.upload.take() {
            self.decide(upload);
        }
    }

    /// Passes a complete upload to the host.
    fn decide(&mut self, upload: Upload) {
        let Upload { from, kind, count, mut items, .. } = upload;
        let request = match kind {
            MissionKind::Mission => {
                let home = self.take_home(from.peer, &mut items);
                if items.len() > usize::from(self.options.max_mission) {
                    return self.end_transfer(from, kind.code(), MissionResult::NoSpace);
                }
                RequestKind::Mission { items, home }
            }
            MissionKind::Fence if self.options.max_fence > 0 => RequestKind::Fence(items),
            // There are none, so there is nothing to delete.
            MissionKind::Fence | MissionKind::Rally | MissionKind::All => {
                return self.end_transfer(from, kind.code(), MissionResult::Accepted);
            }
        };
        self.finished = Some(Finished { from, kind, last: count.saturating_sub(1), result: None });
        if !self.ask(from, Reply::Mission(kind), request) {
            self.end_transfer(from, kind.code(), MissionResult::Error);
        }
    }

    /// Takes the home item off the front of a mission, if it has one. Missions for ArduPilot always have one. For others it
    /// is recognised: an absolute waypoint before items that are all relative, or a ground station of that family.
    fn take_home(&mut self, peer: PeerId, items: &mut Vec<MissionItem>) -> Option<MissionItem> {
        let is_ardupilot = self.options.identity == Identity::Ardupilot;
        let known = self.peer(peer)?;
        let [first, rest @ ..] = &items[..] else { return None };
        let is_waypoint = first.command == command::NAV_WAYPOINT && position_frame::is_amsl(first.frame);
        let is_alone = !rest.is_empty() && rest.iter().all(|item| is_relative(item.frame));
        let is_home = is_ardupilot || is_waypoint && (is_alone || known.is_ardupilot_style);
        known.has_home_item = is_home;
        if is_home && !is_ardupilot {
            known.send_text(Severity::Notice, "mission item 0 is home and is not flown");
        }
        is_home.then(|| items.remove(0))
    }

    fn clear(&mut self, from: Sender, code: u8) {
        let kind = MissionKind::from_code(code);
        let result = match (self.limit(kind), kind) {
            (Err(MissionResult::Denied), _) => MissionResult::Denied,
            (_, None) => MissionResult::Unsupported,
            (_, Some(kind)) => {
                let fences =
                    self.options.max_fence > 0 && matches!(kind, MissionKind::Fence | MissionKind::All);
                let missions = matches!(kind, MissionKind::Mission | MissionKind::All);
                let fence_reply = if missions { Reply::Silence } else { Reply::Mission(kind) };
                let mission = RequestKind::Mission { items: Vec::new(), home: None };
                let is_asked = (!fences || self.ask(from, fence_reply, RequestKind::Fence(Vec::new())))
                    && (!missions || self.ask(from, Reply::Mission(kind), mission));
                match is_asked {
                    true if fences || missions => return,
                    true => MissionResult::Accepted,
                    false => MissionResult::Error,
                }
            }
        };
        self.end_transfer(from, code, result);
    }

    fn set_current(&mut self, from: Sender, seq: u16) {
        let result = match self.item_of(from.peer, seq) {
            _ if self.options.is_read_only => MissionResult::Denied,
            None => MissionResult::InvalidSequence,
            Some(item) if self.ask(from, Reply::Current, RequestKind::SetCurrent(item)) => return,
            Some(_) => MissionResult::Error,
        };
        self.end_transfer(from, MissionKind::Mission.code(), result);
    }
}

/// Returns `true` for a frame with altitudes above home or above the ground, or without a position.
fn is_relative(frame: u8) -> bool {
    frame == position_frame::MISSION || position_frame::is_global(frame) && !position_frame::is_amsl(frame)
}
