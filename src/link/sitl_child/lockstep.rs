//! An unmodified SITL executable in simulated time. A library that is preloaded into it gives it its clock and the packets
//! of the simulator, so that it computes one step for each `Grant` and then waits. Its clock, its motors and its answers
//! depend on what it was given only, and not on the machine. Grants and reports are in memory that both share.
//!
//! ```text
//! this program ── Grant: state, RC, serial data to take in ──▶ library ── clock, select, recvfrom ──▶ executable
//!              ◀─ Report: motors, serial data sent ──────────         ◀── nanosleep, sendto ───────
//!              ── TCP: the bytes of MSP and CLI, both ways ─────────────────────────────────────▶
//! ```

mod frames;
mod handover;
mod inputs;
mod library;
mod page;
mod process;

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::time::{Duration, Instant};

pub use frames::{FDM_BYTES, MOTOR_BYTES, RC_BYTES};
use frames::{Grant, Report, SerialTotals};
use inputs::Inputs;
pub use inputs::{KeptRun, NotAgain};
use library::LoadedLibrary;
pub use library::{NoLockstep, check_lockstep};
pub use process::NoReport;
use process::Process;

use super::events::Events;
use super::launch::{self, LaunchError, Preload};
use super::{ChildConfig, ChildEnd, ChildEvent, now};

/// The variable with the settings of the library.
const SETTINGS: &str = "BETADECK_LOCKSTEP";
/// The simulated time that is granted in advance for the boot. The executable waits for nothing during it.
const BOOT: Duration = Duration::from_secs(3);
/// The steps between two turns of the thread of the serial ports while there is nothing to send to it. Its data are then
/// at most this much older. Each turn costs some system calls.
const SERIAL_EVERY: u32 = 5;
/// The steps between two reports of the lines that the executable prints.
const OUTPUT_EVERY: u32 = 20;
/// The most bytes that the executable can send over its serial port in a step. The longest answers have some 100 kB.
const SENT_MAX: u64 = 1 << 20;
/// The longest wait for a connection to its serial port.
const CONNECTS_WITHIN: Duration = Duration::from_secs(1);
/// The looks for bytes that the executable says to have sent after which they count as not sent: 3 s.
const BYTES_WITHIN: u32 = 300;

/// The ports for which the executable asks. It gets others, which the system chooses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LockstepPorts {
    pub fdm: u16,
    pub rc: u16,
    pub motors: u16,
    pub tcp: u16,
}

/// The settings of an executable in lockstep.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LockstepConfig {
    pub child: ChildConfig,
    pub ports: LockstepPorts,
    /// The length of a step.
    pub step: Duration,
    /// `true` if its threads run on their own. Otherwise its main thread runs their code, which is faster.
    pub own_threads: bool,
    /// `true` to keep what it is given, so that another process can compute the same.
    pub keeps_inputs: bool,
}

/// The packets for one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepInput {
    pub fdm: [u8; FDM_BYTES],
    pub rc: Option<[u8; RC_BYTES]>,
}

/// An executable in lockstep. It ends when this is dropped.
#[derive(Debug)]
pub struct Lockstep {
    config: LockstepConfig,
    library: LoadedLibrary,
    events: Events,
    /// The start, from which simulated time counts for the number of lines that are shown.
    started: Instant,
    process: Process,
    /// The inputs of this run, if they are wanted; the error if they cannot be kept.
    inputs: Option<io::Result<Inputs>>,
    serial: Option<Serial>,
    /// The totals over all connections to this process.
    totals: SerialTotals,
    /// The bytes read from this process over all connections.
    read: u64,
    /// Bytes from the serial port that were not taken yet.
    received: Vec<u8>,
    /// `true` if the process has ended the connection.
    is_lost: bool,
    newest: Option<Report>,
    /// A report whose bytes have not all arrived, and the looks for them.
    incomplete: Option<(Report, u32)>,
    /// The number of times that the process has replaced itself.
    run: u32,
    /// `true` if the thread of the serial ports has something to take in.
    has_news: bool,
    steps: u32,
    /// The steps since its boot.
    steps_of_run: u32,
}

