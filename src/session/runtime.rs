//! The thread that owns the vehicle: takes commands and requests, runs the due ticks, publishes views and events.
//!
//! `commands` carries out the commands of the user interface, `requests` those of the links. `interface` passes the
//! requests of the user interface to the flight controller and returns the answers. `limits` answers refused
//! commands, and refuses requests of clients that are not allowed on a real craft. `rewind` shows earlier instants and continues the flight from them.
#![allow(clippy::disallowed_methods, reason = "this is where wall time meets simulated time")]

mod commands;
mod interface;
mod limits;
mod requests;
mod rewind;

use std::any::Any;
use std::task::Context;
use std::time::{Duration, Instant};

use tokio::sync::{mpsc, watch};

use super::arming::ArmingWatch;
use super::command::{Command, SessionView};
use super::command_queue::CommandQueue;
use super::event_sender::EventSender;
use super::flight_feed::FlightFeed;
use super::host_status::HostStatus;
use super::persistence::Persistence;
use super::real_time::RealTime;
use super::request_handler::RequestHandler;
use super::simulator::Simulator;
use super::waker;
use crate::events::Notice;
use crate::events::{Event, SessionEvent};
use crate::fc::{Access, Denial, RemoteLink, RemoteNotice};
use crate::link::endpoint::EndpointStatus;
use crate::link::{ExternalSimulator, ImpairedLink, Request};
use crate::lookahead::{FlyAgain, FlyingAgain};
use crate::runner::{Runner, Subscriber};
use crate::signals::SimTime;
use crate::sim::Stream;
use crate::storage::Store;
use crate::telemetry::{FirmwareProfile, LinkState};
use crate::timeline::Timeline;
use crate::vehicle::Vehicle;
use interface::{Interface, Outcome, UploadTo};
pub(super) use limits::refuse_command;
use rewind::RunOn;

/// The interval of published views.
const VIEW_INTERVAL: Duration = Duration::from_millis(16);
/// The longest sleep of the loop while time is paced.
const PACED_SLEEP: Duration = Duration::from_millis(2);
/// The longest sleep of the loop while nothing moves.
const PAUSED_SLEEP: Duration = Duration::from_millis(8);
/// The number of ticks between two checks of the clock and the commands.
const SLICE: u64 = 500;

/// The session's side of the endpoints.
#[derive(Debug)]
pub struct Endpoints {
    /// The requests of clients, scripts and simulators.
    pub requests: mpsc::Receiver<Request>,
    pub handler: RequestHandler,
    /// The status of the endpoints.
    pub status: watch::Receiver<Vec<EndpointStatus>>,
    /// The simulator that moves the craft, if the physics is external.
    pub simulator: Option<ExternalSimulator>,
}

/// The initial state of a session.
#[derive(Debug)]
pub struct SessionConfig {
    /// The vehicle at boot.
    pub vehicle: Vehicle,
    /// The storage for `save`.
    pub store: Store,
    /// `true` if a craft without mode conditions gets the starter modes at every restart.
    pub starter_modes: bool,
    /// The multiple of real time at the start; infinite = as fast as possible.
    pub speed: f64,
    /// The altitude to which the scripted pilot climbs, m.
    pub takeoff_m: f64,
    /// `true` to keep a recording, so that earlier instants can be shown. Without a screen it is not needed.
    pub is_recorded: bool,
    /// The endpoints, if any are open. They make the flight live.
    pub endpoints: Option<Endpoints>,
    /// The link to the vehicle's flight controller, if that is remote.
    pub remote: Option<RemoteLink>,
    /// The events that are reported first, after the boot.
    pub first_events: Vec<SessionEvent>,
}

/// A flight that was flown before the session began.
#[derive(Debug)]
pub struct FlownBefore {
    pub timeline: Timeline,
    /// The events of the flight.
    pub events: Vec<Event>,
    /// The instant to show.
    pub show: SimTime,
    /// Flies it again, if it was flown by a remote firmware that has ended.
    pub again: Option<FlyAgain>,
}

/// The caller's ends of a running session.
#[derive(Debug)]
pub struct Handle {
    pub commands: mpsc::Sender<Command>,
    /// Commands of other programs, which do not count in [`SessionView::commands_taken`].
    pub orders: mpsc::Sender<Command>,
    pub view: watch::Receiver<SessionView>,
    /// Every event, in order.
    pub events: mpsc::UnboundedReceiver<Event>,
    /// The thread. It ends on [`Command::Quit`] or when all senders are gone. It also ends by itself when
    /// there is no usable flight controller, and then returns the reason as a sentence.
    pub thread: std::thread::JoinHandle<Option<String>>,
}

/// Formats a speed as a multiple of real time.
fn factor(speed: f64) -> String {
    if speed.is_infinite() { "full speed".to_owned() } else { format!("{speed}×") }
}

