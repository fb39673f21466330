//! Betaflight CLI text. `waypoint insert …`, `update`, `remove` and `clear` are carried out in the order of the
//! lines, from an empty plan, as if someone typed them. All other lines are skipped and counted, so a whole `diff
//! all` is a plan file, too. Its `set` lines are not part of the plan: as a configuration they belong to
//! `--settings`.

use std::ops::Range;

use super::cli_lines::plan_lines;
use super::field::{self, FieldError};
use super::long::hint;
use super::loss::{Finding, LossReport, Severity};
use super::{Note, NoteKind, PlanFile, Problems, Written};
use crate::geo::LatLon;
use crate::plan::record::WaypointRecord;
use crate::plan::{MAX_WAYPOINTS, Waypoint};
use crate::text::did_you_mean;

/// The values of `waypoint insert` and `waypoint update`, by name.
const VALUES: [&str; 8] =
    ["index", "latitude", "longitude", "altitude", "speed", "type", "duration", "pattern"];

/// The sub-commands of `waypoint`.
const OPERATIONS: [&str; 6] = ["insert", "update", "remove", "clear", "list", "status"];

/// The most values of a line that are read: one more than any operation takes, and the two words before them.
const MAX_WORDS: usize = VALUES.len() + 3;

/// The most waypoints that are kept while later lines may still remove some.
const MAX_INSERTED: usize = 1000;

/// The most different commands with a count of their own.
const MAX_NOTES: usize = 30;

/// The longest command name in a note.
const MAX_NAME: usize = 40;

/// The state of the reader after some lines.
struct Reader<'p, 'a> {
    problems: &'p mut Problems<'a>,
    waypoints: Vec<Waypoint>,
    notes: Vec<Note>,
    /// The place of the first waypoint for which there is no room.
    overflow: Option<Range<usize>>,
    /// `true` once there are too many waypoints to keep: the following lines cannot be carried out.
    gave_up: bool,
}

/// A word of a line and its byte range in the text.
type Word<'a> = (&'a str, Range<usize>);

/// Reads the text and adds problems to `problems`.
pub(super) fn read(text: &str, long: bool, problems: &mut Problems<'_>) -> PlanFile {
    let mut reader =
        Reader { problems, waypoints: Vec::new(), notes: Vec::new(), overflow: None, gave_up: false };
    let mut start = 0;
    for (index, line) in text.split_inclusive('\n').enumerate() {
        reader.line(index + 1, line, start);
        start += line.len();
    }
    let most = reader.waypoints.len();
    let at_least = if reader.gave_up { "more than " } else { "" };
    if let Some(span) = reader.overflow.take().filter(|_| !long || reader.gave_up) {
        reader.problems.add(
            span,
            format!("waypoint {MAX_WAYPOINTS} does not fit: {at_least}{most} are inserted"),
            hint(),
        );
    }
    if reader.waypoints.is_empty() && reader.problems.is_empty() {
        reader.note(NoteKind::NoWaypoints, 1);
    }
    let mut file = PlanFile { notes: reader.notes, ..PlanFile::default() };
    file.take(reader.waypoints);
    file
}

impl Reader<'_, '_> {
    fn line(&mut self, number: usize, line: &str, start: usize) {
        let (code, comment) = line.split_once('#').map_or((line, false), |(code, _)| (code, true));
        let words = words(code, start);
        let Some((command, span)) = words.first() else {
            if comment {
                self.note(NoteKind::Comment, number);
            }
            return;
        };
        match command.to_ascii_lowercase().as_str() {
            "waypoint" if self.gave_up => {}
            "waypoint" => self.waypoint(&words, start + code.trim_end().len()),
            "set" => self.note(NoteKind::Setting, number),
            other if did_you_mean::closest(other, ["waypoint"]).is_some() => self.problems.add(
                span.clone(),
                format!("{command} is not a command"),
                "did you mean waypoint?",
            ),
            other if other.len() <= MAX_NAME => self.note(NoteKind::Command(other.to_owned()), number),
            _ => self.note(NoteKind::Others, number),
        }
    }

    fn note(&mut self, kind: NoteKind, line: usize) {
        let is_new_command =
            matches!(kind, NoteKind::Command(_)) && self.notes.iter().all(|note| note.kind != kind);
        let is_full = self.notes.len() >= MAX_NOTES;
        let kind = if is_new_command && is_full { NoteKind::Others } else { kind };
        match self.notes.iter_mut().find(|note| note.kind == kind) {
            Some(note) => note.count += 1,
            None => self.notes.push(Note { kind, count: 1, first_line: line }),
        }
    }

