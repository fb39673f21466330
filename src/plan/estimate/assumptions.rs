//! The facts about the craft that estimates and reviews use.

use super::ReturnFlight;
use crate::geo::GRAVITY;
use crate::math;
use crate::plan::Waypoint;
use crate::plan::setpoint::{AltitudeSetpoint, SetpointLimits};

/// The default altitude above home above which a waypoint is reported, m.
pub const MAX_ALTITUDE_M: f64 = 120.0;
/// The slowest leg speed of a waypoint, m/s.
const SLOWEST_MPS: f64 = 1.0;
/// The slowest leg speed with a DELAY, m/s.
const SLOWEST_DELAYED_MPS: f64 = 0.1;
/// The altitude error at which a HOLD begins, m. A larger hold radius replaces it.
const HOLD_ALTITUDE_M: f64 = 2.0;
/// The altitude that a craft measures may be nearer to the HOLD than the craft is, by up to this, m.
const MEASURED_M: f64 = 1.0;
/// The time for which a HOLD waits for an altitude that cannot be reached, s.
const HELD_OFF_S: f64 = 10.0;
/// The largest turn radius, m.
const WIDEST_TURN_M: f64 = 1000.0;

/// The facts about the craft for estimates and reviews, most of them from its settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assumptions {
    /// `ap_max_velocity`, m/s.
    pub max_velocity_mps: f64,
    /// `alt_hold_climb_rate`, m/s.
    pub climb_mps: f64,
    /// `ap_landing_descent_rate`, m/s.
    pub landing_mps: f64,
    /// `ap_max_distance_from_home`, m; `None` = no fence.
    pub fence_m: Option<f64>,
    /// The source of the fence, for messages that name it.
    pub fence_from: SettingSource,
    /// The altitude above home above which a waypoint is reported, m; `None` = no limit.
    pub max_alt_m: Option<f64>,
    /// Height above home at which the mission begins, m.
    pub start_alt_m: f64,
    /// The hover time of a full battery, s; `None` = unknown.
    pub endurance_s: Option<f64>,
    /// The throttle condition of a touchdown.
    pub touchdown_throttle: TouchdownThrottle,
    /// `ap_landing_altitude_m`.
    pub landing_alt_m: f64,
    /// `ap_min_nav_altitude_m`: below it the craft first climbs on the spot.
    pub min_nav_alt_m: f64,
    /// `ap_waypoint_arrival_radius`, m.
    pub arrival_radius_m: f64,
    /// `ap_waypoint_hold_radius`, m.
    pub hold_radius_m: f64,
    /// `ap_hold_orbit_radius`, m.
    pub orbit_radius_m: f64,
    /// `ap_max_turn_rate`, degrees/s.
    pub turn_rate_dps: f64,
    /// `ap_max_angle`, degrees.
    pub max_angle_deg: f64,
    /// `ap_velocity_buildup_max_pitch`, degrees.
    pub buildup_deg: f64,
    /// `ap_position_p`.
    pub position_p: f64,
    /// The altitude of a GPS rescue.
    pub return_flight: ReturnFlight,
}

/// The source of a setting when the craft and the plan differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SettingSource {
    /// Messages do not have to name the source.
    #[default]
    Unsaid,
    /// The craft's own value, which nothing changes before the flight.
    Craft,
    /// The value that the plan sets during its upload.
    Plan,
}

/// The throttle condition of a touchdown: below `ap_hover_throttle` less `ap_landing_throttle_threshold`; µs.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TouchdownThrottle {
    /// `ap_hover_throttle`; 0 = captured in flight.
    pub hover_us: f64,
    /// `ap_landing_throttle_threshold`.
    pub threshold_us: f64,
    /// `ap_throttle_min`: the least throttle that the autopilot commands.
    pub min_us: f64,
}

impl TouchdownThrottle {
    /// Returns `true` if the autopilot never commands a throttle that low.
    pub fn is_never_met(&self) -> bool {
        self.hover_us > 0.0 && self.hover_us - self.threshold_us <= self.min_us
    }
}

impl Default for TouchdownThrottle {
    fn default() -> Self {
        Self { hover_us: 1275.0, threshold_us: 100.0, min_us: 1100.0 }
    }
}

