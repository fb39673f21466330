//! The names of flight modes, as each autopilot has them.

use std::collections::BTreeMap;

use super::super::message::AvailableModes;
use super::super::value::{StandardMode, autopilot, mode_flag, system_type};

/// A table of modes: numbers and names.
type Table = &'static [(u32, &'static str)];

const ARDUCOPTER: Table = &[
    (0, "STABILIZE"),
    (1, "ACRO"),
    (2, "ALT_HOLD"),
    (3, "AUTO"),
    (4, "GUIDED"),
    (5, "LOITER"),
    (6, "RTL"),
    (7, "CIRCLE"),
    (9, "LAND"),
    (11, "DRIFT"),
    (13, "SPORT"),
    (14, "FLIP"),
    (15, "AUTOTUNE"),
    (16, "POSHOLD"),
    (17, "BRAKE"),
    (18, "THROW"),
    (19, "AVOID_ADSB"),
    (20, "GUIDED_NOGPS"),
    (21, "SMART_RTL"),
    (22, "FLOWHOLD"),
    (23, "FOLLOW"),
    (24, "ZIGZAG"),
    (25, "SYSTEMID"),
    (26, "AUTOROTATE"),
    (27, "AUTO_RTL"),
    (28, "TURTLE"),
];

const ARDUPLANE: Table = &[
    (0, "MANUAL"),
    (1, "CIRCLE"),
    (2, "STABILIZE"),
    (3, "TRAINING"),
    (4, "ACRO"),
    (5, "FBWA"),
    (6, "FBWB"),
    (7, "CRUISE"),
    (8, "AUTOTUNE"),
    (10, "AUTO"),
    (11, "RTL"),
    (12, "LOITER"),
    (13, "TAKEOFF"),
    (14, "AVOID_ADSB"),
    (15, "GUIDED"),
    (16, "INITIALISING"),
    (17, "QSTABILIZE"),
    (18, "QHOVER"),
    (19, "QLOITER"),
    (20, "QLAND"),
    (21, "QRTL"),
    (22, "QAUTOTUNE"),
    (23, "QACRO"),
    (24, "THERMAL"),
    (25, "LOITERALTQLAND"),
    (26, "AUTOLAND"),
];

const ROVER: Table = &[
    (0, "MANUAL"),
    (1, "ACRO"),
    (3, "STEERING"),
    (4, "HOLD"),
    (5, "LOITER"),
    (6, "FOLLOW"),
    (7, "SIMPLE"),
    (8, "DOCK"),
    (9, "CIRCLE"),
    (10, "AUTO"),
    (11, "RTL"),
    (12, "SMART_RTL"),
    (15, "GUIDED"),
    (16, "INITIALISING"),
];

const PX4: Table = &[
    (0x1_0000, "Manual"),
    (0x2_0000, "Altitude"),
    (0x3_0000, "Position"),
    (0x103_0000, "Orbit"),
    (0x104_0000, "Ready"),
    (0x204_0000, "Takeoff"),
    (PX4_HOLD, "Hold"),
    (PX4_MISSION, "Mission"),
    (0x504_0000, "Return"),
    (0x604_0000, "Land"),
    (0x804_0000, "Follow Me"),
    (0x904_0000, "Precision Land"),
    (0x5_0000, "Acro"),
    (0x6_0000, "Offboard"),
    (0x7_0000, "Stabilized"),
    (0x8_0000, "Rattitude"),
];

/// PX4's mode that holds the position without sticks.
pub(super) const PX4_HOLD: u32 = 0x304_0000;
/// PX4's mode that flies the mission.
pub(super) const PX4_MISSION: u32 = 0x404_0000;

const BETAFLIGHT: Table = &[
    (0, "Acro"),
    (1, "Angle"),
    (2, "Horizon"),
    (3, "Alt Hold"),
    (4, "Pos Hold"),
    (5, "Autopilot"),
    (6, "RTL"),
    (7, "Failsafe"),
];

/// The craft and its mode, from a heartbeat.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ModeNumber {
    pub(super) autopilot: u8,
    pub(super) system_type: u8,
    pub(super) base_mode: u8,
    pub(super) custom: u32,
}

/// The modes that a craft listed itself: number and name by index.
#[derive(Debug, Clone, Default)]
pub(super) struct ListedModes(BTreeMap<u8, (u32, String)>);

