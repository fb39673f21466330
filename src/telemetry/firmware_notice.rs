//! The notices of the flight controller to its pilot.

/// A notice for the pilot. `Display` gives the sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
pub enum FirmwareNotice {
    /// The configured airframe type is not supported.
    #[strum(
        to_string = "This mixer type does not fly here: QUADX, QUADP, QUADX1234 and CUSTOM do; QUADX is flown instead."
    )]
    MixerNotFlown,
    /// Making the configuration consistent switched the GPS feature off.
    #[strum(
        to_string = "GPS is off: gps_provider wants a receiver on a serial port; set gps_provider = VIRTUAL, feature GPS, save."
    )]
    GpsSwitchedOff,
    /// The first arming waits for a gyro calibration.
    #[strum(to_string = "Calibrating the gyro before the first arming.")]
    CalibratingGyro,
    /// Arm assist was needed.
    #[strum(
        to_string = "Arm assist: armed although the ARM switch was on early or the throttle was not quite low."
    )]
    ArmAssisted,
    /// An accelerometer calibration ended.
    #[strum(to_string = "Accelerometer calibrated; save keeps the result.")]
    AccCalibrated,
    /// A magnetometer calibration ended.
    #[strum(to_string = "Magnetometer calibrated; save keeps the result.")]
    MagCalibrated,
    /// A magnetometer calibration ended without a result.
    #[strum(
        to_string = "Magnetometer not calibrated: the craft was not turned about all its axes; its offsets stay."
    )]
    MagNotTurned,
    /// The offsets that a magnetometer calibration found are too large.
    #[strum(to_string = "Magnetometer not calibrated: its field is out of range; its offsets stay.")]
    MagOutOfRange,
    /// Position hold is requested without a position.
    #[strum(to_string = "POS HOLD has no position: the craft is only levelled.")]
    NoPosition,
    /// Position hold is requested without a heading.
    #[strum(to_string = "POS HOLD has no heading: the craft is only levelled.")]
    NoHeading,
    /// The inertial sensors repeat one sample.
    #[strum(to_string = "The inertial sensors repeat one sample: they hang.")]
    ImuFrozen,
    /// A setting accepted a value that current firmware refuses.
    #[strum(
        to_string = "{name} = {value} is taken here, but current Betaflight refuses it: it allows {min} to {max}."
    )]
    BeyondCurrentFirmware {
        /// The name of the setting.
        name: &'static str,
        /// The accepted value.
        value: i64,
        /// The least value in current firmware.
        min: i64,
        /// The greatest value in current firmware.
        max: i64,
    },
    /// A setting got a value that acts in the profile `master` only.
    #[strum(
        to_string = "Settings of ap_nav_ act in the profile master only: --profile master, or set ap_profile = MASTER, flies by it."
    )]
    ActsInMaster,
    /// A crash was detected.
    #[strum(to_string = "Crash detected: the craft is levelled, the sticks rest.")]
    CrashDetected,
}
