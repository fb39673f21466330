//! `[craft]`: the craft, its start position and its settings.

use strum::IntoEnumIterator as _;

use super::Craft;
use super::keys::{CRAFT_KEYS, OF_FAULTS};
use super::reader::{Layers, Reader};
use crate::firmware::AttitudeSource;
use crate::flight::setup::{BootLines, check_setting};
use crate::flight::{FlightOptions, FlightSetup};
use crate::pilot::StickInput;
use crate::plan::format::{PlanFile, TomlTable, setting_line};
use crate::scenario::case::OWN_LINES;
use crate::scenario::varied::Tolerance;
use crate::signals::SimTime;
use crate::sim::{Airframe, Home, MAX_FAULTS, STEP_RATES_HZ, ScheduledFault, Switches, WorldConfig};
use crate::telemetry::FirmwareProfile;

/// The most stick inputs of a craft.
const MAX_STICKS: usize = 1000;

pub(super) fn read(layers: &Layers<'_, '_>, plan: PlanFile, reader: &mut Reader<'_, '_>) -> Craft {
    let section = layers.tables("craft", reader);
    for table in &section {
        reader.refuse_unknown(table, CRAFT_KEYS);
    }
    let get = |key| layers.of_section(&section, key);
    let usual = FlightOptions::default();
    let timeout_s = reader.number_in(layers.value("timeout_s"), 1.0, 1e6, "s");
    let options = FlightOptions {
        // Without it the time limit of the scenario ends the flight.
        timeout: timeout_s.map_or(SimTime(u64::MAX), SimTime::from_secs_f64),
        takeoff_m: reader.number_in(get("takeoff_m"), 0.0, 500.0, "m").unwrap_or(usual.takeoff_m),
        tolerance_m: reader.number_in(get("tolerance_m"), 0.0, 1e5, "m").unwrap_or(usual.tolerance_m),
    };
    let pilot = match get("pilot").and_then(|value| Some((value, reader.text(value)?))) {
        None => true,
        Some((_, word)) if word == "scripted" => true,
        Some((_, word)) if word == "none" => false,
        Some((value, word)) => {
            reader.problem(value.span(), format!("{word} is not a pilot"), "allowed: scripted, none");
            true
        }
    };
    let heading_deg = reader.number_in(get("heading_deg"), -360.0, 360.0, "degrees").unwrap_or(0.0);
    let world_tables = layers.tables("air", reader);
    let mut world = WorldConfig {
        airframe: airframe(layers, &section, reader),
        home: Home { heading_deg, ..Home::default() },
        rate_hz: rate(layers, &section, reader),
        switches: switches(layers, &world_tables, reader),
        faults: faults(&world_tables, reader),
        ..WorldConfig::default()
    };
    for of in Tolerance::iter() {
        if let Some(percent) = reader.number_in(get(of.key()), -90.0, 900.0, "%") {
            of.apply(percent, &mut world.airframe, &mut world.switches);
        }
    }
    let home = get("home").and_then(|value| {
        let text = reader.text(value)?;
        text.parse()
            .map_err(|error: crate::plan::format::HomeError| {
                reader.problem(value.span(), error.to_string(), "");
            })
            .ok()
    });
    let attitude = get("attitude").and_then(|value| match reader.text(value)?.as_str() {
        "estimated" => Some(AttitudeSource::Estimated),
        "truth" => Some(AttitudeSource::Truth),
        word => {
            reader.problem(value.span(), format!("{word} is not an attitude"), "allowed: estimated, truth");
            None
        }
    });
    let boot_lines = boot_lines(layers, &section, reader);
    let stick_inputs = sticks(&section, reader);
    let profile = get("profile").and_then(|value| match reader.text(value)?.parse::<FirmwareProfile>() {
        Ok(profile) => Some(profile),
        Err(_) => {
            reader.problem(value.span(), "this is not a profile", "allowed: guide, master");
            None
        }
    });
    let mut setup =
        FlightSetup { world, home, plan, attitude, boot_lines, stick_inputs, ..FlightSetup::default() };
    if let Some(profile) = profile {
        setup.use_profile(profile, false);
    }
    if let Err(error) = setup.configuration() {
        let place = section.last().map_or(0..0, TomlTable::span);
        reader.problem(place, error.to_string(), "");
    }
    Craft { setup, options, pilot }
}

fn airframe(layers: &Layers<'_, '_>, section: &[TomlTable<'_, '_>], reader: &mut Reader<'_, '_>) -> Airframe {
    let Some(value) = layers.of_section(section, "airframe") else { return Airframe::iris() };
    let Some(name) = reader.text(value) else { return Airframe::iris() };
    airframe_named(&name, reader).unwrap_or_else(|problem| {
        reader.problem(value.span(), problem, "");
        Airframe::iris()
    })
}

