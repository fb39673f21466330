//! Sticks that move and things that go wrong during a flight.

use crate::pilot::StickInput;
use crate::sim::ScheduledFault;

use super::{help, value};

/// Sticks that the pilot moves, and faults of the craft and the world.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct TroubleArgs {
    /// Moves a stick or switch: a channel (roll, pitch, throttle, yaw, aux1…aux12), µs, when, how long; repeatable
    #[arg(long, value_name = "CH=VALUE@T[,FOR]", help_heading = "Flight")]
    pub stick: Vec<StickInput>,

    /// The radio link is lost at T
    #[arg(long, value_name = "T[,FOR]", allow_hyphen_values = true, value_parser = value::rx_loss, help_heading = "Faults")]
    pub rx_loss_at: Option<ScheduledFault>,

    /// The GPS is lost at T
    #[arg(long, value_name = "T[,FOR]", allow_hyphen_values = true, value_parser = value::gps_loss, help_heading = "Faults")]
    pub gps_loss_at: Option<ScheduledFault>,

    /// Something goes wrong at T, such as motor@10,,2:0.8 or gps-glitch@10,2,30@90; repeatable
    #[arg(long, value_name = "NAME@T[,FOR][,VALUE]", value_parser = value::fault, long_help = help::faults(), help_heading = "Faults")]
    pub fault: Vec<ScheduledFault>,
}

impl TroubleArgs {
    /// Returns all faults of the flight.
    pub fn faults(&self) -> impl Iterator<Item = ScheduledFault> + '_ {
        self.rx_loss_at.into_iter().chain(self.gps_loss_at).chain(self.fault.iter().copied())
    }
}
