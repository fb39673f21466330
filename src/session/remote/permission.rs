//! What may be done with a craft outside: reading is free, changes are permitted once a connection, nothing moves it.

use std::fmt;

use crate::firmware::msp::{Access as MessageAccess, MESSAGES};
use crate::link::proto::fc_client::{Answer, CliAccess, Unanswered};

/// Why an order that would move a craft outside is not carried out.
pub const NOTHING_MOVES: &str =
    "This craft is real: it is armed, flown and its motors are turned by its own transmitter, not from here.";

/// Why the world of a craft outside cannot be changed.
pub const NOTHING_SIMULATED: &str =
    "Nothing is simulated here: this craft is real, and so are its place and its air.";

/// Why a change is not made that the user has not permitted.
pub const NOT_PERMITTED: &str =
    "Changes are not permitted over this connection: the command allow-changes permits them.";

/// Why a line or message that takes the port away is not passed on.
const TAKES_PORT: &str =
    "The port would carry something else then, and this connection would end: do it in another program.";

/// What may be done with a flight controller outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Everything: its craft is simulated here.
    Everything,
    /// Reading, until the user permits changes.
    Reading,
    /// Reading and changing, until the connection ends.
    Changing,
}

/// What a request does to a craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Impact {
    /// It is only read.
    Reads,
    /// Its configuration or plan changes, or it restarts.
    Changes,
    /// It moves, or is out of reach, for this reason.
    Forbidden(&'static str),
}

/// Why something is not done now. `Display` gives a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Denial {
    /// The user has not permitted changes over this connection.
    NotPermitted,
    /// It is never done: why, as a sentence.
    Never(&'static str),
}

impl fmt::Display for Denial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotPermitted => NOT_PERMITTED,
            Self::Never(why) => why,
        })
    }
}

impl Access {
    /// Whether something with this impact may be done.
    ///
    /// # Errors
    /// Why not.
    pub fn check(self, impact: Impact) -> Result<(), Denial> {
        match (self, impact) {
            (Self::Everything, _) | (_, Impact::Reads) | (Self::Changing, Impact::Changes) => Ok(()),
            (_, Impact::Forbidden(why)) => Err(Denial::Never(why)),
            (Self::Reading, Impact::Changes) => Err(Denial::NotPermitted),
        }
    }

    /// Whether the craft is real.
    #[must_use]
    pub fn is_limited(self) -> bool {
        self != Self::Everything
    }
}

/// What the user has permitted over the present connection.
#[derive(Debug, Default)]
pub(super) struct Permission {
    /// The number of the connection.
    connection: u32,
    may_change: bool,
    /// What became of lines so far.
    lines: Lines,
}

/// What became of the lines of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Lines {
    #[default]
    NoneYet,
    /// None was answered: the craft is armed, or its command line has no framing.
    Closed,
    /// One was answered.
    Work,
}

impl Permission {
    /// There is a new connection, over which nothing is permitted yet.
    pub(super) fn connected(&mut self) {
        *self = Self { connection: self.connection + 1, ..Self::default() };
    }

    /// The connection is gone.
    pub(super) fn lost(&mut self) {
        self.may_change = false;
    }

    /// The user permits changes over a connection; one that is gone does not matter any more.
    pub(super) fn permit(&mut self, connection: u32) {
        self.may_change |= connection == self.connection;
    }

    /// Takes in what became of a line.
    pub(super) fn line_answered(&mut self, answer: &Answer) {
        self.lines = match answer {
            Answer::Line { .. } => Lines::Work,
            Answer::NotAnswered(Unanswered::CliClosed) if self.lines == Lines::NoneYet => Lines::Closed,
            Answer::NotAnswered(_) | Answer::Msp(_) => self.lines,
        };
    }

    /// The number of the connection.
    pub(super) fn connection(&self) -> u32 {
        self.connection
    }

    /// Whether a line would have to open the command line of a disarmed craft, which is a change itself.
    pub(super) fn opens_cli(&self) -> bool {
        self.lines == Lines::Closed
    }

    /// How lines reach the command line.
    pub(super) fn cli(&self) -> CliAccess {
        if self.opens_cli() && self.may_change { CliAccess::Interactive } else { CliAccess::Framed }
    }

    /// What may be done with a real craft.
    pub(super) fn access(&self) -> Access {
        if self.may_change { Access::Changing } else { Access::Reading }
    }
}

/// Lines that only print, whatever stands behind the word.
const PRINT: [&str; 18] = [
    "get",
    "status",
    "version",
    "diff",
    "dump",
    "help",
    "tasks",
    "env",
    "options",
    "mcu_id",
    "sensor_hardware",
    "rc_smoothing_info",
    "gyroregisters",
    "dshot_telemetry_info",
    "flash_info",
    "sd_info",
    "vtx_info",
    "displayport_info",
];

