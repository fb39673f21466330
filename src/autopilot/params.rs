//! The parameters of the autopilot: one list that gives the struct, its defaults, ranges and names, and the settings
//! that users see.
//!
//! Fields keep the units of the settings (documented on each). The methods of [`Params`] return SI values.

mod value;

use crate::geo::GRAVITY;
use crate::math;
use crate::telemetry::{FenceAction, FirmwareProfile, RxLossPolicy};
use value::Value;
pub use value::YawMode;

/// One parameter of the list, with the access to its field.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// The name of the setting, such as `ap_max_angle`.
    pub name: &'static str,
    pub min: i64,
    pub max: i64,
    /// Writes the field as a number (enumerations and switches by their code). The caller keeps to `min` and `max`.
    pub set: fn(&mut Params, i64),
    /// Value of a fresh vehicle.
    pub default: i64,
    /// Size on the wire, bytes.
    pub bytes: usize,
    /// The names of the values of an enumeration or switch in the order of their codes; empty for plain numbers.
    pub words: &'static [&'static str],
    /// Effect of the parameter in this firmware.
    pub effect: Effect,
    /// One line for people, with the unit.
    pub help: &'static str,
}

/// The effect of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Both profiles use it.
    Live,
    /// The profile `guide` uses it. In `master` it is stored only.
    Guide,
    /// The profile `master` uses it. In `guide` it is stored only.
    Master,
}

/// Generates struct, defaults and table from one list, so that each name, range and default is written only once.
macro_rules! parameters {
    ($($(#[$doc:meta])* $name:literal $field:ident : $ty:ty = $default:expr, $min:literal ..= $max:literal,
        $effect:ident, $help:literal;)*) => {
        /// Every parameter of the autopilot, in the units of the settings. The last two, `alt_hold_climb_rate` and
        /// `min_check`, are settings of other groups that the autopilot needs.
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
            /// The number of parameters at the end of the list that are settings of other groups.
            pub const SHARED: usize = 2;

            /// All parameters in the order of the settings list.
            pub const FIELDS: &'static [Field] = &[
                $(Field {
                    name: $name,
                    min: $min,
                    max: $max,
                    set: |params, number| params.$field = <$ty>::from_number(number),
                    default: {
                        const DEFAULT: $ty = $default;
                        DEFAULT as i64
                    },
                    bytes: size_of::<$ty>(),
                    words: <$ty as Value>::WORDS,
                    effect: Effect::$effect,
                    help: $help,
                },)*
            ];
        }
    };
}

