//! The rigid body and its loads: rotors, drag, ground, gravity.
//!
//! With the air-relative velocity `va = Rᵀ(v − w)` in body axes, rotor speeds Ω, spin signs s, efficiencies e and the
//! density ratio ρ (thrust after momentum theory's first-order inflow loss, in-plane drag linear in Ω and airspeed,
//! quadratic body drag by axis):
//!
//! ```text
//! Tᵢ = ρ·eᵢ·max(0, kT·Ωᵢ² − kz·Ωᵢ·va_z)
//! Fᵢ = (−ρ·kd·Ωᵢ·va_x, −ρ·kd·Ωᵢ·va_y, Tᵢ)
//! F  = Σ Fᵢ − ρ·c∘|va|∘va + ground
//! τ  = Σ rᵢ × Fᵢ − Σ sᵢ(ρ·κ·kT·Ωᵢ²·eᵢ + Jr·Ω̇ᵢ)·ẑ − kw∘ω + ground
//! ṗ = v    v̇ = R·F/m − g·ẑ    q̇ = ½·q⊗(0, ω)    ω̇ = J⁻¹(τ − ω × (J·ω + Σ sᵢ·Jr·Ωᵢ·ẑ))
//! ```

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::geo::GRAVITY;

use super::airframe::{Airframe, ROTORS};
use super::body::{AirSample, BodyState, Loads, Slope, Stage, rotation};
use super::ground::{ContactAnchors, Ground};
use super::landform::Landform;
use super::motors::{Motors, RotorSweep};

/// The constants of the equations of motion, computed for one step size.
#[derive(Debug, Clone)]
pub struct Plant {
    h: f64,
    mass: f64,
    inertia: Vector3<f64>,
    inertia_inv: Vector3<f64>,
    rotor_x: [f64; ROTORS],
    rotor_y: [f64; ROTORS],
    rotor_z: [f64; ROTORS],
    spin: [f64; ROTORS],
    thrust_coeff: f64,
    torque_per_thrust: f64,
    rotor_inertia: f64,
    inflow_coeff: f64,
    rotor_drag_coeff: f64,
    body_drag: Vector3<f64>,
    angular_damping: Vector3<f64>,
    efficiency: [f64; ROTORS],
    /// Rotor radius if ground effect is on, m.
    ground_effect_radius: Option<f64>,
    motors: Motors,
    ground: Ground,
}

impl Plant {
    /// Returns the plant of an airframe with steps of `h` seconds, undamaged and without payload.
    pub fn new(airframe: &Airframe, h: f64) -> Self {
        let rotors = &airframe.rotor_positions_m;
        Self {
            h,
            mass: airframe.mass_kg,
            inertia: airframe.inertia_kgm2,
            inertia_inv: airframe.inertia_kgm2.map(f64::recip),
            rotor_x: rotors.map(|r| r.x),
            rotor_y: rotors.map(|r| r.y),
            rotor_z: rotors.map(|r| r.z),
            spin: airframe.spin_sign,
            thrust_coeff: airframe.thrust_coeff,
            torque_per_thrust: airframe.torque_per_thrust_m,
            rotor_inertia: airframe.rotor_inertia_kgm2,
            inflow_coeff: airframe.inflow_coeff,
            rotor_drag_coeff: airframe.rotor_drag_coeff,
            body_drag: airframe.body_drag,
            angular_damping: airframe.angular_damping,
            efficiency: [1.0; ROTORS],
            ground_effect_radius: None,
            motors: Motors::new(airframe, h),
            ground: Ground::new(airframe),
        }
    }

    /// Sets the thrust efficiency of each rotor, 0…1.
    pub fn set_efficiency(&mut self, efficiency: [f64; ROTORS]) {
        self.efficiency = efficiency;
    }

    /// Returns the thrust efficiency of each rotor, 0…1.
    pub fn efficiency(&self) -> &[f64; ROTORS] {
        &self.efficiency
    }

