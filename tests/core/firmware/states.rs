//! The state space of the complete flight controller: random plans, settings, switches, radio silence, GPS,
//! edits and commands. The real firmware flies them on ideal sensors for about a million updates of the
//! navigator.
//!
//! Each flight follows from its seed alone. A failure reports the seed and the update.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

mod crew;
mod happening;
mod law;

use std::collections::BTreeSet;

use betadeck_core::firmware::FirmwareOptions;
use betadeck_core::firmware::config::Configuration;
use betadeck_core::plan::FlightPlan;
use betadeck_core::signals::{RcFrame, RcSource};
use betadeck_core::sim::{Noise, WorldConfig};
use betadeck_core::telemetry::{EventKind, VehicleNotice};
use betadeck_core::vehicle::{CliSession, Vehicle, VehicleCommand, VehicleConfig};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crew::Crew;
use law::Law;

const FLIGHTS: usize = 250;
/// Seeds that once found a fault: a craft that was level for a moment while it tipped over.
const FOUND: [u64; 1] = [1990];
/// The number of navigator updates in a flight.
const UPDATES: u32 = 4000;
const TICKS_PER_UPDATE: u32 = 10;

/// The channels in wire order.
const ROLL: usize = 0;
const PITCH: usize = 1;
const THROTTLE: usize = 2;
const YAW: usize = 3;
const ARM: usize = 4;
const AUTOPILOT: usize = 5;
/// The switch of ANGLE, ALTHOLD and POS HOLD together.
const HOLDS: usize = 6;
const RESCUE: usize = 7;
const FAILSAFE: usize = 8;

/// A vehicle with all that a pilot, a ground station and nature do to it.
#[derive(Clone)]
struct Run {
    vehicle: Vehicle,
    frame: RcFrame,
    source: RcSource,
    /// `true` while RC frames arrive.
    link: bool,
    /// The plan that the memory of the craft should hold.
    plan: FlightPlan,
    update: u32,
    law: Law,
}

impl Run {
    /// Returns a craft on the ground with warm sensors and a switch for every tested mode.
    fn ready() -> Self {
        let mut configuration = Configuration::default();
        configuration.starter_modes();
        let world = WorldConfig { noise: Noise::None, ..WorldConfig::default() };
        let firmware = FirmwareOptions { rate_hz: world.rate_hz, ..FirmwareOptions::default() };
        let vehicle = Vehicle::new(VehicleConfig { world, firmware, configuration, live: false }).unwrap();
        let mut run = Self {
            vehicle,
            frame: RcFrame::SAFE,
            source: RcSource::Udp,
            link: true,
            plan: FlightPlan::default(),
            update: 0,
            law: Law::default(),
        };
        run.vehicle.apply(&VehicleCommand::CutRc(true));
        for line in [
            "aux 5 46 3 1700 2100 0 0",
            "aux 6 27 4 1700 2100 0 0",
            "set ap_hover_throttle = 1500",
            "set failsafe_recovery_delay = 5",
        ] {
            run.cli(line);
        }
        run
    }

    fn cli(&mut self, line: &str) {
        let reply = self.vehicle.apply(&VehicleCommand::line(CliSession::Console, line)).line().unwrap();
        assert!(!reply.failed, "{line}: {}", reply.text);
        self.law.settings_changed(self.vehicle.embedded().unwrap(), self.update);
    }

    /// Restarts the firmware in place, or puts the complete craft back home.
    fn restart(&mut self, whole: bool) {
        let kept = self.vehicle.controller().configuration().cloned().unwrap();
        self.vehicle.apply(&match whole {
            true => VehicleCommand::ResetCraft,
            false => VehicleCommand::Restart(Box::new(kept)),
        });
        self.law.restarted();
    }

    fn switch(&mut self, channel: usize, on: bool) {
        self.frame.channels[channel] = if on { 2000 } else { 1000 };
    }

    /// Flies for one update of the navigator.
    fn fly(&mut self) {
        for _ in 0..TICKS_PER_UPDATE {
            if self.link && self.vehicle.time().0.is_multiple_of(20_000) {
                self.vehicle.apply(&VehicleCommand::Rc(self.frame, self.source));
            }
            self.vehicle.tick();
            self.law.judge_motors(self.vehicle.embedded().unwrap());
            let mut events = Vec::new();
            self.vehicle.drain_events(|event| events.push(event.kind));
            for event in events {
                match event {
                    EventKind::Firmware(event) => {
                        self.law.judge_event(&event, self.vehicle.embedded().unwrap());
                    }
                    EventKind::Notice(notice) => {
                        assert!(!matches!(notice, VehicleNotice::EventsLost(_)), "{notice}");
                    }
                    _ => {}
                }
            }
        }
        assert_eq!(
            self.vehicle.embedded().unwrap().stored_plan(),
            &self.plan,
            "flying changed the stored plan"
        );
        self.law.judge_update(self.vehicle.embedded().unwrap(), self.update, self.link);
        self.update += 1;
    }
}

/// Prints the place of a failure in a flight.
struct Place {
    seed: u64,
    update: u32,
    trail: Vec<String>,
}

impl Drop for Place {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let last = self.trail.len().saturating_sub(12);
            println!("seed {}, update {}; before: {:#?}", self.seed, self.update, &self.trail[last..]);
        }
    }
}

part_and_search!(no_event_breaks_it, every 4, no_event_breaks_the_firmware, no_event_breaks_the_firmware_in_many_flights);

fn no_event_breaks_it(n: usize) {
    let mut base = Run::ready();
    let mut crew = Crew::default();
    while !crew.is_done() {
        crew.work(&mut base);
        base.fly();
    }
    let mut seen = BTreeSet::new();
    let mut happened = BTreeSet::new();
    let (mut updates, mut armings) = (0_u64, 0_u64);
    let flights = FLIGHTS / n;
    for seed in (0..flights as u64).chain(FOUND) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut run = base.clone();
        run.law.forget();
        let mut place = Place { seed, update: 0, trail: Vec::new() };
        happening::prepare(&mut run, &mut rng);
        let mut crew = Crew::done();
        let mut wait = 0;
        for update in 0..UPDATES {
            place.update = update;
            crew.watch(&run, &mut rng);
            if !crew.is_done() {
                crew.work(&mut run);
            } else if wait == 0 {
                let what = happening::happen(&mut run, &mut rng);
                place.trail.push(format!("{update}: {what}"));
                happened.insert(what.split(' ').next().unwrap_or_default().to_owned());
                wait = rng.random_range(1..200);
            } else {
                wait -= 1;
            }
            run.fly();
            updates += 1;
        }
        armings += u64::from(run.law.armings);
        seen.append(&mut run.law.seen);
    }
    println!("{updates} updates, {armings} armings, {} kinds of transitions", seen.len());
    // A part of the flights does not see each of them.
    if n == 1 {
        for needed in law::NEEDED {
            assert!(seen.contains(*needed), "{needed} never happened: {seen:#?}");
        }
    }
    assert!(armings > flights as u64, "{armings}");
}
