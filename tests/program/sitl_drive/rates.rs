//! States at 50, 100, 250 and 1000 Hz: on a good link, on one that loses packets, and with pauses.

use std::time::Duration;

use betadeck::link::conventions::Dialect;

use crate::sitl_drive::child::Child;
use crate::sitl_drive::simulator::{Hand, Simulator};
use crate::sitl_drive::square::Bounds;

/// A pause of the simulator or of the link, ms.
const PAUSE_MS: u64 = 300;
/// The flight time from one pause to the next, ms.
const BETWEEN_MS: u64 = 8000;

/// Starts the drop-in and a simulator that is connected to it.
pub(crate) fn sitl(dialect: Dialect) -> (Child, Simulator) {
    let mut simulator = Simulator::new(dialect);
    let (motors, raw) = simulator.ports();
    let reported = format!("--fdm-dialect={dialect}");
    // The legacy dialect has the size of another one, so it must be named.
    let more: &[&str] = if dialect == Dialect::Legacy { &[&reported] } else { &[] };
    let mut child = Child::sitl(motors, raw, more);
    simulator.connect(child.sitl_ports());
    (child, simulator)
}

#[track_caller]
fn flies_the_square(dialect: Dialect, every_ms: u64) {
    let good = Bounds { flyover_m: 1.0, hold_m: 2.0, land_m: 0.5, height_m: 2.5, impact_mps: 1.2 };
    let rough = Bounds { flyover_m: 2.0, hold_m: 2.0, land_m: 1.0, height_m: 3.0, impact_mps: 1.5 };

    let (_child, mut simulator) = sitl(dialect);
    simulator.fly(every_ms);
    simulator.flown.is_the_square(&good);

    let (_child, mut simulator) = sitl(dialect);
    simulator.loss = 0.05;
    simulator.fly(every_ms);
    simulator.flown.is_the_square(&rough);

    let (_child, mut simulator) = sitl(dialect);
    fly_with_pauses(&mut simulator, every_ms);
    simulator.flown.is_the_square(&rough);
}

/// Flies with two kinds of pause in turn: the world stops, which takes wall time only, or it goes on without any
/// packets.
fn fly_with_pauses(simulator: &mut Simulator, every_ms: u64) {
    let mut next_ms = BETWEEN_MS;
    let mut world_stands = true;
    while simulator.hand != Hand::Done {
        if simulator.plant.time_ms() >= next_ms {
            next_ms += BETWEEN_MS;
            if world_stands {
                pause();
            } else {
                simulator.advance(PAUSE_MS);
            }
            world_stands = !world_stands;
        }
        simulator.step(every_ms);
    }
}

#[expect(clippy::disallowed_methods, reason = "a pause on the wall is what is tested; nothing waits for it")]
fn pause() {
    std::thread::sleep(Duration::from_millis(PAUSE_MS));
}

#[test]
fn at_50_hz() {
    flies_the_square(Dialect::GzPlugin, 20);
}

#[test]
fn at_100_hz() {
    flies_the_square(Dialect::SitlGz, 10);
}

#[test]
#[ignore = "search: three flights at the clock of the wall"]
fn at_250_hz() {
    flies_the_square(Dialect::Legacy, 4);
}

#[test]
#[ignore = "search: three flights at the clock of the wall"]
fn at_1000_hz() {
    flies_the_square(Dialect::GzPlugin, 1);
}
