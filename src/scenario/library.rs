//! The scenarios in the executable: the same files as in `plans/scenarios/`.

use super::Files;
use crate::plan::format::PlanFile;
use crate::text::did_you_mean;

macro_rules! scenarios {
    ($(#[$comment:meta])* $list:ident $prefix:literal $folder:literal $($name:literal)*) => {
        $(#[$comment])*
        pub const $list: &[BuiltinScenario] = &[
            $(BuiltinScenario {
                name: concat!($prefix, $name),
                text: include_str!(concat!("../../plans/", $folder, "/", $name, ".toml")),
            },)*
        ];
    };
}

scenarios! {
    /// The scenarios of the programme of `lab`, beside the guide's and the missions.
    LAB_SCENARIOS "lab-" "lab"
    "plans"
    "signs"
    "arming"
    "throttle"
    "alt-hold"
    "pos-hold"
    "takeover"
    "corners"
    "altitude"
    "hold"
    "landing"
    "rescue"
    "compass"
    "rx-loss"
    "fence"
    "gps"
    "baro"
}

scenarios! {
    /// All built-in scenarios, in the order of a flight of all. Those of `lab` are apart.
    SCENARIOS "" "scenarios"
    "guide-1"
    "guide-2"
    "guide-3"
    "guide-4"
    "guide-5"
    "guide-6"
    "guide-7"
    "guide-8"
    "hold-wind"
    "gust-8"
    "gps-outage"
    "gps-glitch"
    "weak-motor"
    "dead-motor"
    "sag"
    "heavy"
    "bias"
    "strong-wind"
    "takeoff"
    "hill"
    "alt-change"
    "delay"
    "yaw-rate"
    "figure8"
    "min-altitude"
    "thirty-waypoints"
    "antimeridian"
    "southern-hemisphere"
    "five-inch"
    "hover-throttle"
    "worn-motor"
    "low-battery"
    "rough-air"
    "cannot-hold"
    "urban-gps"
    "bad-compass"
    "fix-lost-landing"
    "failsafe-procedures"
    "link-lost-continue"
    "re-engage"
    "upload-in-flight"
    "in-flight-commands"
    "stick-override"
    "flyaway"
    "soak"
    "two-hundred-winds"
}

/// Settings that several scenarios share.
const TEXTS: &[(&str, &str)] = &[("guide.txt", include_str!("../../plans/scenarios/guide.txt"))];

/// A scenario that is part of the executable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltinScenario {
    /// The name on the command line.
    pub name: &'static str,
    /// The text of the scenario file.
    pub text: &'static str,
}

impl BuiltinScenario {
    /// Returns the built-in scenario with this name.
    pub fn find(name: &str) -> Option<Self> {
        SCENARIOS.iter().chain(LAB_SCENARIOS).copied().find(|scenario| scenario.name == name)
    }

    /// Returns the built-in name that is closest to `name`.
    pub fn suggest(name: &str) -> Option<&'static str> {
        did_you_mean::closest(name, SCENARIOS.iter().chain(LAB_SCENARIOS).map(|scenario| scenario.name))
    }
}

/// The files that built-in scenarios name.
#[derive(Debug, Clone, Copy, Default)]
pub struct BuiltinFiles;

impl Files for BuiltinFiles {
    fn plan(&mut self, name: &str) -> Result<PlanFile, String> {
        Err(format!("{name} is not part of this executable: name a built-in plan"))
    }

    fn text(&mut self, name: &str) -> Result<String, String> {
        let found = TEXTS.iter().find(|(known, _)| *known == name);
        found
            .map(|(_, text)| (*text).to_owned())
            .ok_or_else(|| format!("{name} is not part of this executable"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::format::report;

    #[test]
    fn every_file_of_the_folders_is_built_in_reads_and_has_its_row() {
        for (scenarios, folder, prefix) in [(SCENARIOS, "scenarios", ""), (LAB_SCENARIOS, "lab", "lab-")] {
            let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plans").join(folder);
            let mut names: Vec<String> = std::fs::read_dir(folder)
                .unwrap()
                .map(|entry| entry.unwrap().file_name().into_string().unwrap())
                .filter_map(|name| Some(format!("{prefix}{}", name.strip_suffix(".toml")?)))
                .collect();
            names.sort();
            let mut built_in: Vec<&str> = scenarios.iter().map(|scenario| scenario.name).collect();
            built_in.sort_unstable();
            assert_eq!(names, built_in);
        }
        let page = include_str!("../../plans/README.md");
        for scenario in SCENARIOS.iter().chain(LAB_SCENARIOS) {
            let read = crate::scenario::read(scenario.name, scenario.text, None, &mut BuiltinFiles)
                .unwrap_or_else(|errors| panic!("{}", report(&errors)));
            assert!(!read.description.is_empty(), "{}", scenario.name);
            let row = format!("| `{}` | {}", scenario.name, read.description);
            assert!(page.contains(&row), "plans/README.md lacks {row}");
        }
    }
}
