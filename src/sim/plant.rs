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
//! τ  = Σ rᵢ × Fᵢ − Σ sᵢ·ρ·κ·kT·Ωᵢ²·eᵢ·ẑ − kw∘ω + ground
//! L  = J·ω + Σ sᵢ·Jr·Ωᵢ·ẑ
//! ṗ = v    v̇ = R·F/m − g·ẑ    q̇ = ½·q⊗(0, ω)    L̇ = τ − ω × L
//! ```
//!
//! The angular momentum L of body and rotors is integrated instead of the body rates ω. A change of the rotor speeds
//! then turns the body without a torque of its own.
//!
//! The equations are integrated to fourth order. Near the ground that is classical Runge–Kutta (`runge_kutta`), in the
//! air a method that evaluates the loads once a step (`adams`).

use nalgebra::{Matrix3, Vector3};

use crate::geo::GRAVITY;

use super::airframe::{Airframe, ROTORS};
use super::body::{AirSample, BodyState, Loads, rotation};
use super::ground::{ContactAnchors, Ground};
use super::landform::Landform;
use super::motors::Motors;

mod adams;
mod craft;
mod rotors;
mod runge_kutta;

use craft::Trend;
pub use craft::{Craft, Present};
pub use rotors::ground_effect_factor;
use rotors::{RotorSums, Rotors};

/// The distance beyond the reach of the legs at which a craft is in the air, m, and the largest way in a step that keeps
/// it off the ground then, m.
const ALOFT_M: f64 = 1.0;
const MAX_WAY_M: f64 = 0.5;

/// The longest step that is made from the steps before, s: a small part of the lag of the motors. Longer steps are made
/// by Runge–Kutta in the air, too.
const MAX_STEP_S: f64 = 0.001;

/// The constants of the equations of motion, computed for one step size.
#[derive(Debug, Clone)]
pub struct Plant {
    h: f64,
    mass: f64,
    mass_inv: f64,
    inertia: Vector3<f64>,
    inertia_inv: Vector3<f64>,
    rotor_inertia: f64,
    rotors: Rotors,
    body_drag: Vector3<f64>,
    angular_damping: Vector3<f64>,
    motors: Motors,
    ground: Ground,
}

/// A state in which the loads are evaluated.
struct Moment<'a> {
    pos: &'a Vector3<f64>,
    vel: &'a Vector3<f64>,
    rate: &'a Vector3<f64>,
    /// Body → world.
    rotation: &'a Matrix3<f64>,
    rotors: &'a [f64; ROTORS],
    sums: &'a RotorSums,
}

impl Plant {
    /// Returns the plant of an airframe with steps of `h` seconds, undamaged and without payload.
    pub fn new(airframe: &Airframe, h: f64) -> Self {
        Self {
            h,
            mass: airframe.mass_kg,
            mass_inv: airframe.mass_kg.recip(),
            inertia: airframe.inertia_kgm2,
            inertia_inv: airframe.inertia_kgm2.map(f64::recip),
            rotor_inertia: airframe.rotor_inertia_kgm2,
            rotors: Rotors::new(airframe),
            body_drag: airframe.body_drag,
            angular_damping: airframe.angular_damping,
            motors: Motors::new(airframe, h),
            ground: Ground::new(airframe),
        }
    }

    /// Sets the thrust efficiency of each rotor, 0…1.
    pub fn set_efficiency(&mut self, efficiency: [f64; ROTORS]) {
        self.rotors.set_efficiency(efficiency);
    }

    /// Returns the thrust efficiency of each rotor, 0…1.
    pub fn efficiency(&self) -> &[f64; ROTORS] {
        self.rotors.efficiency()
    }

