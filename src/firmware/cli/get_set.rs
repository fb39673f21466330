//! `get` and `set`.

use crate::autopilot::Params;

use super::super::settings::{
    AssignError, Kind, Role, SETTINGS, Scope, Setting, acts_in_master, beyond_current_firmware, find,
    foreign_name,
};
use super::foreign::keep_setting;
use super::session::Session;

/// `get [text]`: prints every setting whose name contains the text.
pub(super) fn get(session: &mut Session<'_>, text: &str) {
    let wanted = text.to_ascii_lowercase();
    let mut found: Vec<&Setting> =
        SETTINGS.iter().filter(|setting| setting.name.to_ascii_lowercase().contains(&wanted)).collect();
    if found.is_empty() {
        found.extend(find(text));
    }
    let kept = kept_values(session, &wanted);
    if found.is_empty() && kept.is_empty() {
        session.error(format_args!("INVALID NAME: {text}"));
        return;
    }
    let mut first = true;
    let mut separate = |session: &mut Session<'_>| {
        if !std::mem::take(&mut first) {
            session.line("");
        }
    };
    for setting in found {
        separate(session);
        block(session, setting);
    }
    for (name, value) in kept {
        separate(session);
        session.line(format_args!("{name} = {value}"));
    }
}

/// Returns the kept settings of other builds whose name contains the text, in the master section and the active
/// profiles.
fn kept_values(session: &Session<'_>, wanted: &str) -> Vec<(String, String)> {
    let settings = &session.configuration.settings;
    session
        .configuration
        .kept
        .iter()
        .filter(|line| !line.name.is_empty() && line.name.to_ascii_lowercase().contains(wanted))
        .filter(|line| line.instance == settings.active(line.scope))
        .map(|line| (line.name.clone(), line.text.clone()))
        .collect()
}

fn block(session: &mut Session<'_>, setting: &Setting) {
    let settings = &session.configuration.settings;
    let setting = &settings.resolved(setting);
    let active = settings.active(setting.scope);
    let changed = settings.is_changed(setting, active);
    let value = current(session, setting);
    session.line(format_args!("{} = {value}", setting.name));
    if setting.scope != Scope::Master {
        session.line(format_args!("{} {active}", setting.scope.word()));
    }
    let range = setting.range_line();
    if !range.is_empty() {
        session.line(range);
    }
    if changed {
        session.line(format_args!("Default value: {}", setting.display(&setting.default_value())));
    }
    // Settings of other groups, and `set` without a value, print the same lines as on the real firmware.
    if setting.role == Role::Carry && Params::field(setting.name).is_some() && session.command == "get" {
        session.line("No effect here");
    }
}

fn current(session: &Session<'_>, setting: &Setting) -> String {
    session
        .configuration
        .settings
        .active_value(setting)
        .map_or_else(String::new, |value| setting.display(value))
}

/// `set`, `set *`, `set <name>`, `set <name> = <value>`.
pub(super) fn set(session: &mut Session<'_>, rest: &str) {
    match rest.split_once('=') {
        Some((name, value)) => assign(session, name.trim(), value.trim(), rest),
        None if rest.is_empty() || rest == "*" => list(session, rest == "*"),
        None => get(session, rest),
    }
}

fn list(session: &mut Session<'_>, with_ranges: bool) {
    session.line("Current settings: ");
    for setting in &SETTINGS {
        let value = current(session, setting);
        session.raw(format_args!("{} = {value}", setting.name));
        if let (true, Kind::Number { min, max, .. }) =
            (with_ranges, session.configuration.settings.resolved(setting).kind)
        {
            session.raw(format_args!(" {min} {max}"));
        }
        session.line("");
    }
}

fn assign(session: &mut Session<'_>, name: &str, value: &str, typed: &str) {
    let Some(setting) = find(name) else {
        match foreign_name(name) {
            Some(name) => keep_setting(session, name, value),
            None => session.error(format_args!("INVALID NAME: {typed}")),
        }
        return;
    };
    match session.configuration.settings.assign(setting, value) {
        Ok(()) => {
            let value = current(session, setting);
            session.raw(format_args!("{} set to {value}", setting.name));
            let profile = session.configuration.settings.profile();
            session.reply.notices.extend(beyond_current_firmware(setting, &value));
            session.reply.notices.extend(acts_in_master(setting, profile, &value));
        }
        Err(error) => {
            if let AssignError::TextTooLong { max } = error {
                session.line(format_args!("STRING MUST BE 1-{max} CHARACTERS OR '-' FOR EMPTY"));
            }
            session.error("INVALID VALUE");
            let range = session.configuration.settings.resolved(setting).range_line();
            if !range.is_empty() {
                session.line(range);
            }
        }
    }
}
