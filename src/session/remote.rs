//! Speaks with a flight controller that runs outside: what the vehicle's mailbox holds goes out, what comes back is delivered.
//!
//! ```text
//!                    ┌── sensor and RC frames ──▶ SitlPeer ──▶ UDP        (a SITL executable only)
//!  vehicle's mailbox ┤◀─ motors ─────────────────┘
//!                    ├── lines, messages ───────▶ FcClient ──▶ FcStream   (TCP, serial, websocket)
//!                    └◀─ answers, telemetry ── Observer ◀── polling ──┘
//! ```
//!
//! Nothing here waits: [`RemoteLink::exchange`] is called between two steps.

mod answers;
mod identify;
mod observer;
mod permission;
mod provision;
mod refresh;
mod reply;
mod rescue;
mod self_check;
mod silence;
mod stream;
#[cfg(test)]
mod tests;
mod view;

use std::collections::BTreeMap;
use std::task::Context;
use std::time::{Duration, Instant};

use crate::geo::LocalFrame;
use crate::link::proto::fc_client::polling::{Poll as Subject, Schedule};
use crate::link::proto::fc_client::{Ask, AskId, FcClient};
use crate::link::proto::sitl_feed::FeedState;
use crate::link::{ChildEvent, FcStream, SitlChild, SitlPeer};
use crate::session::upload::LIST;
use crate::signals::MotorCommand;
use crate::telemetry::EndpointStatus;
use crate::vehicle::{FrameOut, RemoteRequest, Ticket, Vehicle};
use identify::{Identification, Question};
use observer::{Observer, Simulated};
use permission::Permission;
pub use permission::{Access, Denial, Impact, NOT_PERMITTED, NOTHING_MOVES, NOTHING_SIMULATED};
pub use provision::{Provision, ProvisionLines, Unset, UnsetLine};
use refresh::Refresh;
use self_check::SelfCheck;
use silence::Silence;
pub use view::{RemoteNotice, RemoteState, RemoteView};

/// The message that restarts a flight controller.
const REBOOT: u16 = 68;
/// Simulated time between two exchanges at real time, µs.
const EXCHANGE_US: f64 = 1000.0;
/// Least wall time between two exchanges: time that was missed is caught up with at twice the speed.
pub const EXCHANGE_PAUSE: Duration = Duration::from_micros(500);
/// Most events of its program between two steps, so that one that prints much does not hold the craft up.
const MOST_EVENTS: usize = 64;
/// How far from the place where a real craft was seen first another one may be seen, for it to be drawn around the same place, m.
const SAME_FIELD_M: f64 = 1000.0;
/// How long a program may take until it answers for the first time.
const FIRST_ANSWER: Duration = Duration::from_secs(10);

/// The ends by which a flight controller is reached.
#[derive(Debug)]
pub struct RemoteEnds {
    /// What it is called in sentences: a file, or where it is.
    pub name: String,
    pub stream: FcStream,
    /// Where its states, RC and motors go, when it is a SITL executable.
    pub peer: Option<SitlPeer>,
    /// Its process, when it is a child of this program.
    pub child: Option<SitlChild>,
}

/// What an answer is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// A line that somebody in this program asked for, and whether it may change something.
    Line(Ticket, bool),
    /// The line that shows the plan, likewise.
    Plan(Ticket),
    /// A message, likewise.
    Message(Ticket, bool),
    /// To know what it is.
    Identity(Question),
    Provision,
    /// To show how it is.
    Polled(Subject),
    /// To know how it is set now.
    Refreshed(Question),
    /// Nothing: what it causes is seen elsewhere.
    Nothing,
}

