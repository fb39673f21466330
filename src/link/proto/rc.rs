//! The RC datagram of scripts and joysticks: an unused timestamp and sixteen pulses.
//!
//! ```text
//! 0   f64       timestamp, s
//! 8   u16 × 16  pulses, µs: roll, pitch, throttle, yaw, AUX1 … AUX12
//! ```

use crate::signals::{RC_CHANNELS, RcFrame};

/// The size of the datagram. A shorter one is refused, a longer one is truncated.
pub const SIZE: usize = 8 + 2 * RC_CHANNELS;

/// Returns the timestamp (s) and the pulses of a datagram; `None` if it is too short.
pub fn decode(datagram: &[u8]) -> Option<(f64, RcFrame)> {
    let (stamp, rest) = datagram.split_first_chunk::<8>()?;
    let pulses = rest.get(..2 * RC_CHANNELS)?;
    let mut channels = [0; RC_CHANNELS];
    for (channel, pair) in channels.iter_mut().zip(pulses.as_chunks::<2>().0) {
        *channel = u16::from_le_bytes(*pair);
    }
    Some((f64::from_le_bytes(*stamp), RcFrame { channels }))
}

/// Returns the datagram of a frame.
pub fn encode(timestamp_s: f64, frame: &RcFrame) -> [u8; SIZE] {
    let mut datagram = [0; SIZE];
    let (stamp, pulses) = datagram.split_at_mut(8);
    stamp.copy_from_slice(&timestamp_s.to_le_bytes());
    for (pair, channel) in pulses.as_chunks_mut::<2>().0.iter_mut().zip(frame.channels) {
        *pair = channel.to_le_bytes();
    }
    datagram
}
