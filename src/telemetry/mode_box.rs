//! The boxes that mode conditions bind to switches.

use super::mode::Mode;

/// The effect of a box that is switched on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoxLevel {
    /// The box has its full function.
    Full,
    /// The switch works and is reported, but has no other effect.
    Flag,
    /// The box is only accepted in mode conditions. No protocol lists it.
    Name,
}

/// Defines the boxes in the order in which protocols list them, each with its permanent id, its name and its effect.
macro_rules! boxes {
    ($($(#[$doc:meta])* $variant:ident = $id:literal $name:literal $level:ident;)*) => {
        /// A box. The discriminant is its permanent id in mode conditions and protocols. `Display` gives its name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[derive(strum::Display, strum::EnumIter, strum::FromRepr, strum::IntoStaticStr, serde::Serialize, serde::Deserialize)]
        #[repr(u8)]
        #[allow(missing_docs, reason = "the variants have the names of Betaflight")]
        pub enum ModeBox {
            $($(#[$doc])* #[strum(to_string = $name)] $variant = $id,)*
        }

        impl ModeBox {
            /// Returns the effect of the box in the embedded firmware.
            pub fn level(self) -> BoxLevel {
                match self {
                    $(Self::$variant => BoxLevel::$level,)*
                }
            }
        }
    };
}

boxes! {
    Arm = 0 "ARM" Full;
    /// Self-levelling with an angle limit.
    Angle = 1 "ANGLE" Full;
    /// Self-levelling about the stick centre.
    Horizon = 2 "HORIZON" Full;
    /// Heading hold while the yaw stick is centred.
    Mag = 5 "MAG" Full;
    AltHold = 3 "ALTHOLD" Full;
    /// Interprets the sticks relative to the heading at arming.
    HeadFree = 6 "HEADFREE" Full;
    Chirp = 55 "CHIRP" Name;
    PassThru = 12 "PASSTHRU" Name;
    Failsafe = 27 "FAILSAFE" Full;
    PosHold = 11 "POS HOLD" Full;
    /// Flies home and lands.
    GpsRescue = 46 "GPS RESCUE" Full;
    /// The waypoint autopilot flies.
    Autopilot = 56 "AUTOPILOT" Full;
    /// Raises gains during quick throttle changes.
    AntiGravity = 4 "ANTI GRAVITY" Full;
    /// Takes the current heading as the headfree reference.
    HeadAdjust = 7 "HEADADJ" Full;
    CamStab = 8 "CAMSTAB" Name;
    Beeper = 13 "BEEPER" Flag;
    LedLow = 15 "LEDLOW" Name;
    Calib = 17 "CALIB" Flag;
    OsdDisable = 19 "OSD DISABLE" Flag;
    Telemetry = 20 "TELEMETRY" Name;
    Servo1 = 23 "SERVO1" Name;
    Servo2 = 24 "SERVO2" Name;
    Servo3 = 25 "SERVO3" Name;
    /// Pauses the log while it is off.
    Blackbox = 26 "BLACKBOX" Full;
    /// Full stabilisation at zero throttle.
    AirMode = 28 "AIR MODE" Full;
    ThreeDDisable = 29 "3D DISABLE" Name;
    FpvAngleMix = 30 "FPV ANGLE MIX" Flag;
    BlackboxErase = 31 "BLACKBOX ERASE" Name;
    CameraControl1 = 32 "CAMERA CONTROL 1" Flag;
    CameraControl2 = 33 "CAMERA CONTROL 2" Flag;
    CameraControl3 = 34 "CAMERA CONTROL 3" Flag;
    /// Turns the craft over after a crash.
    CrashFlip = 35 "FLIP OVER AFTER CRASH" Name;
    /// Must be on for arming.
    Prearm = 36 "PREARM" Full;
    GpsBeepSatelliteCount = 37 "GPS BEEP SATELLITE COUNT" Flag;
    VtxPitMode = 39 "VTX PIT MODE" Name;
    /// Prevents arming until reboot.
    Paralyze = 45 "PARALYZE" Full;
    User1 = 40 "USER1" Flag;
    User2 = 41 "USER2" Flag;
    User3 = 42 "USER3" Flag;
    User4 = 43 "USER4" Flag;
    PidAudio = 44 "PID AUDIO" Name;
    AcroTrainer = 47 "ACRO TRAINER" Name;
    VtxControlDisable = 48 "VTX CONTROL DISABLE" Name;
    LaunchControl = 49 "LAUNCH CONTROL" Flag;
    MspOverride = 50 "MSP OVERRIDE" Name;
    /// Prevents arming and disarming by the sticks.
    StickCommandsDisable = 51 "STICK COMMANDS DISABLE" Full;
    BeeperMute = 52 "BEEPER MUTE" Flag;
    Ready = 53 "READY" Flag;
    LapTimerReset = 54 "LAP TIMER RESET" Name;
    WpCapture = 57 "WP CAPTURE" Flag;
}

impl From<Mode> for ModeBox {
    /// Returns the box whose switch requests the mode.
    fn from(mode: Mode) -> Self {
        match mode {
            Mode::Arm => Self::Arm,
            Mode::Angle => Self::Angle,
            Mode::Horizon => Self::Horizon,
            Mode::Mag => Self::Mag,
            Mode::AltHold => Self::AltHold,
            Mode::HeadFree => Self::HeadFree,
            Mode::PosHold => Self::PosHold,
            Mode::Failsafe => Self::Failsafe,
            Mode::GpsRescue => Self::GpsRescue,
            Mode::Autopilot => Self::Autopilot,
        }
    }
}
