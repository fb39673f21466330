//! Missions and fences from and to a craft.

use std::time::Duration;

use super::super::message::{
    Message, MissionAck, MissionCount, MissionRequest, MissionRequestInt, MissionRequestList,
};
use super::super::mission::{Address, MissionItem};
use super::super::value::{MissionKind, MissionResult, command, position_frame};

/// The time after which a message is repeated.
const PATIENCE: Duration = Duration::from_millis(1500);
/// The number of times that a message is repeated.
const MAX_RETRIES: u8 = 5;
/// The number of items of a download.
const MAX_ITEMS: u16 = 2000;

/// The end of a transfer.
#[derive(Debug, Clone, PartialEq)]
pub enum TransferEnd {
    /// The items of the craft.
    Received {
        /// Their kind.
        kind: MissionKind,
        /// The items without a home item.
        items: Vec<MissionItem>,
        /// The home item that ArduPilot keeps before them.
        home: Option<MissionItem>,
    },
    /// The craft has taken the items.
    Sent(MissionKind),
    /// The craft refused.
    Refused(MissionKind, MissionResult),
    /// The craft did not answer.
    Silence(MissionKind),
    /// The craft has more items than can be read, with their number.
    TooLong(MissionKind, u16),
}

/// The facts about the craft that a transfer needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Habits {
    pub(super) system: u8,
    pub(super) component: u8,
    /// `true` if item 0 of a mission is home, as ArduPilot has it.
    pub(super) has_home_item: bool,
    /// `true` if the craft takes `MISSION_ITEM_INT`.
    pub(super) takes_int: bool,
}

#[derive(Debug, Clone)]
enum Way {
    Download {
        /// The number of items, if it is known.
        count: Option<u16>,
        /// `true` if items are asked for by the old request.
        is_old: bool,
    },
    Upload {
        /// The item that the craft asked for last.
        asked: Option<u16>,
        /// `true` if the craft asks by the old request.
        is_old: bool,
    },
}

/// A transfer in progress.
#[derive(Debug, Clone)]
pub(super) struct Transfer {
    kind: MissionKind,
    way: Way,
    items: Vec<MissionItem>,
    due: Duration,
    retries: u8,
}

impl Transfer {
    pub(super) fn download(kind: MissionKind) -> Self {
        let way = Way::Download { count: None, is_old: false };
        Self { kind, way, items: Vec::new(), due: Duration::ZERO, retries: 0 }
    }

    pub(super) fn upload(kind: MissionKind, mut items: Vec<MissionItem>, home: Option<MissionItem>) -> Self {
        items.splice(..0, home);
        let way = Way::Upload { asked: None, is_old: false };
        Self { kind, way, items, due: Duration::ZERO, retries: 0 }
    }

    pub(super) fn kind(&self) -> MissionKind {
        self.kind
    }

    /// Returns the number of items that were transferred, and the number of all, if it is known.
    pub(super) fn progress(&self) -> (usize, Option<usize>) {
        match self.way {
            Way::Download { count, .. } => (self.items.len(), count.map(usize::from)),
            Way::Upload { asked, .. } => (asked.map_or(0, usize::from), Some(self.items.len())),
        }
    }

    /// Returns the message that is due, or the end of the transfer.
    pub(super) fn advance(&mut self, now: Duration, craft: Habits) -> Result<Option<Message>, TransferEnd> {
        if now < self.due {
            return Ok(None);
        }
        // The first call sends the first message.
        let is_first = self.due.is_zero();
        if !is_first && self.retries >= MAX_RETRIES {
            return Err(TransferEnd::Silence(self.kind));
        }
        if !is_first {
            self.retries += 1;
            if let Way::Download { count: Some(_), is_old } = &mut self.way {
                // An old craft knows only the old request.
                *is_old = !*is_old && !craft.takes_int;
            }
        }
        self.due = now.saturating_add(PATIENCE).max(Duration::from_nanos(1));
        Ok(self.current(craft))
    }

