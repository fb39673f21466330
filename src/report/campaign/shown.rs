//! Numbers and commands of an answer for people.

use super::Reported;
use crate::campaign::{Rule, Side, Split, Worst};
use crate::report::check::shell_word;
use crate::scenario::{Metric, Quantity, percent};
use crate::telemetry::quantity;

/// Returns a value of a quantity.
pub(in crate::report) fn value(of: &Quantity, value: f64) -> String {
    if Metric::find(&of.name).is_some_and(Metric::is_share) {
        return percent(value);
    }
    quantity::shown(value, of.dimension)
}

/// Returns a probability.
pub(in crate::report) fn probability(p: f64) -> String {
    match p {
        p if p < 1e-6 => "below 0.000001".to_owned(),
        p if p < 0.001 => format!("{p:.6}"),
        p => format!("{p:.3}"),
    }
}

/// Returns a rule with its input: `wind_mps above 9.31`.
pub(in crate::report) fn rule(input: &str, rule: &Rule) -> String {
    match rule {
        Rule::Above(threshold) => format!("{input} above {}", number(*threshold)),
        Rule::AtMost(threshold) => format!("{input} at most {}", number(*threshold)),
        Rule::Is(word) => format!("{input} {word}"),
    }
}

/// Returns what a split says: `48 of 88 such flights failed, 2 of the other 912`.
pub(in crate::report) fn split(split: &Split) -> String {
    let (failed, flights) = split.inside;
    let (others_failed, others) = split.outside;
    format!("{failed} of {flights} such flights failed, {others_failed} of the other {others}")
}

/// Returns a number with at most four digits behind the point.
pub(in crate::report) fn number(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Returns the command that opens a flight at its worst instant; `None` if the flights were not kept.
pub(in crate::report) fn open_command(reported: &Reported<'_>, worst: &Worst) -> Option<String> {
    let run = shell_word(reported.run?);
    let side = if reported.sides.is_some() && worst.side == Side::B { "b" } else { "" };
    let at = worst.at.map_or_else(String::new, |at| {
        let boot = if at.is_from_boot { "boot+" } else { "" };
        format!(" --at {boot}{:.2}", at.seconds)
    });
    Some(format!("betadeck open {run}:{}{side}{at}", worst.number))
}

/// Returns the number of a flight with its side.
pub(in crate::report) fn flight_name(reported: &Reported<'_>, worst: &Worst) -> String {
    match (&reported.sides, worst.side) {
        (Some(_), Side::B) => format!("{}b", worst.number),
        _ => worst.number.to_string(),
    }
}

/// Returns what is wrong with one of the worst flights, or how close it came.
pub(in crate::report) fn complaint(worst: &Worst) -> String {
    match (worst.has_passed, worst.margin) {
        (false, _) if worst.result.is_empty() => worst.complaint.clone(),
        (false, _) => format!("{}, {}", worst.result, worst.complaint),
        (true, Some(margin)) => format!("passed, with {} of a margin left", percent(margin)),
        (true, None) => "passed".to_owned(),
    }
}