/// Begins to keep the inputs of a process that starts, if they are wanted.
fn begin_inputs(config: &LockstepConfig) -> Option<io::Result<Inputs>> {
    config.keeps_inputs.then(|| Inputs::begin(&config.child.directory))
}

/// The connection to the first serial port.
#[derive(Debug)]
struct Serial {
    stream: TcpStream,
    /// Bytes that the connection has not taken yet.
    waiting: Vec<u8>,
}

impl Lockstep {
    /// Starts an executable.
    ///
    /// # Errors
    /// Returns an error if the system cannot start it.
    pub fn start(config: LockstepConfig) -> Result<Self, LaunchError> {
        let library = LoadedLibrary::new()
            .map_err(|error| LaunchError::Start { program: config.child.program.clone(), error })?;
        let (process, inputs) = Self::start_process(&config, &library)?;
        Ok(Self {
            config,
            library,
            inputs,
            events: Events::default(),
            started: now(),
            process,
            serial: None,
            totals: SerialTotals::default(),
            read: 0,
            received: Vec::new(),
            is_lost: false,
            newest: None,
            incomplete: None,
            run: 0,
            has_news: false,
            steps: 0,
            steps_of_run: 0,
        })
    }

    fn start_process(
        config: &LockstepConfig,
        library: &LoadedLibrary,
    ) -> Result<(Process, Option<io::Result<Inputs>>), LaunchError> {
        let LockstepPorts { fdm, rc, motors, tcp } = config.ports;
        let (step_ns, boot_ns) = (config.step.as_nanos(), BOOT.as_nanos());
        let own_threads = u8::from(config.own_threads);
        let settings = format!("{fdm},{rc},{motors},{tcp},{step_ns},{boot_ns},{own_threads}");
        let preload = Preload { library: library.path(), variable: SETTINGS, settings };
        launch::make_directory(&config.child)?;
        let inputs = begin_inputs(config);
        Ok((Process::start(&config.child, &preload)?, inputs))
    }

    /// Starts the executable again after its end.
    ///
    /// # Errors
    /// Returns an error if the system cannot start it.
    pub fn restart(&mut self) -> Result<(), LaunchError> {
        self.process.finish_output(&self.events, self.now());
        (self.process, self.inputs) = Self::start_process(&self.config, &self.library)?;
        self.run = 0;
        self.forget_process();
        Ok(())
    }

    /// Forgets what belongs to a process that has ended.
    fn forget_process(&mut self) {
        (self.serial, self.newest, self.incomplete, self.has_news) = (None, None, None, false);
        self.steps_of_run = 0;
        (self.totals, self.read, self.is_lost) = (SerialTotals::default(), 0, false);
        self.received.clear();
    }

    /// Waits until the executable has used up its time, for a short time at most. Returns its newest motor packet, if it
    /// has sent one since the last report.
    ///
    /// # Errors
    /// Returns the reason why it has not.
    pub fn wait(&mut self) -> Result<Option<[u8; MOTOR_BYTES]>, NoReport> {
        let (report, looks) = match self.incomplete.take() {
            Some(incomplete) => incomplete,
            None => (self.process.wait().map_err(|reason| self.noted(reason))?, 0),
        };
        let is_replaced = self.run != report.run;
        if is_replaced || self.steps.is_multiple_of(OUTPUT_EVERY) {
            self.process.report_output(&self.events, self.now());
        }
        if is_replaced {
            self.run = report.run;
            self.forget_process();
            self.inputs = begin_inputs(&self.config);
            self.newest = Some(report);
            return Err(NoReport::Replaced);
        }
        if !self.read_serial(report.sent)? {
            if looks == BYTES_WITHIN {
                return Err(NoReport::Faulty("reports bytes over its serial port that it has not sent"));
            }
            self.incomplete = Some((report, looks + 1));
            let reason = self.process.no_report();
            return Err(self.noted(reason));
        }
        let motors = (report.motor_packets > 0).then_some(report.motors);
        if let Some(motors) = &motors {
            self.keep(|inputs| inputs.motors(motors));
        }
        self.newest = Some(report);
        Ok(motors)
    }