    /// Switches the thrust gain near the ground on, for rotors with the given radius (m), or off.
    pub fn set_ground_effect(&mut self, rotor_radius_m: Option<f64>) {
        self.ground_effect_radius = rotor_radius_m;
    }

    /// Sets the shape of the ground.
    pub(super) fn set_landform(&mut self, landform: Landform) {
        self.ground.set_landform(landform);
    }

    /// Hangs a point mass (kg) `depth_m` below the centre of mass. It replaces any earlier one. The model keeps the
    /// centre of mass at its place.
    pub fn set_payload(&mut self, airframe: &Airframe, payload_kg: f64, depth_m: f64) {
        let swing = payload_kg * depth_m * depth_m;
        self.mass = airframe.mass_kg + payload_kg;
        self.inertia = airframe.inertia_kgm2 + Vector3::new(swing, swing, 0.0);
        self.inertia_inv = self.inertia.map(f64::recip);
    }

    /// Returns the mass with payload, kg.
    pub fn mass_kg(&self) -> f64 {
        self.mass
    }

    /// Returns the model of the legs and the hull.
    pub fn ground(&self) -> &Ground {
        &self.ground
    }

    /// Returns the loads in a state of the craft, for the accelerometer and as the first stage of the next step.
    pub fn loads(
        &self,
        state: &BodyState,
        rotors: &[f64; ROTORS],
        air: &AirSample,
        anchors: &ContactAnchors,
    ) -> Loads {
        let stage = Stage::from(state);
        self.stage_loads(&stage, &rotation(&stage.q), rotors, air, anchors)
    }

    /// Makes one step of classical Runge–Kutta with constant motor targets (rad/s) and air. `first` are the loads in
    /// the present state. The contact anchors are latched or freed after the step.
    pub fn step(
        &self,
        state: &mut BodyState,
        rotors: &mut [f64; ROTORS],
        anchors: &mut ContactAnchors,
        target: &[f64; ROTORS],
        air: &AirSample,
        first: &Loads,
    ) {
        let h = self.h;
        let sweep = self.motors.sweep(rotors, target);
        let start = Stage::from(&*state);
        let k1 = self.slope_from_loads(&start, &rotation(&start.q), &sweep, 0, first);
        let k2 = self.slope(&start.along(&k1, 0.5 * h), &sweep, 1, air, anchors);
        let k3 = self.slope(&start.along(&k2, 0.5 * h), &sweep, 2, air, anchors);
        let k4 = self.slope(&start.along(&k3, h), &sweep, 3, air, anchors);
        let sixth = h / 6.0;
        state.pos_enu += (k1.vel + (k2.vel + k3.vel) * 2.0 + k4.vel) * sixth;
        state.vel_enu += (k1.acc + (k2.acc + k3.acc) * 2.0 + k4.acc) * sixth;
        state.rate_flu += (k1.rate_dot + (k2.rate_dot + k3.rate_dot) * 2.0 + k4.rate_dot) * sixth;
        let q = start.q + (k1.q_dot + (k2.q_dot + k3.q_dot) * 2.0 + k4.q_dot) * sixth;
        state.attitude = UnitQuaternion::new_normalize(q);
        *rotors = sweep.end;
        self.ground.update_anchors(state, anchors);
    }

    fn slope(
        &self,
        stage: &Stage,
        sweep: &RotorSweep,
        index: usize,
        air: &AirSample,
        anchors: &ContactAnchors,
    ) -> Slope {
        let r = rotation(&stage.q);
        let loads = self.stage_loads(stage, &r, &sweep.speed[index], air, anchors);
        self.slope_from_loads(stage, &r, sweep, index, &loads)
    }

