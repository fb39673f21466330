//! A simulator that keeps the public plugin's rules, over a link that loses packets. Neither side waits for
//! the other for long.

use betadeck::link::proto::fdm_link::{FdmLink, FdmLinkConfig, Received, Reply};
use betadeck::telemetry::LinkState;

use super::plugin::Plugin;
use super::{MS, SeededChance};

/// Both sides, with a link between them that loses packets.
struct LossyLink {
    link: FdmLink,
    plugin: Plugin,
    chance: SeededChance,
    loss: f64,
    now: u64,
    last_state: u64,
    longest_gap: u64,
    steps_since_loss: u32,
    longest_queue: usize,
    states: u32,
}

impl LossyLink {
    fn new(loss: f64) -> Self {
        Self {
            link: FdmLink::new(FdmLinkConfig::default(), 0),
            plugin: Plugin::new(),
            chance: SeededChance(7),
            loss,
            now: 0,
            last_state: 0,
            longest_gap: 0,
            steps_since_loss: 0,
            longest_queue: 0,
            states: 0,
        }
    }

    fn send_servo(&mut self) {
        if !self.plugin.bound {
            self.link.refused();
        } else if self.chance.happens(self.loss) {
            self.steps_since_loss = 0;
        } else {
            self.plugin.socket.push_back(());
        }
    }

    fn run_until(&mut self, end: u64) {
        while self.now < end {
            if let Some(state) = self.plugin.run(self.now) {
                self.step(&state);
            }
            if self.link.poll(self.now) {
                self.send_servo();
            }
            self.now += 100;
        }
    }

    fn step(&mut self, state: &[u8]) {
        self.longest_gap = self.longest_gap.max(self.now - self.last_state);
        self.last_state = self.now;
        self.states += 1;
        self.steps_since_loss += 1;
        if self.chance.happens(self.loss) {
            self.steps_since_loss = 0;
            return;
        }
        let Received { reply, .. } = self.link.receive(state, self.now);
        if reply != Reply::Nothing {
            self.send_servo();
        }
        if self.steps_since_loss > 20 {
            self.longest_queue = self.longest_queue.max(self.plugin.socket.len());
        }
    }

    fn restart_measuring(&mut self) {
        self.steps_since_loss = 0;
        self.last_state = self.now;
    }

    /// Runs until packets flow, for a second at most. Returns the time that it took, µs.
    fn time_to_flow(&mut self) -> u64 {
        self.restart_measuring();
        let start = self.now;
        let before = self.states;
        while self.states < before + 20 && self.now < start + 1000 * MS {
            self.run_until(self.now + MS);
        }
        self.now - start
    }
}

#[test]
fn either_side_may_start_first() {
    for (firmware_waits, simulator_waits) in [(0, 0), (0, 3456), (3456, 0), (1, 777)] {
        let mut sides = LossyLink::new(0.0);
        if firmware_waits == 0 && simulator_waits > 0 {
            // Nobody received the first packet.
            sides.link.refused();
            sides.run_until(simulator_waits * MS);
            sides.plugin.bound = true;
            sides.plugin.waiting_since = sides.now;
        } else {
            sides.plugin.bound = true;
            sides.send_servo();
        }
        let took = sides.time_to_flow();
        assert!(took <= 600 * MS, "{took} µs");
        sides.longest_gap = 0;
        sides.run_until(sides.now + 5000 * MS);
        assert!(sides.longest_gap <= 2 * MS, "{} µs", sides.longest_gap);
        assert!(sides.longest_queue <= 1, "{}", sides.longest_queue);
    }
}

#[test]
fn lost_packets_stall_the_simulator_for_a_tenth_at_most() {
    let mut sides = LossyLink::new(0.01);
    sides.plugin.bound = true;
    sides.send_servo();
    sides.run_until(30_000 * MS);
    assert!(sides.longest_gap <= 150 * MS, "{} µs", sides.longest_gap);
    assert!(sides.longest_queue <= 1, "{} packets wait", sides.longest_queue);
    println!("STEPS {}", sides.plugin.steps);
    assert!(sides.plugin.steps > 10_000, "{} steps", sides.plugin.steps);
}

#[test]
fn a_long_pause_leaves_no_packets_queued() {
    let mut sides = LossyLink::new(0.0);
    sides.plugin.bound = true;
    sides.send_servo();
    sides.run_until(5000 * MS);
    sides.plugin.paused = true;
    sides.run_until(65_000 * MS);
    assert!(sides.plugin.socket.len() > 5);
    assert_eq!(sides.link.state(sides.now), LinkState::Silent);
    sides.plugin.paused = false;
    sides.plugin.waiting_since = sides.now;
    assert!(sides.time_to_flow() <= 600 * MS);
    sides.longest_gap = 0;
    sides.run_until(sides.now + 5000 * MS);
    assert!(sides.longest_gap <= 150 * MS && sides.longest_queue <= 1, "{}", sides.longest_queue);
}

#[test]
fn a_restarted_simulator_is_picked_up() {
    for gone_ms in [50, 300, 5000] {
        let mut sides = LossyLink::new(0.0);
        sides.plugin.bound = true;
        sides.send_servo();
        sides.run_until(3000 * MS);
        sides.plugin = Plugin::new();
        sides.run_until((3000 + gone_ms) * MS);
        sides.plugin.bound = true;
        sides.plugin.waiting_since = sides.now;
        sides.restart_measuring();
        let took = sides.time_to_flow();
        assert!(took <= 650 * MS, "gone for {gone_ms} ms: {took} µs");
        sides.longest_gap = 0;
        sides.run_until(sides.now + 3000 * MS);
        assert!(sides.longest_gap <= 150 * MS && sides.longest_queue <= 1);
        assert_eq!(sides.link.state(sides.now), LinkState::Flowing);
    }
}
