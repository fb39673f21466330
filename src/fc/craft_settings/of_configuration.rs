//! The settings of an embedded flight controller.

use super::{Allowed, CraftSetting, CraftSettings, OTHERS};
use crate::firmware::config::Configuration;
use crate::firmware::settings::{self, Kind, PORT_NAMES, Role, Scope, Setting};

/// The description of a line of another build.
const KEPT: &str = "A setting of another build: kept and printed, without an effect here.";

impl CraftSettings {
    /// Returns the settings in the active profiles. A restart brings back the configuration `saved`, if it is known.
    pub fn from_configuration(now: &Configuration, saved: Option<&Configuration>) -> Self {
        let rows = settings::grouped().map(|(group, setting)| row(group, setting, now, saved));
        Self { all: rows.chain(kept(now)).collect() }
    }
}

fn row(
    group: &'static str,
    setting: &Setting,
    now: &Configuration,
    saved: Option<&Configuration>,
) -> CraftSetting {
    let setting = &now.settings.resolved(setting);
    let instance = now.settings.active(setting.scope);
    let shown = |configuration: &Configuration| {
        configuration.settings.value(setting, instance).map(|value| setting.display(value))
    };
    let profile = match setting.scope {
        Scope::Master => String::new(),
        scope => format!("{} {instance}", scope.word()),
    };
    CraftSetting {
        name: setting.name.to_owned(),
        group,
        value: shown(now).unwrap_or_default(),
        default: Some(setting.display(&setting.default_value())),
        saved: saved.and_then(shown),
        allowed: allowed(setting.kind),
        profile,
        unit: setting.unit(),
        help: setting.help,
        is_carried: setting.role == Role::Carry,
        needs_restart: settings::needs_restart(setting.name),
    }
}

fn allowed(kind: Kind) -> Allowed {
    let words = |words: &[&str]| Allowed::Words(words.iter().map(|&word| word.to_owned()).collect());
    match kind {
        Kind::Number { min, max, .. } => Allowed::Number { min, max },
        Kind::Choice { words: list, .. } => words(list),
        Kind::Port { .. } => words(&PORT_NAMES),
        Kind::Array { default } => Allowed::Numbers(default.len()),
        Kind::Text { max } => Allowed::Text(max),
    }
}

/// Returns the kept settings of other builds, in the master section and the active profiles.
fn kept(now: &Configuration) -> impl Iterator<Item = CraftSetting> + '_ {
    let is_shown = |scope: Scope, instance: u8| instance == now.settings.active(scope);
    let lines =
        now.kept.iter().filter(move |line| !line.name.is_empty() && is_shown(line.scope, line.instance));
    lines.map(|line| CraftSetting {
        name: line.name.clone(),
        group: OTHERS,
        value: line.text.clone(),
        help: KEPT,
        is_carried: true,
        ..CraftSetting::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_of_the_table_has_its_value_its_default_and_its_range() {
        let mut now = Configuration::default();
        let saved = now.clone();
        now.settings.set_number("ap_max_angle", 25).unwrap();
        now.settings.set_number("p_roll", 60).unwrap();
        let read = CraftSettings::from_configuration(&now, Some(&saved));
        assert_eq!(read.all.len(), settings::SETTINGS.len());
        let angle = read.find("AP_MAX_ANGLE").unwrap();
        assert_eq!((angle.value.as_str(), angle.default.as_deref()), ("25", Some("50")));
        assert_eq!((angle.unit, &angle.allowed), ("deg", &Allowed::Number { min: 10, max: 70 }));
        assert!(angle.is_changed() && angle.is_unsaved() && !angle.is_carried && !angle.needs_restart);
        assert_eq!(read.find("p_roll").unwrap().profile, "profile 0");
        assert!(read.find("mag_hardware").unwrap().needs_restart);
        for setting in &read.all {
            assert_eq!(setting.read(&setting.value).as_ref(), Ok(&setting.value), "{}", setting.name);
            assert!(!setting.help.is_empty() && setting.allowed != Allowed::Unknown, "{}", setting.name);
        }
        assert_eq!(read.all.iter().filter(|setting| setting.is_changed()).count(), 2);
    }
}
