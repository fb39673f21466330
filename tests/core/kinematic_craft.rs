//! Missions, rescues and descents without a fix, on craft with other drag, thrust and lag than the
//! simulator's airframes.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

mod descents;
mod missions;
mod plant;
mod rig;

use betadeck_core::telemetry::DisarmReason;

use plant::Kind;
use rig::Rig;

/// Returns craft that climb and sink in other ways than the airframes of the simulator.
fn kinds() -> Vec<Kind> {
    let mut kinds = vec![Kind::HARNESS];
    for bumps in [true, false] {
        for (hover, drag, climb_gain, climb_tau_s) in [
            (0.30, 0.8, 6.0, 0.3),
            (0.30, 0.2, 12.0, 0.3),
            (0.25, 0.8, 3.0, 0.3),
            (0.30, 0.8, 3.0, 1.0),
            (0.45, 0.4, 6.0, 0.1),
            (0.55, 0.8, 10.0, 0.8),
            (0.60, 1.5, 4.0, 0.5),
        ] {
            kinds.push(Kind { hover, drag, climb_gain, climb_tau_s, bumps });
        }
    }
    kinds
}

/// Returns the throttle stick that climbs, µs.
fn climbing_us(kind: Kind) -> u16 {
    (1000.0 + 1000.0 * (kind.hover + 0.2) + 60.0) as u16
}

/// Returns the faults at the end of a flight; `None` without any.
fn fault_of(rig: &Rig, impact_mps: f64, stood_s: f64) -> Option<String> {
    let Some((reason, height_m)) = rig.disarmed else {
        return Some(format!("still armed at {:.2} m", rig.plant.height_m()));
    };
    // A bump of 60 m/s² that lasts 80 ms disturbs the estimate of the climb rate for some seconds.
    let longest_s = if rig.plant.bumps() { 30.0 } else { 18.0 };
    let faults = [
        (height_m > 0.02, format!("motors stopped at {height_m:.2} m")),
        (reason != DisarmReason::Landing, format!("ended by {reason:?}")),
        (rig.impact_mps > impact_mps, format!("hit the ground at {:.2} m/s", rig.impact_mps)),
        (stood_s > longest_s, format!("stood for {stood_s:.1} s with its motors on")),
    ];
    let faults: Vec<_> = faults.into_iter().filter(|(is_wrong, _)| *is_wrong).map(|fault| fault.1).collect();
    (!faults.is_empty()).then(|| faults.join(", "))
}

/// Flies to the end. Returns how long the craft was on the ground with its motors on, s.
fn come_down(rig: &mut Rig) -> f64 {
    let mut stood_s: f64 = 0.0;
    for _ in 0..180 * 50 {
        if rig.disarmed.is_some() {
            break;
        }
        rig.packet();
        stood_s = stood_s.max(rig.stood_s);
    }
    stood_s
}
