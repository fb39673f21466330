//! Frozen vehicles at intervals and the inputs between them, within bounds.
//!
//! ```text
//!   key frames   ■───────■───────■───────■─┄        a clone of the vehicle, inputs of its instant included
//!   inputs        ╵ ╵╵    ╵       ╵╵╵      ╵        by the tick before which they came
//! ```

use std::collections::VecDeque;

use super::idle::IdleTime;
use super::replay::Replay;
use crate::signals::SimTime;
use crate::vehicle::{Vehicle, VehicleCommand};

/// The limits of a recording.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// Time between two key frames, µs: the maximum that a replay flies.
    pub(super) interval_us: u64,
    /// Time for which every key frame is kept, µs without idle time.
    pub(super) dense_us: u64,
    /// Time between two older key frames, µs.
    pub(super) sparse_interval_us: u64,
    /// Reach of the recording, µs without idle time, so that waiting on the ground does not shorten the recorded
    /// flight.
    pub(super) reach_us: u64,
    /// Maximum size of the inputs, bytes; an eighth more until the next key frame.
    pub(super) input_bytes: usize,
    /// Maximum number of key frames.
    pub(super) key_frames: usize,
}

/// In idle time a key frame is dropped if its distance to the previous one is less than its age divided by this.
const IDLE_SHARE: u64 = 16;

impl Default for Bounds {
    /// Returns bounds for an hour of flight with fast access to half an hour: some 14 MB of key frames. A script at
    /// 50 Hz takes three quarters of the maximum size of the inputs. At 100 Hz the recording still reaches back 40
    /// minutes.
    fn default() -> Self {
        const MINUTE_US: u64 = 60_000_000;
        Self {
            interval_us: 10_000_000,
            dense_us: 31 * MINUTE_US,
            sparse_interval_us: MINUTE_US,
            reach_us: 60 * MINUTE_US,
            input_bytes: 11 << 20,
            key_frames: 1000,
        }
    }
}

impl Bounds {
    /// Returns bounds for pictures of a vehicle that cannot be flown again: ten a second for five minutes, and one a second
    /// for an hour: some 150 MB (23 kB each, measured).
    pub(super) fn from_pictures() -> Self {
        const SECOND_US: u64 = 1_000_000;
        Self {
            interval_us: SECOND_US / 10,
            dense_us: 300 * SECOND_US,
            sparse_interval_us: SECOND_US,
            key_frames: 6500,
            ..Self::default()
        }
    }
}

#[derive(Debug)]
pub(super) struct KeyFrame {
    vehicle: Box<Vehicle>,
    next_input: u64,
    /// Time up to the frame without idle time, µs.
    active_us: u64,
}

impl KeyFrame {
    pub(super) fn time(&self) -> SimTime {
        self.vehicle.time()
    }

    pub(super) fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// Returns the number of the first input after the frame.
    pub(super) fn next_input(&self) -> u64 {
        self.next_input
    }
}

/// An input with its time.
#[derive(Debug)]
struct TimedInput {
    at: SimTime,
    input: VehicleCommand,
}

impl TimedInput {
    fn bytes(&self) -> usize {
        size_of::<SimTime>() + self.input.bytes()
    }
}

/// Key frames and inputs, oldest first.
#[derive(Debug, Default)]
pub(super) struct Recording {
    bounds: Bounds,
    key_frames: VecDeque<KeyFrame>,
    inputs: VecDeque<TimedInput>,
    /// Number of the oldest input.
    first_input: u64,
    input_bytes: usize,
    bytes_since_key_frame: usize,
    idle: IdleTime,
}

impl Recording {
    pub(super) fn new(bounds: Bounds) -> Self {
        Self { bounds, ..Self::default() }
    }

