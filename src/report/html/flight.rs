//! The page of one flight, and the part about a flight in the page of several.

use askama::Template;

use super::page::{self, Page};
use super::{bounded, text};
use crate::report::flight::{
    Detail, Figure, FlightReport, MarginRow, ReportedSettings, facts, figures, look, margin_rows,
};
use crate::report::record::{FlightRecord, Transition};
use crate::report::sentence;
use crate::telemetry::signal::Signal;
use crate::telemetry::{Guard, NavState};

/// The part of a page about one flight.
#[derive(Debug, Template)]
#[template(path = "report/flight.html")]
struct FlightPart {
    /// The level of its headings.
    level: u8,
    figures: Vec<Figure>,
    margins: Vec<MarginRow>,
    transitions: Vec<TransitionRow>,
    transitions_left_out: Option<String>,
    settings: Option<Settings>,
    log: Vec<LogLine>,
}

/// A transition of the state machine.
#[derive(Debug)]
struct TransitionRow {
    at: String,
    colour: String,
    to: &'static str,
    waypoint: String,
    why: &'static str,
    guard: String,
    value: String,
    limit: String,
    margin: String,
}

#[derive(Debug)]
struct Settings {
    sentence: &'static str,
    has_defaults: bool,
    groups: Vec<SettingGroup>,
}

#[derive(Debug)]
struct SettingGroup {
    /// The line above rows that are shown on demand.
    summary: Option<String>,
    rows: Vec<SettingRow>,
}

impl SettingGroup {
    /// Returns rows that are always shown, if there are any.
    fn shown(rows: Vec<SettingRow>) -> Vec<Self> {
        if rows.is_empty() { Vec::new() } else { vec![Self { summary: None, rows }] }
    }
}

#[derive(Debug)]
struct SettingRow {
    name: String,
    value: String,
    default: String,
}

#[derive(Debug)]
struct LogLine {
    at: String,
    text: String,
}

/// Returns the page of a flight. `program` is the name of this program with its version.
pub fn flight_page(report: &FlightReport, program: &str) -> String {
    let kind = text::line(&report.kind);
    let title = text::line(&report.name);
    let verdict = super::page::printable_verdict(&report.verdict);
    bounded(Detail::WHOLE, |detail| {
        let body = part(report, "flight", 2, detail);
        let note = note(&report.record);
        let mut page = Page::new(&kind, &title, &verdict, &body, program);
        page.facts = page::facts(&facts(report));
        page.command = report.command.as_deref().and_then(text::command);
        if report.record.begins_at.is_some() {
            page.again = "Open it again";
        }
        page.note = &note;
        page.html()
    })
}

/// Returns the part of a page about a flight. `id` begins the identifiers of its pictures.
pub(super) fn part(report: &FlightReport, id: &str, level: u8, detail: Detail) -> String {
    let record = &report.record;
    let shown = record.transitions.iter().take(detail.rows);
    let left_out = record.transitions.len().saturating_sub(detail.rows);
    let part = FlightPart {
        level,
        figures: figures(report, id, detail),
        margins: margin_rows(report).into_iter().take(detail.rows).collect(),
        transitions: shown.map(|transition| transition_row(record, transition)).collect(),
        transitions_left_out: (left_out > 0).then(|| format!("{left_out} later transitions are left out.")),
        settings: report.settings.as_ref().filter(|_| detail.is_whole).map(|known| settings(known, detail)),
        log: log(record, detail),
    };
    // Writing to a string does not fail.
    part.render().unwrap_or_default()
}

fn transition_row(record: &FlightRecord, transition: &Transition) -> TransitionRow {
    let Transition { time, to, wp, kind, reason, guard, .. } = transition;
    let (colour, name) = look::of_state(*to);
    let waypoint = kind.filter(|_| *to != NavState::Idle).map(|kind| format!("WP{wp} {kind}"));
    let of_guard = |number: fn(&Guard) -> String| guard.as_ref().map_or_else(String::new, number);
    TransitionRow {
        at: format!("{:.1}", record.seconds(*time)),
        colour: colour.light(),
        to: name,
        waypoint: waypoint.unwrap_or_default(),
        why: sentence::cause(*reason, *to),
        guard: of_guard(|guard| guard.name.to_string()),
        value: of_guard(|guard| quantity(guard, guard.value)),
        limit: of_guard(|guard| format!("{} {}", guard.op, quantity(guard, guard.limit))),
        margin: of_guard(|guard| quantity(guard, guard.margin())),
    }
}

/// Returns a number with the unit of a guard.
fn quantity(guard: &Guard, value: f64) -> String {
    let unit: &str = guard.unit().into();
    format!("{:.2} {unit}", value + 0.0).trim_end().to_owned()
}

fn settings(settings: &ReportedSettings, detail: Detail) -> Settings {
    match settings {
        ReportedSettings::Changed(changed) => Settings {
            sentence: match changed.is_empty() {
                true => "All settings have their defaults.",
                false => "All others have their defaults.",
            },
            has_defaults: true,
            groups: SettingGroup::shown(changed.iter().take(detail.rows).map(setting_row).collect()),
        },
        ReportedSettings::Sent(lines) => {
            let row = |line: &String| {
                let line = line.strip_prefix("set ").unwrap_or(line);
                let (name, value) = line.split_once('=').unwrap_or((line, ""));
                let (name, value) = (text::line(name.trim()), text::line(value.trim()));
                SettingRow { name, value, default: String::new() }
            };
            Settings {
                sentence: "The lines that the firmware got before the flight.",
                has_defaults: false,
                groups: SettingGroup::shown(lines.iter().take(detail.rows).map(row).collect()),
            }
        }
        ReportedSettings::Logged { changed, others } => {
            let rows = |rows: &[[String; 3]]| rows.iter().take(detail.rows).map(setting_row).collect();
            let mut groups = SettingGroup::shown(rows(changed));
            if !others.is_empty() {
                let summary = Some(format!("{} more lines of the header", others.len()));
                groups.push(SettingGroup { summary, rows: rows(others) });
            }
            Settings {
                sentence: match changed.is_empty() {
                    true => "No setting in the header of the log differs from the defaults of this firmware.",
                    false => "Those in the header of the log that differ from the defaults of this firmware.",
                },
                has_defaults: true,
                groups,
            }
        }
    }
}

fn setting_row(texts: &[String; 3]) -> SettingRow {
    let [name, value, default] = texts.each_ref().map(|cell| text::line(cell));
    SettingRow { name, value, default }
}

fn log(record: &FlightRecord, detail: Detail) -> Vec<LogLine> {
    let shown = record.sentences.iter().take(detail.sentences);
    shown
        .map(|(at, sentence)| LogLine {
            at: format!("{:.1} s", record.seconds(*at)),
            text: text::line(sentence),
        })
        .collect()
}

/// Returns the meaning of the times.
fn note(record: &FlightRecord) -> String {
    let is_true = record.values(Signal::Altitude).next().is_some();
    match record.engaged_at {
        _ if record.begins_at.is_some() => format!(
            "Times are seconds after the record begins. Places, altitudes and speeds are {}.",
            if is_true { "true unless they are called an estimate" } else { "those that the craft measured" }
        ),
        Some(engaged_at) => format!(
            "Times are simulated seconds after the autopilot engaged, {:.1} s after boot. Places and altitudes are \
             true unless they are called an estimate.",
            engaged_at.as_secs_f64()
        ),
        None => "Times are simulated seconds after boot: the autopilot did not engage.".to_owned(),
    }
}
