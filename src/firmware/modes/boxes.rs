//! The boxes: modes that can be bound to a switch, by permanent id.
//!
//! Mode conditions, `aux` lines and protocols carry the permanent id. Protocols list the boxes in the order in which
//! [`ModeBox`] declares them.

use strum::IntoEnumIterator as _;

use crate::telemetry::{BoxLevel, ModeBox};

/// The permanent id of a box.
pub type BoxId = u8;

pub const ARM: BoxId = ModeBox::Arm as BoxId;
pub const ANGLE: BoxId = ModeBox::Angle as BoxId;
pub const HORIZON: BoxId = ModeBox::Horizon as BoxId;
pub const ALTHOLD: BoxId = ModeBox::AltHold as BoxId;
/// ANTI GRAVITY: raises the gains in quick throttle changes.
pub const ANTI_GRAVITY: BoxId = ModeBox::AntiGravity as BoxId;
/// MAG: holds the heading while the yaw stick is centred.
pub const MAG: BoxId = ModeBox::Mag as BoxId;
/// HEADFREE: sticks relative to the heading at arming.
pub const HEADFREE: BoxId = ModeBox::HeadFree as BoxId;
/// HEADADJ: takes the present heading as the headfree reference.
pub const HEADADJ: BoxId = ModeBox::HeadAdjust as BoxId;
pub const POS_HOLD: BoxId = ModeBox::PosHold as BoxId;
/// The FAILSAFE switch.
pub const FAILSAFE: BoxId = ModeBox::Failsafe as BoxId;
/// BLACKBOX: the log goes on while it is on.
pub const BLACKBOX: BoxId = ModeBox::Blackbox as BoxId;
pub const AIR_MODE: BoxId = ModeBox::AirMode as BoxId;
/// FLIP OVER AFTER CRASH: blocks arming, because nothing here can be flipped.
pub const CRASH_FLIP: BoxId = ModeBox::CrashFlip as BoxId;
pub const PREARM: BoxId = ModeBox::Prearm as BoxId;
/// PARALYZE: no arming until reboot.
pub const PARALYZE: BoxId = ModeBox::Paralyze as BoxId;
pub const GPS_RESCUE: BoxId = ModeBox::GpsRescue as BoxId;
/// STICK COMMANDS DISABLE: the sticks neither arm nor disarm.
pub const STICK_COMMANDS_DISABLE: BoxId = ModeBox::StickCommandsDisable as BoxId;
pub const AUTOPILOT: BoxId = ModeBox::Autopilot as BoxId;

/// The equipment that decides which boxes protocols list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Equipment {
    pub gps: bool,
    /// The AIRMODE feature: airmode is always on and needs no box.
    pub airmode_feature: bool,
    pub anti_gravity_feature: bool,
    /// `true` if a magnetometer is present.
    pub mag: bool,
}

/// Returns the boxes that protocols list with this equipment, in order.
pub fn listed(equipment: Equipment) -> impl Iterator<Item = ModeBox> {
    ModeBox::iter().filter(move |&entry| match entry as BoxId {
        MAG => equipment.mag,
        POS_HOLD | GPS_RESCUE | AUTOPILOT | 37 => equipment.gps,
        AIR_MODE => !equipment.airmode_feature,
        ANTI_GRAVITY => !equipment.anti_gravity_feature,
        // These need hardware that a simulated craft does not have.
        17 | 40..=43 => false,
        _ => entry.level() != BoxLevel::Name,
    })
}

/// A set of boxes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct BoxSet(u64);

impl BoxSet {
    pub const NONE: Self = Self(0);

    /// Returns `true` if the box is in the set. Ids above 63 never are.
    pub fn has(self, id: BoxId) -> bool {
        id < 64 && self.0 & (1 << id) != 0
    }

    /// Adds or removes a box. Ids above 63 are ignored.
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
                .map(|entry| entry as BoxId)
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
                .map(|entry| entry as BoxId)
                .collect();
        for missing in [MAG, POS_HOLD, GPS_RESCUE, AUTOPILOT] {
            assert!(!bare.contains(&missing));
        }
        assert!(bare.contains(&AIR_MODE));
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