    /// Records the inputs since the previous tick, and freezes the vehicle when that is due.
    pub(super) fn record(&mut self, vehicle: &mut Vehicle) {
        let at = vehicle.time();
        let is_idle = !vehicle.has_inputs() && vehicle.is_idle();
        self.idle.note(at, is_idle, self.bounds.interval_us);
        if vehicle.has_inputs() {
            vehicle.take_inputs(|input| {
                let input = TimedInput { at, input };
                self.input_bytes += input.bytes();
                self.bytes_since_key_frame += input.bytes();
                self.inputs.push_back(input);
            });
        }
        let is_due = |newest: &KeyFrame| at.0 >= newest.time().0 + self.bounds.interval_us;
        // With a new key frame, replays from it need no earlier inputs.
        let is_flooded = self.bytes_since_key_frame > self.bounds.input_bytes / 8;
        if self.key_frames.back().is_none_or(is_due) || is_flooded {
            let mut frozen = Box::new(vehicle.clone());
            frozen.keep_inputs(false);
            frozen.drain_events(drop);
            let next_input = self.next_input();
            let active_us = self.idle.active_us(at);
            self.key_frames.push_back(KeyFrame { vehicle: frozen, next_input, active_us });
            self.bytes_since_key_frame = 0;
            self.stay_within_bounds(at);
        }
    }

    /// Returns the idle time.
    pub(super) fn idle(&self) -> &IdleTime {
        &self.idle
    }

    /// Returns the earliest instant that can be flown to again.
    pub(super) fn first(&self) -> Option<SimTime> {
        self.key_frames.front().map(KeyFrame::time)
    }

    /// Returns the newest key frame before `time`, else the oldest. A key frame at exactly `time` already contains
    /// the inputs of that instant.
    pub(super) fn latest_before(&self, time: SimTime) -> Option<&KeyFrame> {
        let after = self.key_frames.partition_point(|frame| frame.time() < time);
        self.key_frames.get(after.saturating_sub(1))
    }

    /// Returns the oldest key frame at or after `time`.
    pub(super) fn first_from(&self, time: SimTime) -> Option<&KeyFrame> {
        self.key_frames.get(self.key_frames.partition_point(|frame| frame.time() < time))
    }

    /// Returns the input with this number, if it came at `time` or before.
    pub(super) fn input(&self, number: u64, time: SimTime) -> Option<&VehicleCommand> {
        let index = usize::try_from(number.checked_sub(self.first_input)?).ok()?;
        self.inputs.get(index).filter(|input| input.at <= time).map(|input| &input.input)
    }

    /// Returns the kept inputs with their times, oldest first.
    pub(super) fn inputs(&self) -> impl DoubleEndedIterator<Item = (SimTime, &VehicleCommand)> {
        self.inputs.iter().map(|input| (input.at, &input.input))
    }

    /// Returns the kept inputs from this number on with their times, oldest first.
    pub(super) fn inputs_from(&self, number: u64) -> impl Iterator<Item = (SimTime, &VehicleCommand)> {
        let skipped = usize::try_from(number.saturating_sub(self.first_input)).unwrap_or(usize::MAX);
        self.inputs.iter().skip(skipped).map(|input| (input.at, &input.input))
    }

    /// Returns the number of the next input.
    pub(super) fn next_input(&self) -> u64 {
        self.first_input + self.inputs.len() as u64
    }

    /// Returns the number of the oldest kept input.
    pub(super) fn first_input(&self) -> u64 {
        self.first_input
    }

    /// Forgets everything after the instant of a replay.
    pub(super) fn forget_after(&mut self, replay: &Replay) {
        let stays =
            |frame: &KeyFrame| frame.time() <= replay.time() && frame.next_input <= replay.next_input();
        while self.key_frames.back().is_some_and(|newest| !stays(newest)) {
            self.key_frames.pop_back();
        }
        while self.next_input() > replay.next_input()
            && let Some(input) = self.inputs.pop_back()
        {
            self.input_bytes -= input.bytes();
        }
        self.idle.forget_after(replay.time());
    }

    /// Thins out the older key frames and drops the oldest.
    fn stay_within_bounds(&mut self, now: SimTime) {
        self.thin_out(now);
        self.drop_oldest(now);
        if let Some(first) = self.first() {
            self.idle.forget_before(first);
        }
    }

