//! The return home of a remote firmware, which has a mode for it instead of a command.

use super::observer::Observer;
use crate::signals::RC_CHANNELS;
use crate::telemetry::Mode;
use crate::telemetry::switch::{self, Switch};

/// The message if no switch makes it fly home.
pub const NO_RETURN_SWITCH: &str = "This firmware flies home only by a switch, and GPS RESCUE has none: assign one with the CLI command aux.";

/// Returns the channel of the switch that makes it fly home, and its pulse (µs) when it is on or off.
pub(super) fn position(observer: &Observer, on: bool) -> Option<(usize, u16)> {
    let Switch { channel, on_us, off_us } = Switch::of(Mode::GpsRescue, &observer.mode_ranges())?;
    Some((channel, if on { on_us } else { off_us }))
}

/// Returns the channel of the switch for AUTOPILOT, and its pulse (µs) when it is off. The return home must not compete with the
/// mission.
pub(super) fn autopilot_off(observer: &Observer) -> Option<(usize, u16)> {
    let Switch { channel, off_us, .. } = Switch::of(Mode::Autopilot, &observer.mode_ranges())?;
    Some((channel, off_us))
}

/// Returns `true` while the switch that makes it fly home is on; `None` without such a switch.
pub(super) fn is_on(observer: &Observer, channels: &[u16; RC_CHANNELS]) -> Option<bool> {
    let mut ranges = observer.mode_ranges();
    let Switch { channel, .. } = Switch::of(Mode::GpsRescue, &ranges)?;
    ranges.retain(|range| usize::from(range.channel) == channel);
    Some(switch::is_on(Mode::GpsRescue, &ranges, channels))
}
