//! The impact of lines and messages on a craft, as far as it can be judged from them.

use super::NOTHING_MOVES;
use crate::fc::client::sent_line;
use crate::msp::{self, code};

/// Refusal of a line or message that takes the port away.
const TAKES_PORT: &str =
    "The port would then carry something else, and this connection would end: do it in another program.";

/// The impact of a request on a craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Impact {
    /// The craft is only read.
    Reads,
    /// The configuration or plan changes, or the craft restarts.
    Changes,
    /// The craft moves or becomes unreachable, for this reason.
    Forbidden(&'static str),
}

/// Lines that only print, whatever follows the word.
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

/// Lines that only print if nothing follows the word.
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

/// Whole lines that also only print. After most other words, `list` would be read as a number or a name.
const PRINT_WITH: [(&str, &str); 14] = [
    ("beacon", "list"),
    ("beeper", "list"),
    ("dma", "list"),
    ("dma", "show"),
    ("feature", "list"),
    ("mixer", "list"),
    ("resource", "list"),
    ("resource", "show"),
    ("resource", "show all"),
    ("timer", "list"),
    ("timer", "show"),
    ("timer", "show all"),
    ("waypoint", "list"),
    ("waypoint", "status"),
];

/// Lines that turn motors.
const MOVE: [&str; 3] = ["motor", "dshotprog", "escprog"];

/// Lines after which the port carries other data.
const TAKE_PORT: [&str; 5] = ["serialpassthrough", "gpspassthrough", "bl", "dfu", "msc"];

/// Messages that move a craft.
const MOVING_MESSAGES: [u16; 5] =
    [code::SET_RAW_RC, code::SET_RAW_GPS, code::SET_HEADING, code::SET_MOTOR, code::SEND_DSHOT_COMMAND];

impl Impact {
    /// Returns at least [`Self::Changes`] if `changes`.
    pub fn or_changes(self, changes: bool) -> Self {
        if changes { self.max(Self::Changes) } else { self }
    }

    /// Returns the impact of a line of the command line, both as typed and as sent. For several lines it is
    /// the worst.
    pub fn from_line(line: &str) -> Self {
        let typed = line.split(['\r', '\n']).map(Self::from_single_line);
        typed.fold(Self::from_single_line(&sent_line(line)), Self::max)
    }

    fn from_single_line(line: &str) -> Self {
        let line = line.trim();
        let word_end = line.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(line.len());
        let (word, rest) = line.split_at(word_end);
        let word = word.to_ascii_lowercase();
        let rest = rest.split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_lowercase();
        let is_in = |words: &[&str]| words.contains(&word.as_str());
        // The firmware accepts a name if no letter or digit follows it.
        let may_be = |names: &[&str]| {
            names.iter().any(|name| {
                word.strip_prefix(name).is_some_and(|more| !more.starts_with(char::is_alphanumeric))
            })
        };
        let prints_with = PRINT_WITH.contains(&(&word, &rest));
        match word.as_str() {
            "" if rest.is_empty() || rest.starts_with('#') => Self::Reads,
            _ if may_be(&TAKE_PORT) => Self::Forbidden(TAKES_PORT),
            // A named motor without a value is only printed, too.
            "motor" if !rest.contains(' ') => Self::Reads,
            _ if may_be(&MOVE) => Self::Forbidden(NOTHING_MOVES),
            "set" if !rest.contains('=') => Self::Reads,
            _ if is_in(&PRINT) || is_in(&PRINT_ALONE) && rest.is_empty() || prints_with => Self::Reads,
            _ => Self::Changes,
        }
    }

