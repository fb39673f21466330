//! The commands to a vehicle as stored data.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use crate::firmware::cli::CliMode;
use crate::firmware::config::correct;
use crate::firmware::msp::UtcTime;
use crate::firmware::storage::{from_text, to_text};
use crate::plan::{FlightPlan, MAX_WAYPOINTS, Waypoint};
use crate::signals::{RC_CHANNELS, RcFrame, RcSource};
use crate::sim::WorldCommand;
use crate::telemetry::InFlightCommand;
use crate::vehicle::{CliSession, Message, VehicleCommand};

/// The greatest altitude to which the scripted pilot climbs, m.
const MAX_TAKEOFF_M: f64 = 10_000.0;

/// A command with its stored names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Input {
    Rc([u16; RC_CHANNELS], Source),
    SticksFirst(bool),
    BeginCli(Session, Mode),
    EndCli(Session),
    EndAllCli,
    Line(Session, String),
    Upload {
        waypoints: Box<ArrayVec<Waypoint, MAX_WAYPOINTS>>,
        settings: Vec<String>,
    },
    /// Code, payload, and the time of day: seconds since 1970 and milliseconds.
    Msp(u16, Vec<u8>, Option<(u32, u16)>),
    CliOpened,
    CliClosed,
    /// The records of the configuration.
    Restart(String),
    ReturnHome,
    GoTo(u8),
    HoldHere,
    GoOn,
    CancelReturn,
    Sticks([u16; RC_CHANNELS]),
    CutRc(bool),
    /// `CH=VALUE@T[,FOR]`.
    Hold(String),
    Release(u8),
    Pilot(f64),
    PilotOff,
    /// In the words of the command line.
    World(String),
    Reset,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Source {
    Udp,
    Msp,
    Sticks,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Session {
    Console,
    Client(u64),
    Single(Mode),
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Mode {
    Interactive,
    Framed,
    Message,
    File,
}

impl From<RcSource> for Source {
    fn from(source: RcSource) -> Self {
        match source {
            RcSource::Udp => Self::Udp,
            RcSource::Msp => Self::Msp,
            RcSource::Sticks => Self::Sticks,
        }
    }
}

impl From<Source> for RcSource {
    fn from(source: Source) -> Self {
        match source {
            Source::Udp => Self::Udp,
            Source::Msp => Self::Msp,
            Source::Sticks => Self::Sticks,
        }
    }
}

impl From<CliMode> for Mode {
    fn from(mode: CliMode) -> Self {
        match mode {
            CliMode::Interactive => Self::Interactive,
            CliMode::Framed => Self::Framed,
            CliMode::Message => Self::Message,
            CliMode::File => Self::File,
        }
    }
}

impl From<Mode> for CliMode {
    fn from(mode: Mode) -> Self {
        match mode {
            Mode::Interactive => Self::Interactive,
            Mode::Framed => Self::Framed,
            Mode::Message => Self::Message,
            Mode::File => Self::File,
        }
    }
}

impl From<CliSession> for Session {
    fn from(session: CliSession) -> Self {
        match session {
            CliSession::Console => Self::Console,
            CliSession::Client(number) => Self::Client(number),
            CliSession::Single(mode) => Self::Single(mode.into()),
        }
    }
}

impl From<Session> for CliSession {
    fn from(session: Session) -> Self {
        match session {
            Session::Console => Self::Console,
            Session::Client(number) => Self::Client(number),
            Session::Single(mode) => Self::Single(mode.into()),
        }
    }
}

impl From<&VehicleCommand> for Input {
    fn from(command: &VehicleCommand) -> Self {
        match command {
            VehicleCommand::Rc(frame, source) => Self::Rc(frame.channels, (*source).into()),
            VehicleCommand::SticksFirst(first) => Self::SticksFirst(*first),
            VehicleCommand::BeginCli(session, mode) => Self::BeginCli((*session).into(), (*mode).into()),
            VehicleCommand::EndCli(session) => Self::EndCli((*session).into()),
            VehicleCommand::EndAllCli => Self::EndAllCli,
            VehicleCommand::Line(line) => Self::Line(line.session.into(), line.line.clone()),
            VehicleCommand::Upload(upload) => Self::Upload {
                waypoints: Box::new(upload.plan.waypoints.clone()),
                settings: upload.settings.clone(),
            },
            VehicleCommand::Message(message) => {
                let clock = message.clock.map(|UtcTime { unix_s, millis }| (unix_s, millis));
                Self::Msp(message.code, message.payload.clone(), clock)
            }
            VehicleCommand::CliOpened => Self::CliOpened,
            VehicleCommand::CliClosed => Self::CliClosed,
            VehicleCommand::Restart(configuration) => Self::Restart(to_text(configuration)),
            VehicleCommand::ReturnHome => Self::ReturnHome,
            VehicleCommand::InFlight(InFlightCommand::GoTo(index)) => Self::GoTo(*index),
            VehicleCommand::InFlight(InFlightCommand::HoldHere) => Self::HoldHere,
            VehicleCommand::InFlight(InFlightCommand::Resume) => Self::GoOn,
            VehicleCommand::CancelReturn => Self::CancelReturn,
            VehicleCommand::Sticks(frame) => Self::Sticks(frame.channels),
            VehicleCommand::CutRc(cut) => Self::CutRc(*cut),
            VehicleCommand::HoldChannel(input) => Self::Hold(input.to_string()),
            VehicleCommand::ReleaseChannel(channel) => Self::Release(*channel),
            VehicleCommand::StartPilot(takeoff_m) => Self::Pilot(*takeoff_m),
            VehicleCommand::StopPilot => Self::PilotOff,
            VehicleCommand::World(command) => Self::World(command.to_string()),
            VehicleCommand::ResetCraft => Self::Reset,
        }
    }
}

impl Input {
    /// Returns the command.
    ///
    /// # Errors
    /// Returns the value that cannot be used, the end of a sentence.
    pub(super) fn command(self) -> Result<VehicleCommand, String> {
        Ok(match self {
            Self::Rc(channels, source) => VehicleCommand::Rc(RcFrame { channels }, source.into()),
            Self::SticksFirst(first) => VehicleCommand::SticksFirst(first),
            Self::BeginCli(session, mode) => VehicleCommand::BeginCli(session.into(), mode.into()),
            Self::EndCli(session) => VehicleCommand::EndCli(session.into()),
            Self::EndAllCli => VehicleCommand::EndAllCli,
            Self::Line(session, line) => VehicleCommand::line(session.into(), line),
            Self::Upload { waypoints, settings } => {
                VehicleCommand::upload(FlightPlan { waypoints: *waypoints }, settings)
            }
            Self::Msp(code, payload, clock) => {
                let clock = clock.map(|(unix_s, millis)| UtcTime { unix_s, millis });
                Message { code, payload, clock }.into()
            }
            Self::CliOpened => VehicleCommand::CliOpened,
            Self::CliClosed => VehicleCommand::CliClosed,
            Self::Restart(records) => {
                let (mut configuration, _) =
                    from_text(&records).map_err(|error| format!("a restart: {error}"))?;
                correct(&mut configuration);
                VehicleCommand::Restart(Box::new(configuration))
            }
            Self::ReturnHome => VehicleCommand::ReturnHome,
            Self::GoTo(index) => VehicleCommand::InFlight(InFlightCommand::GoTo(index)),
            Self::HoldHere => VehicleCommand::InFlight(InFlightCommand::HoldHere),
            Self::GoOn => VehicleCommand::InFlight(InFlightCommand::Resume),
            Self::CancelReturn => VehicleCommand::CancelReturn,
            Self::Sticks(channels) => VehicleCommand::Sticks(RcFrame { channels }),
            Self::CutRc(cut) => VehicleCommand::CutRc(cut),
            Self::Hold(text) => VehicleCommand::HoldChannel(text.parse()?),
            Self::Release(channel) => VehicleCommand::ReleaseChannel(channel),
            Self::Pilot(takeoff_m) if (0.0..=MAX_TAKEOFF_M).contains(&takeoff_m) => {
                VehicleCommand::StartPilot(takeoff_m)
            }
            Self::Pilot(takeoff_m) => {
                return Err(format!("a climb to {takeoff_m} m; allowed are 0 to {MAX_TAKEOFF_M} m"));
            }
            Self::PilotOff => VehicleCommand::StopPilot,
            Self::World(text) => VehicleCommand::World(Box::new(
                WorldCommand::parse(&text).map_err(|error| error.to_string())?,
            )),
            Self::Reset => VehicleCommand::ResetCraft,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::config::Configuration;

    fn round_trip(command: &VehicleCommand) -> VehicleCommand {
        let line = serde_json::to_string(&Input::from(command)).unwrap();
        serde_json::from_str::<Input>(&line).unwrap().command().unwrap()
    }

    #[test]
    fn every_command_is_read_as_it_was_written() {
        let mut frame = RcFrame::SAFE;
        frame.channels[3] = 1234;
        let mut configuration = Configuration::default();
        configuration.starter_modes();
        configuration.board_name = "QUAD".to_owned();
        let client = CliSession::Client(u64::MAX);
        let world = |text: &str| VehicleCommand::World(Box::new(WorldCommand::parse(text).unwrap()));
        let plan = crate::plan::builtin::BuiltinPlan::find("square").unwrap().read().unwrap();
        for command in [
            VehicleCommand::Rc(frame, RcSource::Udp),
            VehicleCommand::Rc(frame, RcSource::Msp),
            VehicleCommand::SticksFirst(true),
            VehicleCommand::BeginCli(client, CliMode::Framed),
            VehicleCommand::EndCli(CliSession::Console),
            VehicleCommand::EndAllCli,
            VehicleCommand::line(client, "set ap_max_angle = 25\u{1b}\u{fffd}"),
            VehicleCommand::single_line("status"),
            VehicleCommand::upload(plan.plan, plan.settings),
            Message {
                code: 222,
                payload: (0..=255).collect(),
                clock: Some(UtcTime { unix_s: 7, millis: 8 }),
            }
            .into(),
            Message::of(68, Vec::new()).into(),
            VehicleCommand::CliOpened,
            VehicleCommand::CliClosed,
            VehicleCommand::Restart(Box::new(configuration)),
            VehicleCommand::ReturnHome,
            VehicleCommand::InFlight(InFlightCommand::GoTo(255)),
            VehicleCommand::InFlight(InFlightCommand::HoldHere),
            VehicleCommand::InFlight(InFlightCommand::Resume),
            VehicleCommand::CancelReturn,
            VehicleCommand::Sticks(frame),
            VehicleCommand::CutRc(false),
            VehicleCommand::HoldChannel("aux2=1000@boot+61.000125,0.3".parse().unwrap()),
            VehicleCommand::ReleaseChannel(15),
            VehicleCommand::StartPilot(0.1 + 0.2),
            VehicleCommand::StopPilot,
            world("wind=0.30000000000000004@12.3"),
            world("fault=motor,0.1,2:0.8"),
            world("fault=gps-loss@boot+20.1,6"),
            world("ground=slope,8,90"),
            world("end=motor:2"),
            VehicleCommand::ResetCraft,
        ] {
            assert_eq!(round_trip(&command), command);
        }
    }

    #[test]
    fn a_value_beyond_its_bounds_is_refused() {
        for text in ["{\"pilot\":1e300}", "{\"hold\":\"aux99=1000@1\"}", "{\"world\":\"wind=500@0\"}"] {
            let input: Input = serde_json::from_str(text).unwrap();
            assert!(input.command().is_err(), "{text}");
        }
        for text in [
            "{\"rc\":[[1500],\"udp\"]}",
            "{\"later\":1}",
            "{\"upload\":{\"waypoints\":[],\"settings\":[],\"x\":1}}",
        ] {
            assert!(serde_json::from_str::<Input>(text).is_err(), "{text}");
        }
    }
}
