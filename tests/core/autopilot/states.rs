//! The state space of the navigator: random plans, parameters and events, flown for about a million updates
//! in all. `PROPTEST_CASES` scales the number; a case is 4000 updates.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

use std::cell::RefCell;
use std::collections::BTreeSet;

use crate::autopilot::flight::{Flight, plan, waypoint};
use betadeck_core::autopilot::{Params, Rescue};
use betadeck_core::plan::WaypointRecord;
use betadeck_core::plan::{FlightPlan, HoldPattern, Waypoint, WaypointType};
use betadeck_core::telemetry::{InFlightCommand, NavEvent, NavState, TransitionReason};
use nalgebra::Vector2;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use strum::IntoEnumIterator;

const UPDATES: u32 = 4000;
/// The number of updates that a disturbance lasts.
const HEALS: u32 = 300;
/// The number of updates within which a changed limit must be in force.
const SETTLE: u32 = 300;

/// Something that happens between two updates.
#[derive(Debug, Clone)]
enum Happening {
    Switch(bool),
    Fix(bool),
    Altitude(bool),
    Home(bool),
    Failsafe(bool),
    Armed(bool),
    Sticks(f64, f64, f64),
    EditPlan(Box<FlightPlan>),
    ClearPlan,
    ReturnHome(bool),
    EmergencyLand,
    Reset,
    SetCurrent(u8),
    Command(InFlightCommand),
    Teleport(f64, f64),
    Parameter(usize, f64),
    Wind(f64, f64),
}

fn any_waypoint() -> impl Strategy<Value = Waypoint> {
    let kinds: Vec<WaypointType> = WaypointType::iter().collect();
    let patterns: Vec<HoldPattern> = HoldPattern::iter().collect();
    // A coarse grid makes places coincide now and then. Short holds let missions continue.
    let place = (-4..=4_i8, -4..=4_i8);
    let flags = (prop::sample::select(kinds), prop::sample::select(patterns));
    (place, flags, prop::sample::select(vec![0, 1, 10, 30]), 0..900_u16, 0..2500_i32).prop_map(
        |((north, east), (kind, pattern), duration_ds, speed, alt_cm)| {
            let place = waypoint(kind, f64::from(north) * 5.0, f64::from(east) * 5.0, 0.0, 0.0);
            WaypointRecord { duration_ds, speed, alt_cm, pattern, ..place.into() }.into()
        },
    )
}

fn any_plan() -> impl Strategy<Value = FlightPlan> {
    let sizes = prop_oneof![3 => 1..6_usize, 1 => 0..=30_usize];
    sizes.prop_flat_map(|size| prop::collection::vec(any_waypoint(), size)).prop_map(|list| plan(&list))
}

fn any_happening() -> impl Strategy<Value = Happening> {
    use Happening as H;
    let stick = || prop_oneof![3 => Just(0.0), 1 => -500.0..500.0];
    let likely = |share: f64| prop::bool::weighted(share);
    prop_oneof![
        4 => likely(0.8).prop_map(H::Switch),
        2 => likely(0.7).prop_map(H::Fix),
        1 => likely(0.8).prop_map(H::Altitude),
        1 => likely(0.8).prop_map(H::Home),
        1 => likely(0.3).prop_map(H::Failsafe),
        2 => likely(0.8).prop_map(H::Armed),
        3 => (stick(), stick(), stick()).prop_map(|(roll, pitch, yaw)| H::Sticks(roll, pitch, yaw)),
        1 => any_plan().prop_map(|plan| H::EditPlan(Box::new(plan))),
        1 => Just(H::ClearPlan),
        2 => any::<bool>().prop_map(H::ReturnHome),
        1 => Just(H::EmergencyLand),
        1 => Just(H::Reset),
        2 => (0..32_u8).prop_map(H::SetCurrent),
        1 => (0..32_u8).prop_map(|index| H::Command(InFlightCommand::GoTo(index))),
        1 => Just(H::Command(InFlightCommand::HoldHere)),
        1 => Just(H::Command(InFlightCommand::Resume)),
        1 => (-200.0..200.0, -200.0..200.0).prop_map(|(north, east)| H::Teleport(north, east)),
        3 => (0..Params::FIELDS.len(), 0.0..=1.0).prop_map(|(field, share)| H::Parameter(field, share)),
        1 => (-8.0..8.0, -8.0..8.0).prop_map(|(north, east)| H::Wind(north, east)),
    ]
}