/// Starts the session's thread.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub fn start(config: SessionConfig) -> std::io::Result<Handle> {
    start_at(config, None, None)
}

/// Starts the session's thread. With `flown`, the vehicle is in the state after that flight, one instant of the
/// flight is shown, and time is paused. `feed` records the flights of the session.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub fn start_at(
    config: SessionConfig,
    flown: Option<FlownBefore>,
    feed: Option<FlightFeed>,
) -> std::io::Result<Handle> {
    let (command_tx, command_rx) = mpsc::channel(256);
    let (order_tx, order_rx) = mpsc::channel(64);
    let (event_tx, event_rx) = mpsc::unbounded_channel();
    let mut session = Session::new(config, flown, feed, (command_rx, event_tx));
    session.orders = CommandQueue::new(order_rx);
    let (view_tx, view_rx) = watch::channel(session.view());
    let thread =
        std::thread::Builder::new().name("vehicle".to_owned()).spawn(move || session.run(&view_tx))?;
    Ok(Handle { commands: command_tx, orders: order_tx, view: view_rx, events: event_rx, thread })
}

struct Session {
    vehicle: Vehicle,
    persistence: Persistence,
    runner: Runner,
    /// The multiple of real time at the start. The speed returns to it after a flight.
    usual_speed: f64,
    takeoff_m: f64,
    /// The profile in which estimates fly the embedded firmware instead of the remote one, once it was reported.
    reported_twin: Option<FirmwareProfile>,
    simulator: Option<Simulator>,
    endpoints: Option<Endpoints>,
    commands: CommandQueue,
    /// Those of other programs.
    orders: CommandQueue,
    events: EventSender,
    arming: ArmingWatch,
    interface: Interface,
    real_time: RealTime,
    /// The recording, unless the flight cannot be rewound.
    timeline: Option<Timeline>,
    /// The way to the recorder of flights, if there is one.
    feed: Option<FlightFeed>,
    /// Flies the flight of a remote firmware that has ended again.
    again: Option<FlyAgain>,
    flying_again: Option<FlyingAgain>,
    /// The folder of a firmware that flew again. Declared after the runner, so that its link is dropped
    /// first.
    keeps: Option<Box<dyn Any + Send>>,
    /// The target up to which the flight continues as fast as possible.
    run_on: Option<RunOn>,
    /// `true` if time was already paused when the earlier instant was shown.
    was_paused: bool,
    /// `true` once a script has sent RC.
    rc_received: bool,
    /// The refusals to clients over the current connection. Each reason is reported once.
    refused_over: Vec<(Option<u32>, Denial)>,
    /// `true` once a client was refused a change while the earlier instant is shown.
    refused_while_rewound: bool,
    /// `true` if something other than time has changed the view.
    changed: bool,
    /// `true` if there are more requests than one round of the loop can handle.
    more_waits: bool,
    quit: bool,
    /// The reason why there is no usable flight controller.
    failure: Option<String>,
}

/// Returns `true` if the vehicle can wait while an earlier instant is shown: its time is that of the session.
fn can_wait(config: &SessionConfig) -> bool {
    config.vehicle.embedded().is_some() || config.remote.as_ref().is_some_and(RemoteLink::is_in_steps)
}

impl Session {
    fn new(
        mut config: SessionConfig,
        flown: Option<FlownBefore>,
        feed: Option<FlightFeed>,
        (commands, events): (mpsc::Receiver<Command>, mpsc::UnboundedSender<Event>),
    ) -> Self {
        let simulator = config.endpoints.as_mut().and_then(|endpoints| endpoints.simulator.take());
        let incoming = ImpairedLink::new(Stream::Link.rng(config.vehicle.clock().seed()));
        let mut again = None;
        let (timeline, flown) = match flown {
            Some(flown) => {
                again = flown.again;
                (Some(flown.timeline), Some((flown.events, flown.show)))
            }
            None if config.is_recorded && simulator.is_none() && can_wait(&config) => {
                (Timeline::new(&mut config.vehicle), None)
            }
            None => (None, None),
        };
        let persistence = Persistence::new(config.store, &mut config.vehicle, config.starter_modes);
        let mut session = Self {
            runner: Runner::new(config.vehicle.step_us(), config.speed, config.remote).with_slice(SLICE),
            usual_speed: config.speed,
            vehicle: config.vehicle,
            persistence,
            takeoff_m: config.takeoff_m,
            reported_twin: None,
            simulator: simulator.map(|link| Simulator::new(link, incoming, Instant::now())),
            endpoints: config.endpoints,
            commands: CommandQueue::new(commands),
            orders: CommandQueue::new(mpsc::channel(1).1),
            events: EventSender::new(events),
            arming: ArmingWatch::default(),
            interface: Interface::default(),
            real_time: RealTime::default(),
            timeline,
            feed,
            again,
            flying_again: None,
            keeps: None,
            run_on: None,
            was_paused: false,
            rc_received: false,
            refused_over: Vec::new(),
            refused_while_rewound: false,
            changed: true,
            more_waits: false,
            quit: false,
            failure: None,
        };
        if let Some(feed) = &mut session.feed {
            session.events.record(feed.sender());
            // Those of a flight before the session.
            if let Some(timeline) = &session.timeline {
                feed.take_inputs(timeline);
            }
        }
        if let Some((events, show)) = flown {
            session.begin_with(&events, show);
        }
        for event in config.first_events {
            session.events.report(&mut session.vehicle, event);
        }
        session
    }

