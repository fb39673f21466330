use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, Mutex};
use std::task::{Wake, Waker};

use super::*;
use crate::replay::{Curve, CurvesRequest, Moment, Overview, PastEvent, PastFlight, Picture, Progress};
use crate::runner::SPEED_RANGE;
use crate::session::ReplyTo;
use crate::session::policy::RECORDED;
use crate::telemetry::{EventKind, FirmwareEvent, Mode, ModeFlags, Snapshot};
use crate::timeline::{MarkKind, Marks};
use crate::vehicle::VehicleCommand;

/// A flight of twenty seconds, which climbs at 1 m/s and is armed from second 12 on. It begins at second 10.
#[derive(Debug)]
struct Climb {
    overview: Arc<Overview>,
    /// `true` while the file is there.
    is_there: Arc<Mutex<bool>>,
}

const FIRST: SimTime = SimTime(10_000_000);

fn at_s(seconds: f64) -> SimTime {
    SimTime::from_secs_f64(seconds)
}

fn picture(time: SimTime) -> Snapshot {
    let mut picture = Snapshot { time, ..Snapshot::default() };
    picture.estimate.alt = Some(time.seconds_since(FIRST));
    picture.craft.armed = Some(time >= at_s(12.0));
    picture
}

impl Climb {
    fn new(is_there: Arc<Mutex<bool>>) -> Self {
        let armed = EventKind::Firmware(FirmwareEvent::Armed);
        let mut marks = Marks::default();
        marks.note(at_s(12.0), &armed);
        let mut modes = ModeFlags::NONE;
        modes.set(Mode::Autopilot, true);
        marks.push(at_s(15.0), MarkKind::Modes(modes));
        let overview = Overview {
            first: FIRST,
            last: at_s(30.0),
            frame_us: 4000,
            about: vec![PastEventKind::Warning("12 bytes are damaged.".to_owned())],
            events: vec![PastEvent { time: at_s(12.0), kind: PastEventKind::Vehicle(armed) }],
            marks,
            pictures: (100..300).map(|tenth| Picture::of(&picture(SimTime(tenth * 100_000)))).collect(),
            ..Overview::default()
        };
        Self { overview: Arc::new(overview), is_there }
    }
}

impl PastFlight for Climb {
    fn overview(&self) -> Arc<Overview> {
        Arc::clone(&self.overview)
    }

    fn at(&mut self, time: SimTime) -> Result<Moment, String> {
        if !*self.is_there.lock().unwrap() {
            return Err("The file is gone.".to_owned());
        }
        // A record every 4 ms.
        let time = SimTime(time.0 / 4000 * 4000);
        Ok(Moment { snapshot: picture(time), values: vec![time.as_secs_f64()] })
    }

    fn curves(&mut self, request: &CurvesRequest) -> Result<Vec<Curve>, String> {
        let steps = vec![Some((0.0, 1.0)); request.steps];
        Ok(vec![Curve::new(request.from, request.to, steps); request.series.len()])
    }
}

struct File {
    count: usize,
    is_there: Arc<Mutex<bool>>,
}

impl PastFlights for File {
    fn name(&self) -> &str {
        "climb.bbl"
    }

    fn count(&self) -> usize {
        self.count
    }

    fn notices(&self) -> Vec<String> {
        Vec::new()
    }

    fn read(&mut self, progress: Progress<'_>) -> Result<bool, String> {
        Ok(progress(0.5))
    }

    fn open(&mut self, number: usize) -> Result<Box<dyn PastFlight>, String> {
        if number == 2 {
            return Err("Flight 3 has no frame.".to_owned());
        }
        Ok(Box::new(Climb::new(Arc::clone(&self.is_there))))
    }
}

/// A replay whose clock the test sets.
struct Rig {
    session: ReplaySession,
    commands: mpsc::Sender<Command>,
    events: mpsc::UnboundedReceiver<Event>,
    is_there: Arc<Mutex<bool>>,
    now: Duration,
}

impl Rig {
    fn new(count: usize, start: Option<ReplayStart>) -> Self {
        let is_there = Arc::new(Mutex::new(true));
        let flights = Box::new(File { count, is_there: Arc::clone(&is_there) });
        let config =
            ReplayConfig { flights, number: None, is_left: false, start, speed: 1.0, notices: Vec::new() };
        let (commands, taken) = mpsc::channel(32);
        let (sent, events) = mpsc::unbounded_channel();
        let session = ReplaySession::new(config, taken, sent);
        let mut rig = Self { session, commands, events, is_there, now: Duration::ZERO };
        rig.show(0).unwrap();
        rig
    }

    fn show(&mut self, number: usize) -> Result<(), String> {
        self.session.show_flight(number, self.now)
    }