    fn slope_from_loads(
        &self,
        stage: &Stage,
        r: &Matrix3<f64>,
        sweep: &RotorSweep,
        index: usize,
        loads: &Loads,
    ) -> Slope {
        let mut spin_momentum = 0.0;
        let mut reaction = 0.0;
        for i in 0..ROTORS {
            spin_momentum += self.spin[i] * sweep.speed[index][i];
            reaction += self.spin[i] * sweep.acceleration[index][i];
        }
        let w = stage.rate;
        let mut momentum = self.inertia.component_mul(&w);
        momentum.z += self.rotor_inertia * spin_momentum;
        let mut torque = loads.torque_flu - w.cross(&momentum);
        torque.z -= self.rotor_inertia * reaction;
        let mut acc = r * loads.force_flu / self.mass;
        acc.z -= GRAVITY;
        Slope {
            vel: stage.vel,
            acc,
            q_dot: stage.q * Quaternion::new(0.0, 0.5 * w.x, 0.5 * w.y, 0.5 * w.z),
            rate_dot: self.inertia_inv.component_mul(&torque),
        }
    }

    fn stage_loads(
        &self,
        stage: &Stage,
        r: &Matrix3<f64>,
        rotors: &[f64; ROTORS],
        air: &AirSample,
        anchors: &ContactAnchors,
    ) -> Loads {
        let va = r.tr_mul(&(stage.vel - air.wind_enu));
        let rho = air.density_ratio;
        let plane = self.ground.landform().tangent_at(&stage.pos);
        let height_m = plane.distance_m(&stage.pos);
        let boost = self.ground_effect(height_m, &r.tr_mul(plane.normal()));
        // The sums over the rotors of thrust, speed and their moments.
        let (mut thrust, mut thrust_x, mut thrust_y, mut drag_torque) = (0.0, 0.0, 0.0, 0.0);
        let (mut speed, mut speed_x, mut speed_y, mut speed_z) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..ROTORS {
            let omega = rotors[i];
            let static_thrust = self.thrust_coeff * omega * omega;
            let scale = rho * self.efficiency[i];
            let t = (static_thrust - self.inflow_coeff * omega * va.z).max(0.0) * scale * boost[i];
            thrust += t;
            thrust_x += t * self.rotor_x[i];
            thrust_y += t * self.rotor_y[i];
            drag_torque += self.spin[i] * static_thrust * scale;
            speed += omega;
            speed_x += omega * self.rotor_x[i];
            speed_y += omega * self.rotor_y[i];
            speed_z += omega * self.rotor_z[i];
        }
        let in_plane = -rho * self.rotor_drag_coeff;
        let mut force = -rho * self.body_drag.component_mul(&va.abs()).component_mul(&va);
        force.x += in_plane * va.x * speed;
        force.y += in_plane * va.y * speed;
        force.z += thrust;
        let mut torque = -self.angular_damping.component_mul(&stage.rate);
        torque.x += thrust_y - in_plane * va.y * speed_z;
        torque.y += in_plane * va.x * speed_z - thrust_x;
        torque.z += in_plane * (va.y * speed_x - va.x * speed_y) - self.torque_per_thrust * drag_torque;
        if height_m < self.ground.reach_m() {
            let contact = self.ground.loads(&stage.pos, &stage.vel, r, &stage.rate, anchors);
            force += contact.force_flu;
            torque += contact.torque_flu;
        }
        Loads { force_flu: force, torque_flu: torque }
    }

    /// Returns the thrust gain of each rotor from the ground below it. The centre of mass is `height_m` above the
    /// ground, whose normal in body axes is `up`.
    fn ground_effect(&self, height_m: f64, up: &Vector3<f64>) -> [f64; ROTORS] {
        let Some(radius) = self.ground_effect_radius else { return [1.0; ROTORS] };
        std::array::from_fn(|i| {
            let hub = Vector3::new(self.rotor_x[i], self.rotor_y[i], self.rotor_z[i]);
            ground_effect_factor(radius, height_m + up.dot(&hub))
        })
    }
}

