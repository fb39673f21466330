//! PHY-01 … PHY-19: closed forms and a reference trajectory of the whole plant.

use betadeck_core::sim::{
    Airframe, BodyState, attitude, ground_effect_factor, level_attitude, lever_arm_acceleration,
    motor_power_w,
};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::sim::vectors::stand::{Stand, symmetric, without_drag};
use crate::sim::vectors::{close, close3, near, num, physics, rows, vec3};

const H: f64 = 0.001;
const G: f64 = 9.806_65;

fn quaternion(value: &serde_json::Value) -> Quaternion<f64> {
    let q = rows(value);
    Quaternion::new(num(&q[0]), num(&q[1]), num(&q[2]), num(&q[3]))
}

#[track_caller]
fn close_q(got: &UnitQuaternion<f64>, want: Quaternion<f64>, tolerance: f64) {
    let off = (got.coords - want.coords).amax().min((got.coords + want.coords).amax());
    assert!(off <= tolerance, "{got:?} instead of {want:?}");
}

#[test]
fn phy_01_hover_is_an_equilibrium() {
    let expect = &physics("PHY-01")["expect"];
    for (airframe, want) in
        [(Airframe::iris(), &expect["iris"]), (Airframe::five_inch(), &expect["five_inch"])]
    {
        let speed = airframe.hover_rotor_speed();
        near(speed, num(&want["omega_hover"]), 1e-9);
        let hover = speed / airframe.rotor_speed_max;
        near(hover, num(&want["u_hover"]), 1e-9);
        near(airframe.thrust_coeff * speed * speed, num(&want["thrust_per_rotor_N"]), 1e-9);
        let most = 4.0 * airframe.thrust_coeff * airframe.rotor_speed_max.powi(2);
        near(most, num(&want["max_total_thrust_N"]), 1e-9);
        near(airframe.thrust_to_weight(), num(&want["thrust_to_weight"]), 1e-9);
        let mut stand = Stand::new(airframe, 50.0, H);
        stand.rotors = [speed; 4];
        stand.command([hover; 4]);
        let start = stand.body;
        stand.run(10.0);
        close3(stand.body.pos_enu, start.pos_enu, 1e-6);
    }
}

#[test]
fn phy_02_free_fall() {
    let expect = &physics("PHY-02")["expect"];
    let mut stand = Stand::new(without_drag(Airframe::five_inch()), 100.0, H);
    stand.run(2.0);
    close(stand.body.pos_enu.z, num(&expect["z"]), 1e-9);
    close(stand.body.vel_enu.z, num(&expect["vz"]), 1e-9);
    close3(stand.specific_force(), vec3(&expect["specific_force"]), 0.0);
}

#[test]
fn phy_03_fall_with_drag() {
    let expect = &physics("PHY-03")["expect"];
    let mut stand = Stand::new(Airframe::iris(), 1000.0, H);
    let mut t = 0.0;
    for row in rows(&expect["rows"]) {
        stand.run(num(&row["t"]) - t);
        t = num(&row["t"]);
        close(stand.body.vel_enu.z, num(&row["vz"]), 1e-6);
        close(stand.body.pos_enu.z, num(&row["z"]), 1e-5);
    }
    stand.run(20.0);
    close(-stand.body.vel_enu.z, num(&expect["terminal_velocity"]), 1e-6);
}

#[test]
fn phy_04_a_tilt_accelerates_by_its_tangent() {
    let expect = &physics("PHY-04")["expect"];
    let mut stand = Stand::new(without_drag(Airframe::iris()), 50.0, H);
    stand.body.attitude = attitude(30.0, -15.0, 0.0);
    near(stand.airframe.rotor_speed_max * num(&expect["u"]), num(&expect["omega_rotor"]), 1e-9);
    stand.hold_rotors([num(&expect["omega_rotor"]); 4]);
    close3(stand.specific_force(), vec3(&expect["specific_force_flu"]), 1e-9);
    stand.run(2.0);
    close3(stand.body.vel_enu, vec3(&expect["vel_enu"]), 1e-8);
    let moved = stand.body.pos_enu - Vector3::new(0.0, 0.0, 50.0);
    close3(moved, vec3(&expect["pos_delta_enu"]), 1e-8);
    near(stand.body.vel_enu.norm() / 2.0, num(&expect["acc_horizontal"]), 1e-8);
}