/// The link to a flight controller outside.
#[derive(Debug)]
pub struct RemoteLink {
    ends: RemoteEnds,
    client: FcClient,
    state: RemoteState,
    identification: Identification,
    schedule: Schedule,
    observer: Observer,
    waiting: BTreeMap<AskId, Purpose>,
    next_ask: u64,
    started: Instant,
    /// When the first connection was made.
    first_connected: Option<Instant>,
    /// When the present connection was made, until it has been told that nothing comes over it.
    connected: Option<Instant>,
    /// Something came over the present connection, or the last one.
    heard: bool,
    /// Why the connection was lost, as it was told last; nothing has come over one since.
    told_loss: Option<String>,
    /// Requests that it has answered since its program was started first; motors are no answer.
    answers: u64,
    motors: FeedState,
    self_check: SelfCheck,
    silence: Silence,
    refresh: Refresh,
    permission: Permission,
    provision: Option<Provision>,
    unset: Option<Unset>,
    notices: Vec<RemoteNotice>,
}

impl RemoteLink {
    /// A link over these ends, whose program, if it has one here, starts now.
    pub fn new(ends: RemoteEnds, now: Instant) -> Self {
        Self {
            schedule: Schedule::new(ends.stream.bytes_per_s),
            ends,
            client: FcClient::default(),
            state: RemoteState::Connecting,
            identification: Identification::default(),
            observer: Observer::default(),
            waiting: BTreeMap::new(),
            next_ask: 0,
            started: now,
            first_connected: None,
            connected: None,
            heard: false,
            told_loss: None,
            answers: 0,
            motors: FeedState::Waiting,
            self_check: SelfCheck::default(),
            silence: Silence::default(),
            refresh: Refresh::default(),
            permission: Permission::default(),
            provision: None,
            unset: None,
            notices: Vec::new(),
        }
    }

    /// How far the flight controller is known.
    pub fn state(&self) -> &RemoteState {
        &self.state
    }

    /// What a screen shows of it.
    pub fn view(&self) -> RemoteView {
        RemoteView {
            name: self.ends.name.clone(),
            state: self.state.clone(),
            access: self.access(),
            has_plans: self.observer.has_plans(),
            opens_cli: self.opens_cli(),
            in_cli: self.client.is_in_cli(),
            connection: self.connection(),
        }
    }

    /// What may be done with it.
    pub fn access(&self) -> Access {
        if self.is_fed() { Access::Everything } else { self.permission.access() }
    }

    /// Requests that it has answered so far; motors are no answer.
    pub fn answers(&self) -> u64 {
        self.answers
    }

    /// The number of the present connection.
    pub fn connection(&self) -> u32 {
        self.permission.connection()
    }

    /// Whether a line opens the interactive command line, which stays open then.
    pub fn opens_cli(&self) -> bool {
        let is_disarmed = self.observer.armed() == Some(false);
        self.permission.opens_cli() && is_disarmed && !self.client.is_in_cli()
    }

    /// The user permits changes over this connection; an earlier one's permission means nothing.
    pub fn permit_changes(&mut self, connection: u32) {
        self.permission.permit(connection);
        self.tell_client();
    }

    /// The client does what is permitted now.
    fn tell_client(&mut self) {
        self.client.set_cli(self.permission.cli());
        self.client.set_may_leave_cli(self.access() != Access::Reading);
    }

    /// What it is called in sentences.
    pub fn name(&self) -> &str {
        &self.ends.name
    }

    /// What it was to be set to and is not.
    pub fn unset(&self) -> Option<&Unset> {
        self.unset.as_ref()
    }

    /// What is known of it.
    pub fn observer(&self) -> &Observer {
        &self.observer
    }

    /// Whether it gets the states of the craft from here, in the rhythm of the steps.
    pub fn is_fed(&self) -> bool {
        self.ends.peer.is_some()
    }

    /// Most steps of `step_us` at `speed` times real time that may be flown before the next exchange: motors are not to stand
    /// still for many steps where it is the machine that was held up.
    pub fn most_steps(&self, step_us: u64, speed: f64, now: Instant) -> u64 {
        match &self.ends.peer {
            None => u64::MAX,
            Some(peer) if peer.waits(now) => 0,
            Some(_) => ((EXCHANGE_US / step_us as f64 * speed).ceil() as u64).max(1),
        }
    }

    /// Its lines among the endpoints.
    pub fn status(&self, now: Instant) -> Vec<EndpointStatus> {
        self.ends.peer.iter().map(|peer| peer.status(now)).collect()
    }

