//! The recorder: decides when a log begins and ends, and keeps the bytes of the last step.

use super::config::LogMode;
use super::log::{Log, LogDefinition, LogPart, Notes};
use super::main_frame::MainState;
use crate::firmware::Firmware;
use crate::signals::SimTime;

/// The time for which a motor test is logged after the motors stopped, µs.
const AFTER_TEST_US: u64 = 5_000_000;
/// The pulse above which a motor runs, µs.
const RUNNING_US: f64 = 1000.0;

/// What the last step noted.
#[derive(Debug, Clone, Copy)]
pub struct LogStep<'a> {
    /// The log that begins with this step.
    pub begins: Option<&'a LogDefinition>,
    /// Lines of the header. They come before the parts.
    pub text: &'a [u8],
    pub parts: &'a [LogPart],
    /// The state for the main frame among the parts.
    pub main: &'a MainState,
    /// `true` if the log ends with this step.
    pub ends: bool,
}

impl LogStep<'_> {
    /// Returns `true` if the step noted nothing.
    pub fn is_empty(&self) -> bool {
        self.begins.is_none() && self.text.is_empty() && self.parts.is_empty()
    }
}

/// Writes one log after the other.
#[derive(Debug, Clone, Default)]
pub(in crate::firmware) struct Recorder {
    notes: Notes,
    log: Option<Log>,
    begins: bool,
    ends: bool,
    /// `None` before the first step.
    was_armed: Option<bool>,
    /// The time until which a motor test is logged.
    test_until: SimTime,
    /// `true` if the log under way must end, because the firmware has restarted.
    must_end: bool,
}

impl Recorder {
    /// Returns what the last step noted.
    pub(in crate::firmware) fn last_step(&self) -> LogStep<'_> {
        let begins = self.log.as_ref().filter(|_| self.begins).map(|log| &log.definition);
        let Notes { text, parts, main } = &self.notes;
        LogStep { begins, text: text.bytes(), parts, main, ends: self.ends }
    }

    /// Returns `true` while a log is written.
    pub(in crate::firmware) fn is_logging(&self) -> bool {
        self.log.is_some()
    }

    /// Ends the log under way with the next step.
    pub(in crate::firmware) fn end(&mut self) {
        self.must_end = self.log.is_some();
    }

    /// Forgets the log under way. If a log is wanted, a new one begins with the next step.
    pub(in crate::firmware) fn forget(&mut self) {
        *self = Self { was_armed: self.was_armed, ..Self::default() };
    }

    /// Notes what belongs in the log after a step of the firmware.
    pub(in crate::firmware) fn step(&mut self, firmware: &Firmware) {
        self.notes.text.clear();
        self.notes.parts.clear();
        (self.begins, self.ends) = (false, false);
        let is_armed = firmware.is_armed();
        let was_armed = self.was_armed.replace(is_armed).unwrap_or(is_armed);
        let is_wanted = self.is_wanted(firmware) && !self.must_end;
        if self.log.is_none() && is_wanted {
            self.log = Some(Log::begin(firmware));
            self.begins = true;
        }
        let Some(log) = &mut self.log else { return };
        match (was_armed, is_armed) {
            (false, true) => log.note_arming(firmware.now),
            (true, false) => log.note_disarming(firmware.last_disarm().map_or(0, |reason| reason as u32)),
            (false, false) | (true, true) => {}
        }
        if log.step(firmware, !is_wanted, &mut self.notes) {
            self.log = None;
            self.ends = true;
            self.must_end = false;
        }
    }

    fn is_wanted(&mut self, firmware: &Firmware) -> bool {
        let config = &firmware.parameters().blackbox;
        let is_armed = firmware.is_armed();
        config.is_on()
            && match config.mode {
                LogMode::Normal => is_armed,
                LogMode::MotorTest => is_armed || self.is_motor_test(firmware),
                LogMode::Always => true,
            }
    }

    fn is_motor_test(&mut self, firmware: &Firmware) -> bool {
        if firmware.control().motors_us.iter().any(|pulse| *pulse > RUNNING_US) {
            self.test_until = SimTime(firmware.now.0 + AFTER_TEST_US);
        }
        firmware.now < self.test_until
    }
}
