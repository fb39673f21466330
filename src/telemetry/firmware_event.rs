//! The events that the flight controller reports.

use super::battery_alarm::BatteryAlarm;
use super::failsafe::{FailsafeProcedure, RxLossPolicy};
use super::firmware_notice::FirmwareNotice;
use super::mode::ModeFlags;
use super::nav::NavEvent;

/// The reason for a disarming. The discriminant is the code in logs and protocols.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    strum::Display,
    strum::EnumIter,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
#[repr(u8)]
pub enum DisarmReason {
    /// An arming disable flag appeared.
    ArmingDisabled = 0,
    /// A failsafe procedure.
    Failsafe = 1,
    /// The throttle was low for too long.
    ThrottleTimeout = 2,
    /// Command of the sticks.
    Sticks = 3,
    /// The ARM switch went off.
    Switch = 4,
    /// The crash protection acted.
    CrashProtection = 5,
    /// The take-off ran away.
    RunawayTakeoff = 6,
    /// The GPS rescue ended.
    GpsRescue = 7,
    /// A command over a serial link.
    SerialCommand = 8,
    /// The autopilot detected the touchdown.
    Landing = 9,
    /// The craft was turned over after a crash.
    Crashflip = 10,
    /// The reason is unknown because a remote flight controller does not report it.
    Unknown = 254,
    /// A reason of the system, such as a restart.
    System = 255,
}

/// An event of the flight controller.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum FirmwareEvent {
    /// The GPS got its first fix, or has a fix again.
    GpsFix {
        /// The number of satellites.
        sats: u8,
    },
    /// The fix was lost.
    GpsLost {
        /// The number of satellites.
        sats: u8,
    },
    /// The craft was armed.
    Armed,
    /// The craft was disarmed.
    Disarmed(DisarmReason),
    /// The set of active modes changed.
    Mode(ModeFlags),
    /// The receiver link was lost (stage 1).
    RxLoss,
    /// The receiver link is back.
    RxRecovered,
    /// A failsafe stage began.
    Failsafe {
        /// The `ap_rx_loss_policy` in force.
        policy: RxLossPolicy,
        /// 1 at the loss, 2 when the procedure starts.
        stage: u8,
        /// The procedure that flies at stage 2.
        procedure: FailsafeProcedure,
    },
    /// An event of the navigator.
    Nav(NavEvent),
    /// The battery is low. This is only reported.
    Battery {
        /// The level of the alarm.
        state: BatteryAlarm,
        /// The voltage per cell, V.
        cell_v: f64,
    },
    /// The magnetometer disagrees with the course over ground, or agrees again.
    HeadingDoubt {
        /// `true` if the magnetometer is doubted, and the course is used instead.
        on: bool,
        /// The magnetic heading minus the heading by the course, degrees.
        error_deg: f64,
    },
    /// Gyro and accelerometer disagree on the tilt, or agree again.
    #[serde(rename = "LeanDoubt")]
    TiltDoubt {
        /// `true` if the tilt is doubted, and corrected faster.
        on: bool,
        /// The error of the tilt at its beginning, degrees.
        error_deg: f64,
    },
    /// A notice for the pilot. It has no stored form: recordings keep its sentence.
    #[serde(skip)]
    Notice(FirmwareNotice),
}
