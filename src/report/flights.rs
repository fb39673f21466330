//! The list of recorded flights, as a table and as lines of JSON.

use serde::Serialize;

use crate::recording::Listed;
use crate::text::printable;

/// What a row says of a recording without an end.
const GROWING: &str = "recording";
const CUT_SHORT: &str = "cut short";

/// The parts of a recording that people look for, as text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlightRow {
    /// Date and time, UTC: `2026-05-09 07:29:33`.
    pub date: String,
    pub plan: String,
    /// The result in a word; of a file that cannot be read `unreadable`.
    pub verdict: String,
    /// The reason of the result, or the reason why the file cannot be read.
    pub reason: String,
    /// `3:45`.
    pub duration: String,
}

impl From<&Listed> for FlightRow {
    fn from(listed: &Listed) -> Self {
        let summary = match &listed.summary {
            Ok(summary) => summary,
            Err(reason) => {
                let (date, plan, duration) = (String::new(), String::new(), String::new());
                return Self {
                    date,
                    plan,
                    verdict: "unreadable".to_owned(),
                    reason: reason.clone(),
                    duration,
                };
            }
        };
        let (verdict, reason) = match &summary.end {
            Some(end) => (end.result.clone(), end.reason.clone()),
            None if listed.is_growing => (GROWING.to_owned(), String::new()),
            None => (CUT_SHORT.to_owned(), "its program was ended in flight".to_owned()),
        };
        Self {
            date: summary.header.date.trim_end_matches('Z').replace('T', " "),
            plan: summary.header.plan.clone(),
            verdict,
            reason,
            duration: duration(summary.flown_s()),
        }
    }
}

/// Returns a time as minutes and seconds.
fn duration(seconds: f64) -> String {
    // A float becomes the nearest number, zero if negative.
    let whole = seconds.round() as u64;
    format!("{}:{:02}", whole / 60, whole % 60)
}

/// Returns a line for each recording, under a heading.
pub fn table(flights: &[Listed]) -> String {
    let rows: Vec<FlightRow> = flights.iter().map(FlightRow::from).collect();
    let width = |of: fn(&FlightRow) -> &str, heading: &str| {
        let widths = rows.iter().map(|row| shown(of(row)).chars().count());
        widths.max().unwrap_or(0).max(heading.len())
    };
    let (plan, verdict) = (width(|row| &row.plan, "plan"), width(|row| &row.verdict, "verdict"));
    let mut text = format!(
        "{:<19}  {:<plan$}  {:<verdict$}  {:>8}  file\n",
        "date (UTC)", "plan", "verdict", "duration"
    );
    for (row, listed) in rows.iter().zip(flights) {
        let FlightRow { date, duration, .. } = row;
        let (of_plan, of_verdict) = (shown(&row.plan), shown(&row.verdict));
        let file = listed.file.display();
        let line =
            format!("{:<19}  {of_plan:<plan$}  {of_verdict:<verdict$}  {duration:>8}  {file}", shown(date));
        text.push_str(&printable::line(&line));
        if listed.summary.is_err() {
            text.push_str(&printable::line(&format!(": {}", row.reason)));
        }
        text.push('\n');
    }
    text
}

/// Returns a text of a file as it is shown in a column.
fn shown(text: &str) -> String {
    const MOST: usize = 40;
    let text = printable::line(text);
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", text.get(..end).unwrap_or_default()),
        None => text.into_owned(),
    }
}

#[derive(Serialize)]
struct Line<'l> {
    file: String,
    bytes: u64,
    date: Option<&'l str>,
    plan: Option<&'l str>,
    program: Option<&'l str>,
    result: &'l str,
    reason: &'l str,
    flown_s: Option<f64>,
    hash: Option<&'l str>,
}

/// Returns a recording as a line of JSON.
pub fn json_line(listed: &Listed) -> String {
    let row = FlightRow::from(listed);
    let summary = listed.summary.as_ref().ok();
    let header = summary.map(|summary| &summary.header);
    let line = Line {
        file: listed.file.display().to_string(),
        bytes: listed.bytes,
        date: header.map(|header| header.date.as_str()),
        plan: header.map(|header| header.plan.as_str()),
        program: header.map(|header| header.program.as_str()),
        result: &row.verdict,
        reason: &row.reason,
        flown_s: summary.map(|summary| (summary.flown_s() * 1000.0).round() / 1000.0),
        hash: summary.and_then(|summary| summary.end.as_ref()?.hash.as_deref()),
    };
    serde_json::to_string(&line).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{End, Header, Summary};

    fn listed() -> Vec<Listed> {
        let header = Header {
            format: 1,
            program: "0.1.0".to_owned(),
            date: "2026-05-09T07:29:33Z".to_owned(),
            plan: "my plan\u{1b}[2J".to_owned(),
        };
        let end = End {
            result: "complete".to_owned(),
            reason: "landed".to_owned(),
            flown_s: 225.29,
            hash: Some("00ff".to_owned()),
            ..End::default()
        };
        let summary = Summary { header, end: Some(end), seen_s: 0.0 };
        let cut = Summary { end: None, seen_s: 59.6, ..summary.clone() };
        let entry =
            |name: &str, is_growing, summary| Listed { file: name.into(), bytes: 7, is_growing, summary };
        vec![
            entry("/f/a.flight", false, Ok(summary)),
            entry("/f/b.flight", true, Ok(cut.clone())),
            entry("/f/c.flight", false, Ok(cut)),
            entry("/f/d.flight", false, Err("it is no recording".to_owned())),
        ]
    }

    #[test]
    fn a_table_has_a_row_for_each_recording() {
        insta::assert_snapshot!(table(&listed()));
    }

    #[test]
    fn a_line_of_json_has_what_the_file_says() {
        let lines: Vec<String> = listed().iter().map(json_line).collect();
        let value: serde_json::Value = serde_json::from_str(&lines[0]).unwrap();
        assert_eq!((value["result"].as_str(), value["flown_s"].as_f64()), (Some("complete"), Some(225.29)));
        assert_eq!(value["hash"].as_str(), Some("00ff"));
        let value: serde_json::Value = serde_json::from_str(&lines[3]).unwrap();
        assert_eq!(
            (value["result"].as_str(), value["reason"].as_str()),
            (Some("unreadable"), Some("it is no recording"))
        );
        assert!(value["plan"].is_null() && value["flown_s"].is_null());
    }
}
