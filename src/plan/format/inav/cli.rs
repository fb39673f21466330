//! The `wp` lines of INAV's CLI, alone or in a whole `dump` or `diff all`.

use std::collections::BTreeMap;
use std::ops::Range;

use super::super::bounds::{self, MAX_ITEMS};
use super::super::loss::{Finding, LossReport, Place, Severity};
use super::super::{PlanFile, Problems, ReadOptions, Written};
use super::{
    Action, Contents, Form, Found, Item, LAST, Mission, altitude_cm, from_plan, private, to_plan, whole,
};
use crate::geo::{Degrees7, LatLon};

const FORM: Form = Form { first: 0, whole_metres: false, has_home: false };

/// The values of a `wp` line, by name.
const VALUES: [&str; 9] = [
    "index",
    "action",
    "latitude",
    "longitude",
    "altitude",
    "parameter 1",
    "parameter 2",
    "parameter 3",
    "flag",
];
/// The other operations of `wp`.
const OPERATIONS: [&str; 4] = ["list", "load", "save", "reset"];
/// The beginning of a line of the private data.
const PRIVATE: &str = "#| ";

/// Returns `true` if the text has the lines of an INAV mission: `wp 0 …` or `# wp N valid`.
pub(in crate::plan::format) fn is_mission(text: &str) -> bool {
    text.lines().any(|line| {
        let mut words = line.split_ascii_whitespace();
        let mut next = || words.next().unwrap_or_default();
        let is_number = |word: &str| !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit());
        match (next(), next(), next(), next()) {
            ("wp", index, action, _) => is_number(index) && is_number(action),
            ("#", "wp", count, "valid") => is_number(count),
            _ => false,
        }
    })
}

/// Reads a text.
pub(in crate::plan::format) fn read(
    text: &str,
    options: &ReadOptions,
    problems: &mut Problems<'_>,
) -> PlanFile {
    let mut lines = Lines::default();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        lines.line(line, start, problems);
        start += line.len();
        if problems.is_full() {
            break;
        }
    }
    if !problems.is_empty() {
        return PlanFile::default();
    }
    to_plan::plan_file(lines.contents(), FORM, options, problems)
}

#[derive(Default)]
struct Lines {
    /// The items by their indices. A block whose indices begin again after the last item of a mission is a map of its own.
    blocks: Vec<BTreeMap<usize, Found>>,
    /// `true` if the item before was the last one of its mission.
    after_last: bool,
    findings: Vec<Finding>,
    /// The numbers of other lines: fences, the approaches of fixed wings, safe homes, all others.
    others: [usize; 4],
    private: Option<String>,
}

impl Lines {
    fn line(&mut self, line: &str, start: usize, problems: &mut Problems<'_>) {
        let line = line.trim_end_matches(['\r', '\n']);
        if let (Some(private), Some(more)) = (&mut self.private, line.strip_prefix(PRIVATE)) {
            private.push_str(more);
            private.push('\n');
            return;
        }
        if line.strip_prefix("# ") == Some(private::MARK) {
            self.private = Some(String::new());
            return;
        }
        let code = line.split('#').next().unwrap_or_default();
        let mut words = code.split_ascii_whitespace();
        match words.next() {
            None => {}
            Some(word) if word.eq_ignore_ascii_case("wp") => {
                let values: Vec<&str> = words.take(VALUES.len() + 1).collect();
                let begin = code.len() - code.trim_start().len();
                self.wp(&values, start + begin..start + code.trim_end().len(), problems);
            }
            Some(word) => {
                let is = |name: &str| word.eq_ignore_ascii_case(name);
                let kind = ["geozone", "fwapproach", "safehome"].into_iter().position(is);
                self.others[kind.unwrap_or(3)] += 1;
            }
        }
    }

    fn wp(&mut self, values: &[&str], span: Range<usize>, problems: &mut Problems<'_>) {
        match values {
            [] => return,
            [operation] if operation.eq_ignore_ascii_case("reset") => return self.blocks.clear(),
            [operation, ..] if OPERATIONS.iter().any(|known| operation.eq_ignore_ascii_case(known)) => return,
            _ => {}
        }
        let Ok(values) = <[&str; VALUES.len()]>::try_from(values) else {
            let names = VALUES.map(|name| format!("<{name}>")).join(" ");
            let message = format!("wp takes {} values", VALUES.len());
            problems.add(span, message, format!("write wp {names}"));
            return;
        };
        let Some(index) = values[0].parse::<usize>().ok().filter(|&index| index < MAX_ITEMS) else {
            let message = format!("index {} is not a number of an item", values[0]);
            problems.add(span, message, format!("allowed: 0 to {}", MAX_ITEMS - 1));
            return;
        };
        if values[1..].iter().all(|&value| value == "0") {
            // A line that is not used.
            return;
        }
        if let Some(item) = self.item(index, values, span.clone(), problems) {
            let is_last = item.flag == LAST;
            self.keep(Found { item, number: index, label: index, span }, problems);
            self.after_last = is_last;
        }
    }