impl ListedModes {
    /// Takes a mode. Returns the index of the next one, or `None` at the end of the list.
    pub(super) fn take(&mut self, mode: &AvailableModes) -> Option<u8> {
        let name = match StandardMode::from_code(mode.standard_mode) {
            Some(standard) if mode.mode_name.is_empty() => format!("{standard:?}"),
            _ => mode.mode_name.to_string(),
        };
        self.0.insert(mode.mode_index, (mode.custom_mode, name));
        mode.mode_index.checked_add(1).filter(|next| *next <= mode.number_modes)
    }

    /// Returns the name of the mode of a heartbeat.
    pub(super) fn name(&self, number: ModeNumber) -> String {
        let listed = self.0.values().find(|mode| mode.0 == number.custom).map(|mode| mode.1.clone());
        let known =
            || table(number).iter().find(|mode| mode.0 == number.custom).map(|mode| mode.1.to_owned());
        listed.or_else(known).unwrap_or_else(|| format!("mode {}", number.custom))
    }

    /// Returns the number of a mode for a craft with such a heartbeat. The case of letters does not matter.
    pub(super) fn number(&self, name: &str, number: ModeNumber) -> Option<u32> {
        let listed = self.0.values().find(|mode| mode.1.eq_ignore_ascii_case(name)).map(|mode| mode.0);
        let known = || table(number).iter().find(|mode| mode.1.eq_ignore_ascii_case(name)).map(|mode| mode.0);
        listed.or_else(known)
    }

    /// Returns the names of the modes of a craft with such a heartbeat.
    pub(super) fn names(&self, number: ModeNumber) -> Vec<String> {
        if self.0.is_empty() {
            return table(number).iter().map(|mode| mode.1.to_owned()).collect();
        }
        self.0.values().map(|mode| mode.1.clone()).collect()
    }
}

/// Returns the table of a craft that lists no modes. Betaflight has numbers of its own, and no flag for custom modes. INAV
/// has the numbers of ArduPilot and the flag, and claims to be generic or ArduPilot.
fn table(number: ModeNumber) -> Table {
    let is_custom = number.base_mode & mode_flag::CUSTOM != 0;
    match (number.autopilot, number.system_type) {
        (autopilot::PX4, _) => PX4,
        (autopilot::GENERIC, _) if !is_custom => BETAFLIGHT,
        (autopilot::GENERIC | autopilot::ARDUPILOT, kind) => match kind {
            system_type::FIXED_WING | system_type::FIRST_VTOL..=system_type::LAST_VTOL => ARDUPLANE,
            system_type::ROVER | system_type::BOAT => ROVER,
            _ => ARDUCOPTER,
        },
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::wire::Text;
    use super::*;

    fn number(autopilot: u8, system_type: u8, base_mode: u8, custom: u32) -> ModeNumber {
        ModeNumber { autopilot, system_type, base_mode, custom }
    }

    #[test]
    fn modes_have_the_names_of_their_autopilots() {
        let name = |number| ListedModes::default().name(number);
        assert_eq!(name(number(3, 2, 81, 5)), "LOITER");
        assert_eq!(name(number(3, 1, 81, 5)), "FBWA");
        assert_eq!(name(number(3, 10, 81, 4)), "HOLD");
        assert_eq!(name(number(3, 20, 81, 19)), "QLOITER");
        assert_eq!(name(number(12, 2, 81, 0x404_0000)), "Mission");
        assert_eq!(name(number(0, 2, 80, 4)), "Pos Hold");
        // INAV.
        assert_eq!(name(number(0, 2, 81, 3)), "AUTO");
        assert_eq!(name(number(0, 1, 81, 11)), "RTL");
        assert_eq!(name(number(3, 2, 81, 99)), "mode 99");
        assert_eq!(name(number(9, 2, 81, 1)), "mode 1");
    }

    #[test]
    fn modes_that_the_craft_lists_win() {
        let mut modes = ListedModes::default();
        let mode = |mode_index, custom_mode, name| AvailableModes {
            custom_mode,
            number_modes: 2,
            mode_index,
            mode_name: Text::new(name),
            standard_mode: 6,
            ..Default::default()
        };
        assert_eq!(modes.take(&mode(1, 5, "Autopilot")), Some(2));
        assert_eq!(modes.take(&mode(2, 6, "")), None);
        assert_eq!(modes.name(number(0, 2, 81, 5)), "Autopilot");
        assert_eq!(modes.name(number(0, 2, 81, 6)), "Mission");
        assert_eq!(modes.number("autopilot", number(0, 2, 81, 0)), Some(5));
        assert_eq!(modes.names(number(0, 2, 81, 0)), ["Autopilot", "Mission"]);
    }
}
