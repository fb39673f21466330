//! A remote flight controller as a state machine without I/O: bytes, requests and times in; bytes and events out.
//!
//! ```text
//! Connecting ─▶ Identifying ─▶ Ready ─▶ Lost ─▶ Identifying …      Unusable: from everywhere, once it is given up
//!                  ▲             └───▶ Silent (a real one only)
//!                  └─────────────────────┘
//! ```
//!
//! [`Remote::handle`] takes an input, [`Remote::handle_timeout`] acts on the time, [`Remote::poll_transmit`] returns the
//! bytes to send, and [`Remote::poll_event`] returns the events for the vehicle and the user.

mod answers;
mod connecting;

use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::Duration;

use super::asked::{Asked, Purpose};
use super::client::{Ask, FcClient};
use super::first_answer::FirstAnswer;
use super::identify::Question;
use super::life::{Connection, Life};
use super::observer::{Observer, Simulated};
use super::permission::Permission;
use super::polling::Schedule;
use super::setup::Setup;
use super::{
    Access, Impact, LIST, NO_RETURN_SWITCH, Provision, RemoteNotice, RemoteState, RemoteView, Unset, rescue,
};
use crate::geo::LocalFrame;
use crate::msp::code;
use crate::vehicle::{LateAnswer, RemoteController, RemoteRequest, Ticket};

/// The maximum number of messages that wait for a connection. Further messages are refused.
const MAX_HELD: usize = 256;

/// The flight controller at the other end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Craft {
    /// The name for sentences: a file, or the address.
    pub name: String,
    /// The address of its serial port, for sentences.
    pub place: String,
    /// The capacity of the serial port in bytes per second; `None` if it exceeds every need.
    pub bytes_per_s: Option<u32>,
    /// `true` if this program feeds it with the states of a simulated craft.
    pub is_fed: bool,
    /// `true` if this program started it.
    pub is_child: bool,
    /// `true` if it runs in simulated time, step by step with the craft.
    pub is_in_steps: bool,
}

