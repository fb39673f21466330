//! An external simulator that moves the craft: its packets advance the time, and its silence stops it.

use std::time::{Duration, Instant};

use arrayvec::ArrayVec;

use super::flight_logs::FlightLogs;
use super::request_handler::RequestHandler;
use crate::events::{SessionEvent, SimulatorNotice};
use crate::link::endpoint::EndpointStatus;
use crate::link::proto::fdm::PacketError;
use crate::link::proto::fdm_link::PacketKind;
use crate::link::{ExternalSimulator, ImpairedLink, LinkImpairment};
use crate::session::event_sender::EventSender;
use crate::sim::LinkFaults;
use crate::telemetry::LinkState;
use crate::vehicle::{Vehicle, VehicleCommand};

/// The interval at which frames from sockets are repeated while time runs fast, µs of simulated time.
pub(super) const RC_REPEAT_US: u64 = 20_000;

/// The silence after which a simulator counts as paused instead of slow.
const PAUSE: Duration = Duration::from_secs(1);

/// The number of kinds of refusals. Each is reported once.
const REFUSALS: usize = 6;

/// The parts of the session that take part in the ticks.
#[derive(Debug)]
pub(super) struct Beside<'a> {
    pub(super) handler: &'a mut RequestHandler,
    pub(super) logs: &'a mut FlightLogs,
    /// The multiple of the wall clock at which simulated time has run.
    pub(super) speed: f64,
}

/// The external simulator of a session.
#[derive(Debug)]
pub(super) struct Simulator {
    link: ExternalSimulator,
    /// The impairments of the link through which its packets arrive.
    incoming: ImpairedLink,
    /// The last reported state.
    state: LinkState,
    /// The time of its last packet.
    received_at: Instant,
    reported_refusals: ArrayVec<PacketError, REFUSALS>,
    /// The wall and simulated time since the last query, without silences.
    passed: (Duration, Duration),
    /// `true` if the view should be updated at once.
    changed: bool,
}

impl Simulator {
    pub(super) fn new(link: ExternalSimulator, incoming: ImpairedLink, now: Instant) -> Self {
        Self {
            link,
            incoming,
            state: LinkState::Waiting,
            received_at: now,
            reported_refusals: ArrayVec::new(),
            passed: (Duration::ZERO, Duration::ZERO),
            changed: false,
        }
    }

    /// Returns the last reported state of the link.
    pub(super) fn state(&self) -> LinkState {
        self.state
    }

    /// Returns the longest wait until [`Self::poll`] must run.
    pub(super) fn longest_wait(&self, now: Instant) -> Duration {
        let due = self.incoming.due().map_or(self.link.due(), |arrives| arrives.min(self.link.due()));
        due.saturating_duration_since(now)
    }

    /// Returns `true` if an unsolicited packet is due. Packets that the simulator has sent by now come first:
    /// they are turned into requests.
    pub(super) fn read_before_sending(&self, now: Instant) -> bool {
        let is_due = self.link.due() <= now;
        if is_due {
            self.link.pass_on_queued();
        }
        is_due
    }

    /// Returns its status as an endpoint.
    pub(super) fn status(&self, now: Instant) -> EndpointStatus {
        self.link.status(now)
    }

    /// Takes a datagram that was sent at `at`. Flies on with the packets that have arrived by then, and returns the ticks.
    pub(super) fn receive(
        &mut self,
        datagram: Vec<u8>,
        at: Instant,
        vehicle: &mut Vehicle,
        events: &mut EventSender,
        beside: &mut Beside<'_>,
    ) -> u64 {
        self.end_faults(at, vehicle);
        self.incoming.send(datagram, at, &impairment(vehicle.link_faults()));
        self.take_arrived(at, vehicle, events, beside)
    }

    /// Flies on with the packets that have arrived by `now`, and returns the ticks.
    fn take_arrived(
        &mut self,
        now: Instant,
        vehicle: &mut Vehicle,
        events: &mut EventSender,
        beside: &mut Beside<'_>,
    ) -> u64 {
        let mut ticks = 0;
        while let Some((datagram, at)) = self.incoming.arrived(now) {
            ticks += self.fly(&datagram, at, vehicle, events, beside);
        }
        ticks
    }

    /// Ends link faults whose time is over. The firmware's time stops while nothing arrives, but the time of
    /// the faults that cause the silence continues.
    fn end_faults(&mut self, now: Instant, vehicle: &mut Vehicle) {
        if self.state != LinkState::Waiting {
            let silence = now.saturating_duration_since(self.received_at);
            self.changed |= vehicle.end_link_faults(silence.as_micros() as u64);
        }
    }

