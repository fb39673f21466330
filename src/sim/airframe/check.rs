//! The rules that every airframe file must satisfy so that the airframe can fly.

use nalgebra::Vector3;

use super::{Airframe, ROTORS};
use crate::math;

/// The minimum thrust over weight.
const MIN_THRUST_TO_WEIGHT: f64 = 1.3;
/// The minimum motor time constant, s. Below it the equation of the motors is unstable at the longest step.
const MIN_MOTOR_TAU_S: f64 = 0.002;
/// The maximum product of leg frequency and step for a craft that is at rest on the ground.
const MAX_LEG_PHASE: f64 = 1.2;
/// The maximum product of leg damping rate and step for a craft that is at rest on the ground. The integrator takes 2.78.
const MAX_LEG_DECAY: f64 = 2.0;
/// The spin of M1…M4 that the mixer of the flight controller expects.
const SPIN: [f64; ROTORS] = [-1.0, 1.0, 1.0, -1.0];
/// The signs of x and y of M1…M4.
const PLACES: [(f64, f64, &str); ROTORS] = [
    (-1.0, -1.0, "rear right"),
    (1.0, -1.0, "front right"),
    (-1.0, 1.0, "rear left"),
    (1.0, 1.0, "front left"),
];

/// One rule that a value breaks: the key and the sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Finding {
    pub key: &'static str,
    pub text: String,
}

/// Returns everything wrong with an airframe, empty if it can fly with steps of `step_s`.
pub(super) fn findings(airframe: &Airframe, step_s: f64) -> Vec<Finding> {
    let mut found = Findings(Vec::new());
    found.above("mass_kg", airframe.mass_kg, 0.0);
    found.inertia(airframe.inertia_kgm2);
    found.rotors(airframe);
    found.above("k_t_N_per_rad2s2", airframe.thrust_coeff, 0.0);
    found.above("omega_max_rads", airframe.rotor_speed_max, 0.0);
    found.above("rotor_radius_m", airframe.rotor_radius_m, 0.0);
    found.at_least("kappa_m_torque_over_thrust", airframe.torque_per_thrust_m, 0.0);
    found.at_least("j_rotor_kgm2", airframe.rotor_inertia_kgm2, 0.0);
    found.at_least("k_z_inflow_kg_per_rad", airframe.inflow_coeff, 0.0);
    found.at_least("k_d_rotor_drag_kg_per_rad", airframe.rotor_drag_coeff, 0.0);
    found.at_least("c_par_N_per_m2s2", airframe.body_drag.min(), 0.0);
    found.at_least("k_w_Nm_per_rads", airframe.angular_damping.min(), 0.0);
    found.at_least("tau_up_s", airframe.motor_tau_up_s, MIN_MOTOR_TAU_S);
    found.at_least("tau_down_s", airframe.motor_tau_down_s, MIN_MOTOR_TAU_S);
    found.at_least("mu", airframe.friction, 0.0);
    found.above("friction_regularisation_mps", airframe.friction_full_mps, 0.0);
    found.above("k_n_N_per_m_per_point", airframe.leg_stiffness, 0.0);
    found.at_least("c_n_Ns_per_m_per_point", airframe.leg_damping, 0.0);
    found.legs(airframe);
    found.battery(airframe);
    if found.0.is_empty() {
        found.thrust(airframe);
        found.leg_stability(airframe, step_s);
    }
    found.0
}

struct Findings(Vec<Finding>);

impl Findings {
    fn add(&mut self, key: &'static str, text: String) {
        self.0.push(Finding { key, text });
    }

    fn above(&mut self, key: &'static str, value: f64, limit: f64) {
        if !(value > limit && value.is_finite()) {
            self.add(key, format!("must be greater than {limit}, not {value}"));
        }
    }

    fn at_least(&mut self, key: &'static str, value: f64, limit: f64) {
        if !(value >= limit && value.is_finite()) {
            self.add(key, format!("must be at least {limit}, not {value}"));
        }
    }

