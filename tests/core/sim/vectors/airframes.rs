//! The built-in airframes equal those of the vectors.

use betadeck_core::sim::{Airframe, BUILTIN_NAMES};
use nalgebra::Vector3;

use crate::sim::vectors::{near, num, rows, section, vec3};

#[test]
fn the_built_in_airframes_have_the_published_constants() {
    let airframes = section("airframes");
    assert_eq!(airframes.as_object().expect("a table").len(), BUILTIN_NAMES.len());
    for name in BUILTIN_NAMES {
        let (got, want): (Airframe, _) = (name.parse().expect("built in"), &airframes[name]);
        let vectors = |key: &str| rows(&want[key]).iter().map(vec3).collect::<Vec<Vector3<f64>>>();
        assert_eq!(got.mass_kg, num(&want["mass_kg"]));
        assert_eq!(got.inertia_kgm2, vec3(&want["inertia_kgm2"]));
        assert_eq!(got.rotor_positions_m[..], vectors("rotor_pos_m_M1_to_M4_flu_from_com"));
        let spin: Vec<f64> = rows(&want["spin_sign_ccw_positive"]).iter().map(num).collect();
        assert_eq!(got.spin_sign[..], spin);
        assert_eq!(got.thrust_coeff, num(&want["k_t_N_per_rad2s2"]));
        assert_eq!(got.torque_per_thrust_m, num(&want["kappa_m_torque_over_thrust"]));
        assert_eq!(got.rotor_inertia_kgm2, num(&want["j_rotor_kgm2"]));
        assert_eq!(got.inflow_coeff, num(&want["k_z_inflow_kg_per_rad"]));
        assert_eq!(got.rotor_drag_coeff, num(&want["k_d_rotor_drag_kg_per_rad"]));
        assert_eq!(got.body_drag, vec3(&want["c_par_N_per_m2s2"]));
        assert_eq!(got.angular_damping, vec3(&want["k_w_Nm_per_rads"]));
        assert_eq!(got.rotor_speed_max, num(&want["omega_max_rads"]));
        assert_eq!(got.motor_tau_up_s, num(&want["tau_up_s"]));
        assert_eq!(got.motor_tau_down_s, num(&want["tau_down_s"]));
        assert_eq!(got.legs_m[..], vectors("contact_points_m_flu_from_com"));
        assert_eq!(got.leg_stiffness, num(&want["k_n_N_per_m_per_point"]));
        assert_eq!(got.leg_damping, num(&want["c_n_Ns_per_m_per_point"]));
        assert_eq!(got.friction, num(&want["mu"]));
        assert_eq!(got.friction_full_mps, num(&want["friction_regularisation_mps"]));
        let derived = &want["derived"];
        near(got.hover_rotor_speed(), num(&derived["omega_hover"]), 1e-9);
        near(got.hover_rotor_speed() / got.rotor_speed_max, num(&derived["u_hover"]), 1e-9);
        near(got.thrust_to_weight(), num(&derived["thrust_to_weight"]), 1e-9);
    }
}
