use std::cell::Cell;

use super::*;
use crate::flight::{Flight, FlightEnd, FlightOptions, FlightSetup};
use crate::plan::builtin::BuiltinPlan;
use crate::vehicle::Vehicle;

/// Returns a flight of the built-in `land`.
fn flight() -> Flight {
    let plan = BuiltinPlan::find("land").unwrap().read().unwrap();
    let mut setup = FlightSetup { plan: plan.clone(), ..FlightSetup::default() };
    setup.stored.plan = plan.plan;
    Flight::new(setup.build().unwrap().0, &FlightOptions::default()).unwrap()
}

/// Counts the calls, and stops the flight after this many ticks.
#[derive(Default)]
struct Counter {
    before: u64,
    events: u64,
    after: u64,
    last: u64,
}

impl<F: Flying> Subscriber<F> for Counter {
    fn before_tick(&mut self, _vehicle: &mut Vehicle) {
        assert_eq!(self.before, self.after);
        self.before += 1;
    }

    fn event(&mut self, event: &Event) {
        // The event of the boot is older than the first tick.
        assert!(event.time.0 == 0 || self.before == self.after + 1, "an event belongs to a tick: {event:?}");
        self.events += 1;
    }

    fn after_tick(&mut self, flight: &F) {
        self.after += 1;
        assert_eq!(flight.vehicle().time().0, self.after * flight.vehicle().step_us());
    }

    fn goes_on(&self) -> bool {
        self.after < self.last
    }
}

fn counter(last: u64) -> Counter {
    Counter { last, ..Counter::default() }
}

fn flown_with(subscriber: &mut impl Subscriber<Flight>) -> FlightEnd {
    let mut flight = flight();
    let mut runner = Runner::new(flight.vehicle().step_us(), f64::INFINITY, None);
    runner.fly(&mut flight, subscriber, || false).unwrap()
}

#[test]
fn observers_do_not_change_a_flight() {
    let alone = flown_with(&mut ());
    let (mut one, mut other) = (counter(u64::MAX), Some(counter(u64::MAX)));
    assert_eq!(flown_with(&mut (&mut one, &mut other)), alone);
    let other = other.unwrap();
    assert_eq!(one.after * flight().vehicle().step_us(), alone.time.0);
    assert_eq!((one.before, one.events, one.after), (other.before, other.events, other.after));
    assert!(one.events > 10, "{} events", one.events);
    assert_eq!(flown_with(&mut None::<Counter>), alone);
}

#[test]
fn an_observer_that_cannot_go_on_ends_the_flight_after_the_tick() {
    let mut flight = flight();
    let mut runner = Runner::new(flight.vehicle().step_us(), f64::INFINITY, None);
    let mut counter = counter(5000);
    let stopped = runner.fly(&mut flight, &mut counter, || false);
    assert_eq!(stopped, Err(Stopped::BySubscriber));
    assert_eq!(flight.vehicle().time().0, 5000 * flight.vehicle().step_us());
}

#[test]
fn a_flight_ends_soon_after_the_user_asks() {
    let mut flight = flight();
    let mut runner = Runner::new(flight.vehicle().step_us(), f64::INFINITY, None);
    let asked = Cell::new(0);
    let stopped = runner.fly(&mut flight, &mut (), || {
        asked.set(asked.get() + 1);
        asked.get() == 3
    });
    assert_eq!(stopped, Err(Stopped::Interrupted));
    assert_eq!(flight.vehicle().time().0, 3 * FREE_SLICE * flight.vehicle().step_us());
}

#[test]
fn a_flight_that_lost_real_time_is_marked() {
    assert_eq!(disturbed_by(Duration::from_millis(499)), "");
    let marked = disturbed_by(Duration::from_millis(1300));
    assert_eq!(marked, "; disturbed: the machine or the firmware stalled, and 1.3 s of real time were lost");
}
