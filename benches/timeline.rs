//! The recording of a flight: the time that it takes to show an earlier instant, and its use of memory.
//!
//! `cargo bench --bench timeline`. A craft circles with real noise in a turbulent wind. Seeks go to random instants of
//! the last half hour, from command to picture through a session; goal: below 0.3 s. The process then flies on to ten
//! hours; goal: below 60 MB.

#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a benchmark looks at the clock and prints"
)]

use std::time::{Duration, Instant};

use betadeck::flight::FlightSetup;
use betadeck::plan::Seconds;
use betadeck::plan::builtin::{BuiltinPlan, DEMO};
use betadeck::session::command::Seek;
use betadeck::session::{Command, Handle, SessionConfig, start};
use betadeck::signals::SimTime;
use betadeck::sim::WorldConfig;
use betadeck::storage::Store;
use betadeck::telemetry::Turbulence;
use betadeck::vehicle::VehicleCommand;

/// The number of seeks.
const SEEKS: u64 = 200;
/// The time of the seeks, and the end, simulated s.
const SOUGHT_AT_S: f64 = 1900.0;
const END_S: f64 = 36_000.0;

fn main() {
    println!("at boot: {:.1} MB", resident_mb());
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    runtime.block_on(async {
        let mut session = session();
        session.commands.send(Command::StartPilot).await.unwrap();
        fly_to(&mut session, SOUGHT_AT_S).await;
        session.commands.send(Command::Pause(true)).await.unwrap();
        session.view.wait_for(|view| view.paused).await.unwrap();
        println!("after {SOUGHT_AT_S:.0} s: {:.1} MB", resident_mb());
        seek(&mut session).await;
        session.commands.send(Command::Seek(Seek::Newest)).await.unwrap();
        session.commands.send(Command::Pause(false)).await.unwrap();
        let started = Instant::now();
        fly_to(&mut session, END_S).await;
        let ratio = (END_S - SOUGHT_AT_S) / started.elapsed().as_secs_f64();
        println!("after {END_S:.0} s: {:.1} MB, flown {ratio:.0}x real time", resident_mb());
    });
}

fn session() -> Handle {
    let world = WorldConfig { turbulence: Turbulence::Light, ..WorldConfig::default() };
    let setup = FlightSetup { world, ..FlightSetup::default() };
    let (mut vehicle, _) = setup.build().expect("the default world is sound");
    let mut plan = BuiltinPlan::find(DEMO).unwrap().read().unwrap();
    // The hold has no end.
    plan.plan.waypoints.truncate(3);
    plan.plan.waypoints[2].duration = Seconds::default();
    vehicle.apply(&VehicleCommand::upload(plan.plan, plan.settings)).accepted().unwrap();
    start(SessionConfig {
        vehicle,
        store: Store::in_memory(),
        starter_modes: true,
        speed: f64::INFINITY,
        takeoff_m: 10.0,
        is_recorded: true,
        endpoints: None,
        remote: None,
        first_events: Vec::new(),
    })
    .unwrap()
}

async fn fly_to(session: &mut Handle, time_s: f64) {
    let time = SimTime::from_secs_f64(time_s);
    while session.view.borrow_and_update().vehicle.time < time {
        session.view.changed().await.unwrap();
        while session.events.try_recv().is_ok() {}
    }
}

async fn seek(session: &mut Handle) {
    let head = session.view.borrow().vehicle.time;
    let mut times: Vec<Duration> = Vec::new();
    for n in 1..=SEEKS {
        // Scattered over the half hour.
        let back_us = (n * 7_919_333_111) % 1_800_000_000;
        let time = SimTime(head.0 - head.0.min(back_us) / 1000 * 1000);
        let started = Instant::now();
        session.commands.send(Command::Seek(Seek::Time(time))).await.unwrap();
        session.view.wait_for(|view| view.vehicle.time == time).await.unwrap();
        times.push(started.elapsed());
    }
    times.sort();
    let ms = |at: usize| times[at.min(times.len() - 1)].as_secs_f64() * 1e3;
    println!("seek: median {:.1} ms, worst of {SEEKS} {:.1} ms", ms(times.len() / 2), ms(times.len()));
}

/// Returns the memory of this process, MB.
fn resident_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmRSS:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |kb| kb / 1024.0)
}
