//! The request handler between the links and a firmware, with a given time: RC that arrives in wall time, and the
//! effects of clients on each other.

#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "tests may panic, and give the handler its time"
)]

use std::time::{Duration, Instant};

use betadeck::firmware::cli::Interpreter;
use betadeck::firmware::config::Configuration;
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::link::proto::command_line::{AfterLine, LineReply, LineSource};
use betadeck::link::{ClientId, ListenConfig, Listeners, Request};
use betadeck::session::{Handled, Persistence, RequestHandler};
use betadeck::signals::{MotorCommand, RcFrame, RcSource, SensorFrame, SimTime};
use betadeck::sim::WorldConfig;
use betadeck::storage::Store;
use betadeck::telemetry::{ArmingFlag, EventKind, FirmwareEvent};
use betadeck::vehicle::{Vehicle, VehicleCommand, VehicleConfig};
use tokio::sync::{mpsc, oneshot};

const TICK: Duration = Duration::from_millis(1);
/// The interval at which the handler checks RC, ticks.
const LOOK: u64 = 20;

/// A firmware on a bench, with a request handler and a wall clock of its own.
struct Bench {
    vehicle: Vehicle,
    persistence: Persistence,
    handler: RequestHandler,
    ticks: u64,
    wall: Instant,
    /// The ticks that are due by the wall clock and have not been run.
    owed: f64,
    motors: MotorCommand,
    lost: bool,
}

impl Bench {
    /// Returns a bench with the starter modes, which are not stored.
    async fn new() -> Self {
        let mut configuration = Configuration::default();
        configuration.starter_modes();
        Self::with(configuration).await
    }

    /// Returns a bench with this configuration, which is not stored.
    async fn with(configuration: Configuration) -> Self {
        let closed = ListenConfig { tcp_port: None, ws_port: None, rc_port: None, ..ListenConfig::default() };
        let (doors, _) = Listeners::open(&closed, mpsc::channel(1).0).await;
        let firmware = FirmwareOptions { arm_assist: true, ..FirmwareOptions::default() };
        let config = VehicleConfig { world: WorldConfig::default(), firmware, configuration, live: true };
        let mut vehicle = Vehicle::with_external_physics(config).unwrap();
        vehicle.apply(&VehicleCommand::CutRc(true));
        Self {
            persistence: Persistence::new(Store::in_memory(), &mut vehicle, true),
            vehicle,
            handler: RequestHandler::new(doors.restart_signal()),
            ticks: 0,
            wall: Instant::now(),
            owed: 0.0,
            motors: MotorCommand::default(),
            lost: false,
        }
    }

    /// Returns a bench with the starter modes, and with a store whose directory has become a file.
    async fn without_room(directory: &tempfile::TempDir) -> Self {
        let folder = directory.path().join("state");
        let mut bench = Self::new().await;
        let store = Store::open(&folder, false).unwrap();
        bench.persistence = Persistence::new(store, &mut bench.vehicle, true);
        std::fs::remove_dir_all(&folder).unwrap();
        std::fs::write(&folder, "").unwrap();
        bench
    }

    fn firmware(&self) -> &Firmware {
        self.vehicle.embedded().unwrap()
    }

    fn tick(&mut self, speed: f64) {
        if self.ticks.is_multiple_of(LOOK) {
            self.handler.keep_rc_fresh(&mut self.vehicle, speed, self.wall);
        }
        let sensors = SensorFrame { time: SimTime(self.ticks * 1000), ..SensorFrame::default() };
        self.motors = self.vehicle.tick_on(&sensors);
        self.ticks += 1;
        self.vehicle.drain_events(|event| match event.kind {
            EventKind::Firmware(FirmwareEvent::RxLoss) => self.lost = true,
            EventKind::Firmware(FirmwareEvent::RxRecovered) => self.lost = false,
            _ => {}
        });
    }

    /// Lets a millisecond of the wall clock pass, at `speed` times real time.
    fn pass(&mut self, speed: f64) {
        self.wall += TICK;
        self.owed += speed;
        while self.owed >= 1.0 {
            self.owed -= 1.0;
            self.tick(speed);
        }
    }

    fn handle(&mut self, request: Request) -> Handled {
        self.handler.handle(request, &mut self.vehicle, &mut self.persistence, self.wall)
    }

    fn receive_udp(&mut self, frame: RcFrame) {
        self.handle(Request::Rc { stamp_s: 0.0, frame, at: self.wall });
    }

