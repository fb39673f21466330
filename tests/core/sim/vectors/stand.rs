//! A test stand: the bare plant with motor commands and air held, without sensors, faults or events.

use betadeck_core::sim::{
    AirSample, Airframe, BodyState, Craft, Loads, Plant, REFERENCE_DENSITY, ROTORS, level_attitude,
};
use nalgebra::Vector3;

pub(crate) struct Stand {
    pub(crate) airframe: Airframe,
    pub(crate) plant: Plant,
    pub(crate) body: BodyState,
    pub(crate) rotors: [f64; ROTORS],
    pub(crate) target: [f64; ROTORS],
    pub(crate) air: AirSample,
    craft: Craft,
    h: f64,
    by_runge_kutta: bool,
}

impl Stand {
    /// Returns a level craft facing north at a height, at rest, rotors stopped, in still air of reference density.
    pub(crate) fn new(airframe: Airframe, height_m: f64, h: f64) -> Self {
        let body = BodyState {
            pos_enu: Vector3::new(0.0, 0.0, height_m),
            vel_enu: Vector3::zeros(),
            attitude: level_attitude(0.0),
            rate_flu: Vector3::zeros(),
        };
        Self {
            plant: Plant::new(&airframe, h),
            airframe,
            body,
            rotors: [0.0; ROTORS],
            target: [0.0; ROTORS],
            air: AirSample { wind_enu: Vector3::zeros(), density_ratio: 1.0 },
            craft: Craft::new(body),
            h,
            by_runge_kutta: false,
        }
    }

    /// Makes every step by Runge–Kutta, as the first steps after a jump of the loads.
    pub(crate) fn by_runge_kutta(mut self) -> Self {
        self.by_runge_kutta = true;
        self
    }

    /// Sets the rotors to these speeds and keeps them there.
    pub(crate) fn hold_rotors(&mut self, speeds: [f64; ROTORS]) {
        self.rotors = speeds;
        self.target = speeds;
    }

    /// Sets the motor commands, 0…1.
    pub(crate) fn command(&mut self, u: [f64; ROTORS]) {
        self.target = u.map(|u| u * self.airframe.rotor_speed_max);
    }

    pub(crate) fn loads(&self) -> Loads {
        self.plant.present(&self.craft(), &self.air).loads
    }

    pub(crate) fn specific_force(&self) -> Vector3<f64> {
        self.loads().force_flu / self.plant.mass_kg()
    }

    /// Returns the craft in the state of the stand, which a test may have changed since the last step.
    fn craft(&self) -> Craft {
        let mut craft = self.craft.clone();
        if *craft.body() != self.body {
            craft.set_body(self.body);
        }
        if *craft.rotors() != self.rotors {
            craft.set_rotors(self.rotors);
        }
        craft
    }

    pub(crate) fn step(&mut self) {
        let mut craft = self.craft();
        if self.by_runge_kutta {
            craft.forget();
        }
        let present = self.plant.present(&craft, &self.air);
        self.plant.step(&mut craft, &self.target, &self.air, &present);
        (self.body, self.rotors) = (*craft.body(), *craft.rotors());
        self.craft = craft;
    }

    pub(crate) fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds / self.h).round() as u64 {
            self.step();
        }
    }
}

/// Returns the airframe with thrust as its only aerodynamic force.
pub(crate) fn without_drag(mut airframe: Airframe) -> Airframe {
    airframe.inflow_coeff = 0.0;
    airframe.rotor_drag_coeff = 0.0;
    airframe.body_drag = Vector3::zeros();
    airframe.angular_damping = Vector3::zeros();
    airframe
}

/// Returns the airframe with its rotors at the same distance from the long axis, in the plane of the centre of mass if
/// `flat`.
pub(crate) fn symmetric(mut airframe: Airframe, flat: bool) -> Airframe {
    for rotor in &mut airframe.rotor_positions_m {
        rotor.y = 0.21 * rotor.y.signum();
        if flat {
            rotor.z = 0.0;
        }
    }
    airframe
}

/// The coefficients hold at the density of sea level, as the vectors assume.
#[test]
fn the_reference_density_is_that_of_sea_level() {
    assert!((betadeck_core::sim::density(0.0) / REFERENCE_DENSITY - 1.0).abs() < 1e-7);
}
