//! Inputs to the craft during a flight, and their instants.

use super::expression::{Cursor, Instant, SyntaxError};
use crate::pilot::{channel_index, pulse_us};
use crate::plan::{FlightPlan, MAX_WAYPOINTS};
use crate::signals::{RC_CHANNELS, RcFrame};
use crate::sim::WorldCommand;
use crate::telemetry::{InFlightCommand, Mode};
use crate::vehicle::{CliSession, VehicleCommand};

/// An input and its instant.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedInput {
    /// The name for use in instants; `inputN` if the file gives none.
    pub name: String,
    /// Line in the scenario's file, from 1.
    pub line: usize,
    /// The instant.
    pub at: Instant,
    /// `true` if the input is repeated each time the instant comes.
    pub each: bool,
    /// The action.
    pub action: Action,
    /// The text in the file.
    pub text: String,
}

/// An action on the craft.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// A command to the vehicle.
    Vehicle(VehicleCommand),
    /// Holds a channel at a value, for a number of seconds or until its release.
    Stick {
        /// Index from 0.
        channel: u8,
        /// Value, µs.
        value_us: u16,
        /// The time, s; `None` = until its release.
        for_s: Option<f64>,
    },
    /// The switch of a mode.
    Switch(Mode, bool),
    /// Cuts off the transmitter, for a number of seconds or until it is restored.
    CutRc(Option<f64>),
    /// Restores the transmitter.
    RestoreRc,
}

/// The forms of an input, for messages and the reference: the syntax and the effect.
pub const FORMS: &[(&str, &str)] = &[
    (
        "stick pitch 2000 for 3 s",
        "holds a channel (roll, pitch, throttle, yaw, aux1 to aux12, or 1 to 16), µs; without `for` until it is released",
    ),
    ("release pitch", "gives a channel back to the pilot"),
    ("switch AUTOPILOT off", "moves the channel that switches a mode"),
    ("rc cut for 10 s", "the transmitter is off; without `for` until `rc restore`"),
    ("rc restore", "the transmitter is on again"),
    ("cli set ap_max_velocity = 800", "types a line on the command line"),
    ("upload other.toml", "uploads a plan: a file, or a built-in plan's name"),
    ("return home", "the command to fly home and land"),
    ("cancel return", "takes that command back"),
    ("go to 2", "flies to a waypoint now"),
    ("hold here", "holds place and altitude"),
    ("go on", "goes on after a hold"),
    ("pilot 10", "the scripted pilot arms, climbs to so many metres and engages"),
    ("pilot off", "the scripted pilot lets go of the sticks"),
    ("sticks 1500 1500 1000 1500 1900 …", "sets all sixteen virtual channels, µs"),
    (
        "wind 5@270",
        "any change of the air: wind, gust, gust-now, turbulence, noise, gps-rate and the world's switches",
    ),
    ("fault gps-loss,6", "a fault as NAME[,FOR][,VALUE], such as push, teleport, motor, payload"),
    ("end gps-loss", "ends a fault; `end all` ends all"),
];

/// A reader for the plans that inputs name.
pub(super) type PlanReader<'r> = &'r mut dyn FnMut(&str) -> Result<FlightPlan, String>;