    /// Takes a message of the craft. Returns the answer, and the end of the transfer.
    pub(super) fn take(
        &mut self,
        message: &Message,
        now: Duration,
        craft: Habits,
    ) -> (Option<Message>, Option<TransferEnd>) {
        let kind = self.kind.code();
        match (*message, &mut self.way) {
            (Message::MissionCount(message), Way::Download { count: count @ None, .. })
                if message.mission_type == kind =>
            {
                if message.count > MAX_ITEMS {
                    let end = TransferEnd::TooLong(self.kind, message.count);
                    return (Some(self.end(craft, MissionResult::NoSpace)), Some(end));
                }
                *count = Some(message.count);
            }
            (Message::MissionItemInt(item), Way::Download { count: Some(_), .. })
                if item.mission_type == kind && usize::from(item.seq) == self.items.len() =>
            {
                self.items.push(MissionItem::from_int(&item));
            }
            (Message::MissionItemFloat(item), Way::Download { count: Some(_), .. })
                if item.mission_type == kind && usize::from(item.seq) == self.items.len() =>
            {
                match MissionItem::from_float(&item) {
                    Ok(item) => self.items.push(item),
                    Err(result) => {
                        let end = TransferEnd::Refused(self.kind, result);
                        return (Some(self.end(craft, result)), Some(end));
                    }
                }
            }
            (Message::MissionRequestInt(request), Way::Upload { asked, is_old })
                if request.mission_type == kind =>
            {
                (*asked, *is_old) = (Some(request.seq), false);
            }
            (Message::MissionRequest(request), Way::Upload { asked, is_old })
                if request.mission_type == kind =>
            {
                (*asked, *is_old) = (Some(request.seq), true);
            }
            (Message::MissionAck(ack), way) if ack.mission_type == kind => {
                let result = MissionResult::from_code(ack.r#type).unwrap_or(MissionResult::Error);
                let is_upload = matches!(way, Way::Upload { .. });
                let end = match result {
                    MissionResult::Accepted if is_upload => TransferEnd::Sent(self.kind),
                    MissionResult::Accepted => return (None, None),
                    result => TransferEnd::Refused(self.kind, result),
                };
                return (None, Some(end));
            }
            _ => return (None, None),
        }
        (self.due, self.retries) = (now.saturating_add(PATIENCE), 0);
        let is_complete =
            matches!(self.way, Way::Download { count: Some(count), .. } if self.items.len() >= count.into());
        if is_complete {
            return (Some(self.end(craft, MissionResult::Accepted)), Some(self.received(craft)));
        }
        (self.current(craft), None)
    }

    /// Returns the message that ends the transfer.
    pub(super) fn end(&self, craft: Habits, result: MissionResult) -> Message {
        MissionAck {
            target_system: craft.system,
            target_component: craft.component,
            r#type: result.code(),
            mission_type: self.kind.code(),
            opaque_id: 0,
        }
        .into()
    }

    /// Returns the message that moves the transfer on.
    fn current(&self, craft: Habits) -> Option<Message> {
        let (target_system, target_component, mission_type) =
            (craft.system, craft.component, self.kind.code());
        let seq = self.items.len() as u16;
        Some(match self.way {
            Way::Download { count: None, .. } => {
                MissionRequestList { target_system, target_component, mission_type }.into()
            }
            Way::Download { is_old: false, .. } => {
                MissionRequestInt { seq, target_system, target_component, mission_type }.into()
            }
            Way::Download { is_old: true, .. } => {
                MissionRequest { seq, target_system, target_component, mission_type }.into()
            }
            Way::Upload { asked: None, .. } => {
                MissionCount { count: seq, target_system, target_component, mission_type, opaque_id: 0 }
                    .into()
            }
            Way::Upload { asked: Some(seq), is_old } => {
                let item = self.items.get(usize::from(seq))?;
                let to =
                    Address { system: target_system, component: target_component, kind: mission_type, seq };
                // Crafts that support both forms may ask by the old request, too.
                if is_old && !craft.takes_int { item.to_float(to).into() } else { item.to_int(to).into() }
            }
        })
    }

    fn received(&mut self, craft: Habits) -> TransferEnd {
        let mut items = std::mem::take(&mut self.items);
        let is_home = |item: &&MissionItem| {
            item.command == command::NAV_WAYPOINT && position_frame::is_amsl(item.frame)
        };
        let has_home = craft.has_home_item
            && self.kind == MissionKind::Mission
            && items.first().as_ref().is_some_and(is_home);
        let home = has_home.then(|| items.remove(0));
        TransferEnd::Received { kind: self.kind, items, home }
    }
}
