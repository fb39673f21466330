//! A firmware and a simulator on one host, in steps of 100 µs: the simulator reads one packet per step and waits
//! when there is none, both stop when the host takes the processor from them, and packets get lost.

use super::Kicks;

/// The length of a step of the clock, µs.
const STEP_US: u64 = 100;

/// The disturbances of a host and its link.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Trouble {
    /// The share of the packets in both directions that is lost, 0…1.
    pub(super) loss: f64,
    /// The share of the simulator's steps in which the host stops it, 0…1.
    pub(super) simulator_stops: f64,
    /// The share of the packets after which the host stops the firmware, 0…1.
    pub(super) firmware_stops: f64,
    /// The longest stop, ms.
    pub(super) longest_stop_ms: f64,
}

#[derive(Debug)]
pub(super) struct BusyHost {
    kicks: Kicks,
    trouble: Trouble,
    now_us: u64,
    /// The packets of motors that wait in the simulator's socket.
    pub(super) waiting: u32,
    /// The states that wait in the firmware's socket.
    states: u32,
    /// The time at which the simulator ends its step; `None` = it waits for a packet.
    computes_until_us: Option<u64>,
    firmware_stops_until_us: u64,
    step_us: u64,
    /// The steps of the simulator.
    steps: u32,
    dice: u64,
}

impl BusyHost {
    /// Starts a simulator whose steps take `step_us`.
    pub(super) fn new(step_us: u64, seed: u64) -> Self {
        Self {
            kicks: Kicks::new(0),
            trouble: Trouble::default(),
            now_us: 0,
            waiting: 1,
            states: 0,
            computes_until_us: None,
            firmware_stops_until_us: 0,
            step_us,
            steps: 0,
            dice: seed.wrapping_mul(2).wrapping_add(1),
        }
    }

    /// Runs `steps` of the simulator with this trouble.
    pub(super) fn run(&mut self, trouble: Trouble, steps: u32) {
        self.trouble = trouble;
        let end = self.steps + steps;
        let give_up_us = self.now_us + 3_600_000_000;
        while self.steps < end {
            self.now_us += STEP_US;
            self.simulator();
            self.firmware();
            assert!(self.now_us < give_up_us, "the simulator stands still: {self:?}");
        }
    }

    fn simulator(&mut self) {
        match self.computes_until_us {
            Some(until_us) if self.now_us < until_us => {}
            Some(_) => {
                self.computes_until_us = None;
                self.states += u32::from(!self.happens(self.trouble.loss));
                self.steps += 1;
            }
            None if self.waiting > 0 => {
                self.waiting -= 1;
                let stop_us = self.stop_us(self.trouble.simulator_stops);
                self.computes_until_us = Some(self.now_us + self.step_us + stop_us);
            }
            None => {}
        }
    }

    fn firmware(&mut self) {
        if self.now_us < self.firmware_stops_until_us {
            return;
        }
        for _ in 0..std::mem::take(&mut self.states) {
            self.kicks.heard(self.now_us);
            if !self.kicks.withhold() {
                self.send();
            }
            self.firmware_stops_until_us = self.now_us + self.stop_us(self.trouble.firmware_stops);
        }
        if self.now_us >= self.firmware_stops_until_us && self.kicks.poll(self.now_us) {
            self.send();
        }
    }

    fn send(&mut self) {
        self.waiting += u32::from(!self.happens(self.trouble.loss));
    }

    /// Returns the length of a stop that happens in this share of the cases.
    fn stop_us(&mut self, share: f64) -> u64 {
        if self.happens(share) { (self.roll() * self.trouble.longest_stop_ms * 1000.0) as u64 } else { 0 }
    }

    fn happens(&mut self, share: f64) -> bool {
        self.roll() < share
    }

    /// Returns the next number of a fixed sequence, 0…1.
    fn roll(&mut self) -> f64 {
        self.dice = self.dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.dice >> 33) as f64 / f64::from(1_u32 << 31)
    }
}
