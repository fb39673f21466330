//! Handles the requests of the links.
#![allow(clippy::disallowed_methods, reason = "this is where wall time meets simulated time")]

use std::task::{Context, Poll};
use std::time::{Duration, Instant};

use super::interface::restart_console;
use super::limits::{refuse_changing_request, refuse_request};
use super::{SLICE, Session};
use crate::events::SessionEvent;
use crate::link::Request;
use crate::link::proto::fdm::Packet;
use crate::runner::SPEED_RANGE;
use crate::runner::Subscriber;
use crate::session::event_sender::EventSender;
use crate::session::policy::REWOUND;
use crate::session::request_handler::{Handled, RequestHandler};
use crate::session::simulator::{Beside, RC_REPEAT_US, Simulator};
use crate::signals::RcSource;
use crate::telemetry::LinkState;
use crate::timeline::Timeline;
use crate::vehicle::{Vehicle, VehicleCommand};

/// The maximum wall time for requests in one round of the loop. The remaining requests wait for the next round.
const REQUEST_TIME: Duration = Duration::from_millis(1);

impl Session {
    /// Handles the waiting requests. Returns the ticks that an external simulator made the craft fly.
    pub(super) fn handle_requests(&mut self, context: &mut Context<'_>) -> u64 {
        // While time runs, the next view is due soon anyway.
        let access = self.access();
        let rewound_to = self.timeline.as_ref().and_then(Timeline::shown).map(Vehicle::time);
        self.vehicle.set_rewound(rewound_to.is_some());
        let time_stands_still = self.runner.pacer.is_paused() || !self.follows_wall_clock();
        let Some(endpoints) = &mut self.endpoints else { return 0 };
        let mut flown = 0;
        let until = Instant::now() + REQUEST_TIME;
        self.more_waits = true;
        let mut may_send = false;
        while flown < SLICE && Instant::now() < until {
            let Poll::Ready(Some(request)) = endpoints.requests.poll_recv(context) else {
                let is_due = |simulator: &Simulator| simulator.read_before_sending(Instant::now());
                if !may_send && self.simulator.as_ref().is_some_and(is_due) {
                    may_send = true;
                    continue;
                }
                self.more_waits = false;
                break;
            };
            // A simulator's packets change the view like time does, at their own rate.
            self.changed |= time_stands_still && !matches!(request, Request::Fdm { .. });
            let request = match refuse_request(request, access) {
                Ok(request) => request,
                Err(denial) => {
                    let connection = self.runner.link.as_ref().map(|link| link.protocol().connection());
                    self.refused_over.retain(|(over, _)| *over == connection);
                    if !self.refused_over.contains(&(connection, denial)) {
                        self.refused_over.push((connection, denial));
                        let notice = format!("A program at a door was refused: {denial}");
                        self.events.notice(&mut self.vehicle, notice);
                    }
                    continue;
                }
            };
            let request = match rewound_to {
                None => request,
                Some(shown) => match refuse_changing_request(request) {
                    Some(request) => request,
                    None => {
                        if !std::mem::replace(&mut self.refused_while_rewound, true) {
                            let notice = format!("A program at a door was refused a change: {REWOUND}");
                            self.events.notice_at(shown, notice);
                        }
                        continue;
                    }
                },
            };
            report_first_packets(
                &request,
                &mut self.rc_received,
                self.simulator.as_ref(),
                &mut self.vehicle,
                &mut self.events,
            );
            let (vehicle, persistence) = (&mut self.vehicle, &mut self.persistence);
            let Handled { notices, restarted, fdm } =
                endpoints.handler.handle(request, vehicle, persistence, Instant::now());
            for notice in notices {
                self.events.notice(&mut self.vehicle, notice);
            }
            if restarted {
                restart_console(&mut self.vehicle);
                self.events.report(&mut self.vehicle, SessionEvent::Restarted);
            }
            if let (Some((datagram, at)), Some(simulator)) = (fdm, &mut self.simulator) {
                let beside = &mut Beside {
                    handler: &mut endpoints.handler,
                    logs: self.persistence.logs(),
                    speed: self.runner.pacer.achieved(),
                };
                flown += simulator.receive(datagram, at, &mut self.vehicle, &mut self.events, beside);
            }
        }
        if let Some(simulator) = &mut self.simulator {
            let beside = &mut Beside {
                handler: &mut endpoints.handler,
                logs: self.persistence.logs(),
                speed: self.runner.pacer.achieved(),
            };
            let is_read = may_send && !self.more_waits;
            flown += simulator.poll(Instant::now(), is_read, &mut self.vehicle, &mut self.events, beside);
            self.changed |= simulator.take_changed();
        }
        if endpoints.status.has_changed().unwrap_or(false) {
            endpoints.status.mark_unchanged();
            self.changed = true;
        }
        self.yield_sticks();
        flown
    }

    /// Cuts the virtual sticks once RC comes over a link. At rest they would disarm the craft as soon as a
    /// script stops.
    fn yield_sticks(&mut self) {
        let controller = self.vehicle.controller();
        let from_link = matches!(controller.rc_source(), Some(RcSource::Udp | RcSource::Msp));
        if from_link && !controller.sticks_taken_over() && !self.vehicle.transmitter().is_cut() {
            for command in [VehicleCommand::CutRc(true), VehicleCommand::StopPilot] {
                let _done = self.vehicle.apply(&command);
            }
            // Without a recording there is no screen, and no key.
            let way_back = if self.timeline.is_some() { ", `x` takes them back" } else { "" };
            let notice = format!("RC now comes from another program: the virtual sticks are cut{way_back}.");
            self.events.notice(&mut self.vehicle, notice);
        }
    }
}

/// Repeats RC from sockets. A script sends fifty frames per second of wall time; at a higher speed the receiver would
/// detect a loss.
pub(super) struct FreshRc<'a> {
    pub(super) handler: &'a RequestHandler,
    /// The wanted multiple of real time.
    pub(super) speed: f64,
}

impl<F> Subscriber<F> for FreshRc<'_> {
    fn before_tick(&mut self, vehicle: &mut Vehicle) {
        if self.speed > 1.0 && vehicle.time().0.is_multiple_of(RC_REPEAT_US) {
            let speed = self.speed.min(*SPEED_RANGE.end());
            self.handler.keep_rc_fresh(vehicle, speed, Instant::now());
        }
    }
}

/// Reports the first RC of a script, and the states of a simulator until one was accepted.
fn report_first_packets(
    request: &Request,
    rc_received: &mut bool,
    simulator: Option<&Simulator>,
    vehicle: &mut Vehicle,
    events: &mut EventSender,
) {
    match request {
        Request::Rc { stamp_s, frame, .. } if !*rc_received => {
            *rc_received = true;
            events.report(vehicle, SessionEvent::FirstRc { stamp_s: *stamp_s, frame: *frame });
        }
        Request::Fdm { datagram, from, .. }
            if simulator.is_some_and(|simulator| simulator.state() == LinkState::Waiting) =>
        {
            if let Ok(packet) = Packet::parse(datagram) {
                let stamp_s = packet.stamp_s();
                events.report(vehicle, SessionEvent::FirstState { stamp_s, from: *from });
            }
        }
        _ => {}
    }
}
