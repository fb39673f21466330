//! The events of a log from bytes.

use super::super::event::{AdjustedValue, LogEvent};
use super::bytes::{Bytes, Stop};
use super::header::FirmwareName;

/// The start of the last event of a log.
const END: &[u8] = b"\xffEnd of log";
/// The continuation that INAV writes before a number and a parenthesis.
const END_REASON: &[u8] = b"(disarm reason:";

/// Reads an event after its letter. Returns `None` for an event that only old firmwares or those for developers write.
pub(super) fn event(bytes: &mut Bytes<'_>, firmware: FirmwareName) -> Result<Option<LogEvent>, Stop> {
    let mut rest = *bytes;
    let event = match rest.byte()? {
        0 => Some(LogEvent::SyncBeep { time_us: rest.unsigned_vb()?.into() }),
        // The phases, results and targets of an automatic tuning.
        10 => skipped(&mut rest, 5)?,
        11 => skipped(&mut rest, 4)?,
        12 => skipped(&mut rest, 8)?,
        13 => Some(adjustment(&mut rest)?),
        14 => Some(LogEvent::Resume { iteration: rest.unsigned_vb()?, time_us: rest.unsigned_vb()?.into() }),
        15 => Some(LogEvent::Disarm { reason: rest.unsigned_vb()? }),
        // The result of another tuning: axis, mean, gain.
        20 => {
            skipped(&mut rest, 1)?;
            rest.signed_vb()?;
            skipped(&mut rest, 2)?
        }
        30 => Some(LogEvent::FlightMode { new: rest.unsigned_vb()?, old: rest.unsigned_vb()? }),
        // A fault of the gyro with its number.
        40 if firmware == FirmwareName::Inav => {
            rest.unsigned_vb()?;
            None
        }
        // A stage of a latency test and its result.
        40 => skipped(&mut rest, 5)?,
        255 => {
            rest = *bytes;
            end(&mut rest)?;
            Some(LogEvent::End)
        }
        _ => return Err(Stop::Wrong),
    };
    *bytes = rest;
    Ok(event)
}

/// Reads the last event, which ends with a zero byte.
fn end(bytes: &mut Bytes<'_>) -> Result<(), Stop> {
    bytes.literal(END)?;
    if bytes.byte()? == 0 {
        return Ok(());
    }
    bytes.literal(END_REASON)?;
    while bytes.byte()?.is_ascii_digit() {}
    bytes.literal(b"\0")
}

fn skipped(bytes: &mut Bytes<'_>, count: usize) -> Result<Option<LogEvent>, Stop> {
    for _ in 0..count {
        bytes.byte()?;
    }
    Ok(None)
}

fn adjustment(bytes: &mut Bytes<'_>) -> Result<LogEvent, Stop> {
    let function = bytes.byte()?;
    let value = if function < 0x80 {
        AdjustedValue::Whole(bytes.signed_vb()?)
    } else {
        AdjustedValue::Float(f32::from_bits(bytes.little_endian(4)?))
    };
    Ok(LogEvent::Adjustment { function: function & 0x7f, value })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<Option<LogEvent>, Stop> {
        let mut rest = Bytes::new(bytes);
        let read = event(&mut rest, FirmwareName::Betaflight)?;
        assert_eq!(rest.remaining(), 0);
        Ok(read)
    }

    #[test]
    fn every_event() {
        assert_eq!(read(&[0, 0xac, 2]), Ok(Some(LogEvent::SyncBeep { time_us: 300 })));
        let whole = LogEvent::Adjustment { function: 5, value: AdjustedValue::Whole(-3) };
        assert_eq!(read(&[13, 5, 5]), Ok(Some(whole)));
        let float = LogEvent::Adjustment { function: 5, value: AdjustedValue::Float(1.0) };
        assert_eq!(read(&[13, 0x85, 0, 0, 0x80, 0x3f]), Ok(Some(float)));
        assert_eq!(read(&[14, 7, 9]), Ok(Some(LogEvent::Resume { iteration: 7, time_us: 9 })));
        assert_eq!(read(&[15, 4]), Ok(Some(LogEvent::Disarm { reason: 4 })));
        assert_eq!(read(&[30, 3, 1]), Ok(Some(LogEvent::FlightMode { new: 3, old: 1 })));
        assert_eq!(read(b"\xffEnd of log\0"), Ok(Some(LogEvent::End)));
        assert_eq!(read(b"\xffEnd of log (disarm reason:4)\0"), Ok(Some(LogEvent::End)));
        for old in [&[10, 1, 2, 3, 4, 5][..], &[11, 1, 2, 3, 4], &[12, 1, 2, 3, 4, 5, 6, 7, 8]] {
            assert_eq!(read(old), Ok(None));
        }
        assert_eq!(read(&[20, 0, 0xac, 2, 1, 1]), Ok(None));
        assert_eq!(read(&[40, 1, 0, 0, 0, 0]), Ok(None));
    }

    #[test]
    fn an_end_with_another_text_is_no_event() {
        assert_eq!(read(b"\xffEnd of Log\0"), Err(Stop::Wrong));
        assert_eq!(read(b"\xffEnd of"), Err(Stop::Short));
        assert_eq!(read(&[99]), Err(Stop::Wrong));
        assert_eq!(read(&[30, 3]), Err(Stop::Short));
    }

    #[test]
    fn event_40_of_inav_has_one_number() {
        let mut rest = Bytes::new(&[40, 2]);
        assert_eq!(event(&mut rest, FirmwareName::Inav), Ok(None));
        assert_eq!(rest.remaining(), 0);
    }
}
