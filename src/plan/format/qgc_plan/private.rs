//! The key `betadeck` of a `.plan`: the waypoints as they are here. They are used for items that still have the meaning
//! with which they were written.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::super::loss::{Finding, LossReport, Severity};
use super::super::mission_item::{Mapping, Mission, send};
use crate::geo::LatLon;
use crate::plan::quantity::Seconds;
use crate::plan::{Altitude, LegSpeed, Waypoint};

/// The version of the data.
const VERSION: u64 = 1;
/// The most waypoints that are taken.
const MAX_WAYPOINTS: usize = 30;

/// The private data of a plan.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct Data {
    version: u64,
    pub(super) name: String,
    #[serde(skip_serializing_if = "String::is_empty")]
    pub(super) description: String,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) settings: Vec<String>,
    waypoints: Vec<Point>,
}

/// A waypoint, with the keys of a TOML plan.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
struct Point {
    #[serde(rename = "type")]
    kind: String,
    lat_deg: f64,
    lon_deg: f64,
    alt_m: f64,
    speed_mps: f64,
    yaw_rate_dps: u16,
    duration_s: f64,
    pattern: String,
}

impl Data {
    pub(super) fn new(name: &str, description: &str, settings: &[String], waypoints: &[Waypoint]) -> Self {
        Self {
            version: VERSION,
            name: name.to_owned(),
            description: description.to_owned(),
            settings: settings.to_vec(),
            waypoints: waypoints.iter().map(Point::from).collect(),
        }
    }

    /// Reads the private data of a file. Data of another version, or damaged, are dropped.
    pub(super) fn read(file: &Value, losses: &mut LossReport) -> Option<Self> {
        let value = file.get("betadeck")?;
        let dropped = |why: &str| Finding::new(Severity::Assumed, "betadeck", why);
        if value["version"].as_u64() != Some(VERSION) {
            losses.add(dropped("the private data have another version, and are not used"));
            return None;
        }
        match Self::deserialize(value) {
            Ok(data) => Some(data),
            Err(error) => {
                losses.add(dropped(&format!("the private data are damaged, and are not used: {error}")));
                None
            }
        }
    }

    fn waypoints(&self) -> Option<Vec<Waypoint>> {
        let points = (self.waypoints.len() <= MAX_WAYPOINTS).then_some(&self.waypoints)?;
        points.iter().map(Point::waypoint).collect()
    }
}

impl From<&Waypoint> for Point {
    fn from(waypoint: &Waypoint) -> Self {
        Self {
            kind: waypoint.kind.to_string(),
            lat_deg: f64::from(waypoint.position.lat_e7) / 1e7,
            lon_deg: f64::from(waypoint.position.lon_e7) / 1e7,
            alt_m: waypoint.altitude.above_home_m(),
            speed_mps: waypoint.speed.mps(),
            yaw_rate_dps: waypoint.yaw_rate_dps,
            duration_s: waypoint.duration.get(),
            pattern: waypoint.pattern.to_string(),
        }
    }
}

impl Point {
    fn waypoint(&self) -> Option<Waypoint> {
        let position = LatLon::from_degrees(self.lat_deg, self.lon_deg);
        let waypoint = Waypoint {
            position,
            altitude: Altitude::checked(self.alt_m)?,
            speed: LegSpeed::checked(self.speed_mps)?,
            yaw_rate_dps: self.yaw_rate_dps,
            duration: Seconds::new(self.duration_s),
            kind: self.kind.parse().ok()?,
            pattern: self.pattern.parse().ok()?,
        };
        position.is_on_globe().then_some(waypoint)
    }
}

/// The waypoints of a file with the private data.
#[derive(Debug, Default)]
pub(super) struct Restored {
    pub(super) waypoints: Vec<Waypoint>,
    pub(super) findings: Vec<Finding>,
}