    fn run(&mut self, view: &watch::Sender<SessionView>) -> Option<String> {
        let waker = waker::of_this_thread();
        let mut context = Context::from_waker(&waker);
        let start = Instant::now();
        let (mut published, mut shown_events) = (Duration::ZERO, 0);
        let mut moved = false;
        self.flush_events();
        while !self.quit {
            self.take_commands(start.elapsed(), &mut context);
            self.take_late_answers(Instant::now());
            self.take_flown_again(start.elapsed());
            let flown = self.handle_requests(&mut context);
            self.record_flown(flown);
            let now = start.elapsed();
            self.record_flood();
            let due = if self.follows_wall_clock() { self.runner.due(now) } else { 0 };
            let ticks = flown + self.advance(due, now);
            if !self.is_in_steps() || ticks == 0 {
                self.exchange_with_remote(Some(&mut context));
            }
            let after = start.elapsed();
            self.runner.pacer.ran(ticks, after);
            self.count_lost_time(after);
            self.tend_logs(Instant::now());
            if ticks > 0 || self.changed {
                self.flush_events();
            }
            self.slow_down_after_flight(after);
            moved |= ticks > 0;
            let has_news = self.changed || self.events.sent() > shown_events;
            if has_news || moved && after - published >= VIEW_INTERVAL {
                published = after;
                shown_events = self.events.sent();
                (self.changed, moved) = (false, false);
                let view_now = self.view();
                self.interface.host = HostStatus::of(&view_now);
                if let Some(endpoints) = &mut self.endpoints {
                    endpoints.handler.set_host_status(self.interface.host);
                }
                if !self.is_rewound()
                    && let Some(notice) = self.arming.check(&view_now.vehicle)
                {
                    self.events.report(&mut self.vehicle, SessionEvent::ArmingBlocked(notice));
                }
                view.send_replace(view_now);
            }
            if ticks < SLICE && !self.more_waits && self.commands.is_idle() && self.orders.is_silent() {
                std::thread::park_timeout(self.sleep_from(now, start.elapsed()));
            }
        }
        self.failure.take()
    }

    /// Resets the speed to that of the start when the craft was disarmed. A speed chosen later, while the
    /// craft is disarmed, is kept.
    fn slow_down_after_flight(&mut self, now: Duration) {
        let (fast, usual) = (self.runner.pacer.speed(), self.usual_speed);
        if !self.events.take_disarmed() || !self.sets_time() || fast <= usual {
            return;
        }
        self.runner.pacer.set_speed(usual, now);
        self.changed = true;
        self.notice(format!(
            "The craft is disarmed: time runs at {} again ({} before); `]` makes it faster.",
            factor(usual),
            factor(fast)
        ));
    }

    /// Returns `true` if the session sets the time, rather than an external simulator or a remote firmware.
    fn sets_time(&self) -> bool {
        self.simulator.is_none() && (self.runner.link.is_none() || self.is_in_steps())
    }

    /// Returns `true` if a remote firmware runs step by step with the craft.
    fn is_in_steps(&self) -> bool {
        self.runner.link.as_ref().is_some_and(RemoteLink::is_in_steps)
    }

    /// Returns `true` while time follows the wall clock: without an external simulator, or until it sends its
    /// first state.
    fn follows_wall_clock(&self) -> bool {
        self.simulator.as_ref().is_none_or(|simulator| simulator.state() == LinkState::Waiting)
    }

    /// Counts the real time that was lost by `now`, and reports it.
    fn count_lost_time(&mut self, now: Duration) {
        self.real_time.lose(self.runner.pacer.take_lost());
        if let Some(simulator) = &mut self.simulator {
            let (wall, simulated) = simulator.take_passed();
            self.real_time.advance(wall, simulated);
        }
        let wanted = if self.simulator.is_some() { 1.0 } else { self.runner.pacer.speed() };
        // While time is paused there is no speed to report, and a real craft does not wait for it.
        if !self.runner.pacer.is_paused()
            && !self.access().is_limited()
            && let Some(notice) = self.real_time.notice(now, wanted, self.runner.pacer.achieved())
        {
            self.notice(notice.to_string());
        }
    }

