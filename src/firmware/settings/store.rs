//! The values of all settings.

use super::parse::{check, parse};
use super::table::{SETTINGS, find, slots};
use super::{AssignError, Kind, Scope, Setting, profile};
use crate::telemetry::FirmwareProfile;
use strum::IntoEnumIterator;

/// The value of one setting.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Value {
    /// A number, the position of a word in its list, or the number of a port.
    Number(i64),
    /// The elements of an array.
    Array(Vec<i64>),
    /// A text.
    Text(String),
}

/// The values of all settings in all profiles.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    values: Vec<Value>,
    active: [u8; 4],
}

impl Default for Settings {
    fn default() -> Self {
        let mut values = Vec::new();
        for scope in Scope::iter() {
            for _ in 0..scope.instances() {
                values.extend(of_scope(scope).map(Setting::default_value));
            }
        }
        Self { values, active: [0; 4] }
    }
}

/// Returns the settings of one scope in table order.
fn of_scope(scope: Scope) -> impl Iterator<Item = &'static Setting> {
    SETTINGS.iter().filter(move |setting| setting.scope == scope)
}

impl Settings {
    /// Returns a number, the position of the chosen word, or a port number, in the active profile; 0 for any other
    /// name.
    pub fn number(&self, name: &str) -> i64 {
        match find(name).and_then(|setting| self.active_value(setting)) {
            Some(Value::Number(number)) => *number,
            _ => 0,
        }
    }

    /// Returns `true` if a switch of the active profile is ON; `false` for any other name.
    pub fn flag(&self, name: &str) -> bool {
        self.number(name) != 0
    }

    /// Returns a text, or the chosen word in canonical case; empty for any other name.
    pub fn text(&self, name: &str) -> &str {
        let Some(setting) = find(name) else { return "" };
        match (self.active_value(setting), setting.kind) {
            (Some(Value::Text(text)), _) => text,
            (Some(Value::Number(at)), Kind::Choice { words, .. }) => super::word_at(words, *at),
            (Some(Value::Number(at)), Kind::Port { .. }) => super::word_at(&super::PORT_NAMES, *at),
            _ => "",
        }
    }

    /// Returns the elements of an array setting; empty for any other name.
    pub fn array(&self, name: &str) -> &[i64] {
        match find(name).and_then(|setting| self.active_value(setting)) {
            Some(Value::Array(numbers)) => numbers,
            _ => &[],
        }
    }

    /// Returns the value of a setting in one profile; `None` if the profile does not exist.
    pub fn value(&self, setting: &Setting, instance: u8) -> Option<&Value> {
        self.values.get(offset(setting, instance)?)
    }

    /// Returns the value of a setting in the active profile.
    pub fn active_value(&self, setting: &Setting) -> Option<&Value> {
        self.value(setting, self.active(setting.scope))
    }

    /// Returns `true` if a setting differs from its default in one profile.
    pub fn is_changed(&self, setting: &Setting, instance: u8) -> bool {
        self.value(setting, instance).is_some_and(|value| *value != self.resolved(setting).default_value())
    }