/// Returns the thrust near the ground over the thrust far from it, after Cheeseman and Bennett: 1/(1 − (R/4z)²), for
/// a rotor of radius R at height z (m), where z is at least R/2.
pub fn ground_effect_factor(rotor_radius_m: f64, height_m: f64) -> f64 {
    let ratio = rotor_radius_m / (4.0 * height_m.max(0.5 * rotor_radius_m));
    1.0 / (1.0 - ratio * ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::ground::NO_ANCHORS;

    /// The step of the integrator, s.
    const H: f64 = 0.002;

    /// Returns a level craft at rest far above the ground.
    fn aloft() -> BodyState {
        BodyState {
            pos_enu: Vector3::new(0.0, 0.0, 1000.0),
            vel_enu: Vector3::zeros(),
            attitude: UnitQuaternion::identity(),
            rate_flu: Vector3::zeros(),
        }
    }

    /// Steps a craft whose rotors speed up or slow down to `target`, rad/s.
    fn run(
        plant: &Plant,
        state: &mut BodyState,
        rotors: &mut [f64; ROTORS],
        target: [f64; ROTORS],
        air: &AirSample,
        seconds: f64,
    ) {
        let mut anchors = NO_ANCHORS;
        for _ in 0..(seconds / H).round() as usize {
            let loads = plant.loads(state, rotors, air, &anchors);
            plant.step(state, rotors, &mut anchors, &target, air, &loads);
        }
    }

    #[test]
    fn a_tumbling_craft_with_turning_rotors_keeps_its_angular_momentum() {
        // Without thrust and drag nothing turns the craft from outside.
        let airframe = Airframe {
            thrust_coeff: 0.0,
            inflow_coeff: 0.0,
            rotor_drag_coeff: 0.0,
            body_drag: Vector3::zeros(),
            angular_damping: Vector3::zeros(),
            spin_sign: [1.0; ROTORS],
            ..Airframe::iris()
        };
        let plant = Plant::new(&airframe, H);
        let air = AirSample { wind_enu: Vector3::zeros(), density_ratio: 1.0 };
        let momentum = |state: &BodyState, rotors: &[f64; ROTORS]| {
            let spin = airframe.rotor_inertia_kgm2 * rotors.iter().sum::<f64>();
            let body = airframe.inertia_kgm2.component_mul(&state.rate_flu);
            state.attitude * (body + Vector3::new(0.0, 0.0, spin))
        };
        let mut state = BodyState { rate_flu: Vector3::new(2.0, -1.0, 0.5), ..aloft() };
        let mut rotors = [300.0; ROTORS];
        let before = momentum(&state, &rotors);
        run(&plant, &mut state, &mut rotors, [400.0; ROTORS], &air, 1.0);
        let change = (momentum(&state, &rotors) - before).norm() / before.norm();
        assert!(change < 1e-5, "the angular momentum changed by {change}");
    }

    #[test]
    fn thin_air_lets_a_craft_fall_faster_and_carries_it_along_less() {
        let plant = Plant::new(&Airframe::iris(), H);
        let velocity = |density_ratio: f64, seconds: f64| {
            let air = AirSample { wind_enu: Vector3::new(10.0, 0.0, 0.0), density_ratio };
            let mut state = aloft();
            run(&plant, &mut state, &mut [0.0; ROTORS], [0.0; ROTORS], &air, seconds);
            state.vel_enu
        };
        let (dense, thin) = (velocity(1.0, 10.0), velocity(0.5, 10.0));
        // The drag carries the weight at the final speed, and it grows with the square of the speed.
        let ratio = thin.z / dense.z;
        assert!((1.3..1.5).contains(&ratio), "{} and {} m/s", thin.z, dense.z);
        let ratio = velocity(0.5, 0.5).x / velocity(1.0, 0.5).x;
        assert!((0.45..0.6).contains(&ratio), "{ratio} of the drift");
    }
}
