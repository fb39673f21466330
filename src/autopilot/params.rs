//! The autopilot's parameters: one list from which the struct, its defaults, ranges and names follow.
//!
//! Fields keep the units of the settings (documented on each); the methods of [`Params`] give SI values.

mod value;

use crate::geo::GRAVITY;
use crate::telemetry::FenceAction;
use value::Value;
pub use value::{RxLossPolicy, YawMode};

/// One parameter of the list: its name, limits, and the way to its field.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// The name of the setting, such as `ap_max_angle`.
    pub name: &'static str,
    /// Smallest value.
    pub min: i64,
    /// Greatest value.
    pub max: i64,
    /// Reads the field as a number (enumerations and switches by their code).
    pub get: fn(&Params) -> i64,
    /// Writes the field; the caller keeps to `min` and `max`.
    pub set: fn(&mut Params, i64),
    /// The words of an enumeration or switch in the order of their codes; empty for plain numbers.
    pub words: fn() -> Vec<&'static str>,
}

/// Why a parameter was not set.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ParamError {
    /// No parameter of that name.
    #[error("there is no autopilot parameter {0}: `get ap_` lists them all")]
    Unknown(String),
    /// Out of range.
    #[error("{name} = {value} is out of range: allowed is {min} to {max}")]
    Range {
        /// Name of the parameter.
        name: &'static str,
        /// The value asked for.
        value: i64,
        /// Smallest value.
        min: i64,
        /// Greatest value.
        max: i64,
    },
}

