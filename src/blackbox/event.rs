//! The events of a log.

/// An event between two frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LogEvent {
    /// The beep at arming, for the synchronisation with a video; µs.
    SyncBeep { time_us: u64 },
    /// A setting changed in flight: the number of the adjustment function (without its bit 7), and the new value.
    Adjustment { function: u8, value: AdjustedValue },
    /// The log goes on after a pause.
    Resume { iteration: u32, time_us: u64 },
    /// The craft was disarmed. The reason has the number of `telemetry`'s `DisarmReason`.
    Disarm { reason: u32 },
    /// The active boxes changed: bits by the index of the box in the order of the header.
    FlightMode { new: u32, old: u32 },
    /// The end of the log.
    End,
}

/// The value of an adjustment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AdjustedValue {
    Whole(i32),
    Float(f32),
}
