//! Kinds of firmware whose waypoint autopilots fly in different ways.

/// A kind of firmware with a waypoint autopilot. Builds of one kind share the behaviour on which scenarios depend.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    strum::Display,
    strum::EnumCount,
    strum::EnumIter,
    strum::EnumString,
    strum::IntoStaticStr,
)]
#[strum(serialize_all = "lowercase")]
pub enum FirmwareProfile {
    /// The builds of the test guide, and the embedded firmware: waypoint altitudes count from home, FLYOVER arrives at the
    /// plane of its waypoint, a HOLD of duration 0 never ends.
    Guide,
    /// Builds of upstream's master: waypoint altitudes count from sea level, every waypoint is reached by its radius, a
    /// HOLD of duration 0 ends at once.
    Master,
}