    /// Switches the thrust gain near the ground on, for rotors with the given radius (m), or off.
    pub fn set_ground_effect(&mut self, rotor_radius_m: Option<f64>) {
        self.rotors.set_ground_effect(rotor_radius_m);
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
        self.mass_inv = self.mass.recip();
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

    /// Returns a craft with stopped rotors that friction holds where its legs touch the ground.
    pub fn at_rest(&self, body: BodyState) -> Craft {
        let mut craft = Craft::new(body);
        self.ground.update_anchors(&body, &mut craft.anchors);
        craft
    }

    /// Returns the loads on a craft now, for the accelerometer and for the next step.
    // Inlined, because the result would otherwise be copied through memory in every step.
    #[inline(always)]
    pub fn present(&self, craft: &Craft, air: &AirSample) -> Present {
        let Craft { body, rotors, anchors, .. } = craft;
        let rotation = rotation(&body.attitude);
        let sums = self.rotors.sums(rotors);
        let moment = Moment {
            pos: &body.pos_enu,
            vel: &body.vel_enu,
            rate: &body.rate_flu,
            rotation: &rotation,
            rotors,
            sums: &sums,
        };
        if !self.is_aloft(body) {
            let loads = self.loads_near_ground(&moment, air, anchors);
            return Present { loads, rotation, sums, trend: None };
        }
        let (loads, is_simple) = self.air_loads(&moment, air);
        let trend = (is_simple && self.h <= MAX_STEP_S).then(|| {
            let steady = self.rotors.static_loads_of(&sums, air.density_ratio);
            let momentum = self.momentum(&body.rate_flu, sums.spin);
            let turn = loads.torque_flu - steady.torque_flu - body.rate_flu.cross(&momentum);
            Trend::new(&turn, steady.force_flu.z, &self.acceleration(&rotation, &loads.force_flu))
        });
        Present { loads, rotation, sums, trend }
    }

    /// Makes one step with constant motor targets (rad/s) and air. `now` are the loads at its start.
    pub fn step(&self, craft: &mut Craft, target: &[f64; ROTORS], air: &AirSample, now: &Present) {
        let rotors = self.motors.step(&craft.rotors, target);
        match (&now.trend, craft.past()) {
            (Some(trend), Some([first, second, third])) => {
                let trends = [trend, first, second, third];
                craft.body = self.fly(&craft.body, &rotors, air, now, trends);
            }
            _ => craft.body = self.runge_kutta(craft, &rotors, air, now),
        }
        craft.rotors = rotors.at_end();
        match now.trend {
            Some(trend) => craft.remember(trend),
            None => {
                craft.forget();
                self.ground.update_anchors(&craft.body, &mut craft.anchors);
            }
        }
    }

    /// Returns `true` if no part of the craft can touch the ground within a step.
    #[inline]
    fn is_aloft(&self, body: &BodyState) -> bool {
        let BodyState { pos_enu, vel_enu, .. } = body;
        let way_m = self.h * (vel_enu.x.abs() + vel_enu.y.abs() + vel_enu.z.abs());
        let height_m = self.ground.landform().tangent_at(pos_enu).distance_m(pos_enu);
        way_m < MAX_WAY_M && height_m > self.ground.reach_m() + ALOFT_M
    }

    /// Returns the angular momentum of body and rotors, FLU, for body rates and the sum of the rotor speeds, rad/s.
    #[inline]
    fn momentum(&self, rate: &Vector3<f64>, spin: f64) -> Vector3<f64> {
        let mut momentum = self.inertia.component_mul(rate);
        momentum.z += self.rotor_inertia * spin;
        momentum
    }

    /// Returns the body rates of an angular momentum.
    #[inline]
    fn rate(&self, momentum: &Vector3<f64>, spin: f64) -> Vector3<f64> {
        let mut body = *momentum;
        body.z -= self.rotor_inertia * spin;
        self.inertia_inv.component_mul(&body)
    }

    /// Returns the acceleration by a force in body axes and gravity, ENU.
    #[inline]
    fn acceleration(&self, rotation: &Matrix3<f64>, force: &Vector3<f64>) -> Vector3<f64> {
        let mut acc = rotation * (force * self.mass_inv);
        acc.z -= GRAVITY;
        acc
    }

    /// Returns the loads without the ground, and `true` if those of the rotors follow from their sums.
    // Inlined, because the result would otherwise be copied through memory in every step.
    #[inline(always)]
    fn air_loads(&self, moment: &Moment<'_>, air: &AirSample) -> (Loads, bool) {
        let va = moment.rotation.tr_mul(&(moment.vel - air.wind_enu));
        let rho = air.density_ratio;
        let is_simple = self.rotors.are_simple(moment.sums, &va);
        let mut loads = if is_simple {
            let steady = self.rotors.static_loads_of(moment.sums, rho);
            let flow = self.rotors.flow_loads(moment.sums, &va, rho);
            Loads {
                force_flu: steady.force_flu + flow.force_flu,
                torque_flu: steady.torque_flu + flow.torque_flu,
            }
        } else {
            self.loads_one_by_one(moment, &va, rho)
        };
        loads.force_flu -= (self.body_drag * rho).component_mul(&va.abs()).component_mul(&va);
        loads.torque_flu -= self.angular_damping.component_mul(moment.rate);
        (loads, is_simple)
    }

    #[cold]
    #[inline(never)]
    fn loads_one_by_one(&self, moment: &Moment<'_>, va: &Vector3<f64>, rho: f64) -> Loads {
        let plane = self.ground.landform().tangent_at(moment.pos);
        let up = moment.rotation.tr_mul(plane.normal());
        self.rotors.loads_one_by_one(moment.rotors, va, rho, plane.distance_m(moment.pos), &up)
    }

    /// Returns the loads with those of the ground.
    fn loads_near_ground(&self, moment: &Moment<'_>, air: &AirSample, anchors: &ContactAnchors) -> Loads {
        let (mut loads, _) = self.air_loads(moment, air);
        let plane = self.ground.landform().tangent_at(moment.pos);
        if plane.distance_m(moment.pos) < self.ground.reach_m() {
            let Moment { pos, vel, rate, rotation, .. } = moment;
            let contact = self.ground.loads(pos, vel, rotation, rate, anchors);
            loads.force_flu += contact.force_flu;
            loads.torque_flu += contact.torque_flu;
        }
        loads
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;

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
    fn run(plant: &Plant, craft: &mut Craft, target: [f64; ROTORS], air: &AirSample, seconds: f64) {
        for _ in 0..(seconds / H).round() as usize {
            let present = plant.present(craft, air);
            plant.step(craft, &target, air, &present);
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
        let momentum = |craft: &Craft| {
            let spin = airframe.rotor_inertia_kgm2 * craft.rotors.iter().sum::<f64>();
            let body = airframe.inertia_kgm2.component_mul(&craft.body.rate_flu);
            craft.body.attitude * (body + Vector3::new(0.0, 0.0, spin))
        };
        let mut craft = Craft::new(BodyState { rate_flu: Vector3::new(2.0, -1.0, 0.5), ..aloft() });
        craft.set_rotors([300.0; ROTORS]);
        let before = momentum(&craft);
        run(&plant, &mut craft, [400.0; ROTORS], &air, 1.0);
        let change = (momentum(&craft) - before).norm() / before.norm();
        assert!(change < 1e-5, "the angular momentum changed by {change}");
    }

    #[test]
    fn thin_air_lets_a_craft_fall_faster_and_carries_it_along_less() {
        let plant = Plant::new(&Airframe::iris(), H);
        let velocity = |density_ratio: f64, seconds: f64| {
            let air = AirSample { wind_enu: Vector3::new(10.0, 0.0, 0.0), density_ratio };
            let mut craft = Craft::new(aloft());
            run(&plant, &mut craft, [0.0; ROTORS], &air, seconds);
            craft.body.vel_enu
        };
        let (dense, thin) = (velocity(1.0, 10.0), velocity(0.5, 10.0));
        // The drag carries the weight at the final speed, and it grows with the square of the speed.
        let ratio = thin.z / dense.z;
        assert!((1.3..1.5).contains(&ratio), "{} and {} m/s", thin.z, dense.z);
        let ratio = velocity(0.5, 0.5).x / velocity(1.0, 0.5).x;
        assert!((0.45..0.6).contains(&ratio), "{ratio} of the drift");
    }
}
