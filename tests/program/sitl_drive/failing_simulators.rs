//! Simulators that hang, end, restart, send without a rhythm, lose packets that are waited for, or send nonsense.

use betadeck::link::conventions::Dialect;
use betadeck::link::proto::fdm::{GZ_PLUGIN_SIZE, SIZE};

use crate::sitl_drive::plant::Plant;
use crate::sitl_drive::rates::sitl;
use crate::sitl_drive::simulator::{Hand, Simulator};
use crate::sitl_drive::square::{Bounds, Flown};

/// The allowed errors of a flight that goes on after a failure.
pub(crate) const BOUNDS: Bounds =
    Bounds { flyover_m: 2.0, hold_m: 2.0, land_m: 1.0, height_m: 3.0, impact_mps: 1.5 };

/// The packets that the firmware sends without a state until a simulator counts as silent. The last one comes after a
/// second.
const SENT_IN_A_SECOND: u32 = 4;

/// Keeps the simulator silent for more than a second, while its world does not move.
pub(crate) fn hang(simulator: &mut Simulator) {
    for _ in 0..SENT_IN_A_SECOND {
        simulator.read_motors();
    }
}

#[test]
fn a_simulator_that_hangs_goes_on_with_the_flight() {
    let (_child, mut simulator) = sitl(Dialect::GzPlugin);
    simulator.fly_up_to(10, 12.0);
    hang(&mut simulator);
    simulator.fly(10);
    simulator.flown.is_the_square(&BOUNDS);
}

#[test]
fn a_simulator_that_dies_and_comes_back_begins_a_new_flight() {
    let (mut child, mut simulator) = sitl(Dialect::GzPlugin);
    simulator.fly_up_to(4, 12.0);
    assert!(simulator.motors().iter().all(|motor| *motor > 0.0));
    let ended = simulator.end();
    let mut simulator = ended.start(Dialect::GzPlugin);
    restarts(&mut simulator);
    child.line("the simulator was restarted: disarmed");
    simulator.fly(4);
    simulator.flown.is_the_square(&BOUNDS);
}

#[test]
fn a_world_that_is_reset_begins_a_new_flight() {
    let (mut child, mut simulator) = sitl(Dialect::SitlGz);
    simulator.fly_up_to(10, 12.0);
    // The same simulator: its time falls to zero and the craft is at home.
    simulator.plant = Plant::new(Dialect::SitlGz);
    simulator.flown = Flown::new(simulator.plant.world.local_frame());
    simulator.hand = Hand::Waits;
    simulator.restart_rc();
    restarts(&mut simulator);
    child.line("the simulator was restarted: disarmed");
    simulator.fly(10);
    simulator.flown.is_the_square(&BOUNDS);
}

/// Checks that the craft of a new world is disarmed and stays at home until it is armed again.
#[track_caller]
fn restarts(simulator: &mut Simulator) {
    while simulator.plant.time_ms() < 5000 {
        simulator.step(4);
    }
    assert_eq!((simulator.hand, simulator.motors()), (Hand::Waits, [0.0; 4]));
    assert!(simulator.flown.farthest_m < 0.5, "{:?}", simulator.flown);
}

#[test]
fn states_need_no_rhythm() {
    let (_child, mut simulator) = sitl(Dialect::GzPlugin);
    for ms in [1, 1, 20, 7, 2, 13, 1, 40, 5, 3, 21, 1, 30, 4].into_iter().cycle() {
        simulator.step(ms);
        if simulator.hand == Hand::Done {
            break;
        }
    }
    simulator.flown.impact_mps = simulator.plant.impact_mps();
    simulator.flown.is_the_square(&BOUNDS);
}

#[test]
fn an_answer_that_is_waited_for_in_vain_comes_again() {
    let (_child, mut simulator) = sitl(Dialect::GzPlugin);
    let mut next_ms = 10_000;
    while simulator.hand != Hand::Done {
        if simulator.plant.time_ms() >= next_ms {
            next_ms += 10_000;
            // The state never arrives, and the simulator waits for its motors. Only the firmware can end this silence.
            simulator.read_motors();
        }
        simulator.step(10);
    }
    simulator.flown.impact_mps = simulator.plant.impact_mps();
    simulator.flown.is_the_square(&BOUNDS);
}

#[test]
fn nonsense_between_the_states_changes_nothing() {
    let (mut child, mut simulator) = sitl(Dialect::GzPlugin);
    let mut turn = 0;
    while simulator.hand != Hand::Done {
        simulator.send(&nonsense(&simulator.plant.packet(), turn));
        turn += 1;
        simulator.step(10);
    }
    assert!(child.is_alive());
    simulator.flown.impact_mps = simulator.plant.impact_mps();
    simulator.flown.is_the_square(&BOUNDS);
}

/// Returns an invalid datagram, made from a valid one.
fn nonsense(good: &[u8], turn: usize) -> Vec<u8> {
    let with = |field: usize, value: f64| {
        let mut bytes = good.to_vec();
        bytes[field * 8..][..8].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    match turn % 9 {
        0 => Vec::new(),
        1 => good[..SIZE - 1 - turn % 100].to_vec(),
        2 => with(turn % 17, f64::NAN),
        3 => with(turn % 17, f64::INFINITY),
        4 => with(7 + turn % 4, 5.0),
        5 => with(1 + turn % 3, 1e9),
        6 => with(4 + turn % 3, -1e5),
        7 => vec![0; GZ_PLUGIN_SIZE],
        _ => vec![0xff; 1500],
    }
}
