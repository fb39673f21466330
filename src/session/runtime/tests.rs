use tokio::sync::oneshot;

use std::sync::Arc;
use std::task::Waker;

use super::*;
use crate::fc::UploadView;
use crate::fc::{RemoteEnds, UploadReport};
use crate::firmware::cli::Interpreter;
use crate::firmware::config::Configuration;
use crate::firmware::{Firmware, FirmwareOptions};
use crate::flight::FlightSetup;
use crate::flight::forecast::SETTINGS_UNKNOWN;
use crate::geo::LatLon;
use crate::link::FcStream;
use crate::lookahead::{FlownAgain, Progress};
use crate::plan::{Altitude, AltitudeReference, FlightPlan, Waypoint, WaypointType};
use crate::session::ReplyTo;
use crate::session::command::Seek;
use crate::signals::SimTime;
use crate::sim::WorldConfig;
use crate::telemetry::FirmwareProfile;
use crate::timeline::MarkKind;
use crate::vehicle::{LateAnswer, RemoteRequest, RemoteTelemetry, VehicleConfig};

/// A session with a remote flight controller. The tests themselves pass its requests to `firmware`.
struct Rig {
    session: Session,
    commands: mpsc::Sender<Command>,
    firmware: Firmware,
    console: Interpreter,
}

/// Returns the settings of a session without doors.
fn config_of(vehicle: Vehicle, is_recorded: bool) -> SessionConfig {
    SessionConfig {
        vehicle,
        store: Store::in_memory(),
        starter_modes: true,
        speed: 1.0,
        takeoff_m: 10.0,
        is_recorded,
        endpoints: None,
        remote: None,
        first_events: Vec::new(),
    }
}

impl Rig {
    fn new() -> Self {
        Self::with(Vehicle::with_remote_controller(WorldConfig::default()).unwrap())
    }

    fn with(vehicle: Vehicle) -> Self {
        let (commands, taken) = mpsc::channel(32);
        let config = config_of(vehicle, true);
        let mut session = Session::new(config, None, None, (taken, mpsc::unbounded_channel().0));
        if let Some(mailbox) = session.vehicle.remote_mut() {
            let altitude_reference = AltitudeReference::Home;
            mailbox.deliver_telemetry(RemoteTelemetry { altitude_reference, ..RemoteTelemetry::default() });
        }
        let firmware = Firmware::new(Configuration::default(), FirmwareOptions::default());
        Self { session, commands, firmware, console: Interpreter::default() }
    }

    /// Requests the upload of this many waypoints. Returns the receiver of the result.
    fn upload(&mut self, waypoints: usize) -> oneshot::Receiver<Result<UploadReport, String>> {
        self.upload_with(waypoints, "ap_max_angle = 33")
    }

    /// Requests the same with this setting.
    fn upload_with(
        &mut self,
        waypoints: usize,
        setting: &str,
    ) -> oneshot::Receiver<Result<UploadReport, String>> {
        let mut plan = Box::new(FlightPlan::default());
        plan.waypoints.extend(
            (0..waypoints).map(|_| Waypoint { altitude: Altitude::above_home(20.0), ..Waypoint::default() }),
        );
        let (reply, result) = ReplyTo::channel();
        let settings = vec![setting.to_owned()];
        self.commands.try_send(Command::Upload { name: String::new(), plan, settings, reply }).unwrap();
        self.take_commands();
        result
    }

    fn seek(&mut self, seek: Seek) {
        self.commands.try_send(Command::Seek(seek)).unwrap();
    }

    /// Carries out the session's commands up to the next view.
    fn take_commands(&mut self) {
        self.session.take_commands(Duration::ZERO, &mut Context::from_waker(Waker::noop()));
    }

    /// Answers the new requests. `change` may change the output of each line. Returns the number of lines.
    fn answer(&mut self, change: impl Fn(&str, &mut String)) -> usize {
        let mut answered = 0;
        while let Some((ticket, request)) = self.mailbox().take_request() {
            let RemoteRequest::Cli(line) = request else { panic!("{request:?}") };
            let mut said = self.firmware.run_cli(&mut self.console, &line);
            change(&line, &mut said.text);
            self.mailbox().deliver_answer(ticket, LateAnswer::Cli(said));
            answered += 1;
        }
        self.session.take_late_answers(Instant::now());
        answered
    }

    fn mailbox(&mut self) -> &mut crate::vehicle::RemoteController {
        self.session.vehicle.remote_mut().unwrap()
    }

    fn shown(&self) -> Option<UploadView> {
        self.session.view().upload
    }
}