impl Default for Assumptions {
    /// Returns the defaults of the firmware, after the climb of the scripted pilot.
    fn default() -> Self {
        Self {
            max_velocity_mps: 5.0,
            climb_mps: 5.0,
            landing_mps: 0.5,
            fence_m: None,
            fence_from: SettingSource::Unsaid,
            max_alt_m: Some(MAX_ALTITUDE_M),
            start_alt_m: 10.0,
            endurance_s: None,
            touchdown_throttle: TouchdownThrottle::default(),
            landing_alt_m: 4.0,
            min_nav_alt_m: 5.0,
            arrival_radius_m: 5.0,
            hold_radius_m: 2.0,
            orbit_radius_m: 10.0,
            turn_rate_dps: 3.0,
            max_angle_deg: 50.0,
            buildup_deg: 8.0,
            position_p: 30.0,
            return_flight: ReturnFlight::default(),
        }
    }
}

impl Assumptions {
    /// The settings that change the estimate. Those of GPS rescue change the assumptions, too.
    pub const SETTINGS: [&str; 16] = [
        "ap_max_velocity",
        "alt_hold_climb_rate",
        "ap_landing_descent_rate",
        "ap_max_distance_from_home",
        "ap_hover_throttle",
        "ap_landing_throttle_threshold",
        "ap_throttle_min",
        "ap_landing_altitude_m",
        "ap_min_nav_altitude_m",
        "ap_waypoint_arrival_radius",
        "ap_waypoint_hold_radius",
        "ap_hold_orbit_radius",
        "ap_max_turn_rate",
        "ap_max_angle",
        "ap_velocity_buildup_max_pitch",
        "ap_position_p",
    ];

    /// Returns the defaults, changed by the lines `name = value` of a plan file.
    pub fn from_settings(lines: &[String]) -> Self {
        Self::default().with_settings(lines)
    }

    /// Changes the assumptions by the lines `name = value` of a plan file.
    pub fn with_settings<L: AsRef<str>>(self, lines: &[L]) -> Self {
        let mut assumptions = self;
        for (name, value) in lines.iter().filter_map(|line| line.as_ref().split_once('=')) {
            assumptions.return_flight.set(&name.trim().to_ascii_lowercase(), value.trim());
            let Ok(value) = value.trim().parse::<u16>() else { continue };
            let value = f64::from(value);
            match name.trim().to_ascii_lowercase().as_str() {
                "ap_max_velocity" => assumptions.max_velocity_mps = value / 100.0,
                "alt_hold_climb_rate" if value > 0.0 => assumptions.climb_mps = value / 10.0,
                "alt_hold_climb_rate" => assumptions.climb_mps = 5.0,
                "ap_landing_descent_rate" => assumptions.landing_mps = value / 100.0,
                "ap_max_distance_from_home" => assumptions.fence_m = (value > 0.0).then_some(value),
                "ap_hover_throttle" => assumptions.touchdown_throttle.hover_us = value,
                "ap_landing_throttle_threshold" => assumptions.touchdown_throttle.threshold_us = value,
                "ap_throttle_min" => assumptions.touchdown_throttle.min_us = value,
                "ap_landing_altitude_m" => assumptions.landing_alt_m = value,
                "ap_min_nav_altitude_m" => assumptions.min_nav_alt_m = value,
                "ap_waypoint_arrival_radius" => assumptions.arrival_radius_m = value / 100.0,
                "ap_waypoint_hold_radius" => assumptions.hold_radius_m = value / 100.0,
                "ap_hold_orbit_radius" => assumptions.orbit_radius_m = value / 100.0,
                "ap_max_turn_rate" => assumptions.turn_rate_dps = value,
                "ap_max_angle" => assumptions.max_angle_deg = value,
                "ap_velocity_buildup_max_pitch" => assumptions.buildup_deg = value,
                "ap_position_p" => assumptions.position_p = value,
                _ => {}
            }
        }
        assumptions
    }

