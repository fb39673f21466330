//! The columns of the waypoint table: a value as text, typing and nudging it.

use strum::IntoEnumIterator as _;

use crate::geo::{Degrees7, GroundPlane};
use crate::plan::format::degrees_e7;
use crate::plan::{Altitude, HoldPattern, LegSpeed, Seconds, SpeedUse, TimeUse, Waypoint, WaypointType};
use crate::ui::units::Units;
use nalgebra::Vector2;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::EnumIter)]
pub enum Column {
    /// The type of the waypoint.
    #[default]
    Type,
    /// Latitude, degrees.
    Latitude,
    /// Longitude, degrees.
    Longitude,
    /// Altitude above home, m or ft.
    Altitude,
    /// Leg speed, m/s or mph; of a YAW_RATE the rate, °/s.
    Speed,
    /// Hold or delay time, s.
    Time,
    Pattern,
}

impl Column {
    /// Returns the column `step` columns to the right.
    pub(crate) fn beside(self, step: isize) -> Self {
        let columns: Vec<Self> = Self::iter().collect();
        let at = columns.iter().position(|&column| column == self).unwrap_or(0);
        columns[at.saturating_add_signed(step).min(columns.len() - 1)]
    }

    /// Returns the name of the column for sentences.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Type => "type",
            Self::Latitude => "latitude",
            Self::Longitude => "longitude",
            Self::Altitude => "altitude",
            Self::Speed => "speed",
            Self::Time => "time",
            Self::Pattern => "pattern",
        }
    }

    /// Returns a hint about the values that may be typed.
    pub(crate) fn hint(self, kind: WaypointType, units: Units) -> String {
        match self {
            Self::Type => names(WaypointType::iter()),
            Self::Latitude => "degrees, -90 to 90".to_owned(),
            Self::Longitude => "degrees, -180 to 180".to_owned(),
            Self::Altitude => format!("{} above home", units.length_name()),
            Self::Speed if kind.has_yaw_rate() => "degrees per second".to_owned(),
            Self::Speed => {
                let most = shortest(units.speed(LegSpeed::MAX_MPS));
                format!("{} up to {most}; 0 = ap_max_velocity", units.speed_unit())
            }
            Self::Time if kind.capability().time == TimeUse::Stay => {
                "seconds up to 6553.5; 0 = endless".to_owned()
            }
            Self::Time => "seconds up to 6553.5".to_owned(),
            Self::Pattern => names(HoldPattern::iter()),
        }
    }

    /// Returns `true` if a waypoint of this type uses the value.
    pub(crate) fn is_used(self, kind: WaypointType) -> bool {
        let uses = kind.capability();
        match self {
            Self::Type => true,
            Self::Latitude | Self::Longitude => uses.place,
            Self::Altitude => uses.altitude,
            Self::Speed => uses.speed != SpeedUse::Unused,
            Self::Time => matches!(uses.time, TimeUse::Stay | TimeUse::Needed),
            Self::Pattern => uses.pattern,
        }
    }

    /// Returns the value as the user types it.
    pub(crate) fn text(self, wp: &Waypoint, units: Units) -> String {
        match self {
            Self::Type => wp.kind.to_string(),
            Self::Latitude => Degrees7(wp.position.lat_e7).to_string(),
            Self::Longitude => Degrees7(wp.position.lon_e7).to_string(),
            Self::Altitude => shortest(units.length(wp.altitude.above_home_m())),
            Self::Speed if wp.kind.has_yaw_rate() => wp.yaw_rate_dps.to_string(),
            Self::Speed => shortest(units.speed(wp.speed.mps())),
            Self::Time => shortest(wp.duration.get()),
            Self::Pattern => wp.pattern.to_string(),
        }
    }

    /// Sets a typed value. The beginning of a name is enough.
    ///
    /// # Errors
    /// Returns the problem and the allowed values in one sentence.
    pub(crate) fn set(self, wp: &mut Waypoint, text: &str, units: Units) -> Result<(), String> {
        let text = text.trim();
        let wrong = || format!("{text} is no {}: {}.", self.name(), self.hint(wp.kind, units));
        match self {
            Self::Type => *wp = wp.with_kind(by_prefix(text, WaypointType::iter()).ok_or_else(wrong)?),
            Self::Pattern => wp.pattern = by_prefix(text, HoldPattern::iter()).ok_or_else(wrong)?,
            Self::Latitude => wp.position.lat_e7 = within(text, 900_000_000).ok_or_else(wrong)?,
            Self::Longitude => wp.position.lon_e7 = within(text, 1_800_000_000).ok_or_else(wrong)?,
            Self::Altitude => {
                let cm = scaled(text, units.metres(100.0), f64::from(i32::MIN), f64::from(i32::MAX))
                    .ok_or_else(wrong)?;
                wp.altitude = Altitude::above_home(cm / 100.0);
            }
            Self::Speed if wp.kind.has_yaw_rate() => {
                wp.yaw_rate_dps = scaled(text, 1.0, 0.0, f64::from(u16::MAX)).ok_or_else(wrong)? as u16;
            }
            Self::Speed => {
                let cms = scaled(text, units.metres_per_second(100.0), 0.0, f64::from(u16::MAX));
                wp.speed = LegSpeed::from_mps(cms.ok_or_else(wrong)? / 100.0);
            }
            Self::Time => {
                let ds = scaled(text, 10.0, 0.0, f64::from(u16::MAX)).ok_or_else(wrong)?;
                wp.duration = Seconds::new(ds / 10.0);
            }
        }
        Ok(())
    }

    /// Changes the value by steps: a metre or a foot for position and altitude, 0.5 m/s or 1 mph for speed, a second
    /// for time. Names wrap around.
    pub(crate) fn nudge(self, wp: &mut Waypoint, steps: i32, units: Units) {
        let ground_m = units.metres(f64::from(steps));
        match self {
            Self::Type => *wp = wp.with_kind(beside(&wp.kind, WaypointType::iter(), steps)),
            Self::Pattern => wp.pattern = beside(&wp.pattern, HoldPattern::iter(), steps),
            Self::Latitude => {
                wp.position = GroundPlane::new(wp.position).to_position(Vector2::new(ground_m, 0.0));
            }
            Self::Longitude => {
                wp.position = GroundPlane::new(wp.position).to_position(Vector2::new(0.0, ground_m));
            }
            Self::Altitude => {
                wp.altitude = Altitude::above_home(units.step_length(wp.altitude.above_home_m(), steps));
            }
            Self::Speed if wp.kind.has_yaw_rate() => {
                let rate_dps = i32::from(wp.yaw_rate_dps) + steps;
                wp.yaw_rate_dps = rate_dps.clamp(0, i32::from(u16::MAX)) as u16;
            }
            Self::Speed => wp.speed = LegSpeed::from_mps(units.step_speed(wp.speed.mps(), steps)),
            Self::Time => wp.duration = Seconds::new(wp.duration.get() + f64::from(steps)),
        }
    }
}

