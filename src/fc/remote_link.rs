//! The links to a remote flight controller: moves the data between its program, its sockets, the protocol and
//! the vehicle.
//!
//! ```text
//!                    ┌── sensor and RC frames ──▶ Feed ───▶ UDP        (a SITL executable only)
//!  vehicle's mailbox ┤◀─ motors ─────────────────┘
//!                    ├── requests ──────────────▶ Remote ─▶ FcStream   (TCP, serial, websocket)
//!                    └◀─ answers, telemetry ──────┘
//! ```
//!
//! [`RemoteLink::exchange`] is called between two steps and does not block. In simulated time it waits for the step of the
//! executable, for a short time at most.

use std::task::{Context, Poll};
use std::time::{Duration, Instant};

use super::feed::Feed;
use super::kept_flight::{Copies, KeptFlight, place_of};
use super::mavlink_craft::MavlinkCraft;
use super::observer::Simulated;
use super::protocol::Protocol;
use super::remote::{Craft, Event, Input};
use super::self_check::SelfCheck;
use super::stepped::{StepEvent, Stepped};
use super::{Remote, RemoteNotice, RemoteState, rescue};
use crate::geo::LocalFrame;
use crate::link::endpoint::EndpointStatus;
use crate::link::lockstep::Lockstep;
use crate::link::proto::sitl_feed::FeedConfig;
use crate::link::{ChildEvent, FcStream, SitlChild, SitlPeer, StreamEvent};
use crate::signals::SimTime;
use crate::storage::state_file;
use crate::vehicle::{Vehicle, VehicleCommand};

/// The wall time before the next question to a flight controller that is not ready.
const QUESTION_PAUSE: Duration = Duration::from_millis(5);
/// The least wall time between two exchanges. Lost time is made up for at twice the speed.
pub const EXCHANGE_PAUSE: Duration = Duration::from_micros(500);
/// The maximum number of events of the child process between two steps. A process that prints much must not
/// hold up the craft.
const MAX_EVENTS: usize = 64;
/// The maximum number of pieces and bytes that are read between two steps, so that a flood from the peer does
/// not hold up the craft. Unread data holds up the peer.
const MAX_READ: usize = 64;
const MAX_BYTES: usize = 8 * 1024;
/// The greatest distance between the first fixes of two real craft for which the drawing keeps its origin, m.
const SAME_FIELD_M: f64 = 1000.0;

/// The links to a flight controller.
#[derive(Debug)]
pub struct RemoteEnds {
    /// The name for sentences: a file, or the address.
    pub name: String,
    pub stream: FcStream,
    /// The sockets for states, RC and motors, if it is a SITL executable.
    pub peer: Option<SitlPeer>,
    /// The process, if it is a child of this program.
    pub child: Option<SitlChild>,
}

/// The link to a remote flight controller.
#[derive(Debug)]
pub struct RemoteLink {
    protocol: Protocol,
    ends: Ends,
    started: Instant,
    notices: Vec<RemoteNotice>,
    /// The protocol at earlier steps of this run of an executable whose inputs are kept.
    earlier: Copies,
    /// The time of the vehicle of the newest step.
    stepped_at: SimTime,
}

/// The ends of the link, by the clock of the flight controller.
#[derive(Debug)]
#[allow(clippy::large_enum_variant, reason = "there is one of them")]
enum Ends {
    /// It runs on the wall clock.
    Wall { stream: FcStream, feed: Option<Feed>, child: Option<SitlChild> },
    /// It runs in simulated time, step by step with the craft.
    Steps(Stepped),
}

impl RemoteLink {
    /// Creates a link over these ends. A program that is a child of this one starts now.
    pub fn new(ends: RemoteEnds, now: Instant) -> Self {
        let RemoteEnds { name, stream, peer, child } = ends;
        let craft = Craft {
            name,
            place: stream.place.clone(),
            bytes_per_s: stream.bytes_per_s,
            is_fed: peer.is_some(),
            is_child: child.is_some(),
            is_in_steps: false,
        };
        let ends = Ends::Wall { stream, feed: peer.map(Feed::new), child };
        Self::over(Protocol::Msp(Box::new(Remote::new(craft, Duration::ZERO))), ends, now)
    }

