//! Decides which requests of the user are allowed now. Keys, the palette, the `:` line and the session give the reason for a refusal
//! in its words.

use std::fmt;

use super::command::{Command, SessionView};
use crate::fc::{
    Access, Denial, Impact, NOTHING_MOVES, NOTHING_SIMULATED, RemoteState, RemoteView, UploadView,
};
use crate::flight::forecast::{CONTROLLER_IS_REMOTE, PHYSICS_IS_EXTERNAL, SETTINGS_UNKNOWN};
use crate::telemetry::LinkState;
use crate::vehicle::{CommandKind, VehicleCommand};

/// Refusal to pause, step or accelerate time with an external simulator.
pub const TIME_IS_EXTERNAL: &str = "The simulator sets the time: pause it or change its speed there.";

/// Refusal to pause, step or accelerate time with a remote flight controller.
pub const TIME_IS_THE_FIRMWARES: &str =
    "The remote firmware runs on the wall clock: time cannot be paused, stepped or made faster.";

/// Refusal to put the craft back home with an external simulator.
pub const PLACE_IS_EXTERNAL: &str =
    "The simulator places the craft: reset its world there, and the firmware restarts by itself.";

/// Refusal to rewind a flight whose flight controller is remote.
pub const NOT_RECORDED: &str = "The flight controller runs on the wall clock: its time cannot be rewound.";

/// Refusal to continue the flight of a remote firmware from an earlier instant.
pub const NOT_FLOWN_AGAIN: &str =
    "The flight of this remote firmware is recorded as pictures: it can be looked at, not flown again.";

/// Refusal of everything but the recording after the flight of a firmware that has ended.
pub const FIRMWARE_ENDED: &str =
    "The flight is over and its firmware has ended: `,` and `<` go back, Space plays the recording.";

/// Refusal of everything but looking at a flight that was recorded.
pub const RECORDED: &str = "This is a recorded flight: it can be looked at, not flown or changed.";

/// Refusal of another flight of the file, without a file.
pub const NO_FILE: &str = "Only a file with recorded flights has others to show.";

/// Refusal of control inputs while an earlier instant is shown.
pub const REWOUND: &str = "An earlier instant is shown: `b` flies on from here, `e` goes back to the end.";

/// The refusal for a flight controller without waypoints.
const NO_PLANS: &str = "This flight controller has no waypoints: today's master has flight plans (board \
                        or SITL), older firmware does not.";

/// The refusal for orders to the navigator of another program.
const NO_ORDERS: &str = "A remote firmware takes no such order in flight: switch the autopilot off and fly there, or upload another plan.";

/// The refusal for a firmware that has not yet reported its settings.
pub const NOT_KNOWN_YET: &str =
    "The remote firmware has not reported its identity and switches: wait until it answers.";

/// The facts on which the policy depends.
#[derive(Debug, Clone, Copy)]
pub struct Facts {
    /// The access to the craft.
    pub access: Access,
    pub remote: Option<RemoteFacts>,
    /// The link to the external simulator.
    pub simulator: Option<LinkState>,
    /// The current upload.
    pub upload: Option<UploadView>,
    /// `true` while the scripted pilot flies.
    pub is_piloted: bool,
    /// `true` if the flight is recorded.
    pub is_recorded: bool,
    /// `true` if the flight cannot be continued from an earlier instant.
    pub cannot_continue: bool,
    /// `true` if the flight controller is a remote firmware that has ended for good.
    pub has_ended: bool,
    /// `true` while an earlier instant is shown.
    pub is_rewound: bool,
    /// `true` if a recorded flight is shown, without a vehicle.
    pub is_replay: bool,
}

/// The facts about a remote flight controller.
#[derive(Debug, Clone, Copy)]
pub struct RemoteFacts {
    /// `true` if it has reported its identity and settings.
    is_ready: bool,
    has_plans: bool,
    /// `true` if estimates can fly with its settings.
    knows_settings: bool,
    /// `true` if a line would have to open its command line, which is itself a change.
    opens_cli: bool,
    /// `true` if its time is that of the session.
    is_in_steps: bool,
}

impl From<&RemoteView> for RemoteFacts {
    fn from(remote: &RemoteView) -> Self {
        let &RemoteView { has_plans, knows_settings, opens_cli, is_in_steps, .. } = remote;
        let is_ready = remote.state == RemoteState::Ready;
        Self { is_ready, has_plans, knows_settings, opens_cli, is_in_steps }
    }
}

