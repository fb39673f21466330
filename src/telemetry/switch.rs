//! The transmitter's switch for a mode, found from the craft's mode conditions.

use crate::signals::RC_CHANNELS;
use crate::telemetry::snapshot::ModeRange;
use crate::telemetry::{Mode, ModeBox};

/// A switch: its channel and the values that turn a mode on and off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Switch {
    /// Index of the channel.
    pub channel: usize,
    /// Value that turns the mode on, µs.
    pub on_us: u16,
    /// Value that turns the mode off, µs.
    pub off_us: u16,
}

impl Switch {
    /// Returns the first switch of a mode; `None` if no channel turns it on.
    pub fn of(mode: Mode, ranges: &[ModeRange]) -> Option<Self> {
        let range = own(mode, ranges).next()?;
        let channel = usize::from(range.channel).min(RC_CHANNELS - 1);
        let active = |us| own(mode, ranges).any(|other| other.channel == range.channel && other.contains(us));
        let off_us = [1000, 1500, 2000].into_iter().find(|&us| !active(us)).unwrap_or(1000);
        Some(Self { channel, on_us: range.start_us.midpoint(range.end_us), off_us })
    }
}

/// Returns `true` if these channels turn a mode on.
pub fn is_on(mode: Mode, ranges: &[ModeRange], channels: &[u16; RC_CHANNELS]) -> bool {
    own(mode, ranges)
        .any(|range| channels.get(usize::from(range.channel)).is_some_and(|&us| range.contains(us)))
}

/// Returns the ranges of a mode that contain any value.
fn own(mode: Mode, ranges: &[ModeRange]) -> impl Iterator<Item = &ModeRange> {
    let mode_box = ModeBox::from(mode);
    ranges.iter().filter(move |range| range.mode_box == mode_box && range.start_us < range.end_us)
}

#[cfg(test)]
mod tests {
    use crate::telemetry::switch::*;

    fn range(mode: Mode, channel: u8, start_us: u16, end_us: u16) -> ModeRange {
        ModeRange { mode_box: mode.into(), channel, start_us, end_us }
    }

    #[test]
    fn a_switch_is_found_where_the_craft_has_it() {
        let ranges = [
            range(Mode::Arm, 7, 1700, 1700),
            range(Mode::Arm, 7, 900, 1200),
            range(Mode::PosHold, 9, 1400, 1600),
        ];
        assert_eq!(Switch::of(Mode::Arm, &ranges), Some(Switch { channel: 7, on_us: 1050, off_us: 1500 }));
        assert_eq!(
            Switch::of(Mode::PosHold, &ranges),
            Some(Switch { channel: 9, on_us: 1500, off_us: 1000 })
        );
        assert_eq!(Switch::of(Mode::Autopilot, &ranges), None);
    }

    #[test]
    fn a_mode_is_on_while_its_channel_is_inside_a_range() {
        let ranges = [range(Mode::Angle, 4, 1700, 2100), range(Mode::Angle, 5, 900, 1300)];
        let channels = |aux1, aux2| {
            let mut channels = [1500; RC_CHANNELS];
            (channels[4], channels[5]) = (aux1, aux2);
            channels
        };
        assert!(is_on(Mode::Angle, &ranges, &channels(1700, 1500)));
        assert!(is_on(Mode::Angle, &ranges, &channels(1500, 1000)));
        assert!(!is_on(Mode::Angle, &ranges, &channels(1500, 1300)), "the end is outside");
        assert!(!is_on(Mode::Arm, &ranges, &channels(1700, 1000)));
    }
}
