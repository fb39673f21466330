use nalgebra::Vector2;
use strum::IntoEnumIterator as _;

use super::*;
use crate::autopilot::control::FlightControllers;
use crate::autopilot::master::Return;
use crate::geo::LatLon;
use crate::plan::{Altitude, Waypoint, WaypointType};
use crate::telemetry::{PlanSource, RxLossPolicy};

fn plan() -> FlightPlan {
    let far = Waypoint {
        position: LatLon::new(404_645_000, -795_182_000),
        altitude: Altitude::above_home(20.0),
        kind: WaypointType::Flyover,
        ..Waypoint::default()
    };
    FlightPlan { waypoints: [far, far].into_iter().collect() }
}

const CALM: OrderFacts = OrderFacts {
    autopilot_switch: false,
    rescue_switch: false,
    signal: true,
    failsafe_active: false,
    failsafe_mission: None,
};
/// The AUTOPILOT switch is on.
const ON: OrderFacts = OrderFacts { autopilot_switch: true, ..CALM };

/// A flight of the navigator under orders, without a craft.
struct Flight {
    orders: Orders,
    navigator: Autopilot,
    controllers: FlightControllers,
    inputs: NavInputs,
    rescue: RescueConfig,
}

impl Flight {
    fn new() -> Self {
        let rescue = RescueConfig { initial_climb_m: 10.0, ..RescueConfig::default() };
        Self {
            orders: Orders::default(),
            navigator: FirmwareProfile::Guide.into(),
            controllers: FlightControllers::default(),
            inputs: NavInputs::hovering(),
            rescue,
        }
    }

    fn update(&mut self, facts: OrderFacts) {
        let params = Params::default();
        let rescue = self.rescue;
        self.inputs.time.0 += 10_000;
        self.orders.update(&mut self.navigator, &self.inputs, &params, &rescue, &plan(), &facts);
        let home = Return { altitude_m: 30.0, speed_mps: 5.0 };
        self.navigator.update(&self.inputs, home, &params, &plan(), &mut self.controllers);
    }

    fn engaged() -> Self {
        let mut flight = Self::new();
        flight.update(OrderFacts { autopilot_switch: true, ..CALM });
        assert_eq!(flight.navigator.state(), NavState::Approaching);
        flight
    }
}

#[test]
fn switch_engages_and_releases() {
    let mut flight = Flight::engaged();
    flight.update(CALM);
    assert_eq!(flight.navigator.state(), NavState::Idle);
    assert_eq!(flight.orders.after_abort(&flight.navigator), AfterAbort::Nothing);
}

#[test]
fn lost_signal_leaves_everything_as_it_was() {
    let mut flight = Flight::engaged();
    flight.update(OrderFacts { autopilot_switch: false, signal: false, ..CALM });
    assert_eq!(flight.navigator.state(), NavState::Approaching);
}

#[test]
fn command_flies_without_the_switch_until_the_switch_goes_off() {
    let mut flight = Flight::new();
    flight.update(CALM);
    let done = flight.orders.return_to_home(&mut flight.navigator, &flight.inputs, &Params::default(), None);
    assert_eq!(done, Ok(()));
    for switch in [false, true, true] {
        flight.update(OrderFacts { autopilot_switch: switch, ..CALM });
        assert!(flight.navigator.is_flying());
        assert_eq!(flight.navigator.telemetry().source, PlanSource::Rth);
    }
    flight.update(CALM);
    assert!(!flight.navigator.is_flying());
}

#[test]
fn a_command_taken_back_leaves_the_craft_to_the_switch() {
    for (switch, after) in [(false, None), (true, Some(PlanSource::Stored))] {
        let facts = OrderFacts { autopilot_switch: switch, ..CALM };
        let mut flight = Flight::new();
        flight.update(facts);
        flight.orders.take_back(&mut flight.navigator, &flight.inputs);
        flight.update(facts);
        assert_eq!(flight.navigator.is_flying(), switch, "without a command nothing is taken back");
        let done =
            flight.orders.return_to_home(&mut flight.navigator, &flight.inputs, &Params::default(), None);
        assert_eq!((done, flight.orders.is_commanded()), (Ok(()), true));
        flight.update(facts);
        assert_eq!(flight.navigator.telemetry().source, PlanSource::Rth);
        flight.orders.take_back(&mut flight.navigator, &flight.inputs);
        flight.update(facts);
        let flown = flight.navigator.is_flying().then(|| flight.navigator.telemetry().source);
        assert_eq!((flown, flight.orders.is_commanded()), (after, false));
    }
}

