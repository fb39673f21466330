//! The speed of the whole vehicle: nanoseconds per tick of world, firmware and both, the speed of a whole mission as a
//! multiple of real time, and the time of the flown estimate of a plan.
//!
//! `cargo bench --bench vehicle`. The mission is the demo square from engagement to disarm, with real noise and light
//! turbulence, no samples; each figure is the median of several runs on one core. World and firmware alone replay the
//! other's recorded output in a part of that mission. The step of a bare rigid body is printed beside the whole tick, as a
//! measure of the machine.
//!
//! `-- --fly RATE` flies the mission once and prints nothing, for a profiler that counts instructions.

#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a benchmark looks at the clock and prints"
)]

#[path = "support/bare_body.rs"]
mod bare_body;

use std::hint::black_box;
use std::time::Instant;

use betadeck::blackbox::encode::LogBuffer;
use betadeck::firmware::Firmware;
use betadeck::firmware::blackbox::LogStream;
use betadeck::flight::forecast::ForecastRun;
use betadeck::flight::{Flight, FlightOptions, FlightResult, FlightSetup};
use betadeck::plan::builtin::{BuiltinPlan, DEMO};
use betadeck::plan::upload_lines;
use betadeck::signals::{MotorCommand, RcFrame, RcSource, SensorFrame};
use betadeck::sim::{World, WorldConfig};
use betadeck::telemetry::Turbulence;
use betadeck::vehicle::{CliSession, Vehicle, VehicleCommand};

const RUNS: usize = 5;
/// The number of ticks in the replayed part of the mission.
const REPLAY: usize = 100_000;

fn main() {
    let mut arguments = std::env::args().skip_while(|argument| argument != "--fly");
    if let Some(rate_hz) = arguments.nth(1) {
        mission(rate_hz.parse().expect("a rate in Hz"));
        return;
    }
    for rate_hz in [1000, 4000, 8000] {
        let mut runs: Vec<(f64, f64)> = (0..RUNS).map(|_| mission(rate_hz)).collect();
        runs.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (flown_s, wall_s) = runs[RUNS / 2];
        println!(
            "mission at {rate_hz} Hz: {flown_s:.1} s in {wall_s:.3} s, {:.0}x real time",
            flown_s / wall_s
        );
    }
    let mut estimates: Vec<f64> = (0..RUNS).map(|_| estimate()).collect();
    estimates.sort_by(f64::total_cmp);
    println!("flown estimate of the demo plan: {:.3} s", estimates[RUNS / 2]);
    let recording = record();
    let world = median(|| recording.replay_world());
    let firmware = median(|| recording.replay_firmware());
    let both = median(|| recording.fly_both());
    println!("world    {world:>7.1} ns/tick");
    println!("firmware {firmware:>7.1} ns/tick");
    println!("both     {both:>7.1} ns/tick  ({:.0}x real time at 1 kHz)", 1e6 / both);
    let bare = median(|| bare_body::ns_per_step(REPLAY as u32));
    println!("bare     {bare:>7.1} ns/step of a rigid body, {:.0} % of the whole tick", 100.0 * bare / both);
    let mut costs: Vec<[f64; 3]> = (0..4 * RUNS).map(|_| recording.cost_of_logs()).collect();
    costs.sort_by(|a, b| (a[1] / a[0]).total_cmp(&(b[1] / b[0])));
    let [without, noted, encoded] = costs[2 * RUNS];
    println!(
        "blackbox log at rate 1/2: {noted:.1} ns/tick, without {without:.1} ns/tick, ratio {:.3} (limit 1.05)",
        noted / without
    );
    println!("its bytes, after the tick: {:.1} ns/tick", encoded - noted);
}

fn air(rate_hz: u32) -> WorldConfig {
    WorldConfig { rate_hz, turbulence: Turbulence::Light, ..WorldConfig::default() }
}

fn vehicle(rate_hz: u32) -> Vehicle {
    let file = BuiltinPlan::find(DEMO).expect("the demo is built in").read().expect("the demo reads");
    let setup = FlightSetup { world: air(rate_hz), ..FlightSetup::default() };
    let (mut vehicle, _) = setup.build().expect("the default world is sound");
    for line in upload_lines(file.plan.records(), &file.settings) {
        vehicle.apply(&VehicleCommand::line(CliSession::Console, line));
    }
    vehicle
}

/// Flies the demo mission and returns the simulated and wall seconds from the engagement to the end.
fn mission(rate_hz: u32) -> (f64, f64) {
    let options = FlightOptions::default();
    let mut flight = Flight::new(vehicle(rate_hz), &options).expect("the starter modes have the switches");
    while flight.engaged_at().is_none() {
        assert!(flight.tick(|_| {}).is_none(), "the mission never engaged");
    }
    let started = Instant::now();
    loop {
        if let Some(end) = flight.tick(|report| {
            black_box(&report);
        }) {
            assert_eq!(end.verdict.result, FlightResult::Complete, "{}", end.verdict.reason);
            return (end.flown_s, started.elapsed().as_secs_f64());
        }
    }
}

