//! Executables that do not keep to the messages, or end in an unusual way. None may hold this program.

use betadeck::link::ChildEnd;
use betadeck::link::lockstep::NoReport;

use super::child::Flight;
use super::stand_in::{ARGUMENT, CLOSES_FILE, PORTS_FILE};
use test_support::free_port;

/// Returns the reason why the stand-in reports no further steps after a line of a test.
fn after(line: &str) -> NoReport {
    let mut flight = Flight::start();
    assert!(flight.lockstep.connect().unwrap());
    flight.lockstep.send(format!("{line}\n").as_bytes());
    flight.run(2000).unwrap_err()
}

fn fault(reason: NoReport) -> &'static str {
    match reason {
        NoReport::Faulty(why) => why,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_report_of_more_bytes_than_a_step_can_carry_is_a_fault() {
    assert_eq!(fault(after("overstate")), "reports more bytes over its serial port than a step can carry");
}

#[test]
fn bytes_that_are_reported_but_never_come_are_a_fault() {
    assert_eq!(fault(after("promise")), "reports bytes over its serial port that it has not sent");
}

#[test]
fn an_executable_that_sleeps_and_does_not_answer_is_silent_rather_than_stopped() {
    assert_eq!(after("sleep"), NoReport::Silent);
}

#[test]
fn the_end_of_a_process_is_noticed_although_a_copy_of_it_holds_its_pipes() {
    assert_eq!(after("fork"), NoReport::Ended(ChildEnd::Code(7)));
}

#[test]
fn an_executable_that_closes_its_connection_is_connected_again() {
    let mut flight = Flight::start();
    assert!(flight.lockstep.connect().unwrap());
    flight.lockstep.send(b"close\n");
    flight.run(20).unwrap();
    assert!(flight.lockstep.received().is_some());
    flight.lockstep.send(b"lost\n");
    flight.run(1).unwrap();
    assert!(flight.lockstep.received().is_none());
    assert!(flight.lockstep.connect().unwrap());
    flight.lockstep.send(b"again\n");
    flight.take_text();
    flight.run(20).unwrap();
    let text = flight.take_text();
    assert!(text.contains("again at "), "{text:?}");
}

#[test]
fn a_flight_over_an_executable_that_closes_its_connection_and_sleeps_ends_with_the_reason() {
    let state = tempfile::tempdir().unwrap();
    let folder = state.path().join("firmware");
    std::fs::create_dir(&folder).unwrap();
    let [raw, motors, fdm, rc, tcp] = std::array::from_fn(|_| free_port());
    std::fs::write(folder.join(PORTS_FILE), format!("{fdm},{rc},{motors},{tcp}")).unwrap();
    std::fs::write(folder.join(CLOSES_FILE), "").unwrap();
    let flown = std::process::Command::new(env!("CARGO_BIN_EXE_betadeck"))
        .args(["fly", "square", "--timeout", "20", "--tcp-port", &tcp.to_string()])
        .args(["--udp-ports", &format!("{raw},{motors},{fdm},{rc}")])
        .args(["--firmware-arg", ARGUMENT, "--firmware"])
        .arg(std::env::current_exe().unwrap())
        .arg("--state-dir")
        .arg(state.path())
        .env_clear()
        .env("HOME", state.path())
        .output()
        .unwrap();
    let printed = String::from_utf8(flown.stderr).unwrap();
    assert_eq!(flown.status.code(), Some(3), "{printed}");
    assert!(printed.contains("has not ended its step for 10 s, although it is not stopped"), "{printed}");
}
