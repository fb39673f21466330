//! All settings of a flight controller: values, ranges, defaults and descriptions, for people who look through them.
//!
//! Those of an embedded flight controller come from its configuration, those of a remote one from the output of `get`.
//! Both are in the order of the embedded firmware's table, with the settings that it does not have at the end.

mod of_configuration;
mod of_get;

use crate::firmware::settings;
use crate::text::printable;

/// The heading of settings that the embedded firmware's table does not have.
const OTHERS: &str = "Other builds";

/// All settings at one instant.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct CraftSettings {
    /// Groups are together, in the order of the reference.
    pub all: Vec<CraftSetting>,
}

/// A setting of a flight controller.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct CraftSetting {
    pub name: String,
    /// The heading under which it is documented.
    pub group: &'static str,
    /// The current value in the active profile, as the command line prints it.
    pub value: String,
    /// The value of a fresh craft; `None` if it is not known.
    pub default: Option<String>,
    /// The value after a restart; `None` if it is not known.
    pub saved: Option<String>,
    pub allowed: Allowed,
    /// The profile to which the value belongs, such as `rateprofile 0`; empty if there is one value for the craft.
    pub profile: String,
    /// The unit of the value; empty if it has none or an unknown one.
    pub unit: &'static str,
    /// The description; empty if it is not known.
    pub help: &'static str,
    /// `true` if it is stored and has no effect in this firmware.
    pub is_carried: bool,
    /// `true` if a change takes effect only after the firmware has saved and restarted.
    pub needs_restart: bool,
}

/// The values that a setting accepts.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Allowed {
    /// Not known.
    #[default]
    Unknown,
    /// An integer in a range.
    Number { min: i64, max: i64 },
    /// One word of a list.
    Words(Vec<String>),
    /// This many integers with commas between them.
    Numbers(usize),
    /// A text of at most this many characters.
    Text(usize),
}

impl CraftSettings {
    /// Returns the setting with this name, in any case.
    pub fn find(&self, name: &str) -> Option<&CraftSetting> {
        self.all.iter().find(|setting| setting.name.eq_ignore_ascii_case(name))
    }

    /// Returns the setting with this name, to change it.
    pub fn find_mut(&mut self, name: &str) -> Option<&mut CraftSetting> {
        self.all.iter_mut().find(|setting| setting.name.eq_ignore_ascii_case(name))
    }
}

impl CraftSetting {
    /// Returns `true` if the value is known to differ from that of a fresh craft.
    pub fn is_changed(&self) -> bool {
        self.default.as_ref().is_some_and(|default| *default != self.value)
    }

    /// Returns `true` if the value is known to be lost at a restart.
    pub fn is_unsaved(&self) -> bool {
        self.saved.as_ref().is_some_and(|saved| *saved != self.value)
    }

    /// Checks a typed value and returns it as the command line prints it. The beginning of a word is enough, if no
    /// other word begins so.
    ///
    /// # Errors
    /// Returns the problem and the allowed values in one sentence.
    pub fn read(&self, typed: &str) -> Result<String, String> {
        let typed = typed.trim();
        let wrong = |allowed: String| {
            let shown = printable::line(typed);
            let shown = if shown.is_empty() { "Nothing" } else { &shown };
            Err(format!("{shown} is no value of {}: {allowed}.", self.name))
        };
        match &self.allowed {
            Allowed::Number { min, max } => match typed.parse::<i64>() {
                Ok(number) if (*min..=*max).contains(&number) => Ok(number.to_string()),
                _ => wrong(self.allowed.to_string()),
            },
            Allowed::Words(words) => match word(words, typed) {
                Some(word) => Ok(word.to_owned()),
                None => wrong(self.allowed.to_string()),
            },
            Allowed::Numbers(count) => {
                let numbers: Option<Vec<i64>> =
                    typed.split(',').map(|number| number.trim().parse().ok()).collect();
                match numbers {
                    Some(numbers) if numbers.len() == *count => {
                        Ok(numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(","))
                    }
                    _ => wrong(self.allowed.to_string()),
                }
            }
            Allowed::Text(_) if typed.is_empty() => Ok("-".to_owned()),
            Allowed::Text(most) if typed.chars().count() > *most => wrong(self.allowed.to_string()),
            Allowed::Unknown if typed.is_empty() => wrong("type what the firmware accepts".to_owned()),
            Allowed::Text(_) | Allowed::Unknown => Ok(typed.to_owned()),
        }
    }

