//! A waypoint in the units of the command line, the stored image and the journal: the border to SI.

use crate::geo::{Degrees7, LatLon};
use crate::plan::quantity::{Altitude, LegSpeed, Seconds};
use crate::plan::{FlightPlan, HoldPattern, MAX_WAYPOINTS, Waypoint, WaypointType};

/// A waypoint as it is stored and sent. The conversion from and to [`Waypoint`] is exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub struct WaypointRecord {
    /// Position, degrees × 10⁷.
    pub position: LatLon,
    /// Altitude, cm: above home in plans, in the craft's own reference in the lines for a craft.
    pub alt_cm: i32,
    /// Leg speed, cm/s; of a YAW_RATE the rate, degrees/s.
    #[serde(rename = "speed_cms")]
    pub speed: u16,
    /// Hold or delay time, deciseconds.
    pub duration_ds: u16,
    /// The action at the waypoint.
    pub kind: WaypointType,
    /// The pattern of a HOLD.
    pub pattern: HoldPattern,
}

/// The records of a plan.
pub type Records = arrayvec::ArrayVec<WaypointRecord, MAX_WAYPOINTS>;

impl WaypointRecord {
    /// Returns the values in the order of `waypoint insert`, after the index. The caller gives the altitude as text:
    /// whole centimetres in lines for typing, metres in replies of the firmware.
    pub(crate) fn values(&self, altitude: impl std::fmt::Display) -> String {
        let Self { position, alt_cm: _, speed, duration_ds, kind, pattern } = self;
        let (lat, lon) = (Degrees7(position.lat_e7), Degrees7(position.lon_e7));
        format!("{lat} {lon} {altitude} {speed} {kind} {duration_ds} {pattern}")
    }
}

impl From<Waypoint> for WaypointRecord {
    fn from(waypoint: Waypoint) -> Self {
        let Waypoint { position, altitude, speed, yaw_rate_dps, duration, kind, pattern } = waypoint;
        let speed = if kind.has_yaw_rate() { yaw_rate_dps } else { speed.cms() };
        Self { position, alt_cm: altitude.cm(), speed, duration_ds: duration.ds(), kind, pattern }
    }
}

impl From<WaypointRecord> for Waypoint {
    fn from(record: WaypointRecord) -> Self {
        let WaypointRecord { position, alt_cm, speed, duration_ds, kind, pattern } = record;
        let (cms, yaw_rate_dps) = if kind.has_yaw_rate() { (0, speed) } else { (speed, 0) };
        Self {
            position,
            altitude: Altitude::from_cm(alt_cm),
            speed: LegSpeed::from_cms(cms),
            yaw_rate_dps,
            duration: Seconds::from_ds(duration_ds),
            kind,
            pattern,
        }
    }
}

impl FlightPlan {
    /// Returns the records of the plan.
    pub fn records(&self) -> Records {
        self.waypoints.iter().copied().map(WaypointRecord::from).collect()
    }

    /// Returns the plan of these records.
    pub fn from_records(records: &Records) -> Self {
        Self { waypoints: records.iter().copied().map(Waypoint::from).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use strum::IntoEnumIterator as _;

    fn there_and_back(record: WaypointRecord) -> WaypointRecord {
        Waypoint::from(record).into()
    }

    #[test]
    fn every_speed_and_duration_is_exact() {
        for number in 0..=u16::MAX {
            for kind in [WaypointType::Flyover, WaypointType::YawRate] {
                let record =
                    WaypointRecord { speed: number, duration_ds: number, kind, ..Default::default() };
                assert_eq!(there_and_back(record), record);
            }
            let waypoint =
                Waypoint::from(WaypointRecord { speed: number, duration_ds: number, ..Default::default() });
            assert_eq!(waypoint.duration.micros(), u64::from(number) * 100_000);
            assert_eq!(LegSpeed::from_mps(waypoint.speed.mps()), waypoint.speed);
            assert_eq!(Seconds::new(waypoint.duration.get()), waypoint.duration);
        }
    }

    #[test]
    fn a_type_keeps_the_numbers_of_the_record() {
        let record = WaypointRecord { alt_cm: 3000, speed: 250, duration_ds: 7, ..Default::default() };
        for from in WaypointType::iter() {
            let before = Waypoint::from(WaypointRecord { kind: from, ..record });
            for kind in WaypointType::iter() {
                assert_eq!(WaypointRecord::from(before.with_kind(kind)), WaypointRecord { kind, ..record });
            }
        }
    }

    #[test]
    fn values_beyond_a_record_saturate() {
        let cm = |metres| Altitude::above_home(metres).cm();
        assert_eq!([cm(1e12), cm(-1e12), cm(f64::NAN)], [i32::MAX, i32::MIN, 0]);
        assert_eq!(Altitude::from_cm(i32::MAX).raised_m(1.0).cm(), i32::MAX);
        assert_eq!([LegSpeed::from_mps(-1.0).cms(), LegSpeed::from_mps(1e6).cms()], [0, u16::MAX]);
        assert_eq!([Seconds::new(-1.0).ds(), Seconds::new(1e6).ds()], [0, u16::MAX]);
        assert_eq!((Altitude::checked(1e12), LegSpeed::checked(-0.01)), (None, None));
    }

    proptest! {
        #[test]
        fn every_altitude_is_exact(alt_cm in prop_oneof![any::<i32>(), Just(i32::MIN), Just(i32::MAX)]) {
            let record = WaypointRecord { alt_cm, ..Default::default() };
            prop_assert_eq!(there_and_back(record), record);
            let altitude = Waypoint::from(record).altitude;
            prop_assert_eq!(altitude.above_home_m().to_bits(), (f64::from(alt_cm) / 100.0).to_bits());
            prop_assert_eq!(Altitude::above_home(altitude.above_home_m()), altitude);
            prop_assert_eq!(Altitude::checked(altitude.above_home_m()), Some(altitude));
        }

        #[test]
        fn an_altitude_rises_by_whole_centimetres(alt_cm in any::<i32>(), by_cm in any::<i32>()) {
            let raised = Altitude::from_cm(alt_cm).raised_m(f64::from(by_cm) / 100.0);
            prop_assert_eq!(raised.cm(), alt_cm.saturating_add(by_cm));
        }
    }
}
