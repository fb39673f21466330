//! MW-XML. Elements have upper or lower case names, attributes lower case ones. Files hold one mission or several.

use std::collections::BTreeMap;
use std::ops::Range;

use super::super::bounds::{self, MAX_ITEMS};
use super::super::home::of_file;
use super::super::loss::{Finding, LossReport, Place, Severity};
use super::super::number::decimal;
use super::super::xml::{Element, Part, Parts};
use super::super::{PlanFile, Problems, ReadOptions, Written};
use super::{
    Action, Contents, Form, Found, Item, LAST, Mission, altitude_cm, as_place, from_plan, private, to_plan,
    whole,
};
use crate::geo::{Degrees7, LatLon};
use crate::math;
use crate::text::did_you_mean;
use strum::IntoEnumIterator as _;

const FORM: Form = Form { first: 1, whole_metres: true, has_home: true };

/// The name of the root element.
const ROOT: &str = "mission";
/// The name of the program that wrote a file.
const GENERATOR: &str = "betadeck";

/// Returns `true` if a root element of this name begins a mission.
pub(in crate::plan::format) fn is_root(name: &str) -> bool {
    name.eq_ignore_ascii_case(ROOT)
}

/// The most names of unknown elements that are counted.
const MAX_NAMES: usize = 20;

/// Reads a file.
pub(in crate::plan::format) fn read(
    text: &str,
    options: &ReadOptions,
    problems: &mut Problems<'_>,
) -> PlanFile {
    let mut parts = Parts::new(text);
    let mut document = Document::default();
    let mut is_root_known = false;
    while let Some(part) = parts.next(problems) {
        let Part::Start(element) = part else { continue };
        if is_root_known {
            document.element(&element, problems);
            parts.skip(problems);
        } else if is_root(&element.name) {
            is_root_known = true;
        } else {
            let message = format!("the first element is {}, that of a mission is {ROOT}", element.name);
            problems.add(element.span, message, "is this the right file?");
            return PlanFile::default();
        }
        if problems.is_full() || document.items > MAX_ITEMS {
            break;
        }
    }
    if !is_root_known && problems.is_empty() {
        problems.add(0..0, format!("the file has no element {ROOT}"), "is this the right file?");
    }
    if !problems.is_empty() {
        return PlanFile::default();
    }
    to_plan::plan_file(document.contents(private_text(text)), FORM, options, problems)
}

/// Returns the text of the comment with the private data.
fn private_text(text: &str) -> Option<String> {
    let (_, rest) = text.split_once(&format!("<!-- {}", private::MARK))?;
    Some(rest.split_once("-->")?.0.to_owned())
}

#[derive(Default)]
struct Document {
    /// The number of items.
    items: usize,
    missions: Vec<Mission>,
    /// The mission to which the next item belongs.
    open: Mission,
    findings: Vec<Finding>,
    /// The number of elements of each name that are no part of a plan.
    others: BTreeMap<String, usize>,
}

impl Document {
    fn element(&mut self, element: &Element, problems: &mut Problems<'_>) {
        let name = element.name.to_ascii_lowercase();
        match name.as_str() {
            "missionitem" => self.mission_item(element, problems),
            "mwp" | "meta" => self.meta(element, problems),
            "version" => {}
            _ if self.others.len() < MAX_NAMES || self.others.contains_key(&name) => {
                *self.others.entry(name).or_default() += 1;
            }
            _ => {}
        }
    }

    fn mission_item(&mut self, element: &Element, problems: &mut Problems<'_>) {
        self.items += 1;
        if self.items > MAX_ITEMS {
            let hint = format!("at most {MAX_ITEMS} are read");
            problems.add(element.span.clone(), format!("the file has more than {MAX_ITEMS} items"), hint);
            return;
        }
        let number = self.open.items.len() + FORM.first;
        let label = element.attribute("no").and_then(|no| no.trim().parse().ok()).unwrap_or(number);
        let Some(item) = self.item(element, number, problems) else { return };
        self.open.items.push(Found { item, number, label, span: element.span.clone() });
        if item.flag == LAST {
            let home = self.open.home;
            self.missions.push(std::mem::replace(&mut self.open, Mission { items: Vec::new(), home }));
        }
    }