    /// Returns the speed of the leg to a waypoint, m/s.
    pub(in crate::plan) fn leg_speed_mps(&self, waypoint: &Waypoint) -> f64 {
        match waypoint.speed.own_mps() {
            None => self.max_velocity_mps,
            Some(mps) => mps.clamp(SLOWEST_MPS, self.max_velocity_mps.max(SLOWEST_MPS)),
        }
    }

    /// Returns the distance before a FLYBY at which the craft begins its turn at this speed, m.
    pub(in crate::plan) fn turn_radius_m(&self, speed_mps: f64) -> f64 {
        let tangent = math::tan(self.max_angle_deg.to_radians());
        if !(0.1..).contains(&tangent) {
            return WIDEST_TURN_M;
        }
        (math::powi(speed_mps.max(SLOWEST_MPS), 2) / (GRAVITY * tangent)).clamp(0.5, WIDEST_TURN_M)
    }

    /// Returns the rate of an ORBIT at this waypoint, radians/s: the setting, limited by the speed of the leg and by half
    /// of the maximum tilt.
    pub(in crate::plan) fn orbit_rate_rps(&self, waypoint: &Waypoint) -> f64 {
        let tilt = self.max_angle_deg.clamp(5.0, 80.0).to_radians();
        let radius_m = self.orbit_radius_m.max(0.1);
        self.turn_rate_dps
            .to_radians()
            .min(self.leg_speed_mps(waypoint) / radius_m)
            .min((0.5 * GRAVITY * math::tan(tilt) / radius_m).sqrt())
    }

    /// Returns the slowest speed of a leg of this length after a DELAY, m/s.
    pub(in crate::plan) fn delayed_mps(&self, length_m: f64, delay_s: f64) -> f64 {
        (length_m / delay_s).max(SLOWEST_DELAYED_MPS)
    }

    /// Returns the limits of the altitude setpoint.
    pub fn setpoint_limits(&self) -> SetpointLimits {
        SetpointLimits {
            climb_mps: self.climb_mps,
            landing_mps: self.landing_mps,
            landing_alt_m: self.landing_alt_m,
        }
    }

    /// Moves the setpoint until a HOLD at this altitude begins, and returns the time that this takes, s.
    pub(in crate::plan) fn wait_for_hold(&self, setpoint: &mut AltitudeSetpoint, alt_m: f64) -> f64 {
        let within_m = self.hold_radius_m.max(HOLD_ALTITUDE_M) + MEASURED_M;
        let waited = setpoint.reach(alt_m, &self.setpoint_limits(), within_m);
        if waited.is_finite() { waited } else { HELD_OFF_S }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_and_orbits_follow_the_settings() {
        let assumptions = Assumptions::from_settings(&["ap_max_angle = 25".to_owned()]);
        assert!((assumptions.turn_radius_m(5.0) - 5.47).abs() < 0.01, "{}", assumptions.turn_radius_m(5.0));
        assert!((assumptions.turn_radius_m(0.0) - 0.5).abs() < 1e-9);
        let level = Assumptions { max_angle_deg: 0.0, ..assumptions };
        assert!((level.turn_radius_m(1.0) - WIDEST_TURN_M).abs() < 1e-9);
        let rate = assumptions.orbit_rate_rps(&Waypoint::default()).to_degrees();
        assert!((rate - 3.0).abs() < 1e-9, "{rate}");
        let fast = Assumptions { turn_rate_dps: 100.0, ..assumptions };
        assert!((fast.orbit_rate_rps(&Waypoint::default()) - 0.478).abs() < 0.001);
    }

    #[test]
    fn settings_change_the_assumptions() {
        let lines = [
            "ap_max_velocity = 700",
            "AP_LANDING_DESCENT_RATE = 100",
            "ap_max_distance_from_home = 300",
            "x",
        ];
        let assumptions = Assumptions::from_settings(&lines.map(str::to_owned));
        assert!(
            (assumptions.max_velocity_mps - 7.0).abs() < 1e-9 && (assumptions.landing_mps - 1.0).abs() < 1e-9
        );
        assert_eq!(assumptions.fence_m, Some(300.0));
        for name in Assumptions::SETTINGS {
            assert_ne!(
                Assumptions::from_settings(&[format!("{name} = 999")]),
                Assumptions::default(),
                "{name}"
            );
        }
    }
}
