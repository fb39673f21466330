//! The flights of whole sessions, each as a recording of its own.

use betadeck_core::flight::FlightSetup;
use betadeck_core::plan::builtin::BuiltinPlan;
use betadeck_core::recording::{
    Cadence, FORMAT, Header, Recorder, Recording, RecordingSink, Repeat, Rest, Seen, Setup,
};
use betadeck_core::signals::SimTime;
use betadeck_core::timeline::{Shown, Timeline};
use betadeck_core::vehicle::{Vehicle, VehicleCommand};

fn header() -> Header {
    let text = |text: &str| text.to_owned();
    Header { format: FORMAT, program: text("0.1.0"), date: text("2026-05-09T07:29:33Z"), plan: text("land") }
}

fn setup() -> FlightSetup {
    FlightSetup { plan: BuiltinPlan::find("land").unwrap().read().unwrap(), ..FlightSetup::default() }
}

fn read(bytes: &[u8]) -> Recording {
    Recording::read(bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn repeat(recording: &Recording) -> Repeat<'_> {
    let mut repeat = Repeat::new(recording, recording.flight().unwrap()).unwrap();
    while !repeat.is_over() {
        repeat.prepare();
        repeat.tick(drop);
    }
    repeat
}

/// A sink in memory: the finished recordings, and the one under way.
#[derive(Default)]
struct Memory {
    done: Vec<Vec<u8>>,
    open: Option<Vec<u8>>,
}

impl RecordingSink for Memory {
    fn header(&self, plan: &str) -> Header {
        Header { plan: plan.to_owned(), ..header() }
    }

    fn begin(&mut self, _: &Header, bytes: &[u8]) {
        assert!(self.open.is_none());
        self.open = Some(bytes.to_vec());
    }

    fn append(&mut self, bytes: &[u8]) {
        self.open.as_mut().expect("a recording").extend(bytes);
    }

    fn end(&mut self, bytes: &[u8]) {
        self.append(bytes);
        self.done.extend(self.open.take());
    }

    fn discard(&mut self) {
        assert!(self.open.take().is_some());
    }
}

/// A session without a screen: the vehicle that flies, its timeline and its recorder.
struct Session {
    vehicle: Vehicle,
    timeline: Timeline,
    recorder: Recorder,
    sink: Memory,
    cadence: Cadence,
    passed: u64,
}

impl Session {
    fn new() -> Self {
        let setup = setup();
        let recorder = Recorder::new(Ok(Setup::from(&setup)));
        let (mut vehicle, _) = setup.build().unwrap();
        let timeline = Timeline::new(&mut vehicle).unwrap();
        Self { vehicle, timeline, recorder, sink: Memory::default(), cadence: Cadence::default(), passed: 0 }
    }

    fn tape_inputs(&mut self) {
        self.timeline.record(&mut self.vehicle);
        for (time, input) in self.timeline.inputs_from(self.passed) {
            self.recorder.input(time, input, &mut self.sink);
        }
        self.passed = self.timeline.next_input();
    }

    fn fly(&mut self, seconds: u64) {
        let until = self.vehicle.time().0 + seconds * 1_000_000;
        while self.vehicle.time().0 < until {
            self.tape_inputs();
            self.vehicle.tick();
            self.vehicle.drain_events(|event| self.recorder.event(event.into()));
            if let Some(seen) = self.cadence.due(&self.vehicle) {
                self.recorder.picture(seen, &mut self.sink);
            }
        }
    }

    /// Uploads the plan and lets the pilot fly it.
    fn start(&mut self) {
        let plan = setup().plan.plan;
        let _reported = self.vehicle.apply(&VehicleCommand::upload(plan, Vec::new()));
        self.vehicle.apply(&VehicleCommand::StartPilot(5.0)).accepted().unwrap();
    }

    fn fly_on_from(&mut self, seconds: u64) {
        let head = self.vehicle.time();
        assert_eq!(self.timeline.show(SimTime(seconds * 1_000_000), head), Shown::Earlier);
        self.vehicle = self.timeline.fly_on().unwrap();
        self.passed = self.timeline.next_input();
        self.recorder.branch(self.vehicle.time(), self.passed as usize, &mut self.sink);
    }

    fn finish(self) -> Vec<Recording> {
        let Self { recorder, mut sink, .. } = self;
        recorder.finish(&mut sink);
        assert!(sink.open.is_none());
        sink.done.iter().map(|bytes| read(bytes)).collect()
    }
}

#[test]
fn each_flight_of_a_session_is_a_recording_that_flies_again() {
    let mut session = Session::new();
    session.fly(10);
    session.start();
    session.fly(100);
    // The craft has landed; it is flown again from home.
    session.vehicle.apply(&VehicleCommand::ResetCraft);
    session.fly(10);
    session.start();
    session.fly(20);
    let recordings = session.finish();
    let results: Vec<_> = recordings.iter().map(|recording| recording.end.as_ref().unwrap()).collect();
    assert_eq!(results.len(), 2);
    assert_eq!(
        results.iter().map(|end| end.result.as_str()).collect::<Vec<_>>(),
        ["complete", "interrupted"]
    );
    assert_eq!(recordings[0].header.plan, "land");
    assert!((20.0..90.0).contains(&results[0].flown_s), "{:?}", results[0]);
    assert_eq!(recordings[0].begin, SimTime::ZERO);
    assert_eq!(recordings[1].begin, SimTime(110_000_000), "the reset");
    for recording in &recordings {
        assert_eq!((recording.rest, recording.left_out, recording.only_pictures()), (Rest::Whole, 0, None));
        let flown = repeat(recording);
        assert_eq!(flown.differs(), None);
        let (vehicle, timeline) = flown.finish();
        // A scenario can be made of it.
        let flight = timeline.unwrap().recorded_flight(vehicle.time()).unwrap();
        assert!(flight.start.time() <= SimTime(recording.begin.0 + 1000));
    }
}

#[test]
fn flying_on_from_an_earlier_instant_leaves_what_came_after_it() {
    let mut session = Session::new();
    session.fly(1);
    session.start();
    session.fly(29);
    // In flight: the same flight goes on.
    session.fly_on_from(20);
    let _reported = session.vehicle.apply(&VehicleCommand::ReturnHome);
    session.fly(5);
    let copy = read(&session.recorder.copy(&mut session.sink));
    assert_eq!(copy.end.as_ref().unwrap().t, SimTime(25_000_000));
    assert_eq!(repeat(&copy).differs(), None);
    // Before the arming: that flight is not kept.
    session.fly_on_from(1);
    assert!(session.sink.open.is_none());
    session.fly(3);
    session.start();
    session.fly(110);
    // Before the flight that begins then: the finished one stays.
    session.fly_on_from(30);
    session.fly(10);
    let recordings = session.finish();
    assert_eq!(recordings.len(), 2);
    for recording in &recordings {
        assert_eq!(repeat(recording).differs(), None);
    }
    assert_eq!(recordings[0].end.as_ref().unwrap().result, "complete");
    assert_eq!(recordings[1].begin, SimTime(30_000_000));
    assert_eq!(recordings[1].end_time(), SimTime(40_000_000));
}

#[test]
fn a_session_without_a_flight_leaves_no_recording_and_can_be_copied() {
    let mut session = Session::new();
    session.fly(30);
    let copy = read(&session.recorder.copy(&mut session.sink));
    assert_eq!(copy.header.plan, "land");
    assert!(copy.pictures.all().len() > 20);
    session.fly(2);
    let again = read(&session.recorder.copy(&mut session.sink));
    assert!(again.pictures.all().len() > copy.pictures.all().len());
    assert_eq!((again.rest, again.left_out), (Rest::Whole, 0));
    assert_eq!(session.finish().len(), 0);
}

#[test]
fn a_flight_without_its_inputs_is_recorded_as_pictures_with_the_reason() {
    let mut session = Session::new();
    session.start();
    session.recorder.lose_inputs();
    session.fly(30);
    let recordings = session.finish();
    assert_eq!(recordings[0].only_pictures().unwrap(), "more inputs came than could be recorded");
    assert!(recordings[0].flight().is_err() && recordings[0].pictures.all().len() > 100);
    let mut remote = Recorder::new(Err("a remote flight controller flew it".to_owned()));
    let mut sink = Memory::default();
    let (vehicle, _) = setup().build().unwrap();
    remote.picture(Seen::of(&vehicle), &mut sink);
    let copy = read(&remote.copy(&mut sink));
    assert_eq!(copy.only_pictures().unwrap(), "a remote flight controller flew it");
}
