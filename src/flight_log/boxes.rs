//! The boxes of a log's mode flags, by the version of the firmware that wrote it.

use strum::IntoEnumIterator as _;

use crate::blackbox::decode::Version;
use crate::telemetry::{Mode, ModeBox, ModeFlags};

/// The version before all that are known.
const FIRST: Version = (0, 0, 0);
/// The version after all that are known.
const NEVER: Version = (u32::MAX, 0, 0);

/// The boxes of Betaflight since 3.3 in the order of the flags: name, the first version with it, the first without it.
const SINCE_3_3: &[(&str, Version, Version)] = &[
    ("ARM", FIRST, NEVER),
    ("ANGLE", FIRST, NEVER),
    ("HORIZON", FIRST, NEVER),
    ("MAG", FIRST, NEVER),
    ("BARO", FIRST, (4, 0, 0)),
    ("GPS HOME", FIRST, (4, 0, 0)),
    ("GPS HOLD", FIRST, (4, 0, 0)),
    ("ALTHOLD", (4, 6, 0), NEVER),
    ("HEADFREE", FIRST, NEVER),
    ("CHIRP", (4, 6, 0), NEVER),
    ("PASSTHRU", FIRST, NEVER),
    ("RANGEFINDER", FIRST, (3, 5, 0)),
    ("FAILSAFE", FIRST, NEVER),
    ("POS HOLD", (4, 6, 0), NEVER),
    ("GPS RESCUE", (3, 4, 0), NEVER),
    ("AUTOPILOT", (2026, 6, 0), NEVER),
    ("ANTI GRAVITY", FIRST, NEVER),
    ("HEADADJ", FIRST, NEVER),
    ("CAMSTAB", FIRST, NEVER),
    ("CAMTRIG", FIRST, (3, 5, 0)),
    ("BEEPER", FIRST, NEVER),
    ("LEDMAX", FIRST, (3, 5, 0)),
    ("LEDLOW", FIRST, NEVER),
    ("LLIGHTS", FIRST, (3, 5, 0)),
    ("CALIB", FIRST, NEVER),
    ("GOVERNOR", FIRST, (3, 5, 0)),
    ("OSD DISABLE", FIRST, NEVER),
    ("TELEMETRY", FIRST, NEVER),
    ("GTUNE", FIRST, (3, 5, 0)),
    ("SERVO1", FIRST, NEVER),
    ("SERVO2", FIRST, NEVER),
    ("SERVO3", FIRST, NEVER),
    ("BLACKBOX", FIRST, NEVER),
    ("AIR MODE", FIRST, NEVER),
    ("3D DISABLE", FIRST, NEVER),
    ("FPV ANGLE MIX", FIRST, NEVER),
    ("BLACKBOX ERASE", FIRST, NEVER),
    ("CAMERA CONTROL 1", FIRST, NEVER),
    ("CAMERA CONTROL 2", FIRST, NEVER),
    ("CAMERA CONTROL 3", FIRST, NEVER),
    ("FLIP OVER AFTER CRASH", FIRST, NEVER),
    ("PREARM", FIRST, NEVER),
];

/// The boxes of Betaflight before 3.3 in the order of the flags.
const BEFORE_3_3: &[(&str, Version, Version)] = &[
    ("ARM", FIRST, NEVER),
    ("ANGLE", FIRST, NEVER),
    ("HORIZON", FIRST, NEVER),
    ("BARO", FIRST, NEVER),
    ("ANTI GRAVITY", (3, 1, 7), NEVER),
    ("MAG", FIRST, NEVER),
    ("HEADFREE", FIRST, NEVER),
    ("HEADADJ", FIRST, NEVER),
    ("CAMSTAB", FIRST, NEVER),
    ("CAMTRIG", FIRST, NEVER),
    ("GPS HOME", FIRST, NEVER),
    ("GPS HOLD", FIRST, NEVER),
    ("PASSTHRU", FIRST, NEVER),
    ("BEEPER", FIRST, NEVER),
    ("LEDMAX", FIRST, NEVER),
    ("LEDLOW", FIRST, NEVER),
    ("LLIGHTS", FIRST, NEVER),
    ("CALIB", FIRST, NEVER),
    ("GOVERNOR", FIRST, NEVER),
    ("OSD DISABLE", FIRST, NEVER),
    ("TELEMETRY", FIRST, NEVER),
    ("GTUNE", FIRST, NEVER),
    ("SONAR", FIRST, NEVER),
    ("SERVO1", FIRST, NEVER),
    ("SERVO2", FIRST, NEVER),
    ("SERVO3", FIRST, NEVER),
    ("BLACKBOX", FIRST, NEVER),
    ("FAILSAFE", FIRST, NEVER),
    ("AIR MODE", FIRST, NEVER),
    ("3D DISABLE", FIRST, NEVER),
    ("FPV ANGLE MIX", FIRST, NEVER),
    ("BLACKBOX ERASE", FIRST, NEVER),
];

