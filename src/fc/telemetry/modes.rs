//! The conditions that switch modes on.

use crate::msp::{ModeLink, ModeSlot};
use crate::signals::RC_CHANNELS;
use crate::telemetry::ModeBox;
use crate::telemetry::snapshot::ModeRange;

/// The index of the first AUX channel.
const AUX1: u8 = 4;

/// Decodes `MODE_RANGES` and, if present, `MODE_RANGES_EXTRA`. Returns the conditions that depend on a
/// channel, without those that are linked to another mode and those of unknown boxes.
pub fn mode_ranges(ranges: &[u8], extra: Option<&[u8]>) -> Vec<ModeRange> {
    let mut links = ModeLink::decode_all(extra.unwrap_or_default());
    ModeSlot::decode_all(ranges)
        .filter(|_| links.next().is_none_or(|link| link.linked == 0))
        .filter_map(|ModeSlot { box_id, aux_channel, start_us, end_us }| {
            let mode_box = ModeBox::from_repr(box_id)?;
            let channel = aux_channel.saturating_add(AUX1);
            let is_used = start_us < end_us && usize::from(channel) < RC_CHANNELS;
            is_used.then_some(ModeRange { mode_box, channel, start_us, end_us })
        })
        .collect()
}
