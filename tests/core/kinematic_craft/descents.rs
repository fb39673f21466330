//! Descents without a fix, of a rescue and of the failsafe.

use betadeck_core::telemetry::{DisarmReason, Mode};

use crate::kinematic_craft::plant::Kind;
use crate::kinematic_craft::rig::Rig;
use crate::kinematic_craft::{climbing_us, come_down, fault_of, kinds};

#[test]
fn a_rescue_by_switch_that_loses_its_gps_descends_to_the_ground_at_its_own_rate() {
    for threshold in [10, 0] {
        let mut rig = Rig::new(Kind::HARNESS, &format!("set landing_disarm_threshold = {threshold}"));
        rig.parked(1600, 120.0).rescue();
        let begun = rig.path.len();
        let parked_m = rig.plant.distance_m();
        rig.until(90.0, "30 m closer", |rig| rig.plant.distance_m() < parked_m - 30.0);
        println!("lost at {:.1} m, climbing at {:.2} m/s", rig.plant.height_m(), rig.plant.climb_mps());
        let lost = rig.path.len();
        let climb = rig.path[begun..].iter().map(|s| -s.1).fold(0.0, f64::max);
        rig.lose_gps();
        let stood_s = come_down(&mut rig);
        assert!(!rig.has(Mode::Failsafe));
        assert_eq!(fault_of(&rig, 1.1, stood_s), None, "threshold {threshold}");
        let sink = rig.sink_mps(lost, 2.0..7.0);
        println!("threshold {threshold}: climb {climb:.2} m/s, sink {sink:.2} m/s, stood {stood_s:.1} s");
        assert!((0.7..0.9).contains(&sink), "{sink}");
    }
}

part_and_search!(rescues, every 3, motors_stop_on_the_ground_wherever_a_rescue_loses_its_gps, motors_stop_on_the_ground_wherever_a_rescue_loses_its_gps_in_every_case);

fn rescues(n: usize) {
    let mut faults = Vec::new();
    for kind in kinds() {
        for (landing_rate, detection) in [(50, 10), (200, 5)] {
            let lines = format!(
                "set landing_disarm_threshold = 0\n\
                 set ap_landing_descent_rate = {landing_rate}\n\
                 set ap_landing_detection_time = {detection}"
            );
            let mut rig = Rig::new(kind, &lines);
            rig.parked(climbing_us(kind), 60.0).rescue();
            // In the climb at the start, on the way, over home, and in the landing.
            for after_s in [0.5, 2.0, 5.0, 9.0, 14.0, 22.0, 30.0, 40.0].into_iter().step_by(n) {
                let mut rig = rig.clone();
                rig.fly(after_s);
                if rig.disarmed.is_some() || rig.plant.height_m() < 1.0 {
                    continue;
                }
                rig.lose_gps();
                let stood_s = come_down(&mut rig);
                faults.extend(
                    fault_of(&rig, 1.3, stood_s)
                        .map(|fault| format!("{kind:?}, {landing_rate} cm/s, {after_s} s: {fault}")),
                );
            }
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

part_and_search!(failsafe_descents, every 7, motors_stop_on_the_ground_whatever_the_craft_does_when_the_failsafe_descent_begins, motors_stop_on_the_ground_whatever_the_craft_does_when_the_failsafe_descent_begins_in_every_case);

fn failsafe_descents(n: usize) {
    let mut faults = Vec::new();
    let mut number = 0;
    for kind in kinds() {
        for (has_gps, landing_rate, impact_mps) in
            [(true, 50, 2.2), (false, 50, 2.2), (true, 200, 2.6), (false, 200, 2.6)]
        {
            let lines = format!(
                "set landing_disarm_threshold = 0\n\
                 set ap_landing_descent_rate = {landing_rate}\n\
                 set failsafe_procedure = AUTO-LAND\n\
                 set failsafe_landing_time = 200"
            );
            let mut rig = Rig::new(kind, &lines);
            rig.take_off(climbing_us(kind), 4.0).hold().throttle(1500);
            rig.fly(6.0).by_hand();
            // Hover, slow climb, fast climb, slow and fast sinking, and a fall from 60 m.
            for (height_m, climb_mps) in
                [(20.0, 0.0), (20.0, 0.7), (20.0, 4.0), (20.0, -0.5), (30.0, -3.0), (60.0, -10.0)]
            {
                for throttle in [1000, 1300, 1800] {
                    number += 1;
                    if number % n != 0 {
                        continue;
                    }
                    let mut rig = rig.clone();
                    rig.throttle(throttle);
                    rig.plant.place(height_m, climb_mps);
                    rig.plant.has_gps = has_gps;
                    rig.fly(0.2).lose_link();
                    let stood_s = come_down(&mut rig);
                    faults.extend(fault_of(&rig, impact_mps, stood_s).map(|fault| {
                        format!(
                            "{kind:?}, GPS {has_gps}, {landing_rate} cm/s, {climb_mps} m/s at {throttle}: {fault}"
                        )
                    }));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn a_failsafe_that_begins_on_the_ground_stops_the_motors_there() {
    for has_gps in [true, false] {
        let lines = "set landing_disarm_threshold = 0\nset failsafe_procedure = AUTO-LAND";
        let mut rig = Rig::new(Kind::HARNESS, lines);
        rig.take_off(1600, 3.0).throttle(1100);
        rig.until(20.0, "ground", |rig| rig.plant.height_m() <= 0.0).fly(2.0);
        rig.plant.has_gps = has_gps;
        rig.fly(3.0).lose_link();
        let stood_s = come_down(&mut rig);
        assert_eq!(rig.disarmed, Some((DisarmReason::Landing, 0.0)), "GPS {has_gps}");
        assert!(stood_s < 15.0, "{stood_s}");
    }
}