#[test]
fn rescue_switch_flies_home_higher_and_lets_go() {
    let mut flight = Flight::engaged();
    let on = OrderFacts { autopilot_switch: true, rescue_switch: true, ..CALM };
    flight.update(on);
    assert_eq!(flight.navigator.telemetry().source, PlanSource::Rth);
    assert_eq!(flight.navigator.active_plan().waypoints[0].altitude, Altitude::above_home(30.0));
    flight.update(OrderFacts { rescue_switch: false, ..on });
    assert_eq!(flight.navigator.telemetry().source, PlanSource::Stored, "the mission goes on");

    let mut flight = Flight::new();
    flight.update(OrderFacts { rescue_switch: true, ..CALM });
    assert!(flight.navigator.is_flying());
    flight.update(CALM);
    assert!(!flight.navigator.is_flying(), "the pilot has it back");
}

#[test]
fn lost_fix_keeps_the_altitude_and_resumes() {
    let mut flight = Flight::engaged();
    let on = OrderFacts { autopilot_switch: true, ..CALM };
    flight.inputs.fix = false;
    flight.update(on);
    assert_eq!(flight.navigator.state(), NavState::Idle);
    assert_eq!(flight.orders.after_abort(&flight.navigator), AfterAbort::Altitude);
    assert_eq!(flight.orders.status(&flight.navigator), MissionStatus::Over);
    flight.inputs.fix = true;
    for _ in 0..199 {
        flight.update(on);
    }
    assert_eq!(flight.navigator.state(), NavState::Idle);
    for _ in 0..3 {
        flight.update(on);
    }
    assert_eq!(flight.navigator.state(), NavState::Approaching);
    assert_eq!(flight.orders.after_abort(&flight.navigator), AfterAbort::Nothing);
}

#[test]
fn an_order_that_waits_says_what_for() {
    let mut flight = Flight::new();
    flight.update(CALM);
    let done = flight.orders.return_to_home(&mut flight.navigator, &flight.inputs, &Params::default(), None);
    assert_eq!(done, Ok(()));
    flight.inputs.fix = false;
    flight.update(CALM);
    assert_eq!(flight.navigator.state(), NavState::Idle);
    let waits = Some(Refusal::Aborted(AbortReason::GpsLost));
    for (fix, updates) in [(false, 1), (true, 199)] {
        flight.inputs.fix = fix;
        for _ in 0..updates {
            flight.update(CALM);
        }
        assert_eq!(flight.navigator.telemetry().refusal, waits, "fix for {updates} updates");
    }
    for _ in 0..3 {
        flight.update(CALM);
    }
    assert_eq!(flight.navigator.telemetry().source, PlanSource::Rth);
    assert_eq!(flight.navigator.telemetry().refusal, None);
}

/// Returns a flight of the plan that lands where it is.
fn landing() -> Flight {
    let mut flight = Flight::engaged();
    assert_eq!(flight.navigator.emergency_land(&flight.inputs), Ok(()));
    flight.update(ON);
    assert_eq!(flight.navigator.state(), NavState::Landing);
    flight
}

