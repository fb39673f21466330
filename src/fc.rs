//! A remote flight controller: sends it the contents of the vehicle's mailbox and delivers its answers.
//!
//! ```text
//!                    ┌── sensor and RC frames ──▶ SitlPeer ──▶ UDP        (a SITL executable only)
//!  vehicle's mailbox ┤◀─ motors ─────────────────┘
//!                    ├── lines, messages ───────▶ FcClient ──▶ FcStream   (TCP, serial, websocket)
//!                    └◀─ answers, telemetry ── Observer ◀── polling ──┘
//! ```
//!
//! `client` exchanges messages and lines over the serial port, `polling` chooses the next message, `telemetry`
//! decodes the replies, and the observer makes snapshots and events from them. `upload` and `provision` write
//! a plan and settings. Nothing here blocks: [`RemoteLink::exchange`] is called between two steps.

mod answers;
pub mod client;
mod identify;
mod landing_gains;
mod observer;
mod patience;
mod permission;
pub mod polling;
mod provision;
mod refresh;
mod reply;
mod rescue;
mod self_check;
mod silence;
mod starter;
mod stream;
pub mod telemetry;
#[cfg(test)]
mod tests;
mod upload;
mod view;

use std::collections::BTreeMap;
use std::task::Context;
use std::time::{Duration, Instant};

use crate::fc::client::{Ask, AskId, FcClient};
use crate::fc::polling::{Poll as Subject, Schedule};
use crate::geo::LocalFrame;
use crate::link::proto::sitl_feed::FeedState;
use crate::link::{ChildEvent, FcStream, SitlChild, SitlPeer};
use crate::signals::MotorCommand;
use crate::telemetry::EndpointStatus;
use crate::vehicle::{FrameOut, RemoteRequest, Ticket, Vehicle};
use identify::{Identification, Question};
pub use landing_gains::replace_falling_gains;
use observer::{Observer, Simulated};
pub use patience::{NotReady, Patience, Unready};
use permission::Permission;
pub use permission::{Access, Denial, Impact, NOT_PERMITTED, NOTHING_MOVES, NOTHING_SIMULATED};
pub use provision::{Provision, ProvisionLines, Unset, UnsetLine};
use refresh::Refresh;
use self_check::SelfCheck;
use silence::Silence;
pub use starter::{guide_settings, starter_lines};
pub use upload::{
    LIST, Upload, UploadProgress, UploadReport, UploadView, plan_above_home, plan_of_list, upload,
};
pub use view::{RemoteNotice, RemoteState, RemoteView};

/// The message that restarts a flight controller.
const REBOOT: u16 = 68;
/// The simulated time between two exchanges at real time, µs.
const EXCHANGE_US: f64 = 1000.0;
/// The least wall time between two exchanges. Lost time is made up for at twice the speed.
pub const EXCHANGE_PAUSE: Duration = Duration::from_micros(500);
/// The maximum number of events of the child process between two steps. A process that prints much must not
/// hold up the craft.
const MOST_EVENTS: usize = 64;
/// The greatest distance between the first fixes of two real craft for which the drawing keeps its origin, m.
const SAME_FIELD_M: f64 = 1000.0;
/// The longest time that a program may take for its first answer.
const FIRST_ANSWER: Duration = Duration::from_secs(10);

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

/// The purpose of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// A line for a part of this program. `true` if it may change something.
    Line(Ticket, bool),
    /// The line that shows the plan, for a part of this program.
    Plan(Ticket),
    /// A message for a part of this program. `true` if it may change something.
    Message(Ticket, bool),
    /// A question about its identity.
    Identity(Question),
    Provision,
    /// A poll for the display.
    Polled(Subject),
    /// A question about its current settings.
    Refreshed(Question),
    /// No purpose; the effect is observed elsewhere.
    Nothing,
}

