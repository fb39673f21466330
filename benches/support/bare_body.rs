//! A bare rigid body: four evaluations of thrust, Newton, Euler and the quaternion equation per step of Runge–Kutta, and
//! nothing else. It is a measure of the machine for the plant and for the whole vehicle.

use std::hint::black_box;
use std::time::Instant;

use betadeck::sim::Airframe;
use nalgebra::{Quaternion, Vector3};

/// The state of the bare loop: position, velocity, attitude, body rates.
#[derive(Clone, Copy)]
struct Bare {
    p: Vector3<f64>,
    v: Vector3<f64>,
    q: Quaternion<f64>,
    w: Vector3<f64>,
}

/// Returns the nanoseconds per step over this many steps.
pub(crate) fn ns_per_step(steps: u32) -> f64 {
    let airframe = Airframe::iris();
    let h = 0.001;
    let mut state =
        Bare { p: Vector3::zeros(), v: Vector3::zeros(), q: Quaternion::identity(), w: Vector3::zeros() };
    let speed = airframe.hover_rotor_speed();
    let start = Instant::now();
    for step in 0..steps {
        let wobble = if step & 64 == 0 { 0.1 } else { -0.1 };
        let speeds = black_box([speed + wobble, speed - wobble, speed - wobble, speed + wobble]);
        let k1 = bare_slope(&airframe, &state, &speeds);
        let k2 = bare_slope(&airframe, &bare_along(&state, &k1, 0.5 * h), &speeds);
        let k3 = bare_slope(&airframe, &bare_along(&state, &k2, 0.5 * h), &speeds);
        let k4 = bare_slope(&airframe, &bare_along(&state, &k3, h), &speeds);
        for (slope, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            state = bare_along(&state, &slope, weight * h / 6.0);
        }
        state.q /= state.q.norm();
    }
    let time = start.elapsed().as_secs_f64() * 1e9 / f64::from(steps);
    black_box(state.p);
    time
}

fn bare_along(state: &Bare, slope: &Bare, dt: f64) -> Bare {
    Bare {
        p: state.p + slope.p * dt,
        v: state.v + slope.v * dt,
        q: state.q + slope.q * dt,
        w: state.w + slope.w * dt,
    }
}

fn bare_slope(airframe: &Airframe, state: &Bare, speeds: &[f64; 4]) -> Bare {
    let mut thrust = 0.0;
    let mut torque = Vector3::zeros();
    let rotors = airframe.rotor_positions_m.iter().zip(&airframe.spin_sign).zip(speeds);
    for ((arm, spin), speed) in rotors {
        let t = airframe.thrust_coeff * speed * speed;
        thrust += t;
        torque.x += arm.y * t;
        torque.y -= arm.x * t;
        torque.z -= spin * airframe.torque_per_thrust_m * t;
    }
    let q = &state.q;
    let up = Vector3::new(
        2.0 * (q.i * q.k + q.w * q.j),
        2.0 * (q.j * q.k - q.w * q.i),
        1.0 - 2.0 * (q.i * q.i + q.j * q.j),
    );
    let j = &airframe.inertia_kgm2;
    let momentum = j.component_mul(&state.w);
    Bare {
        p: state.v,
        v: up * (thrust / airframe.mass_kg) - Vector3::z() * 9.806_65,
        q: state.q * Quaternion::from_imag(state.w * 0.5),
        w: (torque - state.w.cross(&momentum)).component_div(j),
    }
}
