//! Airframes: mass, geometry, rotors, drag, legs and battery of one quadcopter.
//!
//! Body axes are FLU (x forward, y left, z up) with the origin in the centre of mass. Motors are numbered as the
//! flight controller numbers them, seen from above with the nose up the page:
//!
//! ```text
//!        nose
//!   M4 cw    M2 ccw        spin sign: anticlockwise +1, clockwise −1
//!        ×
//!   M3 ccw   M1 cw
//! ```
//!
//! The built-in airframes can fly. Files are checked when they are read, and every airframe when a world is built.

use std::str::FromStr;

use arrayvec::ArrayVec;
use nalgebra::Vector3;

use crate::geo::GRAVITY;
use crate::math;
use crate::signals::MOTORS;

use super::battery::BatterySpec;
use crate::text::did_you_mean;

mod check;
mod file;

pub use file::{AirframeFileError, AirframeProblem};

/// The number of rotors.
pub const ROTORS: usize = MOTORS;

/// The maximum number of legs of an airframe.
pub const MAX_LEGS: usize = 8;

/// The air density for which the rotor and drag coefficients are given, kg/m³.
pub const REFERENCE_DENSITY: f64 = 1.225;

/// The names of the built-in airframes.
pub const BUILTIN_NAMES: [&str; 2] = ["iris", "five-inch"];

/// The physical constants of one quadcopter, SI units, body axes FLU from the centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Airframe {
    /// Name shown to people.
    pub name: String,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Principal moments of inertia about x, y, z, rotors included, kg·m².
    pub inertia_kgm2: Vector3<f64>,
    /// Rotor hubs M1…M4, m.
    pub rotor_positions_m: [Vector3<f64>; ROTORS],
    /// Spin M1…M4 seen from above: +1 anticlockwise, −1 clockwise.
    pub spin_sign: [f64; ROTORS],
    /// Rotor radius, m (ground effect only).
    pub rotor_radius_m: f64,
    /// Thrust per squared rotor speed, N/(rad/s)².
    pub thrust_coeff: f64,
    /// Shaft torque per thrust, m.
    pub torque_per_thrust_m: f64,
    /// Moment of inertia of one rotor, kg·m².
    pub rotor_inertia_kgm2: f64,
    /// Thrust lost per rotor speed and axial inflow, N/((rad/s)·(m/s)).
    pub inflow_coeff: f64,
    /// In-plane rotor drag per rotor speed and airspeed, N/((rad/s)·(m/s)).
    pub rotor_drag_coeff: f64,
    /// Body drag per squared airspeed along x, y, z, N/(m/s)².
    pub body_drag: Vector3<f64>,
    /// Aerodynamic damping of rotation about x, y, z, N·m/(rad/s).
    pub angular_damping: Vector3<f64>,
    /// Rotor speed at full command, rad/s.
    pub rotor_speed_max: f64,
    /// Motor time constant while speeding up, s.
    pub motor_tau_up_s: f64,
    /// Motor time constant while slowing down, s.
    pub motor_tau_down_s: f64,
    /// Lowest points of the legs, m.
    pub legs_m: ArrayVec<Vector3<f64>, MAX_LEGS>,
    /// Spring of one leg, N/m.
    pub leg_stiffness: f64,
    /// Damper of one leg, N·s/m.
    pub leg_damping: f64,
    /// Coulomb friction coefficient between leg and ground.
    pub friction: f64,
    /// Sliding speed below which friction falls linearly with speed, m/s.
    pub friction_full_mps: f64,
    /// Position of the inertial sensor, m.
    pub imu_position_m: Vector3<f64>,
    /// The battery.
    pub battery: BatterySpec,
}

impl Airframe {
    /// Returns the 3DR Iris of the public Gazebo world: 0.53 kg, hover at half command.
    ///
    /// Mass, geometry, inertia, thrust constant and motor lag follow the Gazebo model. Torque, rotor inertia and drag
    /// are those of the PX4 x500, since the blades of the model give almost no yaw authority. The top rotor speed
    /// puts hover at 1500 µs.
    pub fn iris() -> Self {
        Self {
            name: "iris".to_owned(),
            mass_kg: 0.53,
            inertia_kgm2: Vector3::new(0.00683, 0.00611, 0.01063),
            rotor_positions_m: [
                Vector3::new(-0.13, -0.20, 0.01866),
                Vector3::new(0.13, -0.22, 0.01866),
                Vector3::new(-0.13, 0.20, 0.01866),
                Vector3::new(0.13, 0.22, 0.01866),
            ],
            spin_sign: [-1.0, 1.0, 1.0, -1.0],
            rotor_radius_m: 0.1,
            thrust_coeff: 1.06202e-5,
            torque_per_thrust_m: 0.016,
            rotor_inertia_kgm2: 2.65e-5,
            inflow_coeff: 2e-4,
            rotor_drag_coeff: 8.06e-5,
            body_drag: Vector3::new(0.006, 0.006, 0.012),
            angular_damping: Vector3::new(0.002, 0.002, 0.002),
            rotor_speed_max: 696.0,
            motor_tau_up_s: 0.01197,
            motor_tau_down_s: 0.01197,
            legs_m: square_legs(0.235, -0.19934),
            leg_stiffness: 1299.4,
            leg_damping: 9.2,
            friction: 1.0,
            friction_full_mps: 0.02,
            imu_position_m: Vector3::zeros(),
            battery: BatterySpec { cells: 3, nominal_v: 11.1, resistance_ohm: 0.030, capacity_ah: 3.3 },
        }
    }

