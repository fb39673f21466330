//! `[craft]`: the craft, its start position and its settings.

use super::Craft;
use super::keys::CRAFT_KEYS;
use super::reader::{Layers, Reader};
use crate::firmware::AttitudeSource;
use crate::flight::setup::{BootLines, check_setting};
use crate::flight::{FlightOptions, FlightSetup};
use crate::plan::format::{PlanFile, TomlTable, setting_line};
use crate::scenario::case::OWN_LINES;
use crate::sim::{Airframe, Home, STEP_RATES_HZ, Switches, WorldConfig};

pub(super) fn read(layers: &Layers<'_, '_>, plan: PlanFile, reader: &mut Reader<'_, '_>) -> Craft {
    let section = layers.tables("craft", reader);
    for table in &section {
        reader.refuse_unknown(table, CRAFT_KEYS);
    }
    let get = |key| layers.of_section(&section, key);
    let usual = FlightOptions::default();
    let options = FlightOptions {
        takeoff_m: reader.number_in(get("takeoff_m"), 0.0, 500.0, "m").unwrap_or(usual.takeoff_m),
        tolerance_m: reader.number_in(get("tolerance_m"), 0.0, 1e5, "m").unwrap_or(usual.tolerance_m),
        ..usual
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
    let world = WorldConfig {
        airframe: airframe(layers, &section, reader),
        home: Home { heading_deg, ..Home::default() },
        rate_hz: rate(layers, &section, reader),
        switches: switches(layers, &world_tables, reader),
        ..WorldConfig::default()
    };
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
    let setup = FlightSetup { world, home, plan, attitude, boot_lines, ..FlightSetup::default() };
    if let Err(error) = setup.configuration() {
        let place = section.last().map_or(0..0, TomlTable::span);
        reader.problem(place, error.to_string(), "");
    }
    Craft { setup, options, pilot }
}

fn airframe(layers: &Layers<'_, '_>, section: &[TomlTable<'_, '_>], reader: &mut Reader<'_, '_>) -> Airframe {
    let Some(value) = layers.of_section(section, "airframe") else { return Airframe::iris() };
    let Some(name) = reader.text(value) else { return Airframe::iris() };
    let found = if name.ends_with(".toml") {
        reader
            .file(&name)
            .and_then(|text| Airframe::from_toml(text).map_err(|error| error.in_file(&name).to_string()))
    } else {
        name.parse::<Airframe>().map_err(|error| error.to_string())
    };
    found.unwrap_or_else(|problem| {
        reader.problem(value.span(), problem, "");
        Airframe::iris()
    })
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
