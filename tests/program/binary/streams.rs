//! Output that nobody reads, terminals that are closed, and a program that another process stops.
#![allow(clippy::disallowed_methods, reason = "a state of another process is waited for")]

use std::io::Write as _;
use std::os::fd::OwnedFd;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use crate::binary::pty::Terminal;
use crate::binary::support::Sandbox;

/// The time after which an expected event counts as missing.
const NEVER: Duration = Duration::from_secs(600);

/// A process that is killed when its test ends.
struct Guard(Child);

impl Guard {
    fn signal(&self, name: &str) {
        let id = self.0.id().to_string();
        assert!(std::process::Command::new("kill").args(["-s", name, &id]).status().expect("kill").success());
    }

    /// Waits until the process handles SIGTERM itself.
    fn handles_signals(&mut self) {
        handles_signals(self.0.id());
    }

    /// Waits for the end of the process. Returns its exit code.
    fn end(&mut self) -> Option<i32> {
        end_of(&mut self.0)
    }
}

/// Waits until a process handles SIGINT, SIGTERM and SIGHUP itself.
pub(crate) fn handles_signals(id: u32) {
    const SIGNALS: [u32; 3] = [1, 2, 15];
    let path = format!("/proc/{id}/status");
    until("its signal handlers", || {
        let status = std::fs::read_to_string(&path).expect("a process");
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).expect("a mask");
        let caught = u64::from_str_radix(caught.trim(), 16).expect("a mask");
        SIGNALS.iter().all(|signal| caught & (1 << (signal - 1)) != 0)
    });
}

/// Waits for the end of a process. Returns its exit code.
pub(crate) fn end_of(child: &mut Child) -> Option<i32> {
    let mut code = None;
    until("the end of the program", || {
        let status = child.try_wait().expect("a child");
        code = status.and_then(|status| status.code());
        status.is_some()
    });
    code
}

impl Drop for Guard {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

#[track_caller]
pub(crate) fn until(wanted: &str, mut done: impl FnMut() -> bool) {
    let deadline = Instant::now() + NEVER;
    while !done() {
        assert!(Instant::now() < deadline, "never came: {wanted}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn start(sandbox: &Sandbox, arguments: &[&str], out: OwnedFd) -> Guard {
    let mut command = sandbox.command(arguments);
    Guard(command.stdin(Stdio::null()).stdout(out).stderr(Stdio::null()).spawn().expect("a process"))
}

#[test]
fn sitl_ends_quietly_when_its_reader_has_gone() {
    let sandbox = Sandbox::new();
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let doors = ["sitl", "--udp-ports", "0,0,0,0", "--tcp-port=0", "--ws-port=0"];
    assert_eq!(start(&sandbox, &doors, writer.into()).end(), Some(0));
}

#[test]
fn sitl_says_that_its_log_cannot_be_written() {
    let sandbox = Sandbox::new();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("a full device");
    let doors = ["sitl", "--udp-ports", "0,0,0,0", "--tcp-port=0", "--ws-port=0"];
    assert_eq!(start(&sandbox, &doors, full.into()).end(), Some(3));
}

#[test]
fn serve_ends_on_a_signal_while_nobody_reads_it() {
    for signal in ["INT", "TERM", "HUP"] {
        let sandbox = Sandbox::new();
        let (_reader, mut writer) = std::io::pipe().expect("a pipe");
        // The pipe is full, so the first line that the program writes blocks forever.
        rustix::io::ioctl_fionbio(&writer, true).expect("a pipe that does not wait");
        while writer.write(&[b' '; 512]).is_ok() {}
        while writer.write(b" ").is_ok() {}
        rustix::io::ioctl_fionbio(&writer, false).expect("a pipe that waits");
        let mut serve = start(&sandbox, &["serve", "--no-ports"], writer.into());
        serve.handles_signals();
        serve.signal(signal);
        assert_eq!(serve.end(), Some(130), "{signal}");
    }
}

#[test]
fn closing_the_terminal_ends_the_program() {
    assert_eq!(Terminal::closed_when_shown("DISARMED"), 130);
}

#[test]
fn a_signal_ends_the_program_while_its_terminal_takes_no_output() {
    let mut terminal = Terminal::betadeck(80, 24, &["--no-ports"]);
    terminal.until_shown("DISARMED");
    terminal.hold_output();
    terminal.signal("TERM");
    assert_eq!(terminal.end(), 130);
}

#[test]
fn a_program_that_is_stopped_by_a_signal_gives_the_terminal_back_and_takes_it_again() {
    let mut terminal = Terminal::betadeck(80, 24, &["--no-ports"]);
    terminal.until_shown("DISARMED");
    for _ in 0..2 {
        terminal.signal("TSTP");
        until("the program stands still", || terminal.is_stopped());
        terminal.until("the ordinary screen", |terminal| !terminal.is_alternate());
        terminal.assert_given_back();
        terminal.signal("CONT");
        terminal.until_shown("DISARMED");
        assert!(terminal.is_alternate());
    }
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn ctrl_z_without_a_shell_says_why_the_program_does_not_stop() {
    // The program leads its session, as under `xterm -e`. Then a shell without job control leads it, and
    // nobody continues that program either.
    let script = format!("{} --no-ports; exit 7", crate::binary::support::PROGRAM);
    let alone: (&str, &[&str]) = (crate::binary::support::PROGRAM, &["--no-ports"]);
    for (program, arguments) in [alone, ("/bin/sh", &["-c", script.as_str()])] {
        let mut terminal = Terminal::start(100, 30, program, arguments);
        terminal.until_shown("DISARMED");
        terminal.send("\x1a");
        terminal.until_shown("no shell that could continue");
        assert!(!terminal.is_stopped() && terminal.is_alternate());
        terminal.send("q");
        assert_eq!(terminal.end(), if program == "/bin/sh" { 7 } else { 0 });
        terminal.assert_given_back();
    }
}

#[test]
fn ctrl_z_under_a_shell_with_jobs_stops_the_program_until_it_is_continued() {
    // With `set -m` a script has jobs as an interactive shell has.
    let script = format!(
        "set -m; {} --no-ports; echo \"code $?\"; fg; echo \"end $?\"",
        crate::binary::support::PROGRAM
    );
    let mut terminal = Terminal::start(100, 30, "/bin/bash", &["-c", &script]);
    terminal.until_shown("DISARMED");
    terminal.send("\x1a");
    terminal.until("the job is stopped", |terminal| terminal.raw().contains("code 147"));
    terminal.until_shown("DISARMED");
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    assert!(terminal.raw().contains("end 0"), "{:?}", terminal.raw());
}
