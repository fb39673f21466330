//! The boxes: modes a switch can be bound to, by permanent id.
//!
//! The permanent id is what mode conditions, `aux` lines and protocols carry; the order of [`BOXES`] is the order in
//! which protocols list them.

/// Permanent id of a box.
pub type BoxId = u8;

/// ARM.
pub const ARM: BoxId = 0;
/// ANGLE.
pub const ANGLE: BoxId = 1;
/// HORIZON.
pub const HORIZON: BoxId = 2;
/// ALTHOLD.
pub const ALTHOLD: BoxId = 3;
/// ANTI GRAVITY: the gains rise in quick throttle changes.
pub const ANTI_GRAVITY: BoxId = 4;
/// MAG: hold the heading while the yaw stick is centred.
pub const MAG: BoxId = 5;
/// HEADFREE: sticks relative to the heading at arming.
pub const HEADFREE: BoxId = 6;
/// HEADADJ: take the present heading as the headfree reference.
pub const HEADADJ: BoxId = 7;
/// POS HOLD.
pub const POS_HOLD: BoxId = 11;
/// FAILSAFE, the switch.
pub const FAILSAFE: BoxId = 27;
/// AIR MODE.
pub const AIR_MODE: BoxId = 28;
/// FLIP OVER AFTER CRASH: blocks arming, since nothing here can be flipped.
pub const CRASH_FLIP: BoxId = 35;
/// PREARM.
pub const PREARM: BoxId = 36;
/// PARALYZE: no arming until reboot.
pub const PARALYZE: BoxId = 45;
/// GPS RESCUE.
pub const GPS_RESCUE: BoxId = 46;
/// STICK COMMANDS DISABLE: the sticks do not arm or disarm.
pub const STICK_COMMANDS_DISABLE: BoxId = 51;
/// AUTOPILOT.
pub const AUTOPILOT: BoxId = 56;

/// What happens when a box is switched on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoxLevel {
    /// It does what its name says.
    Full,
    /// The switch works and is reported, nothing else happens.
    Flag,
    /// Only accepted in mode conditions; listed by nobody.
    Name,
}

/// One box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoxInfo {
    /// Permanent id.
    pub id: BoxId,
    /// Name as protocols and displays print it.
    pub name: &'static str,
    /// What it does here.
    pub level: BoxLevel,
}

const fn full(id: BoxId, name: &'static str) -> BoxInfo {
    BoxInfo { id, name, level: BoxLevel::Full }
}

const fn flag(id: BoxId, name: &'static str) -> BoxInfo {
    BoxInfo { id, name, level: BoxLevel::Flag }
}

const fn name(id: BoxId, name: &'static str) -> BoxInfo {
    BoxInfo { id, name, level: BoxLevel::Name }
}

/// All boxes in the order in which protocols list them.
pub const BOXES: [BoxInfo; 50] = [
    full(ARM, "ARM"),
    full(ANGLE, "ANGLE"),
    full(HORIZON, "HORIZON"),
    full(MAG, "MAG"),
    full(ALTHOLD, "ALTHOLD"),
    full(HEADFREE, "HEADFREE"),
    name(55, "CHIRP"),
    name(12, "PASSTHRU"),
    full(FAILSAFE, "FAILSAFE"),
    full(POS_HOLD, "POS HOLD"),
    full(GPS_RESCUE, "GPS RESCUE"),
    full(AUTOPILOT, "AUTOPILOT"),
    full(ANTI_GRAVITY, "ANTI GRAVITY"),
    full(HEADADJ, "HEADADJ"),
    name(8, "CAMSTAB"),
    flag(13, "BEEPER"),
    name(15, "LEDLOW"),
    flag(17, "CALIB"),
    flag(19, "OSD DISABLE"),
    name(20, "TELEMETRY"),
    name(23, "SERVO1"),
    name(24, "SERVO2"),
    name(25, "SERVO3"),
    flag(26, "BLACKBOX"),
    full(AIR_MODE, "AIR MODE"),
    name(29, "3D DISABLE"),
    flag(30, "FPV ANGLE MIX"),
    name(31, "BLACKBOX ERASE"),
    flag(32, "CAMERA CONTROL 1"),
    flag(33, "CAMERA CONTROL 2"),
    flag(34, "CAMERA CONTROL 3"),
    name(CRASH_FLIP, "FLIP OVER AFTER CRASH"),
    full(PREARM, "PREARM"),
    flag(37, "GPS BEEP SATELLITE COUNT"),
    name(39, "VTX PIT MODE"),
    full(PARALYZE, "PARALYZE"),
    flag(40, "USER1"),
    flag(41, "USER2"),
    flag(42, "USER3"),
    flag(43, "USER4"),
    name(44, "PID AUDIO"),
    name(47, "ACRO TRAINER"),
    name(48, "VTX CONTROL DISABLE"),
    flag(49, "LAUNCH CONTROL"),
    name(50, "MSP OVERRIDE"),
    full(STICK_COMMANDS_DISABLE, "STICK COMMANDS DISABLE"),
    flag(52, "BEEPER MUTE"),
    flag(53, "READY"),
    name(54, "LAP TIMER RESET"),
    flag(57, "WP CAPTURE"),
];