impl From<&SessionView> for Facts {
    fn from(view: &SessionView) -> Self {
        Self {
            access: view.remote.as_ref().map_or(Access::Everything, |remote| remote.access),
            remote: view.remote.as_ref().map(RemoteFacts::from),
            simulator: view.simulator,
            upload: view.upload,
            is_piloted: view.pilot.is_some(),
            is_recorded: view.timeline.is_some(),
            cannot_continue: view.timeline.as_ref().is_some_and(|timeline| timeline.cannot_continue),
            has_ended: view.remote.is_none()
                && view.timeline.as_ref().is_some_and(|timeline| timeline.is_pictures),
            is_rewound: view.is_rewound(),
            is_replay: view.replay.is_some(),
        }
    }
}

/// The purpose of a request, as far as the policy distinguishes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Intent {
    /// Reads, or changes only what is shown.
    Read,
    /// Pauses, steps or accelerates time.
    Time,
    /// Shows another instant of the recording.
    Recording,
    /// Shows another flight of the recorded file.
    OtherFlight,
    /// Flies on from an earlier instant.
    FlyOn,
    /// Starts the scripted pilot, or stops it.
    Fly,
    /// Moves a switch or a stick, or makes the craft fly elsewhere.
    Move,
    /// Gives an order to the navigator in flight.
    Order,
    /// Puts the craft back home.
    Reset,
    /// Changes the air, the noise or a fault.
    World,
    Upload,
    Download,
    /// Stores the configuration.
    Save,
    /// Runs a line with this impact, or exchanges such a message.
    Line(Impact),
    /// Flies a copy of the vehicle from home, or many copies.
    Forecast,
    /// Flies the present flight ahead on a copy of the vehicle.
    FlyAhead,
}

impl Intent {
    /// Returns the intent of a command.
    pub fn of(command: &Command) -> Self {
        match command {
            Command::Pause(_) | Command::Step(_) | Command::Speed(_) => Self::Time,
            Command::Seek(_) => Self::Recording,
            Command::ShowFlight(_) => Self::OtherFlight,
            Command::FlyOn => Self::FlyOn,
            Command::Vehicle(command) => Self::from_vehicle(command),
            Command::StartPilot => Self::Fly,
            Command::Cli { line, .. } => Self::Line(Impact::from_line(line)),
            Command::Upload { .. } => Self::Upload,
            Command::Download { .. } => Self::Download,
            Command::ReadSettings { .. } => Self::Line(Impact::Reads),
            Command::Save { .. } => Self::Save,
            Command::World { .. } => Self::World,
            Command::CopyVehicle { continues: true, .. } => Self::FlyAhead,
            Command::CopyVehicle { .. } => Self::Forecast,
            Command::RecordedFlight(_)
            | Command::Curves { .. }
            | Command::CopyRecording(_)
            | Command::PermitChanges(_)
            | Command::Quit => Self::Read,
        }
    }

    fn from_vehicle(command: &VehicleCommand) -> Self {
        match (command.kind(), command) {
            (_, VehicleCommand::Line(line)) => Self::Line(Impact::from_line(&line.line)),
            (_, VehicleCommand::Message(message)) => {
                Self::Line(Impact::from_message(message.code, &message.payload))
            }
            (_, VehicleCommand::Upload(_)) => Self::Upload,
            (CommandKind::Configuration, _) => Self::Line(Impact::Changes),
            (CommandKind::Session, _) => Self::Read,
            (CommandKind::Reset, _) => Self::Reset,
            (CommandKind::World, _) => Self::World,
            (CommandKind::Order, _) => Self::Order,
            (CommandKind::Pilot, _) => Self::Fly,
            (CommandKind::Rc | CommandKind::Return, _) => Self::Move,
        }
    }

    /// Returns the impact on a real craft. Time and forecasts have their own rules.
    fn impact(self, facts: &Facts) -> Impact {
        let opens_cli = facts.remote.is_some_and(|remote| remote.opens_cli);
        match self {
            Self::Read
            | Self::Time
            | Self::Recording
            | Self::OtherFlight
            | Self::FlyOn
            | Self::Forecast
            | Self::FlyAhead => Impact::Reads,
            Self::Download => Impact::Reads.or_changes(opens_cli),
            Self::Line(impact) => impact.or_changes(opens_cli),
            Self::Upload | Self::Save => Impact::Changes,
            Self::Fly | Self::Move | Self::Order => Impact::Forbidden(NOTHING_MOVES),
            Self::Reset | Self::World => Impact::Forbidden(NOTHING_SIMULATED),
        }
    }

    /// Returns `true` if it needs the vehicle that flies, which waits while an earlier instant is shown.
    fn needs_newest(self) -> bool {
        match self {
            Self::Read
            | Self::Time
            | Self::Recording
            | Self::OtherFlight
            | Self::FlyOn
            | Self::Forecast
            | Self::FlyAhead => false,
            Self::Line(impact) => impact != Impact::Reads,
            Self::Fly
            | Self::Move
            | Self::Order
            | Self::Reset
            | Self::World
            | Self::Upload
            | Self::Download
            | Self::Save => true,
        }
    }
}

