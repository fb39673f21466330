//! Complete flights. The scripted pilot flies the firmware and the world in lockstep.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::needless_pass_by_value,
    reason = "helpers of tests fail and show as tests do"
)]

mod air;
mod by_hand;
mod checks;
mod compass;
mod corners;
mod geofence;
mod gps;
mod hover;
mod landing;
mod landing_ends;
mod leaving;
mod monitors;
mod orbit;
mod path;
mod policies;
mod rates;
mod rescue;
mod return_home;
mod rig;
mod rx_loss;
mod script;
mod slope;
mod square;
mod station;
mod yaw;
