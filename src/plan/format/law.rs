//! Plans for the laws of the formats.

use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use strum::IntoEnumIterator as _;

use super::{HomePosition, PlanFile};
use crate::geo::LatLon;
use crate::plan::record::WaypointRecord;
use crate::plan::{FlightPlan, HoldPattern, MAX_WAYPOINTS, Waypoint, WaypointType};

/// Returns a file with these waypoints and nothing else.
pub(super) fn file(records: &[WaypointRecord]) -> PlanFile {
    let mut plan = FlightPlan::default();
    plan.waypoints.extend(records.iter().copied().map(Waypoint::from));
    PlanFile { plan, ..PlanFile::default() }
}

/// Generates positions: far ones, and near ones.
fn place() -> impl Strategy<Value = LatLon> {
    prop_oneof![
        Just(LatLon::default()),
        (-900_000_000..=900_000_000, -1_800_000_000..=1_800_000_000)
            .prop_map(|(lat, lon)| LatLon::new(lat, lon)),
        (404_600_000..=404_700_000, -795_200_000..=-795_100_000).prop_map(|(lat, lon)| LatLon::new(lat, lon)),
    ]
}

prop_compose! {
    /// Generates waypoints with any values that the files of other programs may have.
    pub(super) fn waypoint()(
        position in place(),
        alt_cm in prop_oneof![-2_000_000..=2_000_000, (-20..200).prop_map(|metres| metres * 100)],
        speed in prop_oneof![Just(0), 0..2000_u16, any::<u16>()],
        duration_ds in prop_oneof![Just(0), (0..600_u16).prop_map(|seconds| seconds * 10), any::<u16>()],
        kind in proptest::sample::select(WaypointType::iter().collect::<Vec<_>>()),
        pattern in proptest::sample::select(HoldPattern::iter().collect::<Vec<_>>()),
    ) -> WaypointRecord {
        WaypointRecord { position, alt_cm, speed, duration_ds, kind, pattern }
    }
}

prop_compose! {
    /// Generates whole files.
    pub(super) fn plan_file()(
        name in "\\PC{1,12}|a--->b",
        description in "\\PC{0,20}",
        home in option::of((place(), option::of(-500..9000))),
        settings in vec("[a-z_]{1,12} = -?-?[A-Z0-9.]{1,6}", 0..4),
        waypoints in vec(waypoint(), 0..=MAX_WAYPOINTS),
    ) -> PlanFile {
        let home = home.map(|(position, amsl)| HomePosition { position, amsl_m: amsl.map(f64::from) });
        PlanFile { name, description, home, settings, ..file(&waypoints) }
    }
}
