//! The lines of `status` about the program around the firmware: unusable packets and lost real time.

use crate::firmware::cli::CliReply;
use crate::link::endpoint::BadPackets;
use crate::telemetry::LostTime;

use super::SessionView;

/// The figures of the last view.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct HostStatus {
    bad_packets: BadPackets,
    lost_time: LostTime,
}

impl HostStatus {
    pub(super) fn of(view: &SessionView) -> Self {
        Self { bad_packets: BadPackets::of(&view.endpoints), lost_time: view.lost_time }
    }

    /// Adds the lines to the reply if it is that of `status`.
    pub(super) fn add_to(&self, reply: &mut CliReply) {
        if !self.bad_packets.is_none() {
            reply.add_host_line(&format!("Bad packets: {}", self.bad_packets));
        }
        if self.lost_time.is_notable() {
            reply.add_host_line(&format!("Real time lost: {}", self.lost_time));
        }
    }
}