/// The link to a remote flight controller.
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
    /// The time of the first connection.
    first_connected: Option<Instant>,
    /// The time of the current connection, until the notice that it is silent.
    connected: Option<Instant>,
    /// `true` once data came over the current connection, or the last one.
    heard: bool,
    /// The last reported reason for a lost connection; `None` once data has arrived since.
    reported_loss: Option<String>,
    /// The number of requests that it has answered since the first start of its program. Motor packets do not
    /// count.
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
    /// Creates a link over these ends. A program that is a child of this one starts now.
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
            reported_loss: None,
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

    /// Returns the state of the link.
    pub fn state(&self) -> &RemoteState {
        &self.state
    }

    /// Returns the view for the display.
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

    /// Returns the permitted access.
    pub fn access(&self) -> Access {
        if self.is_fed() { Access::Everything } else { self.permission.access() }
    }

    /// Returns the number of requests that it has answered. Motor packets do not count.
    pub fn answers(&self) -> u64 {
        self.answers
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

    /// Permits changes over this connection. Permission for an earlier connection has no effect.
    pub fn permit_changes(&mut self, connection: u32) {
        self.permission.permit(connection);
        self.tell_client();
    }

    /// Passes the current permission on to the client.
    fn tell_client(&mut self) {
        self.client.set_cli(self.permission.cli());
        self.client.set_may_leave_cli(self.access() != Access::Reading);
    }

    /// Returns the name for sentences.
    pub fn name(&self) -> &str {
        &self.ends.name
    }

    /// Returns the settings that were not applied as requested.
    pub fn unset(&self) -> Option<&Unset> {
        self.unset.as_ref()
    }

    /// Returns the observed state of the flight controller.
    pub fn observer(&self) -> &Observer {
        &self.observer
    }

    /// Returns `true` if this program feeds it with the states of the craft, at the rate of the steps.
    pub fn is_fed(&self) -> bool {
        self.ends.peer.is_some()
    }

    /// Returns the maximum number of steps of `step_us` at `speed` times real time that may be flown before
    /// the next exchange. If only the machine was held up, the motor command must not stay the same for many
    /// steps.
    pub fn most_steps(&self, step_us: u64, speed: f64, now: Instant) -> u64 {
        match &self.ends.peer {
            None => u64::MAX,
            Some(peer) if peer.waits(now) => 0,
            Some(_) => ((EXCHANGE_US / step_us as f64 * speed).ceil() as u64).max(1),
        }
    }

    /// Returns its status as an endpoint.
    pub fn status(&self, now: Instant) -> Vec<EndpointStatus> {
        self.ends.peer.iter().map(|peer| peer.status(now)).collect()
    }

    /// Sends the contents of the vehicle's mailbox and delivers the data received since. Returns the notices
    /// for the user. If a context is given, the caller is woken when more data arrives over the serial port.
    pub fn exchange(
        &mut self,
        vehicle: &mut Vehicle,
        context: Option<&mut Context<'_>>,
        now: Instant,
    ) -> Vec<RemoteNotice> {
        self.follow_program(vehicle);
        self.read_stream(vehicle, context, now);
        self.exchange_frames(vehicle, now);
        // First, so that a question that was just answered is not sent again.
        self.take_answers(vehicle, now);
        self.take_requests(vehicle);
        self.ask_what_is_due(now);
        self.client.poll(now.saturating_duration_since(self.started));
        self.write_stream();
        self.observe(vehicle, now);
        std::mem::take(&mut self.notices)
    }

    /// Reports the events of its program.
    fn follow_program(&mut self, vehicle: &mut Vehicle) {
        for _ in 0..MOST_EVENTS {
            let Some(event) = self.ends.child.as_mut().and_then(SitlChild::take_event) else { return };
            match event {
                ChildEvent::Started => {}
                ChildEvent::Line(line) => self.notices.push(RemoteNotice::Output(line)),
                ChildEvent::NotShown(count) => self
                    .notices
                    .push(RemoteNotice::Reported(format!("Lines of the firmware's output that were not shown: {count}."))),
                ChildEvent::Failed(reason) => self.give_up(format!("{} cannot be started: {reason}.", self.ends.name)),
                ChildEvent::Ended(end) if self.answers == 0 => self.give_up(format!(
                    "{} ended {end} before it answered: is it a SITL executable of Betaflight, and are its ports free?",
                    self.ends.name
                )),
                ChildEvent::Ended(end) => {
                    let notice = if end.is_reboot() {
                        "The firmware restarts; the craft is back at home.".to_owned()
                    } else {
                        format!("The firmware ended {end}: it is restarted, and the craft is back at home.")
                    };
                    self.restart(vehicle, notice);
                }
            }
        }
    }

    /// Begins another run of an executable that ended. The craft is at home.
    fn restart(&mut self, vehicle: &mut Vehicle, notice: String) {
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

    /// Sends sensor and RC frames, and receives motors.
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
                    // After a delay of several steps, only the newest state is sent.
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
            let sentence = "The firmware has sent no motors for a second: they are stopped until it does.";
            self.notices.push(RemoteNotice::Lost(sentence.to_owned()));
        } else if motors == FeedState::Answering && self.motors == FeedState::Silent {
            self.notices.push(RemoteNotice::Reported("The firmware sends motors again.".to_owned()));
        }
        self.motors = motors;
    }

    /// Sends the requests of other parts of this program.
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

    /// Asks for the identity, then for the state, while there are no other requests.
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
            // A board that is still starting answers later, as does one that is plugged in later.
            RemoteState::Unusable(_) if !self.is_fed() => self
                .identification
                .next()
                .filter(|question| *question == Question::ApiVersion)
                .map(|question| (Purpose::Identity(question), question.ask())),
            // The connection is there, but nothing answers.
            RemoteState::Lost => Some((Purpose::Nothing, Question::ApiVersion.ask())),
            RemoteState::Connecting | RemoteState::Unusable(_) => None,
        };
        if let Some((purpose, ask)) = next {
            self.ask(purpose, ask);
        }
    }

    /// Delivers the observations and handles their consequences.
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

/// Returns `true` if a drawing around one place also shows the other undistorted.
fn is_near(frame: &LocalFrame, other: &LocalFrame) -> bool {
    frame.to_enu(other.lat_deg, other.lon_deg, other.alt_amsl_m).xy().norm() < SAME_FIELD_M
}
