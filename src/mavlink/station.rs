//! The protocol of a ground station that follows one craft.
//!
//! [`StationProtocol::receive`] takes the bytes of the link, [`StationProtocol::advance`] the time.
//! [`StationProtocol::poll_transmit`] returns bytes to send, [`StationProtocol::poll_event`] what happened.
//! [`StationProtocol::report`] is what is known about the craft.
//!
//! The first autopilot whose heartbeat arrives is followed; others are counted. The station never arms a craft. Memory is
//! bounded: the newest 256 events, 512 frames to send, one transfer.

mod decode;
mod event;
mod modes;
mod orders;
mod report;
mod setup;
mod texts;
mod transfer;

use std::collections::{BTreeSet, VecDeque};
use std::time::Duration;

pub use event::{Event, NotBegun, Order};
pub use orders::{OrderEnd, OrderId};
pub use report::{AutopilotKind, CraftReport, CurrentItem, Firmware, Heard, Presence, SensorStatus};
pub use texts::PilotText;
pub use transfer::TransferEnd;

use super::frame::{Frame, FrameReader, Version};
use super::message::{Heartbeat, Message};
use super::mission::MissionItem;
use super::value::{
    MissionKind, MissionResult, autopilot, capability, command, position_frame, system_state, system_type,
};
use modes::{ListedModes, ModeNumber};
use orders::Orders;
use texts::TextJoiner;
use transfer::{Habits, Transfer};

/// The time between two heartbeats of the station.
const HEARTBEAT: Duration = Duration::from_secs(1);
/// The time without a heartbeat of the craft after which the link is lost.
const SILENCE: Duration = Duration::from_secs(3);
/// The number of events that wait. Older ones are dropped.
const MAX_EVENTS: usize = 256;
/// The number of frames that wait. Further ones are dropped.
const MAX_FRAMES: usize = 512;

/// The options of a ground station.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StationOptions {
    /// The system of the station.
    pub system: u8,
    /// The component of the station.
    pub component: u8,
}

impl Default for StationOptions {
    fn default() -> Self {
        Self { system: 255, component: 190 }
    }
}

/// The craft that is followed.
#[derive(Debug, Clone)]
struct Craft {
    system: u8,
    component: u8,
    number: ModeNumber,
    system_status: u8,
    modes: ListedModes,
    /// The time of the last heartbeat.
    heard: Duration,
    is_lost: bool,
    version: Version,
}

/// The protocol of a ground station. Times are durations since an instant that the host chooses.
#[derive(Debug, Clone)]
pub struct StationProtocol {
    options: StationOptions,
    reader: FrameReader,
    craft: Option<Craft>,
    others: BTreeSet<(u8, u8)>,
    report: CraftReport,
    texts: TextJoiner,
    orders: Orders,
    /// Questions and settings of the station itself.
    setup: Orders,
    transfer: Option<Transfer>,
    heartbeat_due: Duration,
    sequence: u8,
    outbox: VecDeque<Vec<u8>>,
    events: VecDeque<Event>,
}

impl StationProtocol {
    /// Returns the protocol of a station that has not found a craft.
    pub fn new(options: StationOptions) -> Self {
        Self {
            options,
            reader: FrameReader::default(),
            craft: None,
            others: BTreeSet::new(),
            report: CraftReport::default(),
            texts: TextJoiner::default(),
            orders: Orders::default(),
            setup: Orders::default(),
            transfer: None,
            heartbeat_due: Duration::ZERO,
            sequence: 0,
            outbox: VecDeque::new(),
            events: VecDeque::new(),
        }
    }

    /// Takes bytes of the link.
    pub fn receive(&mut self, now: Duration, mut bytes: &[u8]) {
        while let Some(frame) = self.reader.next_frame(&mut bytes) {
            self.handle(now, &frame);
        }
    }

