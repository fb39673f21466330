//! The firmware's side of an external simulator: [`FdmLink`] replies to its packets over a [`MotorPort`].

use std::time::{Duration, Instant};

use super::proto::fdm_link::{Counters, FdmLink, FdmLinkConfig, Received, Reply};
use super::proto::servo;
use super::udp::{MotorPort, Sent, StateQueue};
use crate::link::conventions::MotorOrder;
use crate::link::endpoint::{EndpointKind, EndpointState, EndpointStatus, SimulatorStats};
use crate::signals::{MotorCommand, PerMotor, SensorFrame};
use crate::telemetry::LinkState;

/// Drives a firmware with the packets of a simulator.
#[derive(Debug)]
pub struct ExternalSimulator {
    link: FdmLink,
    port: MotorPort,
    /// The queue in which its packets wait before they become requests.
    states: Option<StateQueue>,
    order: MotorOrder,
    started: Instant,
    pulses_us: PerMotor<f32>,
}

impl ExternalSimulator {
    /// Starts the link at `now` and sends a first packet with the motors at rest.
    pub fn start(config: FdmLinkConfig, order: MotorOrder, port: MotorPort, now: Instant) -> Self {
        let mut simulator = Self {
            link: FdmLink::new(config, 0),
            port,
            states: None,
            order,
            started: now,
            pulses_us: servo::pulses_us(&MotorCommand::default()),
        };
        simulator.send_servo();
        simulator.port.send_raw(simulator.pulses_us);
        simulator
    }

    /// Returns the simulator with the queue in which its packets wait.
    pub fn with_states(self, states: Option<StateQueue>) -> Self {
        Self { states, ..self }
    }

    /// Turns the packets that have arrived by now into requests. Call this first after waking: a packet that
    /// was queued before an unsolicited send is not the answer to it, however late it is read.
    pub fn pass_on_queued(&self) {
        if let Some(states) = &self.states {
            states.pass_on();
        }
    }

    /// Takes a datagram that arrived at `at`. If it describes the craft, `run` steps the firmware by the
    /// given number of ticks on those sensors and returns the motor command. The simulator gets the reply
    /// that it expects.
    pub fn receive(
        &mut self,
        datagram: &[u8],
        at: Instant,
        run: impl FnOnce(&SensorFrame, u32) -> MotorCommand,
    ) -> Received {
        let received = self.link.receive(datagram, self.micros(at));
        if let Some(sensors) = &received.sensors {
            self.pulses_us = servo::pulses_us(&run(sensors, received.ticks));
        }
        match received.reply {
            Reply::Nothing => {}
            Reply::Servo => self.send_servo(),
            Reply::Both => {
                self.send_servo();
                self.port.send_raw(self.pulses_us);
            }
        }
        received
    }

    /// Sends unsolicited packets that are due. Call [`Self::pass_on_queued`] and [`Self::receive`] first.
    pub fn poll(&mut self, now: Instant) {
        if self.link.poll(self.micros(now)) {
            self.send_servo();
        }
    }

    /// Returns the time at which [`Self::poll`] must run next.
    pub fn due(&self) -> Instant {
        self.started + Duration::from_micros(self.link.due_us())
    }

    /// Returns the state of the link to the simulator.
    pub fn state(&self, now: Instant) -> LinkState {
        self.link.state(self.micros(now))
    }

    /// Returns the address to which motor values are sent, and the state of the link to the simulator.
    pub fn status(&self, now: Instant) -> EndpointStatus {
        let Counters { senseless, old, .. } = self.link.counters();
        EndpointStatus {
            kind: EndpointKind::Motors,
            address: self.port.address().map_or_else(String::new, |address| address.to_string()),
            state: EndpointState::Simulator(SimulatorStats {
                link: self.state(now),
                dialect: self.link.dialect().map(Into::into),
                refused: senseless,
                old,
            }),
        }
    }

    fn send_servo(&mut self) {
        if self.port.send_servo(self.order.arrange(self.pulses_us)) == Sent::Refused {
            self.link.refused();
        }
    }

    fn micros(&self, at: Instant) -> u64 {
        at.saturating_duration_since(self.started).as_micros() as u64
    }
}