/// Lines that print when nothing stands behind the word, or one of [`LIST`].
const PRINT_ALONE: [&str; 31] = [
    "adjrange",
    "aux",
    "battery_profile",
    "beacon",
    "beeper",
    "board_name",
    "color",
    "dma",
    "feature",
    "led",
    "manufacturer_id",
    "map",
    "mixer",
    "mmix",
    "mode_color",
    "profile",
    "rateprofile",
    "resource",
    "rxfail",
    "rxrange",
    "serial",
    "servo",
    "signature",
    "simplified_tuning",
    "smix",
    "timer",
    "vtx",
    "vtxtable",
    "waypoint",
    "motor",
    "set",
];

/// Words behind a command that have it print.
const LIST: [&str; 4] = ["list", "show", "status", "all"];

/// Lines that turn motors.
const MOVE: [&str; 3] = ["motor", "dshotprog", "escprog"];

/// Lines after which the port carries something else.
const TAKE_PORT: [&str; 5] = ["serialpassthrough", "gpspassthrough", "bl", "dfu", "msc"];

/// Messages that move a craft: SET_RAW_RC, SET_RAW_GPS, SET_MOTOR, SEND_DSHOT_COMMAND.
const MOVING_MESSAGES: [u16; 4] = [200, 201, 214, 0x3003];
/// Tells the time of day, as configurators do at every connection.
const SET_RTC: u16 = 246;
/// Opens a way through the port to something behind it.
const SET_PASSTHROUGH: u16 = 245;
/// Restarts; with a payload other than 0 into a boot loader or as a disk.
const REBOOT: u16 = 68;

impl Impact {
    /// At least a change, if `changes`.
    #[must_use]
    pub fn or_changes(self, changes: bool) -> Self {
        if changes { self.max(Self::Changes) } else { self }
    }

    /// What a line of the command line does; of several lines the worst.
    #[must_use]
    pub fn of_line(line: &str) -> Self {
        line.split(['\r', '\n']).map(Self::of_single_line).max().unwrap_or(Self::Reads)
    }

    fn of_single_line(line: &str) -> Self {
        let line = line.trim();
        let word_end = line.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(line.len());
        let (word, rest) = line.split_at(word_end);
        let (word, rest) = (word.to_ascii_lowercase(), rest.trim());
        let is_in = |words: &[&str]| words.contains(&word.as_str());
        // The firmware takes a name for typed when no letter or digit follows it.
        let may_be = |names: &[&str]| {
            names.iter().any(|name| {
                word.strip_prefix(name).is_some_and(|more| !more.starts_with(char::is_alphanumeric))
            })
        };
        let prints_alone = rest.is_empty() || LIST.contains(&rest.to_ascii_lowercase().as_str());
        match word.as_str() {
            "" if rest.is_empty() || rest.starts_with('#') => Self::Reads,
            _ if may_be(&TAKE_PORT) => Self::Forbidden(TAKES_PORT),
            // One that is named, without a value, is printed, too.
            "motor" if rest.split_whitespace().count() < 2 => Self::Reads,
            _ if may_be(&MOVE) => Self::Forbidden(NOTHING_MOVES),
            "set" if !rest.contains('=') => Self::Reads,
            _ if is_in(&PRINT) || is_in(&PRINT_ALONE) && prints_alone => Self::Reads,
            _ => Self::Changes,
        }
    }

