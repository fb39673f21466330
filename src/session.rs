//! Owns the vehicle and the clock; takes commands, publishes snapshots and events.

mod arming;
pub mod command;
mod command_queue;
mod event_sender;
mod flight_feed;
mod flight_logs;
mod host_status;
mod late_answers;
mod links;
mod persistence;
pub mod policy;
mod real_time;
mod replay;
mod replay_view;
mod reply;
mod request_handler;
mod runtime;
mod seek;
mod simulator;
pub mod sitl;
mod waker;

pub use command::{Command, Seek, SessionView};
pub use flight_feed::{FeedReceiver, FlightFeed, FlightPart, flight_feed};
pub use links::{Links, MotorTargets, MotorsError};
pub use persistence::Persistence;
pub use replay::{ReplayConfig, ReplayStart, start_replay};
pub use replay_view::ReplayView;
pub use reply::ReplyTo;
pub use request_handler::{Handled, RequestHandler};
pub use runtime::{Endpoints, FlownBefore, Handle, SessionConfig, start, start_at};
