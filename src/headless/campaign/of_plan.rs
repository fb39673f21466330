//! A plan with the options of `fly`, as the text of a scenario.

use crate::args::{AttitudeChoice, CampaignArgs, PlanArg};
use crate::geo::Degrees7;
use crate::process::error::AppError;
use crate::scenario::FORMAT;

/// The most samples of a flight that a scenario keeps.
const MAX_SAMPLES: f64 = 2e6;
/// The samples a second with which the hash of a flight is that of `fly`.
const SAMPLE_HZ: f64 = 100.0;
/// Keys of `[vary]` whose values are words: a text is a list with commas.
const WORDS: [&str; 3] = ["turbulence", "noise", "airframe"];

/// Returns the text. `plan_file` is the name of the plan's file; `None` = the plan is built in.
pub(super) fn text(args: &CampaignArgs, plan: &PlanArg, plan_file: Option<&str>) -> Result<String, AppError> {
    let (flight, mission, trouble) = (&args.flight, &args.mission, &args.trouble);
    let timeout_s = mission.timeout_s();
    let mut text = format!(
        "format = {FORMAT}\nname = {}\nseeds = {}\ntimeout_s = {timeout_s}\ntime_limit_s = {timeout_s}\n",
        quoted(&stem(&plan.display_name())),
        quoted(&format!("{}..", flight.seed.unwrap_or(1)))
    );
    if timeout_s * SAMPLE_HZ > MAX_SAMPLES {
        text.push_str(&format!("sample_hz = {:.1}\n", (MAX_SAMPLES / timeout_s * 10.0).floor() / 10.0));
    }
    let (key, name) = plan_file.map_or(("builtin", plan.display_name()), |file| ("file", file.to_owned()));
    text.push_str(&format!("\n[plan]\n{key} = {}\n", quoted(&name)));

    let mut craft: Vec<(&str, String)> = vec![
        ("takeoff_m", mission.takeoff_m().to_string()),
        ("tolerance_m", mission.tolerance_m().to_string()),
    ];
    if let Some(home) = flight.home {
        let amsl = home.amsl_m.map_or_else(String::new, |amsl| format!(",{amsl}"));
        let (lat, lon) = (Degrees7(home.position.lat_e7), Degrees7(home.position.lon_e7));
        craft.push(("home", quoted(&format!("{lat},{lon}{amsl}"))));
    }
    craft.extend(flight.heading.map(|heading| ("heading_deg", heading.to_string())));
    craft.extend(flight.profile.map(|profile| ("profile", quoted(&profile.to_string()))));
    craft.extend(flight.airframe.as_ref().map(|airframe| ("airframe", quoted(airframe))));
    craft.extend(flight.attitude.map(|attitude| {
        let word = match attitude {
            AttitudeChoice::Truth => "truth",
            AttitudeChoice::Estimated => "estimated",
        };
        ("attitude", quoted(word))
    }));
    craft.extend(flight.rate.map(|rate| ("rate_hz", rate.to_string())));
    craft.extend(flight.settings.as_ref().map(|path| ("settings_file", quoted(&path.display().to_string()))));
    craft.extend(list("settings", &mission.set));
    craft.extend(list("sticks", &trouble.stick));
    table(&mut text, "craft", &craft);

    let mut air: Vec<(&str, String)> = Vec::new();
    air.extend(flight.wind.map(|wind| ("wind", quoted(&wind.to_string()))));
    air.extend(flight.gust.map(|gust| ("gust_mps", gust.to_string())));
    air.extend(flight.turbulence.map(|turbulence| ("turbulence", quoted(&turbulence.to_string()))));
    air.extend(flight.noise.map(|noise| ("noise", quoted(&noise.to_string()))));
    air.extend(list("world", &flight.world));
    air.extend(list("faults", &trouble.faults().collect::<Vec<_>>()));
    table(&mut text, "air", &air);

    for inner in ["", "world", "settings", "faults"] {
        let mut lines = Vec::new();
        for vary in &args.vary {
            let (name, values) = vary.split_once('=').ok_or_else(|| {
                AppError::input(format!("--vary {vary}: write NAME=VALUES, such as wind=6+-2@270"))
            })?;
            let (of, key) = match name.trim().split_once('.') {
                Some((of @ ("world" | "settings" | "faults"), key)) => (of, key),
                _ => ("", name.trim()),
            };
            if of == inner {
                lines.push((quoted(key), varied(key, values.trim(), vary)?));
            }
        }
        if !lines.is_empty() {
            let name = if inner.is_empty() { "vary".to_owned() } else { format!("vary.{inner}") };
            table(&mut text, &name, &lines);
        }
    }
    // Without it a plan would be a single flight.
    let expect: Vec<(&str, String)> = list("expect", &args.expect).into_iter().collect();
    text.push_str("\n[campaign]\n");
    expect.iter().for_each(|(key, value)| text.push_str(&format!("{key} = {value}\n")));
    Ok(text)
}

/// Returns the values of an input as TOML.
fn varied(key: &str, values: &str, option: &str) -> Result<String, AppError> {
    if values.starts_with('[') {
        let parsed = toml::from_str::<toml::Table>(&format!("x = {values}"));
        return match parsed.ok().filter(|table| table.len() == 1 && !values.contains('\n')) {
            Some(_) => Ok(values.to_owned()),
            None => Err(AppError::input(format!(
                "--vary {option}: {values} is no list; write [\"none\", \"light\"]"
            ))),
        };
    }
    if WORDS.contains(&key) {
        let words: Vec<String> = values.split(',').map(|word| word.trim().to_owned()).collect();
        return Ok(format!("[{}]", words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(", ")));
    }
    Ok(quoted(values))
}

fn table<K: AsRef<str>>(text: &mut String, name: &str, lines: &[(K, String)]) {
    if lines.is_empty() {
        return;
    }
    text.push_str(&format!("\n[{name}]\n"));
    for (key, value) in lines {
        text.push_str(&format!("{} = {value}\n", key.as_ref()));
    }
}

/// Returns a list of texts, unless it is empty.
fn list<T: ToString>(key: &'static str, texts: &[T]) -> Option<(&'static str, String)> {
    let quoted: Vec<String> = texts.iter().map(|text| quoted(&text.to_string())).collect();
    (!quoted.is_empty()).then(|| (key, format!("[{}]", quoted.join(", "))))
}

/// Returns a text in TOML notation, on one line.
fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

/// Returns a name without its folder and its extension.
fn stem(name: &str) -> String {
    let name = name.rsplit('/').next().unwrap_or(name);
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    if stem.is_empty() || stem == "-" { "plan".to_owned() } else { stem.to_owned() }
}
