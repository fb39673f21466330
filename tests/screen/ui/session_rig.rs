//! A user interface with a session that flies only on request.

#![allow(dead_code, reason = "tests share this file and use different parts")]
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

use std::sync::Arc;
use std::time::Duration;

use betadeck::firmware::FirmwareOptions;
use betadeck::firmware::config::Configuration;
use betadeck::plan::builtin::{BuiltinPlan, DEMO};
use betadeck::plan::edit::History;
use betadeck::report::sentence;
use betadeck::session::ReplyTo;
use betadeck::session::command::{CliOutput, Seek};
use betadeck::session::{Command, Handle, SessionConfig, start};
use betadeck::signals::SimTime;
use betadeck::sim::{WorldCommand, WorldConfig};
use betadeck::storage::Store;
use betadeck::telemetry::{NavState, Snapshot, Turbulence};
use betadeck::ui::PlanId;
use betadeck::ui::keymap::Keymap;
use betadeck::ui::{
    AppState, CliHelp, Effect, EnteredLines, Msg, OpenPlan, Theme, UiConfig, Units, draw, update,
};
use betadeck::vehicle::{Vehicle, VehicleConfig};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

/// Nothing in these tests takes this long unless it hangs.
const PATIENCE: Duration = Duration::from_secs(600);

/// A user interface with a session that flies only on request.
pub(crate) struct Rig {
    pub(crate) session: Handle,
    pub(crate) state: AppState,
}

impl Rig {
    pub(crate) async fn new() -> Self {
        let mut configuration = Configuration::default();
        configuration.starter_modes();
        let config = VehicleConfig {
            world: WorldConfig { turbulence: Turbulence::Light, ..WorldConfig::default() },
            firmware: FirmwareOptions::default(),
            configuration,
            live: false,
        };
        let session = start(SessionConfig {
            vehicle: Vehicle::new(config).unwrap(),
            store: Store::in_memory(),
            starter_modes: true,
            speed: 1.0,
            takeoff_m: 5.0,
            is_recorded: true,
            endpoints: None,
            remote: None,
            first_events: Vec::new(),
        })
        .unwrap();
        let demo = BuiltinPlan::find(DEMO).unwrap().read().unwrap();
        let config = UiConfig {
            theme: Theme::default(),
            units: Units::default(),
            max_altitude_m: betadeck::plan::estimate::MAX_ALTITUDE_M,
            ground: betadeck::ui::GroundConfig::default(),
            keymap: Keymap::default(),
            cli: CliHelp::default(),
            given_settings: Vec::new(),
            sentence: |event| sentence::text(&event.kind).unwrap_or_default(),
            go_sentence: |name, answer| betadeck::report::campaign::forecast_notice(name, answer, 0.95),
            plan: OpenPlan::new(PlanId(1), None, History::new(demo.into(), true)),
            mouse: true,
            entered: EnteredLines::default(),
            layouts: betadeck::ui::SavedLayouts::default(),
            kept: betadeck::ui::KeptScreens::default(),
            is_first_start: false,
        };
        let view = session.view.borrow().clone();
        let mut rig = Self { session, state: AppState::new(config, (120, 40), view) };
        rig.keys(" ").await;
        rig.until("the pause", |state| state.shared.view.paused).await;
        rig
    }

    /// Presses keys one after another; a line end is Enter.
    pub(crate) async fn keys(&mut self, keys: &str) {
        for key in keys.chars() {
            let code = if key == '\n' { KeyCode::Enter } else { KeyCode::Char(key) };
            let event = KeyEvent::new(code, KeyModifiers::NONE);
            let effects = update(&mut self.state, Msg::Key(event));
            self.carry_out(effects).await;
        }
    }

    /// Sends a line to the craft and returns its answer.
    pub(crate) async fn cli(&self, line: &str) -> CliOutput {
        let (reply, answer) = ReplyTo::channel();
        self.session.commands.send(Command::Cli { line: line.to_owned(), reply }).await.unwrap();
        answer.await.unwrap()
    }