    /// Sends what the vehicle's mailbox holds and delivers what has come back since; what is to be told of it comes back.
    /// With a context the caller is woken when more comes over the serial port.
    pub fn exchange(
        &mut self,
        vehicle: &mut Vehicle,
        context: Option<&mut Context<'_>>,
        now: Instant,
    ) -> Vec<RemoteNotice> {
        self.follow_program(vehicle);
        self.read_stream(vehicle, context, now);
        self.exchange_frames(vehicle, now);
        // First, so that nothing is asked that was answered just now.
        self.take_answers(vehicle, now);
        self.take_requests(vehicle);
        self.ask_what_is_due(now);
        self.client.poll(now.saturating_duration_since(self.started));
        self.write_stream();
        self.observe(vehicle, now);
        std::mem::take(&mut self.notices)
    }

    /// Tells what became of its program since.
    fn follow_program(&mut self, vehicle: &mut Vehicle) {
        for _ in 0..MOST_EVENTS {
            let Some(event) = self.ends.child.as_mut().and_then(SitlChild::take_event) else { return };
            match event {
                ChildEvent::Started => {}
                ChildEvent::Line(line) => self.notices.push(RemoteNotice::Output(line)),
                ChildEvent::NotShown(count) => self
                    .notices
                    .push(RemoteNotice::Told(format!("Lines of the firmware's output that were not shown: {count}."))),
                ChildEvent::Failed(reason) => self.give_up(format!("{} cannot be started: {reason}.", self.ends.name)),
                ChildEvent::Ended(end) if self.answers == 0 => self.give_up(format!(
                    "{} ended {end} before it answered: is it a SITL executable of Betaflight, and are its ports free?",
                    self.ends.name
                )),
                ChildEvent::Ended(end) => {
                    let notice = if end.is_reboot() {
                        "The firmware restarts; the craft stands at home again.".to_owned()
                    } else {
                        format!("The firmware ended {end}: it is started again, and the craft stands at home again.")
                    };
                    self.begin_anew(vehicle, notice);
                }
            }
        }
    }

    /// The executable ended: another life of it begins at home.
    fn begin_anew(&mut self, vehicle: &mut Vehicle, notice: String) {
        if let Some(peer) = &mut self.ends.peer {
            peer.went_down();
        }
        vehicle.remote_restarted();
        self.observer.restarted();
        self.notices.push(RemoteNotice::Restarted(notice));
    }

    fn give_up(&mut self, sentence: String) {
        if !matches!(self.state, RemoteState::Unusable(_)) {
            self.notices.push(RemoteNotice::Failed(sentence.clone()));
            self.state = RemoteState::Unusable(sentence);
            self.ends.child = None;
        }
    }

    /// Sensor and RC frames go out, motors come in.
    fn exchange_frames(&mut self, vehicle: &mut Vehicle, now: Instant) {
        let Some(mailbox) = vehicle.controller_mut().remote_mut() else { return };
        let Some(peer) = &mut self.ends.peer else {
            while mailbox.take_frame().is_some() {}
            return;
        };
        if let Some(motors) = peer.take_motors(now) {
            mailbox.deliver_motors(motors);
        }
        let mut state = None;
        while let Some(frame) = mailbox.take_frame() {
            match frame {
                FrameOut::Rc(frame, _) => peer.send_rc(&frame, now),
                FrameOut::Sensors(frame) => {
                    // Late by several steps: one packet, of the newest.
                    if let Some(older) = state.replace(frame) {
                        peer.pass_over(&older);
                    }
                }
            }
        }
        if let Some(frame) = state {
            peer.send_state(&frame, now);
        }
        peer.repeat_rc(now);
        let motors = peer.state(now);
        if motors == FeedState::Silent && self.motors == FeedState::Answering {
            mailbox.deliver_motors(MotorCommand::default());
            let sentence = "The firmware has sent no motors for a second: they stand still until it does.";
            self.notices.push(RemoteNotice::Lost(sentence.to_owned()));
        } else if motors == FeedState::Answering && self.motors == FeedState::Silent {
            self.notices.push(RemoteNotice::Told("The firmware sends motors again.".to_owned()));
        }
        self.motors = motors;
    }