    /// What an MSP message does. One that is not known here may change the craft.
    #[must_use]
    pub fn of_message(code: u16, payload: &[u8]) -> Self {
        let access = || {
            let at = MESSAGES.binary_search_by_key(&code, |message| message.code).ok()?;
            Some(MESSAGES[at].access)
        };
        match code {
            SET_RTC => Self::Reads,
            SET_PASSTHROUGH => Self::Forbidden(TAKES_PORT),
            REBOOT if payload.first().is_some_and(|kind| *kind != 0) => Self::Forbidden(TAKES_PORT),
            _ if MOVING_MESSAGES.contains(&code) => Self::Forbidden(NOTHING_MOVES),
            _ => match access() {
                Some(MessageAccess::Read | MessageAccess::Ask) => Self::Reads,
                Some(MessageAccess::Write) | None => Self::Changes,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::cli::COMMANDS;

    const MOVES: Impact = Impact::Forbidden(NOTHING_MOVES);

    #[test]
    fn lines_that_print_are_free() {
        for line in [
            "",
            "  ",
            "# a comment",
            "get ap_",
            "GET",
            "status",
            "version",
            "diff all",
            "dump",
            "help waypoint",
            "tasks",
            "waypoint list",
            "waypoint status",
            "waypoint",
            "aux",
            "feature",
            "feature list",
            "resource show",
            "set",
            "set ap_max_angle",
            "motor",
            "motor 1",
            "profile",
            "mixer list",
        ] {
            assert_eq!(Impact::of_line(line), Impact::Reads, "{line}");
        }
    }

    #[test]
    fn lines_that_change_or_are_unknown_ask() {
        for line in [
            "set ap_max_angle = 25",
            "set ap_max_angle=25",
            "SAVE",
            "save noreboot",
            "exit",
            "reboot",
            "defaults nosave",
            "batch start",
            "waypoint clear",
            "waypoint insert 0 1 2 3 4 FLYOVER 0 NONE",
            "waypoint list x",
            "aux 0 0 0 1700 2100 0 0",
            "feature GPS",
            "feature -GPS",
            "map AETR1234",
            "profile 1",
            "simplified_tuning apply",
            "getx",
            "flash_erase",
            "status\nsave",
            "= 1",
        ] {
            assert_eq!(Impact::of_line(line), Impact::Changes, "{line}");
        }
    }

    #[test]
    fn nothing_turns_a_motor_or_takes_the_port() {
        for line in [
            "motor 1 1500",
            "motor 255 1100",
            "MOTOR 0 1000",
            "dshotprog 0 1",
            "motor_0 1200",
            "get x\rmotor 0 1200",
        ] {
            assert_eq!(Impact::of_line(line), MOVES, "{line}");
        }
        for line in ["bl", "bl rom", "msc", "serialpassthrough 1", "gpspassthrough"] {
            assert_eq!(Impact::of_line(line), Impact::Forbidden(TAKES_PORT), "{line}");
        }
        for access in [Access::Reading, Access::Changing] {
            assert_eq!(access.check(MOVES), Err(Denial::Never(NOTHING_MOVES)));
        }
        assert_eq!(Access::Everything.check(MOVES), Ok(()), "a simulated craft is free");
    }

    #[test]
    fn every_command_of_the_embedded_firmware_is_sorted() {
        let reads = |name: &&str| Impact::of_line(name) == Impact::Reads;
        let others: Vec<&str> =
            COMMANDS.iter().map(|command| command.name).filter(|name| !reads(name)).collect();
        let changing_alone = [
            "batch",
            "bl",
            "defaults",
            "exit",
            "gpspassthrough",
            "play_sound",
            "reboot",
            "save",
            "serialpassthrough",
        ];
        assert_eq!(others, changing_alone);
    }

    #[test]
    fn messages_are_sorted_by_what_they_do() {
        let of = |code| Impact::of_message(code, &[]);
        for read in [1, 2, 101, 102, 105, 106, 109, 116, 150, 254, 0x3006] {
            assert_eq!(of(read), Impact::Reads, "{read}");
        }
        for write in [35, 202, 208, 209, 250, 9999] {
            assert_eq!(of(write), Impact::Changes, "{write}");
        }
        for moving in MOVING_MESSAGES {
            assert_eq!(of(moving), MOVES, "{moving}");
        }
        assert_eq!((of(68), Impact::of_message(68, &[0])), (Impact::Changes, Impact::Changes));
        assert_eq!(Impact::of_message(68, &[1]), Impact::Forbidden(TAKES_PORT));
        assert_eq!(of(245), Impact::Forbidden(TAKES_PORT));
    }

    #[test]
    fn a_permission_is_for_one_connection() {
        let mut permission = Permission::default();
        permission.connected();
        assert_eq!((permission.access(), permission.connection()), (Access::Reading, 1));
        permission.permit(1);
        assert_eq!(permission.access(), Access::Changing);
        permission.lost();
        assert_eq!(permission.access(), Access::Reading);
        permission.connected();
        permission.permit(1);
        assert_eq!(permission.access(), Access::Reading, "that was for the connection before");
        permission.permit(2);
        assert_eq!(permission.access(), Access::Changing);
    }

    #[test]
    fn the_prompt_is_opened_with_permission_only() {
        let mut permission = Permission::default();
        permission.connected();
        permission.line_answered(&Answer::NotAnswered(Unanswered::Silent));
        assert!(!permission.opens_cli(), "silence is no refusal");
        permission.line_answered(&Answer::NotAnswered(Unanswered::CliClosed));
        assert_eq!((permission.opens_cli(), permission.cli()), (true, CliAccess::Framed));
        permission.permit(1);
        assert_eq!(permission.cli(), CliAccess::Interactive);
        assert_eq!(Impact::of_line("get").or_changes(permission.opens_cli()), Impact::Changes);
        assert_eq!(Impact::of_line("motor 1 1500").or_changes(true), MOVES);
    }

    #[test]
    fn where_a_line_was_answered_the_prompt_stays_closed() {
        let mut permission = Permission::default();
        permission.connected();
        permission.permit(1);
        permission.line_answered(&Answer::Line { text: String::new(), failed: true, restarted: false });
        permission.line_answered(&Answer::NotAnswered(Unanswered::CliClosed));
        assert_eq!((permission.opens_cli(), permission.cli()), (false, CliAccess::Framed));
    }

    #[test]
    fn changes_wait_for_the_permission() {
        assert_eq!(Access::Reading.check(Impact::Reads), Ok(()));
        assert_eq!(Access::Reading.check(Impact::Changes), Err(Denial::NotPermitted));
        assert_eq!(Access::Changing.check(Impact::Changes), Ok(()));
    }

    proptest::proptest! {
        #[test]
        fn no_spelling_hides_a_motor(
            before in "[ \t]{0,3}",
            word in "(?i)motor",
            values in "[ \t]{1,3}[0-9]{1,3}[ \t]{1,3}[0-9]{1,5}[ \t]{0,2}",
        ) {
            proptest::prop_assert_eq!(Impact::of_line(&format!("{before}{word}{values}")), MOVES);
        }
    }
}
