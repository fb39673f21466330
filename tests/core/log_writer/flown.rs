//! Flights with their logs.

use std::collections::BTreeMap;

use betadeck_core::blackbox::encode::LogBuffer;
use betadeck_core::firmware::Firmware;
use betadeck_core::firmware::blackbox::LogStream;
use betadeck_core::flight::FlightSetup;
use betadeck_core::flight::setup::BootLines;
use betadeck_core::plan::format::PlanFile;
use betadeck_core::signals::RcFrame;
use betadeck_core::sim::WorldConfig;
use betadeck_core::vehicle::{Vehicle, VehicleCommand};

use crate::log_writer::judge;
use crate::log_writer::reader::Log;
use crate::log_writer::truth::Step;

/// A vehicle whose logs are kept.
pub(crate) struct Flown {
    pub(crate) vehicle: Vehicle,
    pub(crate) logs: Vec<Vec<u8>>,
    /// `true` for each log that has ended.
    pub(crate) ended: Vec<bool>,
    pub(crate) stream: LogStream,
    pub(crate) buffer: LogBuffer,
    /// The values of each step with a log, by its time in microseconds.
    pub(crate) truth: BTreeMap<i64, Step>,
}

impl Flown {
    /// Boots with these settings, after those that switch logs on.
    pub(crate) fn boot(rate_hz: u32, settings: &[&str]) -> Self {
        Self::boot_without_device(rate_hz, &[&["blackbox_device = VIRTUAL"], settings].concat())
    }

    pub(crate) fn boot_without_device(rate_hz: u32, settings: &[&str]) -> Self {
        let lines: Vec<String> = settings.iter().map(|line| (*line).to_owned()).collect();
        let setup = FlightSetup {
            world: WorldConfig { rate_hz, ..WorldConfig::default() },
            plan: PlanFile::default(),
            boot_lines: vec![BootLines::settings("--set", &lines)],
            ..FlightSetup::default()
        };
        let (vehicle, _) = setup.build().unwrap();
        Self {
            vehicle,
            logs: Vec::new(),
            ended: Vec::new(),
            stream: LogStream::default(),
            buffer: LogBuffer::default(),
            truth: BTreeMap::new(),
        }
    }

    pub(crate) fn firmware(&self) -> &Firmware {
        self.vehicle.embedded().unwrap()
    }

    /// Runs a CLI line.
    pub(crate) fn line(&mut self, line: &str) {
        let _answer = self.vehicle.apply(&VehicleCommand::single_line(line));
    }

    /// Sets the pulses of channels, from 1, on the virtual sticks.
    pub(crate) fn sticks(&mut self, pulses: &[(usize, u16)]) {
        let mut frame = self.vehicle.transmitter().sticks();
        for (channel, pulse) in pulses {
            frame.channels[channel - 1] = *pulse;
        }
        let _answer = self.vehicle.apply(&VehicleCommand::Sticks(frame));
    }

    pub(crate) fn arm(&mut self) {
        self.sticks(&[(5, 2000)]);
        for _ in 0..20_000 {
            self.fly(0.01);
            if self.firmware().is_armed() {
                return;
            }
        }
        panic!("the craft does not arm: {:?}", self.firmware().arming_flags());
    }

    pub(crate) fn disarm(&mut self) {
        let _answer = self.vehicle.apply(&VehicleCommand::Sticks(RcFrame::SAFE));
        self.fly(0.2);
        assert!(!self.firmware().is_armed());
    }

    /// Arms at the first possible time, and climbs by hand for some seconds with moving sticks.
    pub(crate) fn hop(&mut self, seconds: f64) {
        self.fly(8.0);
        self.arm();
        self.sticks(&[(7, 2000), (3, 1650)]);
        let mut left = seconds;
        for step in 0_u16.. {
            if left <= 0.0 {
                break;
            }
            self.sticks(&[(1, 1450 + step % 5 * 30), (2, 1550 - step % 3 * 40), (4, 1480 + step % 2 * 60)]);
            self.fly(0.25);
            left -= 0.25;
        }
        self.disarm();
    }

    /// Returns the only log, which has ended.
    pub(crate) fn log(&self) -> Log {
        assert_eq!((self.logs.len(), &self.ended[..]), (1, &[true][..]));
        judge::read(&self.logs[0])
    }

    /// Flies on and keeps the bytes of each step.
    pub(crate) fn fly(&mut self, seconds: f64) {
        let until = self.vehicle.time().0 + (seconds * 1e6) as u64;
        while self.vehicle.time().0 < until {
            self.vehicle.tick();
            self.vehicle.drain_events(drop);
            self.keep();
        }
    }

    fn keep(&mut self) {
        let firmware = self.vehicle.embedded().unwrap();
        let Some(step) = firmware.log_step() else { return };
        if step.begins.is_some() {
            self.logs.push(Vec::new());
            self.ended.push(false);
        }
        if step.is_empty() {
            return;
        }
        self.buffer.clear();
        self.stream.step(&step, &mut self.buffer);
        self.logs.last_mut().unwrap().extend_from_slice(self.buffer.bytes());
        *self.ended.last_mut().unwrap() = step.ends;
        self.truth.insert(firmware.time().0 as i64, Step::of(firmware));
    }
}