    fn fly(
        &mut self,
        datagram: &[u8],
        at: Instant,
        vehicle: &mut Vehicle,
        events: &mut EventSender,
        beside: &mut Beside<'_>,
    ) -> u64 {
        let received = self.link.receive(datagram, at, |sensors, ticks| {
            let mut frame = *sensors;
            for _ in 0..ticks {
                if vehicle.time().0.is_multiple_of(RC_REPEAT_US) {
                    beside.handler.keep_rc_fresh(vehicle, beside.speed, at);
                }
                vehicle.tick_on(&frame);
                beside.logs.after_tick(vehicle);
                // Inputs are held; a sample is new only once.
                (frame.pressure_pa, frame.mag_flu, frame.gps) = (None, None, None);
            }
            vehicle.controller().motors()
        });
        if let PacketKind::Refused(refusal) = received.kind {
            self.report_refusal(refusal, vehicle, events);
            return 0;
        }
        self.count_time(at, received.ticks, vehicle.step_us());
        self.report_return(at, vehicle, events);
        if received.kind == (PacketKind::Resync { restarted: true }) {
            vehicle.apply(&VehicleCommand::ResetCraft);
            beside.handler.after_restart(false, vehicle);
        }
        for notice in received.notices {
            self.changed = true;
            report(SimulatorNotice::Adapted(notice), vehicle, events);
        }
        if let Some(pose) = received.pose {
            vehicle.see(pose);
        }
        u64::from(received.ticks)
    }

    /// Processes the packets that are due by time, as [`Self::receive`] does, and returns the ticks. Sends
    /// unsolicited packets only when all packets that the simulator sent before have been received.
    pub(super) fn poll(
        &mut self,
        now: Instant,
        is_read: bool,
        vehicle: &mut Vehicle,
        events: &mut EventSender,
        beside: &mut Beside<'_>,
    ) -> u64 {
        self.end_faults(now, vehicle);
        let ticks = self.take_arrived(now, vehicle, events, beside);
        if is_read {
            self.link.poll(now);
        }
        if self.state == LinkState::Flowing && self.link.state(now) == LinkState::Silent {
            self.state = LinkState::Silent;
            self.changed = true;
            report(SimulatorNotice::Silent, vehicle, events);
        }
        ticks
    }

    /// Returns `true` if the view should be updated at once.
    pub(super) fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// Counts the time since the previous packet, unless the simulator paused.
    fn count_time(&mut self, at: Instant, ticks: u32, step_us: u64) {
        let wall = at.saturating_duration_since(self.received_at);
        if self.state == LinkState::Flowing && wall < PAUSE {
            self.passed.0 += wall;
            self.passed.1 += Duration::from_micros(u64::from(ticks) * step_us);
        }
    }

    /// Returns the wall and simulated time since the last call.
    pub(super) fn take_passed(&mut self) -> (Duration, Duration) {
        std::mem::take(&mut self.passed)
    }

    fn report_return(&mut self, at: Instant, vehicle: &mut Vehicle, events: &mut EventSender) {
        let silence = at.saturating_duration_since(std::mem::replace(&mut self.received_at, at));
        let before = std::mem::replace(&mut self.state, LinkState::Flowing);
        self.changed |= before != LinkState::Flowing;
        match before {
            LinkState::Waiting => report(SimulatorNotice::Connected, vehicle, events),
            LinkState::Silent => {
                report(SimulatorNotice::Resumed { silence_s: silence.as_secs_f64() }, vehicle, events);
            }
            LinkState::Flowing => {}
        }
    }

    fn report_refusal(&mut self, refusal: PacketError, vehicle: &mut Vehicle, events: &mut EventSender) {
        // The count of bad packets has changed.
        self.changed = true;
        if !self.reported_refusals.contains(&refusal) && self.reported_refusals.try_push(refusal).is_ok() {
            report(SimulatorNotice::Refused(refusal), vehicle, events);
        }
    }
}

/// Converts the simulated faults of the link to impairments.
fn impairment(faults: LinkFaults) -> LinkImpairment {
    let LinkFaults { stall, loss, late_ms, duplicated, jitter_ms } = faults;
    LinkImpairment { stall, loss, late_ms, duplicated, jitter_ms }
}

fn report(notice: SimulatorNotice, vehicle: &mut Vehicle, events: &mut EventSender) {
    events.report(vehicle, SessionEvent::Simulator(notice));
}