#[test]
fn phy_05_steady_speed_at_a_held_tilt() {
    let expect = &physics("PHY-05")["expect"];
    for (airframe, table) in [(Airframe::iris(), "iris"), (Airframe::five_inch(), "five_inch")] {
        for row in rows(&expect[table]) {
            let mut stand = Stand::new(symmetric(airframe.clone(), true), 500.0, H);
            stand.body.attitude = attitude(70.0, -num(&row["nose_down_deg"]), 0.0);
            near(airframe.rotor_speed_max * num(&row["u"]), num(&row["omega_rotor"]), 1e-6);
            stand.hold_rotors([num(&row["omega_rotor"]); 4]);
            stand.run(60.0);
            close(stand.body.vel_enu.xy().norm(), num(&row["speed"]), 1e-4);
            close(stand.body.vel_enu.z, 0.0, 1e-4);
        }
    }
}

#[test]
fn phy_06_drift_in_the_wind() {
    let expect = &physics("PHY-06")["expect"];
    let mut airframe = Airframe::iris();
    airframe.body_drag = Vector3::zeros();
    airframe.inflow_coeff = 0.0;
    // Rotors in the plane of the centre of mass, so that their drag does not tilt the craft.
    let mut stand = Stand::new(symmetric(airframe, true), 50.0, H);
    let speed = stand.airframe.hover_rotor_speed();
    stand.hold_rotors([speed; 4]);
    stand.air.wind_enu.x = 5.0;
    let rate = stand.loads().force_flu.xy().norm() / 5.0 / stand.airframe.mass_kg;
    near(rate, num(&expect["rate_1_s"]), 1e-9);
    let mut t = 0.0;
    for row in rows(&expect["rows"]) {
        stand.run(num(&row["t"]) - t);
        t = num(&row["t"]);
        close(stand.body.vel_enu.x, num(&row["ve"]), 1e-7);
        close(stand.body.pos_enu.x, num(&row["pe"]), 1e-6);
    }
}

#[test]
fn phy_07_a_speed_difference_yaws() {
    let expect = &physics("PHY-07")["expect"];
    // With the iris' own rotor places the difference would also roll.
    let mut stand = Stand::new(symmetric(Airframe::iris(), false), 50.0, H);
    stand.hold_rotors([360.0, 339.263_813_322, 339.263_813_322, 360.0]);
    let loads = stand.loads();
    near(loads.force_flu.z, num(&expect["total_thrust_N"]), 1e-9);
    close(loads.torque_flu.z, num(&expect["yaw_torque_Nm"]), 1e-6);
    close(loads.torque_flu.z / stand.airframe.inertia_kgm2.z, num(&expect["initial_yaw_acc"]), 1e-6);
    let mut t = 0.0;
    for row in rows(&expect["rows"]) {
        stand.run(num(&row["t"]) - t);
        t = num(&row["t"]);
        close(stand.body.rate_flu.z, num(&row["omega_z"]), 1e-6);
        let nose = stand.body.attitude * Vector3::x();
        let heading = nose.x.atan2(nose.y).to_degrees().rem_euclid(360.0);
        close(heading, num(&row["heading_deg"]), 1e-4);
        close(360.0 - heading, num(&row["yaw_ccw_deg"]), 1e-4);
    }
}