    /// Returns the impact of an MSP message. An unknown message may change the craft.
    pub fn from_message(code: u16, payload: &[u8]) -> Self {
        match code {
            // Configurators set the time of day at every connection.
            code::SET_RTC => Self::Reads,
            code::SET_PASSTHROUGH => Self::Forbidden(TAKES_PORT),
            // It restarts into a boot loader or as a disk.
            code::REBOOT if payload.first().is_some_and(|kind| *kind != 0) => Self::Forbidden(TAKES_PORT),
            // It disarms an armed craft, which may have armed since the last poll.
            code::SET_ARMING_DISABLED if payload.first().is_some_and(|disable| *disable != 0) => {
                Self::Forbidden(NOTHING_MOVES)
            }
            code::MULTIPLE_MSP => {
                // The flight controller takes arbitrary data as the payload of each message.
                let of_each = |code: &u8| match u16::from(*code) {
                    code::MULTIPLE_MSP => Self::Changes,
                    code => Self::from_message(code, &[u8::MAX]),
                };
                payload.iter().map(of_each).max().unwrap_or(Self::Reads)
            }
            _ if MOVING_MESSAGES.contains(&code) => Self::Forbidden(NOTHING_MOVES),
            _ => match code::find(code).map(|kind| kind.access) {
                Some(msp::Access::Read | msp::Access::Ask) => Self::Reads,
                Some(msp::Access::Write) | None => Self::Changes,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Access, Denial};
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
            "beeper list",
            "Resource  SHOW all",
            "timer list",
            "dma show",
            "waypoint list",
        ] {
            assert_eq!(Impact::from_line(line), Impact::Reads, "{line}");
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
            "aux list",
            "board_name list",
            "manufacturer_id show",
            "map all",
            "profile status",
            "rxfail list",
            "vtxtable show",
            "simplified_tuning list",
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
            assert_eq!(Impact::from_line(line), Impact::Changes, "{line}");
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
            assert_eq!(Impact::from_line(line), MOVES, "{line}");
        }
        for line in ["bl", "bl rom", "msc", "serialpassthrough 1", "gpspassthrough"] {
            assert_eq!(Impact::from_line(line), Impact::Forbidden(TAKES_PORT), "{line}");
        }
        for access in [Access::Reading, Access::Changing] {
            assert_eq!(access.check(MOVES), Err(Denial::Never(NOTHING_MOVES)));
        }
        assert_eq!(Access::Everything.check(MOVES), Ok(()), "a simulated craft is free");
    }

    #[test]
    fn every_command_of_the_embedded_firmware_is_sorted() {
        let reads = |name: &&str| Impact::from_line(name) == Impact::Reads;
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
        let of = |code| Impact::from_message(code, &[]);
        for read in [1, 2, 101, 102, 105, 106, 109, 116, 150, 254, 0x3006] {
            assert_eq!(of(read), Impact::Reads, "{read}");
        }
        for write in [35, 202, 208, 209, 250, 9999] {
            assert_eq!(of(write), Impact::Changes, "{write}");
        }
        for moving in MOVING_MESSAGES {
            assert_eq!(of(moving), MOVES, "{moving}");
        }
        assert_eq!((of(68), Impact::from_message(68, &[0])), (Impact::Changes, Impact::Changes));
        assert_eq!(Impact::from_message(68, &[1]), Impact::Forbidden(TAKES_PORT));
        assert_eq!(of(245), Impact::Forbidden(TAKES_PORT));
    }

    #[test]
    fn a_message_of_messages_does_what_the_worst_of_them_does() {
        let of = |codes: &[u8]| Impact::from_message(230, codes);
        assert_eq!(of(&[]), Impact::Reads);
        assert_eq!(of(&[1, 2, 108]), Impact::Reads);
        assert_eq!(of(&[108, 250]), Impact::Changes);
        assert_eq!(of(&[250, 214, 1]), MOVES);
        assert_eq!(of(&[1, 99]), MOVES);
        assert_eq!(of(&[230, 230]), Impact::Changes, "none is nested");
    }

    #[test]
    fn no_message_disarms_a_craft_and_what_lets_it_arm_again_is_a_change() {
        for disarming in [&[1][..], &[1, 0], &[255, 1]] {
            assert_eq!(Impact::from_message(99, disarming), MOVES, "{disarming:?}");
        }
        for arming in [&[][..], &[0], &[0, 1]] {
            assert_eq!(Impact::from_message(99, arming), Impact::Changes, "{arming:?}");
        }
        assert_eq!(Impact::from_message(211, &[90, 0]), MOVES, "a heading to turn to");
    }

    #[test]
    fn letters_that_are_not_sent_hide_nothing() {
        assert_eq!(Impact::from_line("mo\u{200b}tor 1 1500"), MOVES);
        assert_eq!(Impact::from_line("mo\rtor 1 1500"), MOVES);
        assert_eq!(Impact::from_line("serial\u{1}passthrough 1"), Impact::Forbidden(TAKES_PORT));
        assert_eq!(Impact::from_line("aux\u{1} 0"), Impact::Changes);
    }

    proptest::proptest! {
        #[test]
        fn no_spelling_hides_a_motor(
            before in "[ \t]{0,3}",
            word in "(?i)motor",
            values in "[ \t]{1,3}[0-9]{1,3}[ \t]{1,3}[0-9]{1,5}[ \t]{0,2}",
        ) {
            proptest::prop_assert_eq!(Impact::from_line(&format!("{before}{word}{values}")), MOVES);
        }

        #[test]
        fn no_letter_that_is_not_sent_hides_a_motor(
            word in "(?i)motor",
            at in 0_usize..=5,
            unsent in "[\u{1}-\u{1f}\u{7f}-\u{ff}\u{200b}\u{202e}]{1,4}",
            values in " [0-9]{1,3} [0-9]{1,5}",
        ) {
            let line = format!("{}{unsent}{}{values}", &word[..at], &word[at..]);
            proptest::prop_assert_eq!(Impact::from_line(&line), MOVES);
        }
    }
}
