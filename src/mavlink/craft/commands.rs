//! The commands that a craft knows.

use std::time::Duration;

use super::super::message::*;
use super::super::state::GeoPosition;
use super::super::value::{CommandResult, capability, command, mode_flag, position_frame};
use super::super::wire::Text;
use super::modes::{FlightMode, Identity, px4};
use super::request::{Reply, RequestKind, Sender};
use super::{CraftProtocol, Version};

/// The number that asks to arm or disarm without checks.
const FORCE: f32 = 21196.0;
/// The type of a released version, `FIRMWARE_VERSION_TYPE_OFFICIAL`.
const OFFICIAL: u8 = 255;
/// The property of modes that a user does not select, `MAV_MODE_PROPERTY_NOT_USER_SELECTABLE`.
const NOT_SELECTABLE: u32 = 2;
/// The property of modes in which the craft flies by itself, `MAV_MODE_PROPERTY_AUTO_MODE`.
const AUTO_MODE: u32 = 4;

/// A command of either form.
#[derive(Debug, Clone, Copy)]
pub(super) struct Command {
    id: u16,
    params: [f32; 7],
    /// Latitude and longitude in degrees.
    position: [f64; 2],
    /// The frame of the altitude, in the form with a position.
    frame: Option<u8>,
    /// The number of a mode as a heartbeat has it.
    custom_mode: Option<u32>,
    /// The part that only a repetition has in common with its command.
    bits: [u32; 7],
}

/// The effect of a command.
enum Outcome {
    /// These messages follow the acknowledgement.
    Messages(Vec<Message>),
    /// The host decides.
    Ask(RequestKind),
}

impl Command {
    pub(super) fn from_long(long: &CommandLong) -> Self {
        let CommandLong { param1, param2, param3, param4, param5, param6, param7, .. } = *long;
        let params = [param1, param2, param3, param4, param5, param6, param7];
        Self {
            id: long.command,
            params,
            position: [param5.into(), param6.into()],
            frame: None,
            custom_mode: None,
            bits: params.map(f32::to_bits),
        }
    }

    pub(super) fn from_int(int: &CommandInt) -> Self {
        let CommandInt { param1, param2, param3, param4, x, y, z, .. } = *int;
        let params = [param1, param2, param3, param4, x as f32, y as f32, z];
        let [first, second, third, fourth, .., last] = params.map(f32::to_bits);
        Self {
            id: int.command,
            params,
            position: [x, y].map(|degrees| f64::from(degrees) / 1e7),
            frame: Some(int.frame),
            custom_mode: None,
            bits: [first, second, third, fourth, x as u32, y as u32, last],
        }
    }

    /// Returns the command that has the effect of `SET_MODE`.
    pub(super) fn from_set_mode(set: &SetMode) -> Self {
        let mut params = [0.0; 7];
        params[0] = set.base_mode.into();
        Self {
            id: command::DO_SET_MODE,
            params,
            position: [0.0; 2],
            frame: None,
            custom_mode: Some(set.custom_mode),
            bits: [set.base_mode.into(), set.custom_mode, 0, 0, 0, 0, 0],
        }
    }

    fn first(&self) -> f32 {
        self.params[0]
    }
}

impl CraftProtocol {
    /// Answers a command.
    pub(super) fn command(&mut self, from: Sender, command: &Command) {
        let result = match self.outcome(from, command) {
            Ok(Outcome::Messages(messages)) => {
                self.acknowledge(from, command.id, CommandResult::Accepted);
                messages.into_iter().for_each(|message| self.send(from.peer, message));
                return;
            }
            Ok(Outcome::Ask(_)) if self.options.is_read_only => CommandResult::Denied,
            Ok(Outcome::Ask(kind)) => {
                let reply = Reply::Command(command.id, command.bits);
                // A repeated command gets the answer that the first one waits for.
                if self.pending.contains(from, reply) || self.ask(from, reply, kind) {
                    return;
                }
                CommandResult::TemporarilyRejected
            }
            Err(result) => result,
        };
        self.acknowledge(from, command.id, result);
    }

    pub(super) fn acknowledge(&mut self, to: Sender, command: u16, result: CommandResult) {
        let (target_system, target_component) = (to.system, to.component);
        let result = result.code();
        let acknowledgement =
            CommandAck { command, result, target_system, target_component, ..CommandAck::default() };
        self.send(to.peer, acknowledgement);
    }

