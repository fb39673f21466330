//! `--world gps=…`: the statistics of each grade against the figures in `docs/physics.md`.

use betadeck_core::signals::GpsSample;
use betadeck_core::sim::{GpsGrade, Noise, Switches, WorldConfig};
use nalgebra::Vector3;

use crate::sim::world::{ideal, stand, statistics, world};

/// Returns the position errors (ENU, m) and solutions of a craft at rest, ten a second, after the acquisition.
fn at_rest(gps: GpsGrade, seconds: f64) -> Vec<(Vector3<f64>, GpsSample)> {
    let switches = Switches { gps, ..Switches::default() };
    // A seed with common errors. Over thirty seeds the mean squares of the errors are the stated ones within 1 %.
    let mut world = world(WorldConfig { seed: 9, rate_hz: 400, switches, ..WorldConfig::default() });
    stand(&mut world, 10.0, |_| {});
    let mut solutions = Vec::new();
    stand(&mut world, seconds, |world| {
        if let Some(gps) = world.sensors().gps {
            let (lat, lon) = (gps.position.lat_deg(), gps.position.lon_deg());
            let place = world.local_frame().to_enu(lat, lon, f64::from(gps.alt_amsl_cm) / 100.0);
            solutions.push((place - world.truth().pos_enu, gps));
        }
    });
    solutions
}

/// The stated errors of a grade: white and wandering position error, m, horizontally; time constant of the wandering,
/// s; white velocity error, m/s, horizontally; variance of the multipath steps per axis, m².
struct Stated {
    white: f64,
    sigma: f64,
    tau: f64,
    velocity: f64,
    multipath: f64,
}

fn errors_are_as_stated(gps: GpsGrade, stated: &Stated) {
    // 50 time constants: the deviation of the wandering part is known to 10 %.
    let solutions = at_rest(gps, 50.0 * stated.tau);
    let mut kept = [0.0; 3];
    for (axis, factor) in [(0, 1.0), (1, 1.0), (2, 1.6)] {
        let errors: Vec<f64> = solutions.iter().map(|(error, _)| error[axis] / factor).collect();
        let multipath = if axis == 2 { 0.0 } else { stated.multipath };
        let (mean, sigma) = statistics(&errors);
        let want = (stated.sigma.powi(2) + stated.white.powi(2) + multipath).sqrt();
        assert!((sigma / want - 1.0).abs() < 0.2, "{gps} axis {axis}: σ {sigma} instead of {want}");
        assert!(mean.abs() < 0.4 * want, "{gps} axis {axis}: mean {mean}");
        // The part of the wandering error that is left after one time constant.
        let lag = (stated.tau * 10.0) as usize;
        let product = errors.iter().zip(&errors[lag..]).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>();
        kept[axis] = product / (errors.len() - lag) as f64 / stated.sigma.powi(2);
        let velocities: Vec<f64> = solutions.iter().map(|(_, fix)| fix.vel_enu[axis] / factor).collect();
        let (_, sigma) = statistics(&velocities);
        assert!((sigma / stated.velocity - 1.0).abs() < 0.03, "{gps} axis {axis}: velocity σ {sigma}");
        if multipath == 0.0 {
            let steps: Vec<f64> = errors.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let wander = stated.sigma.powi(2) * (1.0 - (-0.1 / stated.tau).exp());
            // Plus steps of 1e-7° and of a centimetre.
            let grid = 0.01_f64.powi(2) / 12.0;
            let want = (2.0 * (stated.white.powi(2) + wander + grid)).sqrt();
            let (_, sigma) = statistics(&steps);
            assert!((sigma / want - 1.0).abs() < 0.06, "{gps} axis {axis}: step {sigma} instead of {want}");
        }
    }
    let mean = kept.iter().sum::<f64>() / 3.0;
    assert!((mean - (-1.0_f64).exp()).abs() < 0.15, "{gps}: {kept:?} of the variance kept after τ");
}

#[test]
fn rtk_is_good_to_centimetres() {
    let stated = Stated { white: 0.01, sigma: 0.02, tau: 20.0, velocity: 0.05, multipath: 0.0 };
    errors_are_as_stated(GpsGrade::Rtk, &stated);
}

#[test]
fn a_consumer_receiver_wanders_by_a_metre() {
    let stated = Stated { white: 0.1, sigma: 1.0, tau: 120.0, velocity: 0.05, multipath: 0.0 };
    errors_are_as_stated(GpsGrade::Consumer, &stated);
}

#[test]
fn among_buildings_the_position_wanders_by_metres_and_jumps() {
    // A step is there for a fifth of the time; the mean square of its size is 28 m².
    let stated = Stated { white: 0.3, sigma: 3.0, tau: 30.0, velocity: 0.3, multipath: 2.8 };
    errors_are_as_stated(GpsGrade::Urban, &stated);
    let solutions = at_rest(GpsGrade::Urban, 600.0);
    let jumps = solutions.windows(2).filter(|pair| (pair[1].0 - pair[0].0).xy().norm() > 2.5).count();
    assert!((10..40).contains(&jumps), "{jumps} jumps in ten minutes");
}

#[test]
fn every_grade_reports_what_it_is_worth() {
    for (gps, sats, accuracy, speed) in [
        (GpsGrade::Rtk, 12..=12, 0.03, 0.05),
        (GpsGrade::Open, 12..=12, 1.0, 0.05),
        (GpsGrade::Consumer, 10..=10, 2.5, 0.05),
        (GpsGrade::Urban, 8..=10, 6.0, 0.3),
    ] {
        let solutions = at_rest(gps, 120.0);
        assert!(solutions.iter().all(|(_, fix)| sats.contains(&fix.sats)), "{gps}");
        for count in sats {
            assert!(solutions.iter().any(|(_, fix)| fix.sats == count), "{gps}: never {count}");
        }
        let last = solutions.last().expect("solutions").1;
        assert_eq!((last.horizontal_accuracy_m, last.speed_accuracy_mps), (accuracy, speed));
        assert_eq!(last.vertical_accuracy_m, accuracy * 1.6);
    }
}

#[test]
fn exact_sensors_know_no_grade() {
    let solution = |gps| {
        let switches = Switches { gps, ..Switches::default() };
        let mut world = world(WorldConfig { switches, noise: Noise::None, ..ideal() });
        let mut last = None;
        stand(&mut world, 4.0, |world| last = world.sensors().gps.or(last));
        last.map(|fix| (fix.fix, fix.sats, fix.position, fix.vel_enu))
    };
    assert_eq!(solution(GpsGrade::Urban), solution(GpsGrade::Open));
}
