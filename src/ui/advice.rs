//! What stands in the way of flying, and what to do about it: one sentence and one way out.

use crate::plan::FlightPlan;
use crate::telemetry::{AbortReason, LinkState, Mode, NavState, Refusal};

use super::app_state::AppState;
use super::event_log::Level;
use super::transmitter;
use super::transmitter::ThrottleMove;

/// A sentence and the way out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Advice {
    /// How serious.
    pub level: Level,
    /// What is.
    pub what: String,
    /// What to do.
    pub fix: String,
}

fn advice(level: Level, what: impl Into<String>, fix: impl Into<String>) -> Option<Advice> {
    Some(Advice { level, what: what.into(), fix: fix.into() })
}

/// Arming-disable flags, the most useful cause first; those that only say "again" come last.
const FLAG_ORDER: [&str; 9] =
    ["CLI", "RXLOSS", "BOOTGRACE", "CALIB", "THROTTLE", "FAILSAFE", "GPS", "ANGLE", "AUTOPILOT_SW"];

/// The flag that tells the user most.
#[must_use]
pub fn most_useful<'a>(flags: &[&'a str]) -> &'a str {
    let rank = |flag: &str| match flag {
        "ARM_SWITCH" | "NOT_DISARMED" => FLAG_ORDER.len() + 1,
        _ => FLAG_ORDER.iter().position(|known| *known == flag).unwrap_or(FLAG_ORDER.len()),
    };
    flags.iter().copied().min_by_key(|flag| rank(flag)).unwrap_or_default()
}

/// What to do about an arming-disable flag.
#[must_use]
pub fn arming_hint(flag: &str) -> &'static str {
    match flag {
        "NOGYRO" => "no gyro was found",
        "FAILSAFE" => "the link was lost; wait until it is good again",
        "RXLOSS" => "no RC frames; `x` restores the link, or send RC on UDP 9004",
        "NOT_DISARMED" | "ARM_SWITCH" => "switch ARM off, then on again with `a`",
        "BOXFAILSAFE" => "switch FAILSAFE off",
        "RUNAWAY" => "motors or props are mixed up; switch ARM off",
        "CRASH" => "a crash was detected; switch ARM off",
        "THROTTLE" => "lower the throttle with `t`",
        "ANGLE" => "the craft is tilted or its attitude is not known yet",
        "BOOTGRACE" => "wait, the craft has just started",
        "NOPREARM" => "switch PREARM on",
        "LOAD" => "the processor is overloaded",
        "CALIB" => "wait and keep still, sensors are calibrating",
        "CLI" => "a CLI session is open; end it with `exit` or `save`",
        "PARALYZE" => "PARALYZE was on; restart the craft",
        "GPS" => "wait for the GPS fix",
        "RESCUE_SW" => "switch GPS RESCUE off",
        "REBOOT_REQD" => "a setting needs a restart; `save` in the CLI",
        "NO_ACC_CAL" => "calibrate the accelerometer",
        "MOTOR_PROTO" => "choose a motor protocol; `set motor_pwm_protocol = PWM` in the CLI",
        "FLIP_SWITCH" => "switch FLIP OVER AFTER CRASH off",
        "ALT_HOLD_SW" => "switch ALTHOLD off (`t` up and down does it)",
        "POS_HOLD_SW" => "switch POS HOLD off (`t` up and down does it)",
        "AUTOPILOT_SW" => "switch AUTOPILOT off with `g`, then arm",
        _ => "`status` in the CLI (5) tells more",
    }
}

/// What the user should know and do now; `None` while the mission flies.
#[must_use]
pub fn now(state: &AppState) -> Option<Advice> {
    let vehicle = &state.view.vehicle;
    let craft = &vehicle.craft;
    match state.view.simulator {
        Some(LinkState::Silent) => {
            return advice(
                Level::Fault,
                "The simulator is silent: time stands still.",
                "let it go on, or start it again",
            );
        }
        Some(LinkState::Waiting) => {
            let fix = "start it; its states come to the door udp fdm";
            return advice(Level::Warn, "No simulator yet.", fix);
        }
        Some(LinkState::Flowing) | None => {}
    }
    if let Some(truth) = &vehicle.truth {
        if truth.crashed {
            return advice(Level::Fault, "The craft crashed.", "R puts it back home");
        }
        if truth.diverged {
            return advice(
                Level::Fault,
                "The simulation left the range where it means something.",
                "R resets",
            );
        }
    }
    if vehicle.nav.engaged {
        return None;
    }
    let switched_on = transmitter::switch_is_on(state, Mode::Autopilot);
    if state.view.rc_cut {
        return advice(Level::Fault, "The RC link is cut.", "x restores it");
    }
    if craft.armed {
        if craft.failsafe_stage > 0 {
            return advice(Level::Fault, "Failsafe: the RC link is lost.", "send RC frames again");
        }
        if let Some(refusal) = vehicle.nav.refusal.filter(|_| switched_on) {
            let (what, fix) = refused(refusal);
            return advice(Level::Fault, format!("AUTOPILOT refused: {what}"), fix);
        }
        if let Some(doing) = state.view.pilot {
            return advice(Level::Info, format!("The pilot flies: {doing}."), "F stops it");
        }
        return by_hand(state);
    }
    let outside = state.view.simulator.is_some();
    if vehicle.truth.as_ref().is_some_and(|truth| !truth.on_ground && truth.alt > 1.0) {
        let fix = if outside { "reset the simulator's world" } else { "R puts the craft back home" };
        return advice(Level::Fault, "Disarmed in the air.", fix);
    }
    if vehicle.nav.state == NavState::Complete {
        let fix = if outside { "F flies again" } else { "R puts the craft back home, F flies again" };
        return advice(Level::Good, "Mission complete.", fix);
    }
    if let Some(doing) = state.view.pilot {
        if craft.gps_fix && !craft.arming_blocked_by.is_empty() {
            let flag = most_useful(&craft.arming_blocked_by);
            let what = format!("The pilot waits, arming is blocked: {flag}.");
            return advice(Level::Info, what, arming_hint(flag));
        }
        return advice(Level::Info, format!("The pilot prepares: {doing}."), "F stops it");
    }
    if !craft.gps_fix {
        return advice(Level::Warn, "No GPS fix yet.", "wait for satellites; F waits by itself");
    }
    if !craft.arming_blocked_by.is_empty() {
        let flag = most_useful(&craft.arming_blocked_by);
        return advice(Level::Warn, format!("Arming is blocked: {flag}."), arming_hint(flag));
    }
    if vehicle.stored_plan.waypoints.is_empty() {
        let fix = if state.plan.plan.waypoints.is_empty() {
            "`waypoint insert …` in the CLI (5) adds one".to_owned()
        } else {
            format!("U uploads {}; F does it and flies", state.plan.name)
        };
        return advice(Level::Warn, "The craft has no plan.", fix);
    }
    if switched_on {
        return advice(Level::Warn, "AUTOPILOT is on while disarmed.", "g switches it off, then a arms");
    }
    advice(Level::Good, "Ready.", "F flies the plan; by hand: a, t, g")
}

