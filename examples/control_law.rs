//! Flies a circle by a control law of its own in place of the autopilot. The law reads the estimate of the flight
//! controller and moves the sticks in ANGLE, as a companion computer does. No plan is stored and AUTOPILOT stays off.
//!
//! ```sh
//! cargo run --release -p betadeck-core --example control_law         # one flight
//! cargo run --release -p betadeck-core --example control_law -- 5    # five flights, each in another wind
//! ```
//!
//! The exit code is 1 if the true path leaves the circle by more than 3 m, or if the craft does not land.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use std::process::ExitCode;

use betadeck_core::firmware::estimate::Estimate;
use betadeck_core::flight::FlightSetup;
use betadeck_core::nalgebra::{Rotation2, Vector2};
use betadeck_core::pilot::FRAME_US;
use betadeck_core::signals::RcFrame;
use betadeck_core::sim::Wind;
use betadeck_core::telemetry::Mode;
use betadeck_core::telemetry::switch::Switch;
use betadeck_core::vehicle::{Vehicle, VehicleCommand};

/// The circle about home: radius and altitude, m, and speed, m/s.
const RADIUS_M: f64 = 20.0;
const ALTITUDE_M: f64 = 12.0;
const SPEED_MPS: f64 = 5.0;
/// The times after arming at which the craft flies to the circle, is on it, returns, and descends, s.
const DEPART_S: f64 = 10.0;
const ON_CIRCLE_S: f64 = 25.0;
const RETURN_S: f64 = 80.0;
const DESCEND_S: f64 = 95.0;
/// The greatest tilt, degrees, and the interval of the law, s.
const MAX_TILT_DEG: f64 = 30.0;
const STEP_S: f64 = FRAME_US as f64 * 1e-6;
const LOW_US: u16 = 1000;

/// The control law with its memory.
#[derive(Default)]
struct Law {
    /// The integral of the position error, m·s north and east, which learns the wind.
    position_sum: Vector2<f64>,
    /// The throttle beyond the hover throttle that is learned, µs.
    throttle_sum: f64,
}

impl Law {
    /// Returns the sticks for a place (north and east of home, m), a velocity there, m/s, an acceleration, m/s², and an
    /// altitude above home, m. `tilt_us` is the stick for a tilt of a degree, `hover_us` the throttle to begin with.
    fn sticks(
        &mut self,
        estimate: &Estimate,
        [place, velocity, acceleration]: [Vector2<f64>; 3],
        alt_m: f64,
        tilt_us: f64,
        hover_us: f64,
    ) -> [u16; 4] {
        let error = place - estimate.pos_ne;
        self.position_sum = (self.position_sum + error * STEP_S).map(|sum| sum.clamp(-20.0, 20.0));
        let wanted =
            acceleration + error * 0.8 + (velocity - estimate.vel_ne) * 1.6 + self.position_sum * 0.15;
        // The tilt of a hovering craft accelerates it by g·tan(tilt).
        let body = Rotation2::new(-estimate.heading_rad) * wanted;
        let tilt = |mps2: f64| (mps2 / 9.81).atan().to_degrees().clamp(-MAX_TILT_DEG, MAX_TILT_DEG);
        let climb_mps = ((alt_m - estimate.alt_m) * 0.8).clamp(-1.0, 2.0);
        let climb_error = climb_mps - estimate.climb_mps;
        self.throttle_sum = (self.throttle_sum + climb_error * 40.0 * STEP_S).clamp(-300.0, 300.0);
        let throttle =
            (hover_us - 1000.0 + self.throttle_sum + climb_error * 80.0) / estimate.cos_tilt.max(0.7);
        let stick = |value: f64| value.round().clamp(1000.0, 2000.0) as u16;
        [
            stick(1500.0 + tilt_us * tilt(body.y)),
            stick(1500.0 + tilt_us * tilt(body.x)),
            stick(1000.0 + throttle),
            1500,
        ]
    }
}

