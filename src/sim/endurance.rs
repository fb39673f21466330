//! The hover time of an airframe with a full battery.

use super::airframe::{Airframe, ROTORS};
use super::battery::{BASE_LOAD_W, motor_power_w};
use crate::geo::GRAVITY;

/// The number of charge steps. The current is constant within each.
const STEPS: u32 = 200;

impl Airframe {
    /// Returns the seconds of hover in still air from a full battery to an empty one, at an air density over the
    /// reference density. The power is that of the hover: a slow flight takes about as much, climbs and wind take
    /// more.
    pub fn hover_endurance_s(&self, density_ratio: f64) -> f64 {
        let thrust = self.mass_kg * GRAVITY / ROTORS as f64;
        let speed = (thrust / (self.thrust_coeff * density_ratio)).sqrt();
        let power = motor_power_w(self, &[speed; ROTORS], &[density_ratio; ROTORS]) + BASE_LOAD_W;
        let step_ah = self.battery.capacity_ah / f64::from(STEPS);
        (0..STEPS)
            .map(|step| {
                let left = 1.0 - (f64::from(step) + 0.5) / f64::from(STEPS);
                let (_, current_a) = self.battery.under_load(self.battery.open_circuit_v(left), power);
                step_ah / current_a * 3600.0
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_iris_hovers_for_fifty_minutes_and_less_in_thin_air() {
        // 38.78 W for the motors and 5 W for the electronics at 11 V give 4 A from 3.3 A·h.
        let iris = Airframe::iris();
        let minutes = iris.hover_endurance_s(1.0) / 60.0;
        assert!((47.0..53.0).contains(&minutes), "{minutes}");
        let thin = iris.hover_endurance_s(0.5) / 60.0;
        assert!((0.7..0.8).contains(&(thin / minutes)), "{thin}");
    }
}
