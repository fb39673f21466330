//! The conditions that switch modes on.

use super::reader::Reader;
use crate::signals::RC_CHANNELS;
use crate::telemetry::ModeBox;
use crate::telemetry::snapshot::ModeRange;

/// The index of the first AUX channel.
const AUX1: u8 = 4;
/// The pulse at step 0 of a range, µs.
const RANGE_START_US: u16 = 900;
/// The pulse difference per step of a range, µs.
const RANGE_STEP_US: u16 = 25;
/// The highest step of a range.
const RANGE_STEPS: u8 = 48;

/// Decodes `MODE_RANGES` and, if present, `MODE_RANGES_EXTRA`. Returns the conditions that depend on a
/// channel, without those that are linked to another mode and those of unknown boxes.
pub fn mode_ranges(ranges: &[u8], extra: Option<&[u8]>) -> Vec<ModeRange> {
    let links = extra.and_then(|extra| extra.get(1..)).unwrap_or_default();
    let linked = |at: usize| links.get(3 * at + 2).is_some_and(|linked| *linked != 0);
    ranges
        .chunks_exact(4)
        .enumerate()
        .filter(|(at, _)| !linked(*at))
        .filter_map(|(_, slot)| {
            let mut reader = Reader::new(slot);
            let mode_box = ModeBox::from_repr(reader.u8()?)?;
            let channel = reader.u8()?.saturating_add(AUX1);
            let [start_us, end_us] = [reader.u8()?, reader.u8()?]
                .map(|step| RANGE_START_US + RANGE_STEP_US * u16::from(step.min(RANGE_STEPS)));
            let is_used = start_us < end_us && usize::from(channel) < RC_CHANNELS;
            is_used.then_some(ModeRange { mode_box, channel, start_us, end_us })
        })
        .collect()
}
