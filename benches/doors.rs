//! The response time of the doors while a craft flies at real time: eight websocket clients with fifty questions a
//! second each, on a machine with little else to do.
//!
//! `cargo bench --bench doors -- [--seconds N] [--p99-ms LIMIT]`. With a limit, a later 99th percentile makes the exit
//! code 1. For comparison it also prints the lateness of a bare sleep of the same length, which is the machine's part,
//! and the program's memory at the start and at the end.

#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a bench measures, tells and may panic; it shares its clients with the tests"
)]

#[path = "../tests/program/doors/app.rs"]
mod app;
#[path = "../tests/program/doors/msp.rs"]
mod msp;
#[path = "../tests/program/doors/program.rs"]
mod program;
#[path = "../tests/program/doors/transmitter.rs"]
mod transmitter;

use std::net::SocketAddr;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use app::App;
use program::Serve;
use transmitter::Script;

const CLIENTS: usize = 8;
const PERIOD: Duration = Duration::from_millis(20);
/// The clients' questions in flight: attitude, channels, position, and the state with its list of modes.
const QUESTIONS: [(u16, &str); 4] = [(108, "ATTITUDE"), (105, "RC"), (106, "RAW_GPS"), (150, "STATUS_EX")];
/// A plan that circles until the end.
const PLAN: &str = "waypoint insert 0 40.4637000 -79.5182000 2000 500 HOLD 0 ORBIT";

/// Returns the number after an option.
fn option(name: &str) -> Option<f64> {
    let mut arguments = std::env::args().skip_while(|argument| argument != name);
    arguments.nth(1).map(|number| number.parse().unwrap_or_else(|_| panic!("{name} {number} is no number")))
}

/// Returns the delays of one client's answers, each with the index of the question.
fn client(door: SocketAddr, number: usize, requests: u32) -> Vec<(usize, Duration)> {
    let mut app = App::open(door);
    let start = Instant::now() + PERIOD / CLIENTS as u32 * number as u32;
    let ask = |k: u32| {
        thread::sleep((start + PERIOD * k).saturating_duration_since(Instant::now()));
        let question = (number + k as usize) % QUESTIONS.len();
        let asked = Instant::now();
        app.expect(QUESTIONS[question].0);
        (question, asked.elapsed())
    };
    (0..requests).map(ask).collect()
}

/// Sleeps for one period at a time until `done`, and returns the lateness of each sleep.
fn sleep_lateness(done: &AtomicBool) -> Vec<Duration> {
    let sleep = || {
        let slept = Instant::now();
        thread::sleep(PERIOD);
        slept.elapsed().saturating_sub(PERIOD)
    };
    std::iter::from_fn(|| (!done.load(Ordering::Relaxed)).then(sleep)).collect()
}

/// Returns the resident memory of a process, KiB, or `None` if the system does not report it.
fn memory_kib(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let held = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    held.trim().trim_end_matches(" kB").parse().ok()
}

fn tell(name: &str, unit: &str, delays: &mut [Duration]) -> Duration {
    delays.sort_unstable();
    let at = |share: usize| delays[(delays.len() * share / 1000).min(delays.len() - 1)];
    let ms = |delay: Duration| delay.as_secs_f64() * 1e3;
    let (p50, p99, p999, max) = (at(500), at(990), at(999), at(1000));
    println!(
        "{name:<10} {:>6} {unit:<7}  p50 {:>6.2} ms  p99 {:>6.2} ms  p99.9 {:>6.2} ms  max {:>6.2} ms",
        delays.len(),
        ms(p50),
        ms(p99),
        ms(p999),
        ms(max)
    );
    p99
}

fn main() -> ExitCode {
    // `cargo test` only checks that it runs.
    let usual = if std::env::args().any(|argument| argument == "--bench") { 20.0 } else { 1.0 };
    let seconds = option("--seconds").unwrap_or(usual);
    let limit_ms = option("--p99-ms");
    let mut serve = Serve::start("1");
    let mut app = App::connect(serve.websocket);
    app.line("waypoint clear");
    app.line(PLAN);
    msp::wait_until_ready(serve.tcp);
    let script = Script::udp(serve.rc);
    serve.wait("start of the mission", |event| event["event"] == "state" && event["to"] == "APPROACHING");
    let door = serve.websocket;
    let requests = (seconds / PERIOD.as_secs_f64()) as u32;
    let done = &AtomicBool::new(false);
    let before = memory_kib(serve.id());
    let (mut answers, mut lateness): (Vec<(usize, Duration)>, Vec<Duration>) = thread::scope(|scope| {
        let clients: Vec<_> =
            (0..CLIENTS).map(|number| scope.spawn(move || client(door, number, requests))).collect();
        let sleeper = scope.spawn(|| sleep_lateness(done));
        let answers = clients.into_iter().map(thread::ScopedJoinHandle::join).collect::<Vec<_>>();
        done.store(true, Ordering::Relaxed);
        (answers.into_iter().flat_map(Result::unwrap).collect(), sleeper.join().unwrap())
    });
    let after = memory_kib(serve.id());
    assert!(!serve.has_seen("disarmed"), "the craft flies to the end");
    script.end();
    for (question, (_, name)) in QUESTIONS.iter().enumerate() {
        let mut delays: Vec<_> =
            answers.iter().filter(|(asked, _)| *asked == question).map(|(_, delay)| *delay).collect();
        tell(name, "answers", &mut delays);
    }
    let mut all: Vec<_> = answers.drain(..).map(|(_, delay)| delay).collect();
    let p99 = tell("all", "answers", &mut all);
    tell("bare sleep", "sleeps", &mut lateness);
    if let (Some(before), Some(after)) = (before, after) {
        println!("memory     {before} KiB at the start, {after} KiB after {seconds} s");
    }
    match limit_ms {
        Some(limit_ms) if p99.as_secs_f64() * 1e3 > limit_ms => {
            println!("the 99th percentile is above {limit_ms} ms");
            ExitCode::FAILURE
        }
        _ => ExitCode::SUCCESS,
    }
}
