//! The ground crew, who put a craft that came down back into the air.

use betadeck_core::vehicle::VehicleCommand;
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;

use betadeck_core::signals::RcFrame;
use betadeck_core::sim::WorldCommand;

use super::{ARM, AUTOPILOT, HOLDS, Run, THROTTLE};

/// The longest wait for a craft that can be armed, updates. It includes a cold start of the GPS.
const PATIENCE: u32 = 6000;
/// The number of updates that a craft lies disarmed before the crew comes.
const LEFT_ALONE: u32 = 200;
const CLIMB: u32 = 500;
/// The greatest tilt at which a craft is armed, as a cosine.
const UPRIGHT: f64 = 0.95;
/// A craft is at rest if it is slower than this (m/s and rad/s) for `REST` updates. A craft that takes longer
/// than `SETTLE` updates is put back home.
const STILL_MPS: f64 = 0.05;
const STILL_RPS: f64 = 0.05;
const REST: u32 = 50;
const SETTLE: u32 = 1000;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Work {
    #[default]
    Come,
    Settle,
    Wait,
    Arm,
    Climb,
    Done,
}

/// The progress of the work.
#[derive(Debug, Clone, Default)]
pub(crate) struct Crew {
    work: Work,
    since: u32,
    lying: u32,
    resting: u32,
}

impl Crew {
    /// Returns a crew with nothing to do.
    pub(crate) fn done() -> Self {
        Self { work: Work::Done, ..Self::default() }
    }

    pub(crate) fn is_done(&self) -> bool {
        self.work == Work::Done
    }

    /// Starts the work once the craft has been lying for a while. A random delay sometimes leaves it longer.
    pub(crate) fn watch(&mut self, run: &Run, rng: &mut ChaCha8Rng) {
        self.lying = if run.vehicle.embedded().unwrap().is_armed() { 0 } else { self.lying + 1 };
        if self.is_done() && self.lying > LEFT_ALONE && rng.random_bool(0.02) {
            *self = Self::default();
        }
    }

    fn next(&mut self, work: Work) {
        self.work = work;
        self.since = 0;
    }

    /// Works for one update.
    pub(crate) fn work(&mut self, run: &mut Run) {
        self.since += 1;
        match self.work {
            Work::Come => {
                run.frame = RcFrame::SAFE;
                run.link = true;
                run.vehicle.apply(&VehicleCommand::from(WorldCommand::ClearFaults)).accepted().unwrap();
                self.resting = 0;
                self.next(Work::Settle);
            }
            Work::Settle => {
                // A craft that rocks or tumbles may be level for a moment, so its attitude counts only at
                // rest.
                let truth = run.vehicle.truth().unwrap();
                let still = truth.vel_enu.norm() < STILL_MPS && truth.rate_flu.norm() < STILL_RPS;
                self.resting = if still { self.resting + 1 } else { 0 };
                let upright = run.vehicle.embedded().unwrap().estimate().cos_tilt > UPRIGHT;
                let lies_badly = truth.crashed || self.resting >= REST && !upright;
                if lies_badly || self.since >= SETTLE {
                    run.restart(true);
                    self.next(Work::Wait);
                } else if self.resting >= REST {
                    self.next(Work::Wait);
                }
            }
            Work::Wait => {
                let flags = run.vehicle.embedded().unwrap().arming_flags();
                if run.vehicle.embedded().unwrap().arming_flags().is_empty()
                    && run.vehicle.embedded().unwrap().gps_fix()
                {
                    run.switch(ARM, true);
                    self.next(Work::Arm);
                }
                assert!(self.since < PATIENCE, "can never be armed: {:?}", flags.iter().collect::<Vec<_>>());
            }
            Work::Arm => {
                if run.vehicle.embedded().unwrap().is_armed() {
                    run.switch(HOLDS, true);
                    run.frame.channels[THROTTLE] = 1750;
                    self.next(Work::Climb);
                }
                assert!(self.since < 100, "nothing blocks arming, and it does not arm");
            }
            Work::Climb => {
                if self.since >= CLIMB || !run.vehicle.embedded().unwrap().is_armed() {
                    run.frame.channels[THROTTLE] = 1500;
                    run.switch(AUTOPILOT, true);
                    self.next(Work::Done);
                }
            }
            Work::Done => {}
        }
    }
}
