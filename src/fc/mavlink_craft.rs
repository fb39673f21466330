//! A craft that speaks MAVLink, as a state machine without I/O: ArduPilot, PX4, INAV, and any other.
//!
//! The protocol of the ground station is in the crate `betadeck-mavlink`. `telemetry` makes reports for the vehicle of its
//! state, `lines` answers the lines of the command line, `exchange` moves plans as missions. Reading is always allowed, a plan
//! and a mode change need the permission of the connection, and no request arms the craft.

mod exchange;
mod lines;
mod telemetry;

use std::collections::VecDeque;
use std::time::Duration;

use super::observer::EventObserver;
use super::permission::Permission;
use super::remote::{Event, Input};
use super::{Access, NOT_PERMITTED, RemoteNotice, RemoteState, RemoteView};
use crate::firmware::cli::CliReply;
use crate::geo::LocalFrame;
use crate::mavlink::station::{
    AutopilotKind, Event as StationEvent, OrderEnd, OrderId, Presence, StationOptions, StationProtocol,
};
use crate::mavlink::value::{CommandResult, Severity, system_type};
use crate::vehicle::{LateAnswer, RemoteController, RemoteRequest, RemoteTelemetry, Ticket};
use exchange::Exchange;

/// The time between two calls of the protocol.
const CALL: Duration = Duration::from_millis(100);
/// The time between two deliveries of telemetry.
const DELIVERY: Duration = Duration::from_millis(50);

/// The protocol with a craft that speaks MAVLink.
#[derive(Debug)]
pub struct MavlinkCraft {
    /// The name for sentences.
    name: String,
    station: StationProtocol,
    permission: Permission,
    state: RemoteState,
    /// The last reported reason for a loss; `None` once data has arrived since.
    reported_loss: Option<String>,
    /// The name of the mode that was reported last.
    mode: String,
    exchange: Exchange,
    /// The orders that wait for an answer, with the lines that gave them.
    orders: Vec<(OrderId, Ticket)>,
    observer: EventObserver,
    /// The first position of the craft.
    first_fix: Option<LocalFrame>,
    called: Duration,
    delivered: Option<Duration>,
    events: VecDeque<Event>,
}

impl MavlinkCraft {
    /// Begins without a connection. Times count from any fixed instant.
    pub fn new(name: String) -> Self {
        Self {
            name,
            station: StationProtocol::new(StationOptions::default()),
            permission: Permission::default(),
            state: RemoteState::Connecting,
            reported_loss: None,
            mode: String::new(),
            exchange: Exchange::default(),
            orders: Vec::new(),
            observer: EventObserver::default(),
            first_fix: None,
            called: Duration::ZERO,
            delivered: None,
            events: VecDeque::new(),
        }
    }

    /// Permits changes over this connection. Permission for an earlier connection has no effect.
    pub fn permit_changes(&mut self, connection: u32) {
        self.permission.permit(connection);
    }

    /// Has the mission of the craft read again.
    pub fn read_mission(&mut self, now: Duration) {
        self.exchange.read();
        self.handle_timeout(now);
    }

    /// Takes an input.
    pub fn handle(&mut self, input: Input<'_>, now: Duration) {
        match input {
            Input::Received(bytes) => self.station.receive(now, bytes),
            Input::Lost(reason) => {
                // The next heartbeat makes a new connection, perhaps to another craft.
                self.station = StationProtocol::new(StationOptions::default());
                for (_, ticket) in std::mem::take(&mut self.orders) {
                    let reply = order_reply(OrderEnd::Lost);
                    self.events.push_back(Event::Answered(ticket, LateAnswer::Cli(reply)));
                }
                self.lose(reason);
            }
            Input::Requested(ticket, request) => self.request(ticket, request),
            // The first heartbeat makes the connection. The others are of executables.
            Input::Connected
            | Input::SentMotors
            | Input::NotStarted(_)
            | Input::Unusable(_)
            | Input::Ended { .. } => {}
        }
        self.take_events(now);
    }

    /// Sends what is due.
    pub fn handle_timeout(&mut self, now: Duration) {
        if now >= self.called + CALL || now < self.called {
            self.called = now;
            self.station.advance(now);
        }
        self.take_events(now);
        self.exchange.advance(&mut self.station, &mut self.events);
    }

