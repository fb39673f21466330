//! One log on its way into the index.

use std::sync::Arc;

use super::block::{Block, Extents, block_size};
use super::flight::{LogCounts, LogEnd, LogFlight};
use super::mark_log::{Flags, MarkLog};
use super::scale::Scales;
use super::signal::{Newest, SignalTable};
use super::track_log::TrackLog;
use super::tracker::Tracker;
use crate::blackbox::decode::{Frame, Header, HeaderFinding, LogReader, LogSource, ResumePoint};
use crate::blackbox::{FrameKind, LogEvent};
use crate::signals::SimTime;

/// Collects what a display needs to know about a log.
#[derive(Debug)]
pub(super) struct FlightBuilder {
    header: Arc<Header>,
    findings: Vec<HeaderFinding>,
    table: SignalTable,
    tracker: Tracker,
    block_size: u64,
    blocks: Vec<Block>,
    extents: Extents,
    marks: MarkLog,
    track: TrackLog,
    counts: LogCounts,
    /// The frames and bytes skipped before the first main frame.
    start: LogCounts,
    first: Option<SimTime>,
    last: SimTime,
    /// Bytes that were skipped after the last frame.
    skipped: u64,
    is_complete: bool,
}

impl FlightBuilder {
    pub(super) fn new(header: Arc<Header>, file_size: u64) -> Self {
        let scales = Scales::of(&header);
        let table = SignalTable::of(&header, &scales);
        Self {
            findings: scales.findings().to_vec(),
            block_size: block_size(file_size, table.signals.len()),
            extents: Extents::new(table.signals.len()),
            tracker: Tracker::from_header(&header),
            table,
            header,
            blocks: Vec::new(),
            marks: MarkLog::default(),
            track: TrackLog::default(),
            counts: LogCounts::default(),
            start: LogCounts::default(),
            first: None,
            last: SimTime::ZERO,
            skipped: 0,
            is_complete: false,
        }
    }

    /// Takes a frame. Returns `true` if a block begins with it.
    pub(super) fn frame(&mut self, frame: &Frame<'_>) -> bool {
        let before = Flags::of(&self.tracker.state.sample);
        self.tracker.take(frame);
        let sample = &self.tracker.state.sample;
        let time = SimTime(frame.time_us);
        match frame.kind {
            FrameKind::Intra | FrameKind::Inter => {
                self.counts.main += 1;
                if self.skipped > 0 {
                    self.marks.skipped(time, self.last, self.skipped);
                    self.counts.skipped_bytes += self.skipped;
                    self.skipped = 0;
                }
                self.first.get_or_insert(time);
                self.last = time;
            }
            FrameKind::Slow => {
                self.counts.slow += 1;
                self.marks.changed(time, before, Flags::of(sample));
            }
            FrameKind::Gps => {
                self.counts.gps += 1;
                self.track.offer(sample);
            }
            FrameKind::GpsHome | FrameKind::Event => {}
        }
        let begin = self.blocks.last().map_or(0, |block| block.point.offset);
        frame.kind == FrameKind::Intra && (self.blocks.is_empty() || frame.offset - begin >= self.block_size)
    }

    /// Returns `true` once a block has begun.
    pub(super) fn has_begun(&self) -> bool {
        !self.blocks.is_empty()
    }

    /// Begins a block with the frame that was just taken.
    pub(super) fn begin_block(&mut self, point: ResumePoint) {
        if self.blocks.is_empty() {
            let LogCounts { skipped_bytes, skipped_frames, .. } = self.counts;
            self.start = LogCounts { skipped_bytes, skipped_frames, ..LogCounts::default() };
        }
        let state = self.tracker.state.clone();
        self.blocks.push(Block { time: state.sample.time, point, state });
        self.extents.begin();
    }

    /// Widens the extents of the block to the frame that was just taken. At the start of a block they have all newest
    /// values.
    pub(super) fn widen<S: LogSource>(&mut self, kind: FrameKind, is_start: bool, reader: &LogReader<S>) {
        let newest = Newest {
            main: reader.newest(FrameKind::Intra),
            slow: reader.newest(FrameKind::Slow),
            gps: reader.newest(FrameKind::Gps),
            state: &self.tracker.state,
        };
        let others = [FrameKind::Slow, FrameKind::Gps];
        let kinds = others.iter().filter(|_| is_start).chain(std::iter::once(&kind));
        for kind in kinds.filter(|_| !self.blocks.is_empty()) {
            self.table.widen(*kind, &newest, self.extents.last_mut());
        }
    }

    /// Takes an event.
    pub(super) fn event(&mut self, event: LogEvent, time_us: u64) {
        let time = SimTime(time_us);
        let LogEvent::FlightMode { new, old } = event else {
            self.is_complete |= event == LogEvent::End;
            return self.marks.event(time, self.last, event, self.header.firmware);
        };
        if self.tracker.state.sample.boxes.is_none() {
            self.tracker.take_flags(old);
        }
        let before = Flags::of(&self.tracker.state.sample);
        self.tracker.take_flags(new);
        self.marks.changed(time, before, Flags::of(&self.tracker.state.sample));
    }

    /// Counts bytes that were skipped.
    pub(super) fn skip(&mut self, bytes: u64, frames: u64) {
        self.skipped += bytes;
        self.counts.skipped_frames += frames;
    }

    /// Returns the log after its end.
    pub(super) fn finish(self, number: usize) -> LogFlight {
        let first = self.first.unwrap_or_default();
        LogFlight {
            number,
            first,
            last: self.last.max(first),
            marks: self.marks.finish(first),
            track: self.track.finish(),
            home: self.tracker.state.home,
            start: self.start,
            end: LogEnd { counts: self.counts, cut_bytes: self.skipped, is_complete: self.is_complete },
            header: self.header,
            findings: self.findings,
            table: self.table,
            blocks: self.blocks,
            extents: self.extents,
        }
    }
}
