//! The flights that a runner can run, and their observers.

use std::convert::Infallible;

use crate::events::Event;
use crate::flight::forecast::{Forecast, ForecastRun};
use crate::flight::{Flight, FlightEnd};
use crate::scenario::CaseFlight;
use crate::telemetry;
use crate::timeline::Timeline;
use crate::vehicle::Vehicle;

/// A vehicle under way, with a judge or without.
pub trait Flying {
    /// The result of the flight. [`Infallible`] = it has no end.
    type End;

    fn vehicle(&self) -> &Vehicle;

    /// Returns the vehicle, to act on it between two ticks.
    fn vehicle_mut(&mut self) -> &mut Vehicle;

    /// Carries out the inputs that are due before the next tick.
    fn prepare(&mut self) {}

    /// Flies one tick and reports its events. Returns the end when the flight is over.
    fn tick(&mut self, report: impl FnMut(telemetry::Event)) -> Option<Self::End>;
}

/// An observer of a flight. Each method does nothing, and costs nothing, unless it is written.
pub trait Subscriber<F> {
    /// Called before each tick, after the inputs that are due.
    fn before_tick(&mut self, _vehicle: &mut Vehicle) {}

    /// Called for each event of the vehicle and each notice about its flight controller, in their order.
    fn event(&mut self, _event: &Event) {}

    /// Called after each tick and its events.
    fn after_tick(&mut self, _flight: &F) {}

    /// Called before the runner sleeps.
    fn before_rest(&mut self) {}

    /// Returns `false` to stop the flight.
    fn goes_on(&self) -> bool {
        true
    }
}

/// Flies one tick with its subscribers. Returns the end when the flight is over.
pub fn tick<F: Flying>(flight: &mut F, subscriber: &mut impl Subscriber<F>) -> Option<F::End> {
    flight.prepare();
    subscriber.before_tick(flight.vehicle_mut());
    let end = flight.tick(|event| subscriber.event(&event.into()));
    subscriber.after_tick(flight);
    end
}

impl Flying for Vehicle {
    type End = Infallible;

    fn vehicle(&self) -> &Vehicle {
        self
    }

    fn vehicle_mut(&mut self) -> &mut Vehicle {
        self
    }

    fn tick(&mut self, report: impl FnMut(telemetry::Event)) -> Option<Infallible> {
        Vehicle::tick(self);
        self.drain_events(report);
        None
    }
}

impl Flying for Flight {
    type End = FlightEnd;

    fn vehicle(&self) -> &Vehicle {
        Flight::vehicle(self)
    }

    fn vehicle_mut(&mut self) -> &mut Vehicle {
        Flight::vehicle_mut(self)
    }

    fn tick(&mut self, report: impl FnMut(telemetry::Event)) -> Option<FlightEnd> {
        Flight::tick(self, report)
    }
}

impl Flying for ForecastRun {
    type End = Forecast;

    fn vehicle(&self) -> &Vehicle {
        ForecastRun::vehicle(self)
    }

    fn vehicle_mut(&mut self) -> &mut Vehicle {
        ForecastRun::vehicle_mut(self)
    }

    /// A forecast takes the events itself.
    fn tick(&mut self, _report: impl FnMut(telemetry::Event)) -> Option<Forecast> {
        self.advance(1)
    }
}

impl Flying for CaseFlight<'_> {
    type End = ();

    fn vehicle(&self) -> &Vehicle {
        CaseFlight::vehicle(self)
    }

    fn vehicle_mut(&mut self) -> &mut Vehicle {
        CaseFlight::vehicle_mut(self)
    }

    fn prepare(&mut self) {
        CaseFlight::prepare(self);
    }

    fn tick(&mut self, report: impl FnMut(telemetry::Event)) -> Option<()> {
        CaseFlight::tick(self, report);
        self.is_over().then_some(())
    }
}

impl<F> Subscriber<F> for () {}

impl<F> Subscriber<F> for Timeline {
    fn before_tick(&mut self, vehicle: &mut Vehicle) {
        self.record(vehicle);
    }
}

impl<F, S: Subscriber<F>> Subscriber<F> for &mut S {
    fn before_tick(&mut self, vehicle: &mut Vehicle) {
        S::before_tick(self, vehicle);
    }

    fn event(&mut self, event: &Event) {
        S::event(self, event);
    }

    fn after_tick(&mut self, flight: &F) {
        S::after_tick(self, flight);
    }

    fn before_rest(&mut self) {
        S::before_rest(self);
    }

    fn goes_on(&self) -> bool {
        S::goes_on(self)
    }
}

impl<F, S: Subscriber<F>> Subscriber<F> for Option<S> {
    fn before_tick(&mut self, vehicle: &mut Vehicle) {
        self.iter_mut().for_each(|one| one.before_tick(vehicle));
    }

    fn event(&mut self, event: &Event) {
        self.iter_mut().for_each(|one| one.event(event));
    }

    fn after_tick(&mut self, flight: &F) {
        self.iter_mut().for_each(|one| one.after_tick(flight));
    }

    fn before_rest(&mut self) {
        self.iter_mut().for_each(S::before_rest);
    }

    fn goes_on(&self) -> bool {
        self.iter().all(S::goes_on)
    }
}

/// Both, the first one first.
impl<F, A: Subscriber<F>, B: Subscriber<F>> Subscriber<F> for (A, B) {
    fn before_tick(&mut self, vehicle: &mut Vehicle) {
        self.0.before_tick(vehicle);
        self.1.before_tick(vehicle);
    }

    fn event(&mut self, event: &Event) {
        self.0.event(event);
        self.1.event(event);
    }

    fn after_tick(&mut self, flight: &F) {
        self.0.after_tick(flight);
        self.1.after_tick(flight);
    }

    fn before_rest(&mut self) {
        self.0.before_rest();
        self.1.before_rest();
    }

    fn goes_on(&self) -> bool {
        self.0.goes_on() && self.1.goes_on()
    }
}
