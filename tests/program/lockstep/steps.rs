//! Steps, serial bytes, restarts and the ends of a process.

use std::sync::atomic::{AtomicBool, Ordering};

use betadeck::link::ChildEnd;
use betadeck::link::lockstep::{NoReport, NotAgain};

use super::child::Flight;
use super::stand_in::DIFFERS_FILE;

/// Runs a part of a test while two threads take all processor time.
fn beside_busy_loops<T>(run: impl FnOnce() -> T) -> T {
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while !stop.load(Ordering::Relaxed) {
                    std::hint::spin_loop();
                }
            });
        }
        let result = run();
        stop.store(true, Ordering::Relaxed);
        result
    })
}

#[test]
fn each_step_gets_one_motor_packet() {
    let mut flight = Flight::start();
    flight.run(2000).unwrap();
    let steps: Vec<u64> = flight.log.iter().map(|(step, _)| *step).collect();
    assert!(steps == (1..=2000).collect::<Vec<u64>>(), "{} packets", steps.len());
}

#[test]
fn the_same_input_gives_the_same_motors_and_answers_however_busy_the_machine_is() {
    let first = Flight::start().with_lines();
    assert_eq!(first.iter().filter(|(_, bytes)| bytes.len() == 16).count(), 2000);
    assert_eq!(first.iter().filter(|(_, bytes)| bytes.starts_with(b"line ")).count(), 20);
    for run in 0..4 {
        let flight = || Flight::start().with_lines();
        let other = if run % 2 == 0 { flight() } else { beside_busy_loops(flight) };
        assert!(first == other, "run {run} differs");
    }
}

#[test]
fn threads_of_their_own_compute_what_the_main_thread_computes_for_them() {
    let (guests, own) = (Flight::start_with(false), Flight::start_with(true));
    assert!(guests.lockstep.has_guests());
    assert!(!own.lockstep.has_guests());
    assert!(guests.with_lines() == own.with_lines());
    assert_eq!(Flight::start_with(true).with_prints(), Flight::start_with(false).with_prints());
}

#[test]
fn another_process_computes_the_same_up_to_any_step_and_goes_on_like_the_first() {
    let mut flight = Flight::recorded(&[]);
    flight.run(3).unwrap();
    assert!(flight.lockstep.connect().unwrap());
    for line in 0..10 {
        flight.lockstep.send(format!("line {line}\n").as_bytes());
        flight.run(50).unwrap();
    }
    let past = flight.lockstep.past().unwrap();
    assert_eq!(past.steps, 503);
    for (steps, is_connected) in [(0, false), (3, false), (4, true), (357, true)] {
        let again = Flight::again(past.clone(), steps).unwrap();
        assert_eq!(again.lockstep.is_connected(), is_connected, "after {steps} steps");
    }
    let mut again = Flight::again(past.clone(), 503).unwrap();
    flight.log.clear();
    for flight in [&mut flight, &mut again] {
        flight.lockstep.send(b"together\n");
        flight.run(20).unwrap();
    }
    assert_eq!(flight.log.len(), 21, "20 packets and an answer");
    assert!(flight.log == again.log);
    // Its own run can be computed again, too.
    let past = again.lockstep.past().unwrap();
    assert_eq!(past.steps, 523);
    Flight::again(past, 523).unwrap();
}

#[test]
fn a_process_that_does_not_compute_the_same_is_noticed() {
    let mut flight = Flight::recorded(&[DIFFERS_FILE]);
    flight.run(20).unwrap();
    let past = flight.lockstep.past().unwrap();
    let differs = Flight::again(past.clone(), 20).err();
    assert!(matches!(differs, Some(NotAgain::Differs(1))), "{differs:?}");
}

#[test]
fn what_it_gets_is_kept_from_its_newest_boot_on() {
    let mut flight = Flight::recorded(&[]);
    flight.run(20).unwrap();
    assert!(flight.lockstep.connect().unwrap());
    flight.lockstep.send(b"exec\n");
    assert_eq!(flight.run(100), Err(NoReport::Replaced));
    flight.run(7).unwrap();
    let past = flight.lockstep.past().unwrap();
    assert_eq!(past.steps, 7);
    Flight::again(past, 7).unwrap();
}

#[test]
fn what_it_prints_comes_at_the_same_step_however_busy_the_machine_is() {
    let first = Flight::start().with_prints();
    assert!(first.iter().filter(|(_, line)| line.starts_with("printed at ")).count() >= 7, "{first:?}");
    assert_eq!(first.iter().filter(|(_, line)| line == "the state thread ends").count(), 2, "{first:?}");
    for _ in 0..5 {
        assert_eq!(beside_busy_loops(|| Flight::start().with_prints()), first);
    }
}

#[test]
fn another_input_gives_other_motors() {
    let mut one = Flight::start();
    let mut other = Flight::start();
    one.run(10).unwrap();
    other.grant();
    other.wait().unwrap();
    other.lockstep.step(betadeck::link::lockstep::StepInput { fdm: [1; 144], rc: None });
    other.wait().unwrap();
    assert_eq!(one.log[0], other.log[0]);
    assert_ne!(one.log[1].1, other.log[1].1);
}