#[test]
fn phy_08_rotors_and_body_share_angular_momentum() {
    let expect = &physics("PHY-08")["expect"];
    let mut airframe = symmetric(without_drag(Airframe::iris()), false);
    airframe.torque_per_thrust_m = 0.0;
    let mut stand = Stand::new(airframe, 50.0, H);
    let hover = stand.airframe.hover_rotor_speed();
    stand.rotors = [hover; 4];
    stand.target = [hover + 50.0, hover - 50.0, hover - 50.0, hover + 50.0];
    let momentum = |stand: &Stand| {
        let spin: f64 = stand.airframe.spin_sign.iter().zip(&stand.rotors).map(|(s, speed)| s * speed).sum();
        stand.airframe.inertia_kgm2.z * stand.body.rate_flu.z + stand.airframe.rotor_inertia_kgm2 * spin
    };
    let start = momentum(&stand);
    let scale = 4.0 * stand.airframe.rotor_inertia_kgm2 * hover;
    for _ in 0..500 {
        stand.step();
        close(momentum(&stand), start, 1e-9 * scale);
    }
    close(stand.body.rate_flu.z, num(&expect["omega_z_final"]), 1e-6);
}

#[test]
fn phy_09_motor_lag() {
    let expect = &physics("PHY-09")["expect"];
    for (airframe, table, from, to) in [
        (Airframe::iris(), "iris_0_to_1", 0.0, 1.0),
        (Airframe::five_inch(), "five_inch_up_0_to_0p5", 0.0, 0.5),
        (Airframe::five_inch(), "five_inch_down_from_0p5_to_0", 0.5, 0.0),
    ] {
        for row in rows(&expect[table]) {
            let t = num(&row["t"]);
            let steps = (t / H).round();
            // The step is stretched a little where the time is not a multiple of a millisecond.
            let mut stand = Stand::new(airframe.clone(), 100.0, t / steps);
            stand.rotors = [from * airframe.rotor_speed_max; 4];
            stand.command([to; 4]);
            stand.run(t);
            near(stand.rotors[2], num(&row["omega"]), 1e-6);
        }
    }
}

fn spinning(inertia: Vector3<f64>, rate: Vector3<f64>) -> Stand {
    let mut airframe = without_drag(Airframe::iris());
    airframe.inertia_kgm2 = inertia;
    let mut stand = Stand::new(airframe, 5000.0, H);
    stand.body.rate_flu = rate;
    stand.body.attitude = UnitQuaternion::identity();
    stand
}

#[test]
fn phy_10_tumbling_keeps_energy_and_momentum() {
    let expect = &physics("PHY-10")["expect"];
    let inertia = Airframe::iris().inertia_kgm2;
    let mut stand = spinning(inertia, Vector3::new(3.0, -2.0, 5.0));
    let energy = |b: &BodyState| 0.5 * inertia.dot(&b.rate_flu.component_mul(&b.rate_flu));
    let momentum = |b: &BodyState| b.attitude * inertia.component_mul(&b.rate_flu);
    near(energy(&stand.body), num(&expect["kinetic_energy_J"]), 1e-12);
    stand.run(2.0);
    close3(stand.body.rate_flu, vec3(&expect["omega_at_2s"]), 1e-6);
    close_q(&stand.body.attitude, quaternion(&expect["q_wxyz_at_2s"]), 1e-6);
    stand.run(8.0);
    near(energy(&stand.body), num(&expect["kinetic_energy_J"]), 1e-9);
    let want = vec3(&expect["angular_momentum_world"]);
    close3(momentum(&stand.body), want, 1e-9 * want.norm());
    close(stand.body.attitude.norm(), 1.0, 1e-12);
}

#[test]
fn phy_10b_a_symmetric_top_precesses() {
    let expect = &physics("PHY-10b")["expect"];
    let (inertia, rate) = (Vector3::new(0.006, 0.006, 0.010), Vector3::new(1.0, 0.0, 4.0));
    let mut stand = spinning(inertia, rate);
    stand.run(1.0);
    close3(stand.body.rate_flu, vec3(&expect["omega_at_1s"]), 1e-8);
    let turned = stand.body.rate_flu.y.atan2(stand.body.rate_flu.x);
    close(turned, num(&expect["precession_rate"]), 1e-8);
}

