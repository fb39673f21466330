//! A running `betadeck`, which is ended when dropped.

use std::io::{BufRead, BufReader, Read};
use std::net::SocketAddr;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use serde_json::Value;

/// The time limit of every wait. Nothing in these tests takes this long unless it hangs.
pub(crate) const PATIENCE: Duration = Duration::from_secs(600);

/// A process whose output is read line by line.
pub(crate) struct Program {
    child: Child,
    lines: mpsc::Receiver<String>,
    seen: Vec<String>,
    /// A separate home directory, so that the process sees nothing of the user's configuration.
    home: tempfile::TempDir,
}

impl Program {
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let home = tempfile::tempdir().unwrap();
        let mut child = Command::new(env!("CARGO_BIN_EXE_betadeck"))
            .args(arguments)
            .env_clear()
            .env("HOME", home.path())
            .current_dir(home.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (sender, lines) = mpsc::channel();
        pass_on(child.stdout.take().unwrap(), sender.clone());
        pass_on(child.stderr.take().unwrap(), sender);
        Self { child, lines, seen: Vec::new(), home }
    }

    /// Returns the process id.
    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    /// Returns its home and working directory.
    #[allow(dead_code, reason = "only some of those that share this file look at its files")]
    pub(crate) fn directory(&self) -> &Path {
        self.home.path()
    }

    /// Returns the first result of `wanted` among the next lines. Panics with all lines seen if there is
    /// none.
    pub(crate) fn wait<T>(&mut self, what: &str, wanted: impl Fn(&str) -> Option<T>) -> T {
        let end = Instant::now() + PATIENCE;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            let Ok(line) = self.lines.recv_timeout(left) else {
                panic!("no {what} after:\n{}", self.seen.join("\n"))
            };
            let found = wanted(&line);
            self.seen.push(line);
            if let Some(found) = found {
                return found;
            }
        }
    }

    /// Waits for the end of the process. Returns the exit code.
    #[allow(dead_code, reason = "only some of those that share this file wait for an end")]
    pub(crate) fn end(&mut self) -> i32 {
        let end = Instant::now() + PATIENCE;
        while Instant::now() < end {
            if let Some(status) = self.child.try_wait().unwrap() {
                // The last lines may still be on their way.
                while let Ok(line) = self.lines.recv_timeout(Duration::from_secs(1)) {
                    self.seen.push(line);
                }
                return status.code().unwrap_or(-1);
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        panic!("no end after:\n{}", self.seen.join("\n"))
    }

    /// Returns all lines so far.
    pub(crate) fn seen(&mut self) -> &[String] {
        self.seen.extend(self.lines.try_iter());
        &self.seen
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // The process may have ended already.
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

fn pass_on(output: impl Read + Send + 'static, lines: mpsc::Sender<String>) {
    std::thread::spawn(move || {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            if lines.send(line).is_err() {
                break;
            }
        }
    });
}

/// `betadeck serve` with all its doors on ports that the system chooses.
pub(crate) struct Serve {
    program: Program,
    pub(crate) websocket: SocketAddr,
    pub(crate) tcp: SocketAddr,
    pub(crate) rc: SocketAddr,
}

impl Serve {
    /// Serves a craft without stored settings at this many times real time.
    pub(crate) fn start(speed: &str) -> Self {
        let options = "serve --fresh --json - --ws-port 0 --tcp-port 0 --udp-ports 0,0,0,0 --speed";
        let mut arguments: Vec<&str> = options.split(' ').collect();
        arguments.push(speed);
        let mut program = Program::start(&arguments);
        let doors = program.wait("place of the doors", |line| {
            let event: Value = serde_json::from_str(line).ok()?;
            (event["event"] == "doors").then_some(event)
        });
        let address = |door: &str| doors[door].as_str().unwrap().parse().unwrap();
        Self { websocket: address("ws"), tcp: address("tcp"), rc: address("rc"), program }
    }

    /// Returns the process id.
    pub(crate) fn id(&self) -> u32 {
        self.program.id()
    }

    /// Returns the next event that `wanted` accepts.
    pub(crate) fn wait(&mut self, what: &str, wanted: impl Fn(&Value) -> bool) -> Value {
        self.program.wait(what, |line| {
            let event: Value = serde_json::from_str(line).ok()?;
            wanted(&event).then_some(event)
        })
    }

    /// Returns the next event of that name.
    pub(crate) fn event(&mut self, name: &str) -> Value {
        self.wait(name, |event| event["event"] == name)
    }

    /// Returns `true` if an event of that name has come so far.
    pub(crate) fn has_seen(&mut self, name: &str) -> bool {
        let key = format!("\"event\":\"{name}\"");
        self.program.seen().iter().any(|line| line.contains(&key))
    }

    /// Returns the number of notices so far that contain this text.
    pub(crate) fn notices(&mut self, text: &str) -> usize {
        let holds = |line: &&String| line.contains("\"event\":\"notice\"") && line.contains(text);
        self.program.seen().iter().filter(holds).count()
    }
}

/// `betadeck sitl` with its doors on ports that the system chooses.
pub(crate) struct Sitl {
    pub(crate) program: Program,
    pub(crate) fdm: SocketAddr,
    pub(crate) rc: SocketAddr,
    pub(crate) tcp: SocketAddr,
}

impl Sitl {
    /// Starts `betadeck sitl`, which sends its motors to these ports.
    pub(crate) fn start(raw: u16, motors: u16) -> Self {
        let ports = format!("{raw},{motors},0,0");
        // The program keeps `eeprom.bin` in its directory.
        let mut program =
            Program::start(&["sitl", "--ws-port", "0", "--tcp-port", "0", "--udp-ports", &ports]);
        // The lines come from two streams, so their order may vary.
        let (mut udp, mut tcp) = (Vec::new(), None);
        while udp.len() < 2 || tcp.is_none() {
            let (is_udp, place) = program.wait("line of a door", |line| {
                let udp =
                    line.strip_prefix("[SITL] start UDP server @").and_then(|rest| rest.strip_suffix("...0"));
                let tcp = line.strip_prefix("bind port ").and_then(|rest| rest.strip_suffix(" for UART1"));
                udp.or(tcp).map(|text| (udp.is_some(), port(text)))
            });
            if is_udp {
                udp.push(place);
            } else {
                tcp = Some(place);
            }
        }
        Self { program, fdm: udp[0], rc: udp[1], tcp: tcp.unwrap() }
    }

    /// Returns the process id.
    pub(crate) fn id(&self) -> u32 {
        self.program.id()
    }
}

fn port(text: &str) -> SocketAddr {
    SocketAddr::from(([127, 0, 0, 1], text.parse().unwrap()))
}
