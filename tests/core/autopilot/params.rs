//! Every parameter of the autopilot: it has the promised effect, a larger value has more of the effect, and a
//! change in flight causes no step.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

use crate::autopilot::flight::{DT, Flight, guide, inputs, set, vertical, waypoint, worst};
use betadeck_core::autopilot::Params;
use betadeck_core::autopilot::control::{
    AltitudeController, AltitudeTarget, FlightControllers, THROTTLE_SLEW_US_PER_S, TILT_SLEW_RPS,
    YAW_SLEW_DPS2, throttle_share,
};
use betadeck_core::autopilot::guidance::{L1Limits, l1};
use betadeck_core::autopilot::land_detector::{GroundFacts, TouchdownFacts, TouchdownGuards};
use betadeck_core::autopilot::rx_loss::{RxLossFacts, decide};
use betadeck_core::plan::WaypointType::{Flyover, Hold, Land};
use betadeck_core::plan::{HoldPattern, Seconds, Waypoint};
use betadeck_core::telemetry::{L1Mode, NavState, PlanSource};
use nalgebra::Vector2;

/// Parameters that are stored for other firmware versions and have no effect here.
const UNUSED: [&str; 9] = [
    "ap_position_f",
    "ap_stop_threshold",
    "ap_nav_corner_speed",
    "ap_nav_corner_delta_v",
    "ap_nav_decel",
    "ap_nav_accel",
    "ap_nav_carrot_lead_time",
    "ap_nav_carrot_lead_max",
    "ap_nav_preturn_dist",
];

fn with(name: &str, value: i64) -> Params {
    let mut params = guide();
    set(&mut params, name, value);
    params
}

fn hold(north: f64, alt: f64) -> Waypoint {
    waypoint(Hold, north, 0.0, alt, 5.0)
}

fn pattern(pattern: HoldPattern) -> Waypoint {
    Waypoint { pattern, ..waypoint(Hold, 0.0, 0.0, 20.0, 5.0) }
}

fn fly(params: Params, waypoints: &[Waypoint], seconds: f64) -> Flight {
    let mut flight = Flight::new(params, waypoints, 20.0).launch();
    flight.run(seconds);
    flight
}

/// Flies a hold over home. A wind of 6 m/s hits the craft after 5 s.
fn hit_by_wind(params: Params, seconds: f64) -> Flight {
    let mut flight = fly(params, &[hold(0.0, 20.0)], 5.0);
    flight.plant.wind = Vector2::new(6.0, 0.0);
    flight.run(seconds);
    flight
}

/// Flies a hold that loses 40 µs of thrust after 10 s.
fn loaded(params: Params, seconds: f64) -> Flight {
    let mut flight = fly(params, &[hold(0.0, 20.0)], 10.0);
    flight.plant.hover_us += 40.0;
    flight.run(seconds);
    flight
}

fn direct(name: &str, value: i64) -> Params {
    Params { velocity_control_enable: false, ..with(name, value) }
}

/// Flies a hold under the direct law. The craft is moved 1.9 m away from its point.
fn beside(params: Params) -> Flight {
    let mut flight = fly(params, &[hold(0.0, 20.0)], 2.0);
    flight.plant.pos.x = 1.9;
    flight.run(6.0);
    flight
}

fn speeds(flight: &Flight, from: f64) -> f64 {
    worst(flight.since(from).map(|s| s.vel.norm()))
}

fn leg(speed: f64) -> [Waypoint; 2] {
    [waypoint(Flyover, 300.0, 0.0, 20.0, speed), waypoint(Flyover, 450.0, 0.0, 20.0, speed)]
}

/// Flies a leg north with the craft moved 8 m to the east, and returns the remaining offset in metres after
/// some seconds.
fn rejoin(params: Params, seconds: f64) -> f64 {
    let mut flight = fly(params, &leg(5.0), 10.0);
    flight.plant.pos.y = 8.0;
    flight.run(seconds);
    flight.plant.pos.y
}

fn landing(params: Params) -> Flight {
    let mut flight = Flight::new(params, &[waypoint(Land, 0.0, 0.0, 12.0, 0.0)], 12.0).launch();
    assert!(flight.until(150.0, |f| f.disarmed));
    flight
}

fn contact(flight: &Flight) -> f64 {
    flight.log.iter().find(|s| s.alt <= 0.0).unwrap().t
}