/// Struct, defaults and table from one list: the only way to write each name, range and default once.
macro_rules! parameters {
    ($($(#[$doc:meta])* $name:literal $field:ident : $ty:ty = $default:expr, $min:literal ..= $max:literal;)*) => {
        /// Every parameter of the autopilot, in the units of the settings; two settings of other groups that it
        /// needs, `alt_hold_climb_rate` and `min_check`, come last.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub struct Params {
            $($(#[$doc])* pub $field: $ty,)*
        }

        impl Default for Params {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        impl Params {
            /// All parameters in the order of the settings list.
            pub const FIELDS: &'static [Field] = &[
                $(Field {
                    name: $name,
                    min: $min,
                    max: $max,
                    get: |params| params.$field.to_number(),
                    set: |params, number| params.$field = <$ty>::from_number(number),
                    words: <$ty>::words,
                },)*
            ];
        }
    };
}

parameters! {
    /// Below this altitude (m) a touchdown may be declared.
    "ap_landing_altitude_m" landing_altitude_m: u8 = 4, 0..=200;
    /// Throttle at hover, µs; 0 = what held the craft when the autopilot engaged.
    "ap_hover_throttle" hover_throttle: u16 = 1275, 0..=1700;
    /// Throttle floor in flight, µs.
    "ap_throttle_min" throttle_min: u16 = 1100, 1050..=1400;
    /// Throttle ceiling, µs.
    "ap_throttle_max" throttle_max: u16 = 1900, 1400..=2000;
    /// Altitude error gain, 0.01 µs per cm.
    "ap_altitude_p" altitude_p: u8 = 15, 0..=200;
    /// Altitude integral gain, 0.003 µs per cm·s.
    "ap_altitude_i" altitude_i: u8 = 20, 0..=200;
    /// Climb rate gain, 0.01 µs per cm/s.
    "ap_altitude_d" altitude_d: u8 = 30, 0..=200;
    /// Climb rate feed-forward, 0.0033 µs per cm/s.
    "ap_altitude_f" altitude_f: u8 = 30, 0..=200;
    /// Position gain: 0.025 per s of the speed law, 0.12 deg per m of the direct law.
    "ap_position_p" position_p: u8 = 30, 0..=200;
    /// Position integral of the direct law, 0.01 deg per m·s.
    "ap_position_i" position_i: u8 = 30, 0..=200;
    /// Position damping of the direct law, 0.15 deg per m/s.
    "ap_position_d" position_d: u8 = 30, 0..=200;
    /// Acceleration feedback of the direct law, 0.08 deg per m/s².
    "ap_position_a" position_a: u8 = 30, 0..=200;
    /// Stored, without effect.
    "ap_position_f" position_f: u8 = 30, 0..=200;
    /// Low-pass of the measured acceleration, 0.1 Hz.
    "ap_position_cutoff" position_cutoff: u8 = 30, 1..=250;
    /// Stored, without effect, cm/s.
    "ap_stop_threshold" stop_threshold: u8 = 10, 0..=100;
    /// Greatest lean, deg.
    "ap_max_angle" max_angle: u8 = 50, 10..=70;
    /// Whether holds fly the speed law too (else the direct law).
    "ap_velocity_control_enable" velocity_control_enable: bool = true, 0..=1;
    /// Speed error gain, 0.1 deg per m/s.
    "ap_velocity_p" velocity_p: u8 = 50, 0..=200;
    /// Speed error integral gain, 0.1 deg per m.
    "ap_velocity_i" velocity_i: u8 = 10, 0..=200;
    /// Acceleration damping, 0.1 deg per m/s².
    "ap_velocity_d" velocity_d: u8 = 5, 0..=100;
    /// Drag feed-forward, 1e-4 deg per (m/s)².
    "ap_velocity_drag_coeff" velocity_drag_coeff: u16 = 50, 0..=1000;
    /// Default and greatest leg speed, cm/s.
    "ap_max_velocity" max_velocity: u16 = 1000, 100..=5000;
    /// Arrival radius of FLYOVER and FLYBY, cm.
    "ap_waypoint_arrival_radius" waypoint_arrival_radius: u16 = 500, 100..=5000;
    /// Arrival radius of HOLD, LAND and TAKEOFF, cm.
    "ap_waypoint_hold_radius" waypoint_hold_radius: u16 = 200, 50..=1000;
    /// Stick deflection (full stick = 500) beyond which the pilot overrides.
    "ap_stick_deadband" stick_deadband: u16 = 50, 0..=500;
    /// Stored, without effect: the throttle stick never overrides.
    "ap_throttle_deadband" throttle_deadband: u16 = 50, 0..=500;
    /// Where the nose points.
    "ap_yaw_mode" yaw_mode: YawMode = YawMode::Velocity, 0..=4;
    /// Heading error gain, 0.01 per s.
    "ap_yaw_p" yaw_p: u16 = 50, 0..=500;
    /// Yaw rate damping, 0.01.
    "ap_yaw_d" yaw_d: u16 = 10, 0..=200;
    /// Greatest yaw rate, deg/s.
    "ap_max_yaw_rate" max_yaw_rate: u16 = 30, 10..=360;
    /// Ground speed from which the course is trusted, cm/s.
    "ap_min_forward_velocity" min_forward_velocity: u16 = 300, 10..=500;
    /// Stored, without effect, cm/s.
    "ap_nav_corner_speed" nav_corner_speed: u16 = 220, 50..=2000;
    /// Stored, without effect, cm/s.
    "ap_nav_corner_delta_v" nav_corner_delta_v: u16 = 440, 100..=4000;
    /// Stored, without effect, cm/s².
    "ap_nav_decel" nav_decel: u16 = 250, 20..=1000;
    /// Stored, without effect, cm/s².
    "ap_nav_accel" nav_accel: u16 = 250, 20..=1000;
    /// Stored, without effect, ds.
    "ap_nav_carrot_lead_time" nav_carrot_lead_time: u8 = 12, 2..=40;
    /// Stored, without effect, cm.
    "ap_nav_carrot_lead_max" nav_carrot_lead_max: u16 = 2500, 600..=6000;
    /// Stored, without effect, cm.
    "ap_nav_preturn_dist" nav_preturn_dist: u16 = 1500, 500..=5000;
    /// Lean that sets how fast speed builds up, deg; 0 = half of the greatest lean.
    "ap_velocity_buildup_max_pitch" velocity_buildup_max_pitch: u8 = 8, 0..=20;
    /// Angular rate along hold patterns, deg/s.
    "ap_max_turn_rate" max_turn_rate: u8 = 3, 1..=90;
    /// Radius of ORBIT, cm.
    "ap_hold_orbit_radius" hold_orbit_radius: u16 = 1000, 300..=5000;
    /// Distance between the circle centres of FIGURE8, cm.
    "ap_hold_figure8_width" hold_figure8_width: u16 = 2000, 500..=10000;
    /// Sink rate of a landing, cm/s.
    "ap_landing_descent_rate" landing_descent_rate: u8 = 50, 10..=200;
    /// Time the touchdown conditions must hold, ds.
    "ap_landing_detection_time" landing_detection_time: u8 = 10, 5..=50;
    /// Whether a landing descends on a spiral.
    "ap_landing_spiral_enable" landing_spiral_enable: bool = true, 0..=1;
    /// Radius of the spiral, cm.
    "ap_landing_spiral_radius" landing_spiral_radius: u16 = 200, 50..=2000;
    /// Angular rate of the spiral, deg/s.
    "ap_landing_spiral_rate" landing_spiral_rate: u8 = 10, 1..=45;
    /// Ground speed below which a touchdown may be declared, cm/s.
    "ap_landing_velocity_threshold" landing_velocity_threshold: u8 = 50, 10..=200;
    /// How far below hover the throttle must be for a touchdown, µs.
    "ap_landing_throttle_threshold" landing_throttle_threshold: u16 = 100, 10..=500;
    /// Whether legs are followed as lines.
    "ap_l1_enable" l1_enable: bool = true, 0..=1;
    /// Period of the path following, ds.
    "ap_l1_period" l1_period: u16 = 20, 5..=100;
    /// Least lookahead, cm.
    "ap_l1_min_lookahead" l1_min_lookahead: u16 = 1000, 100..=5000;
    /// Greatest lookahead, cm; wins over the least.
    "ap_l1_max_lookahead" l1_max_lookahead: u16 = 10000, 1000..=50000;
    /// Cross-track error beyond which the leg starts anew at the craft, cm.
    "ap_l1_max_cross_track_error" l1_max_cross_track_error: u16 = 10000, 1000..=50000;
    /// Turn rate of arcs at the start of a leg, deg/s; 0 = no arcs.
    "ap_l1_turn_rate" l1_turn_rate: u8 = 0, 0..=90;
    /// Altitude (m) to climb to on the spot before the first leg; 0 = none.
    "ap_min_nav_altitude_m" min_nav_altitude_m: u8 = 5, 0..=50;
    /// What a lost receiver does.
    "ap_rx_loss_policy" rx_loss_policy: RxLossPolicy = RxLossPolicy::Disable, 0..=2;
    /// The fence: greatest distance from home, m; 0 = no fence.
    "ap_max_distance_from_home" max_distance_from_home: u16 = 0, 0..=10000;
    /// What leaving the fence does.
    "ap_geofence_action" geofence_action: FenceAction = FenceAction::Land, 0..=1;
    /// Greatest climb and sink rate, 10 cm/s; 0 counts as 50.
    "alt_hold_climb_rate" alt_hold_climb_rate: u8 = 50, 0..=200;
    /// Throttle pulse that counts as zero, µs.
    "min_check" min_check: u16 = 1050, 750..=2250;
}

impl Params {
    /// Sets the parameter called `name` (enumerations and switches by their code).
    ///
    /// # Errors
    /// When there is no such parameter, or the value is outside its range.
    pub fn set_by_name(&mut self, name: &str, value: i64) -> Result<(), ParamError> {
        let field = Self::field(name).ok_or_else(|| ParamError::Unknown(name.to_owned()))?;
        if !(field.min..=field.max).contains(&value) {
            return Err(ParamError::Range { name: field.name, value, min: field.min, max: field.max });
        }
        (field.set)(self, value);
        Ok(())
    }

    /// The parameter called `name`.
    #[must_use]
    pub fn field(name: &str) -> Option<&'static Field> {
        Self::FIELDS.iter().find(|field| field.name == name)
    }

    /// Greatest lean, rad.
    #[must_use]
    pub fn max_lean_rad(&self) -> f64 {
        f64::from(self.max_angle).to_radians()
    }

    /// Acceleration the greatest lean allows for braking and turning, m/s²: g·sin of it.
    #[must_use]
    pub fn max_accel_mps2(&self) -> f64 {
        GRAVITY * self.max_lean_rad().sin()
    }

    /// Acceleration when speed builds up, m/s².
    #[must_use]
    pub fn build_up_accel_mps2(&self) -> f64 {
        match self.velocity_buildup_max_pitch {
            0 => 0.5 * self.max_accel_mps2(),
            pitch_deg => GRAVITY * f64::from(pitch_deg).to_radians().tan(),
        }
    }

    /// Default and greatest leg speed, m/s.
    #[must_use]
    pub fn max_velocity_mps(&self) -> f64 {
        f64::from(self.max_velocity) / 100.0
    }

    /// Arrival radius of FLYOVER and FLYBY, m.
    #[must_use]
    pub fn arrival_radius_m(&self) -> f64 {
        f64::from(self.waypoint_arrival_radius) / 100.0
    }

    /// Arrival radius of HOLD, LAND and TAKEOFF, m.
    #[must_use]
    pub fn hold_radius_m(&self) -> f64 {
        f64::from(self.waypoint_hold_radius) / 100.0
    }

    /// Greatest climb and sink rate, m/s.
    #[must_use]
    pub fn climb_rate_mps(&self) -> f64 {
        match self.alt_hold_climb_rate {
            0 => 5.0,
            rate => f64::from(rate) / 10.0,
        }
    }

    /// Sink rate of a landing, m/s.
    #[must_use]
    pub fn descent_rate_mps(&self) -> f64 {
        f64::from(self.landing_descent_rate) / 100.0
    }

    /// The fence, m, when one is set.
    #[must_use]
    pub fn fence_m(&self) -> Option<f64> {
        (self.max_distance_from_home > 0).then(|| f64::from(self.max_distance_from_home))
    }

    /// Throttle pulse that is zero for the mixer, µs.
    #[must_use]
    pub fn throttle_zero_us(&self) -> f64 {
        f64::from(self.min_check.clamp(1000, 1900))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_lie_in_their_ranges() {
        let defaults = Params::default();
        for field in Params::FIELDS {
            let value = (field.get)(&defaults);
            assert!((field.min..=field.max).contains(&value), "{} = {value}", field.name);
        }
    }

    #[test]
    fn there_are_fifty_nine_and_two() {
        let own = Params::FIELDS.iter().filter(|field| field.name.starts_with("ap_")).count();
        assert_eq!((own, Params::FIELDS.len()), (59, 61));
    }

    #[test]
    fn every_field_reads_back_what_was_set() {
        for field in Params::FIELDS {
            for value in [field.min, field.max] {
                let mut params = Params::default();
                params.set_by_name(field.name, value).unwrap();
                assert_eq!((field.get)(&params), value, "{}", field.name);
                let changed = Params::FIELDS
                    .iter()
                    .filter(|other| (other.get)(&params) != (other.get)(&Params::default()))
                    .all(|other| other.name == field.name);
                assert!(changed, "{} changed another field", field.name);
            }
        }
    }

    #[test]
    fn a_value_out_of_range_names_the_range() {
        let error = Params::default().set_by_name("ap_max_angle", 71).unwrap_err();
        assert_eq!(error.to_string(), "ap_max_angle = 71 is out of range: allowed is 10 to 70");
        assert!(Params::default().set_by_name("ap_nothing", 0).is_err());
    }

    #[test]
    fn words_follow_their_codes() {
        let words = (Params::field("ap_yaw_mode").unwrap().words)();
        assert_eq!(words, ["VELOCITY", "BEARING", "HYBRID", "FIXED", "DAMPENER"]);
        assert_eq!((Params::field("ap_l1_enable").unwrap().words)(), ["OFF", "ON"]);
    }
}
