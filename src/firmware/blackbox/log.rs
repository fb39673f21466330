//! One log: its header, then the frames and events that are due.

use arrayvec::ArrayVec;

use super::config::LogMode;
use super::header::{HeaderFacts, write_line};
use super::main_frame::{self, LoggedFields, MainState};
use super::schedule::Schedule;
use super::side_frames::{self, GpsValues, HomeValues, LoggedHome, SlowValues};
use crate::blackbox::encode::{CAPACITY, LogBuffer, LogConstants, LogLayout};
use crate::blackbox::{FrameKind, LogEvent};
use crate::firmware::Firmware;
use crate::firmware::config::Feature;
use crate::firmware::modes::{BoxSet, boxes};
use crate::geo::LatLon;
use crate::signals::SimTime;

/// The bytes of a step after which the header waits for the next step. No line is longer than the rest.
const HEADER_BUDGET: usize = CAPACITY / 2;
/// The number of whole frames after which modes and states, and home, are written again.
const SLOW_EVERY: u32 = 256;
const HOME_EVERY: u32 = 128;
/// The bit of the GPS in the mask of fields that are left out.
const GPS_FIELDS: u32 = 12;
/// The lowest pulse of a motor that is stopped on the bench, µs.
const STOPPED_US: f64 = 1000.0;
/// The factor of values in high resolution.
const HIGH_RESOLUTION: f64 = 10.0;

/// Everything that stays the same in a log: its fields, and how their values become bytes.
#[derive(Debug, Clone)]
pub struct LogDefinition {
    pub(super) layout: LogLayout,
    pub(super) constants: LogConstants,
    pub(super) fields: LoggedFields,
    /// The units of a degree per second and of a stick unit.
    pub(super) scale: f64,
}

/// A part of a log after its header.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LogPart {
    /// A main frame with whole values.
    Intra,
    /// A main frame with differences.
    Inter,
    Slow(SlowValues),
    Home(HomeValues),
    Gps(GpsValues),
    Event(LogEvent),
}

/// The most parts of a step: two events, states, a main frame, home, a solution.
pub(super) const MAX_PARTS: usize = 6;

/// What a step noted.
#[derive(Debug, Clone, Default)]
pub(super) struct Notes {
    /// Lines of the header.
    pub(super) text: LogBuffer,
    pub(super) parts: ArrayVec<LogPart, MAX_PARTS>,
    /// The state for the main frame among the parts.
    pub(super) main: MainState,
}

impl Notes {
    fn add(&mut self, part: LogPart) {
        let _full = self.parts.try_push(part);
    }
}

/// A log under way.
#[derive(Debug, Clone)]
pub(super) struct Log {
    pub(super) definition: LogDefinition,
    schedule: Schedule,
    began: SimTime,
    /// The next line of the header; `None` after the last one.
    next_line: Option<usize>,
    has_gps: bool,
    /// `true` if the switch can pause it.
    has_pauses: bool,
    is_paused: bool,
    /// The steps since the last loop.
    steps: u8,
    frames: FrameMemory,
    events: EventMemory,
}

/// The frames beside the main frames that were written.
#[derive(Debug, Clone, Copy, Default)]
struct FrameMemory {
    /// `true` once a whole frame was written.
    has_intra: bool,
    slow: Option<SlowValues>,
    /// The whole frames since the last `S` and `H` frames.
    since_slow: u32,
    since_home: u32,
    home: Option<LoggedHome>,
    /// Position and satellites of the last solution.
    solution: Option<(LatLon, u8)>,
}

/// The events that are written or wait.
#[derive(Debug, Clone, Copy, Default)]
struct EventMemory {
    /// The time of an arming whose beep is not written yet.
    beep: Option<SimTime>,
    disarm: Option<u32>,
    boxes: BoxSet,
    /// The same as bits.
    box_mask: u32,
}

impl Log {
    /// Begins a log with the fields that exist now.
    pub(super) fn begin(firmware: &Firmware) -> Self {
        let parameters = firmware.parameters();
        let config = &parameters.blackbox;
        let schedule = Schedule::new(firmware.setup.loop_us(), config.rate_power);
        let fields = main_frame::logged(firmware);
        let mut layout = LogLayout::default();
        let has_gps = config.has(GPS_FIELDS) && firmware.setup.boot.features.has(Feature::Gps);
        let mut all_fit = fields.iter().all(|fields| layout.add(FrameKind::Intra, fields.group()));
        if has_gps {
            all_fit &= side_frames::HOME.iter().all(|group| layout.add(FrameKind::GpsHome, *group));
            all_fit &= side_frames::GPS.iter().all(|group| layout.add(FrameKind::Gps, *group));
        }
        all_fit &= side_frames::SLOW.iter().all(|group| layout.add(FrameKind::Slow, *group));
        debug_assert!(all_fit, "a frame has room for all fields");
        let constants = LogConstants {
            p_interval: schedule.p_interval(),
            min_throttle: 0,
            min_motor: parameters.control.mixer.stop_us.min(STOPPED_US) as i32,
            vbat_reference: MainState::of(firmware, 0).volts(),
        };
        let switched = firmware.boxes();
        let scale = if config.high_resolution { HIGH_RESOLUTION } else { 1.0 };
        Self {
            definition: LogDefinition { layout, constants, fields, scale },
            schedule,
            began: firmware.now,
            next_line: Some(0),
            has_gps,
            has_pauses: config.has_switch && config.mode != LogMode::Always && firmware.is_armed(),
            is_paused: false,
            steps: 0,
            frames: FrameMemory::default(),
            events: EventMemory {
                boxes: switched,
                box_mask: side_frames::box_mask(switched),
                ..EventMemory::default()
            },
        }
    }