fn set_share(params: &mut Params, field: usize, share: f64) {
    let field = &Params::FIELDS[field];
    let span = (field.max - field.min) as f64;
    (field.set)(params, field.min + (span * share).round() as i64);
}

/// Returns `true` for the transitions that a rule or a command may cause. Every other transition is illegal.
fn legal(from: NavState, to: NavState) -> bool {
    use NavState::{Approaching, Arrived, Complete, Figure8, Holding, Idle, Landing, Orbiting};
    match (from, to) {
        // Disengaging, an emergency landing, a return home and a jump are possible from any state.
        (_, Idle | Landing | Approaching) => true,
        (Idle, Complete) | (Approaching, Arrived) | (Arrived, Holding | Complete) => true,
        (Holding, Orbiting | Figure8 | Complete) => true,
        (Orbiting | Figure8 | Landing, Complete) => true,
        (Idle | Arrived | Holding | Orbiting | Figure8 | Landing | Complete, Arrived) => false,
        (Idle | Approaching | Holding | Orbiting | Figure8 | Landing | Complete, Holding) => false,
        (Idle | Approaching | Arrived | Orbiting | Figure8 | Landing | Complete, Orbiting | Figure8) => false,
        (Approaching | Complete, Complete) => false,
    }
}

/// The limits of throttle (µs) and tilt (degrees). After a change, the widest of the old and the new ones.
#[derive(Debug, Clone, Copy)]
struct Limits {
    low_us: f64,
    high_us: f64,
    tilt_deg: f64,
}

impl Limits {
    fn of(params: &Params) -> Self {
        let low_us = f64::from(params.throttle_min);
        let high_us = f64::from(params.throttle_max).max(low_us);
        Self { low_us, high_us, tilt_deg: f64::from(params.max_angle) }
    }

    fn widest(self, other: Self) -> Self {
        Self {
            low_us: self.low_us.min(other.low_us),
            high_us: self.high_us.max(other.high_us),
            tilt_deg: self.tilt_deg.max(other.tilt_deg),
        }
    }
}

struct Run {
    flight: Flight,
    /// The plan that is stored again after it was cleared.
    first: FlightPlan,
    /// The update at which the disturbance ends.
    heals_at: u32,
    switch: bool,
    last: NavState,
    arrived_for: u32,
    limits_changed_at: u32,
    /// The limits that may be in force.
    limits: Limits,
    seen: BTreeSet<(NavState, NavState)>,
}

