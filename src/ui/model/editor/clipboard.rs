//! Converts waypoints to CLI text and back, for the clipboard.

use crate::plan::format::{self, Format, PlanFile};
use crate::plan::{FlightPlan, Waypoint, plan_lines};

/// Returns the lines that insert these waypoints.
pub(super) fn to_text(waypoints: &[Waypoint]) -> String {
    let plan = crate::ui::model::editor::forms::plan_of(waypoints);
    // Without `waypoint clear`: the waypoints of the command line that they are pasted into stay.
    plan_lines(&plan).skip(1).map(|line| line + "\n").collect()
}

/// A pasted text.
pub(in crate::ui) struct Pasted {
    pub(in crate::ui) file: PlanFile,
    /// `true` if the text begins with an empty plan (`waypoint clear`), so that it replaces the open one.
    pub(in crate::ui) replaces: bool,
}

/// Parses the waypoints of a text: CLI lines with any numbers, or a whole plan file. CLI lines with `waypoint clear` are read
/// as from a file.
///
/// # Errors
/// Returns the reason in one sentence if there are no waypoints.
pub(super) fn from_text(text: &str) -> Result<Pasted, String> {
    let text = text.replace("\r\n", "\n").replace('\r', "\n");
    let format = Format::from_contents(text.as_bytes());
    let replaces = format == Format::CliText && text.lines().any(is_clear);
    let text = if format == Format::CliText && !replaces { renumbered(&text) } else { text };
    let file = format::parse("the pasted text", &text, format).map_err(|errors| {
        // Only the first line of the error: the marker below it needs rows of its own.
        let first = errors.first().map(ToString::to_string);
        let sentence = first.as_deref().and_then(|text| text.lines().next().map(str::to_owned));
        sentence.unwrap_or_else(|| "The pasted text is no plan.".to_owned())
    })?;
    if file.plan == FlightPlan::default() {
        return Err(
            "The pasted text has no waypoints: `waypoint insert …` lines or a plan file are.".to_owned()
        );
    }
    Ok(Pasted { file, replaces })
}

/// Returns `true` for the line that empties a plan.
fn is_clear(line: &str) -> bool {
    let code = line.split('#').next().unwrap_or_default().to_ascii_lowercase();
    code.split_whitespace().eq(["waypoint", "clear"])
}

/// Renumbers the waypoints of the lines from 0, so that a part of a list can be pasted as well as a whole one.
fn renumbered(text: &str) -> String {
    let mut next = 0;
    text.lines().fold(String::new(), |mut out, line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            [waypoint, insert, _, ref values @ ..]
                if waypoint.eq_ignore_ascii_case("waypoint") && insert.eq_ignore_ascii_case("insert") =>
            {
                out.push_str(&format!("waypoint insert {next} {}\n", values.join(" ")));
                next += 1;
            }
            _ => {
                out.push_str(line);
                out.push('\n');
            }
        }
        out
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::plan::Altitude;

    #[test]
    fn what_is_copied_is_pasted_the_same() {
        let waypoints: Vec<Waypoint> = (0..3)
            .map(|n| Waypoint {
                position: LatLon::new(404_640_000 + n, 5),
                altitude: Altitude::above_home(f64::from(n) * 0.07),
                ..Waypoint::default()
            })
            .collect();
        let text = to_text(&waypoints);
        assert_eq!(text.lines().count(), 3);
        assert_eq!(from_text(&text).unwrap().file.plan.waypoints.as_slice(), waypoints);
        let tail: String = text.lines().skip(1).map(|line| format!("{line}\r\n")).collect();
        assert_eq!(
            from_text(&tail).unwrap().file.plan.waypoints.as_slice(),
            &waypoints[1..],
            "a part, from a terminal"
        );
    }

    #[test]
    fn a_file_that_is_no_plan_says_so() {
        for text in ["", "hello", "set a = 5", "waypoint insert 0 4O 1 2 3 FLYOVER 0 NONE"] {
            assert!(from_text(text).is_err_and(|reason| !reason.is_empty()), "{text}");
        }
    }
}
