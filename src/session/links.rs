//! Opens the links of a session: the doors, and the socket for the motors of an external simulator.

use std::io;
use std::net::{IpAddr, SocketAddr};

use tokio::sync::{mpsc, watch};

use super::request_handler::RequestHandler;
use super::runtime::Endpoints;
use crate::link::endpoint::EndpointStatus;
use crate::link::{ExternalSimulator, ListenConfig, Listeners, MotorPort, Request};

/// The maximum number of requests that may wait for the session.
const WAITING: usize = 1024;

/// The destination of the motors of a craft that an external simulator moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MotorTargets {
    /// The machine of the simulator.
    pub ip: IpAddr,
    /// The port for motor commands, 0…1.
    pub motors: u16,
    /// The port for motor pulses, µs.
    pub raw: u16,
}

/// The error that there is no socket for the motors.
#[derive(Debug, thiserror::Error)]
#[error("cannot send motors to {to}: {error}")]
pub struct MotorsError {
    /// The destination.
    to: SocketAddr,
    /// The system's error.
    error: io::Error,
}

/// Open doors that are not yet connected to a session.
#[derive(Debug)]
pub struct Links {
    /// The doors. Some may have problems.
    pub doors: Listeners,
    requests: mpsc::Receiver<Request>,
    status: Vec<EndpointStatus>,
}

impl Links {
    /// Opens the doors. A door that cannot be opened appears among their problems; the others work.
    pub async fn open(config: &ListenConfig) -> Self {
        let (inbox, requests) = mpsc::channel(WAITING);
        let (doors, status) = Listeners::open(config, inbox).await;
        Self { doors, requests, status }
    }

    /// Returns the doors, the session's side of them, and the channel that publishes their state.
    pub fn endpoints(
        self,
        simulator: Option<ExternalSimulator>,
    ) -> (Listeners, Endpoints, watch::Sender<Vec<EndpointStatus>>) {
        let handler = RequestHandler::new(self.doors.restart_signal());
        let simulator = simulator.map(|simulator| simulator.with_states(self.doors.states()));
        let (publish, status) = watch::channel(self.status);
        (self.doors, Endpoints { requests: self.requests, handler, status, simulator }, publish)
    }
}

impl MotorTargets {
    /// Returns the destination of motor commands.
    pub fn motors(self) -> SocketAddr {
        SocketAddr::new(self.ip, self.motors)
    }

    /// Opens the socket for the motors. Sends nothing yet.
    ///
    /// # Errors
    /// Returns an error if there is no socket.
    pub fn open(self) -> Result<MotorPort, MotorsError> {
        let to = self.motors();
        MotorPort::open(to, SocketAddr::new(self.ip, self.raw)).map_err(|error| MotorsError { to, error })
    }
}
