//! The phases of the failsafe in logs.

/// A phase of the failsafe. The discriminant is the number in logs. `Display` gives the name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::FromRepr, strum::IntoStaticStr)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
#[repr(u8)]
pub enum FailsafePhase {
    Idle = 0,
    /// The guard time runs, or the procedure is about to start.
    RxLossDetected = 1,
    Landing = 2,
    Landed = 3,
    /// The procedure has ended, and arming is prevented until the link is good again.
    RxLossMonitoring = 4,
    RxLossRecovered = 5,
    GpsRescue = 6,
}