impl Run {
    fn happen(&mut self, what: &Happening, update: u32) {
        let flight = &mut self.flight;
        let rescue = Rescue {
            altitude_m: 40.0,
            near_climb_m: None,
            climb_mps: 5.0,
            speed_mps: 8.0,
            descend_mps: 2.0,
            is_watched: true,
        };
        self.heals_at = update + HEALS;
        // A refused command is allowed here.
        match what {
            Happening::Switch(on) => {
                self.switch = *on;
                if !on {
                    flight.nav.disengage();
                }
            }
            Happening::Fix(fix) => flight.inputs.fix = *fix,
            Happening::Altitude(valid) => flight.inputs.altitude_valid = *valid,
            Happening::Home(known) => flight.inputs.home = known.then_some(crate::autopilot::flight::HOME),
            Happening::Failsafe(on) => flight.inputs.failsafe = *on,
            Happening::Armed(armed) => flight.inputs.armed = *armed,
            Happening::Sticks(roll, pitch, yaw) => {
                flight.inputs.stick_roll = *roll;
                flight.inputs.stick_pitch = *pitch;
                flight.inputs.stick_yaw = *yaw;
            }
            Happening::EditPlan(plan) => flight.plan = (**plan).clone(),
            Happening::ClearPlan => flight.plan = FlightPlan::default(),
            Happening::ReturnHome(high) => {
                let rescue = high.then_some(rescue);
                let _ = flight.nav.return_to_home(&flight.inputs, &flight.params, rescue);
            }
            Happening::EmergencyLand => {
                let _ = flight.nav.emergency_land(&flight.inputs);
            }
            Happening::Reset => {
                if flight.inputs.armed && self.switch {
                    let _ = flight.nav.reset(&flight.inputs, &flight.params, &flight.plan);
                }
            }
            Happening::SetCurrent(index) => {
                flight.nav.set_current(*index, &flight.inputs, &flight.params, &flight.plan);
            }
            Happening::Command(command) => {
                let _ = flight.nav.command(*command, &flight.inputs, &flight.params, &flight.plan);
            }
            Happening::Teleport(north, east) => flight.plant.pos = Vector2::new(*north, *east),
            Happening::Parameter(field, share) => {
                if update > self.limits_changed_at + SETTLE {
                    self.limits = Limits::of(&flight.params);
                }
                set_share(&mut flight.params, *field, *share);
                self.limits = self.limits.widest(Limits::of(&flight.params));
                self.limits_changed_at = update;
            }
            Happening::Wind(north, east) => flight.plant.wind = Vector2::new(*north, *east),
        }
    }

    /// Ends every disturbance, so that missions can continue.
    fn heal(&mut self) {
        let inputs = &mut self.flight.inputs;
        self.switch = true;
        inputs.fix = true;
        inputs.altitude_valid = true;
        inputs.home = Some(crate::autopilot::flight::HOME);
        inputs.failsafe = false;
        inputs.armed = true;
        inputs.stick_roll = 0.0;
        inputs.stick_pitch = 0.0;
        inputs.stick_yaw = 0.0;
        if self.flight.plan.waypoints.is_empty() {
            self.flight.plan = self.first.clone();
        }
    }

    fn update(&mut self, update: u32) -> Result<(), TestCaseError> {
        if update == self.heals_at {
            self.heal();
        }
        let flight = &mut self.flight;
        flight.disarmed = !flight.inputs.armed;
        if flight.plant.alt <= 0.0 && flight.disarmed {
            // The craft is picked up and thrown again.
            flight.plant.alt = 15.0;
            flight.plant.climb = 0.0;
        }
        let mut refusal = None;
        if self.switch {
            refusal = flight.nav.engage(&flight.inputs, &flight.params, &flight.plan).err();
        }
        let stored = flight.plan.clone();
        let first_event = flight.events.len();
        flight.tick();
        prop_assert_eq!(&flight.plan, &stored);
        if flight.disarmed {
            flight.inputs.armed = false;
        }
        for (_, event) in &flight.events[first_event..] {
            if let NavEvent::State { from, to, guard, target_alt_m, reason, .. } = event {
                prop_assert_eq!(*from, self.last, "a state changed without an event");
                // A plan that has only modifiers is complete as soon as it is reset.
                let at_once = *to == NavState::Complete && *reason == TransitionReason::Reset;
                // A command holds the craft at any point of its way.
                let held = *reason == TransitionReason::HoldHere
                    && *to == NavState::Holding
                    && !matches!(from, NavState::Idle | NavState::Complete);
                prop_assert!(legal(*from, *to) || at_once || held, "{} -> {}", from, to);
                prop_assert!(guard.is_none_or(|guard| guard.holds()), "{:?} fired", guard);
                prop_assert!(target_alt_m.is_finite());
                self.last = *to;
                self.arrived_for = 0;
                self.seen.insert((*from, *to));
            }
        }
        flight.events.clear();
        let sample = flight.log.pop().unwrap();
        flight.log.clear();
        let telemetry = flight.nav.telemetry();
        if telemetry.state == NavState::Idle {
            // Arming again ends the COMPLETE of a landing without a transition.
            self.last = NavState::Idle;
        }
        prop_assert_eq!(telemetry.state, self.last);
        self.arrived_for = if telemetry.state == NavState::Arrived { self.arrived_for + 1 } else { 0 };
        prop_assert!(self.arrived_for <= 1, "ARRIVED lasts one update");
        if flight.nav.is_flying() {
            prop_assert!(usize::from(telemetry.wp) < flight.nav.active_plan().waypoints.len());
            let waits = !telemetry.guards.is_empty();
            let at_rest = matches!(telemetry.state, NavState::Arrived | NavState::Complete);
            // Before a pattern, HOLDING lasts one update and waits for nothing.
            let passing = telemetry.state == NavState::Holding;
            prop_assert!(waits || at_rest || passing, "{} waits for nothing", telemetry.state);
            let params = &flight.params;
            let out = sample.out;
            prop_assert!(out.throttle.is_finite() && (0.0..=1.0).contains(&out.throttle));
            prop_assert!(sample.demand_deg.is_finite() && out.yaw_rate_rps.is_none_or(f64::is_finite));
            let limits =
                if update > self.limits_changed_at + SETTLE { Limits::of(params) } else { self.limits };
            prop_assert!((limits.low_us..=limits.high_us).contains(&out.throttle_us), "{:?} {limits:?}", out);
            let tilt = sample.demand_deg;
            prop_assert!(tilt <= limits.tilt_deg + 1e-6, "{tilt}° {limits:?}");
        } else if let Some(refusal) = refusal {
            prop_assert_eq!(telemetry.refusal, Some(refusal), "IDLE without a reason");
        }
        Ok(())
    }
}

