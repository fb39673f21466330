//! The boxes that mode conditions bind to switches.

use super::mode::Mode;

/// Defines the boxes, each with its permanent id and its name.
macro_rules! boxes {
    ($($(#[$doc:meta])* $variant:ident = $id:literal $name:literal;)*) => {
        /// A box. The discriminant is its permanent id in mode conditions and protocols. `Display` gives its name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[derive(strum::Display, strum::FromRepr, strum::IntoStaticStr)]
        #[repr(u8)]
        pub enum ModeBox {
            $($(#[$doc])* #[strum(to_string = $name)] $variant = $id,)*
        }
    };
}

boxes! {
    Arm = 0 "ARM";
    /// Self-levelling with an angle limit.
    Angle = 1 "ANGLE";
    /// Self-levelling about the stick centre.
    Horizon = 2 "HORIZON";
    AltHold = 3 "ALTHOLD";
    /// Raises gains during quick throttle changes.
    AntiGravity = 4 "ANTI GRAVITY";
    /// Heading hold while the yaw stick is centred.
    Mag = 5 "MAG";
    /// Interprets the sticks relative to the heading at arming.
    HeadFree = 6 "HEADFREE";
    /// Takes the current heading as the headfree reference.
    HeadAdjust = 7 "HEADADJ";
    CamStab = 8 "CAMSTAB";
    PosHold = 11 "POS HOLD";
    PassThru = 12 "PASSTHRU";
    Beeper = 13 "BEEPER";
    LedLow = 15 "LEDLOW";
    Calib = 17 "CALIB";
    OsdDisable = 19 "OSD DISABLE";
    Telemetry = 20 "TELEMETRY";
    Servo1 = 23 "SERVO1";
    Servo2 = 24 "SERVO2";
    Servo3 = 25 "SERVO3";
    Blackbox = 26 "BLACKBOX";
    Failsafe = 27 "FAILSAFE";
    /// Full stabilisation at zero throttle.
    AirMode = 28 "AIR MODE";
    ThreeDDisable = 29 "3D DISABLE";
    FpvAngleMix = 30 "FPV ANGLE MIX";
    BlackboxErase = 31 "BLACKBOX ERASE";
    CameraControl1 = 32 "CAMERA CONTROL 1";
    CameraControl2 = 33 "CAMERA CONTROL 2";
    CameraControl3 = 34 "CAMERA CONTROL 3";
    /// Turns the craft over after a crash.
    CrashFlip = 35 "FLIP OVER AFTER CRASH";
    /// Must be on for arming.
    Prearm = 36 "PREARM";
    GpsBeepSatelliteCount = 37 "GPS BEEP SATELLITE COUNT";
    VtxPitMode = 39 "VTX PIT MODE";
    User1 = 40 "USER1";
    User2 = 41 "USER2";
    User3 = 42 "USER3";
    User4 = 43 "USER4";
    PidAudio = 44 "PID AUDIO";
    /// Prevents arming until reboot.
    Paralyze = 45 "PARALYZE";
    /// Flies home and lands.
    GpsRescue = 46 "GPS RESCUE";
    AcroTrainer = 47 "ACRO TRAINER";
    VtxControlDisable = 48 "VTX CONTROL DISABLE";
    LaunchControl = 49 "LAUNCH CONTROL";
    MspOverride = 50 "MSP OVERRIDE";
    /// Prevents arming and disarming by the sticks.
    StickCommandsDisable = 51 "STICK COMMANDS DISABLE";
    BeeperMute = 52 "BEEPER MUTE";
    Ready = 53 "READY";
    LapTimerReset = 54 "LAP TIMER RESET";
    Chirp = 55 "CHIRP";
    /// The waypoint autopilot flies.
    Autopilot = 56 "AUTOPILOT";
    WpCapture = 57 "WP CAPTURE";
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