#[test]
fn phy_11_a_constant_rate_turns_the_attitude() {
    let expect = &physics("PHY-11")["expect"];
    let mut stand = spinning(Vector3::repeat(0.01), Vector3::new(0.3, -0.4, 1.2));
    stand.run(2.0);
    close_q(&stand.body.attitude, quaternion(&expect["q_wxyz"]), 1e-9);
}

#[test]
fn phy_12_left_mirrors_right() {
    let u: Vec<f64> = rows(&physics("PHY-12")["expect"]["example_u"]).iter().map(num).collect();
    let fly = |u: [f64; 4]| {
        let mut stand = Stand::new(symmetric(Airframe::iris(), false), 50.0, H);
        stand.body.attitude = UnitQuaternion::identity();
        stand.rotors = [stand.airframe.hover_rotor_speed(); 4];
        stand.command(u);
        stand.run(1.0);
        stand.body
    };
    let (a, b) = (fly([u[0], u[1], u[2], u[3]]), fly([u[2], u[3], u[0], u[1]]));
    let mirror = Vector3::new(1.0, -1.0, 1.0);
    close3(a.pos_enu, b.pos_enu.component_mul(&mirror), 1e-9);
    close3(a.vel_enu, b.vel_enu.component_mul(&mirror), 1e-9);
    close3(a.rate_flu, -b.rate_flu.component_mul(&mirror), 1e-9);
    assert!(a.rate_flu.norm() > 0.1, "something moved");
}

/// Returns the start of PHY-13 with a step of `h`.
fn reference_flight(h: f64) -> Stand {
    let mut stand = Stand::new(Airframe::iris(), 50.0, h);
    stand.body.vel_enu = Vector3::new(1.0, 2.0, -0.5);
    stand.body.attitude = attitude(20.0, -5.0, -3.0);
    stand.body.rate_flu = Vector3::new(0.1, -0.2, 0.3);
    stand.rotors = [stand.airframe.hover_rotor_speed(); 4];
    stand.air.wind_enu = Vector3::new(2.0, -1.0, 0.5);
    stand.command([0.52, 0.50, 0.51, 0.505]);
    stand
}

#[test]
fn phy_13_reference_flight() {
    let expect = &physics("PHY-13")["expect"];
    let mut stand = reference_flight(H);
    close_q(&stand.body.attitude, quaternion(&expect["q0_wxyz"]), 1e-12);
    stand.run(1.0);
    close3(stand.body.pos_enu, vec3(&expect["p"]), 1e-7);
    close3(stand.body.vel_enu, vec3(&expect["v"]), 1e-6);
    close_q(&stand.body.attitude, quaternion(&expect["q_wxyz"]), 1e-7);
    close3(stand.body.rate_flu, vec3(&expect["omega"]), 1e-6);
    for (got, want) in stand.rotors.iter().zip(rows(&expect["rotor"])) {
        close(*got, num(want), 1e-4);
    }
}

#[test]
fn phy_13_the_integrator_is_of_fourth_order() {
    let end = |h| {
        let mut stand = reference_flight(h);
        stand.run(1.0);
        stand.body
    };
    let exact = end(0.0002);
    let error = |h| {
        let body = end(h);
        ((body.pos_enu - exact.pos_enu).norm_squared()
            + (body.vel_enu - exact.vel_enu).norm_squared()
            + (body.rate_flu - exact.rate_flu).norm_squared()
            + (body.attitude.coords - exact.attitude.coords).norm_squared())
        .sqrt()
    };
    let ratio = error(0.010) / error(0.005);
    assert!(ratio >= 12.0, "halving the step divides the error by {ratio}");
}

#[test]
fn phy_14_a_craft_at_rest_is_quiet() {
    let expect = &physics("PHY-14")["expect"];
    let mut stand = Stand::new(Airframe::iris(), 0.25, H);
    stand.run(3.0);
    close(stand.body.pos_enu.z, num(&expect["z_com"]), 1e-5);
    let lowest = stand.airframe.legs_m[0].z;
    close(-(stand.body.pos_enu.z + lowest), num(&expect["compression_m"]), 1e-5);
    close3(stand.specific_force(), vec3(&expect["specific_force_flu"]), 1e-3);
    close(stand.body.vel_enu.norm(), num(&expect["speed"]), 1e-5);
    close(stand.airframe.standing_height_m(), num(&expect["z_com"]), 1e-9);
}