/// Returns the wall seconds from the copy of a vehicle to the flown estimate of the demo plan.
fn estimate() -> f64 {
    let file = BuiltinPlan::find(DEMO).expect("the demo is built in").read().expect("the demo reads");
    let craft = vehicle(1000);
    let started = Instant::now();
    let mut run =
        ForecastRun::plan_estimate(craft.clone(), &file.plan, &file.settings, 10.0).expect("a plan to fly");
    loop {
        if let Some(forecast) = run.advance(100) {
            assert!(forecast.is_complete(), "{}", forecast.reason);
            return started.elapsed().as_secs_f64();
        }
    }
}

/// A part of the mission, tick by tick, from a vehicle that has just engaged.
struct Recording {
    start: Vehicle,
    firmware: Firmware,
    world: World,
    frames: Vec<SensorFrame>,
    commands: Vec<MotorCommand>,
    sticks: RcFrame,
}

fn record() -> Recording {
    let mut vehicle = vehicle(1000);
    let mut world = World::new(air(1000)).expect("the default world is sound");
    vehicle.apply(&VehicleCommand::StartPilot(10.0)).accepted().expect("the starter modes have the switches");
    while vehicle.engaged_at().is_none() {
        vehicle.tick();
        world.step(&MotorCommand(vehicle.truth().unwrap().motor_command));
    }
    vehicle.drain_events(drop);
    let mut recording = Recording {
        start: vehicle.clone(),
        firmware: vehicle.embedded().unwrap().clone(),
        world,
        frames: Vec::with_capacity(REPLAY),
        commands: Vec::with_capacity(REPLAY),
        sticks: vehicle.transmitter().sticks(),
    };
    for _ in 0..REPLAY {
        recording.frames.push(*vehicle.sensors());
        vehicle.tick();
        recording.commands.push(MotorCommand(vehicle.truth().unwrap().motor_command));
        vehicle.drain_events(drop);
    }
    recording
}

impl Recording {
    fn replay_world(&self) -> f64 {
        let mut world = self.world.clone();
        time_per_tick(|tick| {
            world.step(&self.commands[tick]);
            black_box(world.sensors());
        })
    }

    fn replay_firmware(&self) -> f64 {
        let mut firmware = self.firmware.clone();
        time_per_tick(|tick| {
            let frame = &self.frames[tick];
            if frame.time.0.is_multiple_of(20_000) {
                firmware.receive_rc(&self.sticks, RcSource::Sticks);
            }
            black_box(firmware.step(frame));
            while let Some(event) = firmware.take_event() {
                black_box(event);
            }
        })
    }

    fn fly_both(&self) -> f64 {
        fly(self.start.clone(), |_| {})
    }

    /// Returns the nanoseconds per tick without a log, with one, and with one that is also encoded, measured one after
    /// the other.
    fn cost_of_logs(&self) -> [f64; 3] {
        let mut logged = self.start.clone();
        let set = VehicleCommand::single_line("set blackbox_sample_rate = 1/2");
        assert!(logged.apply(&set).line().is_some_and(|reply| !reply.failed));
        logged.set_logs(true);
        let (mut stream, mut buffer, mut bytes) = (LogStream::default(), LogBuffer::default(), 0);
        let encoded = logged.clone();
        let ignore = |vehicle: &Vehicle| {
            black_box(vehicle.embedded().and_then(Firmware::log_step));
        };
        let costs = [
            fly(self.start.clone(), ignore),
            fly(logged, ignore),
            fly(encoded, |vehicle| {
                let Some(step) = vehicle.embedded().and_then(Firmware::log_step) else { return };
                buffer.clear();
                stream.step(&step, &mut buffer);
                bytes += buffer.bytes().len();
            }),
        ];
        assert!(bytes > REPLAY * 10, "a log of {bytes} bytes");
        costs
    }
}

/// Flies on, with something to do after each tick. Returns the nanoseconds per tick.
fn fly(mut vehicle: Vehicle, mut after_tick: impl FnMut(&Vehicle)) -> f64 {
    time_per_tick(|_| {
        vehicle.tick();
        after_tick(&vehicle);
        vehicle.drain_events(drop);
    })
}

/// Returns the nanoseconds per tick.
fn time_per_tick(mut tick: impl FnMut(usize)) -> f64 {
    let started = Instant::now();
    for index in 0..REPLAY {
        tick(index);
    }
    started.elapsed().as_secs_f64() * 1e9 / REPLAY as f64
}

fn median(mut measure: impl FnMut() -> f64) -> f64 {
    let mut figures: Vec<f64> = (0..RUNS).map(|_| measure()).collect();
    figures.sort_by(f64::total_cmp);
    figures[RUNS / 2]
}
