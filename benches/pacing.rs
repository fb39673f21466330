//! How evenly a firmware outside is fed: the intervals of the packets to it against the steps of a millisecond, and its
//! time, which is in the stamps here, against the wall clock. `betadeck sitl` flies; the packets pass through this program.
//!
//! `cargo bench --bench pacing -- [--seconds N] [--p99-ms LIMIT]`; with a limit, a 99th percentile beyond it makes the exit
//! code 1.

#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::disallowed_types,
    clippy::print_stdout,
    reason = "a bench measures, tells and may panic; it shares its programs with the tests"
)]

#[path = "../tests/doors/program.rs"]
mod program;

use std::net::UdpSocket;
use std::process::ExitCode;
use std::time::Instant;

use program::{PATIENCE, Program, Sitl};

/// Between two packets, s.
const STEP_S: f64 = 1e-3;
/// Both programs settle, s.
const SETTLED_S: f64 = 2.0;
/// The drift is told by the earliest of so many packets at either end: it was held up least.
const ENDS: usize = 1000;

/// A packet: when it came, and its stamp, s.
#[derive(Debug, Clone, Copy)]
struct Packet {
    at_s: f64,
    stamp_s: f64,
}

/// The number behind an option.
fn option(name: &str) -> Option<f64> {
    let mut arguments = std::env::args().skip_while(|argument| argument != name);
    arguments.nth(1).map(|number| number.parse().unwrap_or_else(|_| panic!("{name} {number} is no number")))
}

/// A port that was free a moment ago.
fn free_port() -> u16 {
    UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

/// Lets the packets pass for `seconds` of wall time.
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
        // Its answers go from the firmware to the other program by themselves.
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

/// How far the stamps are ahead of the wall clock, but for a constant, s.
fn ahead_s(packets: &[Packet]) -> f64 {
    packets.iter().map(|packet| packet.stamp_s - packet.at_s).fold(f64::NEG_INFINITY, f64::max)
}

fn main() -> ExitCode {
    // `cargo test` only looks whether it runs.
    let usual = if std::env::args().any(|argument| argument == "--bench") { 20.0 } else { 1.0 };
    let seconds = option("--seconds").unwrap_or(usual);
    let packets = record(seconds);
    let mut off_s: Vec<f64> =
        packets.windows(2).map(|pair| (pair[1].at_s - pair[0].at_s - STEP_S).abs()).collect();
    off_s.sort_unstable_by(f64::total_cmp);
    let at_ms = |thousandths: usize| 1e3 * off_s[(off_s.len() * thousandths / 1000).min(off_s.len() - 1)];
    let (p50, p99, worst) = (at_ms(500), at_ms(990), at_ms(1000));
    let steps = ((packets[packets.len() - 1].stamp_s - packets[0].stamp_s) / STEP_S).round();
    let ends = ENDS.min(packets.len() / 4);
    let drift_ms = 1e3 * (ahead_s(&packets[packets.len() - ends..]) - ahead_s(&packets[..ends]));
    println!(
        "{:>7} packets in {seconds:.0} s, {:.2} % of the steps; off the millisecond by p50 {p50:.3} ms  p99 {p99:.3} ms  worst {worst:.3} ms",
        packets.len(),
        100.0 * packets.len() as f64 / (steps + 1.0)
    );
    println!("drift against the wall clock {drift_ms:+.3} ms");
    let limit_ms = option("--p99-ms").unwrap_or(f64::INFINITY);
    if p99 > limit_ms {
        println!("beyond the limit of {limit_ms} ms");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
