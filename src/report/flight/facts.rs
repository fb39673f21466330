//! The facts at the top of a report.

use super::FlightReport;
use crate::telemetry::Turbulence;
use crate::telemetry::signal::Signal;
use crate::telemetry::snapshot::WorldView;

/// Returns the facts of a flight: name and value.
pub(in crate::report) fn facts(report: &FlightReport) -> Vec<(String, String)> {
    let mut facts = Vec::new();
    let mut add = |name: &str, value: String| facts.push((name.to_owned(), value));
    if let Some(flown_s) = report.flown_s {
        let from = if report.record.engaged_at.is_some() { "" } else { " since boot" };
        add("flown", format!("{flown_s:.1} s{from}"));
    }
    if let Some(used) = battery(report) {
        add("battery", used);
    }
    if let Some(world) = &report.record.world {
        add("air", air(world));
        if world.noise {
            add("sensors", "with noise".to_owned());
        } else {
            add("sensors", "without noise".to_owned());
        }
    }
    if let Some(boot) = &report.record.boot {
        add("airframe", boot.airframe.clone());
        add("seed", boot.seed.to_string());
        add("steps a second", boot.rate_hz.to_string());
    }
    facts.extend(report.facts.iter().cloned());
    facts
}

/// Returns the charge that was drawn and the lowest voltage.
fn battery(report: &FlightReport) -> Option<String> {
    let used = report.truth.battery_used_pct.map(|used| format!("{used:.1} % used"));
    let volts = |signal| report.record.values(signal).fold(f64::INFINITY, f64::min);
    let lowest =
        [Signal::Battery, Signal::ReportedBattery].map(volts).into_iter().find(|low| low.is_finite());
    let lowest = lowest.map(|volts| format!("lowest {volts:.1} V"));
    let parts: Vec<String> = used.into_iter().chain(lowest).collect();
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// Returns the wind in words.
fn air(world: &WorldView) -> String {
    let mut parts = Vec::new();
    match world.wind {
        Some(wind) if wind.speed_mps > 0.0 => {
            parts.push(format!("{:.1} m/s from {:.0}°", wind.speed_mps, wind.from_deg));
        }
        Some(_) => parts.push("calm".to_owned()),
        None => parts.push("unknown wind".to_owned()),
    }
    if world.gust_mps > 0.0 {
        parts.push(format!("gusts {:.1} m/s", world.gust_mps));
    }
    if world.turbulence != Turbulence::None {
        parts.push(format!("turbulence {}", world.turbulence));
    }
    parts.join(", ")
}