/// The reason for a refusal. `Display` gives a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// The craft is real.
    Access(Denial),
    /// It is impossible now.
    Now(&'static str),
    /// Another upload is under way.
    Uploading(UploadView),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Access(denial) => denial.fmt(f),
            Self::Now(sentence) => f.write_str(sentence),
            Self::Uploading(upload) => {
                let UploadView { sent, total } = upload;
                write!(f, "An upload is under way, line {sent} of {total}: wait for its end.")
            }
        }
    }
}

/// A rule: the sentence of the refusal, and the requests and facts that it applies to.
type Rule = (&'static str, fn(&Facts, Intent) -> bool);

/// The rules for a craft whose access allows the request. The first that applies refuses it.
const RULES: [Rule; 17] = [
    (RECORDED, |facts, intent| {
        let looks = matches!(intent, Intent::Read | Intent::Time | Intent::Recording | Intent::OtherFlight);
        facts.is_replay && !looks
    }),
    (NO_FILE, |facts, intent| intent == Intent::OtherFlight && !facts.is_replay),
    (FIRMWARE_ENDED, |facts, intent| {
        let looks = matches!(intent, Intent::Read | Intent::Recording | Intent::FlyOn);
        facts.has_ended && !looks && !(facts.is_rewound && intent == Intent::Time)
    }),
    (NO_ORDERS, |facts, intent| intent == Intent::Order && facts.remote.is_some()),
    (NOT_KNOWN_YET, |facts, intent| {
        intent == Intent::Fly && facts.remote.is_some_and(|remote| !remote.is_ready)
    }),
    (NO_PLANS, |facts, intent| intent == Intent::Fly && facts.remote.is_some_and(|remote| !remote.has_plans)),
    (NO_PLANS, |facts, intent| {
        matches!(intent, Intent::Upload | Intent::Download)
            && facts.remote.is_some_and(|remote| remote.is_ready && !remote.has_plans)
    }),
    (TIME_IS_EXTERNAL, |facts, intent| {
        matches!(intent, Intent::Time | Intent::Recording | Intent::FlyOn) && facts.simulator.is_some()
    }),
    (TIME_IS_THE_FIRMWARES, |facts, intent| {
        intent == Intent::Time && facts.remote.is_some_and(|remote| !remote.is_in_steps)
    }),
    (NOT_RECORDED, |facts, intent| matches!(intent, Intent::Recording | Intent::FlyOn) && !facts.is_recorded),
    (NOT_FLOWN_AGAIN, |facts, intent| intent == Intent::FlyOn && facts.cannot_continue),
    (REWOUND, |facts, intent| facts.is_rewound && intent.needs_newest()),
    (PLACE_IS_EXTERNAL, |facts, intent| {
        intent == Intent::Reset && facts.simulator == Some(LinkState::Flowing)
    }),
    (SETTINGS_UNKNOWN, |facts, intent| {
        intent == Intent::Forecast && facts.remote.is_some_and(|remote| !remote.knows_settings)
    }),
    (CONTROLLER_IS_REMOTE, |facts, intent| {
        let can_fly_ahead = |remote: RemoteFacts| remote.is_in_steps && facts.is_recorded;
        intent == Intent::FlyAhead && facts.remote.is_some_and(|remote| !can_fly_ahead(remote))
    }),
    (NOT_FLOWN_AGAIN, |facts, intent| intent == Intent::FlyAhead && facts.cannot_continue),
    (PHYSICS_IS_EXTERNAL, |facts, intent| {
        matches!(intent, Intent::Forecast | Intent::FlyAhead) && facts.simulator.is_some()
    }),
];

/// Checks that a request is allowed.
///
/// # Errors
/// Returns the reason for the refusal. A missing permission is the last reason, because the user can give it.
pub fn check(facts: &Facts, intent: Intent) -> Result<(), Refusal> {
    let access = facts.access.check(intent.impact(facts)).map_err(Refusal::Access);
    if let Err(Refusal::Access(Denial::Never(_))) = access {
        return access;
    }
    if let Some((sentence, _)) = RULES.iter().find(|(_, applies)| applies(facts, intent)) {
        return Err(Refusal::Now(sentence));
    }
    match facts.upload {
        // The lines of two uploads would mix.
        Some(upload) if intent == Intent::Upload || intent == Intent::Fly && !facts.is_piloted => {
            Err(Refusal::Uploading(upload))
        }
        _ => access,
    }
}

#[cfg(test)]
mod tests;
