//! Missions that are engaged in a climb, as the public harness does.

use crate::kinematic_craft::plant::Kind;
use crate::kinematic_craft::rig::Rig;
use crate::kinematic_craft::{climbing_us, come_down, fault_of, kinds};

/// A leg to the north, then a LAND to the east of its end, which loiters for 5 s.
const LAND: &str = "\
waypoint update 0 -27.4996407 153.0000000 1000 500 FLYOVER 0 NONE
waypoint insert 1 -27.4996407 153.0002532 1000 500 LAND 50 NONE";

fn engaged(kind: Kind, lines: &str) -> Rig {
    let mut rig = Rig::new(kind, lines);
    rig.engaged(climbing_us(kind));
    rig
}

#[test]
fn a_craft_that_is_engaged_in_a_climb_holds_the_altitude_of_its_plan() {
    let mut faults = Vec::new();
    for kind in kinds() {
        let mut rig = engaged(kind, "waypoint update 0 -27.4982034 153.0000000 1000 500 HOLD 0 NONE");
        let engaged_m = rig.plant.height_m();
        rig.fly(100.0);
        let highest = rig.path.iter().map(|s| s.0).fold(0.0, f64::max);
        let last = rig.plant.height_m();
        println!("{kind:?}: engaged at {engaged_m:.1} m, highest {highest:.1} m, at last {last:.1} m");
        if highest > engaged_m.max(10.0) + if kind == Kind::HARNESS { 1.5 } else { 2.0 }
            || (last - 10.0).abs() > 0.5
        {
            faults.push(format!(
                "{kind:?}: engaged at {engaged_m:.1} m, highest {highest:.1} m, last {last:.1} m"
            ));
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn a_landing_whose_bump_may_stop_the_motors_does_not_stop_them_in_the_air() {
    let mut faults = Vec::new();
    for kind in kinds() {
        // The bump of this plant is meant for the bump detector. Without the detector it only disturbs the
        // altitude estimate.
        let thresholds: &[u8] = if kind.bumps { &[10] } else { &[10, 0] };
        for threshold in thresholds {
            let mut rig = engaged(kind, &format!("{LAND}\nset landing_disarm_threshold = {threshold}"));
            let stood_s = come_down(&mut rig);
            faults.extend(
                fault_of(&rig, 2.6, stood_s).map(|fault| format!("{kind:?}, threshold {threshold}: {fault}")),
            );
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn a_rescue_climbs_at_about_its_ascend_rate() {
    let mut rig = Rig::new(Kind::HARNESS, "");
    rig.parked(1600, 120.0).rescue();
    let begun = rig.path.len();
    rig.fly(40.0);
    let climb = rig.path[begun..].iter().map(|s| -s.1).fold(0.0, f64::max);
    println!("climb {climb:.2} m/s");
    assert!((0.6..2.0).contains(&climb), "{climb:.2} m/s where 1 m/s is set");
}