    fn inertia(&mut self, j: Vector3<f64>) {
        const KEY: &str = "inertia_kgm2";
        if !j.iter().all(|&j| j > 0.0 && j.is_finite()) {
            self.add(KEY, "must be three numbers greater than 0".to_owned());
            return;
        }
        let largest = j.max();
        if largest > j.sum() - largest {
            self.add(
                KEY,
                "no body has one moment of inertia greater than the sum of the other two; check the numbers"
                    .to_owned(),
            );
        }
    }

    fn rotors(&mut self, airframe: &Airframe) {
        for (i, (position, (x, y, place))) in airframe.rotor_positions_m.iter().zip(PLACES).enumerate() {
            if !(position.x * x > 0.0 && position.y * y > 0.0 && position.z.is_finite()) {
                self.add(
                    "rotor_pos_m_M1_to_M4_flu_from_com",
                    format!("M{} must be {place} (x forward, y left)", i + 1),
                );
            }
        }
        if airframe.spin_sign != SPIN {
            self.add(
                "spin_sign_ccw_positive",
                "must be [-1, 1, 1, -1]: M1 and M4 clockwise, M2 and M3 anticlockwise, or yaw would work backwards"
                    .to_owned(),
            );
        }
    }

    fn legs(&mut self, airframe: &Airframe) {
        const KEY: &str = "contact_points_m_flu_from_com";
        if airframe.legs_m.len() < 3 {
            self.add(KEY, format!("needs at least 3 points, not {}", airframe.legs_m.len()));
        }
        if !airframe.legs_m.iter().all(|leg| leg.z < 0.0 && leg.iter().all(|c| c.is_finite())) {
            self.add(KEY, "every point must be below the centre of mass (z < 0)".to_owned());
        }
    }

    fn battery(&mut self, airframe: &Airframe) {
        let battery = &airframe.battery;
        if !(1..=14).contains(&battery.cells) {
            self.add("battery.cells", format!("must be 1 to 14, not {}", battery.cells));
        }
        self.above("battery.nominal_v", battery.nominal_v, 0.0);
        self.above("battery.resistance_ohm", battery.resistance_ohm, 0.0);
        self.above("battery.capacity_ah", battery.capacity_ah, 0.0);
    }

    fn thrust(&mut self, airframe: &Airframe) {
        let ratio = airframe.thrust_to_weight();
        if ratio < MIN_THRUST_TO_WEIGHT {
            self.add(
                "omega_max_rads",
                format!(
                    "gives {ratio:.2} times the weight in thrust; at least {MIN_THRUST_TO_WEIGHT} is needed to fly: raise \
                     omega_max_rads or k_t_N_per_rad2s2, or lower mass_kg"
                ),
            );
        }
    }

