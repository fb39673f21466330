//! The requests of a station to a craft, in the form that its autopilot understands.

use std::time::Duration;

use super::super::message::*;
use super::super::value::{autopilot, command, mode_flag, system_state};
use super::modes::{PX4_HOLD, PX4_MISSION};
use super::report::{AutopilotKind, Presence};
use super::{Craft, Order};

/// Groups of messages of ArduPilot with their rates, Hz.
const GROUPS: [(u8, u16); 7] = [(1, 1), (2, 2), (3, 2), (6, 5), (10, 10), (11, 5), (12, 2)];

/// Messages with their rates, Hz.
const RATES: [(u32, u16); 14] = [
    (SysStatus::ID, 1),
    (GpsRawInt::ID, 2),
    (Attitude::ID, 10),
    (LocalPositionNed::ID, 5),
    (GlobalPositionInt::ID, 5),
    (ServoOutputRaw::ID, 2),
    (RcChannels::ID, 2),
    (MissionCurrent::ID, 1),
    (NavControllerOutput::ID, 2),
    (VfrHud::ID, 4),
    (BatteryStatus::ID, 1),
    (WindCov::ID, 1),
    (HomePosition::ID, 1),
    (ExtendedSysState::ID, 1),
];

impl Craft {
    /// Returns the requests for telemetry that are not answered. ArduPilot knows groups of messages in all its versions.
    pub(super) fn stream_requests(&self) -> Vec<Message> {
        if self.number.autopilot != autopilot::ARDUPILOT {
            return Vec::new();
        }
        let request = |(req_stream_id, req_message_rate)| RequestDataStream {
            req_message_rate,
            target_system: self.system,
            target_component: self.component,
            req_stream_id,
            start_stop: 1,
        };
        GROUPS.map(|group| request(group).into()).to_vec()
    }

    /// Returns the commands that a station sends to a craft that it has found.
    pub(super) fn questions(&self) -> Vec<CommandLong> {
        let first = [
            self.long(command::REQUEST_MESSAGE, [AutopilotVersion::ID as f32, 0.0, 0.0]),
            self.ask_for_mode(1),
        ];
        let interval = |hz: u16| (Duration::from_secs(1) / u32::from(hz)).as_micros() as f32;
        let rates =
            RATES.map(|(id, hz)| self.long(command::SET_MESSAGE_INTERVAL, [id as f32, interval(hz), 0.0]));
        let home = self.long(command::REQUEST_MESSAGE, [HomePosition::ID as f32, 0.0, 0.0]);
        let rates = rates.into_iter().filter(|_| self.number.autopilot != autopilot::ARDUPILOT);
        first.into_iter().chain(rates).chain([home]).collect()
    }

    /// Asks for a mode by its index in the list of the craft.
    pub(super) fn ask_for_mode(&self, index: u8) -> CommandLong {
        self.long(command::REQUEST_MESSAGE, [AvailableModes::ID as f32, index.into(), 0.0])
    }

    /// Returns the command for an order, or `None` if the craft has no such mode.
    pub(super) fn command(&self, order: &Order) -> Option<CommandLong> {
        let is_px4 = self.number.autopilot == autopilot::PX4;
        Some(match order {
            Order::SetMode(name) => self.set_mode(self.modes.number(name, self.number)?),
            // PX4 flies and interrupts missions by its modes.
            Order::StartMission | Order::Continue if is_px4 => self.set_mode(PX4_MISSION),
            Order::Pause if is_px4 => self.set_mode(PX4_HOLD),
            Order::StartMission => self.long(command::MISSION_START, [0.0; 3]),
            Order::Pause => self.long(command::DO_PAUSE_CONTINUE, [0.0; 3]),
            Order::Continue => self.long(command::DO_PAUSE_CONTINUE, [1.0, 0.0, 0.0]),
            Order::ReturnHome => self.long(command::NAV_RETURN_TO_LAUNCH, [0.0; 3]),
            // Without a position: here.
            Order::Land => self.long(command::NAV_LAND, [0.0; 3]),
            Order::SetCurrent(seq) => self.long(command::DO_SET_MISSION_CURRENT, [(*seq).into(), 0.0, 0.0]),
        })
    }

    /// Returns the heartbeat with the name of its mode.
    pub(super) fn presence(&self) -> Presence {
        Presence {
            autopilot: AutopilotKind::from_code(self.number.autopilot),
            system_type: self.number.system_type,
            mode: self.modes.name(self.number),
            custom_mode: self.number.custom,
            is_armed: self.number.base_mode & mode_flag::ARMED != 0,
            is_critical: self.system_status >= system_state::CRITICAL,
        }
    }

    fn set_mode(&self, custom: u32) -> CommandLong {
        let flags = f32::from(mode_flag::CUSTOM);
        let [_, _, main, sub] = custom.to_le_bytes().map(f32::from);
        let is_px4 = self.number.autopilot == autopilot::PX4;
        let numbers = if is_px4 { [flags, main, sub] } else { [flags, custom as f32, 0.0] };
        self.long(command::DO_SET_MODE, numbers)
    }

    fn long(&self, command: u16, [param1, param2, param3]: [f32; 3]) -> CommandLong {
        let (target_system, target_component) = (self.system, self.component);
        CommandLong { param1, param2, param3, command, target_system, target_component, ..Default::default() }
    }
}