/// The number of flags.
const FLAGS: usize = 32;

/// The order of a log's mode flags.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoxOrder(Option<Version>);

impl BoxOrder {
    /// The order is unknown: the flags have no names.
    pub const UNKNOWN: Self = Self(None);

    /// Returns the order of a version of Betaflight.
    pub fn from_betaflight(version: Version) -> Self {
        Self(Some(version))
    }

    /// Returns the names by bit, as far as they are known.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        let known = self.0.into_iter().flat_map(|version| {
            let table = if version < (3, 3, 0) { BEFORE_3_3 } else { SINCE_3_3 };
            table.iter().filter(move |(_, since, until)| (*since..*until).contains(&version))
        });
        known.map(|(name, ..)| *name).take(FLAGS)
    }
}

/// The boxes that are on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoxFlags {
    /// A bit for each box in the order of the firmware.
    pub bits: u32,
    /// The order of the firmware.
    pub order: BoxOrder,
}

impl BoxFlags {
    /// Returns the names of the boxes that are on, in the order of the firmware. A flag without a known name is left out.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        let bits = self.bits;
        self.order.names().enumerate().filter(move |(bit, _)| bits & (1 << bit) != 0).map(|(_, name)| name)
    }

    /// Returns `true` if the box is on.
    pub fn has(&self, mode_box: ModeBox) -> bool {
        let name: &str = mode_box.into();
        self.names().any(|on| on == name)
    }

    /// Returns the modes that are on.
    pub fn modes(&self) -> ModeFlags {
        let mut modes = ModeFlags::NONE;
        for mode in Mode::iter() {
            modes.set(mode, self.has(mode.into()));
        }
        modes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_the_newest_firmware_is_that_of_its_protocol() {
        let protocol: Vec<&str> = ModeBox::iter().take(FLAGS).map(Into::into).collect();
        assert_eq!(BoxOrder::from_betaflight((2026, 12, 0)).names().collect::<Vec<_>>(), protocol);
    }

    #[test]
    fn older_firmwares_have_their_own_order() {
        let bit = |version, name| BoxOrder::from_betaflight(version).names().position(|known| known == name);
        assert_eq!(bit((3, 1, 0), "MAG"), Some(4));
        assert_eq!(bit((3, 2, 0), "MAG"), Some(5));
        assert_eq!(bit((3, 3, 2), "FAILSAFE"), Some(10));
        assert_eq!(bit((3, 4, 0), "ANTI GRAVITY"), Some(12));
        assert_eq!(bit((3, 5, 7), "GPS RESCUE"), Some(10));
        assert_eq!(bit((4, 5, 2), "GPS RESCUE"), Some(7));
        assert_eq!(bit((2025, 12, 1), "GPS RESCUE"), Some(10));
        assert_eq!(bit((2025, 12, 1), "AUTOPILOT"), None);
    }

    #[test]
    fn flags_have_names_and_modes() {
        let flags = BoxFlags { bits: 0b1011, order: BoxOrder::from_betaflight((4, 5, 2)) };
        assert_eq!(flags.names().collect::<Vec<_>>(), ["ARM", "ANGLE", "MAG"]);
        assert!(flags.has(ModeBox::Arm) && !flags.has(ModeBox::Horizon));
        assert_eq!(flags.modes().iter().collect::<Vec<_>>(), [Mode::Arm, Mode::Angle, Mode::Mag]);
        assert_eq!(BoxFlags { order: BoxOrder::UNKNOWN, ..flags }.names().count(), 0);
    }
}