    fn send(&mut self, command: Command) {
        self.commands.try_send(command).unwrap();
        let mut context = Context::from_waker(std::task::Waker::noop());
        if let Some(further) = self.session.take_commands(self.now, &mut context) {
            self.session.show_further(further, self.now);
        }
    }

    fn seek(&mut self, seek: Seek) -> f64 {
        self.send(Command::Seek(seek));
        self.shown_s()
    }

    /// Lets wall time pass, in the steps of a loop.
    fn wait(&mut self, seconds: f64) {
        let until = self.now + Duration::from_secs_f64(seconds);
        while self.now < until {
            self.now += Duration::from_millis(16);
            let moved = self.session.player.as_mut().unwrap().play(self.now);
            moved.unwrap_or_else(|why| self.session.fail(why, self.now));
        }
    }

    fn shown_s(&self) -> f64 {
        self.session.view().vehicle.time.as_secs_f64()
    }

    fn sentences(&mut self) -> Vec<String> {
        let kinds = std::iter::from_fn(|| self.events.try_recv().ok()).map(|event| event.kind);
        kinds
            .map(|kind| match kind {
                SessionEvent::Notice(text) => text,
                SessionEvent::Replay(notice) => notice.to_string(),
                other => format!("{other:?}"),
            })
            .collect()
    }
}

#[test]
fn a_flight_plays_from_its_beginning_to_its_end_and_again() {
    let mut rig = Rig::new(1, None);
    assert!((rig.shown_s() - 10.0).abs() < 1e-9);
    rig.wait(3.0);
    assert!((rig.shown_s() - 13.0).abs() < 0.03, "{}", rig.shown_s());
    assert!(rig.session.view().is_rewound() && !rig.session.view().paused);
    rig.send(Command::Speed(8.0));
    rig.wait(4.0);
    let view = rig.session.view();
    assert!((rig.shown_s() - 30.0).abs() < 1e-9 && view.paused && !view.is_rewound(), "{}", rig.shown_s());
    rig.send(Command::Pause(false));
    rig.wait(0.5);
    assert!((rig.shown_s() - 14.0).abs() < 0.2, "{}", rig.shown_s());
}

#[test]
fn the_first_instant_is_chosen_and_paused() {
    for (start, expected_s) in [
        (ReplayStart::Seconds(4.5), 14.5),
        (ReplayStart::Clock(at_s(21.0)), 21.0),
        (ReplayStart::Clock(at_s(3.0)), 10.0),
        (ReplayStart::Seconds(1e9), 30.0),
    ] {
        let mut rig = Rig::new(1, Some(start));
        rig.wait(1.0);
        assert!((rig.shown_s() - expected_s).abs() < 1e-9, "{start:?}: {}", rig.shown_s());
    }
}

#[test]
fn seeks_go_to_events_and_times_and_stay_inside_the_flight() {
    let mut rig = Rig::new(1, None);
    for (seek, expected_s) in [
        (Seek::Forward { states_only: false }, 12.0),
        (Seek::Forward { states_only: false }, 15.0),
        (Seek::Back { states_only: false }, 12.0),
        (Seek::Forward { states_only: true }, 15.0),
        (Seek::Back { states_only: true }, 15.0),
        (Seek::Seconds(-3.0), 12.0),
        (Seek::Seconds(-60.0), 10.0),
        (Seek::Back { states_only: false }, 10.0),
        (Seek::Time(at_s(17.25)), 17.25),
        (Seek::Newest, 30.0),
        (Seek::Newest, 30.0),
        (Seek::Time(SimTime(u64::MAX)), 30.0),
        (Seek::BeforeMishap, 15.0),
    ] {
        let shown_s = rig.seek(seek);
        assert!((shown_s - expected_s).abs() < 1e-9, "{seek:?}: {shown_s}");
    }
    let sentences = rig.sentences().join("\n");
    for said in ["in no other state", "begins here", "Nothing happened before", "the end of the recorded"] {
        assert!(sentences.contains(said), "{said} in {sentences}");
    }
}

#[test]
fn a_jump_by_time_keeps_playing_and_a_jump_to_an_event_stops() {
    let mut rig = Rig::new(1, None);
    rig.seek(Seek::Seconds(10.0));
    assert!(!rig.session.view().paused);
    rig.seek(Seek::Back { states_only: false });
    assert!(rig.session.view().paused);
    rig.send(Command::Step(3));
    assert!((rig.shown_s() - 15.012).abs() < 1e-9, "three records: {}", rig.shown_s());
}

/// Counts how often it woke a thread.
#[derive(Default)]
struct CountedWakes(AtomicUsize);

