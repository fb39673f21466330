//! The failures that can be tried at this instant.

use crate::sim::{Wind, WorldCommand};

/// The increase of the wind, m/s.
const FRESHER_MPS: f64 = 8.0;

/// A failure to try.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WhatIf {
    /// Name in one word, to be typed.
    pub name: &'static str,
    /// Title in a few words, for a list and in front of the outcome.
    pub title: &'static str,
    change: Change,
}

/// The change of the world.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Change {
    /// A command in the words of [`WorldCommand::parse`].
    Command(&'static str),
    /// The mean wind gets stronger; in a calm it comes from the west.
    FresherWind,
}

/// All failures, the likely ones first.
pub const WHAT_IFS: [WhatIf; 9] = [
    what_if("gps-loss", "GPS lost here", "fault=gps-loss"),
    what_if("rx-loss", "RC lost here", "fault=rx-loss"),
    WhatIf { name: "wind", title: "wind +8 m/s", change: Change::FresherWind },
    what_if("gust", "gust 12 m/s from the north", "gust-now=12@0"),
    what_if("motor", "motor 2 at 70 %", "fault=motor,,2:0.7"),
    what_if("battery", "battery 1.5 V lower", "fault=battery,,-1.5"),
    what_if("gps-glitch", "GPS jumps 30 m to the east", "fault=gps-glitch,,30@90"),
    what_if("mag-bias", "compass 45° off", "fault=mag-bias,,45"),
    what_if("baro-drift", "barometer drifts 1 Pa/s", "fault=baro-drift,,1"),
];

const fn what_if(name: &'static str, title: &'static str, command: &'static str) -> WhatIf {
    WhatIf { name, title, change: Change::Command(command) }
}

impl WhatIf {
    /// Returns the command for a world with this mean wind.
    pub(super) fn command(&self, wind: Wind) -> Result<WorldCommand, String> {
        match self.change {
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
    fn a_fresher_wind_keeps_its_direction() {
        let fresher = WHAT_IFS[2].command(Wind { speed_mps: 3.0, from_deg: 120.0 });
        assert_eq!(fresher, Ok(WorldCommand::SetWind(Wind { speed_mps: 11.0, from_deg: 120.0 })));
        let calm = WHAT_IFS[2].command(Wind::CALM);
        assert_eq!(calm, Ok(WorldCommand::SetWind(Wind { speed_mps: 8.0, from_deg: 270.0 })));
    }
}