    fn outcome(&mut self, from: Sender, asked: &Command) -> Result<Outcome, CommandResult> {
        let kind = match asked.id {
            command::COMPONENT_ARM_DISARM => match asked.params {
                [_, FORCE, ..] => return Err(CommandResult::Denied),
                [1.0, ..] => RequestKind::Arm,
                [0.0, ..] => RequestKind::Disarm,
                _ => return Err(CommandResult::Denied),
            },
            command::NAV_TAKEOFF => RequestKind::TakeOff { altitude: self.take_off_altitude(asked)? },
            command::NAV_LAND => RequestKind::Land,
            command::NAV_RETURN_TO_LAUNCH => RequestKind::ReturnHome,
            command::MISSION_START => RequestKind::StartMission,
            command::DO_PAUSE_CONTINUE => match asked.first() {
                0.0 => RequestKind::Pause,
                1.0 => RequestKind::Continue,
                _ => return Err(CommandResult::Denied),
            },
            command::DO_SET_MODE => mode_request(self.asked_mode(asked))?,
            command::DO_SET_STANDARD_MODE => {
                let code = whole(asked.first()).and_then(|code| u8::try_from(code).ok());
                mode_request(code.and_then(FlightMode::from_standard))?
            }
            command::DO_SET_MISSION_CURRENT => {
                let seq = whole(asked.first()).and_then(|seq| u16::try_from(seq).ok());
                let item = seq.and_then(|seq| self.item_of(from.peer, seq)).ok_or(CommandResult::Denied)?;
                RequestKind::SetCurrent(item)
            }
            command::DO_SET_HOME => RequestKind::SetHome(asked_home(asked)?),
            command::PREFLIGHT_REBOOT_SHUTDOWN if asked.first() != 1.0 => return Err(CommandResult::Denied),
            command::PREFLIGHT_REBOOT_SHUTDOWN if self.state.is_armed => {
                return Err(CommandResult::TemporarilyRejected);
            }
            command::PREFLIGHT_REBOOT_SHUTDOWN => RequestKind::Reboot,
            _ => return self.messages(from, asked).map(Outcome::Messages),
        };
        Ok(Outcome::Ask(kind))
    }

    /// Returns the messages that a command asks for.
    fn messages(&mut self, from: Sender, asked: &Command) -> Result<Vec<Message>, CommandResult> {
        let (first, second) = (whole(asked.first()), whole(asked.params[1]));
        match asked.id {
            command::REQUEST_MESSAGE => {
                self.requested(from, first.ok_or(CommandResult::Denied)?, asked.params[1])
            }
            command::GET_HOME_POSITION => self.requested(from, HomePosition::ID, 0.0),
            command::REQUEST_PROTOCOL_VERSION => self.requested(from, ProtocolVersion::ID, 0.0),
            command::REQUEST_AUTOPILOT_CAPABILITIES => self.requested(from, AutopilotVersion::ID, 0.0),
            command::GET_MESSAGE_INTERVAL => self.requested(from, MessageInterval::ID, asked.first()),
            command::SET_MESSAGE_INTERVAL => {
                let id = first.ok_or(CommandResult::Denied)?;
                let interval = match (asked.params[1], second) {
                    (-1.0, _) => None,
                    (_, Some(micros)) => Some(Duration::from_micros(micros.into())),
                    (micros, None) if micros >= 1.0 => Some(Duration::from_micros(micros.min(1e12) as u64)),
                    _ => return Err(CommandResult::Denied),
                };
                let peer = self.peer(from.peer).ok_or(CommandResult::Failed)?;
                let is_set = peer.streams.set_interval(id, interval);
                if is_set { Ok(Vec::new()) } else { Err(CommandResult::Unsupported) }
            }
            _ => Err(CommandResult::Unsupported),
        }
    }

    /// Returns a message that was asked for once; `detail` is the index or the number that it is about.
    fn requested(&mut self, from: Sender, id: u32, detail: f32) -> Result<Vec<Message>, CommandResult> {
        let peer = self.peer(from.peer).ok_or(CommandResult::Failed)?;
        if peer.version == Version::V1 && id > u8::MAX.into() {
            return Err(CommandResult::Unsupported);
        }
        let message = match id {
            AutopilotVersion::ID => self.autopilot_version().into(),
            ProtocolVersion::ID => {
                ProtocolVersion { version: 200, min_version: 100, max_version: 200, ..Default::default() }
                    .into()
            }
            MessageInterval::ID => {
                let asked = whole(detail).ok_or(CommandResult::Denied)?;
                let interval_us = match peer.streams.interval(asked) {
                    None => 0,
                    Some(None) => -1,
                    Some(Some(interval)) => i32::try_from(interval.as_micros()).unwrap_or(i32::MAX),
                };
                MessageInterval { interval_us, message_id: asked as u16 }.into()
            }
            AvailableModes::ID => {
                let index = whole(detail).unwrap_or_default();
                let modes = available_modes(self.options.identity);
                let wanted: Vec<Message> = modes
                    .into_iter()
                    .filter(|mode| index == 0 || index == mode.mode_index.into())
                    .map(Into::into)
                    .collect();
                return if wanted.is_empty() { Err(CommandResult::Denied) } else { Ok(wanted) };
            }
            _ => {
                let is_repeated = peer.streams.interval(id).is_some();
                let has_home_item =
                    self.peers.iter().any(|peer| peer.id == from.peer && self.has_home_item(peer));
                let result =
                    if is_repeated { CommandResult::TemporarilyRejected } else { CommandResult::Unsupported };
                self.source(has_home_item).message(id).ok_or(result)?
            }
        };
        Ok(vec![message])
    }

