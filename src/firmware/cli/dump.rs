//! `dump` and `diff`: the configuration as commands, in an order in which they can be run again.

use strum::IntoEnumIterator;

use super::super::config::{Configuration, Feature, MixRow, RxFailTable};
use super::super::settings::{SETTINGS, Scope, Setting};
use super::session::Session;
use super::{craft, modes, receiver, serial, status};
use crate::telemetry::FirmwareProfile;

/// The part to print.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    /// The craft and the active profiles.
    Master,
    /// The active PID profile.
    Profile,
    /// The active rate profile.
    Rates,
    /// The settings that describe the hardware.
    Hardware,
    /// Everything, with all profiles.
    All,
}

/// The style in which a part is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Style {
    part: Part,
    /// Prints only the differences from a fresh vehicle.
    changes_only: bool,
    /// Prints the default as a comment before each changed line.
    show_defaults: bool,
    /// Omits batch and reset lines and the board's identity.
    bare: bool,
}

pub(super) fn dump(session: &mut Session<'_>, rest: &str) {
    print(session, rest, false);
}

pub(super) fn diff(session: &mut Session<'_>, rest: &str) {
    print(session, rest, true);
}

fn print(session: &mut Session<'_>, rest: &str, changes_only: bool) {
    let Some(style) = session.understood(style(rest, changes_only)) else { return };
    let fresh = Configuration::default();
    match style.part {
        Part::Profile => profile(session, style, Scope::Profile, active(session, Scope::Profile)),
        Part::Rates => profile(session, style, Scope::RateProfile, active(session, Scope::RateProfile)),
        Part::Hardware | Part::Master | Part::All => craft_sections(session, style, &fresh),
    }
}

fn style(rest: &str, changes_only: bool) -> Option<Style> {
    let mut style = Style { part: Part::Master, changes_only, show_defaults: false, bare: false };
    for (at, word) in rest.split_ascii_whitespace().enumerate() {
        match (word.to_ascii_lowercase().as_str(), at) {
            ("master", 0) => style.part = Part::Master,
            ("profile", 0) => style.part = Part::Profile,
            ("rates", 0) => style.part = Part::Rates,
            ("hardware", 0) => style.part = Part::Hardware,
            ("all", 0) => style.part = Part::All,
            ("defaults" | "showdefaults", _) => style.show_defaults = true,
            ("bare", _) => style.bare = true,
            _ => return None,
        }
    }
    Some(style)
}

fn active(session: &Session<'_>, scope: Scope) -> u8 {
    session.configuration.settings.active(scope)
}

fn craft_sections(session: &mut Session<'_>, style: Style, fresh: &Configuration) {
    let all = style.part == Part::All;
    session.heading("version");
    let version = status::version_line(session);
    session.line(version);
    if !style.bare {
        session.heading("start the command batch");
        session.line("batch start");
        if all && style.changes_only {
            session.heading("reset configuration to default settings");
            session.line("defaults nosave");
        }
    }
    identity(session, style);
    features(session, style, fresh);
    if style.part != Part::Hardware {
        mixer(session, style, fresh);
        receiver_and_modes(session, style, fresh);
        plan(session, style);
    }
    let master: Vec<String> = setting_lines(session, style, Scope::Master, 0);
    section(session, "master", &master);
    if style.part != Part::Hardware {
        profiles(session, style);
    }
    if all && !style.bare {
        session.heading("save configuration");
        session.raw("save");
    } else if !style.bare {
        session.heading("end the command batch");
        session.line("batch end");
    }
}

/// Prints a heading and its lines, or nothing if there are no lines.
fn section(session: &mut Session<'_>, title: &str, lines: &[String]) {
    if lines.is_empty() {
        return;
    }
    session.heading(title);
    for line in lines {
        session.line(line);
    }
}

