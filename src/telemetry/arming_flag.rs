//! The arming disable flags.

use strum::IntoEnumIterator as _;

/// A reason why arming is refused. The discriminant is its bit on the wire. `Display` gives its name.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    strum::Display,
    strum::EnumCount,
    strum::EnumIter,
    strum::IntoStaticStr,
)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
#[repr(u8)]
pub enum ArmingFlag {
    #[strum(to_string = "NOGYRO")]
    NoGyro = 0,
    /// A failsafe landing ended the flight, and the link has not recovered yet.
    Failsafe = 1,
    #[strum(to_string = "RXLOSS")]
    RxLoss = 2,
    /// The link appeared with the ARM switch on.
    NotDisarmed = 3,
    /// The FAILSAFE switch is on.
    #[strum(to_string = "BOXFAILSAFE")]
    BoxFailsafe = 4,
    /// Runaway take-off prevention stopped the motors.
    Runaway = 5,
    /// Crash detection stopped the motors.
    Crash = 6,
    Throttle = 7,
    /// The craft is tilted, or the attitude is not known yet.
    Angle = 8,
    #[strum(to_string = "BOOTGRACE")]
    BootGrace = 9,
    /// The PREARM switch is missing.
    #[strum(to_string = "NOPREARM")]
    NoPrearm = 10,
    Load = 11,
    /// Sensors are being calibrated.
    #[strum(to_string = "CALIB")]
    Calibrating = 12,
    /// A command line session was opened.
    Cli = 13,
    /// The on-screen menu is open.
    Cms = 14,
    /// A BST device is active.
    Bst = 15,
    /// An MSP client requested it (on hardware).
    Msp = 16,
    /// The PARALYZE switch was on.
    Paralyze = 17,
    /// GPS rescue is configured and cannot work.
    Gps = 18,
    /// The GPS RESCUE switch is on.
    #[strum(to_string = "RESCUE_SW")]
    RescueSwitch = 19,
    DshotTelem = 20,
    /// A change needs a reboot.
    #[strum(to_string = "REBOOT_REQD")]
    RebootRequired = 21,
    #[strum(to_string = "DSHOT_BBANG")]
    DshotBitbang = 22,
    /// The accelerometer was never calibrated.
    #[strum(to_string = "NO_ACC_CAL")]
    NoAccCal = 23,
    /// The motor protocol is unusable.
    #[strum(to_string = "MOTOR_PROTO")]
    MotorProtocol = 24,
    /// The crash-flip switch is on.
    FlipSwitch = 25,
    /// The ALTHOLD switch is on.
    #[strum(to_string = "ALT_HOLD_SW")]
    AltHoldSwitch = 26,
    /// The POS HOLD switch is on.
    #[strum(to_string = "POS_HOLD_SW")]
    PosHoldSwitch = 27,
    /// The AUTOPILOT switch is on.
    #[strum(to_string = "AUTOPILOT_SW")]
    AutopilotSwitch = 28,
    /// The ARM switch was on while there was another reason.
    ArmSwitch = 29,
}

