//! A sample of a flight, taken from the vehicle.

use super::flag::Flag;
use super::trace::Sample;
use crate::signals::SimTime;
use crate::telemetry::PlanSource;
use crate::telemetry::signal::{Observed, SignalValues};
use crate::telemetry::snapshot::TruthView;
use crate::vehicle::Vehicle;

/// Takes a sample now. `start_m` is the altitude at the start of the flight, from which altitudes count, m.
pub(super) fn sample(vehicle: &Vehicle, engaged_at: Option<SimTime>, start_m: f64) -> Sample {
    let (estimate, nav) = (vehicle.estimate_view(), vehicle.nav_view());
    let truth = vehicle.truth_view().map(|truth| TruthView { alt: truth.alt - start_m, ..truth });
    let craft = vehicle.controller().craft_view();
    let (truth, nav) = (truth.as_ref(), nav.as_ref());
    let observed =
        Observed { time: vehicle.time(), engaged_at, truth, estimate: &estimate, craft: &craft, nav };
    let target = nav.and_then(|nav| nav.target_ne);
    Sample {
        time: observed.time,
        values: SignalValues::of(&observed),
        flags: flags(&observed),
        state: nav.map(|nav| nav.state).unwrap_or_default(),
        wp: nav.map_or(0, |nav| nav.wp),
        source: nav.map_or(PlanSource::Stored, |nav| nav.source),
        modes: craft.modes.unwrap_or_default(),
        target_ne: target.map_or([f32::NAN; 2], |ne| [ne.x as f32, ne.y as f32]),
    }
}

/// Returns the flags that are set, one bit each.
fn flags(observed: &Observed<'_>) -> u16 {
    let Observed { truth, craft, nav, .. } = *observed;
    let set = [
        (Flag::Armed, craft.is_armed()),
        (Flag::Engaged, nav.is_some_and(|nav| nav.engaged)),
        (Flag::Climbing, nav.is_some_and(|nav| nav.climbing)),
        (Flag::Fix, craft.has_fix()),
        (Flag::OnGround, truth.is_some_and(|truth| truth.on_ground)),
        (Flag::Crashed, truth.is_some_and(|truth| truth.crashed)),
        (Flag::StickOverride, nav.is_some_and(|nav| nav.stick_override)),
        (Flag::RxLink, craft.rc_link == Some(true)),
        (Flag::CannotHold, nav.is_some_and(|nav| nav.cannot_hold.is_some())),
    ];
    set.into_iter().filter(|&(_, on)| on).fold(0, |bits, (flag, _)| bits | 1 << flag as u8)
}
