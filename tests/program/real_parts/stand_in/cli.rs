//! The command line of the stand-in: the part of the public executable's that a ground station uses.

use std::collections::BTreeMap;

/// The known settings with their initial values.
const SETTINGS: [(&str, &str); 12] = [
    ("alt_hold_deadband", "20"),
    ("ap_hover_throttle", "1275"),
    ("ap_landing_descent_rate", "50"),
    ("ap_max_angle", "50"),
    ("ap_max_velocity", "500"),
    ("ap_position_cutoff", "30"),
    ("ap_waypoint_arrival_radius", "500"),
    ("ap_waypoint_hold_radius", "200"),
    ("mag_declination", "0"),
    ("min_check", "1050"),
    ("small_angle", "25"),
    ("trust_mag", "OFF"),
];
const AUX_SLOTS: usize = 20;

/// The effect of a line.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Done {
    /// The line was answered with this text.
    Answered(String),
    /// The line printed this text and ends the program, which must be started again from the outside.
    Reboots(String),
}

/// The stored configuration.
#[derive(Debug, Clone)]
pub(crate) struct Memory {
    settings: BTreeMap<&'static str, String>,
    /// Mode conditions: box, channel, start and end in µs.
    pub(crate) modes: [[u16; 4]; AUX_SLOTS],
    waypoints: Vec<String>,
    /// `true` if every value is refused, as by a firmware with locked settings.
    pub(crate) refuses_settings: bool,
    /// `true` if it was built with flight plans.
    pub(crate) has_plans: bool,
}

impl Memory {
    pub(crate) fn new() -> Self {
        Self {
            settings: SETTINGS.map(|(name, value)| (name, value.to_owned())).into(),
            modes: [[0, 0, 900, 900]; AUX_SLOTS],
            waypoints: Vec::new(),
            refuses_settings: false,
            has_plans: true,
        }
    }

    /// Runs one line.
    pub(crate) fn run(&mut self, line: &str) -> Done {
        let words: Vec<&str> = line.split_whitespace().collect();
        let text = match *words.as_slice() {
            ["save"] => return Done::Reboots("\r\n# saving\r\n\r\nRebooting".to_owned()),
            ["exit"] => {
                let text = "\r\n# leaving CLI mode, unsaved changes lost\r\n\r\nRebooting";
                return Done::Reboots(text.to_owned());
            }
            ["save", "noreboot"] => "\r\n# saving\r\n".to_owned(),
            ["version"] => "# Betaflight / SITL (SITL) 2026.12.0-alpha MSP API: 1.49\r\n".to_owned(),
            ["get", part] => self.get(part),
            ["set", name, "=", value] => self.set(name, value),
            ["aux"] => (0..AUX_SLOTS).map(|slot| self.aux_line(slot)).collect(),
            ["aux", slot, id, channel, start, end, ..] => self.aux([slot, id, channel, start, end]),
            ["diff", ..] => self.diff(),
            ["waypoint", ..] if !self.has_plans => format!("ERR_CMD_NA: {line}\r\n"),
            ["waypoint"] | ["waypoint", "list"] => self.list(),
            ["waypoint", "status"] => {
                format!("Waypoint count: {}\r\n\nRuntime status:\r\n  inactive\r\n", self.waypoints.len())
            }
            ["waypoint", "clear"] => {
                self.waypoints.clear();
                "Waypoints cleared\r\n".to_owned()
            }
            ["waypoint", "insert", index, .., _] if words.len() == 10 => self.insert(index, &words[3..]),
            _ => format!("ERR_CMD_NA: {line}\r\n"),
        };
        Done::Answered(text)
    }

    fn get(&self, part: &str) -> String {
        let found = self.settings.iter().filter(|(name, _)| name.contains(part));
        let text: String = found.map(|(name, value)| format!("{name} = {value}\r\n\r\n")).collect();
        if text.is_empty() { format!("###ERROR IN get: INVALID NAME: {part}###\r\n") } else { text }
    }

    fn set(&mut self, name: &str, value: &str) -> String {
        match self.settings.get_mut(name) {
            Some(kept) if !self.refuses_settings => {
                value.clone_into(kept);
                format!("{name} set to {value}")
            }
            Some(_) => "###ERROR IN set: INVALID VALUE###\r\nAllowed range: 0 - 0\r\n".to_owned(),
            None => format!("###ERROR IN set: INVALID NAME: {name}###\r\n"),
        }
    }

    fn aux(&mut self, words: [&str; 5]) -> String {
        let Ok(numbers) = words.iter().map(|word| word.parse()).collect::<Result<Vec<u16>, _>>() else {
            return "###ERROR IN aux: PARSING FAILED###\r\n".to_owned();
        };
        let slot = usize::from(numbers[0]);
        let Some(mode) = self.modes.get_mut(slot) else {
            return "###ERROR IN aux: INDEX NOT BETWEEN 0 AND 19###\r\n".to_owned();
        };
        mode.copy_from_slice(&numbers[1..]);
        self.aux_line(slot)
    }

    fn aux_line(&self, slot: usize) -> String {
        let [id, channel, start, end] = self.modes[slot];
        format!("aux {slot} {id} {channel} {start} {end} 0 0\r\n")
    }

    fn diff(&self) -> String {
        let changed = SETTINGS.iter().filter(|(name, value)| self.settings[name] != *value);
        let sets: String =
            changed.map(|(name, _)| format!("set {name} = {}\r\n", self.settings[name])).collect();
        let modes: String = (0..AUX_SLOTS)
            .filter(|&slot| self.modes[slot][3] > 900)
            .map(|slot| self.aux_line(slot))
            .collect();
        format!("# version\r\n# Betaflight / SITL (SITL) 2026.12.0-alpha\r\n{modes}{}{sets}", self.list())
    }

    fn insert(&mut self, index: &str, rest: &[&str]) -> String {
        match index.parse::<usize>() {
            Ok(index) if index <= self.waypoints.len() => {
                self.waypoints.insert(index, rest.join(" "));
                format!("waypoint insert {index} {}\r\n", rest.join(" "))
            }
            _ => format!("###ERROR IN waypoint: index NOT BETWEEN 0 AND {}###\r\n", self.waypoints.len()),
        }
    }

    fn list(&self) -> String {
        let lines = self.waypoints.iter().enumerate();
        let lines: String = lines.map(|(k, rest)| format!("waypoint insert {k} {rest}\r\n")).collect();
        format!("waypoint clear\r\n{lines}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_answers_as_the_executable_does() {
        let mut memory = Memory::new();
        let mut say = |line: &str| match memory.run(line) {
            Done::Answered(text) | Done::Reboots(text) => text,
        };
        assert_eq!(say("set ap_max_angle = 25"), "ap_max_angle set to 25");
        assert_eq!(say("get ap_velocity_p"), "###ERROR IN get: INVALID NAME: ap_velocity_p###\r\n");
        assert_eq!(say("aux 0 0 0 1700 2100 0 0"), "aux 0 0 0 1700 2100 0 0\r\n");
        let line = "waypoint insert 0 40.4640000 -79.5175000 32000 0 FLYOVER 0 ORBIT";
        assert_eq!(say(line), format!("{line}\r\n"));
        assert!(say("diff all").contains(line) && say("diff all").contains("set ap_max_angle = 25"));
    }
}