#[test]
fn an_upload_to_a_remote_flight_controller_shows_how_far_it_is_until_it_was_read_back() {
    let mut rig = Rig::new();
    assert_eq!(rig.shown(), None);
    let mut result = rig.upload(2);
    // A setting, `clear`, two waypoints, `list`.
    for sent in 1..=5 {
        assert_eq!(rig.shown(), Some(UploadView { sent, total: 5 }));
        assert!(rig.session.changed, "it is published");
        assert_eq!(rig.answer(|_, _| {}), 1, "one line after the other");
    }
    assert_eq!((rig.shown(), result.try_recv().unwrap()), (None, Ok(UploadReport::default())));
    assert_eq!(rig.firmware.stored_plan().waypoints.len(), 2);
    assert_eq!(rig.firmware.parameters().nav.max_angle, 33);
}

#[test]
fn an_upload_waits_for_a_slow_line_and_fails_in_a_sentence_where_nobody_answers() {
    let mut rig = Rig::new();
    let mut result = rig.upload(2);
    // The client of the serial port may wait that long for a line with much output.
    rig.session.take_late_answers(Instant::now() + Duration::from_secs(90));
    assert!(result.try_recv().is_err(), "it is still awaited");
    while rig.answer(|_, _| {}) > 0 {}
    assert_eq!(result.try_recv().unwrap(), Ok(UploadReport::default()));
    let mut result = rig.upload(2);
    rig.session.take_late_answers(Instant::now() + Duration::from_secs(3600));
    assert_eq!(result.try_recv().unwrap(), Err("the flight controller does not answer".to_owned()));
}

#[test]
fn a_simulated_craft_that_is_master_gets_gains_to_land_with_and_a_real_one_those_of_its_plan() {
    for (is_real, altitude_p) in [(false, 2), (true, 50)] {
        let mut rig = Rig::new();
        if is_real {
            let ((to, _), (_, from)) = (mpsc::channel(1), mpsc::channel(1));
            let stream = FcStream { to, from, place: "tcp:here:1".to_owned(), bytes_per_s: None };
            let ends = RemoteEnds { name: "the board".to_owned(), stream, peer: None, child: None };
            let mut link = RemoteLink::new(ends, Instant::now());
            let connection = link.protocol().connection();
            link.protocol_mut().permit_changes(connection);
            rig.session.runner.link = Some(link);
        }
        let altitude_reference = AltitudeReference::SeaLevel { home_m: Some(300.0) };
        rig.mailbox().deliver_telemetry(RemoteTelemetry { altitude_reference, ..RemoteTelemetry::default() });
        let mut result = rig.upload_with(1, "ap_altitude_p = 50");
        while rig.answer(|_, _| {}) > 0 {}
        let report = result.try_recv().unwrap().unwrap();
        assert_eq!(
            (report.replaced.is_empty(), i64::from(rig.firmware.parameters().nav.altitude_p)),
            (is_real, altitude_p)
        );
    }
}

#[test]
fn a_craft_that_counts_from_sea_level_gets_and_gives_altitudes_from_there() {
    let mut rig = Rig::new();
    let tell = |rig: &mut Rig, home_m| {
        let altitude_reference = AltitudeReference::SeaLevel { home_m };
        rig.mailbox().deliver_telemetry(RemoteTelemetry { altitude_reference, ..RemoteTelemetry::default() });
    };
    tell(&mut rig, None);
    let refused = rig.upload(2).try_recv().unwrap().unwrap_err();
    assert!(refused.contains("sea level") && refused.ends_with("wait for a GPS fix."), "{refused}");
    rig.mailbox().deliver_telemetry(RemoteTelemetry::default());
    let refused = rig.upload(2).try_recv().unwrap().unwrap_err();
    assert!(refused.ends_with("wait until it has reported its settings."), "{refused}");
    tell(&mut rig, Some(300.0));
    let mut result = rig.upload(2);
    while rig.answer(|_, _| {}) > 0 {}
    assert_eq!(result.try_recv().unwrap(), Ok(UploadReport { added_m: 300.0, ..UploadReport::default() }));
    assert_eq!(rig.firmware.stored_plan().waypoints[1].altitude, Altitude::above_home(320.0));
    let (reply, mut plan) = ReplyTo::channel();
    rig.commands.try_send(Command::Download { reply }).unwrap();
    rig.take_commands();
    assert_eq!(rig.answer(|_, _| {}), 1);
    assert_eq!(plan.try_recv().unwrap().unwrap().waypoints[1].altitude, Altitude::above_home(20.0));
}