parameters! {
    /// The laws that fly the craft.
    "ap_profile" profile: FirmwareProfile = FirmwareProfile::Guide, 0..=1, Live,
        "Laws of the autopilot: those of the test guide, or of today's master.";
    /// Altitude (m) below which a touchdown may be declared.
    "ap_landing_altitude_m" landing_altitude_m: u8 = 4, 0..=200, Live,
        "Height below which a touchdown may be declared, m.";
    /// Throttle at hover, µs; 0 = the throttle that held the craft when the autopilot engaged.
    "ap_hover_throttle" hover_throttle: u16 = 1275, 0..=1700, Live,
        "Throttle at hover, µs; 0 uses the throttle at which the autopilot engages.";
    /// Throttle floor in flight, µs.
    "ap_throttle_min" throttle_min: u16 = 1100, 1050..=1400, Live,
        "Minimum throttle in flight, µs.";
    /// Throttle ceiling, µs.
    "ap_throttle_max" throttle_max: u16 = 1900, 1400..=2000, Live,
        "Maximum throttle in flight, µs.";
    /// Altitude error gain, 0.01 µs per cm.
    "ap_altitude_p" altitude_p: u8 = 15, 0..=200, Live,
        "Throttle response to altitude error.";
    /// Altitude integral gain, 0.003 µs per cm·s.
    "ap_altitude_i" altitude_i: u8 = 20, 0..=200, Live,
        "Throttle response to lasting altitude error.";
    /// Climb rate gain, 0.01 µs per cm/s.
    "ap_altitude_d" altitude_d: u8 = 30, 0..=200, Live,
        "Throttle response to climb rate error.";
    /// Climb rate feed-forward, 0.0033 µs per cm/s.
    "ap_altitude_f" altitude_f: u8 = 30, 0..=200, Live,
        "Throttle response to the commanded climb rate.";
    /// Position gain: 0.025 per s of the speed law, 0.12 deg per m of the direct law.
    "ap_position_p" position_p: u8 = 30, 0..=200, Live,
        "Tilt response to position error.";
    /// Position integral of the direct law, 0.01 deg per m·s.
    "ap_position_i" position_i: u8 = 30, 0..=200, Live,
        "Tilt response to lasting position error.";
    /// Position damping of the direct law, 0.15 deg per m/s.
    "ap_position_d" position_d: u8 = 30, 0..=200, Live,
        "Tilt response to speed.";
    /// Acceleration feedback of the direct law, 0.08 deg per m/s².
    "ap_position_a" position_a: u8 = 30, 0..=200, Live,
        "Tilt response to acceleration, and weight of the accelerometer.";
    "ap_position_f" position_f: u8 = 30, 0..=200, Master,
        "Tilt response to the commanded speed.";
    /// Low-pass of the measured acceleration, 0.1 Hz.
    "ap_position_cutoff" position_cutoff: u8 = 30, 1..=250, Live,
        "Smoothing of the tilt angle, 0.1 Hz.";
    "ap_stop_threshold" stop_threshold: u8 = 10, 0..=100, Master,
        "Speed below which a hold counts as stopped, cm/s.";
    /// Maximum tilt, deg.
    "ap_max_angle" max_angle: u8 = 50, 10..=70, Live,
        "Maximum tilt of the autopilot, deg; also sets the turn radius.";
    /// `true` if holds use the speed law too, else the direct law.
    "ap_velocity_control_enable" velocity_control_enable: bool = true, 0..=1, Guide,
        "Control the speed over ground, not only the position.";
    /// Speed error gain, 0.1 deg per m/s.
    "ap_velocity_p" velocity_p: u8 = 50, 0..=200, Guide,
        "Tilt response to speed error, 0.1 deg per m/s.";
    /// Speed error integral gain, 0.1 deg per m.
    "ap_velocity_i" velocity_i: u8 = 10, 0..=200, Guide,
        "Tilt response to lasting speed error, 0.1 deg per m.";
    /// Acceleration damping, 0.1 deg per m/s².
    "ap_velocity_d" velocity_d: u8 = 5, 0..=100, Guide,
        "Tilt response to acceleration, 0.1 deg per m/s².";
    /// Drag feed-forward, 1e-4 deg per (m/s)².
    "ap_velocity_drag_coeff" velocity_drag_coeff: u16 = 50, 0..=1000, Live,
        "Tilt that compensates for air drag, 0.0001 deg per (m/s)2.";
    /// Default and maximum leg speed, cm/s.
    "ap_max_velocity" max_velocity: u16 = 500, 100..=5000, Live,
        "Maximum speed, and the speed of legs that set none, cm/s.";
    /// Arrival radius of FLYOVER and FLYBY, cm.
    "ap_waypoint_arrival_radius" waypoint_arrival_radius: u16 = 500, 100..=5000, Live,
        "Distance at which FLYOVER and FLYBY waypoints count as reached, cm.";
    /// Arrival radius of HOLD, LAND and TAKEOFF, cm.
    "ap_waypoint_hold_radius" waypoint_hold_radius: u16 = 200, 50..=1000, Live,
        "Distance at which HOLD, LAND and TAKEOFF waypoints count as reached, cm.";
    /// Stick deflection (full stick = 500) beyond which the pilot overrides.
    "ap_stick_deadband" stick_deadband: u16 = 50, 0..=500, Guide,
        "Stick movement beyond which the pilot steers, µs.";
    /// Throttle stick movement that takes over a hold after a mission was given up, µs.
    "ap_throttle_deadband" throttle_deadband: u16 = 50, 0..=500, Guide,
        "Throttle movement that takes over after a mission was aborted, µs.";
    /// Direction of the nose.
    "ap_yaw_mode" yaw_mode: YawMode = YawMode::Velocity, 0..=4, Live,
        "Direction of the nose: along the path, to the waypoint, both, or as at engagement (FIXED, DAMPENER).";
    /// Heading error gain, 0.01 per s.
    "ap_yaw_p" yaw_p: u16 = 50, 0..=500, Live,
        "Yaw rate response to heading error, 0.01 per s.";
    /// Yaw rate damping, 0.01.
    "ap_yaw_d" yaw_d: u16 = 10, 0..=200, Live,
        "Damping of the yaw rate, 0.01.";
    /// Maximum yaw rate, deg/s.
    "ap_max_yaw_rate" max_yaw_rate: u16 = 30, 10..=360, Live,
        "Maximum yaw rate of the autopilot, deg/s.";
    /// Ground speed from which the course is trusted, cm/s.
    "ap_min_forward_velocity" min_forward_velocity: u16 = 300, 10..=500, Live,
        "Speed above which the course is trusted, cm/s.";
    "ap_nav_corner_speed" nav_corner_speed: u16 = 220, 50..=2000, Master,
        "Speed through corners, cm/s.";
    "ap_nav_corner_delta_v" nav_corner_delta_v: u16 = 440, 100..=4000, Master,
        "Change of velocity allowed at a corner, cm/s.";
    "ap_nav_decel" nav_decel: u16 = 250, 20..=1000, Master,
        "Braking before corners, cm/s².";
    "ap_nav_accel" nav_accel: u16 = 250, 20..=1000, Master,
        "Acceleration after corners, cm/s².";
    "ap_nav_carrot_lead_time" nav_carrot_lead_time: u8 = 12, 2..=40, Master,
        "Time by which the aim point leads the craft, 0.1 s.";
    "ap_nav_carrot_lead_max" nav_carrot_lead_max: u16 = 2500, 600..=6000, Master,
        "Maximum distance of the aim point, cm.";
    "ap_nav_preturn_dist" nav_preturn_dist: u16 = 1500, 500..=5000, Master,
        "Distance before a corner at which the turn begins, cm.";
    /// Tilt that sets the acceleration when speed builds up, deg; 0 = half of the maximum tilt.
    "ap_velocity_buildup_max_pitch" velocity_buildup_max_pitch: u8 = 8, 0..=20, Guide,
        "Nose-down tilt that helps a slow craft to gain speed, deg.";
    /// Angular rate along hold patterns, deg/s.
    "ap_max_turn_rate" max_turn_rate: u8 = 3, 1..=90, Guide,
        "Angular speed along orbits and figures of eight, deg/s.";
    /// Radius of ORBIT, cm.
    "ap_hold_orbit_radius" hold_orbit_radius: u16 = 1000, 300..=5000, Guide,
        "Radius of orbits, cm.";
    /// Distance between the circle centres of FIGURE8, cm.
    "ap_hold_figure8_width" hold_figure8_width: u16 = 2000, 500..=10000, Guide,
        "Distance between the two circles of a figure of eight, cm.";
    /// Sink rate of a landing, cm/s.
    "ap_landing_descent_rate" landing_descent_rate: u8 = 50, 10..=200, Live,
        "Descent rate of a landing, cm/s.";
    /// Time the touchdown conditions must hold, ds.
    "ap_landing_detection_time" landing_detection_time: u8 = 10, 5..=50, Live,
        "Time for which the signs of a touchdown must last, 0.1 s.";
    /// `true` if a landing descends on a spiral.
    "ap_landing_spiral_enable" landing_spiral_enable: bool = true, 0..=1, Guide,
        "Descend in a spiral.";
    /// Radius of the spiral, cm.
    "ap_landing_spiral_radius" landing_spiral_radius: u16 = 200, 50..=2000, Guide,
        "Radius of that spiral, cm.";
    /// Angular rate of the spiral, deg/s.
    "ap_landing_spiral_rate" landing_spiral_rate: u8 = 10, 1..=45, Guide,
        "Angular speed of that spiral, deg/s.";
    /// Ground speed below which a touchdown may be declared, cm/s.
    "ap_landing_velocity_threshold" landing_velocity_threshold: u8 = 50, 10..=200, Live,
        "Ground speed below which a touchdown is possible, cm/s.";
    /// Required distance of the throttle below the hover throttle for a touchdown, µs.
    "ap_landing_throttle_threshold" landing_throttle_threshold: u16 = 100, 10..=500, Guide,
        "Throttle this far below hover is a sign of a touchdown, µs.";
    /// `true` if legs are followed as lines.
    "ap_l1_enable" l1_enable: bool = true, 0..=1, Guide,
        "Follow the line between waypoints instead of pointing at the next one.";
    /// Period of the path following, ds.
    "ap_l1_period" l1_period: u16 = 20, 5..=100, Guide,
        "Period of the path following; shorter is sharper, 0.1 s.";
    /// Minimum lookahead, cm.
    "ap_l1_min_lookahead" l1_min_lookahead: u16 = 1000, 100..=5000, Guide,
        "Minimum distance of the aim point on the path, cm.";
    /// Maximum lookahead, cm; takes precedence over the minimum.
    "ap_l1_max_lookahead" l1_max_lookahead: u16 = 10000, 1000..=50000, Guide,
        "Maximum distance of the aim point on the path, cm.";
    /// Cross-track error beyond which the leg starts again at the craft, cm.
    "ap_l1_max_cross_track_error" l1_max_cross_track_error: u16 = 10000, 1000..=50000, Guide,
        "Cross-track error above which the craft flies straight back to the path, cm.";
    /// Turn rate of arcs at the start of a leg, deg/s; 0 = no arcs.
    "ap_l1_turn_rate" l1_turn_rate: u8 = 0, 0..=90, Guide,
        "Angular speed of the arcs that round corners, deg/s; 0 for no arcs.";
    /// Altitude (m) to climb to on the spot before the first leg; 0 = none.
    "ap_min_nav_altitude_m" min_nav_altitude_m: u8 = 5, 0..=50, Guide,
        "Height below which the craft climbs before the first leg, m.";
    /// Reaction to a lost receiver.
    "ap_rx_loss_policy" rx_loss_policy: RxLossPolicy = RxLossPolicy::Disable, 0..=2, Live,
        "Reaction of a mission to a lost link.";
    /// The fence: maximum distance from home, m; 0 = no fence.
    "ap_max_distance_from_home" max_distance_from_home: u16 = 0, 0..=10000, Live,
        "Radius of the fence around home, m; 0 for no fence.";
    /// Reaction to leaving the fence.
    "ap_geofence_action" geofence_action: FenceAction = FenceAction::Land, 0..=1, Live,
        "Reaction to leaving the fence.";
    /// Maximum climb and sink rate, 10 cm/s; 0 counts as 50.
    "alt_hold_climb_rate" alt_hold_climb_rate: u8 = 50, 0..=200, Live,
        "Climb rate at full stick in altitude hold, 0.1 m/s.";
    /// Throttle pulse that counts as zero, µs.
    "min_check" min_check: u16 = 1050, 750..=2250, Live,
        "Throttle below this counts as low, µs.";
}

