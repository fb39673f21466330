//! The boxes that mode conditions bind to switches.

use super::mode::Mode;

/// A box. The discriminant is its permanent id in mode conditions and protocols. `Display` gives its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::FromRepr, strum::IntoStaticStr)]
#[repr(u8)]
pub enum ModeBox {
    #[strum(to_string = "ARM")]
    Arm = 0,
    /// Self-levelling with an angle limit.
    #[strum(to_string = "ANGLE")]
    Angle = 1,
    /// Self-levelling about the stick centre.
    #[strum(to_string = "HORIZON")]
    Horizon = 2,
    #[strum(to_string = "ALTHOLD")]
    AltHold = 3,
    /// Raises gains during quick throttle changes.
    #[strum(to_string = "ANTI GRAVITY")]
    AntiGravity = 4,
    /// Heading hold while the yaw stick is centred.
    #[strum(to_string = "MAG")]
    Mag = 5,
    /// Interprets the sticks relative to the heading at arming.
    #[strum(to_string = "HEADFREE")]
    HeadFree = 6,
    /// Takes the current heading as the headfree reference.
    #[strum(to_string = "HEADADJ")]
    HeadAdjust = 7,
    #[strum(to_string = "CAMSTAB")]
    CamStab = 8,
    #[strum(to_string = "POS HOLD")]
    PosHold = 11,
    #[strum(to_string = "PASSTHRU")]
    PassThru = 12,
    #[strum(to_string = "BEEPER")]
    Beeper = 13,
    #[strum(to_string = "LEDLOW")]
    LedLow = 15,
    #[strum(to_string = "CALIB")]
    Calib = 17,
    #[strum(to_string = "OSD DISABLE")]
    OsdDisable = 19,
    #[strum(to_string = "TELEMETRY")]
    Telemetry = 20,
    #[strum(to_string = "SERVO1")]
    Servo1 = 23,
    #[strum(to_string = "SERVO2")]
    Servo2 = 24,
    #[strum(to_string = "SERVO3")]
    Servo3 = 25,
    #[strum(to_string = "BLACKBOX")]
    Blackbox = 26,
    #[strum(to_string = "FAILSAFE")]
    Failsafe = 27,
    /// Full stabilisation at zero throttle.
    #[strum(to_string = "AIR MODE")]
    AirMode = 28,
    #[strum(to_string = "3D DISABLE")]
    ThreeDDisable = 29,
    #[strum(to_string = "FPV ANGLE MIX")]
    FpvAngleMix = 30,
    #[strum(to_string = "BLACKBOX ERASE")]
    BlackboxErase = 31,
    #[strum(to_string = "CAMERA CONTROL 1")]
    CameraControl1 = 32,
    #[strum(to_string = "CAMERA CONTROL 2")]
    CameraControl2 = 33,
    #[strum(to_string = "CAMERA CONTROL 3")]
    CameraControl3 = 34,
    /// Turns the craft over after a crash.
    #[strum(to_string = "FLIP OVER AFTER CRASH")]
    CrashFlip = 35,
    /// Must be on for arming.
    #[strum(to_string = "PREARM")]
    Prearm = 36,
    #[strum(to_string = "GPS BEEP SATELLITE COUNT")]
    GpsBeepSatelliteCount = 37,
    #[strum(to_string = "VTX PIT MODE")]
    VtxPitMode = 39,
    #[strum(to_string = "USER1")]
    User1 = 40,
    #[strum(to_string = "USER2")]
    User2 = 41,
    #[strum(to_string = "USER3")]
    User3 = 42,
    #[strum(to_string = "USER4")]
    User4 = 43,
    #[strum(to_string = "PID AUDIO")]
    PidAudio = 44,
    /// Prevents arming until reboot.
    #[strum(to_string = "PARALYZE")]
    Paralyze = 45,
    /// Flies home and lands.
    #[strum(to_string = "GPS RESCUE")]
    GpsRescue = 46,
    #[strum(to_string = "ACRO TRAINER")]
    AcroTrainer = 47,
    #[strum(to_string = "VTX CONTROL DISABLE")]
    VtxControlDisable = 48,
    #[strum(to_string = "LAUNCH CONTROL")]
    LaunchControl = 49,
    #[strum(to_string = "MSP OVERRIDE")]
    MspOverride = 50,
    /// Prevents arming and disarming by the sticks.
    #[strum(to_string = "STICK COMMANDS DISABLE")]
    StickCommandsDisable = 51,
    #[strum(to_string = "BEEPER MUTE")]
    BeeperMute = 52,
    #[strum(to_string = "READY")]
    Ready = 53,
    #[strum(to_string = "LAP TIMER RESET")]
    LapTimerReset = 54,
    #[strum(to_string = "CHIRP")]
    Chirp = 55,
    /// The waypoint autopilot flies.
    #[strum(to_string = "AUTOPILOT")]
    Autopilot = 56,
    #[strum(to_string = "WP CAPTURE")]
    WpCapture = 57,
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
