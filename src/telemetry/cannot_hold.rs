//! A craft that cannot stay where it should.

/// What keeps a craft from its place; `Display` is the word of events.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::Display, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum HoldLimit {
    /// The lean is at `ap_max_angle`.
    Lean,
    /// The throttle is at `ap_throttle_max`.
    Throttle,
    /// The throttle is at `ap_throttle_max`, and the battery is low: it gives no more thrust.
    Battery,
    /// Nothing that the autopilot knows of.
    #[default]
    None,
}

/// How far a craft is from where it should stay.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CannotHold {
    /// Horizontal distance from the target, m.
    pub distance_m: f64,
    /// Height above the altitude setpoint, m; negative below it.
    pub vertical_m: f64,
    pub limit: HoldLimit,
}