    fn autopilot_version(&self) -> AutopilotVersion {
        let [major, minor, patch] = self.options.version;
        let fence = if self.options.max_fence > 0 { capability::MISSION_FENCE } else { 0 };
        AutopilotVersion {
            capabilities: capability::MAVLINK2
                | capability::MISSION_INT
                | capability::COMMAND_INT
                | capability::PARAM_FLOAT
                | capability::PARAM_C_CAST
                | fence,
            flight_sw_version: u32::from_be_bytes([major, minor, patch, OFFICIAL]),
            ..Default::default()
        }
    }

    fn asked_mode(&self, asked: &Command) -> Option<FlightMode> {
        let identity = self.options.identity;
        let [flags, main, sub, ..] = asked.params;
        if whole(flags)? & u32::from(mode_flag::CUSTOM) == 0 {
            return None;
        }
        if let Some(custom) = asked.custom_mode {
            return identity.mode(custom);
        }
        let main = whole(main)?;
        match (u8::try_from(main), whole(sub).and_then(|sub| u8::try_from(sub).ok())) {
            // MAVSDK sends modes of PX4 to every autopilot but ArduPilot.
            (Ok(main), Some(sub)) if sub > 0 => Identity::Px4.mode(px4(main, sub)),
            (Ok(main), _) if identity == Identity::Px4 => identity.mode(px4(main, 0)),
            _ => identity.mode(main),
        }
    }

    /// Returns the altitude of a take-off above home; `None` if the craft chooses it.
    fn take_off_altitude(&self, asked: &Command) -> Result<Option<f64>, CommandResult> {
        let altitude = f64::from(asked.params[6]);
        let above = if asked.frame.is_some_and(position_frame::is_amsl) && altitude.is_finite() {
            altitude - self.state.home.ok_or(CommandResult::Denied)?.alt_amsl
        } else {
            altitude
        };
        Ok(Some(above).filter(|above| above.is_finite() && *above > 0.0))
    }
}

/// Returns the request for a mode.
fn mode_request(mode: Option<FlightMode>) -> Result<RequestKind, CommandResult> {
    Ok(match mode {
        None | Some(FlightMode::Failsafe) => return Err(CommandResult::Denied),
        Some(FlightMode::TakeOff) => RequestKind::TakeOff { altitude: None },
        Some(FlightMode::Landing) => RequestKind::Land,
        Some(FlightMode::ReturnHome) => RequestKind::ReturnHome,
        Some(mode) => RequestKind::SetMode(mode),
    })
}

fn asked_home(asked: &Command) -> Result<Option<GeoPosition>, CommandResult> {
    if asked.first() == 1.0 {
        return Ok(None);
    }
    let ([lat_deg, lon_deg], alt_amsl) = (asked.position, f64::from(asked.params[6]));
    let is_place = lat_deg.abs() <= 90.0 && lon_deg.abs() <= 180.0 && alt_amsl.is_finite();
    let is_amsl = asked.frame.is_none_or(position_frame::is_amsl);
    if is_place && is_amsl {
        Ok(Some(GeoPosition { lat_deg, lon_deg, alt_amsl }))
    } else {
        Err(CommandResult::Denied)
    }
}

fn available_modes(identity: Identity) -> Vec<AvailableModes> {
    let number_modes = identity.listed_modes().count() as u8;
    let rows = (1..).zip(identity.listed_modes());
    let message = |(mode_index, listed): (u8, super::modes::ListedMode)| {
        let is_selectable = listed.mode != FlightMode::Failsafe;
        let properties = if is_selectable { 0 } else { NOT_SELECTABLE }
            | if listed.mode.is_automatic() { AUTO_MODE } else { 0 };
        AvailableModes {
            custom_mode: listed.custom,
            properties,
            number_modes,
            mode_index,
            standard_mode: listed.mode.standard().code(),
            mode_name: Text::new(listed.name),
        }
    };
    rows.map(message).collect()
}

/// Returns a parameter that is a whole number.
fn whole(value: f32) -> Option<u32> {
    let is_whole = (0.0..=16_777_216.0).contains(&value) && value.fract() == 0.0;
    is_whole.then_some(value as u32)
}
