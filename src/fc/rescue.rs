//! The return home of a remote firmware, which has a mode for it instead of a command.

use super::{RemoteLink, RemoteNotice};
use crate::telemetry::Mode;
use crate::telemetry::switch::{self, Switch};
use crate::vehicle::Vehicle;

impl RemoteLink {
    /// Moves the switch of GPS RESCUE.
    pub(super) fn switch_rescue(&mut self, vehicle: &mut Vehicle, on: bool) {
        match Switch::of(Mode::GpsRescue, &vehicle.controller().mode_ranges()) {
            Some(Switch { channel, on_us, off_us }) => {
                vehicle.transmitter_mut().sticks_mut().channels[channel] = if on { on_us } else { off_us };
                self.observer.deliver_again();
            }
            None => self.notices.push(RemoteNotice::Reported(
                "This firmware flies home only by a switch, and GPS RESCUE has none: assign one with the CLI command \
                 aux."
                    .to_owned(),
            )),
        }
    }

    /// Returns `true` while the switch that makes it fly home is on; `None` without such a switch.
    pub(super) fn rescue_switch(&self, vehicle: &Vehicle) -> Option<bool> {
        let mut ranges = self.observer.mode_ranges();
        let Switch { channel, .. } = Switch::of(Mode::GpsRescue, &ranges)?;
        ranges.retain(|range| usize::from(range.channel) == channel);
        Some(switch::is_on(Mode::GpsRescue, &ranges, &vehicle.transmitter().sticks().channels))
    }
}
