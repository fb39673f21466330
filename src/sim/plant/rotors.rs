//! The loads of the rotors: thrust, drag in their plane, drag torque.
//!
//! Each of them is a sum over the rotors of the speed or its square times a constant of the rotor, so these sums are
//! computed first, for the four rotors together. A rotor is treated by itself only where its thrust would be negative,
//! or where the ground below it raises its thrust.

use nalgebra::Vector3;

use crate::sim::airframe::{Airframe, ROTORS};
use crate::sim::body::Loads;

/// The rotors of an airframe.
#[derive(Debug, Clone)]
pub(super) struct Rotors {
    x: [f64; ROTORS],
    y: [f64; ROTORS],
    z: [f64; ROTORS],
    /// 1 for a rotor that turns anticlockwise, −1 for the others.
    spin: [f64; ROTORS],
    /// One, x, y and z of each rotor.
    places: [[f64; 4]; ROTORS],
    /// One, x, y and the spin of each rotor.
    lifts: [[f64; 4]; ROTORS],
    efficiency: [f64; ROTORS],
    thrust_coeff: f64,
    torque_per_thrust: f64,
    inflow_coeff: f64,
    drag_coeff: f64,
    /// Rotor radius if ground effect is on, m.
    ground_effect_radius: Option<f64>,
}

/// Sums over the rotors at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct RotorSums {
    /// Of the speeds, times one, x, y and z.
    speed: [f64; 4],
    /// Of the effective speeds, times one, x, y and the spin.
    effective: [f64; 4],
    /// Of the effective squares, times one, x, y and the spin.
    squares: [f64; 4],
    /// Of the speeds, anticlockwise positive.
    pub(super) spin: f64,
    /// The lowest speed.
    lowest: f64,
}

impl Rotors {
    pub(super) fn new(airframe: &Airframe) -> Self {
        let places = &airframe.rotor_positions_m;
        Self {
            x: places.map(|place| place.x),
            y: places.map(|place| place.y),
            z: places.map(|place| place.z),
            spin: airframe.spin_sign,
            places: places.map(|place| [1.0, place.x, place.y, place.z]),
            lifts: std::array::from_fn(|i| [1.0, places[i].x, places[i].y, airframe.spin_sign[i]]),
            efficiency: [1.0; ROTORS],
            thrust_coeff: airframe.thrust_coeff,
            torque_per_thrust: airframe.torque_per_thrust_m,
            inflow_coeff: airframe.inflow_coeff,
            drag_coeff: airframe.rotor_drag_coeff,
            ground_effect_radius: None,
        }
    }

    /// Sets the thrust efficiency of each rotor, 0…1.
    pub(super) fn set_efficiency(&mut self, efficiency: [f64; ROTORS]) {
        self.efficiency = efficiency;
    }

    pub(super) fn efficiency(&self) -> &[f64; ROTORS] {
        &self.efficiency
    }

    /// Switches the thrust gain near the ground on, for rotors with the given radius (m), or off.
    pub(super) fn set_ground_effect(&mut self, rotor_radius_m: Option<f64>) {
        self.ground_effect_radius = rotor_radius_m;
    }

    /// Returns the sum of a number of each rotor, anticlockwise positive.
    #[inline]
    pub(super) fn spin(&self, numbers: &[f64; ROTORS]) -> f64 {
        dot(&self.spin, numbers)
    }

    /// Returns the sums at the given speeds, rad/s.
    #[inline(always)]
    pub(super) fn sums(&self, speed: &[f64; ROTORS]) -> RotorSums {
        let effective: [f64; ROTORS] = std::array::from_fn(|i| self.efficiency[i] * speed[i]);
        let [a, b, c, d] = *speed;
        RotorSums {
            speed: weighted(&self.places, speed),
            effective: weighted(&self.lifts, &effective),
            squares: self.squares(&std::array::from_fn(|i| speed[i] * speed[i])),
            spin: self.spin(speed),
            lowest: a.min(b).min(c.min(d)),
        }
    }

    /// Returns the sums of effective squares, times one, x, y and the spin.
    #[inline]
    fn squares(&self, squares: &[f64; ROTORS]) -> [f64; 4] {
        let effective: [f64; ROTORS] = std::array::from_fn(|i| self.efficiency[i] * squares[i]);
        weighted(&self.lifts, &effective)
    }

    /// Returns `true` if the loads follow from the sums, in air that flows past with `va` (m/s, FLU).
    #[inline]
    pub(super) fn are_simple(&self, sums: &RotorSums, va: &Vector3<f64>) -> bool {
        self.ground_effect_radius.is_none() && self.inflow_coeff * va.z <= self.thrust_coeff * sums.lowest
    }