    /// Takes the time: sends heartbeats and repetitions, and notices what does not arrive. Wants to be called at least 10
    /// times a second.
    pub fn advance(&mut self, now: Duration) {
        if now >= self.heartbeat_due {
            self.heartbeat_due = now.saturating_add(HEARTBEAT);
            self.send(Heartbeat {
                r#type: system_type::GROUND_STATION,
                autopilot: autopilot::INVALID,
                system_status: system_state::ACTIVE,
                mavlink_version: 3,
                ..Heartbeat::default()
            });
        }
        if let Some(text) = self.texts.overdue(now) {
            self.event(Event::Text(text));
        }
        let Some(craft) = &mut self.craft else { return };
        if !craft.is_lost && now.saturating_sub(craft.heard) >= SILENCE {
            craft.is_lost = true;
            self.event(Event::LinkLost);
            self.end_all();
        }
        let (command, ended) = self.orders.advance(now);
        self.send_all(command);
        if let Some(id) = ended {
            self.event(Event::Order(id, OrderEnd::Silence));
        }
        let (command, ended) = self.setup.advance(now);
        self.send_all(command);
        if ended.is_some() {
            // A craft that does not answer one question answers none.
            self.setup.clear();
        }
        if let (Some(habits), Some(transfer)) = (self.habits(), &mut self.transfer) {
            match transfer.advance(now, habits) {
                Ok(message) => self.send_all(message),
                Err(end) => self.end_transfer(end),
            }
        }
    }