    fn ask(&mut self, code: u16, payload: &[u8]) -> Option<Vec<u8>> {
        let (reply, mut answer) = oneshot::channel();
        self.handle(Request::Msp { code, payload: payload.to_vec(), reply });
        answer.try_recv().unwrap()
    }

    fn enter(&mut self, client: u64, interactive: bool) -> bool {
        let (reply, mut answer) = oneshot::channel();
        self.handle(Request::EnterCli { client: ClientId(client), interactive, reply });
        answer.try_recv().unwrap()
    }

    fn line(&mut self, client: u64, source: LineSource, line: &str) -> LineReply {
        let (reply, mut answer) = oneshot::channel();
        self.handle(Request::Cli { client: ClientId(client), line: line.to_owned(), source, reply });
        answer.try_recv().unwrap()
    }

    fn leave(&mut self, client: u64) {
        self.handle(Request::LeftCli { client: ClientId(client) });
    }

    fn arming_is_blocked_by_cli(&self) -> bool {
        self.firmware().arming_flags().has(ArmingFlag::Cli)
    }

    fn second_motor(&mut self) -> f64 {
        self.tick(1.0);
        self.motors.0[1]
    }
}

/// Sends half a second of a script, then nothing. Returns the wall time from the last packet to the loss of the link.
async fn wall_time_to_loss(speed: f64) -> Duration {
    let mut bench = Bench::new().await;
    for ms in 0..500_u32 {
        if ms.is_multiple_of(20) {
            bench.receive_udp(RcFrame::SAFE);
        }
        bench.pass(speed);
        // The link is good after half a second of frames.
        assert!(!bench.lost, "lost after {ms} ms at speed {speed}");
    }
    // The last packet came 20 ms ago.
    let last = bench.wall - Duration::from_millis(20);
    while !bench.lost {
        bench.pass(speed);
        assert!(bench.wall - last < Duration::from_secs(10), "never lost at speed {speed}");
    }
    bench.wall - last
}

#[tokio::test]
async fn a_script_is_lost_after_the_same_wall_time_at_any_speed() {
    for speed in [1.0, 2.0, 4.0, 10.0, 50.0, 1000.0] {
        let lost = wall_time_to_loss(speed).await.as_millis();
        assert!((145..=210).contains(&lost), "{lost} ms at speed {speed}");
    }
    // Slower than real time, the firmware's own 150 ms count.
    let lost = wall_time_to_loss(0.5).await.as_millis();
    assert!((290..=420).contains(&lost), "{lost} ms at half speed");
}

#[tokio::test]
async fn a_script_is_not_lost_while_time_is_paused() {
    let mut bench = Bench::new().await;
    for ms in 0..500_u32 {
        if ms.is_multiple_of(20) {
            bench.receive_udp(RcFrame::SAFE);
        }
        bench.pass(1.0);
    }
    // A pause of a minute: no tick, no check.
    bench.wall += Duration::from_secs(60);
    assert!(!bench.lost && bench.firmware().receiver().signal());
}

#[tokio::test]
async fn the_script_stays_in_charge_beside_a_client_that_speaks_msp_however_fast_time_runs() {
    let mut bench = Bench::new().await;
    let mut udp = RcFrame::SAFE;
    udp.channels[0] = 1600;
    let payload: Vec<u8> = RcFrame::SAFE.channels.iter().flat_map(|channel| channel.to_le_bytes()).collect();
    for ms in 0..600_u32 {
        match ms % 20 {
            0 => bench.receive_udp(udp),
            10 => assert!(bench.ask(200, &payload).is_some()),
            _ => {}
        }
        bench.pass(50.0);
        if ms > 100 {
            assert_eq!(bench.firmware().receiver().sources().in_charge(), Some(RcSource::Udp), "{ms} ms");
        }
    }
}

#[tokio::test]
async fn only_who_turned_the_motors_stops_them_by_leaving() {
    let mut bench = Bench::new().await;
    assert!(bench.enter(1, true) && bench.enter(2, false));
    bench.line(1, LineSource::Prompt, "motor 1 1200");
    assert!(bench.second_motor() > 0.1);
    bench.leave(2);
    assert!(bench.second_motor() > 0.1, "another client left");
    bench.leave(1);
    assert!(bench.second_motor() < 0.1);
}