/// The name of a parameter, three rising values, `true` if the effect must rise with them, and the function
/// that measures the effect as a number.
type Effect = (&'static str, [i64; 3], bool, fn(&str, i64) -> f64);

/// Returns the measured effect of every parameter that has one.
fn effects() -> Vec<Effect> {
    vec![
        ("ap_landing_altitude_m", [2, 4, 8], true, |name, value| {
            // The height at which the spiral closes.
            let flight = landing(with(name, value));
            flight.log.iter().find(|s| s.t > 5.0 && s.target.norm() < 1e-6).unwrap().alt
        }),
        ("ap_hover_throttle", [1300, 1500, 1700], true, |name, value| {
            // The controllers have not seen this craft hover, and it climbs at engagement.
            let mut flight = Flight::new(with(name, value), &[hold(0.0, 20.0)], 20.0);
            flight.hover(5.0);
            flight.controllers = FlightControllers::default();
            flight.plant.climb = 1.0;
            flight.engage();
            flight.run(1.5);
            flight.plant.alt
        }),
        ("ap_throttle_min", [1100, 1250, 1400], true, |name, value| {
            // A landed craft gets less and less throttle.
            let params = Params { landing_detection_time: 50, ..with(name, value) };
            let flight = fly(params, &[waypoint(Land, 0.0, 0.0, 20.0, 5.0)], 70.0);
            -worst(flight.log.iter().map(|s| -s.out.throttle_us).filter(|throttle| *throttle < -1000.0))
        }),
        ("ap_throttle_max", [1510, 1540, 1570], true, |name, value| {
            let flight = fly(with(name, value), &[hold(0.0, 90.0)], 6.0);
            worst(flight.log.iter().map(|s| s.throttle_us))
        }),
        ("ap_altitude_p", [15, 50, 100], true, |name, value| {
            -worst(loaded(with(name, value), 10.0).log.iter().map(|s| 20.0 - s.alt))
        }),
        ("ap_altitude_i", [5, 30, 80], true, |name, value| loaded(with(name, value), 8.0).plant.alt),
        ("ap_altitude_d", [10, 20, 60], true, |name, value| {
            -worst(loaded(with(name, value), 10.0).log.iter().map(|s| -s.climb))
        }),
        ("ap_altitude_f", [0, 10, 40], true, |name, value| {
            let flight = fly(with(name, value), &[hold(0.0, 60.0)], 3.0);
            flight.plant.alt
        }),
        ("ap_position_p", [15, 30, 60], true, |name, value| {
            // The rest of the way to a hold.
            let flight = fly(with(name, value), &[hold(8.0, 20.0)], 4.0);
            -(flight.log.last().unwrap().target - flight.plant.pos).norm()
        }),
        ("ap_position_i", [0, 40, 120], false, |name, value| {
            let mut flight = fly(direct(name, value), &[hold(0.0, 20.0)], 5.0);
            flight.plant.wind = Vector2::new(6.0, 0.0);
            flight.run(12.0);
            flight.since(5.0).map(|s| s.pos.x).sum::<f64>() * DT
        }),
        ("ap_position_d", [15, 30, 60], false, |name, value| speeds(&beside(direct(name, value)), 2.0)),
        ("ap_position_a", [0, 20, 80], false, |name, value| {
            let flight = hit_by_wind(direct(name, value), 1.5);
            flight.plant.vel.x
        }),
        ("ap_position_cutoff", [3, 10, 50], false, |name, value| {
            // A quicker filter lets the acceleration feedback resist earlier.
            let mut params = direct(name, value);
            params.position_a = 100;
            hit_by_wind(params, 0.6).plant.vel.x
        }),
        ("ap_max_angle", [15, 25, 45], true, |name, value| {
            let flight = fly(
                with(name, value),
                &[waypoint(Flyover, 40.0, 0.0, 20.0, 5.0), waypoint(Flyover, 0.0, 0.0, 20.0, 5.0)],
                14.0,
            );
            worst(flight.log.iter().map(|s| s.demand_deg))
        }),
        ("ap_velocity_control_enable", [0, 1, 1], true, |name, value| {
            // The speed law returns to the point faster.
            speeds(&beside(with(name, value)), 2.0)
        }),
        ("ap_velocity_p", [25, 50, 100], false, |name, value| {
            worst(hit_by_wind(with(name, value), 6.0).log.iter().map(|s| s.pos.x))
        }),
        ("ap_velocity_i", [0, 20, 80], false, |name, value| {
            hit_by_wind(with(name, value), 6.0).since(5.0).map(|s| s.pos.x).sum::<f64>()
        }),
        ("ap_velocity_d", [0, 20, 80], false, |name, value| hit_by_wind(with(name, value), 0.6).plant.vel.x),
        ("ap_velocity_drag_coeff", [0, 200, 800], true, |name, value| {
            fly(with(name, value), &leg(8.0), 4.0).plant.vel.x
        }),
        ("ap_max_velocity", [300, 600, 900], true, |name, value| {
            fly(with(name, value), &leg(0.0), 15.0).plant.vel.x
        }),
        ("ap_waypoint_arrival_radius", [150, 500, 1500], true, |name, value| {
            let mut flight = fly(with(name, value), &[waypoint(Flyover, 60.0, 0.0, 20.0, 5.0)], 0.0);
            assert!(flight.until(60.0, |f| f.nav.state() == NavState::Arrived));
            60.0 - flight.log.last().unwrap().pos.x
        }),
        ("ap_waypoint_hold_radius", [60, 200, 900], true, |name, value| {
            let mut flight = fly(with(name, value), &[hold(60.0, 20.0)], 0.0);
            assert!(flight.until(60.0, |f| f.nav.state() == NavState::Arrived));
            60.0 - flight.log.last().unwrap().pos.x
        }),
        ("ap_stick_deadband", [0, 100, 300], false, |name, value| {
            let mut flight = fly(with(name, value), &[hold(0.0, 20.0)], 1.0);
            flight.inputs.stick_roll = 200.0;
            flight.run(0.5);
            flight.plant.tilt.y
        }),
        ("ap_yaw_mode", [0, 1, 3], false, |name, value| {
            // The craft starts east slowly: BEARING has turned the nose, VELOCITY not yet, FIXED never turns
            // it.
            let mut flight =
                Flight::new(with(name, value), &[waypoint(Hold, 0.0, 60.0, 20.0, 5.0)], 20.0).launch();
            flight.run(6.0);
            let turned = flight.plant.heading.to_degrees();
            // Ordered by the angle turned: BEARING, VELOCITY, FIXED.
            match value {
                0 => turned.min(80.0),
                _ => turned / 2.0,
            }
        }),
        ("ap_yaw_p", [20, 50, 150], true, |name, value| {
            let mut flight =
                Flight::new(with(name, value), &[waypoint(Hold, 0.0, 80.0, 20.0, 5.0)], 20.0).launch();
            flight.run(5.0);
            flight.plant.heading
        }),
        ("ap_yaw_d", [0, 50, 200], false, |name, value| {
            let mut flight =
                Flight::new(with(name, value), &[waypoint(Hold, 0.0, 80.0, 20.0, 5.0)], 20.0).launch();
            flight.run(5.0);
            flight.plant.heading
        }),
        ("ap_max_yaw_rate", [10, 20, 40], true, |name, value| {
            let params = Params { yaw_p: 200, ..with(name, value) };
            let flight = fly(params, &[waypoint(Hold, 0.0, 80.0, 20.0, 5.0)], 6.0);
            worst(flight.log.iter().map(|s| s.out.yaw_rate_rps.unwrap()))
        }),
        ("ap_min_forward_velocity", [100, 300, 450], true, |name, value| {
            let flight = fly(with(name, value), &[waypoint(Hold, 0.0, 80.0, 20.0, 5.0)], 8.0);
            flight.log.iter().find(|s| s.out.yaw_rate_rps.unwrap() > 0.0).unwrap().t
        }),
        ("ap_velocity_buildup_max_pitch", [2, 8, 16], true, |name, value| {
            fly(with(name, value), &leg(10.0), 3.0).plant.vel.x
        }),
        ("ap_max_turn_rate", [2, 4, 8], true, |name, value| {
            let flight = fly(with(name, value), &[pattern(HoldPattern::Orbit)], 30.0);
            flight.nav.telemetry().pattern_angle_rad.unwrap()
        }),
        ("ap_hold_orbit_radius", [500, 1000, 1500], true, |name, value| {
            fly(with(name, value), &[pattern(HoldPattern::Orbit)], 60.0).plant.pos.norm()
        }),
        ("ap_hold_figure8_width", [1000, 2000, 3000], true, |name, value| {
            let params = Params { max_turn_rate: 10, ..with(name, value) };
            let flight = fly(params, &[pattern(HoldPattern::Figure8)], 80.0);
            worst(flight.log.iter().map(|s| s.pos.y))
        }),
        ("ap_landing_descent_rate", [30, 50, 100], false, |name, value| contact(&landing(with(name, value)))),
        ("ap_landing_detection_time", [5, 10, 50], true, |name, value| {
            let flight = landing(with(name, value));
            flight.t() - contact(&flight)
        }),
        ("ap_landing_spiral_enable", [0, 1, 1], true, |name, value| {
            worst(landing(with(name, value)).log.iter().map(|s| s.pos.norm()))
        }),
        ("ap_landing_spiral_radius", [100, 200, 300], true, |name, value| {
            worst(landing(with(name, value)).log.iter().map(|s| s.pos.norm()))
        }),
        ("ap_landing_spiral_rate", [5, 10, 20], true, |name, value| {
            let flight = landing(with(name, value));
            speeds(&flight, 8.0)
        }),
        ("ap_landing_velocity_threshold", [10, 50, 200], true, |name, value| {
            // The highest ground speed that still counts as landed.
            (0..300)
                .map(f64::from)
                .filter(|speed| {
                    let touchdown =
                        TouchdownFacts::new(&with(name, value), 1500.0, 0.0, speed / 100.0, 1100.0, 0.0);
                    TouchdownGuards::new(&touchdown, &GroundFacts::CERTAIN).all_hold()
                })
                .fold(0.0, f64::max)
        }),
        ("ap_landing_throttle_threshold", [20, 100, 300], true, |name, value| {
            let flight = landing(with(name, value));
            flight.t() - contact(&flight)
        }),
        ("ap_l1_enable", [0, 1, 1], false, |name, value| rejoin(with(name, value), 8.0)),
        ("ap_l1_period", [20, 60, 100], true, |name, value| {
            let params = Params { l1_min_lookahead: 100, ..with(name, value) };
            rejoin(params, 4.0)
        }),
        ("ap_l1_min_lookahead", [500, 1500, 4000], true, |name, value| rejoin(with(name, value), 5.0)),
        ("ap_l1_max_lookahead", [1000, 2000, 4000], true, |name, value| {
            let params = Params { l1_min_lookahead: 4000, ..with(name, value) };
            rejoin(params, 5.0)
        }),
        ("ap_l1_max_cross_track_error", [1000, 3000, 9000], true, |name, value| {
            let limits = L1Limits::from_params(&with(name, value));
            (0..200)
                .map(f64::from)
                .filter(|east| {
                    let position = Vector2::new(50.0, *east);
                    let end = Vector2::new(400.0, 0.0);
                    !l1(Vector2::zeros(), end, position, Vector2::new(5.0, 0.0), &limits).reanchor
                })
                .fold(0.0, f64::max)
        }),
        ("ap_l1_turn_rate", [8, 20, 60], false, |name, value| {
            // A wider arc takes longer to reach the new leg.
            let corner = [waypoint(Flyover, 40.0, 0.0, 20.0, 5.0), waypoint(Flyover, 40.0, 200.0, 20.0, 5.0)];
            let flight = fly(with(name, value), &corner, 26.0);
            worst(flight.log.iter().map(|s| s.pos.x))
        }),
        ("ap_min_nav_altitude_m", [0, 5, 12], true, |name, value| {
            let mut flight = Flight::new(with(name, value), &leg(5.0), 1.5);
            flight.hover(5.0);
            flight.engage();
            flight.until(30.0, |f| f.plant.pos.x > 0.5);
            flight.plant.alt
        }),
        ("ap_rx_loss_policy", [0, 1, 2], true, |name, value| {
            let facts = RxLossFacts {
                policy: with(name, value).rx_loss_policy,
                engaged: true,
                state: NavState::Holding,
                fix: true,
            };
            let rank = ["PROCEDURE", "NONE", "EMERGENCY_LAND"];
            rank.iter().position(|word| *word == decide(&facts).action.to_string()).unwrap() as f64
        }),
        ("ap_max_distance_from_home", [80, 90, 95], true, |name, value| {
            let mut flight = fly(with(name, value), &[hold(60.0, 20.0)], 20.0);
            flight.inputs.stick_pitch = 500.0;
            flight.until(60.0, |f| f.nav.telemetry().source != PlanSource::Stored);
            flight.plant.pos.x
        }),
        ("ap_geofence_action", [0, 1, 1], true, |name, value| {
            let mut params = with(name, value);
            params.max_distance_from_home = 80;
            let mut flight = fly(params, &[hold(60.0, 20.0)], 20.0);
            flight.plant.pos.x = 82.0;
            flight.tick();
            flight.nav.active_plan().waypoints.len() as f64
        }),
        ("alt_hold_climb_rate", [10, 30, 60], true, |name, value| {
            let flight = fly(with(name, value), &[hold(0.0, 80.0)], 8.0);
            worst(flight.log.iter().map(|s| s.climb))
        }),
        ("min_check", [1000, 1050, 1200], false, |name, value| throttle_share(1500.0, &with(name, value))),
    ]
}

#[test]
fn more_of_it_has_more_of_the_effect() {
    let mut tested: Vec<&str> = UNUSED.to_vec();
    // The parameter has its effect after a mission, in the holds of the firmware, and is tested there.
    tested.push("ap_throttle_deadband");
    // It chooses another navigator; the scenarios of master test it.
    tested.push("ap_profile");
    let mut wrong = Vec::new();
    for (name, values, rises, effect) in effects() {
        tested.push(name);
        let got = values.map(|value| effect(name, value));
        println!("{name}: {values:?} -> {got:.4?}");
        let sign = if rises { 1.0 } else { -1.0 };
        let (first, second) = (sign * (got[1] - got[0]), sign * (got[2] - got[1]));
        let repeated = values[1] == values[2];
        let visible = 1e-3 * got[0].abs().max(0.1);
        if first <= visible || (second <= visible && !repeated) {
            wrong.push(format!("{name}: {values:?} -> {got:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    let mut all: Vec<&str> = Params::FIELDS.iter().map(|field| field.name).collect();
    all.sort_unstable();
    tested.sort_unstable();
    assert_eq!(tested, all, "every parameter is tested");
}

#[test]
fn unused_parameters_change_nothing() {
    let mission = [waypoint(Flyover, 30.0, 0.0, 20.0, 5.0), waypoint(Land, 30.0, 20.0, 20.0, 5.0)];
    let usual = fly(guide(), &mission, 70.0);
    for name in UNUSED {
        let field = Params::field(name).unwrap();
        let flight = fly(with(name, field.max), &mission, 70.0);
        assert_eq!(flight.plant.pos, usual.plant.pos, "{name}");
        assert_eq!(flight.t().to_bits(), usual.t().to_bits());
    }
}

#[test]
fn a_change_in_flight_steps_nothing() {
    let mut orbit = pattern(HoldPattern::Orbit);
    orbit.duration = Seconds::new(10.0);
    let mission = [waypoint(Flyover, 40.0, 0.0, 24.0, 5.0), orbit, waypoint(Land, 20.0, 20.0, 20.0, 5.0)];
    for field in Params::FIELDS {
        let mut flight = Flight::new(guide(), &mission, 20.0).wind(0.0, 4.0, 0.0).launch();
        for round in 0..24 {
            let value = if round % 2 == 0 { field.max } else { field.min };
            (field.set)(&mut flight.params, value);
            flight.run(2.0);
            if flight.disarmed {
                break;
            }
        }
        let yaw = |rate: Option<f64>| rate.unwrap_or_default().to_degrees();
        let flown = flight.log.iter().take_while(|s| s.t < flight.t() - 0.05);
        let flown: Vec<_> = flown.filter(|s| s.state != NavState::Idle).collect();
        assert!(flown.len() > 100, "{} ended the flight", field.name);
        for pair in flown.windows(2) {
            let (a, b) = (&pair[0].out, &pair[1].out);
            // The demand turns with the nose as well.
            let turn = pair[1].demand_deg.to_radians() * (pair[1].heading - pair[0].heading).sin().abs();
            let tilt = (b.roll_rad - a.roll_rad).hypot(b.pitch_down_rad - a.pitch_down_rad) - turn;
            assert!(tilt <= TILT_SLEW_RPS * DT + 1e-3, "{}: lean by {tilt} at {}", field.name, pair[1].t);
            let throttle = (b.throttle_us - a.throttle_us).abs();
            assert!(throttle <= THROTTLE_SLEW_US_PER_S * DT + 1e-6, "{}: {throttle} µs", field.name);
            let yaw = (yaw(b.yaw_rate_rps) - yaw(a.yaw_rate_rps)).abs();
            assert!(yaw <= YAW_SLEW_DPS2 * DT + 1e-6, "{}: {yaw}°/s", field.name);
        }
    }
}

#[test]
fn altitude_hold_climbs_at_the_rate_of_the_stick() {
    let params = guide();
    let mut plant = crate::autopilot::flight::Plant::new(20.0);
    let mut altitude = AltitudeController::default();
    let mut at = inputs();
    altitude.engage(&vertical(&at), &params);
    for tick in 0..1500 {
        at.alt_m = plant.alt;
        at.climb_mps = plant.climb;
        let target = if tick < 1000 { AltitudeTarget::Rate(2.0) } else { AltitudeTarget::Rate(0.0) };
        at.throttle_us = altitude.update(&vertical(&at), target, &params, DT);
        plant.step(0.0, 0.0, 0.0, throttle_share(at.throttle_us, &params));
    }
    assert!((38.0..=41.0).contains(&plant.alt), "{}", plant.alt);
    assert!(plant.climb.abs() < 0.3, "{}", plant.climb);
    assert_eq!(L1Mode::default(), L1Mode::Off);
}