/// An armed craft on the sticks: where it is, and the keys that lead on from there.
fn by_hand(state: &AppState) -> Option<Advice> {
    let craft = &state.view.vehicle.craft;
    let (what, fix) = match (transmitter::is_standing(state), transmitter::throttle_move(state)) {
        (true, ThrottleMove::Low) => ("Armed, on the ground.", "g takes off; t low, then a disarms"),
        (true, _) => ("Armed, throttle low.", "t raises it and holds, then g engages"),
        (false, _) if transmitter::is_sinking(state) => {
            ("Coming down.", "t stops that; on the ground a disarms")
        }
        (false, ThrottleMove::Sink(_)) if craft.modes.has(Mode::PosHold) => {
            ("Holds its place.", "g engages, t comes down, H flies home")
        }
        (false, ThrottleMove::Sink(_)) => ("Holds its height.", "g engages, t comes down"),
        (false, ThrottleMove::Hover) => ("Flown by hand.", "t holds the place, g engages"),
        (false, ThrottleMove::Low) => ("Flown by hand.", "g engages the autopilot"),
    };
    advice(Level::Info, what, fix)
}

/// The sentence of a refusal, and the way out.
fn refused(refusal: Refusal) -> (String, &'static str) {
    match refusal {
        Refusal::NotArmed => ("the craft is not armed.".into(), "a arms, then g again"),
        Refusal::Throttle => ("the throttle was not raised since arming.".into(), "t raises it"),
        Refusal::NoFix => ("no GPS fix.".into(), "wait for satellites"),
        Refusal::NoAltitude => ("no altitude estimate.".into(), "wait for the barometer or GPS"),
        Refusal::NoPlan => ("the craft has no waypoints.".into(), "U uploads the plan"),
        Refusal::PlanCorrupt => ("the stored plan is damaged.".into(), "U uploads the plan anew"),
        Refusal::BadWaypoint(wp) => (format!("WP{wp} is invalid."), "2 Plan shows why"),
        Refusal::NoHome => {
            ("a fence is set but home is unknown.".into(), "disarm, wait for the fix, arm again")
        }
        Refusal::Geofence { wp, distance_cm, limit_m } => (
            format!("WP{wp} is {:.0} m from home, the fence is {limit_m} m.", f64::from(distance_cm) / 100.0),
            "5 CLI: set ap_max_distance_from_home, or move the waypoint",
        ),
        Refusal::Failsafe => ("the RX failsafe is active.".into(), "x restores the link"),
        Refusal::Aborted(why) => {
            let what = match why {
                AbortReason::Stalled => "no progress towards the waypoint for 30 s.",
                AbortReason::Flyaway => "the craft moved away from the waypoint.",
                AbortReason::GpsLost => "the GPS fix was lost.",
                AbortReason::NoPlan => "the plan was cleared in flight.",
            };
            (format!("mission aborted, {what}"), "g off and on again resumes")
        }
    }
}

/// What is wrong with a waypoint of a plan, or worth knowing.
#[must_use]
pub fn waypoint_problem(
    plan: &FlightPlan,
    index: usize,
    fence: Option<(crate::geo::LatLon, f64)>,
) -> Option<String> {
    let wp = plan.waypoints.get(index)?;
    if !wp.kind.is_positional() {
        return None;
    }
    if !wp.position.is_on_globe() {
        return Some(format!("WP{index}: latitude or longitude is not on the globe."));
    }
    let (home, limit_m) = fence?;
    let (distance_m, _) = crate::geo::distance_bearing(home, wp.position);
    (distance_m > limit_m)
        .then(|| format!("WP{index} is {distance_m:.0} m from home, the fence is {limit_m:.0} m."))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cause_comes_before_the_latch() {
        assert_eq!(most_useful(&["NOT_DISARMED", "THROTTLE", "CLI", "ARM_SWITCH"]), "CLI");
        assert_eq!(most_useful(&["ARM_SWITCH", "PARALYZE"]), "PARALYZE");
        assert_eq!(most_useful(&["ARM_SWITCH"]), "ARM_SWITCH");
        assert_eq!(most_useful(&[]), "");
    }
}
