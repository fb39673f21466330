//! What a lost receiver link leads to.

/// What a lost receiver link does to a mission: `ap_rx_loss_policy`.
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
)]
#[strum(serialize_all = "UPPERCASE")]
#[repr(u8)]
pub enum RxLossPolicy {
    /// The mission ends and the configured failsafe procedure runs.
    #[default]
    Disable = 0,
    /// The mission goes on.
    Continue = 1,
    /// Land where the link was lost.
    Land = 2,
}

/// What stage 2 of the failsafe does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::IntoStaticStr)]
pub enum FailsafeProcedure {
    #[strum(to_string = "DROP")]
    Drop,
    /// Level, hold the place, descend.
    #[strum(to_string = "AUTO-LAND")]
    AutoLand,
    /// Fly home and land.
    #[strum(to_string = "GPS-RESCUE")]
    GpsRescue,
    /// The mission goes on.
    #[strum(to_string = "CONTINUE")]
    Continue,
    /// The navigator lands where the craft is.
    #[strum(to_string = "LAND")]
    Land,
}

/// The failsafe that comes while the receiver link is lost and its guard time runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailsafeAhead {
    /// Time until the procedure starts, s.
    pub in_s: f64,
    /// What it would be now.
    pub procedure: FailsafeProcedure,
}
