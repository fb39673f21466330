//! All that an executable was given since its boot, from which another process computes the same. A flight in real parts
//! cannot be cloned, so an earlier instant is reached by these inputs.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, BufRead as _, BufReader, BufWriter, Read, Write as _};
use std::os::unix::fs::FileExt as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use super::frames::{FDM_BYTES, MOTOR_BYTES};
use super::{Lockstep, LockstepConfig, NoReport, StepInput};
use crate::link::ChildEnd;

/// The most bytes that are kept of a run. A second has some 180 kB at 1000 steps a second.
const MOST_BYTES: u64 = 1 << 30;
/// The largest file of the executable's folder that belongs to its start, bytes, and the most files.
const MOST_FILE: u64 = 1 << 20;
const MOST_FILES: usize = 64;

/// The kinds of entries. Each entry is its kind and its data.
const STATE: u8 = 1;
const RC: u8 = 2;
const MOTORS: u8 = 3;
/// Serial data: their number, 4 bytes little-endian, and they themselves.
const SERIAL: u8 = 4;
const CONNECTED: u8 = 5;
const DISCONNECTED: u8 = 6;

/// The inputs of a run and the motors that it answered, in a file without a name.
#[derive(Debug)]
pub(super) struct Inputs {
    file: BufWriter<Arc<File>>,
    folder: Arc<Vec<(OsString, Vec<u8>)>>,
    /// The bytes and the steps so far. The record ends at [`MOST_BYTES`].
    bytes: u64,
    steps: u64,
}

impl Inputs {
    /// Begins with a process that starts in this folder.
    ///
    /// # Errors
    /// Returns the system's error.
    pub(super) fn begin(folder: &Path) -> io::Result<Self> {
        let mut files = Vec::new();
        for entry in std::fs::read_dir(folder)? {
            let (entry, mut bytes) = (entry?, Vec::new());
            let facts = entry.metadata()?;
            if facts.is_file() && facts.len() <= MOST_FILE && files.len() < MOST_FILES {
                File::open(entry.path())?.take(MOST_FILE).read_to_end(&mut bytes)?;
                files.push((entry.file_name(), bytes));
            }
        }
        let file = BufWriter::with_capacity(1 << 16, Arc::new(tempfile::tempfile()?));
        Ok(Self { file, folder: Arc::new(files), bytes: 0, steps: 0 })
    }

    pub(super) fn step(&mut self, input: &StepInput) -> io::Result<()> {
        if let Some(rc) = &input.rc {
            self.add(RC, rc)?;
        }
        self.steps += u64::from(self.bytes < MOST_BYTES);
        self.add(STATE, &input.fdm)
    }

    pub(super) fn motors(&mut self, packet: &[u8; MOTOR_BYTES]) -> io::Result<()> {
        self.add(MOTORS, packet)
    }

    pub(super) fn serial(&mut self, bytes: &[u8]) -> io::Result<()> {
        let size = u32::try_from(bytes.len()).map_err(io::Error::other)?.to_le_bytes();
        self.add(SERIAL, &[&size, bytes].concat())
    }

    pub(super) fn connected(&mut self, is_connected: bool) -> io::Result<()> {
        self.add(if is_connected { CONNECTED } else { DISCONNECTED }, &[])
    }

    fn add(&mut self, kind: u8, data: &[u8]) -> io::Result<()> {
        if self.bytes < MOST_BYTES {
            self.file.write_all(&[kind])?;
            self.file.write_all(data)?;
            self.bytes += 1 + data.len() as u64;
        }
        Ok(())
    }

    /// Returns the run so far.
    ///
    /// # Errors
    /// Returns the system's error.
    pub(super) fn run(&mut self, config: LockstepConfig) -> io::Result<KeptRun> {
        self.file.flush()?;
        let (file, folder) = (Arc::clone(self.file.get_ref()), Arc::clone(&self.folder));
        Ok(KeptRun { config, file, folder, bytes: self.bytes, steps: self.steps })
    }
}

/// A run of an executable whose steps can be computed again.
#[derive(Debug, Clone)]
pub struct KeptRun {
    config: LockstepConfig,
    file: Arc<File>,
    folder: Arc<Vec<(OsString, Vec<u8>)>>,
    bytes: u64,
    /// The steps since the boot that are kept.
    pub steps: u64,
}

