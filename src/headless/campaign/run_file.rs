//! The file of a run: its header, then one line for each flight, in the order of their numbers.
//!
//! Each line is written at once when its flight is over. After the program was killed, the file has whole lines and
//! perhaps a part of one, which is cut off. A full disk leaves whole lines, too.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufRead as _, BufReader, Read as _, Seek as _, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::campaign::{Record, Shard, Side};
use crate::headless::campaign::definition::MAX_HEADER;
use crate::headless::campaign::loaded::differs;
use crate::process::error::AppError;
use crate::report::campaign::{LineError, RunHeader, read_record};

/// The longest line of a flight, bytes.
const MAX_LINE: u64 = 1 << 20;

/// Reads the flights of a run's file.
pub(super) struct RunReader {
    path: PathBuf,
    reader: BufReader<File>,
    header: RunHeader,
    shard: Shard,
    /// The number of flights' lines that were read.
    lines: u64,
    /// The bytes of the whole lines that were read.
    bytes: u64,
}

/// A line of a flight.
pub(super) struct Line {
    pub(super) record: Record,
    pub(super) text: String,
}

impl RunReader {
    /// Opens a file and reads its header.
    pub(super) fn open(path: &Path) -> Result<Self, AppError> {
        let file = File::open(path).map_err(|error| cannot_read(path, &error))?;
        Self::from_file(path, file)
    }

    fn from_file(path: &Path, file: File) -> Result<Self, AppError> {
        let mut reader = BufReader::new(file);
        let line = read_line(path, &mut reader, MAX_HEADER)?.unwrap_or_default();
        let header = RunHeader::read(&line)
            .map_err(|problem| AppError::input(format!("{} {problem}: name another file", path.display())))?;
        let shard =
            header.part().map_err(|problem| AppError::input(format!("{}: {problem}", path.display())))?;
        Ok(Self { path: path.to_owned(), reader, header, shard, lines: 0, bytes: line.len() as u64 + 1 })
    }

    pub(super) fn header(&self) -> &RunHeader {
        &self.header
    }

    /// Returns the shard of the file.
    pub(super) fn shard(&self) -> Shard {
        self.shard
    }

    /// Returns the number of lines of flights that were read.
    pub(super) fn lines(&self) -> u64 {
        self.lines
    }

    /// Returns the number of lines of flights in a whole file.
    pub(super) fn wanted(&self) -> u64 {
        self.shard.flights(self.header.flights).count() as u64 * self.header.sides()
    }

    /// Returns the next flight; `None` at the end, and before a line that is cut.
    pub(super) fn next(&mut self) -> Result<Option<Line>, AppError> {
        let Some(text) = read_line(&self.path, &mut self.reader, MAX_LINE)? else { return Ok(None) };
        let problem = |why: String| {
            let place = self.lines + 2;
            AppError::input(format!(
                "{}:{place}: {why}; remove this line and all behind it, and fly the rest again",
                self.path.display()
            ))
        };
        let record =
            read_record(&text, &self.header).map_err(|error: LineError| problem(error.to_string()))?;
        let sides = self.header.sides();
        let wanted = self.shard.flights(self.header.flights).start() + self.lines / sides;
        let side = if self.lines.is_multiple_of(sides) { Side::A } else { Side::B };
        if self.lines >= self.wanted() || record.number != wanted || record.side != side {
            return Err(problem(format!("flight {} is here in place of flight {wanted}", record.number)));
        }
        self.lines += 1;
        self.bytes += text.len() as u64 + 1;
        Ok(Some(Line { record, text }))
    }

    /// Returns the record of a flight; `None` if the campaign has none with this number.
    pub(super) fn find(mut self, number: u64, side: Side) -> Result<Option<Record>, AppError> {
        let flights = self.shard.flights(self.header.flights);
        if !flights.contains(&number) {
            return Ok(None);
        }
        let before = (number - flights.start()) * self.header.sides() + side as u64;
        // Only the line of the flight is decoded.
        for _ in 0..before {
            if read_line(&self.path, &mut self.reader, MAX_LINE)?.is_none() {
                return Err(AppError::input(format!(
                    "{}: flight {number} was not flown yet: fly the rest with betadeck campaign {}",
                    self.path.display(),
                    self.path.display()
                )));
            }
            self.lines += 1;
        }
        let path = self.path.display().to_string();
        match self.next()? {
            Some(line) => Ok(Some(line.record)),
            None => Err(AppError::input(format!(
                "{path}: flight {number} was not flown yet: fly the rest with betadeck campaign {path}"
            ))),
        }
    }
}

