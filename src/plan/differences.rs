//! The differences between two plans, waypoint by waypoint and field by field.

use std::fmt;

use super::{FlightPlan, HoldPattern};
use crate::geo::Degrees7;
use crate::plan::record::WaypointRecord;

/// A difference of one field. `Display` gives `WP3 altitude: 50 m → 15.24 m`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// The waypoint, from 0.
    pub waypoint: usize,
    /// The field; `waypoint` if the other plan does not have it.
    pub field: &'static str,
    /// The value of the first plan.
    pub from: String,
    /// The value of the second plan.
    pub to: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { waypoint, field, from, to } = self;
        write!(f, "WP{waypoint} {field}: {from} → {to}")
    }
}

/// A waypoint of one plan beside its counterpart in another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pair {
    /// The number in the first plan; `None` if only the second one has it.
    pub from: Option<usize>,
    /// The number in the second plan; `None` if only the first one has it.
    pub to: Option<usize>,
}

/// Returns the waypoints of two plans beside each other. Equal waypoints at the beginning and at the end belong
/// together, so that one that was inserted or deleted does not shift the others. Those between them are paired in their
/// order.
pub fn pairs(from: &FlightPlan, to: &FlightPlan) -> Vec<Pair> {
    let (a, b) = (&from.waypoints, &to.waypoints);
    let shorter = a.len().min(b.len());
    let before = std::iter::zip(a, b).take_while(|(a, b)| a == b).count();
    let after = std::iter::zip(a.iter().rev(), b.iter().rev()).take_while(|(a, b)| a == b).count();
    let after = after.min(shorter - before);
    let both = shorter - before - after;
    let pair = |from, to| Pair { from: Some(from), to: Some(to) };
    let firsts = (0..before + both).map(|at| pair(at, at));
    let only_from = (before + both..a.len() - after).map(|at| Pair { from: Some(at), to: None });
    let only_to = (before + both..b.len() - after).map(|at| Pair { from: None, to: Some(at) });
    let lasts = (0..after).map(|at| pair(a.len() - after + at, b.len() - after + at));
    firsts.chain(only_from).chain(only_to).chain(lasts).collect()
}

/// Returns the differences of the plan `to` from the plan `from`, in the order of the waypoints.
pub fn differences(from: &FlightPlan, to: &FlightPlan) -> Vec<Difference> {
    let (from, to) = (from.records(), to.records());
    let of_both = std::iter::zip(&from, &to).enumerate();
    let mut found: Vec<Difference> = of_both.flat_map(|(index, (a, b))| of_waypoint(index, a, b)).collect();
    let field = "waypoint";
    found.extend(from.iter().enumerate().skip(to.len()).map(|(waypoint, record)| Difference {
        waypoint,
        field,
        from: record.kind.to_string(),
        to: "none".to_owned(),
    }));
    found.extend(to.iter().enumerate().skip(from.len()).map(|(waypoint, record)| Difference {
        waypoint,
        field,
        from: "none".to_owned(),
        to: record.kind.to_string(),
    }));
    found
}

/// A field of a record: its name, and its value as text with the unit.
type Field = (&'static str, fn(&WaypointRecord) -> String);

fn of_waypoint(waypoint: usize, a: &WaypointRecord, b: &WaypointRecord) -> Vec<Difference> {
    let fields: [Field; 6] = [
        ("type", |record| record.kind.to_string()),
        ("position", |record| {
            format!("{},{}", Degrees7(record.position.lat_e7), Degrees7(record.position.lon_e7))
        }),
        ("altitude", |record| format!("{} m", f64::from(record.alt_cm) / 100.0)),
        ("speed", |record| match (record.kind.has_yaw_rate(), record.speed) {
            (true, rate) => format!("{rate} deg/s"),
            (false, 0) => "default".to_owned(),
            (false, speed) => format!("{} m/s", f64::from(speed) / 100.0),
        }),
        ("duration", |record| format!("{} s", f64::from(record.duration_ds) / 10.0)),
        ("pattern", |record| match record.pattern {
            HoldPattern::None => "none".to_owned(),
            pattern => pattern.to_string(),
        }),
    ];
    fields
        .into_iter()
        .map(|(field, value)| Difference { waypoint, field, from: value(a), to: value(b) })
        .filter(|difference| difference.from != difference.to)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::format::{Format, parse};
    use super::*;
    use crate::plan::{Altitude, Waypoint};
    use proptest::prelude::*;

    fn plan(lines: &str) -> FlightPlan {
        parse("p.txt", lines, Format::CliText).unwrap().plan
    }

    fn lines(from: &FlightPlan, to: &FlightPlan) -> Vec<String> {
        differences(from, to).iter().map(ToString::to_string).collect()
    }

    fn with_altitudes(altitudes: &[u16]) -> FlightPlan {
        let waypoint = |altitude: &u16| Waypoint {
            altitude: Altitude::above_home(f64::from(*altitude)),
            ..Waypoint::default()
        };
        FlightPlan { waypoints: altitudes.iter().map(waypoint).collect() }
    }

    #[test]
    fn an_inserted_waypoint_does_not_shift_the_others() {
        let pair = |from, to| Pair { from, to };
        assert_eq!(
            pairs(&with_altitudes(&[1, 2, 3]), &with_altitudes(&[1, 9, 2, 3])),
            [pair(Some(0), Some(0)), pair(None, Some(1)), pair(Some(1), Some(2)), pair(Some(2), Some(3))]
        );
        assert_eq!(
            pairs(&with_altitudes(&[1, 1]), &with_altitudes(&[1])),
            [pair(Some(0), Some(0)), pair(Some(1), None)]
        );
    }

    proptest! {
        #[test]
        fn every_waypoint_of_both_plans_is_in_one_pair(
            a in prop::collection::vec(0_u16..3, 0..8),
            b in prop::collection::vec(0_u16..3, 0..8),
        ) {
            let found = pairs(&with_altitudes(&a), &with_altitudes(&b));
            let of = |number: fn(&Pair) -> Option<usize>| found.iter().filter_map(number).collect::<Vec<_>>();
            prop_assert_eq!(of(|pair| pair.from), (0..a.len()).collect::<Vec<_>>());
            prop_assert_eq!(of(|pair| pair.to), (0..b.len()).collect::<Vec<_>>());
        }
    }

    #[test]
    fn each_field_that_differs_is_named_with_both_values() {
        let ours = plan(
            "waypoint insert 0 40.0 -79.0 5000 0 FLYOVER 0 NONE\n\
             waypoint insert 1 40.0 -79.0 5000 500 HOLD 300 ORBIT",
        );
        let theirs = plan("waypoint insert 0 40.0000001 -79.0 4999 250 FLYBY 0 NONE");
        assert_eq!(
            lines(&ours, &theirs),
            [
                "WP0 type: FLYOVER → FLYBY",
                "WP0 position: 40.0000000,-79.0000000 → 40.0000001,-79.0000000",
                "WP0 altitude: 50 m → 49.99 m",
                "WP0 speed: default → 2.5 m/s",
                "WP1 waypoint: HOLD → none",
            ]
        );
        assert_eq!(lines(&theirs, &ours).last().map(String::as_str), Some("WP1 waypoint: none → HOLD"));
        assert_eq!(lines(&ours, &ours), [""; 0]);
    }
}
