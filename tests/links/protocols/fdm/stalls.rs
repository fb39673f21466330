//! A busy machine stops either side again and again. No motor command may be left waiting afterwards.

use betadeck::link::proto::fdm_link::{FdmLink, FdmLinkConfig, Reply};

use super::MS;
use super::plugin::Plugin;

/// The number of stalls in a row.
const STALLS: u64 = 100;
/// The time of undisturbed flight between two stalls, µs.
const BETWEEN: u64 = 400 * MS;
/// The resolution of time, µs.
const TICK: u64 = 100;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Firmware,
    Simulator,
}

/// Both sides, with a link that loses nothing.
struct Flight {
    link: FdmLink,
    plugin: Plugin,
    /// The states that the firmware has not read yet.
    states: Vec<Vec<u8>>,
    now: u64,
    steps: u64,
}

impl Flight {
    fn start(step_us: u64) -> Self {
        let mut plugin = Plugin::with_steps(step_us);
        plugin.bound = true;
        plugin.socket.push_back(());
        let link = FdmLink::new(FdmLinkConfig::default(), 0);
        Self { link, plugin, states: Vec::new(), now: 0, steps: 0 }
    }

    /// Runs both sides for `us`. A stalled side does nothing.
    fn run(&mut self, us: u64, stalled: Option<Side>) {
        for _ in 0..us / TICK {
            self.now += TICK;
            if stalled != Some(Side::Simulator)
                && let Some(state) = self.plugin.run(self.now)
            {
                self.states.push(state);
                self.steps += 1;
            }
            if stalled != Some(Side::Firmware) {
                self.run_firmware();
            }
        }
    }

    /// Runs the firmware. It reads all waiting states before it sends anything unasked.
    fn run_firmware(&mut self) {
        for state in std::mem::take(&mut self.states) {
            if self.link.receive(&state, self.now).reply != Reply::Nothing {
                self.plugin.socket.push_back(());
            }
        }
        if self.link.poll(self.now) {
            self.plugin.socket.push_back(());
        }
    }

    /// Returns the most commands that the simulator has not read when it is about to read the newest one: 1
    /// without any lag.
    fn most_waiting(&mut self, us: u64) -> usize {
        let until = self.now + us;
        let mut most = 0;
        while self.now < until {
            self.run(TICK, None);
            most = most.max(self.plugin.socket.len());
        }
        most
    }
}

/// Returns the length of a stall, 50…1000 ms. Many end at about the time at which the firmware sends unasked.
fn stall(number: u64) -> u64 {
    match number % 4 {
        0 => 50 * MS + number * 9_500,
        1 => 100 * MS + number * 1_000,
        2 => 1000 * MS - number * 700,
        _ => 101 * MS + number * 300,
    }
}

fn fly(rate_hz: u64, side: Side) {
    let step_us = 1_000_000 / rate_hz;
    let mut flight = Flight::start(step_us);
    flight.run(1000 * MS, None);
    for number in 0..STALLS {
        flight.run(stall(number), Some(side));
        // The steps in which the excess is made up for.
        flight.run(20 * step_us, None);
        let waiting = flight.most_waiting(BETWEEN);
        let context = format!("{rate_hz} Hz, stall {number} of {side:?}: {} ms", stall(number) / MS);
        assert!(waiting <= 1, "{context}: {waiting} motor packets wait");
        let before = flight.steps;
        flight.run(BETWEEN, None);
        assert!(flight.steps - before + 2 >= BETWEEN / step_us, "{context}: {} steps", flight.steps - before);
    }
}

#[test]
fn a_firmware_that_is_held_up_a_hundred_times_leaves_no_motor_packets_queued() {
    for rate_hz in [50, 250, 1000] {
        fly(rate_hz, Side::Firmware);
    }
}

#[test]
fn a_simulator_that_is_held_up_a_hundred_times_has_no_motor_packets_left_over() {
    for rate_hz in [50, 250, 1000] {
        fly(rate_hz, Side::Simulator);
    }
}

#[test]
fn a_simulator_that_gave_up_waiting_is_not_answered_for_it() {
    let mut flight = Flight::start(4 * MS);
    flight.run(1000 * MS, None);
    for _ in 0..20 {
        flight.run(3300 * MS, Some(Side::Firmware));
        flight.run(100 * MS, None);
        assert!(flight.most_waiting(BETWEEN) <= 1, "{} motor packets wait", flight.plugin.socket.len());
    }
}
