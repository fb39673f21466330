//! An airframe as the text of its file.

use nalgebra::Vector3;

use crate::sim::airframe::Airframe;

impl Airframe {
    /// Returns the text of a file with every constant. [`Airframe::from_toml`] reads the same airframe from it.
    pub fn to_toml(&self) -> String {
        let four = |values: &[f64]| list(values.iter().map(number));
        let points = |points: &[Vector3<f64>]| list(points.iter().map(vector));
        let battery = &self.battery;
        let lines = [
            ("name", toml::Value::from(self.name.as_str()).to_string()),
            ("mass_kg", number(&self.mass_kg)),
            ("inertia_kgm2", vector(&self.inertia_kgm2)),
            ("rotor_pos_m_M1_to_M4_flu_from_com", points(&self.rotor_positions_m)),
            ("spin_sign_ccw_positive", four(&self.spin_sign)),
            ("k_t_N_per_rad2s2", number(&self.thrust_coeff)),
            ("kappa_m_torque_over_thrust", number(&self.torque_per_thrust_m)),
            ("j_rotor_kgm2", number(&self.rotor_inertia_kgm2)),
            ("k_z_inflow_kg_per_rad", number(&self.inflow_coeff)),
            ("k_d_rotor_drag_kg_per_rad", number(&self.rotor_drag_coeff)),
            ("c_par_N_per_m2s2", vector(&self.body_drag)),
            ("k_w_Nm_per_rads", vector(&self.angular_damping)),
            ("omega_max_rads", number(&self.rotor_speed_max)),
            ("tau_up_s", number(&self.motor_tau_up_s)),
            ("tau_down_s", number(&self.motor_tau_down_s)),
            ("contact_points_m_flu_from_com", points(&self.legs_m)),
            ("k_n_N_per_m_per_point", number(&self.leg_stiffness)),
            ("c_n_Ns_per_m_per_point", number(&self.leg_damping)),
            ("mu", number(&self.friction)),
            ("friction_regularisation_mps", number(&self.friction_full_mps)),
            ("rotor_radius_m", number(&self.rotor_radius_m)),
            ("imu_position_m", vector(&self.imu_position_m)),
            ("battery.cells", battery.cells.to_string()),
            ("battery.nominal_v", number(&battery.nominal_v)),
            ("battery.resistance_ohm", number(&battery.resistance_ohm)),
            ("battery.capacity_ah", number(&battery.capacity_ah)),
        ];
        lines.iter().map(|(key, value)| format!("{key} = {value}\n")).collect()
    }
}

fn list(values: impl Iterator<Item = String>) -> String {
    format!("[{}]", values.collect::<Vec<_>>().join(", "))
}

fn vector(vector: &Vector3<f64>) -> String {
    list(vector.iter().map(number))
}

/// Returns the shortest text that gives the same number again.
fn number(value: &f64) -> String {
    format!("{value:?}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_built_in_airframe_is_read_as_it_was_written() {
        for airframe in [Airframe::iris(), Airframe::five_inch()] {
            assert_eq!(Airframe::from_toml(&airframe.to_toml()), Ok(airframe));
        }
    }

    proptest! {
        #[test]
        fn every_number_is_read_to_the_last_bit(scale in 0.8..1.2_f64, name in "[ -~]{1,20}") {
            let iris = Airframe::iris();
            let airframe = Airframe {
                name,
                mass_kg: iris.mass_kg * scale,
                thrust_coeff: iris.thrust_coeff * scale,
                inertia_kgm2: iris.inertia_kgm2 * scale,
                imu_position_m: Vector3::new(scale / 100.0, 0.0, -0.0),
                legs_m: iris.legs_m.iter().map(|leg| leg * scale).collect(),
                ..iris
            };
            prop_assume!(airframe.fault(0.001).is_none());
            prop_assert_eq!(Airframe::from_toml(&airframe.to_toml()), Ok(airframe));
        }
    }
}
