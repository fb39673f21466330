//! The task of the door: moves bytes between the sockets and the protocol, and requests between the protocol and the session.
#![allow(clippy::disallowed_methods, reason = "ground stations live in wall time")]

use std::net::SocketAddr;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use tokio::sync::{mpsc, oneshot, watch};
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::answers::{Waiting, as_set, outcome, shortened, taken, without_effect};
use super::controls::{self, Controls, Refused, Until};
use super::rc::rc_frame;
use super::sockets::{DoorError, Incoming, Sockets};
use super::state::{craft_state, home, is_on_ground};
use super::texts::{Texts, ascii};
use super::{GroundStationOptions, fences, parameters};
use crate::fc::CraftSettings;
use crate::fc::missions::{self, Mission};
use crate::mavlink::MissionItem;
use crate::mavlink::craft::{Answer, CraftOptions, CraftProtocol, Lifetime, Request, RequestKind, Ticket};
use crate::mavlink::value::{CommandResult, MissionResult};
use crate::plan::FlightPlan;
use crate::session::{Command, ReplyTo, SessionView};
use crate::signals::RcSource;
use crate::telemetry::snapshot::SettingsView;
use crate::telemetry::{NavState, PlanSource};
use crate::vehicle::VehicleCommand;

/// The interval of the task.
const STEP: Duration = Duration::from_millis(20);
/// The time after which a switch that had no effect is refused.
const PATIENCE: Duration = Duration::from_millis(3500);
/// The time within which a plan that was uploaded is shown as the stored one. A firmware may store it with other values.
const UNTIL_SHOWN: Duration = Duration::from_millis(500);
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
            max_fence: fences::MAX_ITEMS,
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
            mission: Mission::default(),
            fence: None,
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
    mission: Mission,
    fence: Option<MissionItem>,
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
        // Before the rest, so that a ground station that has its answer reads what is new.
        self.answer_waiting(&view, now);
        self.follow(&view);
        let unix = self.unix_at_boot.map(|boot| boot + Duration::from_micros(view.vehicle.time.0));
        let mut state = craft_state(&view, self.home_amsl_m, unix);
        state.mission.current =
            state.mission.current.map(|waypoint| self.mission.item_of_waypoint(waypoint).unwrap_or(0));
        for (severity, text) in self.texts.follow(&view) {
            self.protocol.status_text(severity, &ascii(&text));
        }
        let commands = self.controls.advance(&view, now);
        commands.into_iter().for_each(|command| _ = self.order(command));
        self.protocol.advance(now, Duration::from_micros(view.vehicle.time.0), &state);
        self.serve(now);
        self.sockets.forget(|peer| self.protocol.peers().any(|known| known.id == peer));
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
            let plan = vehicle.stored_plan.as_ref().zip(home);
            self.mission = plan.map(|(plan, home)| Mission::of_plan(plan, &home)).unwrap_or_default();
            self.protocol.set_mission(self.mission.items.clone());
        }
        let setting = self.settings.as_ref().and_then(|settings| settings.find(fences::SETTING));
        let fence = fences::item(setting.and_then(parameters::number), home.as_ref());
        if self.fence != fence {
            self.fence = fence;
            self.protocol.set_fence(fence.into_iter().collect());
        }
        if let Some(nav) = vehicle.nav.as_ref().filter(|nav| nav.engaged) {
            // The next waypoint of the same plan begins where the last one was reached, perhaps between two views.
            let is_next = self.flown_to.is_some_and(|wp| wp < nav.wp) && nav.source == PlanSource::Stored;
            let has_arrived = !matches!(nav.state, NavState::Approaching | NavState::Idle);
            let reached = if is_next { self.flown_to } else { Some(nav.wp).filter(|_| has_arrived) };
            self.flown_to = Some(nav.wp);
            if let Some(wp) = reached.filter(|_| self.reached != reached) {
                self.reached = reached;
                if let Some(item) = self.mission.item_of_waypoint(u16::from(wp)) {
                    self.protocol.item_reached(item);
                }
            }
        } else {
            (self.reached, self.flown_to) = (None, None);
        }
        let shown = vehicle.settings.map(SettingsView::chosen);
        if self.reading.is_none() && (self.settings.is_none() || self.shown_settings != shown) {
            let (reply, settings) = ReplyTo::channel();
            if self.order(Command::ReadSettings { reply }) {
                self.shown_settings = shown;
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
            RequestKind::SetParameter { name, value } => {
                let setting = self.settings.as_ref().and_then(|settings| parameters::find(settings, &name));
                let name = setting.map_or(name, |setting| setting.name.clone());
                return self.change(ticket, name, value);
            }
            RequestKind::Fence(items) => return self.set_fence(ticket, &items, view),
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
                let waypoint = self.mission.waypoint_of_item(item);
                let none = || (CommandResult::Denied, format!("The mission has no item {item} to fly to."));
                waypoint.ok_or_else(none).and_then(|waypoint| controls.go_to(view, waypoint)).map(at_once)
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
                return self.answer_upload(ticket, result, lines);
            }
        };
        let (reply, uploaded) = ReplyTo::channel();
        let name = missions::NAME.to_owned();
        let upload = Command::Upload { name, plan: Box::new(plan.clone()), settings: Vec::new(), reply };
        match controls::check(view, std::slice::from_ref(&upload)) {
            Ok(()) if self.order(upload) => self.waiting.push(Waiting::Upload(ticket, uploaded, plan, lines)),
            Ok(()) => self.answer_upload(ticket, MissionResult::Error, Vec::new()),
            Err((_, sentence)) => self.answer_upload(ticket, MissionResult::Denied, vec![sentence]),
        }
    }

    fn set_fence(&mut self, ticket: Ticket, items: &[MissionItem], view: &SessionView) {
        match fences::radius_m(items, home(&view.vehicle, self.home_amsl_m).as_ref()) {
            Ok(radius) => self.change(ticket, fences::SETTING.to_owned(), radius),
            Err(why) => {
                self.protocol.answer(ticket, Answer::Mission(MissionResult::Unsupported), &[ascii(&why)]);
            }
        }
    }

    /// Changes a setting, for a parameter or a fence.
    fn change(&mut self, ticket: Ticket, name: String, number: f32) {
        let setting = self.settings.as_ref().and_then(|settings| settings.find(&name));
        let unknown = || format!("The craft has not reported the setting {name} yet: try again.");
        match setting.ok_or_else(unknown).and_then(|setting| parameters::value(setting, number)) {
            Err(sentence) => self.refuse(ticket, (CommandResult::Denied, sentence)),
            Ok(value) => {
                let (reply, answer) = ReplyTo::channel();
                self.order(Command::Cli { line: format!("set {name} = {value}"), reply });
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
                Waiting::Upload(ticket, mut uploaded, plan, mut lines) => match taken(&mut uploaded) {
                    None => still.push(Waiting::Upload(ticket, uploaded, plan, lines)),
                    Some(Ok(Ok(_))) => still.push(Waiting::Shown(ticket, plan, lines, now + UNTIL_SHOWN)),
                    Some(Ok(Err(sentence))) => {
                        lines.insert(0, sentence);
                        self.answer_upload(ticket, MissionResult::Error, lines);
                    }
                    Some(Err(())) => self.answer_upload(ticket, MissionResult::Error, Vec::new()),
                },
                Waiting::Shown(ticket, plan, lines, deadline) => {
                    let is_shown = view.vehicle.stored_plan.as_ref() == Some(&plan);
                    if is_shown || now >= deadline {
                        self.answer_upload(ticket, MissionResult::Accepted, lines);
                    } else {
                        still.push(Waiting::Shown(ticket, plan, lines, deadline));
                    }
                }
                Waiting::Setting(ticket, name, number, mut answer) => match taken(&mut answer) {
                    None => still.push(Waiting::Setting(ticket, name, number, answer)),
                    Some(answer) => self.answer_setting(ticket, &name, number, as_set(answer)),
                },
            }
        }
        self.waiting = still;
    }

    fn answer_upload(&mut self, ticket: Ticket, result: MissionResult, lines: Vec<String>) {
        self.protocol.answer(ticket, Answer::Mission(result), &shortened(lines));
    }

    fn answer_setting(&mut self, ticket: Ticket, name: &str, number: f32, outcome: Result<(), String>) {
        if let Err(said) = outcome {
            // The answer to a parameter that is refused is its old value.
            return self.refuse(ticket, (CommandResult::Denied, said));
        }
        if let Some(settings) = self.settings.as_deref_mut() {
            if let Some(setting) = settings.find_mut(name) {
                setting.value = parameters::value(setting, number).unwrap_or_default();
            }
            self.protocol.set_parameters(&parameters::table(settings));
        }
        self.protocol.answer(ticket, Answer::Parameter(number), &[]);
        // The settings are read again, because one may change others. A reading from before has the old value.
        (self.shown_settings, self.reading) = (None, None);
    }
}
