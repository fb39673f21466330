//! The reasons why the autopilot does not engage or left the mission.

use std::borrow::Cow;

use crate::math;

/// The reason why the autopilot does not engage or left the mission. `Display` gives the name (without the
/// waypoint number).
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
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
pub enum Refusal {
    /// The craft is not armed.
    NotArmed,
    /// The throttle has not been raised since arming.
    Throttle,
    /// The craft has no GPS fix.
    NoFix,
    /// The altitude is not known.
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
        /// The index of the waypoint in the stored plan.
        wp: u8,
        /// The distance of the waypoint from home, cm.
        distance_cm: u32,
        /// The radius of the fence, m.
        limit_m: u16,
    },
    /// The lowest throttle already lifts the craft.
    ThrottleMin {
        /// `ap_throttle_min`, µs.
        throttle_min_us: u16,
        /// The hover throttle observed in this flight, µs.
        hover_us: u16,
    },
    /// The receiver failsafe is active.
    Failsafe,
    /// The mission was aborted for this reason. Cycle the switch.
    Aborted(AbortReason),
}

/// The reason why a mission ended without completing.
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
    /// The craft did not fly where its nose pointed: the heading is wrong.
    MagFault,
}

impl Refusal {
    /// Returns one sentence with the missing condition and the remedy.
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
            Self::Geofence { wp, distance_cm, limit_m } => {
                let (distance_m, limit_m) = (f64::from(*distance_cm) / 100.0, f64::from(*limit_m));
                let decimals = math::decimals_apart(distance_m, limit_m, 0);
                format!(
                    "Waypoint {wp} is {distance_m:.decimals$} m from home, the fence is {limit_m:.decimals$} m."
                )
                .into()
            }
            Self::ThrottleMin { throttle_min_us, hover_us } => format!(
                "ap_throttle_min is {throttle_min_us} µs, but this craft hovers at about {hover_us} µs and could not descend: set \
                 ap_throttle_min = {} or less.",
                highest_floor_us(*hover_us)
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
                AbortReason::MagFault => {
                    "The mission was given up because the course did not fit the heading: check the compass.".into()
                }
            },
        }
    }
}

/// Returns the highest `ap_throttle_min` with which a craft of this hover throttle can descend, in tens of
/// µs.
fn highest_floor_us(hover_us: u16) -> u16 {
    (hover_us.saturating_sub(100) / 10 * 10).max(1050)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_waypoint_that_rounds_to_the_fence_shows_the_digit_that_decides() {
        let refusal = Refusal::Geofence { wp: 3, distance_cm: 10_004, limit_m: 100 };
        assert_eq!(refusal.sentence(), "Waypoint 3 is 100.04 m from home, the fence is 100.00 m.");
        let refusal = Refusal::Geofence { wp: 3, distance_cm: 15_040, limit_m: 100 };
        assert_eq!(refusal.sentence(), "Waypoint 3 is 150 m from home, the fence is 100 m.");
    }

    #[test]
    fn a_throttle_floor_above_the_hover_is_refused_with_value_limit_and_edit() {
        let refusal = Refusal::ThrottleMin { throttle_min_us: 1400, hover_us: 1347 };
        assert_eq!(refusal.to_string(), "THROTTLE_MIN");
        assert_eq!(
            refusal.sentence(),
            "ap_throttle_min is 1400 µs, but this craft hovers at about 1347 µs and could not descend: set \
             ap_throttle_min = 1240 or less."
        );
        assert_eq!(highest_floor_us(1060), 1050, "the least that the setting takes");
    }
}