    /// Returns the longest sleep of the thread at `present` if nothing arrives; its round began at `now`.
    fn sleep_from(&self, now: Duration, present: Duration) -> Duration {
        self.runner.rest(present, self.longest_sleep().saturating_sub(present.saturating_sub(now)))
    }

    /// Returns the longest sleep of the thread if nothing arrives.
    fn longest_sleep(&self) -> Duration {
        match &self.simulator {
            Some(simulator) if !self.follows_wall_clock() => {
                PAUSED_SLEEP.min(simulator.longest_wait(Instant::now()))
            }
            _ if self.runner.pacer.is_paused() => PAUSED_SLEEP,
            _ => PACED_SLEEP,
        }
    }

    /// Returns the access to the craft.
    fn access(&self) -> Access {
        self.runner.link.as_ref().map_or(Access::Everything, |link| link.protocol().access())
    }

    /// Sends the vehicle's data for its remote flight controller, and takes the data from it.
    fn exchange_with_remote(&mut self, context: Option<&mut Context<'_>>) {
        let Some(link) = &mut self.runner.link else { return };
        for notice in link.exchange(&mut self.vehicle, context, Instant::now()) {
            self.changed = true;
            if let RemoteNotice::Failed(sentence) = &notice
                && link.is_fed()
            {
                self.failure = Some(sentence.clone());
                self.quit = true;
            }
            let restarted = matches!(notice, RemoteNotice::Restarted(_));
            self.events.report(&mut self.vehicle, SessionEvent::Remote(notice));
            if restarted {
                if let Some(endpoints) = &mut self.endpoints {
                    endpoints.handler.after_restart(true, &mut self.vehicle);
                }
                self.events.report(&mut self.vehicle, SessionEvent::Restarted);
            }
        }
    }

    /// Passes on the new answers of a remote flight controller, and gives up overdue requests.
    fn take_late_answers(&mut self, now: Instant) {
        while let Some((ticket, answer)) = self.vehicle.take_answer() {
            self.changed = true;
            let craft = &mut UploadTo { vehicle: &mut self.vehicle, takeoff_m: self.takeoff_m };
            match self.interface.take_answer(ticket, answer, craft, now) {
                Ok(outcome) => self.report(outcome),
                Err(answer) => {
                    if let Some(endpoints) = &mut self.endpoints {
                        endpoints.handler.deliver(ticket, answer);
                    }
                }
            }
        }
        self.interface.give_up_overdue(now);
        if let Some(endpoints) = &mut self.endpoints {
            endpoints.handler.give_up_overdue(now);
        }
    }

    /// Returns the view to publish.
    fn view(&self) -> SessionView {
        let vehicle = self.shown_vehicle();
        let mut endpoints =
            self.endpoints.as_ref().map_or_else(Vec::new, |endpoints| endpoints.status.borrow().clone());
        let link = self.runner.link.as_ref();
        endpoints.extend(link.and_then(|link| link.status(Instant::now())));
        endpoints.extend(self.simulator.as_ref().map(|simulator| simulator.status(Instant::now())));
        SessionView {
            paused: self.runner.pacer.is_paused() && !self.is_running_on(),
            speed_wanted: match self.simulator {
                Some(_) => f64::INFINITY,
                None => self.runner.pacer.speed(),
            },
            speed_achieved: self.runner.pacer.achieved(),
            lost_time: self.real_time.lost(self.runner.pacer.achieved()),
            upload: self.interface.upload_under_way(),
            endpoints,
            simulator: self.simulator.as_ref().map(Simulator::state),
            remote: link.map(|link| link.protocol().view()),
            timeline: self.timeline_view(),
            commands_taken: self.commands.taken(),
            events_sent: self.events.sent(),
            ..SessionView::from_recorded(vehicle)
        }
    }

    fn flush_events(&mut self) {
        self.events.send_events_of(&mut self.vehicle);
    }

    /// Reports the notices of a request, then its answer.
    fn report(&mut self, outcome: Outcome) {
        self.notices(outcome.notices);
        if let Some(answer) = outcome.answer {
            answer();
        }
    }

    fn notices(&mut self, notices: impl IntoIterator<Item = impl Into<Notice>>) {
        notices.into_iter().for_each(|notice| self.notice(notice));
    }

    fn notice(&mut self, notice: impl Into<Notice>) {
        match self.timeline.as_ref().and_then(Timeline::shown) {
            Some(shown) => self.events.notice_at(shown.time(), notice),
            None => self.events.notice(&mut self.vehicle, notice),
        }
    }
}

impl<F> Subscriber<F> for EventSender {
    fn event(&mut self, event: &Event) {
        self.send(event);
    }
}

#[cfg(test)]
mod tests;
