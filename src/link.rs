//! The links through which configurators, scripts, simulators and command lines reach the vehicle.
//!
//! [`proto`] holds the protocols as pure state machines over bytes. They get the time from the caller and
//! never wait. Everything else here moves bytes between sockets and those machines, and turns the incoming
//! messages into [`Request`]s to the session: the files of this folder hold the doors, `notices` their
//! messages to the user, `fc_stream` the streams to a flight controller, and `sitl_child` the SITL executable
//! as a child process.
//!
//! ```text
//! tcp 5761 ──┐                                      ┌── Msp, EnterCli, Cli, LeftCli, Restart ─▶ session
//! ws  6761 ──┴─ listener ─ client ─ serial session ─┘                    ◀─ oneshot replies ──
//! udp 9004 ──── receive ── Rc  ──────────────────────────────────────────────────────────▶
//! udp 9003 ──── receive ── Fdm ────────────────────────────────────────────────▶ ImpairedLink ─▶ ExternalSimulator
//! udp 9002, 9001 ◀── MotorPort ◀──────────────────────────────────────────────────────────
//! ```

mod client;
mod client_stream;
pub mod conventions;
pub mod endpoint;
mod endpoint_stats;
mod external;
mod fc_stream;
mod impairment;
mod listener;
mod listeners;
mod notices;
mod origin;
pub mod proto;
mod request;
mod seats;
mod sitl_child;
mod sitl_peer;
mod udp;

pub use external::ExternalSimulator;
pub use fc_stream::{DEFAULT_BAUD, FcPlace, FcPlaceError, FcStream, StreamEvent};
pub use impairment::{ImpairedLink, LinkImpairment};
pub use listeners::{ListenConfig, ListenError, Listeners, RestartSignal};
pub use request::{ClientId, Request};
pub use sitl_child::lockstep;
pub use sitl_child::{ChildConfig, ChildEnd, ChildEvent, LaunchError, SitlChild, launch_firmware};
pub use sitl_peer::{MotorsInError, SitlPeer, SitlPorts};
pub use udp::{MotorPort, Sent, StateQueue};
