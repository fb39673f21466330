//! The executable as a child: its output lines, and its end together with the test.

use std::io::{BufRead as _, BufReader, Read};
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use tempfile::TempDir;

use crate::sitl_drive::square;

/// The time after which something that is waited for counts as missing.
pub(crate) const NEVER: Duration = Duration::from_secs(600);

/// A running executable in a directory of its own; killed when dropped.
pub(crate) struct Child {
    process: std::process::Child,
    lines: Receiver<String>,
    seen: Vec<String>,
    _directory: TempDir,
}

/// Returns a command of the executable that sees nothing of the real environment.
fn command(directory: &TempDir, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_betadeck"));
    command.env_clear().env("HOME", directory.path()).current_dir(directory.path()).args(arguments);
    command
}

impl Child {
    /// Starts the drop-in with the square in its memory. It sends its motors to this port.
    pub(crate) fn sitl(motors: u16, raw: u16, more: &[&str]) -> Self {
        let directory = tempfile::tempdir().expect("a directory");
        std::fs::write(directory.path().join("square.txt"), square::lines()).expect("a file");
        let configured = command(&directory, &["sitl", "--strict", "--config", "square.txt"])
            .args(["--udp-ports", "0,0,0,0", "--tcp-port=0", "--ws-port=0"])
            .output()
            .expect("it runs");
        assert!(configured.status.success(), "{configured:?}");
        let ports = format!("{raw},{motors},0,0");
        let arguments = [&["sitl", "--udp-ports", &ports, "--tcp-port=0", "--ws-port=0"], more].concat();
        Self::start(directory, &arguments)
    }

    /// Starts `serve`, which is everything but the screen, with the square in its memory. It sends its motors to this
    /// port.
    pub(crate) fn serve(motors: u16, raw: u16, more: &[&str]) -> Self {
        let directory = tempfile::tempdir().expect("a directory");
        std::fs::write(directory.path().join("square.txt"), square::lines()).expect("a file");
        let ports = format!("{raw},{motors},0,0");
        let arguments = ["serve", "--physics", "external", "--fresh", "--settings", "square.txt"];
        let doors = ["--udp-ports", &ports, "--tcp-port=0", "--ws-port=0"];
        Self::start(directory, &[&arguments[..], &doors, more].concat())
    }

    fn start(directory: TempDir, arguments: &[&str]) -> Self {
        let mut process = command(&directory, arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it runs");
        let (says, lines) = channel();
        listen(process.stdout.take().expect("standard output"), says.clone());
        listen(process.stderr.take().expect("standard error"), says);
        Self { process, lines, seen: Vec::new(), _directory: directory }
    }

    /// Returns the first line with these words, from the lines so far or from those to come.
    #[track_caller]
    pub(crate) fn line(&mut self, words: &str) -> String {
        let mut looked_at = 0;
        loop {
            if let Some(line) = self.seen[looked_at..].iter().find(|line| line.contains(words)) {
                return line.clone();
            }
            looked_at = self.seen.len();
            let Ok(line) = self.lines.recv_timeout(NEVER) else {
                panic!("it never said {words:?} but {:#?}", self.seen)
            };
            self.seen.push(line);
        }
    }

    /// Returns all lines so far.
    pub(crate) fn lines(&mut self) -> &[String] {
        self.seen.extend(self.lines.try_iter());
        &self.seen
    }

    /// Returns `true` while the child runs.
    pub(crate) fn is_alive(&mut self) -> bool {
        self.process.try_wait().expect("its state").is_none()
    }

    /// Returns the ports of states and RC, which the lines about the links report in this order.
    #[track_caller]
    pub(crate) fn sitl_ports(&mut self) -> (u16, u16) {
        const SERVER: &str = "[SITL] start UDP server @";
        loop {
            let servers = self.seen.iter().filter_map(|line| line.strip_prefix(SERVER)?.strip_suffix("...0"));
            let ports: Vec<u16> = servers.map(|port| port.parse().expect("a port")).collect();
            if let [states, rc] = ports[..] {
                return (states, rc);
            }
            self.seen.push(self.lines.recv_timeout(NEVER).expect("lines about the links"));
        }
    }

    /// Returns the ports of states and RC from the line about the open doors.
    #[track_caller]
    pub(crate) fn serve_ports(&mut self) -> (u16, u16) {
        let line = self.line("Doors open: ");
        let port = |door: &str| {
            let (_, rest) = line.split_once(door).unwrap_or_else(|| panic!("no {door} in {line}"));
            let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
            digits.parse().expect("a port")
        };
        (port("udp fdm 127.0.0.1:"), port("udp rc 127.0.0.1:"))
    }
}

impl Drop for Child {
    #[expect(clippy::print_stderr, reason = "what it said explains why a test failed")]
    fn drop(&mut self) {
        drop(self.process.kill());
        drop(self.process.wait());
        if std::thread::panicking() {
            self.seen.extend(self.lines.try_iter());
            let from = self.seen.len().saturating_sub(40);
            eprintln!("it said:\n{}", self.seen[from..].join("\n"));
        }
    }
}

fn listen(stream: impl Read + Send + 'static, says: Sender<String>) {
    std::thread::spawn(move || {
        // The loop ends with the program.
        for line in BufReader::new(stream).lines().map_while(Result::ok) {
            if says.send(line).is_err() {
                return;
            }
        }
    });
}
