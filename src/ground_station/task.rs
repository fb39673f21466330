//! The task of the door: moves bytes between the sockets and the protocol, and requests between the protocol and the session.
#![allow(clippy::disallowed_methods, reason = "ground stations live in wall time")]

use std::net::SocketAddr;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use tokio::sync::{mpsc, oneshot, watch};
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::answers::{Waiting, outcome, shortened, taken, without_effect};
use super::controls::{self, Controls, Refused, Until};
use super::rc::rc_frame;
use super::sockets::{DoorError, Incoming, Sockets};
use super::state::{craft_state, home, is_on_ground};
use super::texts::{Texts, ascii};
use super::{GroundStationOptions, missions, parameters};
use crate::fc::CraftSettings;
use crate::mavlink::MissionItem;
use crate::mavlink::craft::{Answer, CraftOptions, CraftProtocol, Lifetime, Request, RequestKind, Ticket};
use crate::mavlink::value::{CommandResult, MissionResult};
use crate::plan::FlightPlan;
use crate::session::command::CliOutput;
use crate::session::{Command, ReplyTo, SessionView};
use crate::signals::RcSource;
use crate::telemetry::snapshot::SettingsView;
use crate::telemetry::{NavState, PlanSource};
use crate::vehicle::VehicleCommand;

/// The interval of the task.
const STEP: Duration = Duration::from_millis(20);
/// The time after which a switch that had no effect is refused.
const PATIENCE: Duration = Duration::from_millis(3500);
/// The altitude of a take-off without one, m.
const TAKEOFF_M: f64 = 10.0;
/// The most items of a mission: a plan has fewer waypoints, but some items are no waypoints.
const MAX_MISSION: u16 = 250;

/// A door whose sockets are open, before the session begins.
#[derive(Debug)]
pub struct BoundDoor {
    options: GroundStationOptions,
    sockets: Sockets,
    stop: CancellationToken,
    tasks: TaskTracker,
}

/// An open door.
#[derive(Debug)]
pub struct Door {
    stop: CancellationToken,
    tasks: TaskTracker,
}

impl Door {
    /// Closes the door and waits for its end.
    pub async fn close(self) {
        self.stop.cancel();
        self.tasks.close();
        self.tasks.wait().await;
    }
}

impl BoundDoor {
    /// Opens the sockets. A place that cannot be opened is returned as an error; the others work.
    pub async fn bind(options: GroundStationOptions) -> (Self, Vec<DoorError>) {
        let (stop, tasks) = (CancellationToken::new(), TaskTracker::new());
        let (sockets, errors) = Sockets::open(&options.places, &stop, &tasks).await;
        (Self { options, sockets, stop, tasks }, errors)
    }

    /// Returns the addresses on which it listens.
    pub fn listening(&self) -> &[SocketAddr] {
        &self.sockets.listening
    }

    /// Serves a session from now on.
    pub fn serve(self, orders: mpsc::Sender<Command>, view: watch::Receiver<SessionView>) -> Door {
        let version = [
            env!("CARGO_PKG_VERSION_MAJOR"),
            env!("CARGO_PKG_VERSION_MINOR"),
            env!("CARGO_PKG_VERSION_PATCH"),
        ];
        let protocol = CraftProtocol::new(CraftOptions {
            identity: self.options.identity,
            version: version.map(|part| part.parse().unwrap_or(0)),
            max_mission: MAX_MISSION,
            takes_rc: self.options.takes_rc,
            is_read_only: self.options.is_read_only,
            ..CraftOptions::default()
        });
        let task = Task {
            protocol,
            sockets: self.sockets,
            orders,
            view,
            began: Instant::now(),
            unix_at_boot: SystemTime::now().duration_since(UNIX_EPOCH).ok(),
            controls: Controls::default(),
            texts: Texts::default(),
            home_amsl_m: None,
            stored: (None, false),
            items: Vec::new(),
            reached: None,
            flown_to: None,
            settings: None,
            shown_settings: None,
            reading: None,
            waiting: Vec::new(),
        };
        self.tasks.spawn(task.run(self.stop.clone()));
        Door { stop: self.stop, tasks: self.tasks }
    }
}

struct Task {
    protocol: CraftProtocol,
    sockets: Sockets,
    orders: mpsc::Sender<Command>,
    view: watch::Receiver<SessionView>,
    began: Instant,
    unix_at_boot: Option<Duration>,
    controls: Controls,
    texts: Texts,
    /// The altitude of home above sea level, m, as it was on the ground.
    home_amsl_m: Option<f64>,
    /// The plan of the present items, and whether home was known.
    stored: (Option<FlightPlan>, bool),
    items: Vec<MissionItem>,
    /// The waypoint that was reported as reached.
    reached: Option<u8>,
    /// The waypoint that is flown to.
    flown_to: Option<u8>,
    settings: Option<Box<CraftSettings>>,
    /// The settings in the view when they were read last.
    shown_settings: Option<SettingsView>,
    reading: Option<oneshot::Receiver<Result<Box<CraftSettings>, String>>>,
    waiting: Vec<Waiting>,
}

