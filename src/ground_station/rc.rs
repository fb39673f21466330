//! The sticks of ground stations.

use crate::mavlink::craft::{ChannelOverride, RcInput};
use crate::session::SessionView;
use crate::signals::RcFrame;

/// Returns the RC frame of a ground station. Channels that it does not give are those of the virtual sticks.
pub(super) fn rc_frame(view: &SessionView, input: &RcInput) -> RcFrame {
    let mut frame = view.sticks;
    match input {
        RcInput::Override(channels) => {
            for (channel, to) in frame.channels.iter_mut().zip(channels) {
                if let ChannelOverride::Set(us) = to {
                    *channel = (*us).clamp(885, 2115);
                }
            }
        }
        RcInput::Manual { pitch, roll, throttle, yaw, .. } => {
            // A stick pushed forward is a positive pitch there, and a high channel here.
            let sticks = [
                (0, roll, 500.0, 1500.0),
                (1, pitch, 500.0, 1500.0),
                (2, throttle, 1000.0, 1000.0),
                (3, yaw, 500.0, 1500.0),
            ];
            for (channel, share, span, zero) in sticks {
                if let Some(share) = share {
                    frame.channels[channel] = (zero + span * share).clamp(1000.0, 2000.0).round() as u16;
                }
            }
        }
    }
    frame
}
