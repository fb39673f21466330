//! The two status lines as sentences, for use without a screen.

use super::{leg_numbers, modes, rc, speed};
use crate::telemetry::LinkState;
use crate::ui::acts::{ground_under, past_flight};
use crate::ui::formatting::{clock, compass, factor};
use crate::ui::panel::in_words::{number, signed_number};
use crate::ui::shared::Shared;

/// Returns the craft and its sensors, then the mission with its numbers and the time.
pub(in crate::ui) fn lines(state: &Shared) -> [String; 2] {
    [craft(state), mission(state)]
}

fn craft(state: &Shared) -> String {
    let craft = &state.view.vehicle.craft;
    let armed = match craft.armed {
        Some(true) => "Armed",
        Some(false) => "Disarmed",
        None => "Armed or not: not known",
    };
    let modes = modes(craft).iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let modes = if modes.is_empty() { modes } else { format!(", {modes}") };
    let fix = match craft.gps_fix {
        Some(true) => "GPS fix",
        Some(false) => "no GPS fix",
        None => "GPS fix not known",
    };
    let satellites = craft.sats.map_or_else(String::new, |sats| format!(", {sats} satellites"));
    let battery = match craft.battery_v {
        Some(_) => format!("battery {} V", number(craft.battery_v, 1)),
        None => "battery not known".to_owned(),
    };
    let rc = match rc(state).0 {
        unknown if unknown.ends_with('—') => "no RC".to_owned(),
        rc => rc,
    };
    format!("{armed}{modes}; {fix}{satellites}; {battery}; {rc}.")
}

fn mission(state: &Shared) -> String {
    let vehicle = &state.view.vehicle;
    let units = state.units;
    let nav = vehicle.nav.as_ref();
    let mut parts = Vec::new();
    if let Some(nav) = nav.filter(|nav| nav.engaged)
        && let Some(kind) = nav.kind
    {
        let numbers = leg_numbers(nav);
        parts.push(format!("WP{} {kind}", nav.wp));
        parts.extend(numbers.distance_m.map(|metres| format!("{} away", units.length_text(metres, 1))));
        parts.extend(numbers.bearing_deg.map(|degrees| format!("bearing {:03.0}°", compass(degrees))));
        parts.extend(match (numbers.hold_left_s, numbers.xte_m) {
            (Some(left_s), _) if left_s.is_finite() => {
                Some(format!("hold for {} s more", number(Some(left_s), 0)))
            }
            (Some(_), _) => Some("hold without an end".to_owned()),
            (None, Some(xte_m)) => {
                let xte = signed_number(Some(units.length(xte_m)), 1);
                Some(format!("cross-track error {xte} {}", units.length_unit()))
            }
            (None, None) => None,
        });
    }
    let estimate = &vehicle.estimate;
    parts.extend(estimate.alt.map(|metres| format!("altitude {}", units.length_text(metres, 1))));
    parts.extend(
        ground_under::agl_m(state).map(|metres| format!("{} above the ground", units.length_text(metres, 1))),
    );
    parts.extend(estimate.ground_speed_mps.map(|mps| format!("speed {}", units.speed_text(mps, 1))));
    parts.extend(
        estimate
            .climb_mps
            .map(|mps| format!("climb {} {}", signed_number(Some(units.speed(mps)), 1), units.speed_unit())),
    );
    let home_m = super::home_m(state).filter(|metres| metres.is_finite());
    parts.extend(home_m.map(|metres| format!("{} from home", units.length_text(metres, 0))));
    let fence_m = nav.and_then(|nav| nav.fence_margin_m).filter(|metres| metres.is_finite());
    parts.extend(fence_m.map(|metres| format!("{} to the fence", units.length_text(metres, 0))));
    parts.push(time(state));
    format!("{}: {}.", super::state_name(nav), parts.join(", "))
}

fn time(state: &Shared) -> String {
    let view = &state.view;
    let at = clock(view.vehicle.time);
    match view.simulator {
        Some(LinkState::Waiting) => return format!("time {at}, no simulator"),
        Some(LinkState::Silent) => return format!("time {at}, the simulator is silent"),
        Some(LinkState::Flowing) | None => {}
    }
    let paused = if view.paused { ", paused" } else { "" };
    if let Some(label) = past_flight::label(state) {
        return format!("time {at}, {label} at {}{paused}", factor(view.speed_wanted));
    }
    if let Some(rewound_s) = state.rewound_s() {
        return format!("time {at}, {rewound_s:.1} s back{paused}");
    }
    if view.paused { format!("time {at}{paused}") } else { format!("time {at} at {}", speed(view).0) }
}