#[test]
fn a_landing_that_loses_its_fix_goes_on_down_and_lands_when_it_is_back() {
    for (north_m, place_m) in [(0.0, 0.0), (19.0, 0.0), (25.0, 25.0)] {
        let mut flight = landing();
        flight.inputs.fix = false;
        flight.update(ON);
        assert_eq!(flight.navigator.state(), NavState::Idle);
        assert_eq!(flight.orders.after_abort(&flight.navigator), AfterAbort::Descent);
        flight.inputs.fix = true;
        flight.inputs.alt_m = 12.0;
        flight.inputs.pos_ne.x = north_m;
        for _ in 0..199 {
            flight.update(ON);
        }
        assert_eq!(flight.navigator.state(), NavState::Idle);
        for _ in 0..3 {
            flight.update(ON);
        }
        assert_eq!(flight.navigator.state(), NavState::Landing);
        assert_eq!(flight.navigator.telemetry().source, PlanSource::Emergency, "the plan is kept");
        assert_eq!(flight.navigator.active_plan().waypoints.len(), 1);
        let target = flight.navigator.telemetry().target_ne.unwrap();
        // Near the landing spiral.
        assert!((target.x - place_m).abs() < 2.5, "{north_m} m away: {target}");
        assert!(flight.navigator.telemetry().target_alt_m.unwrap() <= 12.0);
    }
}

#[test]
fn a_landing_of_the_plan_is_resumed_as_a_landing_unless_the_switch_goes_off() {
    let lost = |switch| {
        let mut flight = Flight::engaged();
        flight.inputs.fix = true;
        flight.navigator.emergency_land(&flight.inputs).unwrap();
        flight.update(ON);
        flight.inputs.fix = false;
        flight.update(ON);
        flight.update(OrderFacts { autopilot_switch: switch, ..CALM });
        flight
    };
    let kept = lost(true);
    assert_eq!(kept.orders.after_abort(&kept.navigator), AfterAbort::Descent);
    let dropped = lost(false);
    assert_eq!(dropped.orders.after_abort(&dropped.navigator), AfterAbort::Nothing);
    assert!(dropped.navigator.active_plan().waypoints.is_empty());
}

#[test]
fn descent_of_the_failsafe_takes_the_mission_off() {
    let mut flight = Flight::engaged();
    let failsafe = OrderFacts { autopilot_switch: true, signal: false, failsafe_active: true, ..CALM };
    flight.update(OrderFacts { failsafe_mission: Some(Response::Continue), ..failsafe });
    assert!(flight.navigator.is_flying());
    flight.update(failsafe);
    assert!(!flight.navigator.is_flying());
}

#[test]
fn disarming_forgets_commands() {
    let mut flight = Flight::new();
    flight.update(CALM);
    let Flight { orders, navigator, inputs, .. } = &mut flight;
    orders.return_to_home(navigator, inputs, &Params::default(), None).unwrap();
    flight.inputs.armed = false;
    flight.update(CALM);
    flight.inputs.armed = true;
    flight.update(CALM);
    assert!(!flight.navigator.is_flying());
}

#[test]
fn failsafe_response_by_policy_and_procedure() {
    use Response::{Continue, EmergencyLand, KeepLanding};
    for procedure in [Procedure::Drop, Procedure::AutoLand, Procedure::GpsRescue] {
        let plain = Response::Procedure(procedure);
        // policy: idle, approaching, landing, approaching without fix
        let rows = [
            (RxLossPolicy::Disable, [plain, plain, plain, plain]),
            (RxLossPolicy::Continue, [plain, Continue, Continue, plain]),
            (RxLossPolicy::Land, [plain, EmergencyLand, KeepLanding, plain]),
        ];
        assert_eq!(rows.len(), RxLossPolicy::iter().count());
        for (policy, expected) in rows {
            let params = Params { rx_loss_policy: policy, ..Params::default() };
            let idle = Flight::new();
            let approaching = Flight::engaged();
            let mut landing = Flight::engaged();
            landing.navigator.emergency_land(&landing.inputs).unwrap();
            let got = [
                failsafe_response(&idle.navigator, &params, procedure, true),
                failsafe_response(&approaching.navigator, &params, procedure, true),
                failsafe_response(&landing.navigator, &params, procedure, true),
                failsafe_response(&approaching.navigator, &params, procedure, false),
            ];
            assert_eq!(got, expected, "{policy} {procedure:?}");
        }
    }
}