impl Task {
    async fn run(mut self, stop: CancellationToken) {
        for peer in self.sockets.targets().collect::<Vec<_>>() {
            self.protocol.connect(Duration::ZERO, peer, Lifetime::UntilDisconnected);
        }
        let mut ticks = tokio::time::interval(STEP);
        ticks.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                () = stop.cancelled() => return,
                incoming = self.sockets.next() => self.take(incoming),
                _ = ticks.tick() => self.step(),
            }
            while let Some((peer, packet)) = self.protocol.poll_transmit() {
                self.sockets.send(peer, packet);
            }
        }
    }

    fn now(&self) -> Duration {
        self.began.elapsed()
    }

    fn take(&mut self, incoming: Incoming) {
        let now = self.now();
        self.sockets.note(&incoming);
        match incoming {
            Incoming::Connected(peer, _) => {
                self.protocol.connect(now, peer, Lifetime::UntilDisconnected);
            }
            Incoming::Disconnected(peer) => self.protocol.disconnect(peer),
            Incoming::Bytes(peer, bytes) => {
                self.protocol.receive(now, peer, &bytes);
                self.serve(now);
            }
            Incoming::Stranger => {}
        }
    }

    /// Brings telemetry, texts and answers up to date.
    fn step(&mut self) {
        let now = self.now();
        let view = self.view.borrow_and_update().clone();
        self.follow(&view);
        let unix = self.unix_at_boot.map(|boot| boot + Duration::from_micros(view.vehicle.time.0));
        let mut state = craft_state(&view, self.home_amsl_m, unix);
        if let (Some(current), Some(plan)) = (state.mission.current, &self.stored.0) {
            state.mission.current = missions::item_of_waypoint(&self.items, plan, current).or(Some(0));
        }
        for (severity, text) in self.texts.follow(&view) {
            self.protocol.status_text(severity, &ascii(&text));
        }
        let commands = self.controls.advance(&view, now);
        commands.into_iter().for_each(|command| _ = self.order(command));
        self.protocol.advance(now, Duration::from_micros(view.vehicle.time.0), &state);
        self.serve(now);
        self.answer_waiting(&view, now);
    }

    /// Follows home, plan and settings of the craft.
    fn follow(&mut self, view: &SessionView) {
        let vehicle = &*view.vehicle;
        let gps = vehicle.craft.gps.filter(|_| vehicle.craft.has_fix());
        if let Some(gps) = gps.filter(|_| self.home_amsl_m.is_none() || !vehicle.craft.is_armed()) {
            self.home_amsl_m =
                Some(gps.alt_amsl_m - vehicle.estimate.alt.filter(|_| !is_on_ground(vehicle)).unwrap_or(0.0));
        }
        let home = home(vehicle, self.home_amsl_m);
        if self.stored.0 != vehicle.stored_plan || self.stored.1 != home.is_some() {
            self.stored = (vehicle.stored_plan.clone(), home.is_some());
            let items =
                vehicle.stored_plan.as_ref().zip(home).map(|(plan, home)| missions::items(plan, &home));
            self.items = items.unwrap_or_default();
            self.protocol.set_mission(self.items.clone());
        }
        if let Some(nav) = vehicle.nav.as_ref().filter(|nav| nav.engaged) {
            // The next waypoint of the same plan begins where the last one was reached, perhaps between two views.
            let is_next = self.flown_to.is_some_and(|wp| wp < nav.wp) && nav.source == PlanSource::Stored;
            let has_arrived = !matches!(nav.state, NavState::Approaching | NavState::Idle);
            let reached = if is_next { self.flown_to } else { Some(nav.wp).filter(|_| has_arrived) };
            self.flown_to = Some(nav.wp);
            if let Some(wp) = reached.filter(|_| self.reached != reached) {
                self.reached = reached;
                let plan = self.stored.0.as_ref();
                if let Some(item) =
                    plan.and_then(|plan| missions::item_of_waypoint(&self.items, plan, u16::from(wp)))
                {
                    self.protocol.item_reached(item);
                }
            }
        } else {
            (self.reached, self.flown_to) = (None, None);
        }
        if self.reading.is_none() && (self.settings.is_none() || self.shown_settings != vehicle.settings) {
            let (reply, settings) = ReplyTo::channel();
            if self.order(Command::ReadSettings { reply }) {
                self.shown_settings = vehicle.settings;
                self.reading = Some(settings);
            }
        }
        if let Some(answer) = self.reading.as_mut().and_then(taken) {
            self.reading = None;
            // A firmware that is not ready yet is asked again when it reports its settings.
            self.settings = Some(answer.ok().and_then(Result::ok).unwrap_or_default());
            let table = self.settings.as_ref().map(|settings| parameters::table(settings));
            self.protocol.set_parameters(&table.unwrap_or_default());
        }
    }

    /// Sends a command to the session. Returns `false` if its queue is full.
    fn order(&self, command: Command) -> bool {
        self.orders.try_send(command).is_ok()
    }

    /// Carries out the requests of ground stations.
    fn serve(&mut self, now: Duration) {
        let view = self.view.borrow().clone();
        while let Some(Request { ticket, kind, .. }) = self.protocol.poll_request() {
            self.carry_out(ticket, kind, &view, now);
        }
        while let Some((_, input)) = self.protocol.poll_rc() {
            let frame = rc_frame(&view, &input);
            self.order(Command::Vehicle(VehicleCommand::Rc(frame, RcSource::Udp)));
        }
    }

    fn carry_out(&mut self, ticket: Ticket, kind: RequestKind, view: &SessionView, now: Duration) {
        let controls = &mut self.controls;
        let at_once = |commands| (commands, Until::Now);
        let commands = match kind {
            RequestKind::Mission { items, .. } => return self.upload(ticket, &items, view),
            RequestKind::SetParameter { name, value } => return self.set_parameter(ticket, name, value),
            RequestKind::Fence(_) => {
                let lines =
                    ["Fences are set by the parameter AP_FENCE_DIST, a circle around home.".to_owned()];
                self.protocol.answer(ticket, Answer::Mission(MissionResult::Unsupported), &lines);
                return;
            }
            RequestKind::Arm => controls.arm(view, now),
            RequestKind::Disarm => controls.disarm(view, now),
            RequestKind::TakeOff { altitude } => controls
                .take_off(view, altitude.filter(|alt| *alt > 0.0).unwrap_or(TAKEOFF_M), now)
                .map(at_once),
            RequestKind::Land => controls.land(view, now).map(at_once),
            RequestKind::ReturnHome => controls.return_home(view, now).map(at_once),
            RequestKind::StartMission => controls.start_mission(view, now),
            RequestKind::Pause => controls.pause(view, now).map(at_once),
            RequestKind::Continue => controls.resume(view, now),
            RequestKind::SetMode(mode) => controls.set_mode(view, mode, now),
            RequestKind::SetCurrent(item) => {
                let plan = self.stored.0.as_ref();
                match plan.and_then(|plan| missions::waypoint_of_item(&self.items, plan, item)) {
                    Some(waypoint) => controls.go_to(view, waypoint).map(at_once),
                    None => {
                        Err((CommandResult::Denied, format!("The mission has no item {item} to fly to.")))
                    }
                }
            }
            RequestKind::SetHome(_) => {
                Err((CommandResult::Unsupported, "Home is where the craft was armed.".to_owned()))
            }
            RequestKind::Reboot if view.vehicle.craft.is_armed() => {
                Err((CommandResult::Denied, "An armed craft does not restart.".to_owned()))
            }
            RequestKind::Reboot => {
                let (reply, _) = ReplyTo::channel();
                Ok((vec![Command::Cli { line: "exit".to_owned(), reply }], Until::Now))
            }
        };
        let checked = commands.and_then(|(commands, until)| {
            controls::check(view, &commands)?;
            Ok((commands, until))
        });
        match checked {
            Err(refused) => self.refuse(ticket, refused),
            Ok((commands, until)) => {
                let all_taken = commands.into_iter().all(|command| self.order(command));
                match until {
                    _ if !all_taken => {
                        let busy = "The session is busy: try again.".to_owned();
                        self.refuse(ticket, (CommandResult::TemporarilyRejected, busy));
                    }
                    Until::Now => self.protocol.answer(ticket, Answer::Command(CommandResult::Accepted), &[]),
                    until => self.waiting.push(Waiting::Switch(ticket, until, now + PATIENCE)),
                }
            }
        }
    }

    fn refuse(&mut self, ticket: Ticket, (result, sentence): Refused) {
        self.protocol.answer(ticket, Answer::Command(result), &[ascii(&sentence)]);
    }

    fn upload(&mut self, ticket: Ticket, items: &[MissionItem], view: &SessionView) {
        let home = home(&view.vehicle, self.home_amsl_m);
        let (plan, lines) = match missions::plan(items, home.as_ref()) {
            Ok(mission) => mission,
            Err((result, lines)) => {
                self.protocol.answer(ticket, Answer::Mission(result), shortened(lines).as_slice());
                return;
            }
        };
        let (reply, uploaded) = ReplyTo::channel();
        let name = missions::NAME.to_owned();
        let upload = Command::Upload { name, plan: Box::new(plan), settings: Vec::new(), reply };
        match controls::check(view, std::slice::from_ref(&upload)) {
            Ok(()) if self.order(upload) => self.waiting.push(Waiting::Upload(ticket, uploaded, lines)),
            Ok(()) => self.protocol.answer(ticket, Answer::Mission(MissionResult::Error), &[]),
            Err((_, sentence)) => {
                self.protocol.answer(ticket, Answer::Mission(MissionResult::Denied), &[sentence]);
            }
        }
    }

    fn set_parameter(&mut self, ticket: Ticket, name: String, number: f32) {
        let setting = self.settings.as_ref().and_then(|settings| parameters::find(settings, &name));
        let Some(setting) = setting else {
            self.protocol.answer(ticket, Answer::Parameter(0.0), &[]);
            return;
        };
        let old = parameters::number(setting).unwrap_or(0.0);
        match parameters::value(setting, number) {
            Err(sentence) => self.protocol.answer(ticket, Answer::Parameter(old), &[sentence]),
            Ok(value) => {
                let (reply, answer) = ReplyTo::channel();
                self.order(Command::Cli { line: format!("set {} = {value}", setting.name), reply });
                self.waiting.push(Waiting::Setting(ticket, name, number, answer));
            }
        }
    }

    /// Answers the requests whose outcome is known now.
    fn answer_waiting(&mut self, view: &SessionView, now: Duration) {
        let mut still = Vec::new();
        for waiting in std::mem::take(&mut self.waiting) {
            match waiting {
                Waiting::Switch(ticket, until, deadline) => match outcome(view, until) {
                    Some(true) => {
                        self.protocol.answer(ticket, Answer::Command(CommandResult::Accepted), &[]);
                    }
                    _ if now < deadline => still.push(Waiting::Switch(ticket, until, deadline)),
                    _ => {
                        self.refuse(
                            ticket,
                            (CommandResult::TemporarilyRejected, without_effect(view, until)),
                        );
                    }
                },
                Waiting::Upload(ticket, mut uploaded, mut lines) => match taken(&mut uploaded) {
                    None => still.push(Waiting::Upload(ticket, uploaded, lines)),
                    Some(Ok(Ok(_))) => {
                        self.protocol.answer(
                            ticket,
                            Answer::Mission(MissionResult::Accepted),
                            shortened(lines).as_slice(),
                        );
                    }
                    Some(Ok(Err(sentence))) => {
                        lines.insert(0, sentence);
                        self.protocol.answer(
                            ticket,
                            Answer::Mission(MissionResult::Error),
                            shortened(lines).as_slice(),
                        );
                    }
                    Some(Err(())) => self.protocol.answer(ticket, Answer::Mission(MissionResult::Error), &[]),
                },
                Waiting::Setting(ticket, name, number, mut answer) => match taken(&mut answer) {
                    None => still.push(Waiting::Setting(ticket, name, number, answer)),
                    Some(answer) => self.answer_setting(ticket, &name, number, answer.ok()),
                },
            }
        }
        self.waiting = still;
    }

    fn answer_setting(&mut self, ticket: Ticket, name: &str, number: f32, answer: Option<CliOutput>) {
        let text = answer.map(|answer| answer.text).unwrap_or_default();
        let settings = self.settings.as_deref_mut();
        let Some(setting) =
            settings.and_then(|all| all.all.iter_mut().find(|at| parameters::alias(&at.name) == name))
        else {
            return;
        };
        if text.contains("set to") {
            setting.value = parameters::value(setting, number).unwrap_or_default();
            self.protocol.answer(ticket, Answer::Parameter(number), &[]);
            // The settings are read again, because one may change others.
            self.shown_settings = None;
        } else {
            let old = parameters::number(setting).unwrap_or(0.0);
            let said = text
                .lines()
                .map(str::trim)
                .find(|line| !line.is_empty())
                .unwrap_or("The craft did not answer.");
            self.protocol.answer(ticket, Answer::Parameter(old), &[said.to_owned()]);
        }
        if let Some(settings) = &self.settings {
            self.protocol.set_parameters(&parameters::table(settings));
        }
    }
}
