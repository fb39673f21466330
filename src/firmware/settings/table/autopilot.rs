//! The waypoint autopilot. The rows come from its own table of parameters.

use super::super::{Kind, Role, Scope, Setting, Width};
use super::{Group, row};
use crate::autopilot::Params;
use crate::autopilot::params::{Effect, Field};
use crate::telemetry::FirmwareProfile;

/// The number of settings in this group. The parameters after them belong to other groups.
const COUNT: usize = Params::FIELDS.len() - Params::SHARED;

pub(super) const AUTOPILOT: Group = Group::new("Autopilot", Scope::Master, &settings_of_parameters());

const fn settings_of_parameters() -> [Setting; COUNT] {
    let mut all = [setting_of(&Params::FIELDS[0]); COUNT];
    let mut at = 1;
    while at < COUNT {
        all[at] = setting_of(&Params::FIELDS[at]);
        at += 1;
    }
    all
}

/// Returns the setting of an autopilot parameter that is listed in another group.
pub(super) const fn setting(name: &str) -> Setting {
    let mut at = COUNT;
    while !is_same(Params::FIELDS[at].name, name) {
        at += 1;
    }
    setting_of(&Params::FIELDS[at])
}

const fn setting_of(field: &Field) -> Setting {
    let width = if field.bytes == 1 { Width::U8 } else { Width::U16 };
    let (min, max, default) = (field.min, field.max, field.default);
    let kind = if field.words.is_empty() {
        Kind::Number { min, max, default }
    } else {
        Kind::Choice { words: field.words, default }
    };
    let role = match field.effect {
        Effect::Live => Role::Live,
        Effect::Guide => Role::Only(FirmwareProfile::Guide),
        Effect::Master => Role::Only(FirmwareProfile::Master),
    };
    row(field.name, width, kind, role, field.help)
}

const fn is_same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut at = 0;
    while at < a.len() && at < b.len() && a[at] == b[at] {
        at += 1;
    }
    at == a.len() && at == b.len()
}
