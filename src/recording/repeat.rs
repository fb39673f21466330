//! A recorded flight, flown again.

use super::fingerprint;
use super::read::Recording;
use crate::flight::FlightSetup;
use crate::signals::SimTime;
use crate::telemetry::Event;
use crate::timeline::{self, Timeline};
use crate::vehicle::{Vehicle, VehicleCommand};

/// The longest flight that is flown again, since boot, µs: a day.
const MAX_US: u64 = 86_400_000_000;

/// A recorded flight that is flown again. It is recorded for replays from the time at which the craft was last at boot, put
/// back home or restarted before the flight, so that a scenario can be made of it.
#[derive(Debug)]
pub struct Repeat<'r> {
    recording: &'r Recording,
    vehicle: Vehicle,
    timeline: Option<Timeline>,
    timeline_from: SimTime,
    next_input: usize,
    next_picture: usize,
    until: SimTime,
    differs: Option<SimTime>,
}

impl Recording {
    /// Returns the start of the flight for [`Repeat::new`], without elevation tiles and the data about the build.
    ///
    /// # Errors
    /// Returns the reason why the flight cannot be flown again, the end of a sentence.
    pub fn flight(&self) -> Result<FlightSetup, String> {
        match (self.only_pictures(), &self.setup) {
            (None, Some(setup)) => setup.flight(),
            (reason, _) => Err(reason.unwrap_or_default()),
        }
    }

    /// Returns the inputs of the flight, oldest first.
    pub fn inputs(&self) -> impl Iterator<Item = &VehicleCommand> {
        self.inputs.iter().map(|(_, input)| input)
    }
}

impl<'r> Repeat<'r> {
    /// Returns the flight at boot.
    ///
    /// # Errors
    /// Returns the reason why it cannot be flown again, the end of a sentence.
    pub fn new(recording: &'r Recording, setup: FlightSetup) -> Result<Self, String> {
        let until = recording.end_time();
        if until.0 > MAX_US {
            return Err(format!("it lasts {:.0} hours since boot", until.as_secs_f64() / 3600.0));
        }
        let (mut vehicle, _) = setup.build().map_err(|error| error.to_string())?;
        if !vehicle.keep_inputs(true) {
            return Err("its flight controller or its craft is remote".to_owned());
        }
        let before = recording.inputs.iter().take_while(|(time, _)| *time <= recording.begin);
        let last_begun = before.filter(|(_, input)| timeline::begins_flight(input)).last();
        Ok(Self {
            recording,
            vehicle,
            timeline: None,
            timeline_from: last_begun.map_or(SimTime::ZERO, |(time, _)| *time),
            next_input: 0,
            next_picture: 0,
            until,
            differs: None,
        })
    }

    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// Returns the inputs before those of the flight for replays, with their times.
    pub fn earlier(&self) -> &'r [(SimTime, VehicleCommand)] {
        let inputs = &self.recording.inputs;
        let earlier = inputs.partition_point(|(time, _)| *time < self.timeline_from);
        inputs.get(..earlier).unwrap_or_default()
    }

    /// Returns the time of the first picture that shows another flight, if there is one.
    pub fn differs(&self) -> Option<SimTime> {
        self.differs
    }

    /// Returns `true` at the end of the recording, or once the flight differs from it.
    pub fn is_over(&self) -> bool {
        self.differs.is_some() || self.vehicle.time() >= self.until
    }

    /// Carries out the inputs before the next tick.
    pub fn prepare(&mut self) {
        let now = self.vehicle.time();
        if self.timeline.is_none() && now >= self.timeline_from {
            // Before the inputs of this instant, which belong to its recording.
            self.vehicle.keep_inputs(true);
            self.timeline = Timeline::new(&mut self.vehicle);
        }
        while let Some((_, input)) = self.recording.inputs.get(self.next_input).filter(|(at, _)| *at <= now) {
            // The answer was reported when the command came.
            let _reported = self.vehicle.apply(input);
            self.next_input += 1;
        }
        match &mut self.timeline {
            Some(timeline) => timeline.record(&mut self.vehicle),
            None => self.vehicle.take_inputs(drop),
        }
    }

    /// Flies one tick. Reports its events once the recording for replays has begun.
    pub fn tick(&mut self, mut report: impl FnMut(Event)) {
        self.vehicle.tick();
        let is_recorded = self.timeline.is_some();
        self.vehicle.drain_events(|event| {
            if is_recorded {
                report(event);
            }
        });
        self.compare();
    }

    /// Compares the vehicle with the picture of this instant, if there is one.
    fn compare(&mut self) {
        let now = self.vehicle.time();
        let pictures = self.recording.pictures.all();
        while let Some(picture) = pictures.get(self.next_picture).filter(|picture| picture.time() <= now) {
            let is_same = picture.print().is_none() || picture.print() == fingerprint::of(&self.vehicle);
            if picture.time() == now && !is_same {
                self.differs.get_or_insert(now);
            }
            self.next_picture += 1;
        }
    }

    /// Returns the vehicle, and its flight for replays.
    pub fn finish(self) -> (Vehicle, Option<Timeline>) {
        (self.vehicle, self.timeline)
    }
}