#[test]
fn a_craft_that_holds_another_waypoint_than_was_sent_is_found_by_reading_back() {
    let mut rig = Rig::new();
    let mut result = rig.upload(2);
    let spoilt = |line: &str, text: &mut String| {
        if line == "waypoint list" {
            let second = text.rfind("2000").unwrap();
            text.replace_range(second..second + 4, "2100");
        }
    };
    while rig.answer(spoilt) > 0 {}
    let sentence = result.try_recv().unwrap().unwrap_err();
    assert_eq!(sentence, "waypoint 1 on the craft differs from the one sent: upload again");
}

#[test]
fn the_lines_of_two_uploads_do_not_mix() {
    let mut rig = Rig::new();
    let (mut first, mut second) = (rig.upload(3), rig.upload(1));
    let refusal = second.try_recv().unwrap().unwrap_err();
    assert!(refusal.starts_with("An upload is under way, line "), "{refusal}");
    while rig.answer(|_, _| {}) > 0 {}
    assert_eq!(first.try_recv().unwrap(), Ok(UploadReport::default()));
    assert_eq!(rig.firmware.stored_plan().waypoints.len(), 3);
}

#[test]
fn a_held_rewind_key_is_one_way_and_each_other_instant_is_shown_before_the_next() {
    let vehicle = Vehicle::new(VehicleConfig {
        world: WorldConfig::default(),
        firmware: FirmwareOptions::default(),
        configuration: Configuration::default(),
        live: false,
    });
    let mut rig = Rig::with(vehicle.unwrap());
    rig.session.advance(60_000, Duration::ZERO);
    let shown_s = |rig: &Rig| rig.session.view().vehicle.time.as_secs_f64();
    (0..20).for_each(|_| rig.seek(Seek::Seconds(-1.0)));
    rig.seek(Seek::Seconds(5.0));
    rig.seek(Seek::Time(SimTime(7_000_000)));
    let (sent, begun) = (ReplyTo::channel(), !rig.session.commands.is_idle());
    rig.commands.try_send(Command::Save { reply: sent.0 }).unwrap();
    assert!(begun, "the loop does not sleep");
    for expected_s in [40.0, 45.0, 7.0] {
        assert!(!rig.session.commands.is_idle());
        rig.take_commands();
        assert!((shown_s(&rig) - expected_s).abs() < 1e-3, "{} for {expected_s}", shown_s(&rig));
    }
    rig.take_commands();
    assert!(rig.session.commands.is_idle(), "whatever comes behind is not forgotten");
    drop(sent.1);
}

/// Returns a session with an embedded flight controller at `speed` times real time.
fn rig_at(speed: f64) -> Rig {
    let mut configuration = Configuration::default();
    configuration.starter_modes();
    let (world, firmware) = (WorldConfig::default(), FirmwareOptions::default());
    let config = VehicleConfig { world, firmware, configuration, live: false };
    let mut rig = Rig::with(Vehicle::new(config).unwrap());
    rig.session.usual_speed = speed;
    rig.session.runner.pacer.set_speed(speed, Duration::ZERO);
    rig
}

impl Rig {
    /// Flies the built-in landing to its end. Returns the speed there.
    fn fly_and_land(&mut self) -> f64 {
        let plan = crate::plan::builtin::BuiltinPlan::find("land").unwrap().read().unwrap().plan;
        let (reply, _result) = ReplyTo::channel();
        let upload =
            Command::Upload { name: String::new(), plan: Box::new(plan), settings: Vec::new(), reply };
        for command in [upload, Command::StartPilot] {
            self.commands.try_send(command).unwrap();
        }
        self.take_commands();
        for _ in 0..400_000 {
            self.session.advance(1, Duration::ZERO);
            self.session.flush_events();
            let landed = self.session.events.marks().all().iter().any(|mark| mark.kind == MarkKind::Disarmed);
            self.session.slow_down_after_flight(Duration::ZERO);
            if landed {
                return self.session.runner.pacer.speed();
            }
        }
        panic!("it never landed");
    }

    fn choose_speed(&mut self, speed: f64) {
        self.commands.try_send(Command::Speed(speed)).unwrap();
        self.take_commands();
    }
}

