//! The blackbox logs of the craft of a session: its flash memory, which MSP reads, and the files in the state directory.

use std::io;
use std::time::{Duration, Instant};

use crate::blackbox::encode::LogBuffer;
use crate::firmware::Firmware;
use crate::firmware::blackbox::{Flash, LogDevice, LogStream};
use crate::runner::{Flying, Subscriber};
use crate::storage::LogFolder;
use crate::vehicle::Vehicle;

/// The wall time between two writes.
const FLUSH: Duration = Duration::from_secs(1);

/// The notice for a full flash memory.
const FULL: &str =
    "The flash memory of the craft is full: the log ends there. Erase it in the App's Blackbox tab.";

/// Writes the logs of an embedded flight controller.
#[derive(Debug, Default)]
pub(super) struct FlightLogs {
    stream: LogStream,
    buffer: LogBuffer,
    flash: Flash,
    /// The directory for files; `None` if the session has none.
    folder: Option<LogFolder>,
    flushed_at: Option<Instant>,
    /// Sentences for the user.
    notices: Vec<String>,
}

impl FlightLogs {
    pub(super) fn new(folder: Option<LogFolder>) -> Self {
        Self { folder, ..Self::default() }
    }

    pub(super) fn flash(&self) -> &Flash {
        &self.flash
    }

    pub(super) fn erase_flash(&mut self) {
        self.flash.erase();
    }

    /// Writes what the last tick noted.
    pub(super) fn after_tick(&mut self, vehicle: &Vehicle) {
        let Some(firmware) = vehicle.embedded() else { return };
        let Some(step) = firmware.log_step().filter(|step| !step.is_empty()) else { return };
        if step.begins.is_some() {
            self.begin(firmware);
        }
        self.buffer.clear();
        self.stream.step(&step, &mut self.buffer);
        if !self.flash.write(self.buffer.bytes()) {
            self.notices.push(FULL.to_owned());
        }
        let Some(folder) = &mut self.folder else { return };
        let written = folder.write(self.buffer.bytes());
        let written = if step.ends { written.and_then(|()| folder.end()) } else { written };
        self.report(written);
    }

    fn begin(&mut self, firmware: &Firmware) {
        if !self.flash.begin() {
            self.notices.push(FULL.to_owned());
        }
        let Some(folder) = &mut self.folder else { return };
        // A log that a rewind left has no end.
        let left = folder.end();
        let begun = match firmware.parameters().blackbox.device {
            LogDevice::Files => folder.begin().map(Some),
            LogDevice::Flash | LogDevice::None => Ok(None),
        };
        self.report(left);
        match begun {
            Ok(Some(path)) => self.notices.push(format!("Blackbox log: {}", path.display())),
            Ok(None) => {}
            Err(error) => self.report(Err(error)),
        }
    }

    /// Passes the files on to the system if a second has passed.
    pub(super) fn flush_if_due(&mut self, now: Instant) {
        let Some(folder) = self.folder.as_mut().filter(|folder| folder.is_open()) else { return };
        if self.flushed_at.is_some_and(|at| now.saturating_duration_since(at) < FLUSH) {
            return;
        }
        self.flushed_at = Some(now);
        let flushed = folder.flush();
        self.report(flushed);
    }

    fn report(&mut self, written: io::Result<()>) {
        if let Err(error) = written {
            self.notices.push(format!("The blackbox log cannot be written: {error}. Its file ends here."));
        }
    }

    /// Takes the sentences for the user.
    pub(super) fn take_notices(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notices)
    }
}

