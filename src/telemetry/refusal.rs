//! Why the autopilot does not engage or left the mission.

use std::borrow::Cow;

/// Why the autopilot does not engage or left the mission; `Display` gives the name (without the waypoint
/// number).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::IntoStaticStr)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
pub enum Refusal {
    /// The craft is not armed.
    NotArmed,
    /// The throttle has not been raised since arming.
    Throttle,
    /// No GPS fix.
    NoFix,
    /// No altitude estimate.
    NoAltitude,
    /// The heading is unknown.
    NoHeading,
    /// The stored plan is empty.
    NoPlan,
    /// The stored plan is damaged.
    PlanCorrupt,
    /// This waypoint is invalid.
    BadWaypoint(u8),
    /// A fence is set but home is unknown.
    NoHome,
    /// This waypoint lies outside the fence.
    Geofence {
        /// Index of the waypoint in the stored plan.
        wp: u8,
        /// Its distance from home, cm.
        distance_cm: u32,
        /// The fence, m.
        limit_m: u16,
    },
    /// The receiver failsafe is active.
    Failsafe,
    /// The mission was given up for this cause; cycle the switch.
    Aborted(AbortReason),
}

/// Why a mission ended without completing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::IntoStaticStr)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
pub enum AbortReason {
    /// No progress towards the waypoint for 30 s.
    Stalled,
    /// The craft moves away from the waypoint.
    Flyaway,
    /// The GPS fix was lost.
    GpsLost,
    /// The plan was cleared while it was flown.
    NoPlan,
}

impl Refusal {
    /// One sentence: what is missing and what to do.
    #[must_use]
    pub fn sentence(&self) -> Cow<'static, str> {
        match self {
            Self::NotArmed => "Autopilot needs an armed craft: arm first, then switch on.".into(),
            Self::Throttle => "Raise the throttle once after arming.".into(),
            Self::NoFix => "No GPS fix: wait for satellites.".into(),
            Self::NoAltitude => "No altitude estimate.".into(),
            Self::NoHeading => "Heading unknown: fly straight faster than 3 m/s for 3 s.".into(),
            Self::NoPlan => "No waypoints: upload a plan.".into(),
            Self::PlanCorrupt => "The stored plan is damaged: upload it again.".into(),
            Self::BadWaypoint(wp) => format!(
                "Waypoint {wp} is invalid: its latitude must lie within 90 degrees, its longitude within 180, and its type \
                 and pattern must be known; correct it."
            )
            .into(),
            Self::NoHome => "Fence is set but home is unknown: arm with a fix.".into(),
            Self::Geofence { wp, distance_cm, limit_m } => format!(
                "Waypoint {wp} is {:.0} m from home, the fence is {limit_m} m.",
                f64::from(*distance_cm) / 100.0
            )
            .into(),
            Self::Failsafe => "RX failsafe is active.".into(),
            Self::Aborted(why) => match why {
                AbortReason::Stalled => {
                    "The mission was given up because the craft made no progress: cycle the switch.".into()
                }
                AbortReason::Flyaway => {
                    "The mission was given up because the craft moved away from its waypoint: cycle the switch."
                        .into()
                }
                AbortReason::GpsLost => "The GPS fix was lost: the mission resumes 2 s after it is back.".into(),
                AbortReason::NoPlan => "The plan was cleared in flight: upload a plan.".into(),
            },
        }
    }
}
