//! The frames of one log, without I/O.

use std::sync::Arc;

use super::super::event::LogEvent;
use super::super::field::FrameKind;
use super::bytes::{Bytes, Stop};
use super::clock::{Clock, Stamp};
use super::event::event;
use super::header::Header;
use super::layout::Layout;
use super::predict::Context;

/// The number of frames in a row after skipped bytes from which on frames without whole values are taken, too.
const TRUSTED: u32 = 3;
/// The most bytes of a frame that the header does not define.
const MAX_UNDEFINED: usize = 128;

/// The values of a log that outlast a frame: all that is needed to go on at a whole main frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DecoderState {
    clock: Clock,
    slow: Vec<i32>,
    home: Vec<i32>,
    gps: Vec<i32>,
    has_home: bool,
}

/// The kind of part with which the bytes begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Step {
    Frame {
        kind: FrameKind,
        length: usize,
    },
    /// An event; `None` for one without a meaning here.
    Event {
        event: Option<LogEvent>,
        length: usize,
    },
    /// A frame whose values cannot be used.
    UselessFrame {
        length: usize,
    },
    /// A frame that the header does not define.
    UndefinedFrame {
        length: usize,
    },
    /// A byte that belongs to no frame.
    StrayByte,
    /// More bytes are needed to tell.
    More,
}

/// The state machine of one log.
#[derive(Debug)]
pub(super) struct Decoder {
    header: Arc<Header>,
    state: DecoderState,
    /// The main frame being decoded, the last one, and the one before that.
    main: [Vec<i32>; 3],
    /// Another frame being decoded.
    other: Vec<i32>,
    /// `true` while differences can be decoded.
    is_synchronised: bool,
    /// `true` if the last main frame is whole, so that nothing before it counts.
    is_first: bool,
    /// The number of frames since the last stray byte.
    in_a_row: u32,
    home_at: Option<[usize; 2]>,
}

impl Decoder {
    pub(super) fn new(header: Arc<Header>) -> Self {
        let blank = |kind| vec![0; header.fields(kind).len()];
        let state = DecoderState {
            clock: Clock::default(),
            slow: blank(FrameKind::Slow),
            home: blank(FrameKind::GpsHome),
            gps: blank(FrameKind::Gps),
            has_home: false,
        };
        Self::resumed(header, state)
    }

    pub(super) fn resumed(header: Arc<Header>, state: DecoderState) -> Self {
        let main = std::array::from_fn(|_| vec![0; header.fields(FrameKind::Intra).len()]);
        let coordinate = |name| header.home.as_ref().and_then(|home| home.place(name));
        let home_at = coordinate("GPS_home[0]").zip(coordinate("GPS_home[1]")).map(|(lat, lon)| [lat, lon]);
        Self {
            main,
            home_at,
            header,
            state,
            other: Vec::new(),
            is_synchronised: false,
            is_first: true,
            in_a_row: TRUSTED,
        }
    }

    pub(super) fn state(&self) -> &DecoderState {
        &self.state
    }

    /// Returns the time of the last main frame, µs.
    pub(super) fn time_us(&self) -> u64 {
        self.state.clock.time_us()
    }

    /// Returns `true` if the place of home is known.
    pub(super) fn has_home(&self) -> bool {
        self.state.has_home
    }

    /// Returns the values of the last frame of a kind.
    pub(super) fn values(&self, kind: FrameKind) -> &[i32] {
        match kind {
            FrameKind::Intra | FrameKind::Inter => &self.main[1],
            FrameKind::Slow => &self.state.slow,
            FrameKind::GpsHome => &self.state.home,
            FrameKind::Gps => &self.state.gps,
            FrameKind::Event => &[],
        }
    }

    /// Decodes the start of `input`, which has at least a byte. `is_whole` is `true` if the log ends with `input`.
    pub(super) fn step(&mut self, input: &[u8], is_whole: bool) -> Step {
        match self.decoded(input, is_whole) {
            Ok(step) => {
                self.in_a_row = self.in_a_row.saturating_add(1);
                step
            }
            Err(Stop::Short) if !is_whole => Step::More,
            Err(_) => {
                self.is_synchronised = false;
                self.in_a_row = 0;
                Step::StrayByte
            }
        }
    }

    fn decoded(&mut self, input: &[u8], is_whole: bool) -> Result<Step, Stop> {
        let kind = input.first().and_then(|letter| self.kind(*letter)).ok_or(Stop::Wrong)?;
        let mut bytes = Bytes::new(&input[1..]);
        let mut found = None;
        let header = Arc::clone(&self.header);
        match header.layout(kind) {
            None if kind != FrameKind::Event => return self.undefined(input, is_whole),
            None => found = event(&mut bytes, header.firmware)?,
            Some(layout) => self.decode(kind, layout, &mut bytes)?,
        }
        let length = input.len() - bytes.remaining();
        let is_followed = match input.get(length) {
            _ if found == Some(LogEvent::End) => true,
            Some(letter) => self.kind(*letter).is_some(),
            None if is_whole => true,
            None => return Err(Stop::Short),
        };
        if !is_followed {
            return Err(Stop::Wrong);
        }
        let is_taken = match kind {
            FrameKind::Intra | FrameKind::Inter => self.take_main(kind),
            FrameKind::Event => self.take_event(found),
            FrameKind::Slow | FrameKind::GpsHome | FrameKind::Gps => self.take_other(kind),
        };
        Ok(match kind {
            _ if !is_taken => Step::UselessFrame { length },
            FrameKind::Event => Step::Event { event: found, length },
            _ => Step::Frame { kind, length },
        })
    }