    /// Creates a link to a craft that speaks MAVLink.
    pub fn mavlink(stream: FcStream, now: Instant) -> Self {
        let name = stream.place.clone();
        Self::over(
            Protocol::Mavlink(Box::new(MavlinkCraft::new(name))),
            Ends::Wall { stream, feed: None, child: None },
            now,
        )
    }

    fn over(protocol: Protocol, ends: Ends, now: Instant) -> Self {
        let (earlier, stepped_at) = (Copies::default(), SimTime::ZERO);
        Self { protocol, ends, started: now, notices: Vec::new(), earlier, stepped_at }
    }

    /// Creates a link to an executable that has booted in simulated time.
    pub fn in_steps(name: String, lockstep: Lockstep, feed: FeedConfig, now: Instant) -> Self {
        let place = place_of(&lockstep);
        let craft = Craft { name, place, bytes_per_s: None, is_fed: true, is_child: true, is_in_steps: true };
        let ends = (Remote::new(craft, Duration::ZERO), Stepped::new(lockstep, feed));
        Self::of_steps(ends, (Copies::default(), SimTime::ZERO), now)
    }

    /// Continues with an executable in simulated time after its newest step, at this time of the vehicle.
    pub(super) fn of_steps(
        (remote, steps): (Remote, Stepped),
        (earlier, stepped_at): (Copies, SimTime),
        now: Instant,
    ) -> Self {
        let link = Self::over(Protocol::Msp(Box::new(remote)), Ends::Steps(steps), now);
        Self { earlier, stepped_at, ..link }
    }

    /// Returns `true` if its flight since its boot can be flown again.
    pub fn keeps_past(&self) -> bool {
        matches!(&self.ends, Ends::Steps(steps) if steps.keeps_past())
    }

    /// Returns the flight of an executable in simulated time since its boot; `None` if its inputs are not kept.
    pub fn past(&mut self) -> Option<KeptFlight> {
        let Ends::Steps(steps) = &mut self.ends else { return None };
        let (run, feed) = steps.past()?;
        let (steps, elapsed) = (steps.steps_of_run(), steps.elapsed());
        Some(KeptFlight { run, feed, steps, elapsed, end: self.stepped_at, earlier: self.earlier.clone() })
    }

    /// Returns the protocol with the flight controller.
    pub fn protocol(&self) -> &Protocol {
        &self.protocol
    }

    /// Does the same as [`Self::protocol`], for its configuration and for permissions.
    pub fn protocol_mut(&mut self) -> &mut Protocol {
        &mut self.protocol
    }

    /// Returns `true` if this program feeds it with the states of the craft, at the rate of the steps.
    pub fn is_fed(&self) -> bool {
        self.feed().is_some() || self.is_in_steps()
    }

    /// Returns `true` if it runs in simulated time: an exchange is due after each step.
    pub fn is_in_steps(&self) -> bool {
        matches!(self.ends, Ends::Steps(_))
    }

    /// Returns a hash over the motor packets of an executable in simulated time and the times of their steps.
    pub fn motor_hash(&self) -> Option<u64> {
        match &self.ends {
            Ends::Wall { .. } => None,
            Ends::Steps(steps) => Some(steps.motor_hash()),
        }
    }

    /// Returns `true` while the craft must wait for the step of an executable in simulated time.
    pub fn is_busy(&self) -> bool {
        matches!(&self.ends, Ends::Steps(steps) if steps.is_busy())
    }

    fn feed(&self) -> Option<&Feed> {
        match &self.ends {
            Ends::Wall { feed, .. } => feed.as_ref(),
            Ends::Steps(_) => None,
        }
    }

    fn feed_mut(&mut self) -> Option<&mut Feed> {
        match &mut self.ends {
            Ends::Wall { feed, .. } => feed.as_mut(),
            Ends::Steps(_) => None,
        }
    }