    /// Drops key frames that are too near to the previous one: old ones, and those in the middle of idle time, whose
    /// number would otherwise grow without limit.
    fn thin_out(&mut self, now: SimTime) {
        let Bounds { dense_us, sparse_interval_us, .. } = self.bounds;
        let dense_from = self.idle.active_us(now).saturating_sub(dense_us);
        let mut index = 1;
        while let (Some(before), Some(frame), Some(after)) =
            (self.key_frames.get(index - 1), self.key_frames.get(index), self.key_frames.get(index + 1))
        {
            let of_old = if frame.active_us < dense_from { sparse_interval_us } else { 0 };
            let is_idle = before.active_us == after.active_us;
            let of_idle = if is_idle { (now.0 - frame.time().0) / IDLE_SHARE } else { 0 };
            if frame.time().0 < before.time().0 + of_old.max(of_idle) {
                self.key_frames.remove(index);
            } else {
                index += 1;
            }
        }
    }

    /// Drops the oldest key frames that are beyond the reach or too many, or whose inputs are too large.
    fn drop_oldest(&mut self, now: SimTime) {
        let Bounds { reach_us, input_bytes, key_frames, .. } = self.bounds;
        let reached_from = self.idle.active_us(now).saturating_sub(reach_us);
        let too_old = |frame: &KeyFrame| frame.active_us < reached_from;
        while self.key_frames.len() > 1
            && (self.key_frames.front().is_some_and(too_old)
                || self.key_frames.len() > key_frames
                || self.input_bytes > input_bytes)
        {
            self.key_frames.pop_front();
            self.drop_unreachable_inputs();
        }
    }

