//! The failures that can be tried at this instant.

use std::borrow::Cow;

use crate::sim::{ScheduledFault, Wind, WorldCommand};

/// The increase of the wind, m/s.
const FRESHER_MPS: f64 = 8.0;

/// A failure to try.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WhatIf {
    /// Name in one word, to be typed.
    pub name: &'static str,
    /// Title in a few words, for a list and in front of the outcome.
    pub title: Cow<'static, str>,
    change: Change,
}

/// The change of the world.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Change {
    /// A command in the words of [`WorldCommand::parse`].
    Command(Cow<'static, str>),
    /// The mean wind gets stronger; in a calm it comes from the west.
    FresherWind,
}

/// All failures, the likely ones first.
pub const WHAT_IFS: [WhatIf; 9] = [
    what_if("gps-loss", "GPS lost here", "fault=gps-loss"),
    what_if("rx-loss", "RC lost here", "fault=rx-loss"),
    WhatIf { name: "wind", title: Cow::Borrowed("wind +8 m/s"), change: Change::FresherWind },
    what_if("gust", "gust 12 m/s from the north", "gust-now=12@0"),
    what_if("motor", "motor 2 at 70 %", "fault=motor,,2:0.7"),
    what_if("battery", "battery 1.5 V lower", "fault=battery,,-1.5"),
    what_if("gps-glitch", "GPS jumps 30 m to the east", "fault=gps-glitch,,30@90"),
    what_if("mag-bias", "compass 45° off", "fault=mag-bias,,45"),
    what_if("baro-drift", "barometer drifts 1 Pa/s", "fault=baro-drift,,1"),
];

const fn what_if(name: &'static str, title: &'static str, command: &'static str) -> WhatIf {
    WhatIf { name, title: Cow::Borrowed(title), change: Change::Command(Cow::Borrowed(command)) }
}

/// The name of a what-if with a value.
const GIVEN: &str = "given";

impl WhatIf {
    /// Reads a failure of the list by its name, or one with values of its own: a fault as `NAME[,FOR][,VALUE]`, and the
    /// wind or a gust as `wind,,SPEED@FROM` and `gust,,SPEED@FROM`.
    ///
    /// # Errors
    /// Fails with a sentence if it is neither.
    pub fn parse(text: &str) -> Result<Self, String> {
        if let Some(known) = WHAT_IFS.into_iter().find(|what_if| what_if.name == text) {
            return Ok(known);
        }
        let (name, values) = text.split_once(',').unwrap_or((text, ""));
        let word = match name {
            "wind" => "wind",
            "gust" => "gust-now",
            _ => {
                let fault = ScheduledFault::without_time(text)?.timeless();
                return Self::given(fault.clone(), format!("fault={fault}"));
            }
        };
        let Some(value) = values.strip_prefix(',') else {
            return Err(format!(
                "a {name} has no duration; write {name},,SPEED@FROM, such as {name},,14@270"
            ));
        };
        Self::given(format!("{name} {value}"), format!("{word}={value}"))
    }

    fn given(title: String, command: String) -> Result<Self, String> {
        WorldCommand::parse(&command).map_err(|error| error.problem().to_owned())?;
        Ok(Self { name: GIVEN, title: title.into(), change: Change::Command(command.into()) })
    }

    /// Returns the command for a world with this mean wind.
    pub(super) fn command(&self, wind: Wind) -> Result<WorldCommand, String> {
        match &self.change {
            Change::Command(text) => WorldCommand::parse(text).map_err(|error| error.to_string()),
            Change::FresherWind => {
                let from_deg = if wind.speed_mps > 0.0 { wind.from_deg } else { 270.0 };
                let speed_mps = (wind.speed_mps + FRESHER_MPS).min(Wind::MAX_MPS);
                Ok(WorldCommand::SetWind(Wind { speed_mps, from_deg }))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_world_understands_each_of_them() {
        for what_if in &WHAT_IFS {
            assert!(what_if.command(Wind::CALM).is_ok(), "{}", what_if.title);
        }
    }

    #[test]
    fn a_what_if_takes_values_in_the_grammar_of_faults() {
        let command = |text: &str| WhatIf::parse(text).and_then(|what_if| what_if.command(Wind::CALM));
        assert_eq!(
            command("wind,,14@270"),
            Ok(WorldCommand::SetWind(Wind { speed_mps: 14.0, from_deg: 270.0 }))
        );
        assert!(matches!(command("gust,,9@90"), Ok(WorldCommand::GustNow(_))));
        for text in ["gps-loss", "gps-loss,6", "motor,,3:0.5", "payload,,0.4"] {
            assert!(command(text).is_ok_and(|command| command.fault().is_some()), "{text}");
        }
        for (text, said) in [
            ("wind,5,14@270", "wind,,14@270"),
            ("wind,,x", "x"),
            ("gps-loss@3", "leave the time out"),
            ("nothing", "nothing"),
        ] {
            let refused = command(text).expect_err(text);
            assert!(refused.contains(said), "{text}: {refused}");
        }
    }

    #[test]
    fn a_fresher_wind_keeps_its_direction() {
        let fresher = WHAT_IFS[2].command(Wind { speed_mps: 3.0, from_deg: 120.0 });
        assert_eq!(fresher, Ok(WorldCommand::SetWind(Wind { speed_mps: 11.0, from_deg: 120.0 })));
        let calm = WHAT_IFS[2].command(Wind::CALM);
        assert_eq!(calm, Ok(WorldCommand::SetWind(Wind { speed_mps: 8.0, from_deg: 270.0 })));
    }
}
