//! Kinds of firmware whose waypoint autopilots fly in different ways.

use super::nav::NavState;

/// A kind of firmware with a waypoint autopilot. Builds of one kind share the behaviour on which scenarios depend.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Hash,
    strum::Display,
    strum::EnumCount,
    strum::EnumIter,
    strum::EnumString,
    strum::IntoStaticStr,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "lowercase")]
pub enum FirmwareProfile {
    /// The builds of the test guide: waypoint altitudes count from home, FLYOVER arrives at the plane of its waypoint, a
    /// HOLD of duration 0 never ends.
    #[default]
    Guide,
    /// Builds of upstream's master: waypoint altitudes count from sea level, every waypoint is reached by its radius, a
    /// HOLD of duration 0 ends at once.
    Master,
}

impl FirmwareProfile {
    /// Returns the setting that chooses the profile in the embedded firmware: `ap_profile = MASTER`.
    pub fn setting(self) -> String {
        format!("ap_profile = {}", self.to_string().to_uppercase())
    }

    /// Returns the name of a state of the mission. A mission that was given up is IDLE in both, and master names it.
    pub fn state_word(self, state: NavState, is_aborted: bool) -> &'static str {
        match (self, state) {
            (Self::Master, NavState::Idle) if is_aborted => "ABORTED",
            (Self::Master, NavState::Approaching | NavState::Arrived) => "TARGETING",
            (Self::Master, NavState::Holding | NavState::Orbiting | NavState::Figure8) => "HOLDING",
            (Self::Master | Self::Guide, state) => state.into(),
        }
    }
}
