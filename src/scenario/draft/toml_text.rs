//! The text of a scenario file for a draft.

use super::{Block, Draft};
use crate::geo::Degrees7;
use crate::scenario::file::FORMAT;
use crate::signals::SimTime;

/// Returns a text in TOML notation.
pub(super) fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// `12.34 s after boot`.
pub(super) fn after_boot(at: SimTime) -> String {
    let decimals = match at.0 {
        us if us.is_multiple_of(10_000) => 2,
        us if us.is_multiple_of(1000) => 3,
        _ => 6,
    };
    format!("{:.decimals$} s after boot", at.as_secs_f64())
}

pub(super) fn text(draft: &Draft, expectations: &[Block]) -> String {
    let mut out = format!("format = {FORMAT}\nname = {}\n", quoted(&draft.name));
    let mut line = |text: String| {
        out.push_str(&text);
        out.push('\n');
    };
    if !draft.description.is_empty() {
        line(format!("description = {}", quoted(&draft.description)));
    }
    // A campaign of the file then flies a seed of its own in each flight.
    line(format!("seeds = {}", quoted(&format!("{}..", draft.seed))));
    if let Some(ends) = &draft.ends {
        line(format!("ends = {}", quoted(&after_boot(*ends))));
        line(format!("time_limit_s = {}", ends.as_secs_f64().ceil() + 60.0));
    }
    line(String::new());
    line("[plan]".to_owned());
    let records = draft.plan.records();
    let waypoints: Vec<String> = records
        .iter()
        .enumerate()
        .map(|(index, record)| format!("{index} {}", record.values(record.alt_cm)))
        .collect();
    line(format!("waypoints = {}", list(&waypoints)));
    line(String::new());
    line("[craft]".to_owned());
    if let Some(home) = &draft.home {
        let place = format!("{},{}", Degrees7(home.position.lat_e7), Degrees7(home.position.lon_e7));
        let amsl = home.amsl_m.map_or_else(String::new, |amsl| format!(",{amsl}"));
        line(format!("home = {}", quoted(&(place + &amsl))));
    }
    if draft.heading_deg.abs() > 1e-9 {
        line(format!("heading_deg = {}", draft.heading_deg));
    }
    if let Some(airframe) = &draft.airframe {
        line(format!("airframe = {}", quoted(airframe)));
    }
    if draft.pilot {
        line(format!("takeoff_m = {}", draft.takeoff_m));
    } else {
        line("pilot = \"none\"".to_owned());
    }
    for (key, lines) in [("settings", &draft.settings), ("lines", &draft.lines)] {
        if !lines.is_empty() {
            line(format!("{key} = {}", list(lines)));
        }
    }
    if !draft.air.is_empty() {
        line("\n[air]".to_owned());
        draft.air.iter().for_each(|(key, value)| line(format!("{key} = {value}")));
    }
    for (at, what) in &draft.inputs {
        line(format!("\n[[input]]\nat = {}\ndo = {}", quoted(at), quoted(what)));
    }
    for block in expectations {
        line("\n[[expect]]".to_owned());
        block.iter().for_each(|(key, value)| line(format!("{key} = {value}")));
    }
    out
}

/// Returns a list of texts, with one text on each line.
pub(super) fn list(texts: &[String]) -> String {
    let lines: String = texts.iter().map(|text| format!("  {},\n", quoted(text))).collect();
    format!("[\n{lines}]")
}