    /// Drops the inputs before the oldest key frame.
    fn drop_unreachable_inputs(&mut self) {
        let Some(needed) = self.key_frames.front().map(KeyFrame::next_input) else { return };
        while self.first_input < needed
            && let Some(input) = self.inputs.pop_front()
        {
            self.input_bytes -= input.bytes();
            self.first_input += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signals::{RcFrame, RcSource};
    use crate::vehicle::{CliSession, VehicleConfig};

    const BOUNDS: Bounds = Bounds {
        interval_us: 10_000,
        dense_us: 100_000,
        sparse_interval_us: 40_000,
        reach_us: 300_000,
        input_bytes: 2000 * size_of::<TimedInput>(),
        key_frames: usize::MAX,
    };

    fn config() -> VehicleConfig {
        VehicleConfig {
            world: crate::sim::WorldConfig::default(),
            firmware: crate::firmware::FirmwareOptions::default(),
            configuration: crate::firmware::config::Configuration::default(),
            live: true,
        }
    }

    fn recorded(bounds: Bounds, ticks: u64, frames_a_tick: u16) -> Recording {
        recorded_while(bounds, ticks, |_| frames_a_tick)
    }

    fn recorded_while(bounds: Bounds, ticks: u64, frames_at: impl Fn(u64) -> u16) -> Recording {
        let mut vehicle = Vehicle::new(config()).unwrap();
        assert!(vehicle.keep_inputs(true));
        let mut recording = Recording::new(bounds);
        for tick in 0..ticks {
            for us in 0..frames_at(tick) {
                let mut frame = RcFrame::SAFE;
                frame.channels[0] += us;
                vehicle.apply(&VehicleCommand::Rc(frame, RcSource::Udp));
            }
            recording.record(&mut vehicle);
            vehicle.tick();
        }
        recording
    }

    #[test]
    fn old_key_frames_are_thinned_out_and_the_oldest_go() {
        let bounds = Bounds { input_bytes: usize::MAX, ..BOUNDS };
        let recording = recorded(bounds, 1000, 1);
        let times: Vec<u64> = recording.key_frames.iter().map(|frame| frame.time().0 / 1000).collect();
        assert_eq!(times.last(), Some(&990));
        let (old, new) = times.split_at(times.partition_point(|&time| time < 890));
        assert!(new.windows(2).all(|pair| pair[1] - pair[0] == 10), "{times:?}");
        assert!(old.windows(2).all(|pair| pair[1] - pair[0] == 40), "{times:?}");
        assert!((690..=730).contains(&times[0]), "{times:?}");
    }

    #[test]
    fn waiting_on_the_ground_takes_no_flight_away_and_little_memory() {
        let bounds = Bounds { input_bytes: usize::MAX, ..BOUNDS };
        // A flight of 0.2 s in a long wait; the recording reaches back 0.3 s.
        let flies = 1000..1200;
        let recording = recorded_while(bounds, 10_000, |tick| u16::from(flies.contains(&tick)));
        let times: Vec<u64> = recording.key_frames.iter().map(|frame| frame.time().0 / 1000).collect();
        assert_eq!(times.first(), Some(&0));
        assert!(times.len() < 120, "{}", times.len());
        // Each instant of the flight and of the newest wait is near a key frame.
        let is_near =
            |time: &u64| times.iter().any(|frame| (time.saturating_sub(40)..=*time).contains(frame));
        assert!((1000..1200).step_by(10).all(|time| is_near(&time)), "{times:?}");
        assert!((9_900..10_000).step_by(10).all(|time| is_near(&time)), "{times:?}");
        // The gaps between the others are at most in proportion to their age.
        let apart = times.windows(2).all(|pair| pair[1] - pair[0] <= 10 + (10_000 - pair[0]) / 4);
        assert!(apart, "{times:?}");
        // A longer second flight replaces the first.
        let flies_on = 1000..1500;
        let recording = recorded_while(bounds, 10_000, |tick| u16::from(flies_on.contains(&tick)));
        assert!(recording.first() > Some(SimTime(1_000_000)), "{:?}", recording.first());
    }

    #[test]
    fn there_are_never_more_key_frames_than_allowed() {
        let recording = recorded(Bounds { key_frames: 7, ..BOUNDS }, 500, 1);
        assert_eq!(recording.key_frames.len(), 7);
        let first = recording.key_frames.front().map(KeyFrame::next_input);
        assert_eq!(first, Some(recording.first_input));
    }

    #[test]
    fn of_many_frames_before_a_tick_the_newest_is_kept() {
        let recording = recorded(BOUNDS, 100, 5);
        assert_eq!(recording.inputs.len(), 100);
        let Some(VehicleCommand::Rc(frame, RcSource::Udp)) = recording.input(50, SimTime(50_000)) else {
            panic!("a frame a tick");
        };
        assert_eq!(frame.channels[0], RcFrame::SAFE.channels[0] + 4);
    }

    #[test]
    fn a_flood_of_lines_while_time_is_paused_is_bounded() {
        let mut vehicle = Vehicle::new(config()).unwrap();
        assert!(vehicle.keep_inputs(true));
        let mut recording = Recording::new(BOUNDS);
        let line = "x".repeat(10_000);
        for _ in 0..100 {
            let _reported = vehicle.apply(&VehicleCommand::line(CliSession::Console, &line));
            assert!(vehicle.input_bytes() > line.len());
            recording.record(&mut vehicle);
            // The limit until the next key frame.
            let most = BOUNDS.input_bytes + BOUNDS.input_bytes / 8 + 2 * line.len();
            assert!(recording.input_bytes <= most, "{}", recording.input_bytes);
        }
        assert_eq!(vehicle.input_bytes(), 0);
        assert!(recording.first_input() > 80, "{}", recording.first_input());
    }

    #[test]
    fn inputs_beyond_their_bound_take_the_oldest_key_frames_along() {
        let bounds = Bounds { reach_us: u64::MAX, ..BOUNDS };
        let recording = recorded(bounds, 3000, 1);
        assert!(recording.input_bytes <= bounds.input_bytes);
        assert!(recording.inputs.len() > 1900, "{}", recording.inputs.len());
        let first = recording.key_frames.front().unwrap();
        assert_eq!(first.next_input(), recording.first_input);
        assert!(recording.inputs.front().unwrap().at > first.time());
    }
}