    /// Returns thrust and torque without any inflow at squares of the speeds, in air of this relative density.
    #[inline]
    pub(super) fn static_loads(&self, squares: &[f64; ROTORS], rho: f64) -> Loads {
        self.static_part(&self.squares(squares), rho)
    }

    /// Does the same as [`Self::static_loads`] for the sums.
    #[inline]
    pub(super) fn static_loads_of(&self, sums: &RotorSums, rho: f64) -> Loads {
        self.static_part(&sums.squares, rho)
    }

    #[inline]
    fn static_part(&self, squares: &[f64; 4], rho: f64) -> Loads {
        let [thrust, thrust_x, thrust_y, spun] = squares.map(|sum| rho * self.thrust_coeff * sum);
        Loads {
            force_flu: Vector3::new(0.0, 0.0, thrust),
            torque_flu: Vector3::new(thrust_y, -thrust_x, -self.torque_per_thrust * spun),
        }
    }

    /// Returns the loads by the flow of the air, if they follow from the sums: the thrust lost to inflow, and the drag.
    #[inline]
    pub(super) fn flow_loads(&self, sums: &RotorSums, va: &Vector3<f64>, rho: f64) -> Loads {
        let inflow = rho * self.inflow_coeff * va.z;
        let [thrust, thrust_x, thrust_y, _] = sums.effective.map(|sum| -inflow * sum);
        self.with_drag(sums, va, rho, [thrust, thrust_x, thrust_y])
    }

    /// Returns all loads, rotor by rotor. The centre of mass is `height_m` above the ground, whose normal in body axes
    /// is `up`.
    pub(super) fn loads_one_by_one(
        &self,
        speed: &[f64; ROTORS],
        va: &Vector3<f64>,
        rho: f64,
        height_m: f64,
        up: &Vector3<f64>,
    ) -> Loads {
        let sums = self.sums(speed);
        let mut thrust = [0.0; 3];
        for (i, speed) in speed.iter().enumerate() {
            let boost = self.ground_effect_radius.map_or(1.0, |radius_m| {
                let hub = Vector3::new(self.x[i], self.y[i], self.z[i]);
                ground_effect_factor(radius_m, height_m + up.dot(&hub))
            });
            let free = (self.thrust_coeff * speed - self.inflow_coeff * va.z) * speed;
            let lift = free.max(0.0) * self.efficiency[i] * rho * boost;
            thrust = [thrust[0] + lift, thrust[1] + lift * self.x[i], thrust[2] + lift * self.y[i]];
        }
        let mut loads = self.with_drag(&sums, va, rho, thrust);
        loads.torque_flu.z += self.static_loads_of(&sums, rho).torque_flu.z;
        loads
    }

    /// Returns the loads of a thrust and its moments x and y, and of the drag in the plane of the rotors.
    #[inline]
    fn with_drag(
        &self,
        sums: &RotorSums,
        va: &Vector3<f64>,
        rho: f64,
        [thrust, thrust_x, thrust_y]: [f64; 3],
    ) -> Loads {
        let [speed, speed_x, speed_y, speed_z] = sums.speed;
        let (drag_x, drag_y) = (-rho * self.drag_coeff * va.x, -rho * self.drag_coeff * va.y);
        Loads {
            force_flu: Vector3::new(drag_x * speed, drag_y * speed, thrust),
            torque_flu: Vector3::new(
                thrust_y - drag_y * speed_z,
                drag_x * speed_z - thrust_x,
                drag_y * speed_x - drag_x * speed_y,
            ),
        }
    }
}

/// Returns the sums over the rotors of a number of each, times its weights.
#[inline]
fn weighted(weights: &[[f64; 4]; ROTORS], numbers: &[f64; ROTORS]) -> [f64; 4] {
    let ([first, second, third, fourth], [a, b, c, d]) = (weights, numbers);
    std::array::from_fn(|i| (first[i] * a + third[i] * c) + (second[i] * b + fourth[i] * d))
}

#[inline]
fn dot(a: &[f64; ROTORS], b: &[f64; ROTORS]) -> f64 {
    let [first, second, third, fourth] = std::array::from_fn(|i| a[i] * b[i]);
    (first + third) + (second + fourth)
}

/// Returns the thrust near the ground over the thrust far from it, after Cheeseman and Bennett: 1/(1 − (R/4z)²), for
/// a rotor of radius R at height z (m), where z is at least R/2.
pub fn ground_effect_factor(rotor_radius_m: f64, height_m: f64) -> f64 {
    let ratio = rotor_radius_m / (4.0 * height_m.max(0.5 * rotor_radius_m));
    1.0 / (1.0 - ratio * ratio)
}