    /// Returns the value after `steps` steps: numbers stop at their limits, words wrap around. `None` if it has no
    /// steps.
    pub fn nudged(&self, steps: i64) -> Option<String> {
        match &self.allowed {
            Allowed::Number { min, max } => {
                let by = steps.saturating_mul(step(*min, *max));
                let number = self.value.parse::<i64>().ok()?.saturating_add(by).clamp(*min, *max);
                Some(number.to_string())
            }
            Allowed::Words(words) => {
                let at = words.iter().position(|word| word.eq_ignore_ascii_case(&self.value))?;
                let count = i64::try_from(words.len()).ok()?;
                words.get((at as i64).saturating_add(steps).rem_euclid(count) as usize).cloned()
            }
            Allowed::Unknown | Allowed::Numbers(_) | Allowed::Text(_) => None,
        }
    }
}

/// Returns `true` if two texts are the same value: `on` is `ON`, `05` is `5`.
pub fn same_value(one: &str, other: &str) -> bool {
    match (one.parse::<i64>(), other.parse::<i64>()) {
        (Ok(one), Ok(other)) => one == other,
        _ => one.eq_ignore_ascii_case(other),
    }
}

/// Returns settings as lines of the command line, with a line that selects the profile before the values of each
/// profile.
pub fn cli_block(settings: &[&CraftSetting]) -> String {
    let mut profiles = vec![""];
    for setting in settings {
        if !profiles.contains(&setting.profile.as_str()) {
            profiles.push(&setting.profile);
        }
    }
    let mut block = String::new();
    for profile in profiles {
        let mut lines = settings.iter().filter(|setting| setting.profile == profile).peekable();
        if lines.peek().is_some() && !profile.is_empty() {
            block.push_str(profile);
            block.push('\n');
        }
        for setting in lines {
            block.push_str(&format!("set {} = {}\n", setting.name, setting.value));
        }
    }
    block
}

/// Returns the step of a number: about a hundredth of its range, a power of ten.
fn step(min: i64, max: i64) -> i64 {
    let mut step = 1;
    while max.saturating_sub(min) / 100 >= step * 10 {
        step *= 10;
    }
    step
}

/// Returns the word that is meant: the same one, else the only one that begins so.
fn word<'a>(words: &'a [String], typed: &str) -> Option<&'a str> {
    if let Some(same) = words.iter().find(|word| word.eq_ignore_ascii_case(typed)) {
        return Some(same);
    }
    let begins =
        |word: &&String| word.get(..typed.len()).is_some_and(|start| start.eq_ignore_ascii_case(typed));
    let mut found = words.iter().filter(begins);
    let first = found.next().filter(|_| !typed.is_empty())?;
    found.next().is_none().then_some(first)
}

impl std::fmt::Display for Allowed {
    /// Formats the values for sentences and displays: `10…70`, `OFF ON`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unknown => f.write_str("what the firmware accepts"),
            Self::Number { min, max } => write!(f, "{min}…{max}"),
            Self::Words(words) => f.write_str(&words.join(" ")),
            Self::Numbers(count) => write!(f, "{count} whole numbers with commas between them"),
            Self::Text(most) => write!(f, "at most {most} characters, - for none"),
        }
    }
}

