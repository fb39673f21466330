//! Compares the transition table of `docs/autopilot.md` with the rules: it is printed from them.

use std::fmt::Write as _;

use strum::IntoEnumIterator as _;

use super::rules::{common, monitors, own};
use super::{Facts, Outcome, ProgressFacts, Rules};
use crate::autopilot::guidance::PlaneCrossing;
use crate::autopilot::land_detector::{GroundFacts, TouchdownFacts, TouchdownGuards};
use crate::autopilot::params::Params;
use crate::plan::{HoldPattern, Seconds, WaypointType};
use crate::telemetry::{AbortReason, FenceAction, Guard, NavState, PlanSource};

impl Outcome {
    /// Describes the side effects in a few words. Empty if there are none.
    fn effect(self) -> &'static str {
        match self {
            Self::Abort(AbortReason::GpsLost) => "mission off, reason GPS_LOST",
            Self::Abort(AbortReason::NoPlan) => "mission off, reason NO_PLAN",
            Self::Abort(AbortReason::Stalled) => "mission off until the switch is cycled, reason STALLED",
            Self::Abort(AbortReason::Flyaway) => "mission off until the switch is cycled, reason FLYAWAY",
            Self::Abort(AbortReason::MagFault) => "mission off until the switch is cycled, reason MAG_FAULT",
            Self::LandHere | Self::Fence(FenceAction::Land) => "active plan: LAND here",
            Self::Fence(FenceAction::Rth) => "active plan: FLYOVER home, LAND home",
            Self::Climbed => "climb over, the leg starts here",
            Self::Missed => "the waypoint becomes a stop",
            Self::Hold => "the hold clock starts",
            Self::Orbit | Self::Figure8 => "phase 0, centre = waypoint",
            Self::Land => "descent from the current altitude",
            Self::Next => "advance to the next positional waypoint",
            Self::Complete => "target and altitude held",
            Self::Touchdown => "disarm, reason LANDING",
            Self::Arrive => "",
        }
    }
}

/// A situation of the machine, in words, and the rules that apply to it.
struct Situation {
    state: String,
    waypoint: &'static str,
    rules: Rules,
}

fn facts(kind: WaypointType, last: bool) -> Facts {
    let mut facts = Facts::default();
    facts.waypoint.kind = kind;
    facts.waypoint.last = last;
    facts
}

/// Returns the facts of a hold of 2 s.
fn timed(kind: WaypointType, last: bool) -> Facts {
    let mut facts = facts(kind, last);
    facts.waypoint.duration = Seconds::new(2.0);
    facts
}

fn own_rules(state: NavState, waypoint: &'static str, facts: &Facts) -> Situation {
    let mut rules = Rules::new();
    own(state, facts, &mut rules);
    Situation { state: state.to_string(), waypoint, rules }
}

/// Returns the rules that end a mission from any state, with the fence for both actions.
fn everywhere() -> Vec<Situation> {
    let mut list = Vec::new();
    for (state, from) in [
        (NavState::Complete, "any"),
        (NavState::Orbiting, "APPROACHING, ARRIVED, HOLDING, ORBITING, FIGURE8"),
    ] {
        for action in FenceAction::iter() {
            let mut facts = Facts::default();
            facts.fence.limit_m = Some(100.0);
            facts.fence.distance_m = Some(0.0);
            facts.fence.action = action;
            let mut rules = Rules::new();
            common(state, &facts, &mut rules);
            let fenced = state == NavState::Orbiting;
            rules.retain(|rule| matches!(rule.outcome, Outcome::Fence(_)) == fenced);
            list.push(Situation { state: from.to_owned(), waypoint: "any", rules });
        }
    }
    // Both actions print the same rows if the fence does not apply.
    list.remove(1);
    list
}