/// Formats a number without needless zeros: `50`, `62.5`.
pub(crate) fn shortest(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn names<T: ToString>(all: impl Iterator<Item = T>) -> String {
    all.map(|name| name.to_string()).collect::<Vec<_>>().join(", ")
}

fn by_prefix<T: ToString>(text: &str, all: impl Iterator<Item = T>) -> Option<T> {
    let text = text.to_ascii_uppercase();
    // `FLY` fits both FLYOVER and FLYBY: the first of them is the usual one.
    all.into_iter().find(|name| !text.is_empty() && name.to_string().starts_with(&text))
}

fn within(text: &str, limit_e7: u32) -> Option<i32> {
    degrees_e7(text).filter(|value| value.unsigned_abs() <= limit_e7)
}

fn scaled(text: &str, scale: f64, least: f64, most: f64) -> Option<f64> {
    let value = (text.parse::<f64>().ok()? * scale).round();
    (value >= least && value <= most).then_some(value)
}

fn beside<T: PartialEq>(value: &T, all: impl Iterator<Item = T>, steps: i32) -> T {
    let mut all: Vec<T> = all.collect();
    let at = all.iter().position(|other| other == value).unwrap_or(0) as i64;
    let to = (at + i64::from(steps)).rem_euclid(all.len() as i64);
    all.swap_remove(to as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::WaypointRecord;

    /// Returns altitude and speed as they are stored.
    fn record(wp: &Waypoint) -> (i32, u16) {
        let record = WaypointRecord::from(*wp);
        (record.alt_cm, record.speed)
    }

    #[test]
    fn what_is_shown_can_be_typed() {
        let wp = Waypoint {
            position: crate::geo::LatLon::new(404_640_000, -795_175_001),
            altitude: Altitude::above_home(-12.5),
            speed: LegSpeed::from_mps(3.33),
            duration: Seconds::new(30.5),
            kind: WaypointType::Hold,
            pattern: HoldPattern::Figure8,
            ..Waypoint::default()
        };
        for units in [Units::Metric, Units::Imperial] {
            let mut typed = Waypoint { kind: WaypointType::Hold, ..Waypoint::default() };
            for column in Column::iter() {
                column.set(&mut typed, &column.text(&wp, units), units).unwrap();
            }
            assert_eq!(typed, wp, "in {units:?}");
        }
    }

    #[test]
    fn feet_and_miles_an_hour_are_typed_and_nudged_without_drift() {
        let units = Units::Imperial;
        let mut wp = Waypoint { kind: WaypointType::Hold, ..Waypoint::default() };
        Column::Altitude.set(&mut wp, "100", units).unwrap();
        Column::Speed.set(&mut wp, "10", units).unwrap();
        assert_eq!(record(&wp), (3048, 447));
        for _ in 0..400 {
            Column::Altitude.nudge(&mut wp, 1, units);
            Column::Speed.nudge(&mut wp, 1, units);
        }
        assert_eq!(record(&wp), (15_240, 18_329), "500 ft, 410 mph");
        assert!(Column::Speed.set(&mut wp, "1500", units).unwrap_err().contains("mph up to 1465.98"));
    }

    #[test]
    fn wrong_values_say_what_is_allowed_and_change_nothing() {
        for (column, text) in [
            (Column::Type, "x"),
            (Column::Type, ""),
            (Column::Latitude, "95"),
            (Column::Longitude, "4O.5"),
            (Column::Altitude, "nan"),
            (Column::Speed, "700"),
            (Column::Speed, "-1"),
            (Column::Time, "1e9"),
        ] {
            let mut wp = Waypoint::default();
            let said = column.set(&mut wp, text, Units::Metric).unwrap_err();
            assert!(said.starts_with(text) && said.ends_with('.') && said.contains(column.name()), "{said}");
            assert_eq!(wp, Waypoint::default());
        }
    }

    #[test]
    fn nudges_go_by_a_metre_and_names_go_round() {
        let mut wp = Waypoint { altitude: Altitude::above_home(10.0), ..Waypoint::default() };
        Column::Altitude.nudge(&mut wp, 3, Units::Metric);
        Column::Speed.nudge(&mut wp, -1, Units::Metric);
        Column::Type.nudge(&mut wp, -1, Units::Metric);
        Column::Latitude.nudge(&mut wp, 10, Units::Metric);
        assert_eq!((record(&wp), wp.kind), ((1300, 0), WaypointType::YawRate));
        assert_eq!(wp.position.lat_e7, 898);
    }
}
