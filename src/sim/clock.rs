//! The clock of a simulation: its time, its seed, the faults that begin and end, and the events that it reports.
//!
//! A simulation has one clock and acts on its faults ([`FaultHost`]). A clock alone is the simulation of a craft that
//! an external simulator moves: only its links can fail.

use arrayvec::ArrayVec;

use crate::signals::SimTime;

use super::command::WorldCommand;
use super::event::{WorldEvent, WorldEventKind};
use super::fault::{
    ActiveFault, Effects, Fault, FaultChange, FaultLink, FaultSchedule, LinkFaults, MAX_FAULTS,
    ScheduledFault,
};
use crate::sim::config::step_us;
use crate::sim::error::WorldError;

/// The maximum number of events that can wait. If nothing takes them, later ones are lost.
const MAX_EVENTS: usize = 64;

/// Time, seed, faults and events of a simulation. A clone continues identically.
#[derive(Debug, Clone)]
pub struct Clock {
    seed: u64,
    step_us: u64,
    pub(super) time: SimTime,
    link: FaultLink,
    faults: FaultSchedule,
    pub(super) effects: Effects,
    events: ArrayVec<WorldEvent, MAX_EVENTS>,
}

impl Clock {
    /// Returns the clock of a craft that an external simulator moves.
    ///
    /// # Errors
    /// Fails if the step rate or a fault is not allowed.
    pub fn from_external(rate_hz: u32, seed: u64, faults: Vec<ScheduledFault>) -> Result<Self, WorldError> {
        let mut clock = Self::new(rate_hz, seed, FaultLink::External, faults)?;
        clock.run_faults();
        Ok(clock)
    }

    /// Returns a clock at boot. Faults that are due at boot have not begun.
    pub(super) fn new(
        rate_hz: u32,
        seed: u64,
        link: FaultLink,
        faults: Vec<ScheduledFault>,
    ) -> Result<Self, WorldError> {
        let step_us = step_us(rate_hz)?;
        if faults.len() > MAX_FAULTS {
            return Err(WorldError::TooManyFaults(MAX_FAULTS));
        }
        for scheduled in &faults {
            scheduled.check()?;
            link.allows(&scheduled.fault)?;
        }
        Ok(Self {
            seed,
            step_us,
            time: SimTime::ZERO,
            link,
            faults: FaultSchedule::new(faults),
            effects: Effects::NONE,
            events: ArrayVec::new(),
        })
    }

    /// Returns the simulated time since boot.
    pub fn time(&self) -> SimTime {
        self.time
    }

    /// Returns the length of a step, µs.
    pub fn step_us(&self) -> u64 {
        self.step_us
    }

    /// Returns the seed of all randomness.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Takes the oldest waiting event.
    pub fn take_event(&mut self) -> Option<WorldEvent> {
        self.events.pop_at(0)
    }

    /// Reports that the autopilot engaged. Faults without `boot+` count from the first call after boot or reset.
    pub fn set_engaged(&mut self, time: SimTime) {
        self.faults.set_engaged(time);
    }

    /// Returns the active faults and the remaining seconds of each.
    pub fn active_faults(&self) -> impl Iterator<Item = (Fault, Option<f64>)> {
        let left_s = |fault: &ActiveFault| fault.until.map(|until| until.seconds_since(self.time));
        self.faults.active().iter().map(move |active| (active.fault, left_s(active)))
    }

    /// Returns the waiting faults.
    pub fn waiting_faults(&self) -> &[ScheduledFault] {
        self.faults.waiting()
    }

    /// Returns `true` while the `gps-loss` fault is active.
    pub fn gps_lost(&self) -> bool {
        self.effects.gps.loss
    }

    /// Returns `true` while the `rx-loss` fault is active. No RC frame reaches the receiver then.
    pub fn rx_lost(&self) -> bool {
        self.effects.rx_loss
    }

    /// Returns the fraction of RC frames that the `rx-jitter` fault drops, 0…1. Draw from
    /// [`Stream::RxJitter`](crate::sim::Stream).
    pub fn rx_drop_fraction(&self) -> f64 {
        self.effects.rx_jitter
    }

    /// Returns the effects of the active faults on the packets of an external simulator.
    pub fn link_faults(&self) -> LinkFaults {
        self.effects.link
    }

