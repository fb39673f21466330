//! The numbers that every flight of a campaign has.

use crate::telemetry::quantity::Dimension;

/// A number of a flight. All but the fence margin come from the truth.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    strum::EnumIter,
    strum::EnumString,
    strum::Display,
    strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
pub enum Metric {
    /// Greatest horizontal distance from the leg, m.
    CrossTrack,
    /// Greatest distance from the altitude of the leg, m.
    AltitudeError,
    /// Greatest horizontal distance at a waypoint, m.
    WaypointMiss,
    /// Horizontal distance of the touchdown from its place, m.
    Touchdown,
    /// Distance of the touchdown north of its place, m.
    TouchdownNorth,
    /// Distance of the touchdown east of its place, m.
    TouchdownEast,
    /// Time from the engagement to the end, s.
    Time,
    /// Charge left at the end, % of the capacity.
    BatteryLeft,
    /// Smallest distance from the fence, m.
    FenceMargin,
}

impl Metric {
    /// Returns the metric with this name.
    pub fn find(name: &str) -> Option<Self> {
        name.parse().ok()
    }

    /// Returns the dimension of its values.
    pub fn dimension(self) -> Dimension {
        match self {
            Self::Time => Dimension::TIME,
            Self::BatteryLeft => Dimension::NONE,
            _ => Dimension::LENGTH,
        }
    }

    /// Returns `true` if its values are shares of a whole.
    pub fn is_share(self) -> bool {
        self == Self::BatteryLeft
    }

    /// Returns `true` if greater values are better.
    pub fn is_better_when_greater(self) -> bool {
        matches!(self, Self::BatteryLeft | Self::FenceMargin)
    }

    /// Returns its meaning.
    pub fn help(self) -> &'static str {
        match self {
            Self::CrossTrack => "greatest horizontal distance from the leg to the present waypoint",
            Self::AltitudeError => "greatest difference from the altitude of a waypoint of the plan",
            Self::WaypointMiss => "greatest horizontal miss of a waypoint of the plan, by its own rule",
            Self::Touchdown => "distance of the touchdown from the LAND of the plan",
            Self::TouchdownNorth => "the same, north of it",
            Self::TouchdownEast => "the same, east of it",
            Self::Time => "from the engagement to the end",
            Self::BatteryLeft => "charge that is left at the end, as a share of the capacity",
            Self::FenceMargin => "least distance left to the fence, as the navigator sees it",
        }
    }
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator as _;

    use super::*;

    #[test]
    fn metrics_have_names() {
        assert_eq!(Metric::find("cross_track"), Some(Metric::CrossTrack));
        assert_eq!(Metric::find("altitude"), None);
        assert!(Metric::iter().all(|metric| Metric::find(&metric.to_string()) == Some(metric)));
    }
}