#[test]
fn several_executables_that_ask_for_the_same_ports_fly_at_once() {
    let alone = Flight::start().with_lines();
    let together: Vec<_> = std::thread::scope(|scope| {
        let flights: Vec<_> = (0..4).map(|_| scope.spawn(|| Flight::start().with_lines())).collect();
        flights.into_iter().map(|flight| flight.join().unwrap()).collect()
    });
    assert!(together.iter().all(|log| *log == alone));
}

#[test]
fn an_executable_that_restarts_gets_the_same_clock_again() {
    let mut flight = Flight::start();
    flight.run(20).unwrap();
    let first = flight.log.clone();
    assert!(flight.lockstep.connect().unwrap());
    flight.lockstep.send(b"save\n");
    assert_eq!(flight.run(100), Err(NoReport::Ended(ChildEnd::Code(0))));
    flight.begin_again();
    flight.lockstep.restart().unwrap();
    flight.wait().unwrap();
    flight.run(20).unwrap();
    assert!(flight.log == first);
    assert!(flight.lockstep.connect().unwrap());
    flight.lockstep.send(b"again\n");
    flight.run(20).unwrap();
    assert!(flight.take_text().starts_with("again at 30"), "it answers after its restart");
}

#[test]
fn a_client_may_disconnect_and_connect_again() {
    let mut flight = Flight::start();
    for client in ["one", "two", "three"] {
        assert!(flight.lockstep.connect().unwrap());
        flight.lockstep.send(format!("{client}\n").as_bytes());
        flight.run(20).unwrap();
        assert!(flight.take_text().starts_with(client));
        flight.lockstep.disconnect();
        flight.run(20).unwrap();
    }
}

#[test]
fn much_data_at_once_arrives_whole() {
    let mut flight = Flight::start();
    assert!(flight.lockstep.connect().unwrap());
    let lines: String = (0..3000).map(|line| format!("line number {line}\n")).collect();
    flight.lockstep.send(lines.as_bytes());
    flight.run(3000).unwrap();
    let text = flight.take_text();
    assert_eq!(text.lines().count(), 3000);
    assert!(
        text.lines().enumerate().all(|(line, text)| text.starts_with(&format!("line number {line} at ")))
    );
}

#[test]
fn a_crash_is_reported_with_its_signal() {
    let mut flight = Flight::start();
    assert!(flight.lockstep.connect().unwrap());
    flight.lockstep.send(b"crash\n");
    assert_eq!(flight.run(100), Err(NoReport::Ended(ChildEnd::Signal(6))));
}

#[test]
fn an_executable_that_computes_without_an_end_is_reported_as_hung() {
    let mut flight = Flight::start();
    assert!(flight.lockstep.connect().unwrap());
    flight.lockstep.send(b"hang\n");
    assert_eq!(flight.run(100), Err(NoReport::Hung));
}

#[test]
fn an_executable_that_the_host_stops_is_waited_for_and_computes_the_same() {
    use rustix::process::{Pid, Signal, kill_process};
    let undisturbed = Flight::start().with_lines();
    let mut flight = Flight::start();
    let pid = Pid::from_raw(flight.lockstep.id() as i32).unwrap();
    flight.lockstep.connect().unwrap();
    for line in 0..20 {
        flight.lockstep.send(format!("line {line}\n").as_bytes());
        if line == 7 {
            kill_process(pid, Signal::STOP).unwrap();
            flight.grant();
            assert_eq!(flight.lockstep.wait(), Err(NoReport::Stopped));
            kill_process(pid, Signal::CONT).unwrap();
            flight.wait().unwrap();
            flight.run(99).unwrap();
        } else {
            flight.run(100).unwrap();
        }
    }
    assert!(flight.log == undisturbed);
}

#[test]
fn programs_that_it_starts_inherit_nothing() {
    let mut flight = Flight::start();
    assert!(flight.lockstep.connect().unwrap());
    flight.lockstep.send(b"start\n");
    flight.run(100).unwrap();
    let line = flight.wait_for_line("a program inherits lockstep");
    assert!(line.ends_with("false"), "{line}");
}

#[test]
fn an_executable_that_replaces_itself_stays_in_lockstep() {
    let mut flight = Flight::start();
    flight.run(20).unwrap();
    let first = flight.log.clone();
    for (run, line) in ["exec\n", "join\n", "join\n", "exec\n"].iter().enumerate() {
        assert!(flight.lockstep.connect().unwrap());
        flight.lockstep.send(line.as_bytes());
        assert_eq!(flight.run(100), Err(NoReport::Replaced), "run {run}");
        flight.begin_again();
        flight.run(20).unwrap();
        assert!(flight.log == first, "run {run}");
    }
}

#[test]
fn it_ends_with_its_owner() {
    let flight = Flight::start();
    let id = flight.lockstep.id();
    drop(flight);
    assert!(!std::path::Path::new(&format!("/proc/{id}")).exists());
}