/// Returns what the table of the embedded firmware says about a setting, for one that another firmware reports.
fn described(name: &str) -> CraftSetting {
    let unknown = CraftSetting { name: name.to_owned(), group: OTHERS, ..CraftSetting::default() };
    settings::find(name).filter(|setting| setting.name.eq_ignore_ascii_case(name)).map_or(
        unknown,
        |setting| CraftSetting {
            name: name.to_owned(),
            group: settings::group_of(setting),
            unit: setting.unit(),
            help: setting.help,
            needs_restart: settings::needs_restart(setting.name),
            ..CraftSetting::default()
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn number(value: &str, min: i64, max: i64) -> CraftSetting {
        CraftSetting {
            name: "ap_max_angle".to_owned(),
            value: value.to_owned(),
            allowed: Allowed::Number { min, max },
            ..CraftSetting::default()
        }
    }

    fn words(value: &str) -> CraftSetting {
        let words = ["OFF", "ON", "AUTO"].map(str::to_owned).to_vec();
        CraftSetting { allowed: Allowed::Words(words), ..number(value, 0, 0) }
    }

    #[test]
    fn a_typed_value_is_checked_and_written_as_the_firmware_does() {
        assert_eq!(number("25", 10, 70).read(" 040 "), Ok("40".to_owned()));
        let refused = number("25", 10, 70).read("999").unwrap_err();
        assert_eq!(refused, "999 is no value of ap_max_angle: 10…70.");
        assert!(number("25", 10, 70).read("").unwrap_err().starts_with("Nothing is no value"));
        assert_eq!(words("OFF").read("au"), Ok("AUTO".to_owned()));
        assert_eq!(words("OFF").read("on"), Ok("ON".to_owned()));
        assert!(words("OFF").read("o").unwrap_err().ends_with("OFF ON AUTO."), "two begin so");
        let three = CraftSetting { allowed: Allowed::Numbers(3), ..number("0,0,0", 0, 0) };
        assert_eq!(three.read("1, -2,3"), Ok("1,-2,3".to_owned()));
        assert!(three.read("1,2").is_err());
        let name = CraftSetting { allowed: Allowed::Text(4), ..number("-", 0, 0) };
        assert_eq!((name.read(""), name.read("quad")), (Ok("-".to_owned()), Ok("quad".to_owned())));
        assert!(name.read("quads").is_err());
    }

    #[test]
    fn steps_fit_the_range_and_words_go_round() {
        assert_eq!(number("25", 10, 70).nudged(1).as_deref(), Some("26"));
        assert_eq!(number("500", 100, 5000).nudged(1).as_deref(), Some("510"));
        assert_eq!(number("500", 100, 5000).nudged(-10).as_deref(), Some("400"));
        assert_eq!(number("4990", 100, 5000).nudged(10).as_deref(), Some("5000"));
        assert_eq!(words("AUTO").nudged(1).as_deref(), Some("OFF"));
        assert_eq!(words("OFF").nudged(-1).as_deref(), Some("AUTO"));
        assert_eq!(CraftSetting::default().nudged(1), None);
    }

    #[test]
    fn a_block_selects_the_profile_of_its_values() {
        let in_profile = |profile: &str, name: &str| CraftSetting {
            name: name.to_owned(),
            profile: profile.to_owned(),
            ..number("1", 0, 9)
        };
        let settings = [
            in_profile("profile 0", "p_roll"),
            in_profile("", "small_angle"),
            in_profile("profile 0", "i_roll"),
        ];
        assert_eq!(
            cli_block(&settings.each_ref()),
            "set small_angle = 1\nprofile 0\nset p_roll = 1\nset i_roll = 1\n"
        );
    }

    proptest! {
        #[test]
        fn any_nudge_and_any_text_give_an_allowed_value(
            value in any::<i64>(), min in any::<i64>(), more in 0_i64..i64::MAX, steps in any::<i64>(), text in ".{0,12}",
        ) {
            let setting = number(&value.to_string(), min, min.saturating_add(more));
            let Allowed::Number { min, max } = setting.allowed else { unreachable!() };
            let nudged: i64 = setting.nudged(steps).unwrap().parse().unwrap();
            prop_assert!((min..=max).contains(&nudged));
            for setting in [setting, words(&text)] {
                if let Ok(read) = setting.read(&text) {
                    prop_assert_eq!(setting.read(&read), Ok(read.clone()));
                }
            }
            let stepped = words("ON").nudged(steps).unwrap();
            prop_assert!(["OFF", "ON", "AUTO"].contains(&stepped.as_str()));
        }
    }
}