    /// Reports the last lines of a process that has ended.
    fn noted(&mut self, reason: NoReport) -> NoReport {
        if matches!(reason, NoReport::Ended(_)) {
            self.process.finish_output(&self.events, self.now());
        }
        reason
    }

    /// Reads what the executable has sent over the serial port, of which it has sent this much since it started. Returns
    /// `false` if a part has not arrived yet.
    fn read_serial(&mut self, sent: u64) -> Result<bool, NoReport> {
        let Some(serial) = &mut self.serial else { return Ok(true) };
        if sent.saturating_sub(self.read) > SENT_MAX {
            return Err(NoReport::Faulty("reports more bytes over its serial port than a step can carry"));
        }
        let (mut bytes, mut has_waited) = ([0; 4096], false);
        while self.read < sent {
            let most = bytes.len().min((sent - self.read) as usize);
            match serial.stream.read(&mut bytes[..most]) {
                Ok(0) => {
                    self.lose_serial();
                    break;
                }
                Ok(read) => {
                    self.received.extend_from_slice(&bytes[..read]);
                    self.read += read as u64;
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    // One that sends a byte now and then must not hold this thread either.
                    if has_waited || !process::is_readable(&serial.stream) {
                        return Ok(false);
                    }
                    has_waited = true;
                }
                Err(_) => {
                    self.lose_serial();
                    break;
                }
            }
        }
        Ok(true)
    }

    fn lose_serial(&mut self) {
        (self.serial, self.is_lost) = (None, true);
    }

    /// Lets the executable compute one step. Call [`Self::wait`] next.
    pub fn step(&mut self, input: StepInput) {
        self.steps = self.steps.wrapping_add(1);
        self.steps_of_run = self.steps_of_run.wrapping_add(1);
        self.keep(|inputs| inputs.step(&input));
        self.write_waiting();
        let serves = std::mem::take(&mut self.has_news)
            || self.serial.is_some() && self.steps_of_run.is_multiple_of(SERIAL_EVERY);
        let serial = serves.then_some(self.totals);
        self.process.grant(&Grant { fdm: input.fdm, rc: input.rc, serial });
    }