/// Returns place, velocity and acceleration on the way, north and east, at a time after arming, s.
fn way(time_s: f64) -> [Vector2<f64>; 3] {
    let rate = SPEED_MPS / RADIUS_M;
    let angle = rate * (time_s - DEPART_S);
    let (east, north) = angle.sin_cos();
    if (DEPART_S..RETURN_S).contains(&time_s) {
        let out = Vector2::new(north, east);
        let along = Vector2::new(-east, north);
        [out * RADIUS_M, along * SPEED_MPS, out * (-SPEED_MPS * rate)]
    } else {
        [Vector2::zeros(); 3]
    }
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let flights: u32 = std::env::args().nth(1).map_or(Ok(1), |count| count.parse())?;
    let mut all_good = true;
    for number in 0..flights {
        let wind = Wind { speed_mps: f64::from(number % 6), from_deg: f64::from(60 * number % 360) };
        let mut setup = FlightSetup::default();
        setup.world.seed = u64::from(number) + 1;
        setup.world.wind = wind;
        let (mut vehicle, _) = setup.build()?;
        let (worst_m, landed) = fly(&mut vehicle)?;
        println!(
            "wind {wind}: the true path left the circle by at most {worst_m:.2} m; {}",
            if landed { "landed and disarmed" } else { "did not land" }
        );
        all_good &= worst_m < 3.0 && landed;
    }
    Ok(ExitCode::from(u8::from(!all_good)))
}

/// Flies the circle. Returns the greatest distance of the truth from it, m, and whether the craft landed whole.
fn fly(vehicle: &mut Vehicle) -> Result<(f64, bool), Box<dyn Error>> {
    let ranges = vehicle.controller().mode_ranges();
    let [arm, angle] = [Mode::Arm, Mode::Angle].map(|mode| Switch::of(mode, &ranges));
    let (arm, angle) = (arm.ok_or("no switch arms")?, angle.ok_or("no switch levels")?);
    let mut law = Law::default();
    let mut frame = RcFrame::SAFE;
    let (mut armed_at, mut worst_m) = (None, 0.0_f64);
    while vehicle.time().as_secs_f64() < 200.0 {
        let time = vehicle.time();
        if time.0.is_multiple_of(FRAME_US) {
            let firmware = vehicle.embedded().ok_or("the firmware is embedded")?;
            let estimate = firmware.estimate();
            let flown_s = armed_at.map(|at| time.seconds_since(at));
            match flown_s {
                None if firmware.is_armed() => {
                    armed_at = Some(time);
                    frame.channels[angle.channel] = angle.on_us;
                }
                None if estimate.gps.fix && firmware.arming_flags().is_empty() => {
                    frame.channels[arm.channel] = arm.on_us;
                }
                None => {}
                Some(flown_s) => {
                    let tilt_us = (f64::from(firmware.forward_stick_us()) - 1500.0) / 15.0;
                    let hover_us = f64::from(firmware.hover_stick_us());
                    // The target stays above the ground on the way down until the legs carry the craft.
                    let alt_m = if flown_s < DESCEND_S { ALTITUDE_M } else { estimate.alt_m - 1.0 };
                    let sticks = law.sticks(estimate, way(flown_s), alt_m, tilt_us, hover_us);
                    frame.channels[..4].copy_from_slice(&sticks);
                    if flown_s > DESCEND_S && estimate.alt_m < 0.3 && estimate.climb_mps.abs() < 0.1 {
                        frame.channels[2] = LOW_US;
                        frame.channels[arm.channel] = arm.off_us;
                    }
                }
            }
            vehicle.apply(&VehicleCommand::Sticks(frame));
            if flown_s.is_some_and(|flown_s| (ON_CIRCLE_S..RETURN_S).contains(&flown_s)) {
                let truth = vehicle.truth().ok_or("the world is embedded")?;
                let off_m = (truth.pos_enu.xy().norm() - RADIUS_M).hypot(truth.pos_enu.z - ALTITUDE_M);
                worst_m = worst_m.max(off_m);
            }
        }
        vehicle.tick();
        vehicle.drain_events(|_| ());
        if armed_at.is_some() && !vehicle.controller().is_armed() {
            break;
        }
    }
    let landed = !vehicle.controller().is_armed() && !vehicle.crashed();
    Ok((worst_m, landed && armed_at.is_some_and(|at| vehicle.time().seconds_since(at) > DESCEND_S)))
}