    /// Returns the bytes to send.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.station.poll_transmit()
    }

    /// Returns the oldest event.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// Returns the time at which the next call is due.
    pub fn timeout(&self) -> Duration {
        self.called + CALL
    }

    /// Delivers new telemetry and the events that it shows.
    pub fn deliver(&mut self, mailbox: &mut RemoteController, frame: Option<&LocalFrame>, now: Duration) {
        if self.delivered.is_some_and(|delivered| now < delivered + DELIVERY) {
            return;
        }
        self.delivered = Some(now);
        let is_connected = self.station.is_connected();
        let reported = telemetry::of_report(&self.station, &self.exchange, frame, now);
        // The events of a lost craft are unknown until it is heard again.
        if is_connected {
            let (craft, nav) = (&reported.craft, reported.nav.as_ref());
            for event in self.observer.follow(craft, nav, reported.stored_plan.as_ref()) {
                mailbox.deliver_event(event);
            }
        }
        let last_disarm = self.observer.last_disarm();
        mailbox.deliver_telemetry(RemoteTelemetry { last_disarm, ..reported });
    }

    /// Returns the frame at the first known place of the craft: home, or its first position.
    pub fn first_fix(&mut self) -> Option<LocalFrame> {
        let report = self.station.report();
        let place = report.home.or(report.position).map(|heard| heard.value);
        self.first_fix = self
            .first_fix
            .or_else(|| place.map(|place| LocalFrame::new(place.lat_deg, place.lon_deg, place.alt_amsl)));
        self.first_fix
    }

    /// Returns the view for the display.
    pub fn view(&self) -> RemoteView {
        RemoteView {
            name: self.name.clone(),
            state: self.state.clone(),
            access: self.access(),
            has_plans: self.state == RemoteState::Ready,
            knows_settings: false,
            opens_cli: false,
            in_cli: false,
            connection: self.connection(),
            is_in_steps: false,
        }
    }

    /// Returns the permitted access.
    pub fn access(&self) -> Access {
        self.permission.access()
    }

    /// Returns the number of the current connection.
    pub fn connection(&self) -> u32 {
        self.permission.connection()
    }

    fn request(&mut self, ticket: Ticket, request: RemoteRequest) {
        match request {
            RemoteRequest::Cli(line) | RemoteRequest::Typed(line) => self.line(ticket, &line),
            RemoteRequest::Msp { .. } => {
                self.events.push_back(Event::Answered(ticket, LateAnswer::Msp(None)));
            }
            // The policy refuses them for a real craft.
            RemoteRequest::LeavePrompt
            | RemoteRequest::Restart
            | RemoteRequest::ReturnHome
            | RemoteRequest::CancelReturn => {}
        }
    }

    /// Answers a line, at once or later.
    fn line(&mut self, ticket: Ticket, line: &str) {
        let reply = match lines::parse(line) {
            Err(why) => refusal(&why),
            Ok(line) if line.changes() && self.access() == Access::Reading => refusal(NOT_PERMITTED),
            Ok(lines::Line::Show(shown)) => done(shown.text(&self.station)),
            Ok(lines::Line::Order(order)) => match self.station.order(&order) {
                Ok(id) => return self.orders.push((id, ticket)),
                Err(why) => refusal(lines::not_begun(why)),
            },
            Ok(lines::Line::List) => return self.exchange.list(ticket),
            Ok(lines::Line::Plan(line)) => {
                self.exchange.add_line(line);
                done(String::new())
            }
            Ok(lines::Line::Setting) => {
                self.exchange.leave_setting_out();
                done("not sent: a craft that speaks MAVLink has other settings".to_owned())
            }
        };
        self.events.push_back(Event::Answered(ticket, LateAnswer::Cli(reply)));
    }

    fn take_events(&mut self, now: Duration) {
        while let Some(event) = self.station.poll_event() {
            match event {
                StationEvent::Connected { system, .. } => {
                    let presence = self.station.report().presence.as_ref();
                    let kind = presence.map(|heard| kind(&heard.value)).unwrap_or_default();
                    self.notice(format!("{} answers: {kind}, system {system}.", self.name));
                    self.begin();
                }
                StationEvent::LinkRestored => {
                    self.notice(format!("{} answers again.", self.name));
                    self.begin();
                }
                StationEvent::LinkLost => self.lose("no heartbeat has arrived for 3 s"),
                // The craft may list the name of the same mode in other letters.
                StationEvent::Mode(mode) if mode.eq_ignore_ascii_case(&self.mode) => {}
                StationEvent::Mode(mode) => {
                    self.notice(format!("Mode {mode}."));
                    self.mode = mode;
                }
                StationEvent::Text(text) => {
                    let notice = match text.severity {
                        Severity::Emergency | Severity::Alert | Severity::Critical | Severity::Error => {
                            RemoteNotice::Lost(format!("The craft reports: {}", text.text))
                        }
                        _ => RemoteNotice::Output(text.text),
                    };
                    self.events.push_back(Event::Notice(notice));
                }
                StationEvent::Order(id, end) => {
                    if let Some(at) = self.orders.iter().position(|(waiting, _)| *waiting == id) {
                        let (_, ticket) = self.orders.swap_remove(at);
                        let reply = order_reply(end);
                        self.events.push_back(Event::Answered(ticket, LateAnswer::Cli(reply)));
                    }
                }
                StationEvent::Transfer(end) => {
                    let home = telemetry::home(&self.station);
                    self.exchange.take(end, home, &mut self.events);
                }
                // The state shows them.
                StationEvent::Armed(_) | StationEvent::ItemReached(_) => {}
            }
            self.delivered = self.delivered.filter(|delivered| *delivered > now);
        }
    }

    /// Begins a connection: the mission is read.
    fn begin(&mut self) {
        self.state = RemoteState::Ready;
        self.reported_loss = None;
        self.permission.connected();
        self.exchange.read();
        self.events.push_back(Event::BecameReady);
    }

    fn lose(&mut self, reason: &str) {
        if self.state == RemoteState::Ready {
            self.state = RemoteState::Lost;
        }
        self.permission.lost();
        self.exchange.forget_lines();
        if self.reported_loss.as_deref() != Some(reason) {
            self.reported_loss = Some(reason.to_owned());
            let lost = RemoteNotice::Lost(format!("{}: {reason}.", self.name));
            self.events.push_back(Event::Notice(lost));
        }
    }

    fn notice(&mut self, sentence: String) {
        self.events.push_back(Event::Notice(RemoteNotice::Reported(sentence)));
    }
}

