//! Rescues by switch, with and without GPS, on the simulator's airframes and on some with other drag, thrust
//! and lag.

use crate::flights::checks::{Checks, assert_met};
use crate::flights::rig::{Rig, world};
use betadeck_core::sim::{Airframe, Fault, WorldCommand};
use betadeck_core::telemetry::{DisarmReason, EventKind, Mode};
use betadeck_core::vehicle::VehicleCommand;

/// A plan with one FLYOVER 333 m north at 40 m, and the rescue of the public harness.
const PLAN: &str = "\
waypoint insert 0 40.4665000 -79.5182000 4000 500 FLYOVER 0 NONE
aux 5 46 4 1700 2100 0 0
set gps_rescue_alt_mode = FIXED_ALT
set gps_rescue_return_alt = 30
set gps_rescue_ascend_rate = 100
set gps_rescue_descend_rate = 80";

fn airframes() -> Vec<(&'static str, Airframe)> {
    let iris = Airframe::iris();
    let plate = nalgebra::Vector3::new(1.0, 1.0, 20.0);
    vec![
        ("iris", iris.clone()),
        ("five-inch", Airframe::five_inch()),
        (
            "iris with inflow loss and plate drag",
            Airframe {
                inflow_coeff: 3.0 * iris.inflow_coeff,
                body_drag: iris.body_drag.component_mul(&plate),
                ..iris.clone()
            },
        ),
        ("iris with slow motors", Airframe { motor_tau_up_s: 0.06, motor_tau_down_s: 0.06, ..iris.clone() }),
        ("strong iris", Airframe { thrust_coeff: 1.6 * iris.thrust_coeff, ..iris.clone() }),
        ("heavy iris", Airframe { mass_kg: 1.3 * iris.mass_kg, ..iris }),
    ]
}

#[test]
fn a_rescue_that_loses_its_gps_sinks_at_its_own_rate_to_the_ground_on_every_airframe() {
    assert_met(airframes().into_iter().flat_map(|(name, airframe)| {
        [(50, 1.2), (200, 1.4)].map(|(landing_rate, impact_limit)| {
            let mut world = world(1).0;
            world.airframe = airframe.clone();
            let lines = format!("{PLAN}\nset ap_landing_descent_rate = {landing_rate}");
            let mut rig = Rig::new(world, &lines, 10.0);
            rig.engaged();
            rig.vehicle.apply(&VehicleCommand::HoldChannel("aux5=2000@20".parse().unwrap()));
            rig.until(40.0, "30 s of flight", |rig| rig.t() >= 30.0);
            rig.vehicle
                .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsLoss, None)))
                .accepted()
                .unwrap();
            let lost = rig.t();
            rig.until(200.0, "disarm", |rig| rig.disarmed().is_some());
            rig.fly(2.0);
            let mut checks = Checks::default();
            let (disarm, reason) = rig.disarmed().unwrap();
            checks.same("reason", reason, DisarmReason::Landing);
            checks.at_most("height at the disarm", rig.at(disarm).alt, 0.05);
            checks.holds("no failsafe", !rig.at(disarm - 0.1).modes.has(Mode::Failsafe));
            let mut sink: Vec<f64> =
                rig.span(lost, disarm).filter(|s| (5.0..15.0).contains(&s.alt)).map(|s| -s.vu).collect();
            sink.sort_by(f64::total_cmp);
            let median = sink[sink.len() / 2];
            checks.at_most("error of the sink rate", (median - 0.8).abs(), 0.12);
            let impact = rig.events.iter().find_map(|event| match event.kind {
                EventKind::Touchdown { impact_mps, .. } => Some(impact_mps),
                _ => None,
            });
            checks.at_most("touchdown", impact.unwrap_or(f64::INFINITY), impact_limit);
            println!("{name}, {landing_rate} cm/s: sinks at {median:.2} m/s, touches at {impact:?}");
            checks.verdict(&format!("{name}, {landing_rate} cm/s"), &rig.story())
        })
    }));
}

#[test]
fn a_rescue_that_keeps_its_gps_sinks_at_its_own_rate_too() {
    assert_met([50, 200].map(|landing_rate| {
        let lines = format!("{PLAN}\nset ap_landing_descent_rate = {landing_rate}");
        let mut rig = Rig::new(world(1).0, &lines, 10.0);
        rig.engaged();
        rig.vehicle.apply(&VehicleCommand::HoldChannel("aux5=2000@20".parse().unwrap()));
        rig.until(250.0, "disarm", |rig| rig.disarmed().is_some());
        let mut checks = Checks::default();
        let (disarm, reason) = rig.disarmed().unwrap();
        checks.same("reason", reason, DisarmReason::Landing);
        let mut sink: Vec<f64> =
            rig.span(disarm - 40.0, disarm).filter(|s| (6.0..15.0).contains(&s.alt)).map(|s| -s.vu).collect();
        sink.sort_by(f64::total_cmp);
        checks.at_most("error of the sink rate", (sink[sink.len() / 2] - 0.8).abs(), 0.1);
        checks.verdict(&format!("{landing_rate} cm/s"), &rig.story())
    }));
}
