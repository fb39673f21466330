//! The reactions to a lost receiver link.

/// The effect of a lost receiver link on a mission: `ap_rx_loss_policy`.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Hash,
    strum::Display,
    strum::EnumIter,
    strum::FromRepr,
    strum::IntoStaticStr,
    strum::VariantNames,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "UPPERCASE")]
#[repr(u8)]
pub enum RxLossPolicy {
    /// The mission ends and the configured failsafe procedure runs.
    #[default]
    Disable = 0,
    /// The mission continues.
    Continue = 1,
    /// The craft lands at the place of the loss.
    Land = 2,
}

/// The procedure of failsafe stage 2.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    strum::Display,
    strum::IntoStaticStr,
    serde::Serialize,
    serde::Deserialize,
)]
pub enum FailsafeProcedure {
    /// Stops the motors.
    #[strum(to_string = "DROP")]
    Drop,
    /// Level, hold the position, descend.
    #[strum(to_string = "AUTO-LAND")]
    AutoLand,
    /// Fly home and land.
    #[strum(to_string = "GPS-RESCUE")]
    GpsRescue,
    /// The mission continues.
    #[strum(to_string = "CONTINUE")]
    Continue,
    /// The navigator lands at the current place.
    #[strum(to_string = "LAND")]
    Land,
}

/// The failsafe that will start after the guard time of a lost receiver link.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FailsafeAhead {
    /// Time until the procedure starts, s.
    pub in_s: f64,
    /// The procedure that would start now.
    pub procedure: FailsafeProcedure,
}