/// Returns a built-in airframe or that of a file.
pub(super) fn airframe_named(name: &str, reader: &mut Reader<'_, '_>) -> Result<Airframe, String> {
    if name.ends_with(".toml") {
        reader
            .file(name)
            .and_then(|text| Airframe::from_toml(text).map_err(|error| error.in_file(name).to_string()))
    } else {
        name.parse::<Airframe>().map_err(|error| error.to_string())
    }
}

/// Returns the faults with their times, as in the option `--fault`.
fn faults(section: &[TomlTable<'_, '_>], reader: &mut Reader<'_, '_>) -> Vec<ScheduledFault> {
    let mut faults = Vec::new();
    for table in section {
        for (text, span) in reader.texts(table, OF_FAULTS).unwrap_or_default() {
            match text.parse::<ScheduledFault>() {
                Ok(scheduled) if scheduled.fault.needs_link() => {
                    let message = format!("{} needs an external simulator", scheduled.fault.name());
                    reader.problem(span, message, "leave it out");
                }
                Ok(_) if faults.len() >= MAX_FAULTS => {
                    reader.problem(span, "this fault does not fit", format!("allowed: {MAX_FAULTS}"));
                    break;
                }
                Ok(scheduled) => faults.push(scheduled),
                Err(error) => reader.problem(span, error.problem().to_owned(), ""),
            }
        }
    }
    faults
}

/// Returns the inputs of the sticks, as in the option `--stick`.
fn sticks(section: &[TomlTable<'_, '_>], reader: &mut Reader<'_, '_>) -> Vec<StickInput> {
    let mut sticks = Vec::new();
    for table in section {
        for (text, span) in reader.texts(table, "sticks").unwrap_or_default() {
            match text.parse() {
                Ok(_) if sticks.len() >= MAX_STICKS => {
                    reader.problem(span, "this stick input does not fit", format!("allowed: {MAX_STICKS}"));
                    break;
                }
                Ok(stick) => sticks.push(stick),
                Err(problem) => reader.problem(span, problem, ""),
            }
        }
    }
    sticks
}

fn rate(layers: &Layers<'_, '_>, section: &[TomlTable<'_, '_>], reader: &mut Reader<'_, '_>) -> u32 {
    let usual = WorldConfig::default().rate_hz;
    let Some(value) = layers.of_section(section, "rate_hz") else { return usual };
    let rate = reader.integer(value).and_then(|rate| u32::try_from(rate).ok());
    match rate {
        Some(rate) if STEP_RATES_HZ.contains(&rate) => rate,
        Some(rate) => {
            let allowed = STEP_RATES_HZ.map(|rate| rate.to_string()).join(", ");
            reader.problem(
                value.span(),
                format!("{rate} Hz is not a step rate"),
                format!("allowed: {allowed}"),
            );
            usual
        }
        None => usual,
    }
}

fn switches(layers: &Layers<'_, '_>, section: &[TomlTable<'_, '_>], reader: &mut Reader<'_, '_>) -> Switches {
    let mut switches = Switches::default();
    for (text, span) in layers.lines(section, "world", reader) {
        if let Err(error) = switches.set(&text) {
            reader.problem(span, error.problem().to_owned(), "write NAME=VALUE");
        }
    }
    switches
}

/// Returns the settings and command lines in the order in which they are applied.
fn boot_lines(
    layers: &Layers<'_, '_>,
    section: &[TomlTable<'_, '_>],
    reader: &mut Reader<'_, '_>,
) -> Vec<BootLines> {
    let mut all = Vec::new();
    for table in section {
        if let Some(value) = table.get("settings_file")
            && let Some(name) = reader.text(value)
        {
            match reader.file(&name).map(str::len) {
                Ok(bytes) if reader.take_lines(bytes, value.span()) => {
                    let text = reader.file(&name).unwrap_or_default().to_owned();
                    all.push(BootLines { source: name, text });
                }
                Ok(_) => {}
                Err(problem) => reader.problem(value.span(), problem, ""),
            }
        }
    }
    let [of_settings, of_lines] = OWN_LINES;
    let mut settings = Vec::new();
    for (text, span) in layers.lines(section, of_settings, reader) {
        if !reader.take_lines(text.len(), span.clone()) {
            break;
        }
        let Some(setting) = setting_line(&text) else {
            reader.problem(span, "this is not a setting", "write \"ap_max_angle = 25\"");
            continue;
        };
        if let Some((name, value)) = setting.split_once(" = ")
            && let Err(fault) = check_setting(name, value)
        {
            reader.problem(span, fault.message, fault.hint);
            continue;
        }
        settings.push(setting);
    }
    all.push(BootLines::settings(of_settings, &settings));
    let mut lines = Vec::new();
    for (line, span) in layers.lines(section, of_lines, reader) {
        if reader.take_lines(line.len(), span) {
            lines.push(line);
        }
    }
    if !lines.is_empty() {
        all.push(BootLines { source: of_lines.to_owned(), text: lines.join("\n") });
    }
    all
}