#[test]
fn phy_15_a_touchdown_spikes() {
    for row in rows(&physics("PHY-15")["expect"]["rows"]) {
        let mut stand = Stand::new(Airframe::iris(), 0.19934, H);
        stand.body.vel_enu.z = -num(&row["sink_rate"]);
        let (mut peak, mut at) = (0.0, 0.0);
        for step in 1..=50 {
            stand.step();
            let force = stand.specific_force().z;
            if force > peak {
                (peak, at) = (force, f64::from(step) * H);
            }
        }
        near(peak, num(&row["peak_specific_force_z"]), 0.02);
        close(at, num(&row["peak_time_s"]), 2.0 * H);
    }
}

#[test]
fn phy_16_sliding_stops() {
    let expect = &physics("PHY-16")["expect"];
    let airframe = Airframe::iris();
    let height = airframe.standing_height_m();
    let mut stand = Stand::new(airframe, height, H);
    stand.body.attitude = level_attitude(90.0);
    stand.body.vel_enu.x = 2.0;
    stand.run(1.5);
    near(stand.body.pos_enu.x, num(&expect["model_distance_at_1p5s_m"]), 0.08);
    near(num(&expect["ideal_stop_distance_m"]), 4.0 / (2.0 * G), 1e-12);
    close(stand.body.vel_enu.norm(), num(&expect["model_speed_at_1p5s"]), 0.02);
}

#[test]
fn phy_17_battery_under_load() {
    let expect = &physics("PHY-17")["expect"];
    let airframe = Airframe::iris();
    for (speed, table) in
        [(airframe.hover_rotor_speed(), "hover"), (airframe.rotor_speed_max, "full_throttle_nominal_speed")]
    {
        let want = &expect[table];
        let power = motor_power_w(&airframe, &[speed; 4], &[1.0; 4]);
        near(power, num(&want["elec_W"]), 1e-6);
        if table == "hover" {
            near(power * 0.75, num(&want["mech_W"]), 1e-6);
        }
        let (volts, amps) = airframe.battery.under_load(11.55, power);
        near(volts, num(&want["volts"]), 1e-6);
        near(amps, num(&want["amps"]), 1e-6);
    }
}

#[test]
fn phy_18_ground_effect() {
    for row in rows(&physics("PHY-18")["expect"]["rows"]) {
        near(ground_effect_factor(0.10, num(&row["z"])), num(&row["factor"]), 1e-9);
    }
    let mut stand = Stand::new(symmetric(Airframe::iris(), true), 0.21, H);
    let speed = stand.airframe.hover_rotor_speed();
    stand.hold_rotors([speed; 4]);
    let free = stand.loads().force_flu.z;
    stand.plant.set_ground_effect(Some(0.10));
    near(stand.loads().force_flu.z / free, ground_effect_factor(0.10, 0.21), 1e-9);
}

#[test]
fn phy_19_accelerometer_lever_arm() {
    let extra = lever_arm_acceleration(
        Vector3::new(0.5, -1.0, 2.0),
        Vector3::new(3.0, 1.0, -2.0),
        Vector3::new(0.03, -0.02, 0.01),
    );
    close3(extra, vec3(&physics("PHY-19")["expect"]["extra"]), 1e-12);
}

/// Every check of the vectors has a test above.
#[test]
fn no_check_is_left_out() {
    let mut ids: Vec<String> = rows(&crate::sim::vectors::section("physics"))
        .iter()
        .map(|check| check["id"].as_str().expect("an id").to_lowercase().replace('-', "_"))
        .collect();
    ids.sort();
    let here = include_str!("physics.rs");
    for id in &ids {
        assert!(here.contains(&format!("fn {id}_")), "{id} has no test");
    }
    assert_eq!(ids.len(), 20);
}