#[tokio::test]
async fn a_client_of_the_time_before_a_restart_does_nothing_to_those_after_it() {
    let mut bench = Bench::new().await;
    bench.enter(1, true);
    bench.line(1, LineSource::Prompt, "motor 1 1200");
    assert_eq!(bench.ask(68, &[]), Some(vec![0]));
    assert!(bench.second_motor() < 0.1, "a restart stops the motors");
    bench.enter(3, true);
    bench.line(3, LineSource::Prompt, "motor 1 1300");
    bench.leave(1);
    assert!(bench.second_motor() > 0.1);
    assert!(bench.arming_is_blocked_by_cli());
}

#[tokio::test]
async fn a_command_line_blocks_arming_until_the_restart_that_ends_it() {
    let mut bench = Bench::new().await;
    bench.enter(1, false);
    assert!(!bench.arming_is_blocked_by_cli(), "one batch of lines blocks nothing");
    bench.enter(1, true);
    bench.leave(1);
    assert!(bench.arming_is_blocked_by_cli(), "also when it was left");

    // Another client saves a flight plan: that restarts the craft and keeps the links.
    bench.enter(2, true);
    assert!(bench.enter(3, false));
    bench.line(3, LineSource::Framed, "feature TELEMETRY");
    let reply = bench.line(3, LineSource::Framed, "save");
    assert!(!reply.refused, "{}", reply.text);
    assert!(bench.arming_is_blocked_by_cli(), "the second is still there");
    bench.leave(2);
    bench.line(3, LineSource::Framed, "save");
    assert!(!bench.arming_is_blocked_by_cli(), "nobody is");
}

#[tokio::test]
async fn an_armed_craft_is_not_restarted() {
    let mut bench = Bench::new().await;
    let mut frame = RcFrame::SAFE;
    bench.enter(1, true);
    // The craft is put back home: the command line is open but blocks nothing.
    let kept = bench.vehicle.controller().configuration().cloned().unwrap();
    bench.vehicle.apply(&VehicleCommand::Restart(Box::new(kept)));
    for ms in 0..7000_u32 {
        frame.channels[4] = if ms > 6500 { 2000 } else { 1000 };
        if ms.is_multiple_of(20) {
            bench.receive_udp(frame);
        }
        bench.pass(1.0);
    }
    assert!(bench.firmware().is_armed(), "{:?}", bench.firmware().arming_flags());
    assert!(!bench.handle(Request::Restart).restarted);
    assert_eq!(bench.ask(68, &[]), None);
    assert_eq!(bench.ask(208, &[]), Some(vec![0]));
    assert!(!bench.enter(3, true) && !bench.enter(3, false));
    assert!(bench.firmware().is_armed());
}

#[tokio::test]
async fn what_cannot_be_saved_is_reported_in_a_sentence() {
    let directory = tempfile::tempdir().unwrap();
    let mut bench = Bench::without_room(&directory).await;
    let (reply, mut answer) = oneshot::channel();
    let handled = bench.handle(Request::Msp { code: 250, payload: Vec::new(), reply });
    assert_eq!(answer.try_recv().unwrap(), None);
    let [notice] = &handled.notices[..] else { panic!("{:?}", handled.notices) };
    assert!(notice.text.starts_with("Not saved: ") && notice.text.ends_with('.'), "{notice:?}");
    assert!(notice.is_warning);
}

#[tokio::test]
async fn a_save_that_failed_says_so_and_loses_nothing() {
    for source in [LineSource::Prompt, LineSource::Framed] {
        let directory = tempfile::tempdir().unwrap();
        let mut bench = Bench::without_room(&directory).await;
        assert!(bench.enter(1, source == LineSource::Prompt));
        bench.line(1, source, "set ap_max_angle = 44");
        for line in ["save", "save noreboot"] {
            let reply = bench.line(1, source, line);
            let expected = "###ERROR IN save: Not saved: cannot write ";
            assert!(reply.refused && reply.text.starts_with(expected), "{}", reply.text);
            assert!(!reply.text.contains("saving") && !reply.text.contains("Rebooting"), "{}", reply.text);
            assert_eq!(reply.then, AfterLine::Stay);
            assert_eq!(bench.firmware().parameters().nav.max_angle, 44, "{line}: it stays in memory");
        }
        let status = bench.line(1, source, "status").text;
        assert!(status.contains("32768b), not saved: cannot write "), "{status}");
    }
}