    /// Notes that the craft was armed.
    pub(super) fn note_arming(&mut self, now: SimTime) {
        self.events.beep = Some(now);
    }

    /// Notes that the craft was disarmed. The reason is a number of `DisarmReason`.
    pub(super) fn note_disarming(&mut self, reason: u32) {
        self.events.disarm = Some(reason);
    }

    /// Notes what belongs in the log after a step. With `is_over`, ends the log as soon as it has a frame. Returns `true`
    /// at its end.
    pub(super) fn step(&mut self, firmware: &Firmware, is_over: bool, notes: &mut Notes) -> bool {
        if let Some(line) = self.next_line {
            self.write_header(firmware, line, &mut notes.text);
            return false;
        }
        if self.frames.has_intra {
            if let Some(reason) = self.events.disarm.take() {
                notes.add(LogPart::Event(LogEvent::Disarm { reason }));
            }
            if is_over {
                notes.add(LogPart::Event(LogEvent::End));
                return true;
            }
        }
        // A disarmed craft has no rate loop, but the same number of loops a second.
        self.steps += 1;
        let has_run = firmware.is_armed() && firmware.control.controller.has_run();
        if has_run || self.steps >= firmware.setup.boot.pid_denominator {
            self.steps = 0;
            self.note_loop(firmware, notes);
            self.schedule.advance();
        }
        false
    }

    fn write_header(&mut self, firmware: &Firmware, mut line: usize, text: &mut LogBuffer) {
        let facts = HeaderFacts {
            firmware,
            definition: &self.definition,
            schedule: &self.schedule,
            began: self.began,
        };
        while text.bytes().len() < HEADER_BUDGET {
            if !write_line(line, &facts, text) {
                self.next_line = None;
                return;
            }
            line += 1;
        }
        self.next_line = Some(line);
    }

    /// Notes what is due in this loop. The first thing after the header is a whole frame, because some decoders end the
    /// header there.
    fn note_loop(&mut self, firmware: &Firmware, notes: &mut Notes) {
        let is_switched_off = self.has_pauses && !firmware.boxes().has(boxes::BLACKBOX);
        if self.schedule.is_intra() {
            if self.is_paused {
                if is_switched_off {
                    return;
                }
                let (iteration, time_us) = (self.schedule.iteration(), firmware.now.0);
                notes.add(LogPart::Event(LogEvent::Resume { iteration, time_us }));
                self.is_paused = false;
            }
            if self.schedule.is_only_intra() && self.frames.has_intra {
                self.note_slow_if_due(firmware, notes);
            }
            self.note_main(LogPart::Intra, firmware, notes);
            let frames = &mut self.frames;
            frames.has_intra = true;
            frames.since_slow += 1;
            frames.since_home += 1;
            return;
        }
        self.is_paused |= is_switched_off;
        if self.is_paused {
            return;
        }
        self.note_events(firmware, notes);
        if self.schedule.is_inter() {
            self.note_slow_if_due(firmware, notes);
            self.note_main(LogPart::Inter, firmware, notes);
        }
        self.note_gps_if_due(firmware, notes);
    }

    fn note_main(&self, frame: LogPart, firmware: &Firmware, notes: &mut Notes) {
        notes.main = MainState::of(firmware, self.schedule.iteration());
        notes.add(frame);
    }

    fn note_events(&mut self, firmware: &Firmware, notes: &mut Notes) {
        if let Some(armed_at) = self.events.beep.take() {
            notes.add(LogPart::Event(LogEvent::SyncBeep { time_us: armed_at.0 }));
        }
        let old = self.events.box_mask;
        let new = self.box_mask(firmware);
        if new != old {
            notes.add(LogPart::Event(LogEvent::FlightMode { new, old }));
        }
    }

    fn box_mask(&mut self, firmware: &Firmware) -> u32 {
        let switched = firmware.boxes();
        if switched != self.events.boxes {
            self.events.boxes = switched;
            self.events.box_mask = side_frames::box_mask(switched);
        }
        self.events.box_mask
    }

    fn note_slow_if_due(&mut self, firmware: &Firmware, notes: &mut Notes) {
        let boxes = self.box_mask(firmware);
        let values = side_frames::slow_values(firmware, boxes);
        let is_known = |known: SlowValues| std::iter::zip(known, values).all(|(known, value)| known == value);
        if !self.frames.slow.is_some_and(is_known) || self.frames.since_slow >= SLOW_EVERY {
            notes.add(LogPart::Slow(values));
            self.frames.slow = Some(values);
            self.frames.since_slow = 0;
        }
    }

    /// Notes home and solution if they changed. A log that lacks its beginning gets home again after a while.
    fn note_gps_if_due(&mut self, firmware: &Firmware, notes: &mut Notes) {
        let (gps, frames) = (&firmware.estimate().gps, &mut self.frames);
        let Some(solution) = gps.solution.as_ref().filter(|_| self.has_gps) else { return };
        let home = LoggedHome::of(firmware, frames.home.unwrap_or_default());
        let is_home_due = frames.home != Some(home) || frames.since_home >= HOME_EVERY;
        if is_home_due {
            notes.add(LogPart::Home(home.values()));
            frames.home = Some(home);
            frames.since_home = 0;
        }
        let seen = Some((solution.position, gps.sats));
        if is_home_due || frames.solution != seen {
            notes.add(LogPart::Gps(side_frames::gps_values(firmware, solution)));
            frames.solution = seen;
        }
    }
}