#[test]
fn rescue_altitude_by_mode() {
    let orders = Orders { highest_m: 45.0, ..Orders::default() };
    let config = RescueConfig { initial_climb_m: 10.0, return_alt_m: 30.0, ..RescueConfig::default() };
    for (altitude, expected) in [
        (RescueAltitude::HighestOfFlight, 55.0),
        (RescueAltitude::Fixed, 30.0),
        (RescueAltitude::Present, 30.0),
    ] {
        let config = RescueConfig { altitude, ..config };
        let flight = orders.rescue_flight(&config, &NavInputs::hovering(), RescueCause::Switch);
        assert_eq!(flight.altitude_m, expected);
    }
}

#[test]
fn rescue_next_to_home_does_not_climb_first() {
    let config = RescueConfig { initial_climb_m: 10.0, min_start_dist_m: 15.0, ..RescueConfig::default() };
    let orders = Orders::default();
    for (distance_m, altitude_m) in [(0.0, 20.0), (14.9, 20.0), (15.1, 30.0)] {
        let inputs = NavInputs { pos_ne: Vector2::new(0.0, distance_m), ..NavInputs::hovering() };
        let flight = orders.rescue_flight(&config, &inputs, RescueCause::Failsafe);
        assert_eq!(flight.altitude_m, altitude_m, "{distance_m}");
    }
    let inputs = NavInputs { home: None, ..NavInputs::hovering() };
    assert_eq!(orders.rescue_flight(&config, &inputs, RescueCause::Failsafe).altitude_m, 30.0);
}

#[test]
fn sanity_checks_by_setting_and_cause() {
    for (sanity, by_switch, by_failsafe) in [
        (RescueSanity::Off, false, false),
        (RescueSanity::On, true, true),
        (RescueSanity::FailsafeOnly, false, true),
    ] {
        let config = RescueConfig { sanity, ..RescueConfig::default() };
        let watched =
            |cause| Orders::default().rescue_flight(&config, &NavInputs::hovering(), cause).is_watched;
        assert_eq!((watched(RescueCause::Switch), watched(RescueCause::Failsafe)), (by_switch, by_failsafe));
    }
}

#[test]
fn rescue_that_does_not_come_nearer_is_given_up_when_watched() {
    for (sanity, given_up) in [(RescueSanity::On, true), (RescueSanity::Off, false)] {
        let mut flight = Flight::new();
        flight.rescue.sanity = sanity;
        // A storm holds the craft 100 m from home, at the altitude of the return.
        flight.inputs.pos_ne = Vector2::new(100.0, 0.0);
        flight.inputs.alt_m = 40.0;
        let switch = OrderFacts { rescue_switch: true, ..CALM };
        flight.rescue.altitude = RescueAltitude::Fixed;
        flight.update(CALM);
        for _ in 0..3200 {
            flight.update(switch);
            while flight.navigator.take_event().is_some() {}
        }
        let state = if given_up { NavState::Landing } else { NavState::Approaching };
        assert_eq!(flight.navigator.state(), state, "{sanity:?}");
        // Requested again, it is tried again.
        flight.update(CALM);
        flight.update(switch);
        assert!(flight.navigator.is_flying());
    }
}

#[test]
fn a_rescue_goes_on_when_the_autopilot_switch_goes_off() {
    let mut flight = Flight::engaged();
    let both = OrderFacts { autopilot_switch: true, rescue_switch: true, ..CALM };
    flight.update(both);
    flight.update(OrderFacts { autopilot_switch: false, ..both });
    assert_eq!(flight.navigator.telemetry().source, PlanSource::Rth);
    assert!(flight.navigator.is_flying() && flight.orders.is_rescue_by_switch());
    flight.update(CALM);
    assert!(!flight.navigator.is_flying(), "both switches are off");
}

/// What a pilot, a ground station, the radio and the GPS do before an update.
#[derive(Debug, Clone, Copy)]
enum Deed {
    Autopilot(bool),
    Rescue(bool),
    Signal(bool),
    /// The failsafe flies this, or nothing of the navigator's (`None`).
    Failsafe(Option<Response>),
    FailsafeEnds,
    Fix(bool),
    Raised(bool),
    Armed(bool),
    ReturnHome,
    Cancel,
    /// Nothing happens for this number of updates.
    Wait(u16),
}

