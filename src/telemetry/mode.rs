//! The flight modes as users see them.

/// A set of active modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, serde::Serialize, serde::Deserialize)]
pub struct ModeFlags(u32);

/// A mode that can be active. `Display` gives the box name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::EnumIter, strum::IntoStaticStr)]
#[repr(u8)]
pub enum Mode {
    /// The motors may turn.
    #[strum(to_string = "ARM")]
    Arm = 0,
    /// Self-levelling with an angle limit.
    #[strum(to_string = "ANGLE")]
    Angle = 1,
    /// Self-levelling around the stick centre.
    #[strum(to_string = "HORIZON")]
    Horizon = 2,
    /// Heading hold while the yaw stick is centred.
    #[strum(to_string = "MAG")]
    Mag = 3,
    /// Altitude hold.
    #[strum(to_string = "ALTHOLD")]
    AltHold = 4,
    /// Controls relative to the heading at arming.
    #[strum(to_string = "HEADFREE")]
    HeadFree = 5,
    /// Position hold.
    #[strum(to_string = "POS HOLD")]
    PosHold = 6,
    /// A failsafe procedure flies.
    #[strum(to_string = "FAILSAFE")]
    Failsafe = 7,
    /// Flies home and lands.
    #[strum(to_string = "GPS RESCUE")]
    GpsRescue = 8,
    /// The waypoint autopilot flies.
    #[strum(to_string = "AUTOPILOT")]
    Autopilot = 9,
}

impl ModeFlags {
    /// The empty set.
    pub const NONE: Self = Self(0);

    /// Returns `true` if `mode` is in the set.
    pub fn has(self, mode: Mode) -> bool {
        self.0 & (1 << mode as u32) != 0
    }

    /// Adds or removes a mode.
    pub fn set(&mut self, mode: Mode, on: bool) {
        if on {
            self.0 |= 1 << mode as u32;
        } else {
            self.0 &= !(1 << mode as u32);
        }
    }

    /// Returns the active modes in a fixed order.
    pub fn iter(self) -> impl Iterator<Item = Mode> {
        use strum::IntoEnumIterator as _;
        Mode::iter().filter(move |&mode| self.has(mode))
    }
}
