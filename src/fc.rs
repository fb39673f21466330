//! A remote flight controller: sends it the requests of this program and delivers its answers and reports.
//!
//! The protocol is a state machine without I/O and clock: `remote` takes bytes and requests and gives bytes
//! and events. In it, `client` exchanges messages and lines over the serial port, one after the other, `life`
//! is the phase of the connection, `polling` chooses the next message, `telemetry` decodes the replies, and
//! `observer` makes snapshots and events from them. `upload` and `provision` write a plan and settings,
//! `craft_settings` lists all settings, and `permission` decides what a real craft is asked to do.
//!
//! A craft that speaks MAVLink has `mavlink_craft` instead, with plans as `missions`. `protocol` is one of both.
//!
//! `remote_link` moves the data between this machine, the sockets and the vehicle, and `feed` gives a SITL
//! executable the states of the simulated craft. `stepped` does both for an executable in simulated time.
//! `tests` has boards whose answers the tests choose.

mod asked;
pub mod client;
mod craft_settings;
mod feed;
mod first_answer;
mod identify;
mod kept_flight;
mod life;
mod mavlink_craft;
pub mod missions;
mod observer;
mod patience;
mod permission;
pub mod polling;
mod protocol;
mod provision;
mod refresh;
pub mod remote;
mod remote_link;
mod reply;
mod rescue;
mod self_check;
mod setup;
mod starter;
mod stepped;
pub mod telemetry;
#[cfg(test)]
mod tests;
mod upload;
mod view;

pub use craft_settings::{Allowed, CraftSetting, CraftSettings, cli_block, same_value};
pub use kept_flight::KeptFlight;
pub use mavlink_craft::MavlinkCraft;
pub use observer::{Observer, Simulated};
pub use patience::{NotReady, Patience, Unready};
pub use permission::{Access, Denial, Impact, NOT_PERMITTED, NOTHING_MOVES, NOTHING_SIMULATED};
pub use protocol::Protocol;
pub use provision::{Provision, ProvisionLines, Unset, UnsetLine};
pub use remote::Remote;
pub use remote_link::{EXCHANGE_PAUSE, RemoteEnds, RemoteLink};
pub use rescue::NO_RETURN_SWITCH;
pub use starter::{guide_settings, starter_lines};
pub use upload::{LIST, Upload, UploadProgress, UploadReport, UploadView, plan_above_home, plan_of_list};
pub use view::{RemoteNotice, RemoteState, RemoteView};
