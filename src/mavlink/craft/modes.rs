//! Flight modes, and their numbers for each identity.

use super::super::value::{StandardMode, autopilot};

/// The autopilot that a craft claims to be. It decides the numbers of modes and some habits of ground stations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Identity {
    /// No known autopilot, with the modes of Betaflight.
    #[default]
    Generic,
    /// ArduPilot's ArduCopter.
    Ardupilot,
    /// PX4.
    Px4,
}

/// A flight mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FlightMode {
    /// Sticks demand rates.
    Acro,
    /// Sticks demand angles.
    Angle,
    /// Sticks demand angles near the middle and rates beyond.
    Horizon,
    /// Holds the altitude.
    AltHold,
    /// Holds the position.
    PosHold,
    /// Flies the mission.
    Autopilot,
    /// Returns home.
    ReturnHome,
    /// Lands.
    Landing,
    /// Takes off.
    TakeOff,
    /// A failsafe.
    Failsafe,
}

/// A mode of an identity: the mode, its number and the name under which it is listed. Modes with an empty name are not listed.
type Row = (FlightMode, u32, &'static str);

const GENERIC: &[Row] = &[
    (FlightMode::Acro, 0, "Acro"),
    (FlightMode::Angle, 1, "Angle"),
    (FlightMode::Horizon, 2, "Horizon"),
    (FlightMode::AltHold, 3, "Alt Hold"),
    (FlightMode::PosHold, 4, "Pos Hold"),
    (FlightMode::Autopilot, 5, "Autopilot"),
    (FlightMode::ReturnHome, 6, "RTL"),
    (FlightMode::Failsafe, 7, "Failsafe"),
    (FlightMode::Landing, 5, ""),
    (FlightMode::TakeOff, 5, ""),
];

const ARDUCOPTER: &[Row] = &[
    (FlightMode::Angle, 0, "Stabilize"),
    (FlightMode::Acro, 1, "Acro"),
    (FlightMode::AltHold, 2, "Alt Hold"),
    (FlightMode::Autopilot, 3, "Auto"),
    (FlightMode::PosHold, 5, "Loiter"),
    (FlightMode::ReturnHome, 6, "RTL"),
    (FlightMode::Landing, 9, "Land"),
    (FlightMode::Horizon, 0, ""),
    (FlightMode::Failsafe, 9, ""),
    // Guided: programs set it before they command a take-off.
    (FlightMode::TakeOff, 4, ""),
    (FlightMode::PosHold, 16, ""),
    (FlightMode::PosHold, 17, ""),
];

const PX4: &[Row] = &[
    (FlightMode::Angle, px4(7, 0), "Stabilized"),
    (FlightMode::Acro, px4(5, 0), "Acro"),
    (FlightMode::AltHold, px4(2, 0), "Altitude"),
    (FlightMode::PosHold, px4(3, 0), "Position"),
    (FlightMode::PosHold, px4(4, 3), "Hold"),
    (FlightMode::Autopilot, px4(4, 4), "Mission"),
    (FlightMode::ReturnHome, px4(4, 5), "Return"),
    (FlightMode::Landing, px4(4, 6), "Land"),
    (FlightMode::TakeOff, px4(4, 2), "Takeoff"),
    (FlightMode::Angle, px4(1, 0), ""),
    (FlightMode::Horizon, px4(7, 0), ""),
    (FlightMode::Failsafe, px4(4, 6), ""),
];

/// Returns the number of a mode of PX4.
pub(super) const fn px4(main: u8, sub: u8) -> u32 {
    (main as u32) << 16 | (sub as u32) << 24
}

/// A mode in the list of modes that can be set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ListedMode {
    pub(super) mode: FlightMode,
    pub(super) custom: u32,
    pub(super) name: &'static str,
}

impl Identity {
    /// Returns the number of the autopilot in a heartbeat.
    pub(super) fn autopilot(self) -> u8 {
        match self {
            Self::Generic => autopilot::GENERIC,
            Self::Ardupilot => autopilot::ARDUPILOT,
            Self::Px4 => autopilot::PX4,
        }
    }

    fn rows(self) -> &'static [Row] {
        match self {
            Self::Generic => GENERIC,
            Self::Ardupilot => ARDUCOPTER,
            Self::Px4 => PX4,
        }
    }

    /// Returns the number of a mode.
    pub(super) fn custom_mode(self, mode: FlightMode) -> u32 {
        self.rows().iter().find(|row| row.0 == mode).map_or(0, |row| row.1)
    }

    /// Returns the mode that a ground station means by a number, or `None` if the craft has none.
    pub(super) fn mode(self, custom: u32) -> Option<FlightMode> {
        let mode = self.rows().iter().find(|row| row.1 == custom)?.0;
        // Guided flight to positions does not exist: the craft holds its position and waits for a command.
        let is_guided = self == Self::Ardupilot && mode == FlightMode::TakeOff;
        Some(if is_guided { FlightMode::PosHold } else { mode })
    }

    /// Returns the modes that ground stations list.
    pub(super) fn listed_modes(self) -> impl Iterator<Item = ListedMode> {
        let listed = self.rows().iter().filter(|row| !row.2.is_empty());
        listed.map(|&(mode, custom, name)| ListedMode { mode, custom, name })
    }
}

impl FlightMode {
    /// Returns the mode that means the same for all autopilots.
    pub(super) fn standard(self) -> StandardMode {
        match self {
            Self::Acro | Self::Angle | Self::Horizon | Self::Failsafe => StandardMode::NonStandard,
            Self::AltHold => StandardMode::AltitudeHold,
            Self::PosHold => StandardMode::PositionHold,
            Self::Autopilot => StandardMode::Mission,
            Self::ReturnHome => StandardMode::SafeRecovery,
            Self::Landing => StandardMode::Land,
            Self::TakeOff => StandardMode::TakeOff,
        }
    }

    /// Returns the mode with a standard number, or `None` if the craft has none.
    pub(super) fn from_standard(code: u8) -> Option<Self> {
        let all =
            [Self::AltHold, Self::PosHold, Self::Autopilot, Self::ReturnHome, Self::Landing, Self::TakeOff];
        all.into_iter().find(|mode| mode.standard().code() == code)
    }

    /// Returns `true` for a mode in which the craft flies by itself.
    pub(super) fn is_automatic(self) -> bool {
        matches!(self, Self::Autopilot | Self::ReturnHome | Self::Landing | Self::TakeOff)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_of_modes_are_those_of_the_autopilots() {
        let numbers = |identity: Identity| {
            [FlightMode::Angle, FlightMode::PosHold, FlightMode::Autopilot, FlightMode::ReturnHome]
                .map(|mode| identity.custom_mode(mode))
        };
        assert_eq!(numbers(Identity::Generic), [1, 4, 5, 6]);
        assert_eq!(numbers(Identity::Ardupilot), [0, 5, 3, 6]);
        assert_eq!(numbers(Identity::Px4), [0x7_0000, 0x3_0000, 0x404_0000, 0x504_0000]);
    }

    #[test]
    fn a_listed_mode_is_set_by_its_number() {
        for identity in [Identity::Generic, Identity::Ardupilot, Identity::Px4] {
            for listed in identity.listed_modes() {
                assert_eq!(identity.mode(listed.custom), Some(listed.mode), "{identity:?} {listed:?}");
            }
            assert_eq!(identity.mode(999), None);
        }
    }

    #[test]
    fn guided_mode_of_arducopter_holds_the_position() {
        assert_eq!(Identity::Ardupilot.mode(4), Some(FlightMode::PosHold));
    }
}