    fn waypoint(&mut self, words: &[Word<'_>], line_end: usize) {
        let Some((operation, span)) = words.get(1) else { return };
        let arguments = &words[2..];
        match operation.to_ascii_lowercase().as_str() {
            "insert" => self.insert_or_update(arguments, line_end, true),
            "update" => self.insert_or_update(arguments, line_end, false),
            "remove" => self.remove(arguments, line_end),
            "clear" => {
                if self.no_more_than(0, arguments, line_end, "waypoint clear takes no value") {
                    self.waypoints.clear();
                    self.overflow = None;
                }
            }
            "list" | "status" => {}
            _ => self.problems.add(
                span.clone(),
                format!("{operation} is not an operation of waypoint"),
                did_you_mean::hint(operation, OPERATIONS),
            ),
        }
    }

    fn insert_or_update(&mut self, arguments: &[Word<'_>], line_end: usize, insert: bool) {
        let before = self.problems.len();
        let operation = if insert { "insert" } else { "update" };
        if let Some(missing) = VALUES.get(arguments.len()) {
            let values = VALUES.map(|name| format!("<{name}>")).join(" ");
            self.problems.add(
                line_end..line_end,
                format!("the {missing} is missing: waypoint {operation} takes {} values", VALUES.len()),
                format!("write waypoint {operation} {values}"),
            );
        }
        let too_many = format!("waypoint {operation} takes {} values", VALUES.len());
        self.no_more_than(VALUES.len(), arguments, line_end, &too_many);
        let index = arguments.first().and_then(|word| self.index(word, insert));
        let record = WaypointRecord {
            position: LatLon::new(
                self.value(arguments.get(1), field::latitude),
                self.value(arguments.get(2), field::longitude),
            ),
            alt_cm: self.value(arguments.get(3), field::altitude_cm),
            speed: self.value(arguments.get(4), field::speed_cms),
            kind: self.value(arguments.get(5), field::waypoint_type),
            duration_ds: self.value(arguments.get(6), field::duration_ds),
            pattern: self.value(arguments.get(7), field::pattern),
        };
        let waypoint = record.into();
        if insert && self.waypoints.len() == MAX_INSERTED {
            self.gave_up = true;
        } else if insert {
            // A faulty waypoint still takes its index, so that the lines after it give no false problems.
            let index = index.unwrap_or(self.waypoints.len());
            self.waypoints.insert(index, waypoint);
            if self.waypoints.len() > MAX_WAYPOINTS && self.overflow.is_none() {
                self.overflow = arguments.first().map(|(_, span)| span.clone());
            }
        } else if let (Some(index), true) = (index, self.problems.len() == before) {
            self.waypoints[index] = waypoint;
        }
    }

    fn remove(&mut self, arguments: &[Word<'_>], line_end: usize) {
        let Some(word) = arguments.first() else {
            self.problems.add(line_end..line_end, "the index is missing", "write waypoint remove <index>");
            return;
        };
        if self.no_more_than(1, arguments, line_end, "waypoint remove takes one value")
            && let Some(index) = self.index(word, false)
        {
            self.waypoints.remove(index);
            if self.waypoints.len() <= MAX_WAYPOINTS {
                self.overflow = None;
            }
        }
    }

    /// Reads an index into the waypoints so far. An insert may also use the index after the last.
    fn index(&mut self, (text, span): &Word<'_>, insert: bool) -> Option<usize> {
        let count = self.waypoints.len();
        let places = if insert { count + 1 } else { count };
        match text.parse::<usize>() {
            Ok(index) if index < places => return Some(index),
            Ok(_) if places == 0 => self.problems.add(
                span.clone(),
                format!("there is no waypoint {text}: the plan is empty here"),
                "waypoint insert 0 adds the first",
            ),
            Ok(_) => self.problems.add(
                span.clone(),
                format!("index {text} is out of range"),
                format!("allowed: 0 to {} ({count} waypoints so far)", places - 1),
            ),
            Err(_) => self.problems.add(
                span.clone(),
                format!("index {text} is not a whole number"),
                format!("allowed: 0 to {}", MAX_WAYPOINTS - 1),
            ),
        }
        None
    }

    /// Reads one value. A missing value was already reported.
    fn value<T: Default>(&mut self, word: Option<&Word<'_>>, read: fn(&str) -> Result<T, FieldError>) -> T {
        let Some((text, span)) = word else { return T::default() };
        read(text).unwrap_or_else(|error| {
            self.problems.add(span.clone(), error.message, error.hint);
            T::default()
        })
    }

    fn no_more_than(&mut self, count: usize, arguments: &[Word<'_>], line_end: usize, message: &str) -> bool {
        let Some((_, first)) = arguments.get(count) else { return true };
        self.problems.add(first.start..line_end, message, "remove the rest of the line");
        false
    }
}

/// Returns the words of a line that starts at byte `start` of the text, up to the limit.
fn words(line: &str, start: usize) -> Vec<Word<'_>> {
    line.split_ascii_whitespace()
        .take(MAX_WORDS)
        .map(|word| {
            let at = start + (word.as_ptr() as usize - line.as_ptr() as usize);
            (word, at..at + word.len())
        })
        .collect()
}

/// Writes the output of `waypoint list`: text that can be pasted into the CLI.
pub(super) fn write(file: &PlanFile) -> Written {
    let text: String = plan_lines(&file.plan).map(|line| line + "\n").collect();
    let mut losses = LossReport { items: file.plan.waypoints.len(), ..LossReport::default() };
    if !file.description.is_empty() {
        let why = "CLI text carries waypoints only";
        losses.add(Finding::new(Severity::Info, "description", why));
    }
    if let Some(home) = file.home {
        let why = "CLI text carries waypoints only: fly with --home";
        losses.add(Finding::new(Severity::Lost, "home", why).values(home.to_string(), ""));
    }
    if !file.settings.is_empty() {
        let why =
            "CLI text carries waypoints only: type them as `set` lines in the CLI or fly with --settings";
        let finding = Finding::new(Severity::Lost, "settings", why);
        losses.add(finding.values(file.settings.len().to_string(), ""));
    }
    Written { contents: text.into_bytes(), losses }
}

#[cfg(test)]
mod tests {
    use super::super::{Format, parse, report, write};
    use super::*;
    use crate::plan::{HoldPattern, WaypointType};

    fn read_text(text: &str) -> PlanFile {
        parse("plan.txt", text, Format::CliText).unwrap_or_else(|errors| panic!("{}", report(&errors)))
    }

    fn headlines(text: &str) -> Vec<String> {
        let errors = parse("plan.txt", text, Format::CliText).unwrap_err();
        errors.iter().map(super::super::PlanError::headline).collect()
    }

    const TWO: &str = "waypoint clear\n\
        waypoint insert 0 40.4640000 -79.5175000 5000 0 FLYOVER 0 ORBIT\n\
        waypoint insert 1 -27.4900000 153.0100000 -150 1000 HOLD 600 FIGURE8\n";

    #[test]
    fn canonical_text_prints_byte_identically() {
        let file = read_text(TWO);
        assert_eq!(file.name, "plan");
        assert_eq!(file.plan.records()[1].alt_cm, -150);
        assert_eq!(file.plan.waypoints[1].pattern, HoldPattern::Figure8);
        let written = write(&file, Format::CliText);
        assert_eq!((written.text().as_ref(), written.losses.findings.len()), (TWO, 0));
    }

    #[test]
    fn lines_are_carried_out_in_order() {
        let file = read_text(&format!(
            "{TWO}Waypoint INSERT 0 1 2 300 0 takeoff 0 none\r\n\
             waypoint update 1 1.5 2 300 0 flyby 0 none # comment\n waypoint remove 2\nwaypoint list\nwaypoint\n"
        ));
        let kinds: Vec<_> = file.plan.waypoints.iter().map(|waypoint| waypoint.kind).collect();
        assert_eq!(kinds, [WaypointType::Takeoff, WaypointType::Flyby]);
        assert_eq!(read_text(&format!("{TWO}waypoint clear")).plan, crate::plan::FlightPlan::default());
    }

    #[test]
    fn other_lines_are_counted_by_kind() {
        let file = read_text(&format!(
            "# version\nbatch start\nfeature GPS\nfeature -LED_STRIP\n\n# master\nset ap_max_angle = 25\n{TWO}save\n"
        ));
        let notes: Vec<_> = file.notes.iter().map(ToString::to_string).collect();
        assert_eq!(notes[0], "Skipped 2 comment lines");
        assert_eq!(notes[1], "Skipped 1 `batch` line (first: line 2)");
        assert_eq!(notes[2], "Skipped 2 `feature` lines (first: line 3)");
        assert!(notes[3].starts_with("Skipped 1 `set` line (first: line 7)"));
        assert!(notes[3].contains("--settings"));
        assert_eq!(notes[4], "Skipped 1 `save` line (first: line 11)");
        let many: String = (0..100).map(|at| format!("other{at}\nother0\n")).collect();
        let notes = read_text(&format!("{TWO}{many}{}", "x".repeat(99))).notes;
        assert_eq!(notes.len(), MAX_NOTES + 1);
        assert_eq!(notes[0].count, 101);
        assert_eq!(notes[MAX_NOTES].to_string(), "Skipped 71 other lines (first: line 64)");
        assert_eq!(read_text("save").notes.last().unwrap().kind, NoteKind::NoWaypoints);
    }

    #[test]
    fn all_problems_are_reported_with_their_places() {
        let text = "waypoint insert 0 4O.4640000 -79.5175000 5000 0 FLYOVR 0 ORBIT\n\
                    waypoint insert 1 40.4 -790 5000 70000 FLYBY 0 CIRCLE\n\
                    waypoint insert 7 40.4 -79 5000 0 FLYBY 0 NONE\n\
                    waypont insert 2 1 2 3 0 LAND 0 NONE\n\
                    waypoint inser 2 1 2 3 0 LAND 0 NONE\n\
                    waypoint insert 2 1 2 3 0 LAND 0\n\
                    waypoint insert 2 1 2 3 0 LAND 0 NONE extra words\n\
                    waypoint remove x\n\
                    waypoint remove\n";
        assert_eq!(
            headlines(text),
            [
                "plan.txt:1:19: latitude 4O.4640000 is not a number",
                "plan.txt:1:49: FLYOVR is not a waypoint type",
                "plan.txt:2:24: longitude -790 is out of range",
                "plan.txt:2:34: speed 70000 is out of range",
                "plan.txt:2:48: CIRCLE is not a hold pattern",
                "plan.txt:3:17: index 7 is out of range",
                "plan.txt:4:1: waypont is not a command",
                "plan.txt:5:10: inser is not an operation of waypoint",
                "plan.txt:6:33: the pattern is missing: waypoint insert takes 8 values",
                "plan.txt:7:39: waypoint insert takes 8 values",
                "plan.txt:8:17: index x is not a whole number",
                "plan.txt:9:16: the index is missing",
            ]
        );
    }

    #[test]
    fn the_report_shows_line_caret_range_and_guess() {
        let text = "waypoint clear\nwaypoint insert 0 1 2 3 0 FLYOVR 0 NONE\n";
        let errors = parse("plan.txt", text, Format::CliText).unwrap_err();
        assert_eq!(
            report(&errors),
            "plan.txt:2:27: FLYOVR is not a waypoint type\n  |\n\
             2 | waypoint insert 0 1 2 3 0 FLYOVR 0 NONE\n  \
             |                           ^^^^^^ did you mean FLYOVER? allowed: FLYOVER, FLYBY, HOLD, LAND, TAKEOFF, \
             ALT_CHANGE, DELAY, YAW_RATE"
        );
    }

    #[test]
    fn the_thirty_first_waypoint_is_refused_once() {
        let lines = |count: usize| {
            (0..count).map(|i| format!("waypoint insert {i} 1 2 3 0 FLYBY 0 NONE\n")).collect::<String>()
        };
        assert_eq!(read_text(&lines(30)).plan.waypoints.len(), 30);
        assert_eq!(headlines(&lines(33)), ["plan.txt:31:17: waypoint 30 does not fit: 33 are inserted"]);
        assert_eq!(read_text(&format!("{}waypoint remove 3", lines(31))).plan.waypoints.len(), 30);
        assert_eq!(read_text(&format!("{}waypoint clear", lines(40))).plan.waypoints.len(), 0);
        let far_too_many = headlines(&format!("{}waypoint clear", lines(MAX_INSERTED + 1)));
        assert_eq!(far_too_many, ["plan.txt:31:17: waypoint 30 does not fit: more than 1000 are inserted"]);
    }

    #[test]
    fn what_the_text_cannot_carry_is_listed() {
        let file = PlanFile {
            description: "d".to_owned(),
            home: "40,-79,300".parse().ok(),
            settings: vec!["ap_max_angle = 25".to_owned()],
            ..PlanFile::default()
        };
        let losses = write(&file, Format::CliText).losses;
        assert_eq!(losses.counts(), "2 lost, 1 info");
        assert!(losses.findings[1].to_string().contains("home: 40.0000000,-79.0000000,300: CLI text"));
    }
}