impl Wake for CountedWakes {
    fn wake(self: Arc<Self>) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

#[test]
fn a_key_after_any_other_wakes_a_paused_replay() {
    let first = [
        Command::Seek(Seek::Newest),
        Command::Seek(Seek::Forward { states_only: false }),
        Command::Seek(Seek::Seconds(-3.0)),
        Command::ShowFlight(1),
        Command::Pause(true),
    ];
    for command in first {
        let name = format!("{command:?}");
        let mut rig = Rig::new(2, Some(ReplayStart::Seconds(1.0)));
        let wakes = Arc::new(CountedWakes::default());
        let waker = Waker::from(Arc::clone(&wakes));
        let mut context = Context::from_waker(&waker);
        rig.commands.try_send(command).unwrap();
        rig.session.take_commands(rig.now, &mut context);
        while !rig.session.commands.is_idle() {
            rig.session.take_commands(rig.now, &mut context);
        }
        let before = wakes.0.load(Ordering::Relaxed);
        rig.commands.try_send(Command::Seek(Seek::Seconds(-1.0))).unwrap();
        assert_eq!(wakes.0.load(Ordering::Relaxed), before + 1, "after {name}");
    }
}

#[test]
fn nothing_reaches_the_craft_of_a_recorded_flight() {
    let mut rig = Rig::new(1, None);
    rig.sentences();
    rig.send(Command::Vehicle(VehicleCommand::ResetCraft));
    rig.send(Command::StartPilot);
    rig.send(Command::FlyOn);
    assert_eq!(rig.sentences(), [RECORDED; 3]);
    let (reply, mut answer) = ReplyTo::channel();
    rig.send(Command::Save { reply });
    assert_eq!(answer.try_recv().unwrap(), Err(RECORDED.to_owned()));
    let (reply, mut answer) = ReplyTo::channel();
    rig.send(Command::Cli { line: "get".to_owned(), reply });
    assert_eq!(answer.try_recv().unwrap().advice.as_deref(), Some(RECORDED));
}

#[test]
fn the_events_of_the_flight_follow_its_beginning() {
    let mut rig = Rig::new(3, None);
    let sentences = rig.sentences();
    assert_eq!(
        sentences[..2],
        ["climb.bbl, flight 1 of 3: 20.0 s of flight are shown.", "12 bytes are damaged."]
    );
    assert!(sentences[2].contains("Armed"), "{sentences:?}");
}

#[test]
fn the_flights_of_a_file_are_shown_one_after_the_other() {
    let mut rig = Rig::new(4, None);
    let shown =
        |rig: &Rig| rig.session.view().replay.map(|replay| (replay.number, Arc::clone(&replay.overview)));
    let (first, before) = shown(&rig).unwrap();
    rig.send(Command::ShowFlight(-1));
    rig.send(Command::ShowFlight(1));
    let (second, after) = shown(&rig).unwrap();
    assert_eq!((first, second), (0, 1));
    assert!(!Arc::ptr_eq(&before, &after));
    rig.sentences();
    // The next one is damaged.
    rig.send(Command::ShowFlight(1));
    assert_eq!(shown(&rig).unwrap().0, 3);
    let sentences = rig.sentences();
    assert!(sentences.contains(&"Flight 3 has no frame.".to_owned()), "{sentences:?}");
    rig.send(Command::ShowFlight(1));
    assert_eq!(rig.sentences(), ["This is the last flight of the file, 4 of 4."]);
    rig.send(Command::ShowFlight(-1));
    assert_eq!(shown(&rig).unwrap().0, 1, "the damaged one is passed over");
}

#[test]
fn a_last_flight_that_cannot_be_shown_leaves_the_one_before() {
    let mut rig = Rig::new(3, None);
    rig.send(Command::ShowFlight(1));
    rig.sentences();
    rig.send(Command::ShowFlight(1));
    assert_eq!(rig.session.view().replay.map(|replay| replay.number), Some(1));
    assert_eq!(rig.sentences(), ["Flight 3 has no frame."]);
}

#[test]
fn a_file_that_disappears_stops_the_flight_and_is_reported_once() {
    let mut rig = Rig::new(1, None);
    rig.wait(2.0);
    rig.sentences();
    *rig.is_there.lock().unwrap() = false;
    rig.wait(1.0);
    let shown_s = rig.shown_s();
    assert!(rig.session.view().paused && (shown_s - 12.0).abs() < 0.1, "{shown_s}");
    rig.seek(Seek::Seconds(5.0));
    rig.seek(Seek::Newest);
    assert_eq!(rig.sentences(), ["The file is gone."]);
    assert!((rig.shown_s() - shown_s).abs() < 1e-9, "the picture stays");
    *rig.is_there.lock().unwrap() = true;
    rig.seek(Seek::Newest);
    assert!((rig.shown_s() - 30.0).abs() < 1e-9);
}

#[test]
fn as_fast_as_possible_is_a_speed_that_can_be_seen() {
    let mut rig = Rig::new(1, None);
    rig.send(Command::Speed(f64::INFINITY));
    assert!(rig.session.view().speed_wanted.is_infinite());
    rig.now += Duration::from_millis(5);
    rig.session.player.as_mut().unwrap().play(rig.now).unwrap();
    assert!((rig.shown_s() - 10.0 - 0.005 * SPEED_RANGE.end()).abs() < 0.1, "{}", rig.shown_s());
}

#[test]
fn the_curves_of_a_flight_are_read() {
    let mut rig = Rig::new(1, None);
    let request = CurvesRequest { series: vec![0, 3], from: FIRST, to: at_s(11.0), steps: 7 };
    let (reply, mut answer) = ReplyTo::channel();
    rig.send(Command::Curves { request, reply });
    let curves = answer.try_recv().unwrap().unwrap();
    assert_eq!(curves.iter().map(|curve| curve.between(0.0, 99.0).count()).collect::<Vec<_>>(), [7, 7]);
}

#[test]
fn the_thread_shows_views_until_its_commands_end() {
    let flights = Box::new(File { count: 1, is_there: Arc::new(Mutex::new(true)) });
    let config =
        ReplayConfig { flights, number: None, is_left: false, start: None, speed: 1.0, notices: Vec::new() };
    let mut handle = start_replay(config).unwrap();
    let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
    runtime.block_on(async {
        while handle.view.borrow_and_update().vehicle.time < at_s(10.05) {
            handle.view.changed().await.unwrap();
        }
        assert!(handle.events.recv().await.is_some());
        let values = handle.view.borrow().replay.as_ref().map(|replay| Arc::clone(&replay.values));
        assert!(values.is_some_and(|values| values[0] >= 10.04));
    });
    drop(handle.commands);
    assert_eq!(handle.thread.join().unwrap(), None);
}

#[test]
fn a_flight_that_cannot_be_read_ends_the_session_with_the_reason() {
    let flights = Box::new(File { count: 3, is_there: Arc::new(Mutex::new(true)) });
    let config = ReplayConfig {
        flights,
        number: Some(2),
        is_left: false,
        start: None,
        speed: 1.0,
        notices: Vec::new(),
    };
    let handle = start_replay(config).unwrap();
    assert_eq!(handle.thread.join().unwrap().as_deref(), Some("Flight 3 has no frame."));
}

#[test]
fn a_flight_that_was_left_and_is_not_in_the_file_any_more_is_the_first_one_and_notices_come_after_its_beginning()
 {
    let flights = Box::new(File { count: 3, is_there: Arc::new(Mutex::new(true)) });
    let start = Some(ReplayStart::Clock(at_s(12.0)));
    let notices = vec!["A notice.".to_owned()];
    let config = ReplayConfig { flights, number: Some(2), is_left: true, start, speed: 1.0, notices };
    let mut handle = start_replay(config).unwrap();
    let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
    runtime.block_on(async {
        let begins = handle.events.recv().await.expect("the beginning");
        assert!(matches!(begins.kind, SessionEvent::Replay(ReplayNotice::Begins(_))), "{begins:?}");
        while handle.events.recv().await.expect("a notice").kind
            != SessionEvent::Notice("A notice.".to_owned())
        {}
        handle.view.changed().await.unwrap();
        let view = handle.view.borrow();
        assert!(!view.paused && view.replay.as_ref().is_some_and(|replay| replay.number == 0));
    });
    drop(handle.commands);
    assert_eq!(handle.thread.join().unwrap(), None);
}

/// A file that takes long to read.
struct Slow(Receiver<()>, Sender<()>);

impl PastFlights for Slow {
    fn name(&self) -> &str {
        "slow.bbl"
    }

    fn count(&self) -> usize {
        1
    }

    fn notices(&self) -> Vec<String> {
        Vec::new()
    }

    fn open(&mut self, _: usize) -> Result<Box<dyn PastFlight>, String> {
        Err("It was not read.".to_owned())
    }

    fn read(&mut self, progress: Progress<'_>) -> Result<bool, String> {
        assert!(progress(0.25), "the screen is there");
        self.1.send(()).unwrap();
        self.0.recv().unwrap();
        while progress(0.5) {
            std::thread::yield_now();
        }
        Ok(false)
    }
}

#[test]
fn reading_a_large_file_ends_when_the_screen_leaves() {
    let ((go, gone), (begin, begun)) = (std::sync::mpsc::channel(), std::sync::mpsc::channel());
    let flights = Box::new(Slow(gone, begin));
    let config =
        ReplayConfig { flights, number: None, is_left: false, start: None, speed: 1.0, notices: Vec::new() };
    let handle = start_replay(config).unwrap();
    assert_eq!(handle.view.borrow().replay.as_ref().and_then(|replay| replay.reading), Some(0.0));
    begun.recv().unwrap();
    drop(handle.commands);
    go.send(()).unwrap();
    assert_eq!(handle.thread.join().unwrap(), None);
}