    fn item(&mut self, element: &Element, number: usize, problems: &mut Problems<'_>) -> Option<Item> {
        let span = || element.span.clone();
        let Some(action) = element.attribute("action") else {
            problems.add(span(), "the item has no action", "write action=\"WAYPOINT\"");
            return None;
        };
        let Ok(action) = action.trim().parse::<Action>() else {
            let hint = did_you_mean::hint(action, Action::iter().map(Into::into));
            problems.add(span(), format!("{action} is not an action of INAV"), hint);
            return None;
        };
        let known = problems.len();
        let mut number_of = |name: &str, default: Option<f64>| {
            let value = match (element.attribute(name), default) {
                (None, Some(default)) => Ok(default),
                (text, _) => decimal(name, text.unwrap_or_default()),
            };
            value.unwrap_or_else(|message| {
                problems.add(span(), message, "");
                0.0
            })
        };
        let place = if action.has_place() { None } else { Some(0.0) };
        let (lat, lon) = (number_of("lat", place), number_of("lon", place));
        let altitude = number_of("alt", place);
        let alt_cm = altitude_cm(altitude).unwrap_or_else(|message| {
            problems.add(span(), message, "");
            0
        });
        let (position, wrapped) = bounds::position(lat, lon).unwrap_or_else(|message| {
            problems.add(span(), message, "");
            Default::default()
        });
        if wrapped {
            let line = problems.line_at(element.span.start);
            let why = "a longitude of a plan is within 180 degrees";
            let finding = Finding::new(Severity::Changed, "longitude", why).item(number);
            let finding = finding.place(Place::Line { line });
            self.findings.push(finding.values(lon.to_string(), Degrees7(position.lon_e7).to_string()));
        }
        let mut parameter = |name: &str| match element.attribute(name) {
            None => Some(0),
            Some(text) => whole(name, text, span(), problems),
        };
        let values = ["parameter1", "parameter2", "parameter3", "flag"].map(&mut parameter);
        let [Some(p1), Some(p2), Some(p3), Some(flag)] = values else { return None };
        (problems.len() == known).then_some(Item { action, position, alt_cm, p1, p2, p3, flag })
    }

    /// Takes the home of an `mwp` or `meta` element.
    fn meta(&mut self, element: &Element, problems: &mut Problems<'_>) {
        if element.attribute("generator") != Some(GENERATOR) {
            *self.others.entry(element.name.to_ascii_lowercase()).or_default() += 1;
        }
        let (Some(lat), Some(lon)) = (element.attribute("home-y"), element.attribute("home-x")) else {
            return;
        };
        let place = Place::Line { line: problems.line_at(element.span.start) };
        let mut losses = LossReport::default();
        let home = match (decimal("latitude", lat), decimal("longitude", lon)) {
            (Ok(lat), Ok(lon)) => of_file(lat, lon, None, Some(&place), &mut losses),
            (Err(message), _) | (_, Err(message)) => {
                let why = format!("{message}: add --home LAT,LON,AMSL");
                let finding = Finding::new(Severity::Lost, "home", why).place(place);
                losses.add(finding.values(format!("{lat},{lon}"), "unknown"));
                None
            }
        };
        self.findings.append(&mut losses.findings);
        // 0,0 is that of a mission without a home.
        if let Some(home) = home.map(|home| home.position).filter(|home| *home != LatLon::default()) {
            self.open.home = Some(home);
        }
    }

    fn contents(mut self, private: Option<String>) -> Contents {
        if !self.open.items.is_empty() || self.missions.is_empty() {
            self.missions.push(self.open);
        }
        for (name, count) in self.others {
            self.findings.push(other(&name, count));
        }
        Contents { missions: self.missions, findings: self.findings, private }
    }
}