impl Params {
    /// Returns the parameter with this name.
    pub fn field(name: &str) -> Option<&'static Field> {
        Self::FIELDS.iter().find(|field| field.name == name)
    }

    /// Returns the maximum tilt, rad.
    pub fn max_tilt_rad(&self) -> f64 {
        f64::from(self.max_angle).to_radians()
    }

    /// Returns the acceleration that the maximum tilt allows for braking and turning, m/s²: g·sin(maximum tilt).
    pub fn max_accel_mps2(&self) -> f64 {
        GRAVITY * math::sin(self.max_tilt_rad())
    }

    /// Returns the acceleration when speed builds up, m/s².
    pub fn build_up_accel_mps2(&self) -> f64 {
        match self.velocity_buildup_max_pitch {
            0 => 0.5 * self.max_accel_mps2(),
            pitch_deg => GRAVITY * math::tan(f64::from(pitch_deg).to_radians()),
        }
    }

    /// Returns the default and maximum leg speed, m/s.
    pub fn max_velocity_mps(&self) -> f64 {
        f64::from(self.max_velocity) / 100.0
    }

    /// Returns the arrival radius of FLYOVER and FLYBY, m.
    pub fn arrival_radius_m(&self) -> f64 {
        f64::from(self.waypoint_arrival_radius) / 100.0
    }

    /// Returns the arrival radius of HOLD, LAND and TAKEOFF, m.
    pub fn hold_radius_m(&self) -> f64 {
        f64::from(self.waypoint_hold_radius) / 100.0
    }

    /// Returns the maximum climb and sink rate, m/s.
    pub fn climb_rate_mps(&self) -> f64 {
        match self.alt_hold_climb_rate {
            0 => 5.0,
            rate => f64::from(rate) / 10.0,
        }
    }

    /// Returns the sink rate of a landing, m/s.
    pub fn descent_rate_mps(&self) -> f64 {
        f64::from(self.landing_descent_rate) / 100.0
    }

    /// Returns the fence, m, if one is set.
    pub fn fence_m(&self) -> Option<f64> {
        (self.max_distance_from_home > 0).then(|| f64::from(self.max_distance_from_home))
    }

    /// Returns the throttle pulse that is zero for the mixer, µs.
    pub fn throttle_zero_us(&self) -> f64 {
        f64::from(self.min_check.clamp(1000, 1900))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the defaults with another number in a field.
    fn with(field: &Field, number: i64) -> Params {
        let mut params = Params::default();
        (field.set)(&mut params, number);
        params
    }

    #[test]
    fn defaults_lie_in_their_ranges() {
        for field in Params::FIELDS {
            let value = field.default;
            assert!((field.min..=field.max).contains(&value), "{} = {value}", field.name);
            assert_eq!(with(field, value), Params::default(), "{}", field.name);
        }
    }

    #[test]
    fn there_are_sixty_and_two() {
        let own = Params::FIELDS.iter().filter(|field| field.name.starts_with("ap_")).count();
        assert_eq!((own, Params::FIELDS.len()), (60, 62));
        assert_eq!(own + Params::SHARED, Params::FIELDS.len());
    }

    #[test]
    fn every_field_keeps_each_number_and_changes_no_other_field() {
        for field in Params::FIELDS {
            let numbers = [field.min, field.min + 1, field.default, field.max - 1, field.max];
            for one in numbers {
                for other in numbers {
                    let is_same = with(field, one) == with(field, other);
                    assert_eq!(is_same, one == other, "{}: {one} and {other}", field.name);
                }
                let mut params = with(field, one);
                (field.set)(&mut params, field.default);
                assert_eq!(params, Params::default(), "{} = {one} changed another field", field.name);
            }
        }
    }

    #[test]
    fn words_follow_their_codes() {
        let words = Params::field("ap_yaw_mode").unwrap().words;
        assert_eq!(words, ["VELOCITY", "BEARING", "HYBRID", "FIXED", "DAMPENER"]);
        assert_eq!(Params::field("ap_l1_enable").unwrap().words, ["OFF", "ON"]);
    }
}
