//! The flight bounds of the autopilot on a point-mass craft: with default gains and with the guide's, with
//! slow and quick attitude, in calm air and in wind.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

use crate::autopilot::flight::{Flight, guide, rms, waypoint, worst};
use betadeck_core::autopilot::Params;
use betadeck_core::plan::{HoldPattern, Waypoint, WaypointType};
use betadeck_core::telemetry::NavState;
use nalgebra::Vector2;

use WaypointType::{Flyby, Flyover, Hold, Land};

fn tunes() -> [(&'static str, Params); 2] {
    [("default", Params { max_angle: 25, ..Params::default() }), ("guide", guide())]
}

const BANDWIDTHS: [f64; 3] = [3.0, 5.0, 8.0];

/// Calls `fly` for every tune with every bandwidth.
fn each(mut fly: impl FnMut(&str, Params, f64)) {
    for (name, params) in tunes() {
        for bandwidth in BANDWIDTHS {
            fly(&format!("{name} gains, lean {bandwidth} rad/s"), params, bandwidth);
        }
    }
}

fn line() -> [Waypoint; 2] {
    [waypoint(Flyover, 10.0, 0.0, 20.0, 5.0), waypoint(Flyover, 210.0, 0.0, 20.0, 5.0)]
}

#[test]
fn straight_leg_in_wind() {
    each(|name, params, bandwidth| {
        for (wind, bound, mean_bound) in [(0.0, 0.5, 0.5), (5.0, 2.0, 0.8), (8.0, 3.0, 1.2)] {
            let mut flight = Flight::new(params, &line(), 20.0).wind(0.0, wind, 0.0);
            flight.plant.tilt_bandwidth = bandwidth;
            let mut flight = flight.launch();
            assert!(flight.until(60.0, |f| f.nav.state() == NavState::Complete), "{name}: not complete");
            let late = flight.log.iter().filter(|s| s.wp == 1 && s.pos.x > 40.0 && s.pos.x < 205.0);
            let worst_xte = worst(late.clone().map(|s| s.pos.y.abs()));
            let count = late.clone().count() as f64;
            let mean = late.clone().map(|s| s.pos.y.abs()).sum::<f64>() / count;
            let steady: Vec<f64> =
                late.filter(|s| s.t > 10.0 && s.pos.x < 195.0).map(|s| s.vel.norm()).collect();
            let (low, high) = (steady.iter().copied().fold(9.0, f64::min), worst(steady.iter().copied()));
            println!("{name} wind {wind}: xte {worst_xte:.2} mean {mean:.2} speed {low:.2}..{high:.2}");
            assert!(worst_xte <= bound && mean <= mean_bound, "{name}, wind {wind}: {worst_xte} {mean}");
            assert!(low >= 4.75 && high <= 5.25, "{name}, wind {wind}: speed {low}..{high}");
            assert!(worst(flight.log.iter().map(|s| s.vel.norm())) <= 5.75);
        }
    });
}

#[test]
fn cruise_along_the_wind() {
    each(|name, params, bandwidth| {
        for wind in [-5.0, 5.0] {
            let far = [waypoint(Flyover, 300.0, 0.0, 20.0, 5.0), waypoint(Flyover, 400.0, 0.0, 20.0, 5.0)];
            let mut flight = Flight::new(params, &far, 20.0).wind(wind, 0.0, 0.0);
            flight.plant.tilt_bandwidth = bandwidth;
            let mut flight = flight.launch();
            flight.run(40.0);
            let speeds = || flight.since(10.0).map(|s| s.vel.norm());
            let (low, high) = (speeds().fold(9.0, f64::min), worst(speeds()));
            println!("{name} tail {wind}: {low:.2}..{high:.2}");
            assert!(low > 4.75 && high < 5.25, "{name}, tail wind {wind}: {low}..{high}");
            assert!(worst(flight.log.iter().map(|s| s.vel.norm())) < 5.75);
        }
    });
}

#[test]
fn start_from_rest() {
    each(|name, params, bandwidth| {
        let far = [waypoint(Flyover, 200.0, 0.0, 20.0, 0.0), waypoint(Flyover, 400.0, 0.0, 20.0, 0.0)];
        let mut flight = Flight::new(params, &far, 20.0);
        flight.plant.tilt_bandwidth = bandwidth;
        let mut flight = flight.launch();
        flight.run(3.0);
        let accel = flight.plant.vel.norm() / 3.0;
        println!("{name}: {accel:.2} m/s²");
        assert!((1.0..=1.6).contains(&accel), "{name}: {accel}");
    });
}

#[test]
fn stop_at_a_hold_from_10_mps() {
    each(|name, params, bandwidth| {
        let hold = [waypoint(Hold, 120.0, 0.0, 20.0, 10.0)];
        let mut flight = Flight::new(params, &hold, 20.0);
        flight.plant.tilt_bandwidth = bandwidth;
        let mut flight = flight.launch();
        assert!(flight.until(60.0, |f| f.nav.state() == NavState::Holding));
        let arrived = flight.t();
        flight.run(30.0);
        let place = flight.place(0);
        let farthest = worst(flight.since(arrived).map(|s| (s.pos - place).norm()));
        let later = worst(flight.since(arrived + 10.0).map(|s| (s.pos - place).norm()));
        println!("{name}: arrived {arrived:.1} s, farthest {farthest:.2}, after 10 s {later:.2}");
        assert!(farthest <= 3.0 && later <= 1.0, "{name}: {farthest} {later}");
    });
}

#[test]
fn hold_in_wind() {
    each(|name, params, bandwidth| {
        for (wind, gust, bound, alt_bound) in
            [(0.0, 0.0, 0.3, 0.3), (5.0, 0.8, 0.8, 0.3), (8.0, 1.5, 1.3, 1.0)]
        {
            let diagonal = wind / 2_f64.sqrt();
            let hold = [waypoint(Hold, 0.0, 0.0, 20.0, 0.0)];
            let mut flight = Flight::new(params, &hold, 20.0).wind(diagonal, diagonal, gust);
            flight.plant.tilt_bandwidth = bandwidth;
            let mut flight = flight.launch();
            flight.run(60.0);
            let place = flight.place(0);
            let off = rms(flight.log.iter().map(|s| (s.pos - place).norm()));
            let alt = worst(flight.since(12.0).map(|s| (s.alt - 20.0).abs()));
            println!("{name} wind {wind}: rms {off:.2}, alt {alt:.2}");
            assert!(off <= bound, "{name}, wind {wind}: rms {off}");
            assert!(alt <= alt_bound, "{name}, wind {wind}: altitude {alt}");
        }
    });
}

#[test]
fn orbit() {
    each(|name, params, bandwidth| {
        for (wind, ring) in [(0.0, 0.6), (5.0, 1.0)] {
            let mut hold = waypoint(Hold, 60.0, 0.0, 20.0, 5.0);
            hold.pattern = HoldPattern::Orbit;
            let mut flight = Flight::new(params, &[hold], 20.0).wind(0.0, wind, 0.0);
            flight.plant.tilt_bandwidth = bandwidth;
            let mut flight = flight.launch();
            assert!(flight.until(60.0, |f| f.nav.state() == NavState::Orbiting));
            let began = flight.t();
            flight.run(180.0);
            let place = flight.place(0);
            let (mut off, mut lag, mut fast) = (0.0_f64, 0.0_f64, 0.0_f64);
            for s in flight.since(began + 20.0) {
                let from_centre = s.pos - place;
                off = off.max((from_centre.norm() - 10.0).abs());
                let angle = from_centre.y.atan2(from_centre.x).to_degrees();
                let target = (s.target - place).y.atan2((s.target - place).x).to_degrees();
                lag = lag.max(((target - angle + 180.0).rem_euclid(360.0) - 180.0).abs());
                fast = fast.max((s.vel.norm() - 0.524).abs());
            }
            println!("{name} wind {wind}: radius ±{off:.2}, lag {lag:.1}°, speed ±{fast:.3}");
            assert!(off <= ring && lag <= 10.0, "{name}, wind {wind}: {off} {lag}");
            assert!(fast <= 0.05, "{name}, wind {wind}: speed {fast}");
        }
    });
}

#[test]
fn a_figure_8_goes_round_both_of_its_circles() {
    let mut hold = waypoint(Hold, 60.0, 0.0, 20.0, 5.0);
    hold.pattern = HoldPattern::Figure8;
    let mut flight = Flight::new(guide(), &[hold], 20.0).launch();
    let width = f64::from(flight.params.hold_figure8_width) / 100.0;
    assert!(flight.until(60.0, |f| f.nav.state() == NavState::Figure8));
    let began = flight.t();
    flight.run(300.0);
    let place = flight.place(0);
    let (most, least) = flight
        .since(began)
        .map(|s| s.pos.y - place.y)
        .fold((f64::NEG_INFINITY, f64::INFINITY), |(most, least), east| (most.max(east), least.min(east)));
    assert!(most > 0.8 * width && least < -0.8 * width, "{least} to {most} m of {width} m");
}

fn corner(kind: WaypointType) -> [Waypoint; 2] {
    [waypoint(kind, 60.0, 0.0, 20.0, 5.0), waypoint(Flyover, 60.0, 120.0, 20.0, 5.0)]
}

#[test]
fn flyover_corner() {
    each(|name, params, bandwidth| {
        let mut flight = Flight::new(params, &corner(Flyover), 20.0);
        flight.plant.tilt_bandwidth = bandwidth;
        let mut flight = flight.launch();
        assert!(flight.until(90.0, |f| f.nav.state() == NavState::Complete));
        let place = Vector2::new(60.0, 0.0);
        let nearest = -worst(flight.log.iter().map(|s| -(s.pos - place).norm()));
        let overshoot = worst(flight.log.iter().map(|s| s.pos.x - 60.0));
        let back = worst(flight.log.iter().filter(|s| s.pos.y > 40.0).map(|s| (s.pos.x - 60.0).abs()));
        println!("{name}: nearest {nearest:.2}, overshoot {overshoot:.2}, after 40 m {back:.2}");
        assert!(nearest <= 1.0 && (2.0..=6.0).contains(&overshoot), "{name}: {nearest} {overshoot}");
        assert!(back <= 1.5, "{name}: {back}");
    });
}

#[test]
fn flyby_corner() {
    each(|name, params, bandwidth| {
        let mut flight = Flight::new(params, &corner(Flyby), 20.0);
        flight.plant.tilt_bandwidth = bandwidth;
        let mut flight = flight.launch();
        assert!(flight.until(90.0, |f| f.nav.state() == NavState::Complete));
        let place = Vector2::new(60.0, 0.0);
        let at = flight.entered(NavState::Arrived, 0).unwrap();
        let switch = flight.since(at).next().unwrap();
        let before = (switch.pos - place).norm();
        let nearest = -worst(flight.log.iter().map(|s| -(s.pos - place).norm()));
        let overshoot = worst(flight.log.iter().map(|s| s.pos.x - 60.0));
        let back = worst(flight.log.iter().filter(|s| s.pos.y > 30.0).map(|s| (s.pos.x - 60.0).abs()));
        println!(
            "{name}: switch {before:.2}, nearest {nearest:.2}, overshoot {overshoot:.2}, later {back:.2}"
        );
        assert!((4.9..=6.1).contains(&before), "{name}: {before}");
        assert!((1.0..=3.5).contains(&nearest) && overshoot <= 2.5, "{name}: {nearest} {overshoot}");
        assert!(back <= 1.5, "{name}: {back}");
    });
}

#[test]
fn climb_from_10_to_50_m() {
    each(|name, params, bandwidth| {
        let hold = [waypoint(Hold, 0.0, 0.0, 50.0, 0.0)];
        let mut flight = Flight::new(params, &hold, 10.0);
        flight.plant.tilt_bandwidth = bandwidth;
        let mut flight = flight.launch();
        flight.run(60.0);
        let overshoot = worst(flight.log.iter().map(|s| s.alt - 50.0));
        let late = worst(flight.since(20.0).map(|s| (s.alt - 50.0).abs()));
        println!("{name}: overshoot {overshoot:.2}, after 20 s ±{late:.2}");
        let bound = if name.starts_with("guide") { 1.5 } else { 3.5 };
        assert!(overshoot <= bound && late <= 1.0, "{name}: {overshoot} {late}");
    });
}

#[test]
fn altitude_on_a_level_square() {
    each(|name, params, bandwidth| {
        let square = [
            waypoint(Flyover, 60.0, 0.0, 20.0, 5.0),
            waypoint(Flyover, 60.0, 60.0, 20.0, 5.0),
            waypoint(Flyby, 0.0, 60.0, 20.0, 5.0),
            waypoint(Flyover, 0.0, 0.0, 20.0, 5.0),
        ];
        let mut flight = Flight::new(params, &square, 20.0);
        flight.plant.tilt_bandwidth = bandwidth;
        let mut flight = flight.launch();
        assert!(flight.until(120.0, |f| f.nav.state() == NavState::Complete));
        let (first, later) = if name.starts_with("guide") { (1.6, 0.7) } else { (3.0, 2.2) };
        let early_off = worst(flight.log.iter().map(|s| (s.alt - 20.0).abs()));
        let late_off = worst(flight.since(12.0).map(|s| (s.alt - 20.0).abs()));
        println!("{name}: ±{early_off:.2}, then ±{late_off:.2}");
        assert!(early_off <= first && late_off <= later, "{name}: {early_off} {late_off}");
    });
}

#[test]
fn landing() {
    each(|name, params, bandwidth| {
        for (wind, place_bound) in [(0.0, 1.0), (3.0, 1.5)] {
            for hover_error in [-50.0, 0.0, 50.0] {
                let land = [waypoint(Land, 0.0, 0.0, 20.0, 0.0)];
                let mut params = params;
                params.hover_throttle = (1500.0 + hover_error) as u16;
                let mut flight = Flight::new(params, &land, 20.0).wind(wind, 0.0, 0.0);
                flight.plant.tilt_bandwidth = bandwidth;
                let mut flight = flight.launch();
                assert!(flight.until(90.0, |f| f.disarmed), "{name}: no touchdown");
                let landing = flight.entered(NavState::Landing, 0).unwrap();
                let contact = flight.log.iter().find(|s| s.alt <= 0.0).unwrap();
                let rate = {
                    let low = flight.log.iter().find(|s| s.alt <= 4.0).unwrap();
                    16.0 / (low.t - landing)
                };
                let delay = flight.t() - contact.t;
                let off = contact.pos.norm();
                let impact = flight.plant.impact_mps.unwrap();
                println!(
                    "{name} wind {wind} hover {hover_error:+}: rate {rate:.3}, contact {:.1} s, off {off:.2}, \
                     impact {impact:.2}, disarm +{delay:.1} s",
                    contact.t - landing
                );
                assert!((rate - 0.5).abs() <= 0.08 && impact <= 0.8, "{name}: {rate} {impact}");
                assert!((38.0..=43.0).contains(&(contact.t - landing)));
                assert!(off <= place_bound, "{name}: {off}");
                assert!((1.0..=10.0).contains(&delay), "{name}: {delay}");
                for s in flight.log.iter().filter(|s| (4.0..=31.0).contains(&(s.t - landing))) {
                    assert!((s.alt - (20.0 - 0.5 * (s.t - landing))).abs() <= 1.0);
                    assert!(s.climb <= 0.1);
                }
            }
        }
    });
}