#[tokio::test]
async fn a_second_craft_on_the_same_store_does_not_save() {
    let directory = tempfile::tempdir().unwrap();
    let first = Store::open(directory.path(), false).unwrap();
    let mut bench = Bench::new().await;
    let second = Store::open(directory.path(), false).unwrap();
    bench.persistence = Persistence::new(second, &mut bench.vehicle, true);
    assert!(bench.enter(1, true));
    let reply = bench.line(1, LineSource::Prompt, "save");
    assert!(
        reply.refused && reply.text.starts_with("###ERROR IN save: another betadeck uses "),
        "{}",
        reply.text
    );
    let status = bench.line(1, LineSource::Prompt, "status").text;
    assert!(status.contains(", read-only: another betadeck uses "), "{status}");
    drop(first);
}

#[tokio::test]
async fn a_batch_lasts_over_the_lines_of_one_client_and_of_no_other() {
    let mut bench = Bench::new().await;
    assert!(bench.enter(1, true) && bench.enter(2, true));
    bench.line(1, LineSource::Prompt, "batch start");
    assert!(bench.line(1, LineSource::Prompt, "set nonsense = 1").refused);
    let other = bench.line(2, LineSource::Prompt, "batch end");
    let end = bench.line(1, LineSource::Prompt, "batch end");
    assert_ne!(end.text, other.text);
    // A client that returns starts again.
    bench.line(1, LineSource::Prompt, "batch start");
    bench.line(1, LineSource::Prompt, "set nonsense = 1");
    bench.leave(1);
    assert!(bench.enter(1, true));
    assert_eq!(bench.line(1, LineSource::Prompt, "batch end").text, other.text);
}

/// Returns the modes that channels switch, in their order.
fn modes(bench: &Bench) -> Vec<&'static str> {
    bench.firmware().mode_ranges().iter().map(|range| range.mode_box.into()).collect()
}

/// Returns a bench whose craft has ARM on AUX4 and a tilt angle set, as `--settings` does, and a client at its command
/// line.
async fn bench_with_given_settings() -> Bench {
    let mut firmware = Firmware::new(Configuration::default(), FirmwareOptions::default());
    for line in ["aux 0 0 3 1700 2100 0 0", "set ap_max_angle = 33"] {
        assert!(!firmware.run_cli(&mut Interpreter::default(), line).failed, "{line}");
    }
    let mut bench = Bench::with(firmware.configuration().clone()).await;
    assert!(bench.enter(1, true));
    bench
}

#[tokio::test]
async fn modes_given_at_boot_are_not_replaced_by_starter_modes_at_a_restart() {
    let mut bench = bench_with_given_settings().await;
    bench.line(1, LineSource::Prompt, "set ap_max_angle = 44");
    bench.line(1, LineSource::Prompt, "exit");
    assert_eq!(modes(&bench), ["ARM"]);
    assert_eq!(
        bench.firmware().parameters().nav.max_angle,
        33,
        "what was typed is lost, what was given is not"
    );
}

#[tokio::test]
async fn what_is_saved_wins_over_what_was_given_at_boot() {
    let mut bench = bench_with_given_settings().await;
    bench.line(1, LineSource::Prompt, "set ap_max_angle = 44");
    bench.line(1, LineSource::Prompt, "save");
    assert_eq!((modes(&bench), bench.firmware().parameters().nav.max_angle), (vec!["ARM"], 44));
    assert!(bench.enter(2, true));
    bench.line(2, LineSource::Prompt, "defaults");
    assert_eq!(
        modes(&bench),
        ["ARM", "AUTOPILOT", "ANGLE", "ALTHOLD", "POS HOLD"],
        "nothing is stored nor given"
    );
    assert_eq!(
        bench.firmware().parameters().nav.max_angle,
        Configuration::default().settings.number("ap_max_angle") as u8
    );
}

#[tokio::test]
async fn a_restart_that_gives_the_starter_modes_says_so() {
    let mut bench = bench_with_given_settings().await;
    let restart = |bench: &mut Bench, line: &str| {
        let (reply, _answer) = oneshot::channel();
        let line = line.to_owned();
        let handled =
            bench.handle(Request::Cli { client: ClientId(1), line, source: LineSource::Prompt, reply });
        handled.notices.into_iter().map(|notice| notice.text).collect::<Vec<_>>()
    };
    assert_eq!(restart(&mut bench, "exit"), [""; 0], "ARM was given");
    assert!(bench.enter(1, true));
    assert_eq!(restart(&mut bench, "defaults"), [Configuration::STARTER_MODES_NOTICE]);
    assert!(bench.enter(1, true));
    assert_eq!(restart(&mut bench, "save"), [""; 0], "they are stored now");
}