    /// Advances by one step without a simulation.
    pub fn pass(&mut self) {
        self.advance();
        self.run_faults();
    }

    /// Changes the faults of a craft that an external simulator moves.
    ///
    /// # Errors
    /// Fails if a value is not allowed, or if the command is about anything but faults. Nothing has changed then.
    pub fn apply(&mut self, command: WorldCommand) -> Result<(), WorldError> {
        command.check()?;
        self.change_faults(command)
    }

    /// Ends the flight. Faults that count from the engagement wait for the next one.
    pub fn wait_for_next_flight(&mut self) {
        self.end_flight();
    }

    /// Ends faults of the link whose time is over when the clock is advanced by this much, µs. A clock that depends
    /// on the packets of the link stops while there are none.
    pub fn end_link_faults(&mut self, ahead_us: u64) {
        let time = SimTime(self.time.0.saturating_add(ahead_us));
        while let Some(ended) = self.faults.end_link_fault(time) {
            self.end_fault(ended);
        }
    }

    /// Advances the time by one step.
    pub(super) fn advance(&mut self) {
        self.time.0 += self.step_us;
    }

    /// Changes the end of an active fault.
    pub(super) fn set_fault_end(&mut self, fault: &Fault, until: SimTime) {
        self.faults.set_end(fault, until);
    }

    pub(super) fn emit(&mut self, kind: WorldEventKind) {
        // A full queue means that nothing takes the events.
        let _ = self.events.try_push(WorldEvent { time: self.time, kind });
    }

    fn check_fault(&self, fault: &Fault) -> Result<(), WorldError> {
        fault.check()?;
        self.link.allows(fault)?;
        if self.faults.has_room() { Ok(()) } else { Err(WorldError::TooManyFaults(MAX_FAULTS)) }
    }
}

/// A simulation in which the faults of its clock begin and end.
pub(super) trait FaultHost {
    fn clock_mut(&mut self) -> &mut Clock;

    /// Carries out a fault that acts when it begins.
    fn act(&mut self, begun: &ActiveFault);

    /// Follows a change of the effects of the active faults.
    fn use_effects(&mut self);

    /// Begins and ends the faults that are due.
    fn run_faults(&mut self) {
        let time = self.clock_mut().time;
        if !self.clock_mut().faults.is_due(time) {
            return;
        }
        while let Some(change) = self.clock_mut().faults.take_due(time) {
            match change {
                FaultChange::Begin(begun) => self.begin_fault(&begun),
                FaultChange::End(fault) => self.end_fault(fault),
            }
        }
    }

    /// Carries out a command about faults.
    fn change_faults(&mut self, command: WorldCommand) -> Result<(), WorldError> {
        let clock = self.clock_mut();
        match command {
            WorldCommand::FaultOn(fault, for_s) => {
                clock.check_fault(&fault)?;
                let until = for_s.map(|seconds| SimTime(clock.time.0 + SimTime::from_secs_f64(seconds).0));
                let begun = clock.faults.insert(fault, until);
                self.begin_fault(&begun);
            }
            WorldCommand::FaultOff(key) => self.end_faults(|active| key.covers(active)),
            WorldCommand::ClearFaults => {
                clock.faults.forget_waiting();
                self.end_faults(|_| true);
            }
            WorldCommand::Schedule(scheduled) => {
                scheduled.check()?;
                clock.check_fault(&scheduled.fault)?;
                clock.faults.add(scheduled);
            }
            WorldCommand::SetWind(_)
            | WorldCommand::SetGust(_)
            | WorldCommand::GustNow(_)
            | WorldCommand::SetTurbulence(_)
            | WorldCommand::SetNoise(_)
            | WorldCommand::SetSwitch(_)
            | WorldCommand::SetGpsRate(_)
            | WorldCommand::ResetToHome => return Err(WorldError::Outside),
        }
        Ok(())
    }

    /// Ends the flight. Faults that count from the engagement wait for the next one.
    fn end_flight(&mut self) {
        while let Some(ended) = self.clock_mut().faults.wait_for_next_flight() {
            self.end_fault(ended);
        }
    }

    fn end_faults(&mut self, ends: impl Fn(&Fault) -> bool) {
        while let Some(ended) = self.clock_mut().faults.end_first(&ends) {
            self.end_fault(ended);
        }
    }