    /// Returns a five-inch racing quadcopter: 0.70 kg, ten times its weight in thrust, from published bench figures.
    pub fn five_inch() -> Self {
        Self {
            name: "five-inch".to_owned(),
            mass_kg: 0.70,
            inertia_kgm2: Vector3::new(0.0025, 0.0021, 0.0043),
            rotor_positions_m: [
                Vector3::new(-0.075, -0.1, 0.0),
                Vector3::new(0.075, -0.1, 0.0),
                Vector3::new(-0.075, 0.1, 0.0),
                Vector3::new(0.075, 0.1, 0.0),
            ],
            spin_sign: [-1.0, 1.0, 1.0, -1.0],
            rotor_radius_m: 0.0635,
            thrust_coeff: 1.798e-6,
            torque_per_thrust_m: 0.022,
            rotor_inertia_kgm2: 5e-6,
            inflow_coeff: 6e-5,
            rotor_drag_coeff: 2.4e-5,
            body_drag: Vector3::new(0.0045, 0.0057, 0.0229),
            angular_damping: Vector3::new(0.001, 0.001, 0.001),
            rotor_speed_max: 3108.6,
            motor_tau_up_s: 0.020,
            motor_tau_down_s: 0.030,
            legs_m: square_legs(0.08, -0.04),
            leg_stiffness: 1716.2,
            leg_damping: 12.15,
            friction: 0.7,
            friction_full_mps: 0.02,
            imu_position_m: Vector3::zeros(),
            battery: BatterySpec { cells: 6, nominal_v: 22.2, resistance_ohm: 0.025, capacity_ah: 1.3 },
        }
    }

    /// Returns the first rule that this airframe breaks, as a sentence that names the key, or `None` if it can fly with
    /// steps of `step_s`.
    pub fn fault(&self, step_s: f64) -> Option<String> {
        check::findings(self, step_s)
            .into_iter()
            .next()
            .map(|finding| format!("{} {}", finding.key, finding.text))
    }

    /// Returns the rotor speed at which four rotors carry the weight at the reference density, rad/s.
    pub fn hover_rotor_speed(&self) -> f64 {
        (self.mass_kg * GRAVITY / (ROTORS as f64 * self.thrust_coeff)).sqrt()
    }

    /// Returns the maximum thrust over weight at the reference density.
    pub fn thrust_to_weight(&self) -> f64 {
        ROTORS as f64 * self.thrust_coeff * math::powi(self.rotor_speed_max, 2) / (self.mass_kg * GRAVITY)
    }

    /// Returns the height of the centre of mass above the ground when the craft is on its legs, m.
    pub fn standing_height_m(&self) -> f64 {
        let lowest = self.legs_m.iter().map(|leg| leg.z).fold(0.0, f64::min);
        let touching = self.legs_m.iter().filter(|leg| leg.z < lowest + 1e-3).count().max(1);
        -lowest - self.mass_kg * GRAVITY / (touching as f64 * self.leg_stiffness)
    }
}

/// Returns four legs at (±xy, ±xy, z).
fn square_legs(xy: f64, z: f64) -> ArrayVec<Vector3<f64>, MAX_LEGS> {
    [(xy, xy), (xy, -xy), (-xy, xy), (-xy, -xy)].into_iter().map(|(x, y)| Vector3::new(x, y, z)).collect()
}

/// A name that no built-in airframe has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "{name:?} is not a built-in airframe (iris, five-inch), and an airframe file must end in .toml{hint}"
)]
pub struct UnknownAirframe {
    name: String,
    hint: String,
}

impl FromStr for Airframe {
    type Err = UnknownAirframe;

    /// Returns a built-in airframe by name.
    fn from_str(name: &str) -> Result<Self, Self::Err> {
        match name {
            "iris" => Ok(Self::iris()),
            "five-inch" => Ok(Self::five_inch()),
            _ => Err(UnknownAirframe {
                name: name.to_owned(),
                hint: did_you_mean::suffix(name, BUILTIN_NAMES),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_name_is_built_in_and_valid() {
        for name in BUILTIN_NAMES {
            let airframe: Airframe = name.parse().unwrap();
            assert_eq!(airframe.name, name);
            assert_eq!(check::findings(&airframe, 0.0025), Vec::new());
        }
    }

    #[test]
    fn a_misspelt_name_gets_a_suggestion() {
        let error = "five-inhc".parse::<Airframe>().unwrap_err().to_string();
        assert!(error.contains("did you mean five-inch?"), "{error}");
    }

    #[test]
    fn the_iris_sinks_one_millimetre_into_its_springs() {
        let iris = Airframe::iris();
        assert!((iris.standing_height_m() - 0.198_340_014_525_935_03).abs() < 1e-12);
    }
}