    /// Returns the settings of the active profiles that differ from their defaults: name, value and default.
    pub fn changed(&self) -> impl Iterator<Item = (String, String, String)> + '_ {
        let changed = SETTINGS.iter().filter(|setting| self.is_changed(setting, self.active(setting.scope)));
        changed.filter_map(|setting| {
            let value = setting.display(self.active_value(setting)?);
            Some((setting.name.to_owned(), value, setting.display(&self.resolved(setting).default_value())))
        })
    }

    /// Returns the active instance of a scope.
    pub fn active(&self, scope: Scope) -> u8 {
        self.active[scope as usize]
    }

    /// Makes another profile the active one. Returns `false` if the instance does not exist.
    pub fn select(&mut self, scope: Scope, instance: u8) -> bool {
        let exists = instance < scope.instances();
        if exists {
            self.active[scope as usize] = instance;
        }
        exists
    }

    /// Parses `text` as the value of a setting of the active profile.
    pub fn assign(&mut self, setting: &Setting, text: &str) -> Result<(), AssignError> {
        self.assign_in(setting, self.active(setting.scope), text)
    }

    /// Parses `text` as the value of a setting of one profile.
    pub fn assign_in(&mut self, setting: &Setting, instance: u8, text: &str) -> Result<(), AssignError> {
        self.put(setting, instance, parse(&self.resolved(setting), text)?)
    }

    /// Sets a number, word position or port number in the active profile.
    pub fn set_number(&mut self, name: &str, number: i64) -> Result<(), AssignError> {
        self.set(name, Value::Number(number))
    }

    /// Sets a text of the active profile. The empty text is allowed.
    pub fn set_text(&mut self, name: &str, text: &str) -> Result<(), AssignError> {
        self.set(name, Value::Text(text.to_owned()))
    }

    /// Sets any value in the active profile.
    pub fn set(&mut self, name: &str, value: Value) -> Result<(), AssignError> {
        let setting = find(name).ok_or(AssignError::UnknownName)?;
        self.put(setting, self.active(setting.scope), value)
    }

    /// Sets a value in one profile after checking it.
    pub fn put(&mut self, setting: &Setting, instance: u8, value: Value) -> Result<(), AssignError> {
        let value = check(&self.resolved(setting), value)?;
        let from = self.profile();
        let place = offset(setting, instance).and_then(|at| self.values.get_mut(at));
        let place = place.ok_or(AssignError::UnknownName)?;
        *place = value;
        if setting.name == profile::NAME {
            self.follow_profile(from);
        }
        Ok(())
    }

    /// Returns the profile of the autopilot.
    pub fn profile(&self) -> FirmwareProfile {
        if self.flag(profile::NAME) { FirmwareProfile::Master } else { FirmwareProfile::Guide }
    }

    /// Chooses the profile of the autopilot.
    pub fn set_profile(&mut self, profile: FirmwareProfile) {
        // The value is one of the setting's.
        self.set_number(profile::NAME, i64::from(profile == FirmwareProfile::Master)).ok();
    }

    /// Returns a setting with the permitted values, the default and the role that it has in the present profile.
    pub fn resolved(&self, setting: &Setting) -> Setting {
        profile::resolved(setting, self.profile())
    }

    /// Gives settings that had the default of the profile `from` that of the present one, and limits the others to their
    /// ranges.
    fn follow_profile(&mut self, from: FirmwareProfile) {
        for setting in profile::names().filter_map(find) {
            let (before, now) = (profile::resolved(setting, from), self.resolved(setting));
            let Some(place) = offset(setting, 0).and_then(|at| self.values.get_mut(at)) else { continue };
            if *place == before.default_value() {
                *place = now.default_value();
            } else if let (Value::Number(number), Kind::Number { min, max, .. }) = (&mut *place, now.kind) {
                *number = (*number).clamp(min, max);
            }
        }
    }

    /// Resets all values and the profile selection to those of a fresh vehicle.
    pub fn reset(&mut self) {
        *self = Self::default();
    }
}

/// Returns the position of a setting's value in the store.
fn offset(setting: &Setting, instance: u8) -> Option<usize> {
    if instance >= setting.scope.instances() {
        return None;
    }
    let before: usize = Scope::iter()
        .take_while(|scope| *scope != setting.scope)
        .map(|scope| slots(scope) * usize::from(scope.instances()))
        .sum();
    Some(before + usize::from(instance) * slots(setting.scope) + setting.slot)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_keep_their_own_values() {
        let mut settings = Settings::default();
        assert!(settings.select(Scope::Profile, 2));
        settings.set_number("p_roll", 99).expect("allowed");
        assert!(settings.select(Scope::RateProfile, 3));
        settings.set_number("roll_srate", 11).expect("allowed");
        assert_eq!((settings.number("p_roll"), settings.number("roll_srate")), (99, 11));
        assert!(settings.select(Scope::Profile, 0) && settings.select(Scope::RateProfile, 0));
        assert_eq!((settings.number("p_roll"), settings.number("roll_srate")), (45, 67));
        assert!(!settings.select(Scope::Profile, 4) && !settings.select(Scope::BatteryProfile, 3));
        assert_eq!(settings.active(Scope::Profile), 0);
    }

    #[test]
    fn refused_values_change_nothing_and_reset_brings_all_defaults_back() {
        let mut settings = Settings::default();
        settings.set_number("small_angle", 25).expect("allowed");
        assert_eq!(settings, Settings::default(), "the value was there already");
        settings.set_number("small_angle", 180).expect("allowed");
        let changed = settings.clone();
        assert_ne!(changed, Settings::default());
        settings.set_number("small_angle", 181).expect_err("too large");
        assert_eq!(settings, changed);
        assert!(settings.select(Scope::Profile, 1));
        assert_ne!(settings, changed);
        settings.reset();
        assert_eq!(settings, Settings::default());
    }

    #[test]
    fn wrong_names_and_kinds_answer_with_nothing() {
        let mut settings = Settings::default();
        assert_eq!((settings.number("nonsense"), settings.text("nonsense")), (0, ""));
        assert_eq!((settings.number("craft_name"), settings.text("small_angle")), (0, ""));
        assert_eq!(settings.array("motor_output_reordering"), [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!((settings.text("ap_yaw_mode"), settings.text("msp_uart_1")), ("VELOCITY", "UART1"));
        assert!(settings.flag("ap_l1_enable"));
        assert_eq!(settings.set_text("small_angle", "1"), Err(AssignError::InvalidValue));
        assert_eq!(settings.set_number("ap_yaw_mode", 5), Err(AssignError::InvalidValue));
        assert_eq!(settings.set_number("nonsense", 5), Err(AssignError::UnknownName));
        assert_eq!(
            settings.set_text("craft_name", "seventeen letters"),
            Err(AssignError::TextTooLong { max: 16 })
        );
        assert_eq!(settings.set_text("craft_name", "a#b"), Err(AssignError::InvalidValue));
    }
}