/// Reads the action of an input.
pub(super) fn read_action(text: &str, plans: PlanReader<'_>) -> Result<Action, SyntaxError> {
    let trimmed = text.trim();
    let (word, rest) = trimmed.split_once(char::is_whitespace).unwrap_or((trimmed, ""));
    let rest = rest.trim();
    let whole =
        |message: String, hint: &str| SyntaxError { span: 0..text.len(), message, hint: hint.to_owned() };
    let words: Vec<&str> = rest.split_whitespace().collect();
    Ok(match (word, words.as_slice()) {
        ("stick", [channel, value, span @ ..]) => Action::Stick {
            channel: channel_index(channel).map_err(|problem| whole(problem, ""))?,
            value_us: pulse_us(value).map_err(|problem| whole(problem, ""))?,
            for_s: read_for(span)
                .ok_or_else(|| whole("the duration is not understood".to_owned(), "write for 3 s"))?,
        },
        ("release", [channel]) => {
            let channel = channel_index(channel).map_err(|problem| whole(problem, ""))?;
            Action::Vehicle(VehicleCommand::ReleaseChannel(channel))
        }
        ("sticks", values) => {
            let frame = read_sticks(values).map_err(|problem| whole(problem, ""))?;
            Action::Vehicle(VehicleCommand::Sticks(frame))
        }
        ("switch", [.., position @ ("on" | "off")]) => {
            let name = rest[..rest.len() - position.len()].trim();
            let mut cursor = Cursor::new(name);
            let mode = super::expression::read_mode(&mut cursor)
                .map_err(|error| whole(error.message, &error.hint))?;
            Action::Switch(mode, *position == "on")
        }
        ("rc", ["cut", span @ ..]) => Action::CutRc(
            read_for(span)
                .ok_or_else(|| whole("the duration is not understood".to_owned(), "write for 3 s"))?,
        ),
        ("rc", ["restore"]) => Action::RestoreRc,
        ("cli", [_, ..]) => Action::Vehicle(VehicleCommand::line(CliSession::Console, rest)),
        ("upload", [_, ..]) => {
            let plan = plans(rest).map_err(|problem| whole(problem, ""))?;
            Action::Vehicle(VehicleCommand::upload(plan, Vec::new()))
        }
        ("return", ["home"]) => Action::Vehicle(VehicleCommand::ReturnHome),
        ("cancel", ["return"]) => Action::Vehicle(VehicleCommand::CancelReturn),
        ("go", ["on"]) => Action::Vehicle(VehicleCommand::InFlight(InFlightCommand::Resume)),
        ("go", ["to", wp]) => match wp.parse() {
            Ok(wp) => Action::Vehicle(VehicleCommand::InFlight(InFlightCommand::GoTo(wp))),
            Err(_) => return Err(whole(format!("{wp} is not the number of a waypoint"), "write go to 2")),
        },
        ("hold", ["here"]) => Action::Vehicle(VehicleCommand::InFlight(InFlightCommand::HoldHere)),
        ("pilot", ["off"]) => Action::Vehicle(VehicleCommand::StopPilot),
        ("pilot", [height]) => match height.parse::<f64>() {
            Ok(height) if (0.0..=500.0).contains(&height) => {
                Action::Vehicle(VehicleCommand::StartPilot(height))
            }
            _ => return Err(whole(format!("{height} is not a height"), "allowed: 0 to 500, metres")),
        },
        (
            "stick" | "release" | "switch" | "rc" | "cli" | "upload" | "return" | "cancel" | "go" | "hold"
            | "pilot",
            _,
        ) => {
            let form = FORMS.iter().find(|(form, _)| form.starts_with(word)).map_or("", |(form, _)| form);
            return Err(whole(format!("{trimmed} is not understood"), &format!("write {form}")));
        }
        _ => {
            return world(trimmed).map_err(|problem| whole(problem, "docs/scenarios.md lists the inputs"));
        }
    })
}

/// Returns the least number of waypoints of the stored plan after an input that uploads a plan or inserts a waypoint;
/// `None` for other inputs.
pub(super) fn waypoints_after(text: &str, plans: PlanReader<'_>) -> Option<usize> {
    let words: Vec<&str> = text.split_whitespace().collect();
    match words.as_slice() {
        ["upload", ..] => match read_action(text, plans) {
            Ok(Action::Vehicle(VehicleCommand::Upload(upload))) => Some(upload.plan.waypoints.len()),
            _ => None,
        },
        ["cli", "waypoint", "insert", index, ..] => {
            index.parse::<usize>().ok().filter(|index| *index < MAX_WAYPOINTS).map(|index| index + 1)
        }
        _ => None,
    }
}

/// Reads a change of the world. If the first word is unknown, the suggestion comes from the words of all inputs.
fn world(text: &str) -> Result<Action, String> {
    let world = |command| Action::Vehicle(VehicleCommand::World(Box::new(command)));
    WorldCommand::parse(text).map(world).map_err(|error| {
        let problem = error.problem().to_owned();
        let word = text.split(['=', ' ']).next().unwrap_or_default();
        let firsts = FORMS.iter().filter_map(|(form, _)| form.split(' ').next());
        match crate::text::did_you_mean::closest(word, firsts) {
            Some(meant) if problem.starts_with("there is no") && meant != word => {
                format!("there is no input {word}; did you mean {meant}?")
            }
            _ => problem,
        }
    })
}

/// Reads `for 3 s`, or nothing.
fn read_for(words: &[&str]) -> Option<Option<f64>> {
    match words {
        [] => Some(None),
        ["for", seconds, "s"] => seconds.parse().ok().filter(|s| (0.0..1e6).contains(s)).map(Some),
        _ => None,
    }
}

fn read_sticks(values: &[&str]) -> Result<RcFrame, String> {
    if values.len() != RC_CHANNELS {
        return Err(format!("sticks sets {RC_CHANNELS} channels, {} are given", values.len()));
    }
    let mut frame = RcFrame::SAFE;
    for (channel, value) in frame.channels.iter_mut().zip(values) {
        *channel = pulse_us(value)?;
    }
    Ok(frame)
}
