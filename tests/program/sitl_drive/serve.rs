//! `betadeck serve --physics external`: the embedded firmware with all its doors, moved by the same simulator.

use betadeck::link::conventions::Dialect;

use crate::sitl_drive::child::Child;
use crate::sitl_drive::failing_simulators::{BOUNDS, hang};
use crate::sitl_drive::simulator::{Hand, Simulator};

fn serve(dialect: Dialect, more: &[&str]) -> (Child, Simulator) {
    let mut simulator = Simulator::new(dialect);
    let (motors, raw) = simulator.ports();
    let mut child = Child::serve(motors, raw, more);
    simulator.connect(child.serve_ports());
    (child, simulator)
}

#[test]
fn a_mission_flies_in_an_external_simulator() {
    let (mut child, mut simulator) = serve(Dialect::GzPlugin, &[]);
    child.line("A simulator moves the craft: it sends states to UDP 127.0.0.1:");
    simulator.fly(4);
    simulator.flown.is_the_square(&BOUNDS);
    let said = |child: &mut Child, words: &str| {
        let line = child.line(words);
        child.lines().iter().position(|said| *said == line)
    };
    let story = [
        "The simulator sends",
        "Armed.",
        "IDLE → APPROACHING",
        "ARRIVED → LANDING",
        "LANDING → COMPLETE",
        "Disarmed: landed.",
    ];
    let places = story.map(|words| said(&mut child, words));
    assert!(places.is_sorted(), "{places:?}");
}

#[test]
fn silence_return_and_restart_are_reported_and_survived() {
    let (mut child, mut simulator) = serve(Dialect::GzPlugin, &[]);
    simulator.fly_up_to(10, 12.0);
    hang(&mut simulator);
    child.line("The simulator is silent: time is stopped until it sends again.");
    while simulator.flown.order.is_empty() {
        simulator.step(10);
    }
    child.line("The simulator sends again after ");

    let mut simulator = simulator.end().start(Dialect::GzPlugin);
    while simulator.plant.time_ms() < 5000 {
        simulator.step(10);
    }
    assert_eq!((simulator.hand, simulator.motors()), (Hand::Waits, [0.0; 4]));
    child.line("The simulator was restarted: disarmed.");
    simulator.fly(10);
    simulator.flown.is_the_square(&BOUNDS);
}

#[test]
fn trouble_on_the_link_is_flown_through() {
    let faults = [
        ("fdm-loss", "boot+9,3,0.1"),
        ("fdm-late", "boot+15,1,20"),
        ("fdm-jitter", "boot+20,1,5"),
        ("stall", "boot+25,0.3"),
        ("fdm-loss", "boot+30,0.5,1"),
    ];
    let asked = faults.map(|(name, when)| format!("{name}@{when}"));
    let options: Vec<&str> = asked.iter().flat_map(|fault| ["--fault", fault]).collect();
    let (mut child, mut simulator) = serve(Dialect::GzPlugin, &options);
    simulator.fly(10);
    simulator.flown.is_the_square(&BOUNDS);
    child.line("Disarmed: landed.");
    for fault in ["fdm-loss 0.1", "fdm-late 20", "fdm-jitter 5", "stall", "fdm-loss 1"] {
        child.line(&format!("Fault {fault} begins."));
        child.line(&format!("Fault {fault} ends."));
    }
}

#[test]
fn packets_that_are_refused_are_reported_once() {
    let (mut child, mut simulator) = serve(Dialect::SitlGz, &[]);
    let mut senseless = simulator.plant.packet();
    senseless[8..16].copy_from_slice(&f64::NAN.to_le_bytes());
    for _ in 0..50 {
        simulator.send(&senseless);
        simulator.step(10);
    }
    child.line("Packets of the simulator are refused: a value is not a number.");
    simulator.fly(10);
    simulator.flown.is_the_square(&BOUNDS);
    child.line("Disarmed: landed.");
    let reported = child.lines().iter().filter(|line| line.contains("are refused")).count();
    assert_eq!(reported, 1);
}

#[test]
fn other_rates_of_control_and_the_estimator_fly_it_too() {
    for more in [["--rate", "400"], ["--rate", "4000"], ["--attitude", "estimated"]] {
        let (_child, mut simulator) = serve(Dialect::GzPlugin, &more);
        simulator.fly(5);
        simulator.flown.is_the_square(&BOUNDS);
    }
}

#[test]
fn faults_of_the_craft_are_refused_with_the_way_out() {
    let mut child = Child::serve(0, 0, &["--fault", "motor@10,,2:0.8"]);
    child.line(
        "fault motor is up to the simulator that moves the craft: make it there; here there are rx-loss,",
    );
}

#[test]
fn options_of_the_world_inside_have_no_effect_and_say_so() {
    let (mut child, _simulator) = serve(Dialect::GzPlugin, &["--wind", "30@270", "--speed", "4"]);
    child.line("--wind, --speed have no effect: the external simulator decides that.");
}
