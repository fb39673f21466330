//! Owns the vehicle and the clock; takes commands, publishes snapshots and events.

mod arming;
pub mod command;
mod event;
mod fly_again;
mod forecaster;
mod hazards;
mod host_status;
mod late_answers;
mod links;
mod pacer;
mod persistence;
pub mod policy;
mod real_time;
mod replay;
mod reply;
mod request_handler;
mod runner;
mod runtime;
mod seek;
mod simulator;
pub mod sitl;
mod waker;

pub use command::{Command, Seek, SessionView};
pub use event::{EndpointAddresses, Event, SessionEvent};
pub use fly_again::{FlownAgain, FlyAgain, Progress};
pub use forecaster::{ForecastJob, ForecastReply, ForecastRequest, Forecaster};
pub use hazards::hazards;
pub use links::{Links, MotorTargets, MotorsError};
pub use pacer::SPEED_RANGE;
pub use persistence::Persistence;
pub use replay::{ReplayConfig, ReplayNotice, ReplayStart, ReplayView, start_replay};
pub use reply::ReplyTo;
pub use request_handler::{Handled, RequestHandler};
pub use runner::{Flying, Runner, Stopped, Subscriber};
pub use runtime::{Endpoints, FlownBefore, Handle, SessionConfig, Subscription, start, start_at};
pub use simulator::SimulatorNotice;
