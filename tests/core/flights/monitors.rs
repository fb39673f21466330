//! The progress monitors on the complete craft. They must not end these missions.

use betadeck_core::telemetry::NavState;

use crate::flights::rig::{Rig, world};

/// A flight 60 m north and back home.
const OUT_AND_BACK: &str = "
waypoint insert 0 40.4640390 -79.5182000 2000 0 FLYOVER 0 NONE
waypoint insert 1 40.4635000 -79.5182000 2000 0 FLYOVER 0 NONE";
/// A square of 60 m.
const SQUARE: &str = "
waypoint insert 0 40.4640390 -79.5182000 2000 0 FLYOVER 0 NONE
waypoint insert 1 40.4640390 -79.5174917 2000 0 FLYOVER 0 NONE
waypoint insert 2 40.4635000 -79.5174917 2000 0 FLYOVER 0 NONE
waypoint insert 3 40.4635000 -79.5182000 2000 0 FLYOVER 0 NONE";

#[track_caller]
fn completes(lines: &str) {
    for seed in [0, 1] {
        let mut rig = Rig::new(world(seed).0, &format!("{lines}\nset ap_max_distance_from_home = 0"), 10.0);
        rig.engaged().until(600.0, "the end", |rig| {
            rig.transitions()
                .last()
                .is_some_and(|last| matches!(last.to, NavState::Complete | NavState::Idle))
        });
        assert!(rig.path().contains("COMPLETE"), "seed {seed}: {}", rig.story());
    }
}

#[test]
fn a_fast_turn_back_is_not_a_flyaway() {
    completes(&format!("{OUT_AND_BACK}\nset ap_max_velocity = 1200\nset ap_max_angle = 25"));
}

#[test]
fn a_wide_corner_arc_is_not_a_flyaway() {
    completes(&format!("{SQUARE}\nset ap_l1_turn_rate = 8"));
    completes(&format!("{SQUARE}\nset ap_l1_turn_rate = 8\nset ap_max_angle = 50"));
}