/// Returns the finding for elements that are no part of a plan.
fn other(name: &str, count: usize) -> Finding {
    let (severity, why) = match name {
        "mwp" | "meta" => (Severity::Info, "only the home is a part of a plan"),
        _ if name.starts_with("geozone") => (Severity::Lost, "this craft does not keep out of it"),
        _ if name.starts_with("fwapproach") => (Severity::Info, "it is the approach of fixed wings"),
        _ if name.starts_with("safehome") => (Severity::Info, "this craft returns to its home"),
        _ => (Severity::Info, "it is no part of a plan"),
    };
    Finding::new(severity, format!("element {name}"), why).values(count.to_string(), "")
}

/// Writes a file with one mission.
pub(in crate::plan::format) fn write(file: &PlanFile) -> Written {
    let items = from_plan::items(file, FORM);
    let is_refused = items.is_refused();
    let losses = LossReport { items: items.items.len(), findings: items.findings, ..LossReport::default() };
    if is_refused {
        return Written { contents: Vec::new(), losses };
    }
    let mut text =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<mission>\n  <version value=\"2.3-pre8\"/>\n".to_owned();
    let home = file.home.map(|home| as_place(home.position));
    let places: Vec<LatLon> = items
        .items
        .iter()
        .filter(|item| item.action.has_place())
        .map(|item| item.position)
        .chain(home)
        .collect();
    text.push_str(&view(&places, home));
    for (number, item) in (FORM.first..).zip(&items.items) {
        let Item { action, position, alt_cm, p1, p2, p3, flag } = item;
        let (lat, lon) = (Degrees7(position.lat_e7), Degrees7(position.lon_e7));
        text.push_str(&format!(
            "  <missionitem no=\"{number}\" action=\"{action}\" lat=\"{lat}\" lon=\"{lon}\" alt=\"{}\" \
             parameter1=\"{p1}\" parameter2=\"{p2}\" parameter3=\"{p3}\" flag=\"{flag}\"/>\n",
            alt_cm / 100
        ));
    }
    if let Some(private) = private::text(file) {
        // A comment cannot have two hyphens. They are in quoted texts only.
        let private = private.replace("--", "-\\u002D");
        text.push_str(&format!("  <!-- {}\n{private}  -->\n", private::MARK));
    }
    text.push_str("</mission>\n");
    Written { contents: text.into_bytes(), losses }
}

/// Returns the element with the home and the part of the map to show.
fn view(places: &[LatLon], home: Option<LatLon>) -> String {
    let Some(first) = places.first() else { return String::new() };
    let range = |of: fn(&LatLon) -> i32| -> Range<i32> {
        let (least, most) = places
            .iter()
            .map(of)
            .fold((of(first), of(first)), |(least, most), value| (least.min(value), most.max(value)));
        least..most
    };
    let (lat, lon) = (range(|place| place.lat_e7), range(|place| place.lon_e7));
    let middle = |range: &Range<i32>| (f64::from(range.start) + f64::from(range.end)) * 0.5e-7;
    let span = |range: &Range<i32>| (f64::from(range.end) - f64::from(range.start)) * 1e-7;
    // Zoom 17 shows about 0.005 degrees, each zoom less twice as much.
    let zoom = 17.0 - math::log2(span(&lat).max(span(&lon)) / 0.005).max(0.0).ceil();
    let home = home.map_or_else(String::new, |home| {
        format!(" home-x=\"{}\" home-y=\"{}\"", Degrees7(home.lon_e7), Degrees7(home.lat_e7))
    });
    let (cx, cy) = (middle(&lon), middle(&lat));
    format!("  <mwp cx=\"{cx:.5}\" cy=\"{cy:.5}\"{home} zoom=\"{zoom}\" generator=\"{GENERATOR}\"/>\n")
}
