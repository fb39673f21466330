//! The stand-in in lockstep, with the packets of a scripted flight.

use std::path::{Path, PathBuf};
use std::time::Duration;

use betadeck::link::lockstep::{
    FDM_BYTES, KeptRun, Lockstep, LockstepConfig, LockstepPorts, NoReport, NotAgain, RC_BYTES, StepInput,
};
use betadeck::link::{ChildConfig, ChildEvent};

use super::stand_in::{ARGUMENT, PORTS_FILE};

/// The ports for which each stand-in asks. None uses them: the system chooses others.
const PORTS: LockstepPorts = LockstepPorts { fdm: 9003, rc: 9004, motors: 9002, tcp: 5761 };

/// A flight of a stand-in, in its own folder.
pub(crate) struct Flight {
    pub(crate) lockstep: Lockstep,
    step: u64,
    /// The motor packets and the bytes from the serial port, with their steps.
    pub(crate) log: Vec<(u64, Vec<u8>)>,
    _folder: tempfile::TempDir,
}

/// Returns the settings of a stand-in in this folder.
pub(crate) fn config(folder: &Path) -> LockstepConfig {
    let LockstepPorts { fdm, rc, motors, tcp } = PORTS;
    std::fs::write(folder.join(PORTS_FILE), format!("{fdm},{rc},{motors},{tcp}")).unwrap();
    let child = ChildConfig {
        program: std::env::current_exe().unwrap(),
        arguments: vec![ARGUMENT.to_owned()],
        directory: folder.to_owned(),
        launcher: PathBuf::from(env!("CARGO_BIN_EXE_betadeck")),
    };
    LockstepConfig {
        child,
        ports: PORTS,
        step: Duration::from_millis(1),
        own_threads: false,
        keeps_inputs: false,
    }
}

impl Flight {
    /// Starts a stand-in and waits until it has booted.
    pub(crate) fn start() -> Self {
        Self::start_with(false)
    }

    /// Starts a stand-in whose threads run on their own if `own_threads`, and waits until it has booted.
    pub(crate) fn start_with(own_threads: bool) -> Self {
        Self::booted(|folder| Lockstep::start(LockstepConfig { own_threads, ..config(folder) }).unwrap())
    }

    /// Starts a stand-in that finds these files in its folder and whose inputs are kept, and waits until it has booted.
    pub(crate) fn recorded(files: &[&str]) -> Self {
        Self::booted(|folder| {
            files.iter().for_each(|file| std::fs::write(folder.join(file), "").unwrap());
            Lockstep::start(LockstepConfig { keeps_inputs: true, ..config(folder) }).unwrap()
        })
    }

    fn booted(start: impl FnOnce(&Path) -> Lockstep) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut flight = Self { lockstep: start(folder.path()), step: 0, log: Vec::new(), _folder: folder };
        flight.wait().unwrap();
        flight
    }

    /// Lets another stand-in compute the first steps of a run.
    pub(crate) fn again(past: KeptRun, steps: u64) -> Result<Self, NotAgain> {
        let folder = tempfile::tempdir().unwrap();
        let (lockstep, newest) = past.compute(steps, folder.path().to_owned(), |_, _| true)?;
        assert_eq!(newest.is_some(), steps > 0);
        Ok(Self { lockstep, step: steps, log: Vec::new(), _folder: folder })
    }

    /// Waits for the report of the step, however long the machine takes.
    pub(crate) fn wait(&mut self) -> Result<(), NoReport> {
        let motors = loop {
            match self.lockstep.wait() {
                Err(NoReport::Stopped) => {}
                result => break result?,
            }
        };
        let serial = self.lockstep.received().unwrap_or_default();
        self.log.extend(motors.map(|motors| (self.step, motors.to_vec())));
        self.log.extend(Some((self.step, serial)).filter(|(_, bytes)| !bytes.is_empty()));
        Ok(())
    }

    /// Grants the next step of the script: states that change with each step, and RC at 50 Hz.
    pub(crate) fn grant(&mut self) {
        let mut fdm = [0; FDM_BYTES];
        fdm[8..16].copy_from_slice(&(self.step as f64 * 0.1).sin().to_le_bytes());
        let mut rc = [0; RC_BYTES];
        rc[8..16].copy_from_slice(&self.step.to_le_bytes());
        self.lockstep.step(StepInput { fdm, rc: self.step.is_multiple_of(20).then_some(rc) });
        self.step += 1;
    }

    /// Begins the script and the log from the beginning.
    pub(crate) fn begin_again(&mut self) {
        self.step = 0;
        self.log.clear();
    }

    pub(crate) fn run(&mut self, steps: u32) -> Result<(), NoReport> {
        for _ in 0..steps {
            self.grant();
            self.wait()?;
        }
        Ok(())
    }

    /// Connects to the serial port, runs a flight of 2 s with a line every 100 ms, and returns the log.
    pub(crate) fn with_lines(mut self) -> Vec<(u64, Vec<u8>)> {
        assert!(self.lockstep.connect().unwrap());
        for line in 0..20 {
            self.lockstep.send(format!("line {line}\n").as_bytes());
            self.run(100).unwrap();
        }
        self.log
    }

    /// Makes the process print a line every 33 steps and restart in between, and returns the lines with the steps at which
    /// they came.
    pub(crate) fn with_prints(mut self) -> Vec<(u64, String)> {
        let mut lines = Vec::new();
        for turn in 0..10 {
            let restarts = turn % 4 == 3;
            _ = self.lockstep.connect().unwrap();
            self.lockstep.send(if restarts { b"join\n" } else { b"print\n" });
            for _ in 0..33 {
                match self.run(1) {
                    Ok(()) => {}
                    Err(reason) => assert_eq!(reason, NoReport::Replaced),
                }
                while let Some(event) = self.lockstep.take_event() {
                    if let ChildEvent::Line(line) = event {
                        lines.push((self.step, line));
                    }
                }
            }
        }
        lines
    }

    /// Returns the text of the serial port so far, and forgets it.
    pub(crate) fn take_text(&mut self) -> String {
        let log = std::mem::take(&mut self.log);
        log.into_iter()
            .filter(|(_, bytes)| bytes.len() != 16)
            .map(|(_, bytes)| String::from_utf8(bytes).unwrap())
            .collect()
    }

    /// Waits until the process has printed a line with this text, and returns the line.
    pub(crate) fn wait_for_line(&mut self, text: &str) -> String {
        loop {
            match self.lockstep.take_event() {
                Some(ChildEvent::Line(line)) if line.contains(text) => return line,
                Some(_) => {}
                // Lines come between steps.
                None => drop(self.run(1)),
            }
        }
    }
}