    /// Checks the legs as springs on the mass and, through their lever, on the inertias.
    fn leg_stability(&mut self, airframe: &Airframe, step_s: f64) {
        let step = format!("steps of {} ms with this mass and inertia", (step_s * 1e6).round() / 1e3);
        let legs = &airframe.legs_m;
        let lever = |arm: fn(&Vector3<f64>) -> f64, j: f64| legs.iter().map(arm).sum::<f64>() / j;
        let per_unit = (legs.len() as f64 / airframe.mass_kg)
            .max(lever(|r| r.y * r.y + r.z * r.z, airframe.inertia_kgm2.x))
            .max(lever(|r| r.x * r.x + r.z * r.z, airframe.inertia_kgm2.y))
            .max(lever(|r| r.x * r.x + r.y * r.y, airframe.inertia_kgm2.z));
        let phase = (airframe.leg_stiffness * per_unit).sqrt() * step_s;
        if phase > MAX_LEG_PHASE {
            let limit = math::powi(MAX_LEG_PHASE / step_s, 2) / per_unit;
            self.add("k_n_N_per_m_per_point", format!("is too stiff for {step}: use at most {limit:.0} N/m"));
        }
        if airframe.leg_damping * per_unit * step_s > MAX_LEG_DECAY {
            let limit = MAX_LEG_DECAY / step_s / per_unit;
            self.add(
                "c_n_Ns_per_m_per_point",
                format!("is too strong for {step}: use at most {limit:.1} N·s/m"),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(change: impl FnOnce(&mut Airframe)) -> Vec<&'static str> {
        let mut airframe = Airframe::iris();
        change(&mut airframe);
        findings(&airframe, 0.0025).into_iter().map(|finding| finding.key).collect()
    }

    #[test]
    fn each_broken_rule_names_its_key() {
        assert_eq!(keys(|a| a.mass_kg = 0.0), ["mass_kg"]);
        assert_eq!(keys(|a| a.mass_kg = f64::NAN), ["mass_kg"]);
        assert_eq!(keys(|a| a.inertia_kgm2.z = 0.02), ["inertia_kgm2"]);
        assert_eq!(keys(|a| a.spin_sign[0] = 1.0), ["spin_sign_ccw_positive"]);
        assert_eq!(keys(|a| a.rotor_positions_m.swap(0, 1)).len(), 2);
        assert_eq!(keys(|a| a.rotor_speed_max = 390.0), ["omega_max_rads"]);
        assert_eq!(keys(|a| a.motor_tau_down_s = 0.0), ["tau_down_s"]);
        assert_eq!(keys(|a| a.legs_m.truncate(2)), ["contact_points_m_flu_from_com"]);
        assert_eq!(keys(|a| a.leg_stiffness = 1e5), ["k_n_N_per_m_per_point"]);
        assert_eq!(keys(|a| a.leg_damping = 100.0), ["c_n_Ns_per_m_per_point"]);
        assert_eq!(keys(|a| a.battery.resistance_ohm = 0.0), ["battery.resistance_ohm"]);
    }

    #[test]
    fn the_legs_are_judged_at_the_step_that_is_flown() {
        let mut airframe = Airframe::iris();
        airframe.leg_damping = 30.0;
        assert_eq!(findings(&airframe, 0.001), []);
        let found = findings(&airframe, 0.0025);
        assert!(found[0].text.starts_with("is too strong for steps of 2.5 ms"), "{found:?}");
        let found = findings(&airframe, 0.002_474_999_999_999_999_6);
        assert!(found[0].text.starts_with("is too strong for steps of 2.475 ms"), "{found:?}");
    }

    #[test]
    fn the_stiffest_legs_depend_on_the_mass_or_the_inertia_that_they_move_most() {
        // Half the distances between the legs, their depth, the mass, and the inertia per newton per metre and leg, of
        // which the largest counts.
        for (x, y, z, mass_kg, per_unit) in [
            (0.1, 0.1, 0.1, 0.2, 4.0 / 0.2),
            (0.1, 0.4, 0.2, 1.0, 4.0 * (0.16 + 0.04) / 0.04),
            (0.4, 0.1, 0.2, 1.0, 4.0 * (0.16 + 0.04) / 0.04),
            (0.4, 0.3, 0.1, 1.0, 4.0 * (0.16 + 0.09) / 0.04),
        ] {
            let mut airframe = Airframe::iris();
            airframe.mass_kg = mass_kg;
            airframe.inertia_kgm2 = Vector3::repeat(0.04);
            airframe.legs_m.clear();
            for (x, y) in [(x, y), (x, -y), (-x, y), (-x, -y)] {
                airframe.legs_m.push(Vector3::new(x, y, -z));
            }
            let stiffest = (1.2_f64 / 0.0025).powi(2) / per_unit;
            let strongest = 2.0 / 0.0025 / per_unit;
            (airframe.leg_stiffness, airframe.leg_damping) = (0.999 * stiffest, 0.999 * strongest);
            assert_eq!(findings(&airframe, 0.0025), [], "{x}, {y}, {z}");
            (airframe.leg_stiffness, airframe.leg_damping) = (1.001 * stiffest, 1.001 * strongest);
            let found = findings(&airframe, 0.0025);
            assert_eq!(found.len(), 2, "{x}, {y}, {z}: {found:?}");
            assert!(found[0].text.contains(&format!("at most {stiffest:.0} N/m")), "{found:?}");
            assert!(found[1].text.contains(&format!("at most {strongest:.1} N·s/m")), "{found:?}");
        }
    }
}