/// The reason why a run cannot be computed again. `Display` gives a sentence without a full stop.
#[derive(Debug, thiserror::Error)]
pub enum NotAgain {
    #[error("the firmware cannot be started again: {0}")]
    Start(String),
    #[error("what it was given cannot be read: {0}")]
    Read(#[from] io::Error),
    #[error("the firmware does not compute the same again: its motors differ at step {0}")]
    Differs(u64),
    #[error("the firmware, started again, ended {0}")]
    Ended(ChildEnd),
    #[error("the firmware, started again, did not end its step {0}")]
    NoReport(u64),
    #[error("the firmware has restarted since this instant")]
    BeforeBoot,
    #[error("the record of what the firmware was given does not contain this instant")]
    NotKept,
    #[error("it was stopped")]
    Stopped,
}

impl KeptRun {
    /// Returns the length of a step.
    pub fn step_length(&self) -> Duration {
        self.config.step
    }

    /// Starts the executable in another folder and lets it compute its first `steps` steps again. `goes_on` gets the number
    /// of steps so far and, after each of them, the bytes that it sent over the serial port. Returns the executable and its
    /// newest state packet.
    ///
    /// # Errors
    /// Returns the reason if it cannot, or if `goes_on` returns `false`.
    pub fn compute(
        self,
        steps: u64,
        directory: PathBuf,
        mut goes_on: impl FnMut(u64, &[u8]) -> bool,
    ) -> Result<(Lockstep, Option<[u8; FDM_BYTES]>), NotAgain> {
        for (name, bytes) in &*self.folder {
            std::fs::write(directory.join(name), bytes)?;
        }
        let mut config = self.config;
        config.child.directory = directory;
        let mut lockstep = Lockstep::start(config).map_err(|error| NotAgain::Start(error.to_string()))?;
        let mut inputs = BufReader::with_capacity(1 << 16, At { file: &self.file, at: 0, end: self.bytes });
        let mut motors = finish(&mut lockstep, 0, &mut goes_on)?;
        let (mut step, mut rc, mut fdm) = (0, None, None);
        while !inputs.fill_buf()?.is_empty() {
            match array::<1>(&mut inputs)? {
                [MOTORS] => {
                    let wanted = array(&mut inputs)?;
                    if motors.take() != Some(wanted) {
                        return Err(NotAgain::Differs(step));
                    }
                }
                // The executable takes what follows in with the next step.
                _ if step == steps => break,
                [STATE] if step > 0 && motors.is_some() => return Err(NotAgain::Differs(step)),
                [RC] => rc = Some(array(&mut inputs)?),
                [STATE] => {
                    let state = array(&mut inputs)?;
                    lockstep.step(StepInput { fdm: state, rc: rc.take() });
                    (step, fdm) = (step + 1, Some(state));
                    motors = finish(&mut lockstep, step, &mut goes_on)?;
                }
                [CONNECTED] => drop(lockstep.connect()?),
                [DISCONNECTED] => lockstep.disconnect(),
                _ => {
                    let size = u32::from_le_bytes(array(&mut inputs)?);
                    let mut bytes = vec![0; size as usize];
                    inputs.read_exact(&mut bytes)?;
                    lockstep.send(&bytes);
                }
            }
        }
        Ok((lockstep, fdm))
    }
}

/// Waits until the executable has ended its step, and returns its motors.
fn finish(
    lockstep: &mut Lockstep,
    step: u64,
    goes_on: &mut impl FnMut(u64, &[u8]) -> bool,
) -> Result<Option<[u8; MOTOR_BYTES]>, NotAgain> {
    loop {
        let (bytes, motors) = match lockstep.wait() {
            Ok(motors) => (lockstep.received().unwrap_or_default(), Some(motors)),
            Err(NoReport::Stopped) => (Vec::new(), None),
            Err(NoReport::Ended(end)) => return Err(NotAgain::Ended(end)),
            Err(_) => return Err(NotAgain::NoReport(step)),
        };
        if !goes_on(step, &bytes) {
            return Err(NotAgain::Stopped);
        }
        if let Some(motors) = motors {
            // The first process has printed the same lines, and they were reported.
            while lockstep.take_event().is_some() {}
            return Ok(motors);
        }
    }
}

/// Reads a part of a file that another thread writes on.
struct At<'f> {
    file: &'f File,
    at: u64,
    end: u64,
}

impl Read for At<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let most = usize::try_from(self.end - self.at).unwrap_or(usize::MAX).min(bytes.len());
        let read = self.file.read_at(&mut bytes[..most], self.at)?;
        self.at += read as u64;
        Ok(read)
    }
}

fn array<const N: usize>(from: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    from.read_exact(&mut bytes)?;
    Ok(bytes)
}