impl ArmingFlag {
    /// Returns the cause of the flag as a phrase. For flags that are never set here, returns the reason.
    pub fn cause(self) -> &'static str {
        match self {
            Self::NoGyro => "never: the simulated gyro is always there",
            Self::Failsafe => "a failsafe landing ended the flight, until the link is good again",
            Self::RxLoss => "no valid RC for 150 ms, until it is back for `failsafe_recovery_delay`",
            Self::NotDisarmed => "the link appeared with ARM on, until ARM goes off",
            Self::BoxFailsafe => "the FAILSAFE switch is on",
            Self::Runaway => "runaway take-off prevention disarmed, until ARM goes off",
            Self::Crash => "crash detection disarmed, until ARM goes off",
            Self::Throttle => "the throttle is at `min_check` or above",
            Self::Angle => "tilted more than `small_angle`, or the attitude is not known yet",
            Self::BootGrace => "`pwr_on_arm_grace` after boot is not over",
            Self::NoPrearm => "PREARM is bound and not switched on for this arming",
            Self::Load => "never: simulated time has no overload",
            Self::Calibrating => "a calibration of gyro, accelerometer or magnetometer runs",
            Self::Cli => "a CLI session was opened on a link, until reboot",
            Self::Cms => "never: there is no on-screen menu",
            Self::Bst => "never: there is no BST device",
            Self::Msp => "never: in a simulator the configurator may stay connected",
            Self::Paralyze => "the PARALYZE switch was on, until reboot",
            Self::Gps => {
                "GPS rescue is bound or the failsafe procedure, without its satellites, before the first arming"
            }
            Self::RescueSwitch => "the GPS RESCUE switch is on",
            Self::DshotTelem | Self::DshotBitbang => "never: there is no DShot hardware",
            Self::RebootRequired => "a change in memory needs a restart, until then or taken back",
            Self::NoAccCal => "never: the simulated accelerometer needs no calibration",
            Self::MotorProtocol => "`motor_pwm_protocol` was DISABLED at boot",
            Self::FlipSwitch => "the FLIP OVER AFTER CRASH switch is on",
            Self::AltHoldSwitch => "the ALTHOLD switch is on",
            Self::PosHoldSwitch => "the POS HOLD switch is on",
            Self::AutopilotSwitch => "the AUTOPILOT switch is on",
            Self::ArmSwitch => {
                "another flag stood while ARM was on, or a touchdown disarmed; until ARM goes off"
            }
        }
    }

    /// Returns the remedy as a phrase.
    pub fn hint(self) -> &'static str {
        match self {
            Self::NoGyro => "no gyro",
            Self::Failsafe => "the link was lost: wait until it is good again",
            Self::RxLoss => "no RC signal: start sending RC",
            Self::NotDisarmed | Self::ArmSwitch => "switch ARM off, then on",
            Self::BoxFailsafe => "switch FAILSAFE off",
            Self::Runaway => "motors or propellers mixed up: switch ARM off",
            Self::Crash => "switch ARM off",
            Self::Throttle => "lower the throttle",
            Self::Angle => "craft tilted, or no attitude yet",
            Self::BootGrace => "just booted: wait a few seconds",
            Self::NoPrearm => "switch PREARM on",
            Self::Load => "CPU overload",
            Self::Calibrating => "calibrating: wait and keep still",
            Self::Cli => "a CLI session was opened: type exit or save",
            Self::Cms => "close the menu",
            Self::Bst => "disconnect the BST device",
            Self::Msp => "disconnect the configurator",
            Self::Paralyze => "PARALYZE was switched on: reboot",
            Self::Gps => "GPS rescue needs a fix: wait for satellites",
            Self::RescueSwitch => "switch GPS RESCUE off",
            Self::DshotTelem | Self::DshotBitbang => "DShot trouble",
            Self::RebootRequired => "save and reboot",
            Self::NoAccCal => "calibrate the accelerometer",
            Self::MotorProtocol => "set motor_pwm_protocol to another value, then save",
            Self::FlipSwitch => "switch crash flip off",
            Self::AltHoldSwitch => "switch ALTHOLD off",
            Self::PosHoldSwitch => "switch POS HOLD off",
            Self::AutopilotSwitch => "arm first, then switch AUTOPILOT on",
        }
    }
}

/// A set of reasons. The bits are those on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct ArmingFlags(u32);

impl ArmingFlags {
    /// No reason: the craft can be armed.
    pub const NONE: Self = Self(0);

    /// Returns `true` if the flag is set.
    pub fn has(self, flag: ArmingFlag) -> bool {
        self.0 & (1 << flag as u32) != 0
    }

    /// Sets or clears a flag.
    pub fn set(&mut self, flag: ArmingFlag, on: bool) {
        self.0 = if on { self.0 | (1 << flag as u32) } else { self.0 & !(1 << flag as u32) };
    }

    /// Returns the set without one flag.
    pub fn without(mut self, flag: ArmingFlag) -> Self {
        self.set(flag, false);
        self
    }

    /// Returns `true` if nothing blocks arming.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns the bits on the wire.
    pub fn bits(self) -> u32 {
        self.0
    }

    /// Returns the flags without those that only mean that the ARM switch must be moved again.
    pub fn causes(self) -> Self {
        self.without(ArmingFlag::ArmSwitch).without(ArmingFlag::NotDisarmed)
    }

    /// Returns the flags in bit order.
    pub fn iter(self) -> impl Iterator<Item = ArmingFlag> {
        ArmingFlag::iter().filter(move |&flag| self.has(flag))
    }
}

impl std::fmt::Display for ArmingFlags {
    /// Writes the names in bit order.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (at, flag) in self.iter().enumerate() {
            let gap = if at > 0 { " " } else { "" };
            write!(f, "{gap}{flag}")?;
        }
        Ok(())
    }
}

impl FromIterator<ArmingFlag> for ArmingFlags {
    fn from_iter<I: IntoIterator<Item = ArmingFlag>>(flags: I) -> Self {
        let mut set = Self::NONE;
        flags.into_iter().for_each(|flag| set.set(flag, true));
        set
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_bit_order() {
        let names: Vec<_> = ArmingFlag::iter().map(|flag| flag.to_string()).collect();
        assert_eq!(
            names.join(" "),
            "NOGYRO FAILSAFE RXLOSS NOT_DISARMED BOXFAILSAFE RUNAWAY CRASH THROTTLE ANGLE BOOTGRACE NOPREARM LOAD \
             CALIB CLI CMS BST MSP PARALYZE GPS RESCUE_SW DSHOT_TELEM REBOOT_REQD DSHOT_BBANG NO_ACC_CAL MOTOR_PROTO \
             FLIP_SWITCH ALT_HOLD_SW POS_HOLD_SW AUTOPILOT_SW ARM_SWITCH"
        );
        for (bit, flag) in ArmingFlag::iter().enumerate() {
            assert_eq!(flag as usize, bit);
        }
    }
}