    fn begin_fault(&mut self, begun: &ActiveFault) {
        self.clock_mut().emit(WorldEventKind::Fault { fault: begun.fault, on: true });
        self.act(begun);
        self.renew_effects();
    }

    fn end_fault(&mut self, fault: Fault) {
        self.clock_mut().emit(WorldEventKind::Fault { fault, on: false });
        self.renew_effects();
    }

    fn renew_effects(&mut self) {
        let clock = self.clock_mut();
        clock.effects = clock.faults.effects();
        self.use_effects();
    }
}

impl FaultHost for Clock {
    fn clock_mut(&mut self) -> &mut Clock {
        self
    }

    fn act(&mut self, _: &ActiveFault) {}

    fn use_effects(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::fault::{FAULTS, FaultStart};
    use crate::telemetry::FaultKind;

    fn external(faults: Vec<ScheduledFault>) -> Result<Clock, WorldError> {
        Clock::from_external(1000, 1, faults)
    }

    #[test]
    fn with_a_link_only_what_comes_in_can_fail() {
        for info in FAULTS {
            let Ok(fault) = Fault::parse(info.name(), None) else { continue };
            let start = FaultStart::Boot(5.0);
            let made = external(vec![ScheduledFault { fault, start, for_s: None }]);
            match info.kind {
                FaultKind::RxLoss | FaultKind::GpsLoss => assert!(made.is_ok(), "{}", info.kind),
                kind if info.needs_link() => assert!(made.is_ok(), "{kind}"),
                kind => assert_eq!(made.err(), Some(WorldError::OutsideFault(kind))),
            }
        }
        let mut clock = external(Vec::new()).unwrap();
        assert_eq!(clock.apply(WorldCommand::SetGust(3.0)), Err(WorldError::Outside));
    }

    #[test]
    fn time_passes_alone_and_faults_of_the_link_end_ahead_of_it() {
        let faults = ["gps-loss@boot+0.1,1", "fdm-loss@boot+0.1,1", "stall@boot+0.1"];
        let mut clock = external(faults.map(|fault| fault.parse().unwrap()).to_vec()).unwrap();
        for _ in 0..200 {
            clock.pass();
        }
        assert_eq!(clock.time().0, 200_000);
        let active = |clock: &Clock| clock.active_faults().map(|(fault, _)| fault.name()).collect::<Vec<_>>();
        assert_eq!(active(&clock), ["gps-loss", "fdm-loss", "stall"]);
        clock.end_link_faults(899_999);
        assert_eq!(active(&clock).len(), 3);
        clock.end_link_faults(900_000);
        assert_eq!(active(&clock), ["gps-loss", "stall"], "a fault without an end goes on");
        assert!(!clock.link_faults().loss.is_normal() && clock.link_faults().stall);
    }

    #[test]
    fn a_clock_knows_the_seed_of_its_world() {
        for seed in [0, 1, 7, u64::MAX] {
            assert_eq!(Clock::from_external(1000, seed, Vec::new()).map(|clock| clock.seed()), Ok(seed));
        }
    }

    #[test]
    fn a_fault_of_one_flight_ends_with_it_and_comes_back_in_the_next() {
        let faults = ["gps-loss@0.1", "rx-loss@boot+0.1"].map(|fault| fault.parse().unwrap());
        let mut clock = external(faults.to_vec()).unwrap();
        let pass = |clock: &mut Clock, steps: u32| {
            for _ in 0..steps {
                clock.pass();
            }
            (clock.gps_lost(), clock.rx_lost())
        };
        clock.set_engaged(clock.time());
        assert_eq!(pass(&mut clock, 200), (true, true));
        clock.wait_for_next_flight();
        assert_eq!(pass(&mut clock, 200), (false, true), "only the fault that counts from boot stays");
        let reported = std::iter::from_fn(|| clock.take_event()).filter(
            |event| matches!(event.kind, WorldEventKind::Fault { fault, on: false } if fault.name() == "gps-loss"),
        );
        assert_eq!(reported.count(), 1);
        clock.set_engaged(clock.time());
        assert_eq!(pass(&mut clock, 50), (false, true));
        assert_eq!(pass(&mut clock, 100), (true, true));
    }
}