/// Returns the kind of a craft, such as "an ArduPilot quadcopter".
fn kind(presence: &Presence) -> String {
    let autopilot = match presence.autopilot {
        AutopilotKind::Generic => "a".to_owned(),
        AutopilotKind::Ardupilot => "an ArduPilot".to_owned(),
        AutopilotKind::Px4 => "a PX4".to_owned(),
        AutopilotKind::Other(number) => format!("an autopilot with the number {number} on a"),
    };
    let craft = match presence.system_type {
        system_type::QUADROTOR => "quadcopter",
        system_type::FIXED_WING => "plane",
        system_type::FIRST_VTOL..=system_type::LAST_VTOL => "VTOL plane",
        system_type::ROVER => "rover",
        system_type::BOAT => "boat",
        _ => "craft",
    };
    format!("{autopilot} {craft}")
}

fn order_reply(end: OrderEnd) -> CliReply {
    match end {
        OrderEnd::Answered(CommandResult::Accepted) => {
            done(lines::result(CommandResult::Accepted).to_owned())
        }
        OrderEnd::Answered(result) => refusal(&format!("the craft refused: {}", lines::result(result))),
        OrderEnd::Silence => refusal("the craft did not answer"),
        OrderEnd::Lost => refusal("the link to the craft was lost"),
    }
}

/// Returns the reply with a text.
fn done(text: String) -> CliReply {
    let text = if text.is_empty() { text } else { text.replace('\n', "\r\n") + "\r\n" };
    CliReply { text, ..CliReply::default() }
}

/// Returns the reply that refuses a line, in the form of a firmware.
fn refusal(why: &str) -> CliReply {
    CliReply {
        text: format!("###ERROR: {}###\r\n", why.trim_end_matches('.')),
        failed: true,
        ..CliReply::default()
    }
}

#[cfg(test)]
mod tests;
