//! A log in blocks: where reading can begin, and the extents of all signals.

use super::signal::Extent;
use super::tracker::TrackerState;
use crate::blackbox::decode::ResumePoint;
use crate::signals::SimTime;

/// The most bytes of the file in one block if the file is small.
const MIN_BLOCK: u64 = 4 * 1024;
/// The number of extents in all blocks of a file, about. Each takes 16 bytes.
const EXTENTS: u64 = 1 << 20;
/// The number of blocks of a file, about.
const BLOCKS: u64 = 1 << 14;

/// A part of a log that begins with a whole main frame.
#[derive(Debug, Clone)]
pub(super) struct Block {
    /// The time of its first frame.
    pub(super) time: SimTime,
    pub(super) point: ResumePoint,
    pub(super) state: TrackerState,
}

/// Returns the least number of bytes in a block for a log with so many signals, in a file of a size. All blocks of a file
/// take a limited amount of memory, whatever the sizes.
pub(super) fn block_size(file_size: u64, signals: usize) -> u64 {
    let by_extents = file_size.saturating_mul(signals as u64) / EXTENTS;
    MIN_BLOCK.max(by_extents).max(file_size / BLOCKS)
}

/// The extents of all signals in all blocks of a log.
#[derive(Debug, Clone, Default)]
pub(super) struct Extents {
    signals: usize,
    all: Vec<Extent>,
}

impl Extents {
    pub(super) fn new(signals: usize) -> Self {
        Self { signals, all: Vec::new() }
    }

    /// Begins a block.
    pub(super) fn begin(&mut self) {
        self.all.resize(self.all.len() + self.signals, Extent::NONE);
    }

    /// Returns the extents of the last block.
    pub(super) fn last_mut(&mut self) -> &mut [Extent] {
        let from = self.all.len().saturating_sub(self.signals);
        &mut self.all[from..]
    }

    /// Returns the extent of a signal in a block.
    pub(super) fn get(&self, block: usize, signal: usize) -> Extent {
        self.all.get(block * self.signals + signal).copied().unwrap_or(Extent::NONE)
    }
}
