//! The feed of an executable, in simulated wall time, against the rules of the public executable (L-9).

use betadeck::geo::LatLon;
use betadeck::link::conventions::{Dialect, MotorOrder, Stamps};
use betadeck::link::proto::fdm::pressure_pa;
use betadeck::link::proto::sitl_feed::{FeedConfig, FeedState, SitlFeed};
use betadeck::link::proto::{rc, servo};
use betadeck::signals::{GpsSample, SensorFrame, SimTime};
use nalgebra::{UnitQuaternion, Vector3};

use super::stand_in::receiver::{BOOT_US, Receiver, Taken};

const MS: u64 = 1000;
const SECOND: u64 = 1000 * MS;
const HOME: (f64, f64, f64) = (40.4635, -79.5182, 300.0);

/// A small random number generator, so that every run has the same delays.
struct Delays(u64);

impl Delays {
    /// Returns the delay of the sender's next wake-up, µs: usually short, sometimes long.
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let number = self.0 >> 33;
        if number.is_multiple_of(400) { number % (30 * MS) } else { number % 900 }
    }
}

fn feed(stamps: Stamps) -> SitlFeed {
    SitlFeed::new(FeedConfig {
        dialect: Dialect::SitlGz,
        stamps,
        motor_order: MotorOrder::Native,
        home: HOME,
    })
}

/// Returns the sensor frame of a craft that drifts north at 1 m/s from the beginning.
fn drifting(now_us: u64) -> SensorFrame {
    let north_deg = now_us as f64 * 1e-6 / 111_000.0;
    let gps = GpsSample {
        fix: true,
        position: LatLon::from_degrees(HOME.0 + north_deg, HOME.1),
        vel_enu: Vector3::new(0.0, 1.0, 0.0),
        ..GpsSample::default()
    };
    SensorFrame {
        time: SimTime(now_us),
        gps: Some(gps),
        pressure_pa: Some(pressure_pa(300.0)),
        truth_attitude: Some(UnitQuaternion::identity()),
        ..SensorFrame::default()
    }
}

/// Feeds the stand-in for `seconds` after its boot packet, with a sender that wakes late. Returns the stand-in and the
/// end time, µs.
fn feed_for(seconds: u64, stamps: Stamps) -> (Receiver, u64) {
    let (mut feed, mut receiver, mut delays) = (feed(stamps), Receiver::new(), Delays(7));
    let answer = servo::encode([1000.0; 4]);
    let (end, mut wakes, mut turn) = (BOOT_US + seconds * SECOND, BOOT_US, BOOT_US);
    while wakes.min(turn) < end {
        if wakes <= turn {
            let wall = wakes;
            // The simulation's time is that of its newest step.
            feed.sense(&drifting((wall - BOOT_US) / MS * MS));
            if receiver.receive(&feed.packet(wall).to_bytes(), wall) == Taken::Resync {
                assert!(feed.answered(&answer, wall).is_some());
            }
            // The next step of the grid, and the delay of the wake-up for it.
            wakes = wall / MS * MS + MS + delays.next();
        } else {
            if receiver.mixer_sends() {
                assert!(feed.answered(&answer, turn).is_some());
            }
            turn += MS;
        }
    }
    assert_eq!(feed.state(end), FeedState::Answering);
    (receiver, end)
}

#[test]
fn a_minute_of_packets_keeps_the_executables_clock_and_nearly_all_are_answered() {
    let (mut receiver, end) = feed_for(60, Stamps::Constant);
    let off_us = receiver.clock_us(end) - end as f64;
    assert!(off_us.abs() <= 50_000.0, "its clock is off by {off_us} µs");
    let seen = receiver.seen;
    assert_eq!((seen.other_stamps, seen.before_boot, seen.moved_before_answer), (0, 0, 0), "{seen:?}");
    assert!(seen.worst_leap_us <= 20_000.0, "{seen:?}");
    assert!(seen.answered as f64 >= 0.95 * seen.packets as f64, "{seen:?}");
    assert!(seen.packets > 50_000, "{seen:?}");
    let gps = receiver.sensors().unwrap().gps.unwrap();
    // A minute at 1 m/s, and nothing sideways: the mirror's centre is home.
    let north_m = (f64::from(gps.lat) * 1e-7 - HOME.0) * 111_000.0;
    assert!(
        (north_m - 60.0).abs() < 1.0 && (gps.lon - (HOME.1 * 1e7) as i32).abs() <= 1,
        "{north_m} {gps:?}"
    );
}

#[test]
fn stamps_of_simulated_time_are_no_clock_for_it() {
    // The reason for the constant stamp: the same feed with advancing stamps puts the executable's clock off by
    // seconds.
    let (mut receiver, end) = feed_for(60, Stamps::Sim);
    assert!(receiver.seen.other_stamps > 50_000);
    assert!((receiver.clock_us(end) - end as f64).abs() > SECOND as f64);
}

#[test]
fn a_hundred_thousand_datagrams_of_noise_turn_no_motor_beyond_its_range() {
    let (mut feed, mut delays) = (feed(Stamps::Constant), Delays(3));
    for k in 0..100_000_u64 {
        let size = delays.next() as usize % 1500;
        let noise: Vec<u8> = (0..size).map(|at| (delays.0 >> (at % 57)) as u8 ^ at as u8).collect();
        match feed.answered(&noise, k) {
            Some(motors) => {
                assert!(size >= 16 && motors.0.iter().all(|motor| (0.0..=1.0).contains(motor)), "{motors:?}");
            }
            None => assert!(
                size < 16
                    || noise[..16]
                        .chunks(4)
                        .any(|value| { !f32::from_le_bytes(value.try_into().unwrap()).is_finite() })
            ),
        }
        assert_eq!(rc::decode(&noise).is_some(), size >= 40);
    }
}
