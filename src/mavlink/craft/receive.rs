//! The answers of a craft to everything but commands and missions.

use super::super::frame::Frame;
use super::super::message::*;
use super::super::value::{autopilot, system_type};
use super::commands::Command;
use super::parameters::ListCursor;
use super::rc::RcInput;
use super::request::{Reply, RequestKind, Sender};
use super::{CraftProtocol, PeerId};

/// The opcode of a refusal in the file transfer protocol.
const FTP_NAK: u8 = 129;
/// The reason of a refusal: the file does not exist.
const FTP_FILE_NOT_FOUND: u8 = 10;

impl CraftProtocol {
    /// Handles a frame of a peer.
    pub(super) fn handle(&mut self, peer: PeerId, frame: &Frame) {
        let from = Sender { peer, system: frame.system, component: frame.component };
        let is_echo = from.system == self.options.system && from.component == self.options.component;
        if is_echo {
            return;
        }
        match frame.message {
            Message::Heartbeat(heartbeat) => self.heartbeat(peer, &heartbeat),
            Message::Ping(ping) if ping.target_system == 0 => {
                let (target_system, target_component) = (from.system, from.component);
                self.send(peer, Ping { target_system, target_component, ..ping });
            }
            Message::Timesync(sync) if sync.tc1 == 0 => {
                let tc1 = self.sim.as_nanos() as i64;
                let (target_system, target_component) = (from.system, from.component);
                self.send(peer, Timesync { tc1, ts1: sync.ts1, target_system, target_component });
            }
            Message::SetMode(set) if self.is_for_us(set.target_system, 0) => {
                self.command(from, &Command::from_set_mode(&set));
            }
            Message::CommandLong(long) if self.is_for_us(long.target_system, long.target_component) => {
                self.command(from, &Command::from_long(&long));
            }
            Message::CommandInt(int) if self.is_for_us(int.target_system, int.target_component) => {
                self.command(from, &Command::from_int(&int));
            }
            Message::RequestDataStream(request)
                if self.is_for_us(request.target_system, request.target_component) =>
            {
                let rate = if request.start_stop == 0 { 0 } else { request.req_message_rate };
                if let Some(peer) = self.peer(peer) {
                    peer.streams.set_group(request.req_stream_id, rate);
                }
            }
            Message::ParamRequestList(list) if self.is_for_us(list.target_system, list.target_component) => {
                let now = self.wall;
                if let Some(peer) = self.peer(peer) {
                    peer.list = Some(ListCursor::new(now));
                }
            }
            Message::ParamRequestRead(read) if self.is_for_us(read.target_system, read.target_component) => {
                if let Some(index) = self.parameters.asked(&read) {
                    self.send_parameter(index, Some(peer));
                }
            }
            Message::ParamSet(set) if self.is_for_us(set.target_system, set.target_component) => {
                self.set_parameter(from, &set);
            }
            Message::FileTransferProtocol(file)
                if self.is_for_us(file.target_system, file.target_component) =>
            {
                self.send(peer, refusal(from, &file));
            }
            Message::RcChannelsOverride(channels)
                if self.takes_rc() && self.is_for_us(channels.target_system, channels.target_component) =>
            {
                self.rc = Some((peer, RcInput::from_override(&channels)));
            }
            Message::ManualControl(sticks) if self.takes_rc() && self.is_for_us(sticks.target, 0) => {
                self.rc = Some((peer, RcInput::from_manual(&sticks)));
            }
            message => self.mission_message(from, &message),
        }
    }

    pub(super) fn is_for_us(&self, system: u8, component: u8) -> bool {
        [0, self.options.system].contains(&system) && [0, self.options.component].contains(&component)
    }

    fn takes_rc(&self) -> bool {
        self.options.takes_rc && !self.options.is_read_only
    }

    fn heartbeat(&mut self, peer: PeerId, heartbeat: &Heartbeat) {
        let is_ardupilot_style = heartbeat.autopilot == autopilot::ARDUPILOT;
        if let Some(peer) = self.peer(peer).filter(|_| heartbeat.r#type == system_type::GROUND_STATION) {
            peer.is_ardupilot_style = is_ardupilot_style;
        }
    }

    fn set_parameter(&mut self, from: Sender, set: &ParamSet) {
        let Some(index) = self.parameters.find(&set.param_id) else { return };
        let (name, value) = (self.parameters.name(index), set.param_value);
        let is_allowed = value.is_finite() && !self.options.is_read_only;
        let kind = RequestKind::SetParameter { name, value };
        if !is_allowed || !self.ask(from, Reply::Parameter(index), kind) {
            // The old value is the refusal.
            self.send_parameter(index, Some(from.peer));
        }
    }
}

/// Returns the refusal of a file, without which some ground stations wait for seconds.
fn refusal(to: Sender, request: &FileTransferProtocol) -> FileTransferProtocol {
    let [low, high, session, opcode, ..] = request.payload;
    let [low, high] = u16::from_le_bytes([low, high]).wrapping_add(1).to_le_bytes();
    let mut payload = [0; 251];
    // Sequence, session, opcode, size of the data, opcode of the request, then 6 bytes, then the data.
    payload[..6].copy_from_slice(&[low, high, session, FTP_NAK, 1, opcode]);
    payload[12] = FTP_FILE_NOT_FOUND;
    let (target_system, target_component) = (to.system, to.component);
    FileTransferProtocol { target_network: 0, target_system, target_component, payload }
}
