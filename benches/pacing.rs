//! The regularity of the feed to a remote firmware: the intervals of its packets against the steps of a millisecond,
//! and the simulated time in its stamps against the wall clock. `betadeck sitl` flies; the packets pass through this
//! program.
//!
//! At the same time, a thread only sleeps until every millisecond. It shows the irregularity of the machine itself.
//!
//! `cargo bench --bench pacing -- [--seconds N] [--p99-ms LIMIT]`. With a limit, a 99th percentile beyond it makes the
//! exit code 1.

#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a bench measures, tells and may panic; it shares its programs with the tests"
)]

#[path = "../tests/program/doors/program.rs"]
mod program;

use std::net::UdpSocket;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use program::{PATIENCE, Program, Sitl};

/// The interval between two packets, s.
const STEP_S: f64 = 1e-3;
/// The time in which both programs settle, s.
const SETTLED_S: f64 = 2.0;
/// The number of packets at either end from which the drift is taken. The earliest of them counts: it was held up
/// least.
const ENDS: usize = 1000;

/// The arrival of a packet and its stamp, s.
#[derive(Debug, Clone, Copy)]
struct Packet {
    at_s: f64,
    stamp_s: f64,
}

/// Returns the number after an option.
fn option(name: &str) -> Option<f64> {
    let mut arguments = std::env::args().skip_while(|argument| argument != name);
    arguments.nth(1).map(|number| number.parse().unwrap_or_else(|_| panic!("{name} {number} is no number")))
}

/// Returns a port that was free a moment ago.
fn free_port() -> u16 {
    UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

/// Passes the packets on for `seconds` of wall time, and records them.
fn record(seconds: f64) -> Vec<Packet> {
    let passage = UdpSocket::bind("127.0.0.1:0").unwrap();
    passage.set_read_timeout(Some(PATIENCE)).unwrap();
    let (raw, motors) = (free_port(), free_port());
    let firmware = Sitl::start(raw, motors);
    let udp = format!("{raw},{motors},{},{}", passage.local_addr().unwrap().port(), firmware.rc.port());
    let tcp = firmware.tcp.port().to_string();
    let options = "serve --fresh --json - --ws-port 0 --firmware attach --fdm-stamps sim";
    let mut arguments: Vec<&str> = options.split(' ').collect();
    arguments.extend(["--udp-ports", &udp, "--tcp-port", &tcp]);
    let _serve = Program::start(&arguments);

    let (mut packets, mut datagram) = (Vec::new(), [0; 512]);
    let mut start = None;
    loop {
        let size = passage.recv(&mut datagram).expect("a packet");
        let now = Instant::now();
        // The firmware's answers go to the other program directly.
        passage.send_to(&datagram[..size], firmware.fdm).unwrap();
        let at_s = (now - *start.get_or_insert(now)).as_secs_f64();
        if at_s > SETTLED_S + seconds {
            return packets;
        }
        if at_s > SETTLED_S {
            packets.push(Packet { at_s, stamp_s: f64::from_le_bytes(datagram[..8].try_into().unwrap()) });
        }
    }
}

/// Returns the lead of the stamps over the wall clock, up to a constant, s.
fn ahead_s(packets: &[Packet]) -> f64 {
    packets.iter().map(|packet| packet.stamp_s - packet.at_s).fold(f64::NEG_INFINITY, f64::max)
}

/// Sleeps until every millisecond until `stop` is set. Returns the errors of the intervals between wake-ups, s, sorted.
fn sleep_beside(stop: &Arc<AtomicBool>) -> JoinHandle<Vec<f64>> {
    let stop = Arc::clone(stop);
    std::thread::spawn(move || {
        let (start, mut woken) = (Instant::now(), Vec::new());
        while !stop.load(Ordering::Relaxed) {
            let next = ((start.elapsed().as_secs_f64() / STEP_S).floor() + 1.0) * STEP_S;
            std::thread::sleep(Duration::from_secs_f64(next).saturating_sub(start.elapsed()));
            woken.push(start.elapsed().as_secs_f64());
        }
        off_the_step(&woken)
    })
}

/// Returns the errors of the intervals between these instants against the step, s, sorted.
fn off_the_step(at_s: &[f64]) -> Vec<f64> {
    let mut off_s: Vec<f64> = at_s.windows(2).map(|pair| (pair[1] - pair[0] - STEP_S).abs()).collect();
    off_s.sort_unstable_by(f64::total_cmp);
    off_s
}

/// Returns the value (ms) below which this many thousandths of the values are.
fn at_ms(sorted_s: &[f64], thousandths: usize) -> f64 {
    1e3 * sorted_s[(sorted_s.len() * thousandths / 1000).min(sorted_s.len() - 1)]
}

fn main() -> ExitCode {
    // `cargo test` only checks that it runs.
    let usual = if std::env::args().any(|argument| argument == "--bench") { 20.0 } else { 1.0 };
    let seconds = option("--seconds").unwrap_or(usual);
    let stop = Arc::new(AtomicBool::new(false));
    let sleeper = sleep_beside(&stop);
    let packets = record(seconds);
    stop.store(true, Ordering::Relaxed);
    let bare_s = sleeper.join().expect("the sleeper ends");
    let off_s = off_the_step(&packets.iter().map(|packet| packet.at_s).collect::<Vec<_>>());
    let (p50, p99, worst) = (at_ms(&off_s, 500), at_ms(&off_s, 990), at_ms(&off_s, 1000));
    let (bare_p50, bare_p99) = (at_ms(&bare_s, 500), at_ms(&bare_s, 990));
    let steps = ((packets[packets.len() - 1].stamp_s - packets[0].stamp_s) / STEP_S).round();
    let ends = ENDS.min(packets.len() / 4);
    let drift_ms = 1e3 * (ahead_s(&packets[packets.len() - ends..]) - ahead_s(&packets[..ends]));
    println!(
        "{:>7} packets in {seconds:.0} s, {:.2} % of the steps; off the millisecond by p50 {p50:.3} ms  p99 {p99:.3} ms  worst {worst:.3} ms",
        packets.len(),
        100.0 * packets.len() as f64 / (steps + 1.0)
    );
    println!(
        "a bare sleep meanwhile: p50 {bare_p50:.3} ms  p99 {bare_p99:.3} ms  worst {:.3} ms; the packets' p99 is {:.2} times that",
        at_ms(&bare_s, 1000),
        p99 / bare_p99
    );
    println!("drift against the wall clock {drift_ms:+.3} ms");
    let limit_ms = option("--p99-ms").unwrap_or(f64::INFINITY);
    if p99 > limit_ms {
        println!("beyond the limit of {limit_ms} ms");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