impl<F: Flying> Subscriber<F> for FlightLogs {
    fn after_tick(&mut self, flight: &F) {
        self.after_tick(flight.vehicle());
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_methods, reason = "the writer gets its time from the tests")]

    use super::*;
    use crate::flight::FlightSetup;
    use crate::storage::logs_in;
    use crate::vehicle::VehicleCommand;

    /// Returns a vehicle that logs from boot on.
    fn logging(device: &str) -> Vehicle {
        let (mut vehicle, _) = FlightSetup::default().build().expect("a vehicle");
        for line in [format!("set blackbox_device = {device}"), "set blackbox_mode = ALWAYS".to_owned()] {
            let reply = vehicle.apply(&VehicleCommand::single_line(&line)).line().expect("a reply");
            assert!(!reply.failed, "{line}");
        }
        vehicle
    }

    fn fly(vehicle: &mut Vehicle, logs: &mut FlightLogs, ticks: usize) {
        for _ in 0..ticks {
            vehicle.tick();
            vehicle.drain_events(drop);
            logs.after_tick(vehicle);
        }
    }

    #[test]
    fn a_log_is_in_the_flash_memory_and_in_a_file() {
        let directory = tempfile::tempdir().expect("a directory");
        let mut logs = FlightLogs::new(Some(LogFolder::new(directory.path().to_owned())));
        let mut vehicle = logging("VIRTUAL");
        fly(&mut vehicle, &mut logs, 2000);
        let path = directory.path().join("LOG00001.BFL");
        assert_eq!(logs.take_notices(), [format!("Blackbox log: {}", path.display())]);
        let begun = Instant::now();
        logs.flush_if_due(begun);
        let written = std::fs::read(&path).expect("a log");
        let used = logs.flash().facts().used;
        assert!(used > 20_000 && written == logs.flash().read(0, used), "{used}");
        fly(&mut vehicle, &mut logs, 200);
        logs.flush_if_due(begun + FLUSH / 2);
        assert_eq!(std::fs::read(&path).expect("a log").len(), used, "not a second yet");
        logs.flush_if_due(begun + FLUSH);
        assert!(std::fs::read(&path).expect("a log").len() > used);
    }

    #[test]
    fn a_flight_that_goes_on_from_an_earlier_instant_has_a_log_of_its_own() {
        let directory = tempfile::tempdir().expect("a directory");
        let mut logs = FlightLogs::new(Some(LogFolder::new(directory.path().to_owned())));
        let mut vehicle = logging("VIRTUAL");
        fly(&mut vehicle, &mut logs, 500);
        let mut earlier = vehicle.clone();
        fly(&mut vehicle, &mut logs, 500);
        earlier.begin_new_log();
        fly(&mut earlier, &mut logs, 500);
        drop(logs);
        let mut files: Vec<_> = logs_in(directory.path()).collect();
        files.sort();
        assert_eq!(files.len(), 2);
        for file in files {
            let bytes = std::fs::read(file).expect("a log");
            let mut reader = crate::blackbox::decode::LogReader::new(bytes.as_slice());
            while let Some(item) = reader.next_item().expect("bytes") {
                let is_damage = matches!(item, crate::blackbox::decode::Item::Skipped { .. });
                assert!(!is_damage, "{item:?}");
            }
        }
    }

    #[test]
    fn the_flash_memory_alone_has_no_file() {
        let directory = tempfile::tempdir().expect("a directory");
        let mut logs = FlightLogs::new(Some(LogFolder::new(directory.path().to_owned())));
        fly(&mut logging("SPIFLASH"), &mut logs, 500);
        assert!(logs.flash().facts().used > 5000);
        assert_eq!((logs_in(directory.path()).count(), logs.take_notices().len()), (0, 0));
    }

    #[test]
    fn a_file_that_cannot_be_written_is_reported_once() {
        let directory = tempfile::tempdir().expect("a directory");
        let mut logs = FlightLogs::new(Some(LogFolder::new(directory.path().join("none"))));
        fly(&mut logging("VIRTUAL"), &mut logs, 500);
        let notices = logs.take_notices();
        assert!(notices.len() == 1 && notices[0].contains("cannot be written"), "{notices:?}");
        assert!(logs.flash().facts().used > 5000, "the flash memory goes on");
    }
}