/// The box with this permanent id.
#[must_use]
pub fn by_id(id: BoxId) -> Option<&'static BoxInfo> {
    BOXES.iter().find(|entry| entry.id == id)
}

/// Whether any build knows a box of this permanent id.
#[must_use]
pub fn is_known(id: BoxId) -> bool {
    by_id(id).is_some()
}

/// What decides which boxes protocols list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Equipment {
    /// Feature GPS.
    pub gps: bool,
    /// Feature AIRMODE: airmode is on by itself and needs no box.
    pub airmode_feature: bool,
    /// Feature ANTI_GRAVITY: likewise.
    pub anti_gravity_feature: bool,
    /// A magnetometer is present.
    pub mag: bool,
}

/// The boxes that protocols list with this equipment, in order.
pub fn listed(equipment: Equipment) -> impl Iterator<Item = &'static BoxInfo> {
    BOXES.iter().filter(move |entry| match entry.id {
        MAG => equipment.mag,
        POS_HOLD | GPS_RESCUE | AUTOPILOT | 37 => equipment.gps,
        AIR_MODE => !equipment.airmode_feature,
        ANTI_GRAVITY => !equipment.anti_gravity_feature,
        // Need hardware that a simulated craft does not have.
        17 | 40..=43 => false,
        _ => entry.level != BoxLevel::Name,
    })
}

/// A set of boxes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct BoxSet(u64);

impl BoxSet {
    /// The empty set.
    pub const NONE: Self = Self(0);

    /// Whether the box is in the set; ids above 63 never are.
    #[must_use]
    pub fn has(self, id: BoxId) -> bool {
        id < 64 && self.0 & (1 << id) != 0
    }

    /// Adds or removes a box; ids above 63 are ignored.
    pub fn set(&mut self, id: BoxId, on: bool) {
        if id < 64 {
            self.0 = if on { self.0 | (1 << id) } else { self.0 & !(1 << id) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn default_list_is_the_one_configurators_know() {
        let ids: Vec<_> =
            listed(Equipment { gps: true, airmode_feature: true, anti_gravity_feature: true, mag: true })
                .map(|entry| entry.id)
                .collect();
        assert_eq!(
            ids,
            [0, 1, 2, 5, 3, 6, 27, 11, 46, 56, 7, 13, 19, 26, 30, 32, 33, 34, 36, 37, 45, 49, 51, 52, 53, 57]
        );
    }

    #[test]
    fn equipment_changes_the_list() {
        let bare: Vec<_> =
            listed(Equipment { gps: false, airmode_feature: false, anti_gravity_feature: false, mag: false })
                .map(|entry| entry.id)
                .collect();
        for missing in [MAG, POS_HOLD, GPS_RESCUE, AUTOPILOT] {
            assert!(!bare.contains(&missing));
        }
        assert!(bare.contains(&AIR_MODE));
    }

    #[test]
    fn permanent_ids_are_unique() {
        let mut ids: Vec<_> = BOXES.iter().map(|entry| entry.id).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), BOXES.len());
    }

    #[test]
    fn set_ignores_ids_out_of_range() {
        let mut set = BoxSet::NONE;
        set.set(200, true);
        assert_eq!(set, BoxSet::NONE);
        assert!(!set.has(200));
        set.set(AUTOPILOT, true);
        assert!(set.has(AUTOPILOT) && !set.has(ARM));
    }
}