#[test]
fn after_the_landing_the_speed_falls_back_once_and_one_chosen_later_stays() {
    let mut rig = rig_at(1.0);
    rig.choose_speed(128.0);
    rig.session.slow_down_after_flight(Duration::ZERO);
    assert!((rig.session.runner.pacer.speed() - 128.0).abs() < 1e-9, "it has not flown yet");
    assert!((rig.fly_and_land() - 1.0).abs() < 1e-9);
    rig.choose_speed(16.0);
    rig.session.advance(1000, Duration::ZERO);
    rig.session.flush_events();
    rig.session.slow_down_after_flight(Duration::ZERO);
    assert!((rig.session.runner.pacer.speed() - 16.0).abs() < 1e-9, "chosen while disarmed");
}

#[test]
fn a_speed_of_the_command_line_and_a_slow_one_outlast_the_landing() {
    let mut rig = rig_at(8.0);
    assert!((rig.fly_and_land() - 8.0).abs() < 1e-9);
    let mut rig = rig_at(1.0);
    rig.choose_speed(0.25);
    assert!((rig.fly_and_land() - 0.25).abs() < 1e-9);
}

#[test]
fn a_session_without_a_screen_keeps_nothing_of_its_flight() {
    let recorded = |is_recorded| {
        let config = VehicleConfig {
            world: WorldConfig::default(),
            firmware: FirmwareOptions::default(),
            configuration: Configuration::default(),
            live: false,
        };
        let config = config_of(Vehicle::new(config).unwrap(), is_recorded);
        Session::new(config, None, None, (mpsc::channel(1).1, mpsc::unbounded_channel().0)).timeline.is_some()
    };
    assert_eq!((recorded(true), recorded(false)), (true, false));
}

/// A session after a flight of three seconds with a firmware that has ended. `again` flies it again.
fn after_a_flight(
    again: impl Fn(SimTime, &Progress) -> Result<FlownAgain, String> + Send + Sync + 'static,
) -> (Session, mpsc::UnboundedReceiver<Event>) {
    let mut vehicle = flown_until(SimTime::ZERO);
    let mut timeline = Timeline::new(&mut vehicle).unwrap();
    while vehicle.time() < SimTime(3_000_000) {
        timeline.record(&mut vehicle);
        vehicle.tick();
    }
    let again = Some(FlyAgain::new(again));
    let flown = FlownBefore { timeline, events: Vec::new(), show: SimTime(1_000_000), again };
    let (events, reported) = mpsc::unbounded_channel();
    (Session::new(config_of(vehicle, true), Some(flown), None, (mpsc::channel(1).1, events)), reported)
}

fn flown_until(time: SimTime) -> Vehicle {
    let mut vehicle = Vehicle::with_remote_controller(WorldConfig::default()).unwrap();
    while vehicle.time() < time {
        vehicle.tick();
    }
    vehicle
}

/// Flies on, and waits until the flight was flown again.
fn fly_on(session: &mut Session) {
    session.fly_on(Duration::ZERO);
    while session.flying_again.is_some() {
        std::thread::park_timeout(Duration::from_millis(10));
        session.take_flown_again(Duration::ZERO);
    }
    session.flush_events();
}

#[test]
fn the_flight_of_a_firmware_that_has_ended_is_flown_again_to_the_instant_that_is_shown() {
    let link = || {
        let (to, from) = (mpsc::channel(1).0, mpsc::channel(1).1);
        let stream = FcStream { to, from, place: "tcp:here:1".to_owned(), bytes_per_s: None };
        RemoteLink::new(
            RemoteEnds { name: "the board".to_owned(), stream, peer: None, child: None },
            Instant::now(),
        )
    };
    let (mut session, _events) =
        after_a_flight(move |_, _| Ok(FlownAgain { link: link(), keeps: Box::new(()) }));
    let shown = session.shown_vehicle().time();
    assert!(shown >= SimTime(1_000_000) && shown < session.vehicle.time());
    fly_on(&mut session);
    assert!(!session.is_rewound() && session.runner.link.is_some());
    assert_eq!(session.vehicle.time(), shown);
    let timeline = session.timeline_view().unwrap();
    assert_eq!((timeline.branch, timeline.branched_at), (1, shown));
}

#[test]
fn a_flight_that_cannot_be_flown_again_stays_shown() {
    let (mut session, mut events) = after_a_flight(|_, _| Err("It is gone.".to_owned()));
    fly_on(&mut session);
    assert!(session.is_rewound() && session.runner.link.is_none());
    let is_reason = |event: Event| event.kind == SessionEvent::Notice("It is gone.".to_owned());
    assert!(std::iter::from_fn(|| events.try_recv().ok()).any(is_reason));
}

