//! The deviation of a craft that cannot hold its position.

/// The limit that keeps a craft from holding its position. `Display` gives the word in events.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    strum::Display,
    strum::IntoStaticStr,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "lowercase")]
pub enum HoldLimit {
    /// The tilt is at `ap_max_angle`.
    #[strum(serialize = "lean")]
    #[serde(rename = "Lean")]
    Tilt,
    /// The throttle is at `ap_throttle_max`.
    Throttle,
    /// The throttle is at `ap_throttle_max`, and a low battery gives no more thrust.
    Battery,
    /// No limit is known to the autopilot.
    #[default]
    None,
}

/// The deviation of a craft from its target.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct CannotHold {
    /// The horizontal distance from the target, m.
    pub distance_m: f64,
    /// The height above the altitude setpoint, m; negative below it.
    pub vertical_m: f64,
    /// The limit that is exceeded.
    pub limit: HoldLimit,
}