fn on_the_way() -> Vec<Situation> {
    let approaching = |waypoint, facts: &Facts| own_rules(NavState::Approaching, waypoint, facts);
    let climbing = Facts { climb: Some((0.0, 5.0)), ..Facts::default() };
    let progress = ProgressFacts { no_progress_s: 0.0, distance_m: 0.0, flyaway_m: 20.0 };
    let watched = |source, waypoint| {
        let mut facts = Facts { progress: Some(progress), ..Facts::default() };
        facts.fence.source = source;
        let mut rules = Rules::new();
        monitors(&facts, &mut rules);
        Situation { state: NavState::Approaching.to_string(), waypoint, rules }
    };
    let mut list = vec![
        approaching("any, while CLIMBING", &climbing),
        watched(PlanSource::Stored, "any of the stored plan"),
        watched(PlanSource::Rth, "any of a return home"),
    ];
    for (kind, between, last) in [
        (WaypointType::Flyover, "FLYOVER, not last", "FLYOVER last, co-located or missed"),
        (WaypointType::Flyby, "FLYBY, not last", "FLYBY last, co-located or missed"),
    ] {
        let mut crossing = facts(kind, false);
        crossing.approach.plane = PlaneCrossing::Crossed { lateral_m: 0.0 };
        crossing.approach.turn_radius_m = 5.5;
        list.push(approaching(between, &crossing));
        list.push(approaching(last, &facts(kind, true)));
    }
    let mut behind = facts(WaypointType::Flyover, false);
    behind.approach.plane = PlaneCrossing::Behind;
    list.push(approaching("FLYOVER, FLYBY, not last, behind the plane", &behind));
    list.push(approaching("HOLD", &facts(WaypointType::Hold, true)));
    list.push(approaching("LAND", &facts(WaypointType::Land, true)));
    list.push(approaching("TAKEOFF", &facts(WaypointType::Takeoff, true)));
    list
}

fn at_the_waypoint() -> Vec<Situation> {
    let mut list = Vec::new();
    let mut add = |state, waypoint, facts: Facts| list.push(own_rules(state, waypoint, &facts));
    add(NavState::Arrived, "FLYOVER, FLYBY, TAKEOFF, not last", facts(WaypointType::Flyover, false));
    add(NavState::Arrived, "FLYOVER, FLYBY, TAKEOFF, last", facts(WaypointType::Flyover, true));
    add(NavState::Arrived, "HOLD; TAKEOFF with a duration", facts(WaypointType::Hold, true));
    add(NavState::Arrived, "LAND", facts(WaypointType::Land, true));
    add(NavState::Arrived, "LAND with a duration", timed(WaypointType::Land, true));
    for (pattern, words) in [(HoldPattern::Orbit, "HOLD ORBIT"), (HoldPattern::Figure8, "HOLD FIGURE8")] {
        let mut hold = facts(WaypointType::Hold, true);
        hold.waypoint.pattern = pattern;
        add(NavState::Holding, words, hold);
    }
    add(NavState::Holding, "LAND, 2 s", timed(WaypointType::Land, true));
    for (state, between, last) in [
        (NavState::Holding, "HOLD NONE, TAKEOFF, 2 s, not last", "HOLD NONE, TAKEOFF, 2 s, last"),
        (NavState::Orbiting, "HOLD, 2 s, not last", "HOLD, 2 s, last"),
        (NavState::Figure8, "HOLD, 2 s, not last", "HOLD, 2 s, last"),
    ] {
        add(state, between, timed(WaypointType::Hold, false));
        add(state, last, timed(WaypointType::Hold, true));
    }
    let mut landing = facts(WaypointType::Land, true);
    let params = Params::default();
    let hover = f64::from(params.hover_throttle);
    landing.touchdown = TouchdownGuards::new(
        &TouchdownFacts::new(&params, hover, 0.0, 0.0, 0.0, 0.0),
        &GroundFacts { needed_us: 50.0, ..GroundFacts::CERTAIN },
    );
    add(NavState::Landing, "LAND", landing);
    list
}

fn condition(guards: &[Guard]) -> String {
    if guards.is_empty() {
        return "always".to_owned();
    }
    let words: Vec<String> = guards
        .iter()
        .map(|guard| {
            format!("{} {} {} {}", guard.name, guard.op, guard.limit, guard.unit()).trim().to_owned()
        })
        .collect();
    words.join(" and ")
}

/// Returns every transition as a Markdown table, with the default parameters as limits, in the order in which the
/// rules of a state are tried.
fn transition_table() -> String {
    let mut table =
        "| from | waypoint | condition | to | effect |\n| --- | --- | --- | --- | --- |\n".to_owned();
    for Situation { state, waypoint, rules } in
        everywhere().into_iter().chain(on_the_way()).chain(at_the_waypoint())
    {
        for rule in &rules {
            let (to, effect) = (rule.outcome.state(), rule.outcome.effect());
            // Writing to a string cannot fail.
            let _ =
                writeln!(table, "| {state} | {waypoint} | {} | {to} | {effect} |", condition(&rule.guards));
        }
    }
    table
}

#[test]
fn the_transition_table_is_the_one_of_the_code() {
    let table = transition_table();
    let page = include_str!("../../../docs/autopilot.md");
    assert!(page.contains(&table), "replace the table in docs/autopilot.md by this one:\n{table}");
}