    /// Asks what somebody in this program wants to know or to be done.
    fn take_requests(&mut self, vehicle: &mut Vehicle) {
        loop {
            let Some(mailbox) = vehicle.controller_mut().remote_mut() else { return };
            let Some((ticket, request)) = mailbox.take_request() else { return };
            match request {
                RemoteRequest::Cli(line) => {
                    let changes = Impact::of_line(&line) > Impact::Reads;
                    let purpose =
                        if line == LIST { Purpose::Plan(ticket) } else { Purpose::Line(ticket, changes) };
                    self.ask(purpose, Ask::Line(line));
                }
                RemoteRequest::Msp { code, payload } => {
                    let changes = Impact::of_message(code, &payload) == Impact::Changes;
                    self.ask(Purpose::Message(ticket, changes), Ask::Msp { code, payload });
                }
                RemoteRequest::ReturnHome => self.switch_rescue(vehicle, true),
                RemoteRequest::CancelReturn => self.switch_rescue(vehicle, false),
                RemoteRequest::Restart => {
                    self.ask(Purpose::Nothing, Ask::Msp { code: REBOOT, payload: Vec::new() });
                }
            }
        }
    }

    fn ask(&mut self, purpose: Purpose, ask: Ask) {
        let id = AskId(self.next_ask);
        self.next_ask += 1;
        self.waiting.insert(id, purpose);
        self.client.ask(id, ask);
    }

    /// While nobody else asks: what it is, then how it is.
    fn ask_what_is_due(&mut self, now: Instant) {
        if !self.client.is_idle() {
            return;
        }
        let since = now.saturating_duration_since(self.started);
        let next = match self.state {
            RemoteState::Identifying => match self.identification.next() {
                Some(question) => Some((Purpose::Identity(question), question.ask())),
                None => self.ask_to_provision().map(|ask| (Purpose::Provision, ask)),
            },
            RemoteState::Ready => match self.next_to_refresh(now) {
                Some(question) => Some((Purpose::Refreshed(question), question.ask())),
                None => {
                    let next = self.schedule.next(self.observer.is_armed(), since);
                    next.map(|subject| (Purpose::Polled(subject), subject.ask()))
                }
            },
            // A board that still starts, or a plug that is put into another one, answers later.
            RemoteState::Unusable(_) if !self.is_fed() => self
                .identification
                .next()
                .filter(|question| *question == Question::ApiVersion)
                .map(|question| (Purpose::Identity(question), question.ask())),
            // The connection is there, and nobody answers.
            RemoteState::Lost => Some((Purpose::Nothing, Question::ApiVersion.ask())),
            RemoteState::Connecting | RemoteState::Unusable(_) => None,
        };
        if let Some((purpose, ask)) = next {
            self.ask(purpose, ask);
        }
    }

    /// Delivers what was observed since, and what follows from it.
    fn observe(&mut self, vehicle: &mut Vehicle, now: Instant) {
        self.tell_silence(now);
        self.client.set_armed(self.observer.is_armed());
        if let Some(finding) = self.check_at_rest(vehicle, now) {
            self.notices.push(RemoteNotice::Lost(finding));
        }
        if let Some(seen) = self.observer.first_fix()
            && !vehicle.local_frame().is_some_and(|frame| self.is_fed() || is_near(frame, &seen))
        {
            vehicle.set_origin(seen);
        }
        let frame = vehicle.local_frame().copied();
        let simulated = self.is_fed().then(|| Simulated {
            home_m: frame.map(|frame| frame.alt_amsl_m),
            commanded: self.rescue_switch(vehicle),
        });
        let Some(mailbox) = vehicle.controller_mut().remote_mut() else { return };
        self.observer.deliver(mailbox, frame.as_ref(), simulated);
    }
}

/// Whether a drawing around one place shows the other as it is.
fn is_near(frame: &LocalFrame, other: &LocalFrame) -> bool {
    frame.to_enu(other.lat_deg, other.lon_deg, other.alt_amsl_m).xy().norm() < SAME_FIELD_M
}