#[test]
fn a_flight_that_is_flown_again_shows_its_progress_and_can_be_stopped() {
    let (mut session, mut events) = after_a_flight(|until, progress| {
        progress.reach(SimTime(until.0 / 2));
        while !progress.stopped().load(std::sync::atomic::Ordering::Relaxed) {
            std::thread::yield_now();
        }
        Err("It was stopped.".to_owned())
    });
    session.fly_on(Duration::ZERO);
    let progress = |session: &Session| session.timeline_view().unwrap().flying_again;
    let until = session.shown_vehicle().time();
    while progress(&session) != Some((SimTime(until.0 / 2), until)) {
        std::thread::yield_now();
        session.take_flown_again(Duration::ZERO);
    }
    session.fly_on(Duration::ZERO);
    assert_eq!((progress(&session), session.is_rewound()), (None, true));
    session.take_flown_again(Duration::ZERO);
    session.flush_events();
    let is_notice = |event: Event| format!("{event:?}").contains("Stopped: the flight is not flown again.");
    assert!(std::iter::from_fn(|| events.try_recv().ok()).any(is_notice));
}

#[test]
fn a_running_session_publishes_its_views_and_events() {
    let (vehicle, _) = FlightSetup::default().build().unwrap();
    let mut handle = start(config_of(vehicle, true)).unwrap();
    let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
    runtime.block_on(async {
        handle.commands.send(Command::Seek(Seek::Newest)).await.unwrap();
        let is_answer =
            |event: &Event| matches!(&event.kind, SessionEvent::Notice(said) if said.contains("newest"));
        let mut events = 1;
        while !handle.events.recv().await.is_some_and(|event| is_answer(&event)) {
            events += 1;
        }
        // A view with their outcome follows.
        handle.view.wait_for(|view| view.events_sent >= events).await.unwrap();
        handle.commands.send(Command::Quit).await.unwrap();
        // The session drops its ends.
        while handle.events.recv().await.is_some() {}
    });
    assert_eq!(handle.thread.join().unwrap(), None);
}

#[test]
fn the_hazards_of_an_uploaded_plan_are_reported_before_the_answer() {
    let (commands, taken) = mpsc::channel(32);
    let (events, mut heard) = mpsc::unbounded_channel();
    let (vehicle, _) = FlightSetup::default().build().unwrap();
    let home = *vehicle.local_frame().unwrap();
    let mut session = Session::new(config_of(vehicle, true), None, None, (taken, events));
    session.flush_events();
    let mut plan = Box::new(FlightPlan::default());
    // The leg to the second waypoint is too steep.
    let position = LatLon::from_degrees(home.lat_deg + 0.0003, home.lon_deg);
    for (alt_m, kind) in [(80.0, WaypointType::Flyover), (20.0, WaypointType::Land)] {
        let altitude = Altitude::above_home(alt_m);
        plan.waypoints.push(Waypoint { position, altitude, kind, ..Waypoint::default() });
    }
    let (order, answered) = std::sync::mpsc::channel();
    let reply = ReplyTo::new(move |_: Option<Result<UploadReport, String>>| {
        let mut before = 0;
        while let Ok(event) = heard.try_recv() {
            before +=
                usize::from(matches!(event.kind, SessionEvent::Notice(said) if said.starts_with("Caution")));
        }
        order.send(before).unwrap();
    });
    commands.try_send(Command::Upload { name: String::new(), plan, settings: Vec::new(), reply }).unwrap();
    session.take_commands(Duration::ZERO, &mut Context::from_waker(Waker::noop()));
    assert!(answered.try_recv().unwrap() > 0, "the notices of the plan come first");
}

#[test]
fn a_plan_is_estimated_by_the_embedded_firmware_with_the_settings_of_the_remote_one() {
    let mut rig = Rig::new();
    let copy = |rig: &mut Rig| {
        let (reply, copy) = ReplyTo::channel();
        rig.commands.try_send(Command::CopyVehicle { continues: false, reply }).unwrap();
        rig.take_commands();
        copy.blocking_recv().unwrap()
    };
    assert_eq!(copy(&mut rig).unwrap_err(), SETTINGS_UNKNOWN);
    let mut configuration = Configuration::default();
    configuration.settings.set_number("ap_profile", 1).unwrap();
    let configuration = Some(Arc::new(configuration));
    rig.mailbox().deliver_telemetry(RemoteTelemetry { configuration, ..RemoteTelemetry::default() });
    let copied = copy(&mut rig).unwrap();
    assert_eq!(copied.vehicle.controller().profile(), Some(FirmwareProfile::Master));
    assert!(copied.again.is_none());
    assert_eq!(rig.session.reported_twin, Some(FirmwareProfile::Master), "it is said which laws fly");
}
