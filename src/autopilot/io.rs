//! The inputs and demands of the navigator: the interface between the firmware and the autopilot.
//!
//! Local frame: north, east (m) relative to `origin`, which is fixed while armed; altitude in metres above home (the
//! arming point). Angles in radians, heading clockwise from north.

use nalgebra::Vector2;

use crate::geo::{LatLon, offset_to_latlon};
use crate::signals::SimTime;

/// Demands for the attitude and throttle loops.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NavOutput {
    /// Roll demand, rad, right positive.
    pub roll_rad: f64,
    /// Pitch demand, rad, nose down positive (accelerates forward).
    pub pitch_down_rad: f64,
    /// Yaw rate demand, rad/s, clockwise positive; `None` = the pilot's stick.
    pub yaw_rate_rps: Option<f64>,
    /// Throttle into the mixer, 0…1.
    pub throttle: f64,
    /// The same throttle as RC µs.
    pub throttle_us: f64,
}

/// The facts for one update.
#[derive(Debug, Clone, PartialEq)]
pub struct NavInputs {
    /// Time of this update.
    pub time: SimTime,
    /// Seconds since the previous update (nominally 0.01).
    pub dt: f64,
    /// `true` if the craft is armed.
    pub armed: bool,
    /// `true` if a 3-D GPS fix is present.
    pub fix: bool,
    /// `true` if the altitude estimate is valid.
    pub altitude_valid: bool,
    /// `true` if the heading is known.
    pub heading_valid: bool,
    /// `true` if the throttle has been above 25 % since arming.
    pub throttle_raised: bool,
    /// `true` while stage 2 of the receiver failsafe is active.
    pub failsafe: bool,
    /// `true` if the battery is at its warning voltage or below.
    pub battery_low: bool,
    /// Home (GPS position at arming), if known.
    pub home: Option<LatLon>,
    /// Origin of the local frame of this flight.
    pub origin: LatLon,
    /// Estimated position, north and east of `origin`, m.
    pub pos_ne: Vector2<f64>,
    /// Estimated ground velocity, north and east, m/s.
    pub vel_ne: Vector2<f64>,
    /// Estimated altitude above home, m.
    pub alt_m: f64,
    /// Altitude above the site by the newest sample of the barometer alone, m, if known.
    pub pressure_alt_m: Option<f64>,
    /// Estimated climb rate, m/s, up positive.
    pub climb_mps: f64,
    /// Estimated heading, rad clockwise from north.
    pub heading_rad: f64,
    /// Estimated yaw rate, rad/s, clockwise positive.
    pub yaw_rate_rps: f64,
    /// Estimated roll, rad, right wing down positive.
    pub roll_rad: f64,
    /// Estimated pitch, rad, nose down positive.
    pub pitch_down_rad: f64,
    /// Cosine of the tilt from level.
    pub cos_tilt: f64,
    /// Earth-frame acceleration without gravity, north and east, m/s².
    pub accel_ne: Vector2<f64>,
    /// Throttle that the mixer used in the previous cycle, as RC µs (1000…2000).
    pub throttle_us: f64,
    /// Hover throttle learned in this flight, as RC µs, if known.
    pub hover_us: Option<f64>,
    /// Roll stick, RC command units ±500, right positive; 0 while the link is lost.
    pub stick_roll: f64,
    /// Pitch stick, RC command units ±500, forward positive; 0 while the link is lost.
    pub stick_pitch: f64,
    /// Yaw stick, RC command units ±500, right positive; 0 while the link is lost.
    pub stick_yaw: f64,
}

impl NavInputs {
    /// Returns the inputs of a disarmed craft with nothing known yet.
    pub fn unknown() -> Self {
        Self {
            time: SimTime::ZERO,
            dt: 0.01,
            armed: false,
            fix: false,
            altitude_valid: false,
            heading_valid: false,
            throttle_raised: false,
            failsafe: false,
            battery_low: false,
            home: None,
            origin: LatLon::default(),
            pos_ne: Vector2::zeros(),
            vel_ne: Vector2::zeros(),
            alt_m: 0.0,
            pressure_alt_m: None,
            climb_mps: 0.0,
            heading_rad: 0.0,
            yaw_rate_rps: 0.0,
            roll_rad: 0.0,
            pitch_down_rad: 0.0,
            cos_tilt: 1.0,
            accel_ne: Vector2::zeros(),
            throttle_us: 1000.0,
            hover_us: None,
            stick_roll: 0.0,
            stick_pitch: 0.0,
            stick_yaw: 0.0,
        }
    }

    /// Returns the position of the craft.
    pub(super) fn here(&self) -> LatLon {
        offset_to_latlon(self.origin, self.pos_ne)
    }

    /// Returns the inputs of an armed craft that hovers 20 m above home.
    #[cfg(test)]
    pub(crate) fn hovering() -> Self {
        let home = LatLon::new(404_635_000, -795_182_000);
        Self {
            time: SimTime(60_000_000),
            armed: true,
            fix: true,
            altitude_valid: true,
            heading_valid: true,
            throttle_raised: true,
            home: Some(home),
            origin: home,
            alt_m: 20.0,
            throttle_us: 1500.0,
            ..Self::unknown()
        }
    }
}