    /// Returns the next bytes to send, one frame.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.outbox.pop_front()
    }

    /// Returns the next event.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// Returns what is known about the craft.
    pub fn report(&self) -> &CraftReport {
        &self.report
    }

    /// Returns `true` while heartbeats of the craft arrive.
    pub fn is_connected(&self) -> bool {
        self.craft.as_ref().is_some_and(|craft| !craft.is_lost)
    }

    /// Returns the systems and components of other autopilots on the link, at most 32.
    pub fn others(&self) -> &BTreeSet<(u8, u8)> {
        &self.others
    }

    /// Returns the reader of the link, with its counts and losses.
    pub fn reader(&self) -> &FrameReader {
        &self.reader
    }

    /// Returns the number of the first item of a mission after the home item, in numbers of the craft.
    pub fn first_item(&self) -> u16 {
        self.habits().is_some_and(|habits| habits.has_home_item).into()
    }

    /// Returns the names of the modes of the craft.
    pub fn mode_names(&self) -> Vec<String> {
        self.craft.as_ref().map(|craft| craft.modes.names(craft.number)).unwrap_or_default()
    }

    /// Orders the craft to do something. The event [`Event::Order`] has the outcome.
    ///
    /// # Errors
    ///
    /// No craft, a mode that the craft does not have, or too many orders.
    pub fn order(&mut self, order: &Order) -> Result<OrderId, NotBegun> {
        let craft = self.craft.as_ref().filter(|craft| !craft.is_lost).ok_or(NotBegun::NoCraft)?;
        let command = craft.command(order).ok_or(NotBegun::NoSuchMode)?;
        self.orders.add(command).ok_or(NotBegun::Busy)
    }

    /// Begins to read the mission or the fences of the craft. The event [`Event::Transfer`] has the outcome.
    ///
    /// # Errors
    ///
    /// No craft, or another transfer.
    pub fn download(&mut self, kind: MissionKind) -> Result<(), NotBegun> {
        self.begin(Transfer::download(kind))
    }

    /// Begins to replace the mission or the fences of the craft. The items have no home item: the station adds it for
    /// ArduPilot. The event [`Event::Transfer`] has the outcome.
    ///
    /// # Errors
    ///
    /// No craft, another transfer, or too many items.
    pub fn upload(&mut self, kind: MissionKind, items: Vec<MissionItem>) -> Result<(), NotBegun> {
        let habits = self.habits().ok_or(NotBegun::NoCraft)?;
        if items.len() >= usize::from(u16::MAX) {
            return Err(NotBegun::TooLong);
        }
        let needs_home = habits.has_home_item && kind == MissionKind::Mission;
        let home = needs_home.then(|| self.home_item(items.first()));
        self.begin(Transfer::upload(kind, items, home))
    }

    /// Cancels the transfer. No event follows.
    pub fn cancel_transfer(&mut self) {
        if let (Some(habits), Some(transfer)) = (self.habits(), self.transfer.take()) {
            self.send(transfer.end(habits, MissionResult::Cancelled));
        }
    }

    /// Returns the number of items that the transfer has moved and the number of all, if it is known; `None` without a
    /// transfer.
    pub fn transfer_progress(&self) -> Option<(usize, Option<usize>)> {
        self.transfer.as_ref().map(Transfer::progress)
    }

    fn begin(&mut self, transfer: Transfer) -> Result<(), NotBegun> {
        if !self.is_connected() {
            return Err(NotBegun::NoCraft);
        }
        if self.transfer.is_some() {
            return Err(NotBegun::Busy);
        }
        self.transfer = Some(transfer);
        Ok(())
    }

    fn handle(&mut self, now: Duration, frame: &Frame) {
        let is_own = frame.system == self.options.system;
        if let Message::Heartbeat(heartbeat) = frame.message
            && heartbeat.autopilot != autopilot::INVALID
            && heartbeat.r#type != system_type::GROUND_STATION
            && !is_own
        {
            self.heartbeat(now, frame, &heartbeat);
        }
        let sender = (frame.system, frame.component);
        let Some(craft) = self.craft.as_mut().filter(|craft| (craft.system, craft.component) == sender)
        else {
            return;
        };
        craft.version = frame.version;
        match frame.message {
            Message::Statustext(text) => {
                let texts = self.texts.take(&text, now);
                texts.into_iter().flatten().for_each(|text| self.event(Event::Text(text)));
            }
            Message::MissionItemReached(reached) => self.event(Event::ItemReached(reached.seq)),
            Message::CommandAck(ack) => {
                if let Some((id, result)) = self.orders.answer(now, ack.command, ack.result) {
                    self.event(Event::Order(id, OrderEnd::Answered(result)));
                } else {
                    self.setup.answer(now, ack.command, ack.result);
                }
            }
            Message::AvailableModes(mode) => {
                if let Some(next) = craft.modes.take(&mode) {
                    let question = craft.ask_for_mode(next);
                    self.setup.add(question);
                }
                self.update_presence(now);
            }
            message => {
                self.report.take(&message, now);
                self.move_transfer(now, &message);
            }
        }
    }

    fn heartbeat(&mut self, now: Duration, frame: &Frame, heartbeat: &Heartbeat) {
        let sender = (frame.system, frame.component);
        let number = ModeNumber {
            autopilot: heartbeat.autopilot,
            system_type: heartbeat.r#type,
            base_mode: heartbeat.base_mode,
            custom: heartbeat.custom_mode,
        };
        match &mut self.craft {
            Some(craft) if (craft.system, craft.component) != sender => {
                if self.others.len() < 32 {
                    self.others.insert(sender);
                }
                return;
            }
            Some(craft) => {
                (craft.number, craft.heard) = (number, now);
                craft.system_status = heartbeat.system_status;
                if std::mem::take(&mut craft.is_lost) {
                    self.event(Event::LinkRestored);
                    self.set_up();
                }
            }
            None => {
                let (system, component) = sender;
                self.craft = Some(Craft {
                    system,
                    component,
                    number,
                    system_status: heartbeat.system_status,
                    modes: ListedModes::default(),
                    heard: now,
                    is_lost: false,
                    version: frame.version,
                });
                self.event(Event::Connected { system, component });
                self.set_up();
            }
        }
        self.update_presence(now);
    }

    /// Asks for everything that the station needs.
    fn set_up(&mut self) {
        let Some(craft) = &self.craft else { return };
        let (messages, questions) = (craft.stream_requests(), craft.questions());
        messages.into_iter().for_each(|message| self.send(message));
        self.setup.clear();
        questions.into_iter().for_each(|question| _ = self.setup.add(question));
    }

    /// Writes the heartbeat to the report, with the name of its mode.
    fn update_presence(&mut self, now: Duration) {
        let Some(craft) = &self.craft else { return };
        let presence = craft.presence();
        let before = self.report.presence.replace(Heard { value: presence.clone(), at: now });
        let before = before.map(|before| before.value);
        if before.as_ref().map(|before| &before.mode) != Some(&presence.mode) {
            self.event(Event::Mode(presence.mode));
        }
        if before.is_some_and(|before| before.is_armed != presence.is_armed) {
            self.event(Event::Armed(presence.is_armed));
        }
    }

    fn move_transfer(&mut self, now: Duration, message: &Message) {
        let (Some(habits), Some(transfer)) = (self.habits(), &mut self.transfer) else { return };
        let (answer, end) = transfer.take(message, now, habits);
        self.send_all(answer);
        if let Some(end) = end {
            self.end_transfer(end);
        }
    }

    fn end_transfer(&mut self, end: TransferEnd) {
        self.transfer = None;
        self.event(Event::Transfer(end));
    }

    /// Ends all orders and the transfer when the link is lost.
    fn end_all(&mut self) {
        self.setup.clear();
        for id in self.orders.clear() {
            self.event(Event::Order(id, OrderEnd::Lost));
        }
        if let Some(transfer) = &self.transfer {
            self.end_transfer(TransferEnd::Silence(transfer.kind()));
        }
    }

    fn habits(&self) -> Option<Habits> {
        let craft = self.craft.as_ref()?;
        let firmware = self.report.firmware.map(|firmware| firmware.value);
        Some(Habits {
            system: craft.system,
            component: craft.component,
            // INAV may claim to be ArduPilot. It has no home item, and does not report a version.
            has_home_item: craft.number.autopilot == autopilot::ARDUPILOT && firmware.is_some(),
            takes_int: firmware.is_some_and(|firmware| firmware.capabilities & capability::MISSION_INT != 0),
        })
    }

    /// Returns the home item for ArduPilot: home, or the first position if home is not known.
    fn home_item(&self, first: Option<&MissionItem>) -> MissionItem {
        let first = first.copied().unwrap_or_default();
        let (x, y, z) = self.report.home.map_or((first.x, first.y, 0.0), |home| {
            let [x, y] =
                [home.value.lat_deg, home.value.lon_deg].map(|degrees| (degrees * 1e7).round() as i32);
            (x, y, home.value.alt_amsl as f32)
        });
        let (frame, command) = (position_frame::GLOBAL, command::NAV_WAYPOINT);
        MissionItem { frame, command, params: [0.0; 4], x, y, z, is_current: true, autocontinue: true }
    }

    fn send_all<T: Into<Message>>(&mut self, messages: impl IntoIterator<Item = T>) {
        messages.into_iter().for_each(|message| self.send(message));
    }

    fn send(&mut self, message: impl Into<Message>) {
        let version = self.craft.as_ref().map_or(Version::V2, |craft| craft.version);
        let StationOptions { system, component } = self.options;
        let frame = Frame { version, sequence: self.sequence, system, component, message: message.into() };
        if let Some(bytes) = frame.encode().filter(|_| self.outbox.len() < MAX_FRAMES) {
            self.sequence = self.sequence.wrapping_add(1);
            self.outbox.push_back(bytes);
        }
    }

    fn event(&mut self, event: Event) {
        if self.events.len() >= MAX_EVENTS {
            self.events.pop_front();
        }
        self.events.push_back(event);
    }
}

#[cfg(test)]
mod tests;
