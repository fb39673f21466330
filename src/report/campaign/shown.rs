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

/// Returns a number with three significant digits; a whole number keeps all of its digits.
pub(in crate::report) fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() || value.fract() == 0.0 {
        return format!("{value}");
    }
    let decimals = (2 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Returns the worst flights by their complaints, its numbers apart: the worst flight of each complaint first.
pub(in crate::report) fn alike(worst: &[Worst]) -> Vec<Vec<&Worst>> {
    let mut groups: Vec<Vec<&Worst>> = Vec::new();
    for one in worst {
        let same = groups.iter_mut().find(|group| {
            group.first().is_some_and(|first| !one.has_passed && !first.has_passed && first.is_like(one))
        });
        match same {
            Some(group) => group.push(one),
            None => groups.push(vec![one]),
        }
    }
    groups
}

/// Returns how many flights failed like one of the worst flights, with the next worst of them; `None` if it is the only one.
pub(in crate::report) fn others(reported: &Reported<'_>, one: &Worst, listed: &[&Worst]) -> Option<String> {
    let more = one.alike.saturating_sub(1);
    if more == 0 {
        return None;
    }
    let listed: Vec<String> = listed.iter().map(|other| flight_name(reported, other)).collect();
    let next = match listed.len() as u64 {
        0 => String::new(),
        all if all == more => format!(": {}", listed.join(", ")),
        _ => format!(", the worst of them {}", listed.join(", ")),
    };
    Some(format!("and {more} more like it{next}"))
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
        // The sentence of a crash begins with the result.
        (false, _) if worst.result.is_empty() || worst.complaint.starts_with("the craft crashed") => {
            worst.complaint.clone()
        }
        (false, _) => format!("{}, {}", worst.result, worst.complaint),
        (true, Some(margin)) => format!("passed, with {} of a margin left", percent(margin)),
        (true, None) => "passed".to_owned(),
    }
}
