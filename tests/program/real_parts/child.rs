//! The stand-in as a child process, which the program starts and ends like the public executable.

use std::time::Duration;

use betadeck::link::{ChildConfig, ChildEnd, ChildEvent, SitlChild};
use tempfile::TempDir;

use super::stand_in::free_ports;
use super::stand_in::process::{self, Trouble, VARIABLE};
use super::stand_in::program::Ports;

/// Starts the stand-in through `env`, because this test cannot set the environment of the child itself.
fn start(ports: Ports, trouble: Trouble) -> (SitlChild, TempDir) {
    let directory = tempfile::tempdir().unwrap();
    let (program, arguments) = process::command();
    let variable = format!("{VARIABLE}={}", process::variable(ports, trouble));
    let arguments =
        [variable, program.display().to_string()].into_iter().chain(arguments.map(str::to_owned)).collect();
    let config = ChildConfig {
        program: "/usr/bin/env".into(),
        arguments,
        directory: directory.path().join("firmware"),
        launcher: env!("CARGO_BIN_EXE_betadeck").into(),
    };
    (SitlChild::start(config).unwrap(), directory)
}

/// Waits until the child ends and returns the first end. Output lines are ignored.
fn end(child: &mut SitlChild) -> ChildEnd {
    loop {
        match child.take_event() {
            Some(ChildEvent::Ended(end)) => return end,
            Some(ChildEvent::Failed(why)) => panic!("{why}"),
            Some(_) => {}
            None => std::thread::sleep(Duration::from_millis(5)),
        }
    }
}

#[test]
fn a_state_before_the_boot_is_its_end_as_it_is_the_public_ones() {
    let ports = free_ports();
    let (mut child, _directory) = start(ports, Trouble::None);
    let socket = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_nonblocking(true).unwrap();
    let ended = loop {
        drop(socket.send_to(&[0; 144], ("127.0.0.1", ports.fdm)));
        match child.take_event() {
            Some(ChildEvent::Ended(end)) => break end,
            _ => std::thread::sleep(Duration::from_millis(2)),
        }
    };
    assert_eq!(ended, ChildEnd::Signal(6));
}

#[test]
fn a_crash_is_reported_with_its_signal() {
    let (mut child, _directory) = start(free_ports(), Trouble::Crashes);
    assert_eq!(end(&mut child), ChildEnd::Signal(6));
}

#[test]
fn a_port_in_use_ends_it() {
    let ports = free_ports();
    let _taken = std::net::UdpSocket::bind(("127.0.0.1", ports.fdm)).unwrap();
    let (mut child, _directory) = start(ports, Trouble::None);
    assert_eq!(end(&mut child), ChildEnd::Code(1));
}