fn fly(
    first: &FlightPlan,
    settings: &[(usize, f64)],
    happenings: &[(u32, Happening)],
) -> Result<BTreeSet<(NavState, NavState)>, TestCaseError> {
    let mut params = Params::default();
    for (field, share) in settings {
        set_share(&mut params, *field, *share);
    }
    let mut flight = Flight::new(params, &first.waypoints, 12.0);
    flight.tick();
    flight.log.clear();
    let mut run = Run {
        flight,
        first: first.clone(),
        heals_at: 0,
        switch: true,
        last: NavState::Idle,
        arrived_for: 0,
        limits_changed_at: 0,
        limits: Limits::of(&params),
        seen: BTreeSet::new(),
    };
    let mut due = happenings.iter();
    let mut next = due.next();
    let mut wait = 0;
    for update in 0..UPDATES {
        if let Some((after, what)) = next
            && wait >= *after
        {
            run.happen(what, update);
            next = due.next();
            wait = 0;
        }
        wait += 1;
        run.update(update)?;
    }
    Ok(run.seen)
}

type Input = (FlightPlan, Vec<(usize, f64)>, Vec<(u32, Happening)>);

fn any_input() -> impl Strategy<Value = Input> {
    (
        any_plan(),
        prop::collection::vec((0..Params::FIELDS.len(), 0.0..=1.0), 0..8),
        prop::collection::vec((1..1000_u32, any_happening()), 5..40),
    )
}

#[test]
fn no_event_breaks_the_machine() {
    proptest!(|((first, settings, happenings) in any_input())| {
        fly(&first, &settings, &happenings)?;
    });
}

/// The flights are the same in each run of the test: which states random flights enter depends on chance.
#[test]
fn the_flights_of_this_test_enter_and_leave_every_state() {
    let seen = RefCell::new(BTreeSet::new());
    let result = TestRunner::deterministic().run(&any_input(), |(first, settings, happenings)| {
        seen.borrow_mut().extend(fly(&first, &settings, &happenings)?);
        Ok(())
    });
    assert!(result.is_ok(), "{result:?}");
    let seen = seen.into_inner();
    for state in NavState::iter() {
        assert!(seen.iter().any(|(_, to)| *to == state), "{state} was never entered");
        assert!(seen.iter().any(|(from, _)| *from == state), "{state} was never left");
    }
}