/// Replaces waypoints of the public items by the private ones. The private waypoints are written again in memory: where
/// these items have the same meaning as those of the file, no other program edited them.
pub(super) fn restore(mapping: Mapping, private: Option<Data>, mission: &Mission<'_>) -> Restored {
    let plain = |mapping: Mapping| Restored {
        waypoints: mapping.waypoints.iter().map(|&(waypoint, _)| waypoint).collect(),
        findings: mapping.findings,
    };
    let dropped = "another program edited items: their private data are not used";
    let Some(private) = private else { return plain(mapping) };
    let (Some(ours), Some(home)) = (private.waypoints(), mission.home) else {
        let mut restored = plain(mapping);
        restored.findings.push(Finding::new(Severity::Assumed, "betadeck", dropped));
        return restored;
    };
    let sent = send(&ours, home.position, mission.assumptions, true);
    let written = Mission { items: &sent.items, ..*mission }.map();
    let groups = groups(&ours);
    let group_of = |at: usize| {
        let source = sent.sources[written.waypoints[at].1];
        groups.iter().position(|group| group.contains(&source)).unwrap_or(0)
    };
    let pairs = pairs(&mapping, &written);
    // A group is used if all of its waypoints are in the file.
    let mut used = vec![true; groups.len()];
    for (at, pair) in pairs.iter().enumerate() {
        used[group_of(at)] &= pair.is_some();
    }
    if let Some(last) = groups.len().checked_sub(1)
        && !(0..written.waypoints.len()).any(|at| group_of(at) == last)
    {
        used[last] = last.checked_sub(1).is_none_or(|before| used[before]);
    }
    let of_file = |index: usize| pairs.iter().position(|&pair| pair == Some(index)).map(group_of);
    let mut restored = Restored::default();
    let mut places = Vec::new();
    let mut begun = 0;
    for (index, &(waypoint, _)) in mapping.waypoints.iter().enumerate() {
        match of_file(index).filter(|&group| used[group]) {
            Some(group) if group >= begun => {
                places.push(restored.waypoints.len());
                restored.waypoints.extend_from_slice(&ours[groups[group].clone()]);
                begun = group + 1;
            }
            Some(_) => places.push(restored.waypoints.len().saturating_sub(1)),
            None => {
                places.push(restored.waypoints.len());
                restored.waypoints.push(waypoint);
            }
        }
    }
    if let Some(last) = groups.last().filter(|_| begun + 1 == groups.len() && used[begun]) {
        restored.waypoints.extend_from_slice(&ours[last.clone()]);
        begun += 1;
    }
    // Differences that were known when the file was written are none.
    let is_known = |finding: &Finding| {
        let index = finding.waypoint.filter(|&index| index < mapping.waypoints.len());
        let is_used = index.is_none_or(|index| of_file(index).is_some_and(|group| used[group]));
        let same = |other: &Finding| {
            (other.severity, &other.field, &other.from, &other.to, &other.why)
                == (finding.severity, &finding.field, &finding.from, &finding.to, &finding.why)
        };
        is_used && written.findings.iter().any(same)
    };
    restored.findings = mapping.findings.iter().filter(|finding| !is_known(finding)).cloned().collect();
    for finding in &mut restored.findings {
        finding.waypoint = finding.waypoint.map(|index| places.get(index).copied().unwrap_or(index));
    }
    if begun < groups.len() || used.contains(&false) || mapping.waypoints.len() != written.waypoints.len() {
        restored.findings.push(Finding::new(Severity::Assumed, "betadeck", dropped));
    }
    restored
}

/// Returns the waypoints that belong together: modifiers and the waypoint that they change.
fn groups(waypoints: &[Waypoint]) -> Vec<Range<usize>> {
    let mut groups = Vec::new();
    let mut begin = 0;
    for (index, waypoint) in waypoints.iter().enumerate() {
        if waypoint.kind.is_positional() {
            groups.push(begin..index + 1);
            begin = index + 1;
        }
    }
    if begin < waypoints.len() {
        groups.push(begin..waypoints.len());
    }
    groups
}

/// Returns the waypoint of the file that equals each of the written ones: from both ends, and between them by number if
/// the file has as many.
fn pairs(file: &Mapping, written: &Mapping) -> Vec<Option<usize>> {
    let (file, written) = (&file.waypoints, &written.waypoints);
    let same = |ours: usize, theirs: usize| written[ours].0 == file[theirs].0;
    let shorter = file.len().min(written.len());
    let before = (0..shorter).take_while(|&at| same(at, at)).count();
    let back = |count: usize| (written.len() - 1 - count, file.len() - 1 - count);
    let after = (0..shorter - before)
        .take_while(|&count| {
            let (ours, theirs) = back(count);
            same(ours, theirs)
        })
        .count();
    let mut pairs = vec![None; written.len()];
    for (at, pair) in pairs.iter_mut().enumerate() {
        let from_end = written.len() - 1 - at;
        *pair = if at < before {
            Some(at)
        } else if from_end < after {
            Some(file.len() - 1 - from_end)
        } else {
            (file.len() == written.len() && same(at, at)).then_some(at)
        };
    }
    pairs
}
