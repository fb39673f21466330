//! The command line of a craft that has none: lines that become orders and questions.

use crate::mavlink::station::{NotBegun, Order, StationProtocol};
use crate::mavlink::value::{CommandResult, MissionResult};

/// The lines, for `help`.
const HELP: &str = "\
This craft has no command line. These lines become orders and questions:
status           autopilot, mode, arming, other craft on the link
mode [NAME]      the modes, or a change of the mode
start            fly the mission
pause, continue  interrupt the mission, go on with it
goto ITEM        go on with this item of the mission
rtl, land        return home, land here
waypoint list    the mission as a plan; waypoint clear and insert before it send another one
Orders need the permission of the connection (allow-changes). Nothing here arms the craft.";

/// A line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Line {
    Show(Shown),
    Order(Order),
    /// Prints the plan of the craft.
    List,
    /// A line of a plan.
    Plan(String),
    /// A setting of a plan, which this craft does not have.
    Setting,
}

/// An answer from this program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shown {
    Nothing,
    Help,
    Status,
    Modes,
}

impl Line {
    /// Returns `true` if the line changes the craft.
    pub(super) fn changes(&self) -> bool {
        matches!(self, Self::Order(_) | Self::Plan(_))
    }
}

/// Reads a line.
///
/// # Errors
/// Fails with a sentence if this craft has no such line.
pub(super) fn parse(line: &str) -> Result<Line, String> {
    let line = line.trim();
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let rest = rest.trim();
    let order = |order| Ok(Line::Order(order));
    match (word.to_ascii_lowercase().as_str(), rest) {
        ("", _) => Ok(Line::Show(Shown::Nothing)),
        ("help", _) => Ok(Line::Show(Shown::Help)),
        ("status", _) => Ok(Line::Show(Shown::Status)),
        ("mode", "") => Ok(Line::Show(Shown::Modes)),
        ("mode", name) => order(Order::SetMode(name.to_owned())),
        ("start", "") => order(Order::StartMission),
        ("pause", "") => order(Order::Pause),
        ("continue", "") => order(Order::Continue),
        ("rtl", "") => order(Order::ReturnHome),
        ("land", "") => order(Order::Land),
        ("goto", item) => match item.parse() {
            Ok(item) => order(Order::SetCurrent(item)),
            Err(_) => Err(format!("\"{item}\" is not an item of a mission: allowed are 0 to 65535")),
        },
        ("set", rest) if rest.contains('=') => Ok(Line::Setting),
        ("waypoint", "list") => Ok(Line::List),
        ("waypoint", rest) if rest == "clear" || rest.starts_with("insert ") => {
            Ok(Line::Plan(format!("waypoint {rest}")))
        }
        _ => Err(format!("a craft that speaks MAVLink has no line {word}: help lists those that it has")),
    }
}

impl Shown {
    /// Returns the text.
    pub(super) fn text(self, station: &StationProtocol) -> String {
        match self {
            Self::Nothing => String::new(),
            Self::Help => HELP.to_owned(),
            Self::Modes => station.mode_names().join("\n"),
            Self::Status => status(station),
        }
    }
}

fn status(station: &StationProtocol) -> String {
    let report = station.report();
    let Some(presence) = report.presence.as_ref().map(|heard| &heard.value) else {
        return "no craft was heard".to_owned();
    };
    let link = if station.is_connected() { "connected" } else { "lost" };
    let armed = if presence.is_armed { "armed" } else { "disarmed" };
    let mut text = format!("craft: {}, {link}\nmode: {}, {armed}", super::kind(presence), presence.mode);
    if let Some(firmware) = report.firmware {
        let [major, minor, patch] = firmware.value.version;
        text += &format!("\nfirmware: {major}.{minor}.{patch}");
    }
    if let Some(mission) = report.mission {
        let total = mission.value.total.map(|total| format!(" of {total}")).unwrap_or_default();
        text += &format!("\nmission: item {}{total}", mission.value.seq);
    }
    let others: Vec<String> = station.others().iter().map(|(system, _)| system.to_string()).collect();
    if !others.is_empty() {
        text += &format!("\nother systems on the link, which are not shown: {}", others.join(", "));
    }
    text
}

/// Returns the reason why an order or a transfer did not begin.
pub(super) fn not_begun(why: NotBegun) -> &'static str {
    match why {
        NotBegun::NoCraft => "no craft is connected",
        NotBegun::Busy => "another transfer or too many orders are under way: try again",
        NotBegun::NoSuchMode => "the craft has no such mode: the line mode lists those that it has",
        NotBegun::TooLong => "the mission has too many items",
    }
}

/// Returns the reason why a craft has not carried out an order.
pub(super) fn result(result: CommandResult) -> &'static str {
    match result {
        CommandResult::Accepted => "accepted",
        CommandResult::TemporarilyRejected => "not now",
        CommandResult::Denied => "denied",
        CommandResult::Unsupported => "the craft does not know this order",
        CommandResult::Failed => "failed",
        CommandResult::InProgress => "begun",
        CommandResult::Cancelled => "cancelled",
        CommandResult::LongOnly | CommandResult::IntOnly | CommandResult::UnsupportedFrame => {
            "the craft wants this order in another form"
        }
    }
}

/// Returns the reason why a craft has refused a mission.
pub(super) fn transfer_result(result: MissionResult) -> &'static str {
    match result {
        MissionResult::Accepted => "accepted",
        MissionResult::Error => "it gives no reason",
        MissionResult::UnsupportedFrame => "it does not know the reference of an altitude",
        MissionResult::Unsupported => "it does not know the command of an item",
        MissionResult::NoSpace => "it has no space for so many items",
        MissionResult::InvalidX | MissionResult::InvalidY => "a position is not allowed",
        MissionResult::InvalidZ => "an altitude is not allowed",
        MissionResult::InvalidSequence => "the items came in another order",
        MissionResult::Denied => "it takes no mission now",
        MissionResult::Cancelled => "cancelled",
        _ => "a value of an item is not allowed",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_become_orders_and_others_are_refused_by_their_names() {
        let order = |order| Ok(Line::Order(order));
        assert_eq!(parse(" mode  Loiter "), order(Order::SetMode("Loiter".to_owned())));
        assert_eq!(parse("RTL"), order(Order::ReturnHome));
        assert_eq!(parse("goto 3"), order(Order::SetCurrent(3)));
        assert_eq!(parse("waypoint list"), Ok(Line::List));
        assert_eq!(parse("mode"), Ok(Line::Show(Shown::Modes)));
        assert!(parse("goto home").unwrap_err().contains("0 to 65535"));
        for line in ["arm", "motor 1 1500", "waypoint remove 1", "land now"] {
            assert!(parse(line).unwrap_err().contains("has no line"), "{line}");
        }
        assert!(parse("waypoint clear").unwrap().changes() && !parse("status").unwrap().changes());
    }
}