    pub(crate) async fn carry_out(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            match effect {
                Effect::Send(command) => self.session.commands.send(command).await.unwrap(),
                Effect::Upload { id, name, plan, settings } => {
                    let count = plan.waypoints.len();
                    let (reply, answer) = ReplyTo::channel();
                    self.session
                        .commands
                        .send(Command::Upload { name, plan, settings, reply })
                        .await
                        .unwrap();
                    let result = answer.await.unwrap();
                    let next = update(&mut self.state, Msg::UploadReply { id, count, result });
                    Box::pin(self.carry_out(next)).await;
                }
                Effect::ReadSettings => {
                    let (reply, answer) = ReplyTo::channel();
                    self.session.commands.send(Command::ReadSettings { reply }).await.unwrap();
                    let next = update(&mut self.state, Msg::SettingsReply(answer.await.unwrap()));
                    Box::pin(self.carry_out(next)).await;
                }
                Effect::Set(line) => {
                    let (reply, answer) = ReplyTo::channel();
                    let set = line.clone();
                    self.session.commands.send(Command::Cli { line, reply }).await.unwrap();
                    let next =
                        update(&mut self.state, Msg::SetReply { line: set, output: answer.await.ok() });
                    Box::pin(self.carry_out(next)).await;
                }
                Effect::World(line) => {
                    let (reply, answer) = ReplyTo::channel();
                    let change = Box::new(WorldCommand::parse(&line).unwrap());
                    self.session.commands.send(Command::World { change, reply }).await.unwrap();
                    let result = answer.await.unwrap();
                    let next = update(&mut self.state, Msg::WorldReply { line, result });
                    Box::pin(self.carry_out(next)).await;
                }
                Effect::Cli(line) => {
                    let (reply, answer) = ReplyTo::channel();
                    self.session.commands.send(Command::Cli { line, reply }).await.unwrap();
                    let next = update(&mut self.state, Msg::CliReply(answer.await.ok()));
                    Box::pin(self.carry_out(next)).await;
                }
                // Files and forecasts have their own tests.
                Effect::Files(_) | Effect::Forecast(_) => {}
                other => panic!("not expected here: {other:?}"),
            }
        }
    }

    /// Takes pictures and events until the screen matches.
    pub(crate) async fn until(&mut self, what: &str, wanted: impl Fn(&AppState) -> bool) {
        let seen = async {
            loop {
                while let Ok(event) = self.session.events.try_recv() {
                    update(&mut self.state, Msg::Event(event));
                }
                let view = self.session.view.borrow_and_update().clone();
                let mut effects = update(&mut self.state, Msg::View(view));
                effects.retain(|effect| matches!(effect, Effect::ReadSettings));
                self.carry_out(effects).await;
                if wanted(&self.state) {
                    return;
                }
                self.session.view.changed().await.unwrap();
            }
        };
        let in_time = tokio::time::timeout(PATIENCE, seen).await.is_ok();
        assert!(in_time, "never seen: {what}\n{}", self.screen());
        // Events come before the picture that shows them.
        while let Ok(event) = self.session.events.try_recv() {
            update(&mut self.state, Msg::Event(event));
        }
    }

    /// Lets the flight go on to its next transition, which leads to `state`.
    pub(crate) async fn fly_to(&mut self, state: NavState) {
        let from = self.time();
        self.keys("}").await;
        let arrived = |now: &AppState| {
            now.shared.view.vehicle.time > from && now.shared.view.paused && nav_state(now) == Some(state)
        };
        self.until(state.into(), arrived).await;
    }

    /// Shows the instant at this time.
    pub(crate) async fn show(&mut self, time: SimTime) {
        self.session.commands.send(Command::Seek(Seek::Time(time))).await.unwrap();
        self.until("an instant", |state| state.shared.view.vehicle.time == time).await;
    }

    pub(crate) fn time(&self) -> SimTime {
        self.state.shared.view.vehicle.time
    }

    pub(crate) fn picture(&self) -> Arc<Snapshot> {
        Arc::clone(&self.state.shared.view.vehicle)
    }

    pub(crate) fn screen(&self) -> String {
        let (width, height) = self.state.shared.size;
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| draw(&self.state, frame)).unwrap();
        terminal.backend().to_string()
    }

    #[track_caller]
    pub(crate) fn assert_shown(&self, words: &[&str]) {
        let screen = self.screen();
        for word in words {
            assert!(screen.contains(word), "no {word} in\n{screen}");
        }
    }
}

pub(crate) fn nav_state(state: &AppState) -> Option<NavState> {
    state.shared.view.vehicle.nav.as_ref().map(|nav| nav.state)
}
