//! The loss report: the differences between a plan here and the same plan in the file of another program.

use std::fmt;

/// The weight of a finding, the lightest first.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    serde::Serialize,
    strum::Display,
    strum::EnumIter,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Severity {
    /// Not part of a flight: camera actions, colours, comments, planning speeds.
    Info,
    /// The source is ambiguous, and a rule decided.
    Assumed,
    /// A value differs by more than its resolution, or an item became several or none.
    Changed,
    /// The other side flies or guards something else.
    Lost,
    /// The file or the item cannot be taken at all.
    Refused,
}

/// The place of an item in a file.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
#[serde(untagged)]
pub enum Place {
    /// A line, from 1.
    Line {
        /// The number of the line, from 1.
        line: usize,
    },
    /// A JSON pointer, such as `/mission/items/3`.
    Pointer {
        /// The JSON pointer.
        pointer: String,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line { line } => write!(f, "line {line}"),
            Self::Pointer { pointer } => write!(f, "{pointer}"),
        }
    }
}

/// One difference. `Display` is its line in the report: `changed  WP 3 (item 5, line 41) altitude: 0 m → 50 m: WHY`.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// The number of the waypoint of the plan, from 0; `None` = the whole file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waypoint: Option<usize>,
    /// The number of the item in the file, as its format counts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub item: Option<usize>,
    /// The place in the file, if there is one.
    #[serde(flatten)]
    pub place: Option<Place>,
    /// The part that differs, such as `altitude`.
    pub field: String,
    /// The value in the source with its unit; may be empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub from: String,
    /// The value in the target with its unit; may be empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub to: String,
    /// The reason, as a part of a sentence without a full stop.
    pub why: String,
}

impl Finding {
    /// Creates a finding for the whole file.
    pub fn new(severity: Severity, field: impl Into<String>, why: impl Into<String>) -> Self {
        Self {
            severity,
            waypoint: None,
            item: None,
            place: None,
            field: field.into(),
            from: String::new(),
            to: String::new(),
            why: why.into(),
        }
    }

    /// Sets the waypoint, from 0.
    #[must_use]
    pub fn at(self, waypoint: usize) -> Self {
        Self { waypoint: Some(waypoint), ..self }
    }

    /// Sets the number of the item in the file.
    #[must_use]
    pub fn item(self, item: usize) -> Self {
        Self { item: Some(item), ..self }
    }

    /// Sets the place in the file.
    #[must_use]
    pub fn place(self, place: Place) -> Self {
        Self { place: Some(place), ..self }
    }

    /// Sets the values on both sides.
    #[must_use]
    pub fn values(self, from: impl Into<String>, to: impl Into<String>) -> Self {
        Self { from: from.into(), to: to.into(), ..self }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { severity, waypoint, item, place, field, from, to, why } = self;
        write!(f, "{severity:<7}  ")?;
        let item = item.map(|item| format!("item {item}"));
        let of_file: Vec<String> = item.into_iter().chain(place.as_ref().map(ToString::to_string)).collect();
        match (waypoint, of_file.is_empty()) {
            (Some(waypoint), true) => write!(f, "WP {waypoint} ")?,
            (Some(waypoint), false) => write!(f, "WP {waypoint} ({}) ", of_file.join(", "))?,
            (None, true) => {}
            (None, false) => write!(f, "{} ", of_file.join(", "))?,
        }
        write!(f, "{field}")?;
        match (from.is_empty(), to.is_empty()) {
            (true, true) => {}
            (false, true) => write!(f, ": {from}")?,
            (true, false) => write!(f, ": {to}")?,
            (false, false) => write!(f, ": {from} → {to}")?,
        }
        write!(f, ": {why}")
    }
}

/// The findings of one conversion, in one direction.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LossReport {
    /// The number of items in the file.
    pub items: usize,
    /// The number of waypoints of the plan.
    pub waypoints: usize,
    /// The differences, in the order of the file.
    pub findings: Vec<Finding>,
}

impl LossReport {
    /// Adds a finding.
    pub fn add(&mut self, finding: Finding) {
        self.findings.push(finding);
    }

    /// Returns `true` if the plan is the same on both sides.
    pub fn is_lossless(&self) -> bool {
        self.worst().is_none_or(|worst| worst == Severity::Info)
    }

    /// Returns the heaviest severity.
    pub fn worst(&self) -> Option<Severity> {
        self.findings.iter().map(|finding| finding.severity).max()
    }

    /// Returns the number of findings of a severity.
    pub fn count(&self, severity: Severity) -> usize {
        self.findings.iter().filter(|finding| finding.severity == severity).count()
    }

    /// Returns the numbers of findings: `1 lost, 2 changed, 1 assumed, 4 info`; `nothing is lost` if no finding is
    /// above info.
    pub fn counts(&self) -> String {
        let heavy = [Severity::Refused, Severity::Lost, Severity::Changed, Severity::Assumed];
        let mut parts: Vec<String> = heavy
            .into_iter()
            .map(|severity| (severity, self.count(severity)))
            .filter(|&(_, count)| count > 0)
            .map(|(severity, count)| format!("{count} {severity}"))
            .collect();
        if parts.is_empty() {
            parts.push("nothing is lost".to_owned());
        }
        match self.count(Severity::Info) {
            0 => {}
            count => parts.push(format!("{count} {}", Severity::Info)),
        }
        parts.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_is_one_line() {
        let why = "the altitude of a MAVLink LAND is that of the ground";
        let finding = Finding::new(Severity::Changed, "altitude", why).at(3).item(5).values("0 m", "50 m");
        assert_eq!(
            finding.place(Place::Line { line: 41 }).to_string(),
            "changed  WP 3 (item 5, line 41) altitude: 0 m → 50 m: the altitude of a MAVLink LAND is that of the ground"
        );
        let finding = Finding::new(Severity::Info, "zoom", "a plan has none").values("17", "");
        assert_eq!(finding.to_string(), "info     zoom: 17: a plan has none");
    }

    #[test]
    fn counts_name_what_is_above_info() {
        let mut report = LossReport::default();
        assert_eq!((report.counts().as_str(), report.is_lossless()), ("nothing is lost", true));
        report.add(Finding::new(Severity::Info, "a", "b"));
        assert_eq!((report.counts().as_str(), report.is_lossless()), ("nothing is lost, 1 info", true));
        report.add(Finding::new(Severity::Assumed, "a", "b"));
        report.add(Finding::new(Severity::Lost, "a", "b"));
        assert_eq!(report.counts(), "1 lost, 1 assumed, 1 info");
        assert_eq!(report.worst(), Some(Severity::Lost));
    }
}