/// Something that happened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Input<'a> {
    /// A connection is made and has carried nothing yet.
    Connected,
    Received(&'a [u8]),
    /// The connection is lost or could not be made, with the reason as part of a sentence.
    Lost(&'a str),
    /// It has sent motors, in packets of their own.
    SentMotors,
    /// Its program cannot be started, for this reason.
    NotStarted(&'a str),
    /// Its program cannot be used any more, for this reason, which follows its name.
    Unusable(&'a str),
    /// Its program has ended in this way, as part of a sentence. It starts again by itself.
    Ended {
        how: &'a str,
        is_reboot: bool,
    },
    /// A part of this program requests something.
    Requested(Ticket, RemoteRequest),
}

/// A consequence for the vehicle, the user or the program of the flight controller.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    Notice(RemoteNotice),
    /// The answer to a request.
    Answered(Ticket, LateAnswer),
    /// It restarts, and its craft is back at home. The notice is a sentence.
    Restarted(String),
    /// It has booted: a connection is made.
    CameUp,
    /// It is gone, or about to be.
    WentDown,
    /// It is identified and configured.
    BecameReady,
    /// It cannot be used; its program must end.
    GivenUp,
    /// It is configured: these words belong into this file.
    Configured(PathBuf, String),
    /// A switch of the transmitter moves: channel and pulse, µs.
    Switched(usize, u16),
}

/// The protocol with a remote flight controller.
#[derive(Debug, Clone)]
pub struct Remote {
    craft: Craft,
    client: FcClient,
    life: Life,
    first_answer: FirstAnswer,
    sends_motors: bool,
    asked: Asked,
    schedule: Schedule,
    observer: Observer,
    permission: Permission,
    setup: Setup,
    /// The messages that wait for the connection to a child that boots.
    held: Vec<(Ticket, RemoteRequest)>,
    events: VecDeque<Event>,
}

impl Remote {
    /// Returns the same protocol at the serial port of another process that has computed the same.
    pub fn at(self, place: String) -> Self {
        Self { craft: Craft { place, ..self.craft }, ..self }
    }

    /// Begins at `now`, which counts from any fixed instant. A program that is a child of this one starts now.
    pub fn new(craft: Craft, now: Duration) -> Self {
        let schedule = Schedule::new(craft.bytes_per_s);
        Self {
            schedule: if craft.is_in_steps { schedule.in_steps() } else { schedule },
            first_answer: FirstAnswer::new(craft.is_child.then_some(now)),
            craft,
            client: FcClient::default(),
            life: Life::default(),
            sends_motors: false,
            asked: Asked::default(),
            observer: Observer::default(),
            permission: Permission::default(),
            setup: Setup::default(),
            held: Vec::new(),
            events: VecDeque::new(),
        }
    }

    /// Configures the flight controller once it is identified, before it counts as ready.
    pub fn provision(&mut self, provision: Provision) {
        self.setup.begin(provision);
    }

    /// Permits changes over this connection. Permission for an earlier connection has no effect.
    pub fn permit_changes(&mut self, connection: u32) {
        self.permission.permit(connection);
        self.report_to_client();
    }

    /// Takes an input.
    pub fn handle(&mut self, input: Input<'_>, now: Duration) {
        match input {
            Input::Connected => self.connect(now),
            Input::Received(bytes) => {
                if let Some(connection) = self.life.connection_mut() {
                    connection.heard();
                }
                self.client.push(bytes, now);
            }
            Input::Lost(reason) => self.lose(reason),
            Input::SentMotors => self.sends_motors = true,
            Input::NotStarted(reason) => {
                self.give_up(format!("{} cannot be started: {reason}.", self.craft.name));
            }
            Input::Unusable(why) => {
                self.give_up(format!("{} {why}: is it a SITL executable of Betaflight?", self.craft.name));
            }
            Input::Ended { how, .. } if self.first_answer.answers == 0 => self.give_up(format!(
                "{} ended {how} before it answered: is it a SITL executable of Betaflight, and are its ports free?",
                self.craft.name
            )),
            Input::Ended { is_reboot: true, .. } => {
                self.restart("The firmware restarts; the craft is back at home.".to_owned());
            }
            Input::Ended { how, .. } => {
                self.restart(format!("The firmware ended {how}: it is restarted, and the craft is back at home."));
            }
            Input::Requested(ticket, request) => self.request(ticket, request),
        }
        self.take_answers(now);
    }

    /// Sends the requests that are due, and gives up what has waited too long.
    pub fn handle_timeout(&mut self, now: Duration) {
        self.take_answers(now);
        self.ask_what_is_due(now);
        self.client.poll(now);
        self.check_first_answer(now);
        self.client.set_armed(self.observer.is_armed());
    }

    /// Returns the bytes to send over the serial port.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        Some(self.client.take_output()).filter(|output| !output.is_empty())
    }

    /// Returns the oldest event.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// Returns the time at which the next request is due even without an input; `None` while it waits for an input
    /// or for the first answer. The deadline of the first answer is checked by each [`Self::handle_timeout`], which
    /// therefore must also run now and then.
    pub fn timeout(&self) -> Option<Duration> {
        if !self.client.is_idle() {
            return self.client.due();
        }
        match &self.life {
            Life::Ready { connection } => {
                let refresh = connection.refresh.due().filter(|_| self.can_refresh());
                let poll = self.schedule.due(self.observer.is_armed());
                Some(refresh.map_or(poll, |refresh| poll.min(refresh)))
            }
            Life::Identifying { .. } | Life::Silent { .. } => Some(Duration::ZERO),
            Life::Connecting | Life::Lost { .. } | Life::Unusable { .. } => None,
        }
    }

    /// Delivers new telemetry and the events that it shows.
    pub fn deliver(
        &mut self,
        mailbox: &mut RemoteController,
        frame: Option<&LocalFrame>,
        simulated: Option<Simulated>,
    ) {
        self.observer.deliver(mailbox, frame, simulated);
    }

    /// Returns the state of the connection.
    pub fn state(&self) -> RemoteState {
        self.life.state()
    }

    /// Returns the view for the display.
    pub fn view(&self) -> RemoteView {
        RemoteView {
            name: self.craft.name.clone(),
            state: self.state(),
            access: self.access(),
            has_plans: self.observer.has_plans(),
            knows_settings: self.observer.knows_settings(),
            opens_cli: self.opens_cli(),
            in_cli: self.client.is_in_cli(),
            connection: self.connection(),
            is_in_steps: self.craft.is_in_steps,
        }
    }

    /// Returns the flight controller at the other end.
    pub fn craft(&self) -> &Craft {
        &self.craft
    }

    /// Returns the permitted access.
    pub fn access(&self) -> Access {
        if self.craft.is_fed { Access::Everything } else { self.permission.access() }
    }

    /// Returns the number of requests that it has answered. Motor packets do not count.
    pub fn answers(&self) -> u64 {
        self.first_answer.answers
    }

    /// Returns the number of the current connection.
    pub fn connection(&self) -> u32 {
        self.permission.connection()
    }

    /// Returns `true` if a line would open the interactive command line, which then stays open.
    pub fn opens_cli(&self) -> bool {
        let is_disarmed = self.observer.armed() == Some(false);
        self.permission.opens_cli() && is_disarmed && !self.client.is_in_cli()
    }

    /// Returns the settings that were not applied as requested.
    pub fn unset(&self) -> Option<&Unset> {
        self.setup.unset()
    }

    /// Returns the observed state of the flight controller.
    pub fn observer(&self) -> &Observer {
        &self.observer
    }

    fn notice(&mut self, notice: RemoteNotice) {
        self.events.push_back(Event::Notice(notice));
    }

    /// Passes the current permission on to the client.
    fn report_to_client(&mut self) {
        self.client.set_cli(self.permission.cli());
        self.client.set_may_leave_cli(self.access() != Access::Reading);
    }

    /// Sends a request of another part of this program.
    fn request(&mut self, ticket: Ticket, request: RemoteRequest) {
        match request {
            RemoteRequest::Msp { .. } if self.holds_messages() && self.held.len() < MAX_HELD => {
                self.held.push((ticket, request));
            }
            // The prompt of a real craft opens only with permission, which the client asks for by itself.
            RemoteRequest::Typed(line) if self.craft.is_fed => {
                let changes = Impact::from_line(&line) > Impact::Reads;
                self.ask(Purpose::Typed(ticket, changes), Ask::Typed(line));
            }
            RemoteRequest::LeavePrompt if self.craft.is_fed => self.ask(Purpose::Nothing, Ask::LeavePrompt),
            RemoteRequest::LeavePrompt => {}
            RemoteRequest::Cli(line) | RemoteRequest::Typed(line) => {
                let changes = Impact::from_line(&line) > Impact::Reads;
                let purpose =
                    if line == LIST { Purpose::Plan(ticket) } else { Purpose::Line(ticket, changes) };
                self.ask(purpose, Ask::Line(line));
            }
            RemoteRequest::Msp { code, payload } => {
                let changes = Impact::from_message(code, &payload) == Impact::Changes;
                self.ask(Purpose::Message(ticket, changes), Ask::Msp { code, payload });
            }
            RemoteRequest::ReturnHome => self.switch_rescue(true),
            RemoteRequest::CancelReturn => self.switch_rescue(false),
            RemoteRequest::Restart => {
                self.ask(Purpose::Nothing, Ask::Msp { code: code::REBOOT, payload: Vec::new() });
            }
        }
    }

    /// Returns `true` if messages wait until there is a connection. A child listens only once it has booted, and a client
    /// of the doors must not take the wait for a refusal.
    fn holds_messages(&self) -> bool {
        self.craft.is_child && matches!(self.life, Life::Connecting | Life::Lost { .. })
    }

    /// Returns `true` if a lost connection means that a child restarts.
    fn restarts(&self) -> bool {
        self.craft.is_child && !matches!(self.life, Life::Unusable { .. })
    }

    /// Sends the messages that have waited for the connection, or refuses them if there is none.
    fn release_messages(&mut self) {
        for (ticket, request) in std::mem::take(&mut self.held) {
            self.request(ticket, request);
        }
    }

    /// Moves the switch that makes it fly home.
    fn switch_rescue(&mut self, on: bool) {
        match rescue::position(&self.observer, on) {
            Some((channel, pulse_us)) => {
                if on && let Some((channel, pulse_us)) = rescue::autopilot_off(&self.observer) {
                    self.events.push_back(Event::Switched(channel, pulse_us));
                }
                self.events.push_back(Event::Switched(channel, pulse_us));
                self.observer.deliver_again();
            }
            None => self.notice(RemoteNotice::Reported(NO_RETURN_SWITCH.to_owned())),
        }
    }

    fn ask(&mut self, purpose: Purpose, ask: Ask) {
        let id = self.asked.register(purpose);
        self.client.ask(id, ask);
    }

    /// Returns `true` if questions about its settings can be asked: only while the craft is disarmed, because
    /// the command line does not open in flight, and only if a line does not leave the command line open.
    fn can_refresh(&self) -> bool {
        self.observer.armed() == Some(false) && !self.permission.opens_cli()
    }

    /// Asks for the identity, then for the state, while there are no other requests.
    fn ask_what_is_due(&mut self, now: Duration) {
        if !self.client.is_idle() {
            return;
        }
        let can_refresh = self.can_refresh();
        let next = match &mut self.life {
            Life::Identifying { identification, .. } => match identification.next() {
                Some(question) => Some((Purpose::Identity(question), question.ask())),
                None => {
                    let ask = self.setup.next(self.observer.is_master());
                    self.finish_setup();
                    ask.map(|ask| (Purpose::Provision, ask))
                }
            },
            Life::Ready { connection } => {
                let refresh = if can_refresh { connection.refresh.next(now) } else { None };
                match refresh {
                    Some(question) => Some((Purpose::Refreshed(question), question.ask())),
                    None => {
                        let next = self.schedule.next(self.observer.is_armed(), now);
                        next.map(|subject| (Purpose::Polled(subject), subject.ask()))
                    }
                }
            }
            // A board that is still starting answers later, as does one that is plugged in later.
            Life::Unusable { identification, .. } if !self.craft.is_fed => identification
                .next()
                .filter(|question| *question == Question::ApiVersion)
                .map(|question| (Purpose::Identity(question), question.ask())),
            // The connection is there, but nothing answers.
            Life::Silent { .. } => Some((Purpose::Nothing, Question::ApiVersion.ask())),
            Life::Connecting | Life::Lost { .. } | Life::Unusable { .. } => None,
        };
        if let Some((purpose, ask)) = next {
            self.ask(purpose, ask);
        }
    }
}
