//! The arming disable flags.

use strum::IntoEnumIterator as _;

/// Defines the flags in bit order, each with its name, the cause, and the remedy.
macro_rules! flags {
    ($($variant:ident $name:literal $cause:literal $hint:literal;)*) => {
        /// A reason why arming is refused. The discriminant is its bit on the wire. `Display` gives its name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[derive(strum::Display, strum::EnumCount, strum::EnumIter, strum::IntoStaticStr)]
        #[repr(u8)]
        pub enum ArmingFlag {
            $(#[doc = $cause] #[strum(to_string = $name)] $variant,)*
        }

        impl ArmingFlag {
            /// Returns the cause of the flag as a phrase. For flags that are never set here, returns the reason.
            pub fn cause(self) -> &'static str {
                match self {
                    $(Self::$variant => $cause,)*
                }
            }

            /// Returns the remedy as a phrase.
            pub fn hint(self) -> &'static str {
                match self {
                    $(Self::$variant => $hint,)*
                }
            }
        }
    };
}

flags! {
    NoGyro "NOGYRO" "never: the simulated gyro is always there" "no gyro";
    Failsafe "FAILSAFE" "a failsafe landing ended the flight, until the link is good again"
        "the link was lost: wait until it is good again";
    RxLoss "RXLOSS" "no valid RC for 150 ms, until it is back for `failsafe_recovery_delay`"
        "no RC signal: start sending RC";
    NotDisarmed "NOT_DISARMED" "the link appeared with ARM on, until ARM goes off" "switch ARM off, then on";
    BoxFailsafe "BOXFAILSAFE" "the FAILSAFE switch is on" "switch FAILSAFE off";
    Runaway "RUNAWAY" "runaway take-off prevention disarmed, until ARM goes off"
        "motors or propellers mixed up: switch ARM off";
    Crash "CRASH" "crash detection disarmed, until ARM goes off" "switch ARM off";
    Throttle "THROTTLE" "the throttle is at `min_check` or above" "lower the throttle";
    Angle "ANGLE" "tilted more than `small_angle`, or the attitude is not known yet"
        "craft tilted, or no attitude yet";
    BootGrace "BOOTGRACE" "`pwr_on_arm_grace` after boot is not over" "just booted: wait a few seconds";
    NoPrearm "NOPREARM" "PREARM is bound and not switched on for this arming" "switch PREARM on";
    Load "LOAD" "never: simulated time has no overload" "CPU overload";
    Calibrating "CALIB" "a calibration of gyro, accelerometer or magnetometer runs"
        "calibrating: wait and keep still";
    Cli "CLI" "a CLI session was opened on a link, until reboot"
        "a CLI session was opened: type exit or save";
    Cms "CMS" "never: there is no on-screen menu" "close the menu";
    Bst "BST" "never: there is no BST device" "disconnect the BST device";
    Msp "MSP" "never: in a simulator the configurator may stay connected" "disconnect the configurator";
    Paralyze "PARALYZE" "the PARALYZE switch was on, until reboot" "PARALYZE was switched on: reboot";
    Gps "GPS" "GPS rescue is bound or the failsafe procedure, without its satellites, before the first arming"
        "GPS rescue needs a fix: wait for satellites";
    RescueSwitch "RESCUE_SW" "the GPS RESCUE switch is on" "switch GPS RESCUE off";
    DshotTelem "DSHOT_TELEM" "never: there is no DShot hardware" "DShot trouble";
    RebootRequired "REBOOT_REQD" "a change in memory needs a restart, until then or taken back"
        "save and reboot";
    DshotBitbang "DSHOT_BBANG" "never: there is no DShot hardware" "DShot trouble";
    NoAccCal "NO_ACC_CAL" "never: the simulated accelerometer needs no calibration"
        "calibrate the accelerometer";
    MotorProtocol "MOTOR_PROTO" "`motor_pwm_protocol` was DISABLED at boot"
        "set motor_pwm_protocol to another value, then save";
    FlipSwitch "FLIP_SWITCH" "the FLIP OVER AFTER CRASH switch is on" "switch crash flip off";
    AltHoldSwitch "ALT_HOLD_SW" "the ALTHOLD switch is on" "switch ALTHOLD off";
    PosHoldSwitch "POS_HOLD_SW" "the POS HOLD switch is on" "switch POS HOLD off";
    AutopilotSwitch "AUTOPILOT_SW" "the AUTOPILOT switch is on" "arm first, then switch AUTOPILOT on";
    ArmSwitch "ARM_SWITCH" "another flag stood while ARM was on, or a touchdown disarmed; until ARM goes off"
        "switch ARM off, then on";
}

/// A set of reasons. The bits are those on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, serde::Serialize, serde::Deserialize)]
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