/// Reads a line without its end; `None` if there is no whole one.
fn read_line(path: &Path, reader: &mut BufReader<File>, most: u64) -> Result<Option<String>, AppError> {
    let mut line = Vec::new();
    reader.take(most).read_until(b'\n', &mut line).map_err(|error| cannot_read(path, &error))?;
    if line.pop() != Some(b'\n') {
        if line.len() as u64 + 1 >= most {
            return Err(AppError::input(format!("{} has a line without an end", path.display())));
        }
        return Ok(None);
    }
    String::from_utf8(line)
        .map(Some)
        .map_err(|_| AppError::input(format!("{} is not a text file (UTF-8)", path.display())))
}

fn cannot_read(path: &Path, error: &std::io::Error) -> AppError {
    AppError::environment(format!("cannot read {}: {error}", path.display()))
}

/// Appends flights to a run's file.
#[derive(Debug)]
pub(super) struct RunFile {
    path: PathBuf,
    file: File,
    /// The bytes of whole lines.
    bytes: u64,
    /// The number of flights' lines.
    lines: u64,
    wanted: u64,
}

impl RunFile {
    /// Opens the file of a campaign to go on where it ends, or creates it. `old` gets each flight that is in it.
    ///
    /// # Errors
    /// Fails if the file belongs to something else, is damaged, or is written by another process.
    pub(super) fn open(
        path: &Path,
        header: &RunHeader,
        mut old: impl FnMut(&Record),
    ) -> Result<Self, AppError> {
        let name = path.display();
        let cannot = |error: std::io::Error| AppError::environment(format!("cannot write {name}: {error}"));
        if path.exists() && !path.is_file() {
            return Err(AppError::input(format!(
                "--out {name} is not a file: a run is continued in it, so it cannot be a device, a pipe or a directory"
            )));
        }
        let mut options = OpenOptions::new();
        let mut file =
            options.read(true).write(true).create(true).truncate(false).open(path).map_err(cannot)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(AppError::environment(format!(
                    "another betadeck is writing {name}: wait for its end"
                )));
            }
            // Some file systems have no locks.
            Err(TryLockError::Error(_)) => {}
        }
        let mut run = Self {
            path: path.to_owned(),
            file: file.try_clone().map_err(cannot)?,
            bytes: 0,
            lines: 0,
            wanted: 0,
        };
        let head = format!("{}\n", header.line());
        if is_beginning(&mut file, head.as_bytes()).map_err(cannot)? {
            run.write(head.as_bytes())?;
            let shard = header.part().map_err(AppError::internal)?;
            run.wanted = shard.flights(header.flights).count() as u64 * header.sides();
            return Ok(run);
        }
        file.seek(SeekFrom::Start(0)).map_err(cannot)?;
        let mut reader = RunReader::from_file(path, file)?;
        if reader.header().id != header.id {
            let why = differs(header, reader.header());
            return Err(AppError::input(format!(
                "{name} has another campaign: {why}; name another --out, or remove the file"
            )));
        }
        if reader.shard().to_string() != header.shard.clone().unwrap_or_else(|| Shard::WHOLE.to_string()) {
            return Err(AppError::input(format!(
                "{name} has shard {} of this campaign: name another --out for each shard",
                reader.shard()
            )));
        }
        while let Some(line) = reader.next()? {
            old(&line.record);
        }
        (run.bytes, run.lines, run.wanted) = (reader.bytes, reader.lines, reader.wanted());
        // The beginning of a line that a kill cut short.
        run.file.set_len(run.bytes).map_err(cannot)?;
        Ok(run)
    }

    /// Returns the number of flights' lines in the file.
    pub(super) fn lines(&self) -> u64 {
        self.lines
    }

    /// Appends a line.
    ///
    /// # Errors
    /// Fails with the way to go on. The file then has whole lines only.
    pub(super) fn append(&mut self, line: &str) -> Result<(), AppError> {
        self.write(format!("{line}\n").as_bytes())?;
        self.lines += 1;
        Ok(())
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), AppError> {
        let at_end = |file: &mut File, at: u64| file.seek(SeekFrom::Start(at));
        let written = at_end(&mut self.file, self.bytes).and_then(|_| self.file.write_all(bytes));
        if let Err(error) = written {
            // A part of the line may be there.
            let _cut = self.file.set_len(self.bytes);
            return Err(AppError::environment(format!(
                "cannot write {}: {error}. The {} of {} lines before are whole: make room and run the same command again \
                 to go on",
                self.path.display(),
                self.lines,
                self.wanted
            )));
        }
        self.bytes += bytes.len() as u64;
        Ok(())
    }

    /// Makes sure that the lines survive a failure of the system.
    pub(super) fn finish(self) -> Result<(), AppError> {
        self.file
            .sync_all()
            .map_err(|error| AppError::environment(format!("cannot write {}: {error}", self.path.display())))
    }
}

/// Returns `true` if a file is empty, or has only a part of the first line.
fn is_beginning(file: &mut File, head: &[u8]) -> std::io::Result<bool> {
    let mut there = Vec::new();
    file.take(head.len() as u64).read_to_end(&mut there)?;
    Ok(there.len() < head.len() && head.starts_with(&there))
}