fn identity(session: &mut Session<'_>, style: Style) {
    session.line("");
    let names = [
        ("board_name", session.configuration.board_name.clone()),
        ("manufacturer_id", session.configuration.manufacturer_id.clone()),
    ];
    for (command, name) in names {
        if !style.changes_only || !name.is_empty() {
            session.line(format_args!("{command} {name}"));
        }
    }
    if style.part == Part::All && !style.bare {
        session.line(format_args!("mcu_id {}", status::MCU_ID));
        session.line("signature ");
    }
    let craft = session.configuration.settings.text("craft_name").to_owned();
    if style.part != Part::Hardware && (!style.changes_only || !craft.is_empty()) {
        let craft = if craft.is_empty() { "-" } else { craft.as_str() };
        session.heading(format_args!("name: {craft}"));
    }
}

fn features(session: &mut Session<'_>, style: Style, fresh: &Configuration) {
    let (now, default) = (session.configuration.features, fresh.features);
    let mut lines = Vec::new();
    if !style.changes_only {
        lines.extend(Feature::iter().map(|feature| format!("feature -{feature}")));
        lines.extend(
            Feature::iter().filter(|feature| now.has(*feature)).map(|feature| format!("feature {feature}")),
        );
    } else {
        for feature in Feature::iter().filter(|feature| now.has(*feature) != default.has(*feature)) {
            let (on, off) = (format!("feature {feature}"), format!("feature -{feature}"));
            let (line, was) = if now.has(feature) { (on, off) } else { (off, on) };
            lines.push(line);
            if style.show_defaults {
                lines.push(format!("#{was}"));
            }
        }
    }
    section(session, "feature", &lines);
}

fn mixer(session: &mut Session<'_>, style: Style, fresh: &Configuration) {
    let kind = session.configuration.mixer;
    let mix = session.configuration.custom_mix;
    let used = mix.iter().enumerate().filter(|(_, row)| **row != MixRow::default());
    let rows: Vec<String> = used.map(|(at, row)| craft::mix_row(at, row)).collect();
    let kind_lines = rows_of(style, [(format!("mixer {kind}"), format!("mixer {}", fresh.mixer))]);
    if kind_lines.is_empty() && rows.is_empty() {
        return;
    }
    session.heading("mixer");
    for line in kind_lines {
        session.line(line);
    }
    session.line("\r\nmmix reset\r\n");
    for row in rows {
        session.line(row);
    }
}

/// Returns the lines of a section: all of them, or only those that differ from their default.
fn rows_of(style: Style, rows: impl IntoIterator<Item = (String, String)>) -> Vec<String> {
    let mut lines = Vec::new();
    for (line, default) in rows {
        let changed = line != default;
        if changed && style.show_defaults {
            lines.push(format!("#{default}"));
        }
        if changed || !style.changes_only {
            lines.push(line);
        }
    }
    lines
}

/// Pairs each row of a table with the same row of a fresh vehicle.
fn table<T: Copy>(now: &[T], fresh: &[T], row: impl Fn(usize, T) -> String) -> Vec<(String, String)> {
    now.iter().zip(fresh).enumerate().map(|(at, (now, fresh))| (row(at, *now), row(at, *fresh))).collect()
}

fn receiver_and_modes(session: &mut Session<'_>, style: Style, fresh: &Configuration) {
    let configuration = &*session.configuration;
    let RxFailTable(fail) = configuration.rx_fail;
    let RxFailTable(fresh_fail) = fresh.rx_fail;
    let map = [(format!("map {}", configuration.channel_map), format!("map {}", fresh.channel_map))];
    let sections = [
        ("map", rows_of(style, map)),
        ("serial", serial_lines(configuration, style, fresh)),
        (
            "aux",
            rows_of(style, table(&configuration.modes, &fresh.modes, |at, row| modes::aux_row(at, &row))),
        ),
        (
            "adjrange",
            rows_of(
                style,
                table(&configuration.adjustments, &fresh.adjustments, |at, row| {
                    modes::adjustment_row(at, &row)
                }),
            ),
        ),
        ("rxrange", rows_of(style, table(&configuration.rx_ranges, &fresh.rx_ranges, receiver::range_row))),
        ("rxfail", rows_of(style, table(&fail, &fresh_fail, receiver::fail_row))),
    ];
    for (title, lines) in sections {
        section(session, title, &lines);
    }
}