    /// Keeps an item. The later one of two with an index counts, unless its indices begin again with another mission.
    fn keep(&mut self, found: Found, problems: &Problems<'_>) {
        let is_known = |block: &BTreeMap<usize, Found>| block.contains_key(&found.number);
        if self.blocks.is_empty() || self.after_last && self.blocks.last().is_some_and(is_known) {
            self.blocks.push(BTreeMap::new());
        }
        let Some(block) = self.blocks.last_mut() else { return };
        let (index, line) = (found.number, problems.line_at(found.span.start));
        if let Some(earlier) = block.insert(index, found) {
            let why = format!("line {line} has the same index and counts");
            let place = Place::Line { line: problems.line_at(earlier.span.start) };
            self.findings.push(Finding::new(Severity::Lost, "item", why).item(index).place(place));
        }
    }

    fn item(
        &mut self,
        index: usize,
        [_, action, lat, lon, alt, p1, p2, p3, flag]: [&str; VALUES.len()],
        span: Range<usize>,
        problems: &mut Problems<'_>,
    ) -> Option<Item> {
        let known = problems.len();
        let code = action.parse().ok().and_then(Action::from_repr);
        if code.is_none() {
            problems.add(span.clone(), format!("{action} is not an action of INAV"), "allowed: 0 to 8");
        }
        let mut scaled = |name: &str, text: &str, unit: f64| match text.parse::<i32>() {
            Ok(value) => f64::from(value) * unit,
            Err(_) => {
                let why = if text.contains(',') { ": a decimal comma is not read" } else { "" };
                problems.add(span.clone(), format!("{name} {text} is not a whole number{why}"), "");
                0.0
            }
        };
        let (lat, lon) = (scaled("latitude", lat, 1e-7), scaled("longitude", lon, 1e-7));
        let alt_cm = altitude_cm(scaled("altitude", alt, 0.01));
        let place = bounds::position(lat, lon);
        for message in [alt_cm.as_ref().err(), place.as_ref().err()].into_iter().flatten() {
            problems.add(span.clone(), message.clone(), "");
        }
        let (position, wrapped) = place.unwrap_or((LatLon::default(), false));
        if wrapped {
            let why = "a longitude of a plan is within 180 degrees";
            let line = Place::Line { line: problems.line_at(span.start) };
            let finding = Finding::new(Severity::Changed, "longitude", why).item(index).place(line);
            self.findings.push(finding.values(lon.to_string(), Degrees7(position.lon_e7).to_string()));
        }
        let mut value = |name: &str, text: &str| whole(name, text, span.clone(), problems);
        let (p1, p2) = (value("parameter 1", p1)?, value("parameter 2", p2)?);
        let (p3, flag) = (value("parameter 3", p3)?, value("flag", flag)?);
        let item = Item { action: code?, position, alt_cm: alt_cm.ok()?, p1, p2, p3, flag };
        (problems.len() == known).then_some(item)
    }

    fn contents(self) -> Contents {
        let mut missions = Vec::new();
        for block in self.blocks {
            let mut open = Mission::default();
            for found in block.into_values() {
                let is_last = found.item.flag == LAST;
                // Jumps count from the beginning of their mission.
                let found = Found { number: open.items.len(), ..found };
                open.items.push(found);
                if is_last {
                    missions.push(std::mem::take(&mut open));
                }
            }
            if !open.items.is_empty() {
                missions.push(open);
            }
        }
        if missions.is_empty() {
            missions.push(Mission::default());
        }
        let mut findings = self.findings;
        let whys = [
            (Severity::Lost, "geozone lines", "this craft does not keep out of them"),
            (Severity::Info, "fwapproach lines", "they are the approaches of fixed wings"),
            (Severity::Info, "safehome lines", "this craft returns to its home"),
            (Severity::Info, "other lines", "they are no part of a mission"),
        ];
        for ((severity, field, why), count) in whys.into_iter().zip(self.others) {
            if count > 0 {
                findings.push(Finding::new(severity, field, why).values(count.to_string(), ""));
            }
        }
        Contents { missions, findings, private: self.private }
    }
}

/// Writes the lines of a mission.
pub(in crate::plan::format) fn write(file: &PlanFile) -> Written {
    let items = from_plan::items(file, FORM);
    let is_refused = items.is_refused();
    let losses = LossReport { items: items.items.len(), findings: items.findings, ..LossReport::default() };
    if is_refused {
        return Written { contents: Vec::new(), losses };
    }
    let mut text = format!("# wp {} valid\n", items.items.len());
    for (index, item) in items.items.iter().enumerate() {
        let Item { action, position, alt_cm, p1, p2, p3, flag } = *item;
        let (code, lat, lon) = (action as u8, position.lat_e7, position.lon_e7);
        text.push_str(&format!("wp {index} {code} {lat} {lon} {alt_cm} {p1} {p2} {p3} {flag}\n"));
    }
    if let Some(private) = private::text(file) {
        text.push_str(&format!("# {}\n", private::MARK));
        for line in private.lines().filter(|line| !line.is_empty()) {
            text.push_str(&format!("{PRIVATE}{line}\n"));
        }
    }
    Written { contents: text.into_bytes(), losses }
}