fn deed() -> impl proptest::strategy::Strategy<Value = Deed> {
    use proptest::prelude::*;
    let response = prop_oneof![
        Just(Response::Continue),
        Just(Response::EmergencyLand),
        Just(Response::KeepLanding),
        Just(Response::Procedure(Procedure::GpsRescue)),
    ];
    prop_oneof![
        4 => any::<bool>().prop_map(Deed::Autopilot),
        4 => any::<bool>().prop_map(Deed::Rescue),
        2 => any::<bool>().prop_map(Deed::Signal),
        1 => proptest::option::of(response).prop_map(Deed::Failsafe),
        2 => Just(Deed::FailsafeEnds),
        2 => any::<bool>().prop_map(Deed::Fix),
        1 => any::<bool>().prop_map(Deed::Raised),
        1 => prop_oneof![4 => Just(true), 1 => Just(false)].prop_map(Deed::Armed),
        1 => Just(Deed::ReturnHome),
        2 => Just(Deed::Cancel),
        4 => (1_u16..300).prop_map(Deed::Wait),
    ]
}

proptest::proptest! {
    #[test]
    fn while_a_rescue_is_asked_for_and_possible_it_is_flown(
        deeds in proptest::collection::vec(deed(), 1..60),
    ) {
        let mut flight = Flight::new();
        let mut facts = CALM;
        // Updates since the last deed that may delay a rescue.
        let mut fix_for = 0_u32;
        for deed in deeds {
            let mut updates = 1;
            match deed {
                Deed::Autopilot(on) => facts.autopilot_switch = on,
                Deed::Rescue(on) => facts.rescue_switch = on,
                Deed::Signal(on) => facts.signal = on,
                Deed::Failsafe(mission) => {
                    let params = Params::default();
                    match mission {
                        Some(Response::EmergencyLand) => {
                            flight.navigator.emergency_land(&flight.inputs).ok();
                        }
                        Some(Response::Procedure(_)) => {
                            flight.navigator.return_to_home(&flight.inputs, &params, None).ok();
                        }
                        _ => {}
                    }
                    (facts.failsafe_active, facts.failsafe_mission) = (true, mission);
                }
                Deed::FailsafeEnds => (facts.failsafe_active, facts.failsafe_mission) = (false, None),
                Deed::Fix(fix) => flight.inputs.fix = fix,
                Deed::Raised(raised) => flight.inputs.throttle_raised = raised,
                Deed::Armed(armed) => flight.inputs.armed = armed,
                Deed::ReturnHome => {
                    let Flight { orders, navigator, inputs, .. } = &mut flight;
                    orders.return_to_home(navigator, inputs, &Params::default(), None).ok();
                }
                Deed::Cancel => flight.orders.take_back(&mut flight.navigator, &flight.inputs),
                Deed::Wait(count) => updates = count,
            }
            for _ in 0..updates {
                flight.update(facts);
                fix_for = if flight.inputs.fix { fix_for + 1 } else { 0 };
            }
            let heard = facts.signal && !facts.failsafe_active;
            let possible = flight.inputs.armed && flight.inputs.throttle_raised && fix_for > 201;
            let orders = &flight.orders;
            if heard && facts.rescue_switch && possible && !orders.is_commanded() {
                proptest::prop_assert!(orders.is_rescue_by_switch() && flight.navigator.is_flying(), "{deed:?}");
                proptest::prop_assert_eq!(flight.navigator.telemetry().source, PlanSource::Rth);
            }
            if heard && !facts.rescue_switch {
                proptest::prop_assert!(!orders.is_rescue_by_switch(), "after {deed:?}");
                let wanted = facts.autopilot_switch || orders.is_commanded();
                proptest::prop_assert!(wanted || !flight.navigator.is_flying(), "{deed:?}");
            }
        }
    }
}