/// Returns the rows of the changed serial ports. Unchanged ports are not printed, even by `dump`.
fn serial_lines(configuration: &Configuration, style: Style, fresh: &Configuration) -> Vec<String> {
    let rows = configuration.serial.0.iter().zip(&fresh.serial.0).enumerate();
    let changed = rows.filter(|(_, (now, fresh))| now != fresh).map(|(at, (now, default))| {
        let line = serial::serial_row(configuration, at, now);
        (line, serial::serial_row(fresh, at, default))
    });
    rows_of(Style { changes_only: true, ..style }, changed)
}

fn plan(session: &mut Session<'_>, style: Style) {
    let mut lines = super::waypoint::lines(session);
    if session.configuration.settings.profile() == FirmwareProfile::Master {
        // The profile decides about the reference of the altitudes, so it must be set before them.
        lines.insert(0, "set ap_profile = MASTER".to_owned());
    }
    if !style.changes_only {
        section(session, "waypoint", &lines);
    } else if !session.configuration.plan.waypoints.is_empty() {
        for line in lines {
            session.line(line);
        }
    }
}

/// Returns the `set` lines of one section, followed by the lines that were kept for it.
fn setting_lines(session: &Session<'_>, style: Style, scope: Scope, instance: u8) -> Vec<String> {
    let settings = &session.configuration.settings;
    let hardware = style.part == Part::Hardware;
    // A port row may move the MSP ports, so the settings that own them are printed even if unchanged.
    let fresh_ports = super::super::config::SerialTable::default() == session.configuration.serial;
    let line = |setting: &Setting| {
        let now = setting.display(settings.value(setting, instance)?);
        let default = setting.display(&settings.resolved(setting).default_value());
        Some((format!("set {} = {now}", setting.name), format!("set {} = {default}", setting.name)))
    };
    let mut lines = Vec::new();
    for setting in SETTINGS.iter().filter(|setting| setting.scope == scope && (setting.hardware || !hardware))
    {
        let forced = !fresh_ports && setting.name.starts_with("msp_uart_");
        lines.extend(rows_of(Style { changes_only: style.changes_only && !forced, ..style }, line(setting)));
    }
    if !hardware {
        lines.extend(
            session.configuration.kept.of(scope, instance).map(super::super::config::KeptLine::command),
        );
    }
    lines
}

fn profiles(session: &mut Session<'_>, style: Style) {
    if style.part != Part::All {
        for scope in [Scope::Profile, Scope::RateProfile, Scope::BatteryProfile] {
            profile(session, style, scope, active(session, scope));
        }
        return;
    }
    every_profile(session, style, Scope::Profile);
    restore(session, style, Scope::Profile);
    every_profile(session, style, Scope::RateProfile);
    every_profile(session, style, Scope::BatteryProfile);
    restore(session, style, Scope::RateProfile);
    restore(session, style, Scope::BatteryProfile);
}

fn every_profile(session: &mut Session<'_>, style: Style, scope: Scope) {
    for instance in 0..scope.instances() {
        profile(session, style, scope, instance);
    }
}

fn profile(session: &mut Session<'_>, style: Style, scope: Scope, instance: u8) {
    let title = format!("{} {instance}", scope.word());
    session.line(format_args!("\r\n{title}"));
    let lines = setting_lines(session, style, scope, instance);
    section(session, &title, &lines);
}

fn restore(session: &mut Session<'_>, style: Style, scope: Scope) {
    if style.bare {
        return;
    }
    let instance = active(session, scope);
    session.heading(format_args!("restore original {} selection", scope.word()));
    session.line(format_args!("{} {instance}", scope.word()));
}