    /// Returns the maximum number of steps of `step_us` at `speed` times real time that may be flown before
    /// the next exchange.
    pub fn most_steps(&self, step_us: u64, speed: f64, now: Instant) -> u64 {
        match &self.ends {
            Ends::Wall { feed, .. } => {
                feed.as_ref().map_or(u64::MAX, |feed| feed.most_steps(step_us, speed, now))
            }
            Ends::Steps(steps) => {
                if steps.is_busy() {
                    0
                } else {
                    u64::MAX
                }
            }
        }
    }

    /// Returns its status as an endpoint.
    pub fn status(&self, now: Instant) -> Option<EndpointStatus> {
        self.feed().map(|feed| feed.peer.status(now))
    }

    /// Returns the time until an exchange is due even if nothing arrives; `None` if none is.
    pub fn pause(&self, now: Instant) -> Option<Duration> {
        let due = self.protocol.timeout()?;
        let least = if due.is_zero() { QUESTION_PAUSE } else { EXCHANGE_PAUSE };
        Some(due.saturating_sub(self.since(now)).max(least))
    }

    /// Sends the contents of the vehicle's mailbox and delivers the data received since. Returns the notices
    /// for the user. If a context is given, the caller is woken when more data arrives over the serial port.
    pub fn exchange(
        &mut self,
        vehicle: &mut Vehicle,
        context: Option<&mut Context<'_>>,
        now: Instant,
    ) -> Vec<RemoteNotice> {
        if self.is_in_steps() {
            self.exchange_step(vehicle, now);
            return std::mem::take(&mut self.notices);
        }
        let since = self.since(now);
        self.follow_program(vehicle, since);
        self.read_stream(context, since);
        self.take_events(vehicle);
        self.empty_mailbox(vehicle, now);
        self.protocol.handle_timeout(since);
        while let Some(output) = self.protocol.poll_transmit() {
            if let Ends::Wall { stream, .. } = &self.ends {
                // A full queue means that the stream carries nothing any more. The client gives the request up.
                drop(stream.to.try_send(output));
            }
        }
        self.take_events(vehicle);
        self.observe(vehicle, since);
        std::mem::take(&mut self.notices)
    }

    /// Runs the executable's step for the vehicle's newest one, if there is one.
    fn exchange_step(&mut self, vehicle: &mut Vehicle, now: Instant) {
        let Ends::Steps(steps) = &mut self.ends else { return };
        let since = steps.elapsed();
        if !steps.is_busy() {
            if let Some(mailbox) = vehicle.remote_mut() {
                steps.take_frames(mailbox);
                while let Some((ticket, request)) = mailbox.take_request() {
                    self.protocol.handle(Input::Requested(ticket, request), since);
                }
            }
            self.protocol.handle_timeout(since);
            while let Some(output) = self.protocol.poll_transmit() {
                steps.send(&output);
            }
        }
        let before = steps.steps_of_run();
        steps.run(vehicle.remote_mut(), now);
        if steps.steps_of_run() > before {
            self.stepped_at = vehicle.time();
        }
        let since = steps.elapsed();
        if steps.sends_motors {
            self.protocol.handle(Input::SentMotors, since);
        }
        while let Some(event) = self.step_event() {
            match event {
                StepEvent::Connected => self.protocol.handle(Input::Connected, since),
                StepEvent::Received(bytes) => self.protocol.handle(Input::Received(&bytes), since),
                StepEvent::Ended { how, is_reboot } => {
                    self.earlier.clear();
                    self.protocol.handle(Input::Ended { how: &how, is_reboot }, since);
                    self.protocol.handle(Input::Lost("it restarts"), since);
                }
                StepEvent::NotStarted(reason) => self.protocol.handle(Input::NotStarted(&reason), since),
                StepEvent::Unusable(why) => self.protocol.handle(Input::Unusable(why), since),
                StepEvent::Notice(notice) => self.notices.push(notice),
            }
        }
        self.follow_program(vehicle, since);
        self.take_events(vehicle);
        self.observe(vehicle, since);
        self.keep_earlier();
    }