    /// Returns the kind of frame that begins with this byte in this log.
    fn kind(&self, letter: u8) -> Option<FrameKind> {
        let kind = FrameKind::from_letter(letter)?;
        let header = &self.header;
        let is_known =
            kind == FrameKind::Event || header.layout(kind).is_some() || header.may_have_undefined(kind);
        is_known.then_some(kind)
    }

    /// Finds the end of a frame that the header does not define: the frames of the log go on there.
    fn undefined(&mut self, input: &[u8], is_whole: bool) -> Result<Step, Stop> {
        if !self.is_trusted() {
            return Err(Stop::Wrong);
        }
        for length in 1..input.len().min(MAX_UNDEFINED) {
            match self.goes_on(&input[length..], is_whole) {
                Ok(()) => return Ok(Step::UndefinedFrame { length }),
                Err(Stop::Short) if !is_whole => return Err(Stop::Short),
                // In a whole log no more bytes can tell that a short one is right.
                Err(_) => {}
            }
        }
        Err(if input.len() < MAX_UNDEFINED { Stop::Short } else { Stop::Wrong })
    }

    /// Returns `Ok` if frames that follow the last main frame begin here.
    fn goes_on(&mut self, input: &[u8], is_whole: bool) -> Result<(), Stop> {
        let mut rest = input;
        let mut has_main = false;
        for _ in 0..TRUSTED {
            let Some(letter) = rest.first() else {
                return if is_whole { Ok(()) } else { Err(Stop::Short) };
            };
            let kind = self.kind(*letter).ok_or(Stop::Wrong)?;
            let mut bytes = Bytes::new(&rest[1..]);
            let header = Arc::clone(&self.header);
            match header.layout(kind) {
                // Its end is found in its turn.
                None if kind != FrameKind::Event && has_main => return Ok(()),
                None if kind != FrameKind::Event => return Err(Stop::Wrong),
                None if event(&mut bytes, header.firmware)? == Some(LogEvent::End) => return Ok(()),
                None => {}
                Some(layout) => {
                    let read = self.decode(kind, layout, &mut bytes);
                    // The log may be cut inside a frame.
                    if read == Err(Stop::Short) && is_whole && has_main {
                        return Ok(());
                    }
                    read?;
                }
            }
            let is_main = matches!(kind, FrameKind::Intra | FrameKind::Inter);
            // Later frames are predicted from that frame, so only its own values are right.
            if is_main && !has_main && !self.state.clock.is_next(self.stamp()) {
                return Err(Stop::Wrong);
            }
            has_main |= is_main;
            rest = &rest[rest.len() - bytes.remaining()..];
        }
        if has_main { Ok(()) } else { Err(Stop::Wrong) }
    }

    /// Decodes a frame into its place for a frame that is not taken yet.
    fn decode(&mut self, kind: FrameKind, layout: &Layout, bytes: &mut Bytes<'_>) -> Result<(), Stop> {
        let last = self.state.clock.last();
        let [next, previous, before] = &mut self.main;
        let (values, previous, before): (_, &[i32], &[i32]) = match kind {
            FrameKind::Intra => (next, &[], &[]),
            FrameKind::Inter if self.is_first => (next, previous, previous),
            FrameKind::Inter => (next, previous, before),
            _ => (&mut self.other, &[], &[]),
        };
        let coordinate = |at: usize| self.state.home.get(at).copied().unwrap_or_default();
        let context = Context {
            previous,
            before,
            skipped: last.map_or(0, |last| self.header.interval.skipped_after(last.iteration)),
            home: self.home_at.map_or([0; 2], |places| places.map(coordinate)),
            main_time: last.map_or(0, |last| last.time as i32),
            constants: self.header.constants,
        };
        values.resize(layout.fields().len(), 0);
        layout.decode(bytes, values, &context)
    }

    /// Returns the stamp of the main frame being decoded.
    fn stamp(&self) -> Stamp {
        let value = |at: usize| self.main[0].get(at).copied().unwrap_or_default() as u32;
        Stamp { iteration: value(self.header.iteration_at), time: value(self.header.time_at) }
    }

    fn take_main(&mut self, kind: FrameKind) -> bool {
        let stamp = self.stamp();
        let clock = &mut self.state.clock;
        self.is_first = kind == FrameKind::Intra;
        self.is_synchronised =
            if self.is_first { clock.whole(stamp) } else { self.is_synchronised && clock.step(stamp) };
        if self.is_synchronised {
            self.main.rotate_right(1);
        }
        self.is_synchronised
    }

    fn is_trusted(&self) -> bool {
        self.is_synchronised || self.in_a_row >= TRUSTED
    }

    fn take_other(&mut self, kind: FrameKind) -> bool {
        if !self.is_trusted() {
            return false;
        }
        let values = match kind {
            FrameKind::Slow => &mut self.state.slow,
            FrameKind::GpsHome => {
                self.state.has_home = true;
                &mut self.state.home
            }
            _ => &mut self.state.gps,
        };
        std::mem::swap(values, &mut self.other);
        true
    }

    fn take_event(&mut self, event: Option<LogEvent>) -> bool {
        if event == Some(LogEvent::End) {
            return true;
        }
        if !self.is_trusted() {
            return false;
        }
        if let Some(LogEvent::Resume { iteration, time_us }) = event {
            self.state.clock.resume(Stamp { iteration, time: time_us as u32 });
        }
        true
    }
}
