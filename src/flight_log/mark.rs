//! The instants of a log that a timeline shows.

use super::boxes::BoxFlags;
use super::failsafe_phase::FailsafePhase;
use crate::blackbox::AdjustedValue;
use crate::signals::SimTime;
use crate::telemetry::DisarmReason;

/// Something that happened at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogMark {
    pub time: SimTime,
    pub kind: LogMarkKind,
}

/// The things that happen in a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LogMarkKind {
    /// The craft was armed. The log has the beep for the synchronisation with a video.
    Armed,
    Disarmed(DisarmReason),
    /// The set of boxes that are on changed.
    Boxes {
        old: BoxFlags,
        new: BoxFlags,
    },
    FailsafePhase(FailsafePhase),
    /// The receiver signal was lost (`false`) or is back.
    RxSignal(bool),
    /// The GPS lost its fix (`false`) or has one.
    GpsFix(bool),
    /// A setting was adjusted in flight: the number of the function, and the value.
    Adjustment {
        function: u8,
        value: AdjustedValue,
    },
    /// Logging went on after a pause that began at `since`.
    Resumed {
        since: SimTime,
    },
    /// Bytes without a frame were skipped; the frame before them was at `since`.
    Skipped {
        since: SimTime,
        bytes: u64,
    },
    /// The log ends as it should.
    End,
}