    /// Keeps the protocol once in a while, for a flight from an earlier instant.
    fn keep_earlier(&mut self) {
        if let Ends::Steps(steps) = &self.ends
            && steps.keeps_past()
            && !steps.is_busy()
            && let Some(remote) = self.protocol.msp()
        {
            self.earlier.keep(steps.steps_of_run(), steps.elapsed(), remote);
        }
    }

    fn step_event(&mut self) -> Option<StepEvent> {
        match &mut self.ends {
            Ends::Steps(steps) => steps.poll_event(),
            Ends::Wall { .. } => None,
        }
    }

    /// Returns the time of the protocol: that of the steps, or wall time.
    pub fn protocol_time(&self, now: Instant) -> Duration {
        match &self.ends {
            Ends::Steps(steps) => steps.elapsed(),
            Ends::Wall { .. } => self.since(now),
        }
    }

    fn since(&self, now: Instant) -> Duration {
        now.saturating_duration_since(self.started)
    }

    /// Reports the events of its program.
    fn follow_program(&mut self, vehicle: &mut Vehicle, since: Duration) {
        for _ in 0..MAX_EVENTS {
            let event = match &mut self.ends {
                Ends::Wall { child, .. } => child.as_mut().and_then(SitlChild::take_event),
                Ends::Steps(steps) => steps.take_output(),
            };
            let Some(event) = event else { return };
            match event {
                ChildEvent::Started => {}
                ChildEvent::Line(line) => self.notices.push(RemoteNotice::Output(line)),
                ChildEvent::NotShown(count) => self.notices.push(RemoteNotice::Reported(format!(
                    "Lines of the firmware's output that were not shown: {count}."
                ))),
                ChildEvent::Failed(reason) => self.protocol.handle(Input::NotStarted(&reason), since),
                ChildEvent::Ended(end) => {
                    let ended = Input::Ended { how: &end.to_string(), is_reboot: end.is_reboot() };
                    self.protocol.handle(ended, since);
                }
            }
            // Notices keep the order of the events, and a program that is given up has no further ones.
            self.take_events(vehicle);
        }
    }

    /// Reads the data that has arrived over the serial port.
    fn read_stream(&mut self, mut context: Option<&mut Context<'_>>, since: Duration) {
        let Ends::Wall { stream, .. } = &mut self.ends else { return };
        let mut read = 0;
        for _ in 0..MAX_READ {
            if read >= MAX_BYTES {
                break;
            }
            let event = match &mut context {
                Some(context) => match stream.from.poll_recv(context) {
                    Poll::Ready(event) => event,
                    Poll::Pending => None,
                },
                None => stream.from.try_recv().ok(),
            };
            match event {
                None => return,
                Some(StreamEvent::Bytes(bytes)) => {
                    read += bytes.len();
                    self.protocol.handle(Input::Received(&bytes), since);
                }
                Some(StreamEvent::Connected) => self.protocol.handle(Input::Connected, since),
                Some(StreamEvent::Notice(sentence)) => self.notices.push(RemoteNotice::Reported(sentence)),
                Some(StreamEvent::Lost(reason)) => self.protocol.handle(Input::Lost(&reason), since),
            }
        }
        // The queue was not polled until it was empty, so no wake-up is registered.
        if let Some(context) = context {
            context.waker().wake_by_ref();
        }
    }

    /// Carries the frames and requests of the vehicle to the flight controller.
    fn empty_mailbox(&mut self, vehicle: &mut Vehicle, now: Instant) {
        let since = self.since(now);
        let Some(mailbox) = vehicle.remote_mut() else { return };
        let Ends::Wall { feed, .. } = &mut self.ends else { return };
        match feed {
            Some(feed) => {
                self.notices.extend(feed.exchange(mailbox, now));
                if feed.has_motors() {
                    self.protocol.handle(Input::SentMotors, since);
                }
            }
            None => while mailbox.take_frame().is_some() {},
        }
        while let Some((ticket, request)) = mailbox.take_request() {
            self.protocol.handle(Input::Requested(ticket, request), since);
        }
    }

