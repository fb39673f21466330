//! A repeated flight is the same to the last bit.

use crate::scenarios::rig::{case_of, fly};
use betadeck_core::scenario::judge;

#[test]
fn the_same_flight_gives_the_same_record() {
    for (scenario, name) in [("guide-1", "noise real"), ("rough-air", ""), ("gps-outage", "")] {
        let case = case_of(scenario, name);
        let (first, second) = (fly(&case), fly(&case));
        assert_eq!(first.trace.hash(), second.trace.hash(), "{scenario}");
        let (judged, measures) = judge(&case, &first);
        let (judged_again, measures_again) = judge(&case, &second);
        assert_eq!(judged, judged_again);
        assert_eq!(measures, measures_again);
    }
}

#[test]
fn another_seed_gives_another_record() {
    let mut case = case_of("gps-outage", "");
    case.time_limit_s = 5.0;
    let first = fly(&case).trace.hash();
    case.airs[0].seed = 2;
    assert_ne!(first, fly(&case).trace.hash());
}
