//! The longer texts of `--help`.

use crate::sim::{FAULTS, FaultInfo, SWITCHES};

/// The sources of values, for the end of the help of commands that fly.
pub(super) const LAYERS: &str = "\
Each option can also be set in the configuration file (wind = \"5@270\") and in the environment
(BETADECK_WIND=5@270); the command line overrides the environment, which overrides the file.";

/// The end of the help of `fly`.
pub(super) const FLY: &str = "\
T is in simulated seconds from the moment the autopilot engages; boot+T counts from boot.

Exit codes: 0 the mission truly completed, 1 it did not, 2 wrong usage or input, 3 file or port trouble,
4 internal error, 130 interrupted.

Each option can also be set in the configuration file (wind = \"5@270\") and in the environment
(BETADECK_WIND=5@270); the command line overrides the environment, which overrides the file.";

/// The end of the help of `compare`.
pub(super) const COMPARE: &str = "\
Everything is measured from truth, in the same way for both. The embedded firmware, and an executable in simulated time,
fly as fast as the machine allows: once, because each of their flights is the same, or with each of --seeds. A firmware
on the wall clock flies --repeat times. Each flight starts from defaults, an executable in an empty folder each time.
attach uses a running firmware as it is, and once.

Exit codes: 0 every flight completed (with --log: both were measured), 1 one did not,
2 wrong usage or input, 3 file or port trouble, 4 internal error, 130 interrupted.

Each option can also be set in the configuration file (wind = \"5@270\") and in the environment
(BETADECK_WIND=5@270); the command line overrides the environment, which overrides the file.";

/// The end of the help of `lab`.
pub(super) const LAB: &str = "\
Both executables fly the same flights in simulated time: the scenarios of the test guide, modes by sticks, rescue, failsafe,
fence, faults, landings, random missions. A measure has changed if a test of the paired differences says so and if a pilot
would notice it. docs/firmware-ci.md explains the programme, the tests, and a workflow for pull requests.

Exit codes: 0 nothing is worse (alone: every property was kept), 1 something is, 2 wrong usage, 3 file trouble or a firmware
that could not be flown, 4 internal error, 130 interrupted.";

/// The end of the help of `campaign`.
pub(super) const CAMPAIGN: &str = "\
docs/scenarios.md explains what a file can vary and expect, docs/clusters.md how several machines fly one campaign.
The options below Craft, Air, Time, Flight and Faults are for a plan; a scenario has them in its file.

Exit codes: 0 every expectation of the campaign was met (without one: every flight succeeded), 1 not, 2 wrong usage or
input, 3 file trouble or a firmware that could not be flown, 4 internal error, 130 interrupted.

The firmware can also be set in the configuration file (firmware = \"PATH\") and in the environment
(BETADECK_FIRMWARE=PATH), as can each option below Firmware.";

/// The end of the help of `forecast`.
pub(super) const FORECAST: &str = "\
Each flight draws its wind and its seed. A flight succeeds if it completes as planned with the reserve left. With a fence,
the answer has the least distance left to it. docs/campaigns.md explains the forms of --wind.

Exit codes: 0 go, 1 no-go, 2 wrong usage or input, 3 file trouble, 4 internal error, 130 interrupted.";

/// The end of the help of `check`.
pub(super) const CHECK: &str = "\
docs/scenarios.md explains how to write a scenario.

Exit codes: 0 every expectation was met, 1 one was not, 2 wrong usage or scenario, 3 file trouble,
4 internal error, 130 interrupted.

The firmware can also be set in the configuration file (firmware = \"PATH\") and in the environment
(BETADECK_FIRMWARE=PATH), as can each option below Firmware; the scenario contains everything else of a flight.";

/// Returns the examples of a command for the top of its help: the line to type and its effect.
pub(super) fn examples(examples: &[(&str, &str)]) -> String {
    let mut text = String::from("Examples:");
    for (line, meaning) in examples {
        text.push_str(&format!("\n  {line}"));
        if !meaning.is_empty() {
            text.push_str(&format!("\n      {meaning}"));
        }
    }
    text
}

/// Returns all faults, for the long help of `--fault`.
pub(super) fn faults() -> String {
    let mut text = String::from(
        "Something goes wrong at T, for FOR seconds or to the end; repeatable\n\n\
         motor@10,,2:0.8 weakens motor 2 to 80 % after 10 s, gps-loss@boot+20,6 takes the GPS away for 6 s.\n\n\
         NAME (VALUE; default when left out):\n",
    );
    // Without an external simulator, faults of its link have no effect.
    text.extend(FAULTS.iter().filter(|fault| !fault.needs_link()).map(fault_line));
    text.trim_end().to_owned()
}

/// Returns all faults, for the long help of `--fault` of commands that allow an external simulator.
pub(super) fn faults_with_link() -> String {
    let mut text = faults();
    text.push_str("\n\nWith --physics external: rx-loss, gps-loss and\n");
    text.extend(FAULTS.iter().filter(|fault| fault.needs_link()).map(fault_line));
    text.trim_end().to_owned()
}

fn fault_line(fault: &FaultInfo) -> String {
    let value = match (fault.value, fault.default) {
        ("", _) => String::new(),
        (value, "") => format!(" ({value})"),
        (value, default) => format!(" ({value}; {default})"),
    };
    format!("  {}{value}: {}\n", fault.name(), fault.help)
}

/// Returns all switches of the world, for the long help of `--world`.
pub(super) fn world_switches() -> String {
    let mut text =
        String::from("A rare switch of the simulated world, such as battery_sag=on; repeatable\n\n");
    for switch in &SWITCHES {
        text.push_str(&format!("  {}={}: {}\n", switch.name, switch.values, switch.help));
    }
    text.trim_end().to_owned()
}