    /// Applies the consequences for the vehicle, the program and the user.
    fn take_events(&mut self, vehicle: &mut Vehicle) {
        while let Some(event) = self.protocol.poll_event() {
            match event {
                Event::Notice(notice) => self.notices.push(notice),
                Event::Answered(ticket, answer) => {
                    if let Some(mailbox) = vehicle.remote_mut() {
                        mailbox.deliver_answer(ticket, answer);
                    }
                }
                Event::Restarted(notice) => {
                    if let Some(feed) = self.feed_mut() {
                        feed.peer.went_down();
                    }
                    vehicle.remote_restarted();
                    self.notices.push(RemoteNotice::Restarted(notice));
                }
                Event::CameUp => {
                    if let Some(feed) = self.feed_mut() {
                        feed.peer.came_up();
                    }
                }
                Event::WentDown => {
                    if let Some(feed) = self.feed_mut() {
                        feed.peer.went_down();
                    }
                }
                Event::BecameReady => match &mut self.ends {
                    Ends::Wall { feed, .. } => feed.iter_mut().for_each(Feed::became_ready),
                    Ends::Steps(steps) => steps.self_check = SelfCheck::default(),
                },
                Event::GivenUp => match &mut self.ends {
                    Ends::Wall { child, .. } => *child = None,
                    Ends::Steps(steps) => steps.give_up(),
                },
                Event::Configured(file, words) => {
                    if let Err(error) = state_file::replace(&file, words.as_bytes()) {
                        let place = file.display();
                        self.notices.push(RemoteNotice::Lost(format!("Cannot write {place}: {error}.")));
                    }
                }
                Event::Switched(channel, pulse_us) => {
                    // The scripted pilot would move the switch back.
                    vehicle.apply(&VehicleCommand::StopPilot);
                    let mut sticks = vehicle.transmitter().sticks();
                    sticks.channels[channel] = pulse_us;
                    vehicle.apply(&VehicleCommand::Sticks(sticks));
                }
            }
        }
    }

    /// Delivers the observations and handles their consequences.
    fn observe(&mut self, vehicle: &mut Vehicle, since: Duration) {
        let is_fed = self.is_fed();
        let is_ready = self.protocol.view().state == RemoteState::Ready;
        let trusts_mag = self.protocol.msp().is_some_and(|remote| remote.observer().trusts_mag());
        self.notices.extend(match &mut self.ends {
            Ends::Wall { feed, .. } => {
                feed.as_mut().and_then(|feed| feed.check_at_rest(vehicle, is_ready, trusts_mag, since))
            }
            Ends::Steps(steps) => {
                let dialect = steps.feed().config().dialect;
                steps.self_check.look(dialect, vehicle, is_ready && steps.sends_motors, trusts_mag, since)
            }
        });
        if let Some(seen) = self.protocol.first_fix()
            && !vehicle.local_frame().is_some_and(|frame| is_fed || is_near(frame, &seen))
        {
            vehicle.set_origin(seen);
        }
        let frame = vehicle.local_frame().copied();
        let channels = vehicle.transmitter().newest().channels;
        let simulated = self.protocol.msp().filter(|_| is_fed).map(|remote| Simulated {
            home_m: frame.map(|frame| frame.alt_amsl_m),
            commanded: rescue::is_on(remote.observer(), &channels),
        });
        if let Some(mailbox) = vehicle.remote_mut() {
            self.protocol.deliver(mailbox, frame.as_ref(), simulated, since);
        }
    }
}

/// Returns `true` if a drawing around one place also shows the other undistorted.
fn is_near(frame: &LocalFrame, other: &LocalFrame) -> bool {
    frame.to_enu(other.lat_deg, other.lon_deg, other.alt_amsl_m).xy().norm() < SAME_FIELD_M
}

#[cfg(test)]
mod tests;