    /// Connects to its first serial port. Returns `false` if it does not listen yet.
    ///
    /// # Errors
    /// Returns the system's error.
    pub fn connect(&mut self) -> io::Result<bool> {
        let Some(newest) = self.newest.as_ref().filter(|report| report.ports[0] != 0) else {
            return Ok(false);
        };
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, newest.ports[0]));
        let stream = TcpStream::connect_timeout(&address, CONNECTS_WITHIN)?;
        stream.set_nodelay(true)?;
        stream.set_nonblocking(true)?;
        // What it has sent so far went to connections before this one.
        (self.read, self.is_lost) = (newest.sent, false);
        self.totals.connections += 1;
        self.has_news = true;
        self.serial = Some(Serial { stream, waiting: Vec::new() });
        self.keep(|inputs| inputs.connected(true));
        Ok(true)
    }

    /// Returns `true` if its first serial port listens.
    pub fn listens(&self) -> bool {
        self.newest.as_ref().is_some_and(|report| report.ports[0] != 0)
    }

    /// Returns the sentence about a process that ended before it answered, without a full stop.
    pub fn why_ended(&self, end: ChildEnd) -> String {
        let child = &self.config.child;
        let of_launcher = match end {
            ChildEnd::Code(code) => launch::error_of_code(code, child),
            ChildEnd::Signal(_) => None,
        };
        of_launcher.unwrap_or_else(|| {
            let name = child.program.file_name().unwrap_or_default().to_string_lossy();
            format!("{name} ended {end} before it answered: is it a SITL executable of Betaflight?")
        })
    }

    /// Ends the connection to its serial port.
    pub fn disconnect(&mut self) {
        if self.serial.take().is_some() {
            self.totals.closed += 1;
            self.has_news = true;
            self.keep(|inputs| inputs.connected(false));
        }
    }

    /// Returns `true` if its main thread runs the code of other threads.
    pub fn has_guests(&self) -> bool {
        self.process.has_guests()
    }

    /// Returns the length of a step.
    pub fn step_length(&self) -> Duration {
        self.config.step
    }

    /// Returns the number of its process.
    pub fn id(&self) -> u32 {
        self.process.id()
    }

    /// Sends bytes over the serial port. The executable takes them in with the next step.
    pub fn send(&mut self, bytes: &[u8]) {
        if let Some(serial) = &mut self.serial {
            serial.waiting.extend_from_slice(bytes);
            self.keep(|inputs| inputs.serial(bytes));
        }
    }

    /// Passes the inputs of this run to `work`, if they are kept. An incomplete record cannot be flown again, so an error ends it.
    fn keep<T>(&mut self, work: impl FnOnce(&mut Inputs) -> io::Result<T>) -> Option<T> {
        let Some(Ok(inputs)) = &mut self.inputs else { return None };
        match work(inputs) {
            Ok(done) => Some(done),
            Err(error) => {
                self.inputs = Some(Err(error));
                None
            }
        }
    }

    /// Returns the error, once, if the inputs of this run cannot be kept.
    pub fn take_inputs_error(&mut self) -> Option<io::Error> {
        self.inputs.take_if(|inputs| inputs.is_err())?.err()
    }

    /// Returns the number of steps since its boot.
    pub fn steps_of_run(&self) -> u64 {
        u64::from(self.steps_of_run)
    }

    /// Returns `true` if its first serial port is connected.
    pub fn is_connected(&self) -> bool {
        self.serial.is_some()
    }

    /// Returns `true` if its run can be computed again.
    pub fn keeps_past(&self) -> bool {
        matches!(self.inputs, Some(Ok(_)))
    }

    /// Returns its run since its boot, which can be computed again; `None` if its inputs are not kept.
    pub fn past(&mut self) -> Option<KeptRun> {
        let config = self.config.clone();
        self.keep(|inputs| inputs.run(config))
    }

    /// Returns the bytes that the executable has sent over the serial port up to its last report. Returns `None` after them
    /// if it has ended the connection.
    pub fn received(&mut self) -> Option<Vec<u8>> {
        (!self.is_lost || !self.received.is_empty()).then(|| std::mem::take(&mut self.received))
    }

    /// Returns the next event of the process.
    pub fn take_event(&mut self) -> Option<ChildEvent> {
        self.events.take(self.now())
    }

    /// Returns the simulated time, counted from the start.
    fn now(&self) -> Instant {
        self.started + self.config.step * self.steps
    }

    /// Writes the waiting bytes as far as the connection takes them.
    fn write_waiting(&mut self) {
        let Some(serial) = self.serial.as_mut().filter(|serial| !serial.waiting.is_empty()) else { return };
        // The executable would wait for bytes that a connection which it has ended cannot carry.
        if serial.stream.peek(&mut [0]).is_ok_and(|size| size == 0) {
            return self.lose_serial();
        }
        while !serial.waiting.is_empty() {
            match serial.stream.write(&serial.waiting) {
                Ok(0) => break,
                Ok(written) => {
                    self.totals.bytes += written as u64;
                    self.has_news = true;
                    serial.waiting.drain(..written);
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => break,
            }
        }
    }
}
