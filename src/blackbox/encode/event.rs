//! Events as bytes.

use super::LogWriter;
use crate::blackbox::{AdjustedValue, FrameKind, LogEvent};

/// The numbers of the events.
const SYNC_BEEP: u8 = 0;
const ADJUSTMENT: u8 = 13;
const RESUME: u8 = 14;
const DISARM: u8 = 15;
const FLIGHT_MODE: u8 = 30;
const END: u8 = 255;

/// Added to the number of an adjustment function whose value is a float.
const IS_FLOAT: u8 = 0x80;

impl LogWriter<'_> {
    /// Writes an event. Times have 32 bits and start again after 71 minutes, as in the frames.
    pub fn event(&mut self, event: &LogEvent) {
        self.byte(FrameKind::Event.letter());
        match *event {
            LogEvent::SyncBeep { time_us } => {
                self.byte(SYNC_BEEP);
                self.unsigned_vb(time_us as u32);
            }
            LogEvent::Adjustment { function, value } => {
                self.byte(ADJUSTMENT);
                match value {
                    AdjustedValue::Whole(value) => {
                        self.byte(function & !IS_FLOAT);
                        self.signed_vb(value);
                    }
                    AdjustedValue::Float(value) => {
                        self.byte(function | IS_FLOAT);
                        self.all(&value.to_le_bytes());
                    }
                }
            }
            LogEvent::Resume { iteration, time_us } => {
                self.byte(RESUME);
                self.unsigned_vb(iteration);
                self.unsigned_vb(time_us as u32);
            }
            LogEvent::Disarm { reason } => {
                self.byte(DISARM);
                self.unsigned_vb(reason);
            }
            LogEvent::FlightMode { new, old } => {
                self.byte(FLIGHT_MODE);
                self.unsigned_vb(new);
                self.unsigned_vb(old);
            }
            LogEvent::End => {
                self.byte(END);
                self.all(b"End of log\0");
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::buffer::written;
    use super::*;

    #[test]
    fn events_have_their_numbers_and_values() {
        let written = |event| written(|log| log.event(&event));
        assert_eq!(written(LogEvent::SyncBeep { time_us: (1 << 32) + 300 }), [b'E', 0, 0xac, 2]);
        assert_eq!(written(LogEvent::Resume { iteration: 1, time_us: 2 }), [b'E', 14, 1, 2]);
        assert_eq!(written(LogEvent::Disarm { reason: 4 }), [b'E', 15, 4]);
        assert_eq!(written(LogEvent::FlightMode { new: 3, old: 1 }), [b'E', 30, 3, 1]);
        assert_eq!(written(LogEvent::End), b"E\xffEnd of log\0");
        let whole = LogEvent::Adjustment { function: 5, value: AdjustedValue::Whole(-3) };
        assert_eq!(written(whole), [b'E', 13, 5, 5]);
        let float = LogEvent::Adjustment { function: 5, value: AdjustedValue::Float(1.0) };
        assert_eq!(written(float), [b'E', 13, 0x85, 0, 0, 0x80, 0x3f]);
    }
}
