//! The battery: open-circuit voltage over charge, internal resistance, load of the motors.

use super::airframe::{Airframe, ROTORS};
use crate::math;

/// The share of the electrical power that reaches the propeller shafts.
const DRIVE_EFFICIENCY: f64 = 0.75;
/// The power of the electronics, W.
pub(super) const BASE_LOAD_W: f64 = 5.0;
/// The open-circuit voltage of a full cell, of one with 10 % left, and of an empty one, V.
const CELL_V: [f64; 3] = [4.2, 3.5, 3.0];
/// The remaining charge at which the steep end of the discharge curve begins.
const KNEE: f64 = 0.1;
/// The rate at which the voltage of an empty cell falls with the charge drawn beyond its capacity, V per capacity.
const BEYOND_EMPTY_V: f64 = 50.0;

/// The battery of an airframe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BatterySpec {
    /// Cells in series.
    pub cells: u8,
    /// Voltage at which the motors reach their specified top speed, V.
    pub nominal_v: f64,
    /// Internal resistance of the pack, Ω.
    pub resistance_ohm: f64,
    /// Capacity, A·h.
    pub capacity_ah: f64,
}

impl BatterySpec {
    /// Returns the open-circuit voltage with `left` of the charge left (1 full, 0 empty, negative beyond), V.
    pub fn open_circuit_v(&self, left: f64) -> f64 {
        let [full, knee, empty] = CELL_V;
        let left = left.min(1.0);
        let cell = if left >= KNEE {
            knee + (full - knee) * (left - KNEE) / (1.0 - KNEE)
        } else if left < 0.0 {
            (empty + BEYOND_EMPTY_V * left).max(0.0)
        } else {
            empty + (knee - empty) * left / KNEE
        };
        cell * f64::from(self.cells)
    }

    /// Returns the terminal voltage (V) and current (A) under a constant-power load. A load beyond the maximum power
    /// of the pack is limited to that. A dead pack gives nothing.
    pub fn under_load(&self, open_circuit_v: f64, load_w: f64) -> (f64, f64) {
        if open_circuit_v <= 0.0 {
            return (0.0, 0.0);
        }
        let load = load_w.min(open_circuit_v * open_circuit_v / (4.0 * self.resistance_ohm));
        let root = (open_circuit_v * open_circuit_v - 4.0 * self.resistance_ohm * load).max(0.0).sqrt();
        let voltage = 0.5 * (open_circuit_v + root);
        (voltage, load / voltage)
    }
}

/// Returns the electrical power of the four motors at the given rotor speeds (rad/s), W. `load_factor` is the factor
/// of density and efficiency on the torque of each rotor.
pub fn motor_power_w(airframe: &Airframe, rotor_speeds: &[f64; ROTORS], load_factor: &[f64; ROTORS]) -> f64 {
    let cubes: f64 =
        rotor_speeds.iter().zip(load_factor).map(|(speed, load)| math::powi(*speed, 3) * load).sum();
    airframe.torque_per_thrust_m * airframe.thrust_coeff * cubes / DRIVE_EFFICIENCY
}

/// The faults that make a pack worse than its specification.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct BatteryFaults {
    /// Offset of the open-circuit voltage, V.
    pub offset_v: f64,
    /// Number of cells that failed short.
    pub dead_cells: u8,
}

/// The state of the battery in the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Battery {
    spec: BatterySpec,
    /// Terminal voltage, V.
    pub voltage_v: f64,
    /// Current, A.
    pub current_a: f64,
    /// Charge drawn since the start, mA·h.
    pub drawn_mah: f64,
    /// Energy drawn since the start, W·h.
    pub drawn_wh: f64,
}

impl Battery {
    /// Returns a full battery under the base load.
    pub(super) fn full(spec: BatterySpec) -> Self {
        let (voltage_v, current_a) = spec.under_load(spec.open_circuit_v(1.0), BASE_LOAD_W);
        Self { spec, voltage_v, current_a, drawn_mah: 0.0, drawn_wh: 0.0 }
    }

    /// Returns the capacity of the full pack, mA·h.
    pub(super) fn capacity_mah(&self) -> f64 {
        self.spec.capacity_ah * 1000.0
    }

    /// Returns the remaining charge: 1 full, 0 empty, negative if more than the capacity was drawn.
    pub(super) fn charge_left(&self) -> f64 {
        1.0 - self.drawn_mah / self.capacity_mah()
    }

    /// Returns the terminal voltage per cell, V.
    pub(super) fn cell_v(&self) -> f64 {
        self.voltage_v / f64::from(self.spec.cells)
    }

    /// Returns the terminal voltage over the nominal voltage: the scale of the rotor speeds if sag affects them.
    pub(super) fn speed_scale(&self) -> f64 {
        self.voltage_v / self.spec.nominal_v
    }

    /// Draws `motor_w` and the base load for `dt` seconds. A pack that `runs_out` dies when it is empty; any other
    /// keeps the voltage of an empty pack.
    pub(super) fn draw(&mut self, motor_w: f64, faults: BatteryFaults, runs_out: bool, dt: f64) {
        let left = if runs_out { self.charge_left() } else { self.charge_left().max(0.0) };
        let alive = f64::from(self.spec.cells.saturating_sub(faults.dead_cells)) / f64::from(self.spec.cells);
        let open = (self.spec.open_circuit_v(left) * alive + faults.offset_v).max(0.0);
        (self.voltage_v, self.current_a) = self.spec.under_load(open, motor_w + BASE_LOAD_W);
        self.drawn_mah += self.current_a * dt / 3.6;
        self.drawn_wh += self.voltage_v * self.current_a * dt / 3600.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_discharge_curve_has_its_knee_at_ten_percent() {
        let spec = Airframe::iris().battery;
        assert!((spec.open_circuit_v(1.0) - 12.6).abs() < 1e-12);
        assert!((spec.open_circuit_v(0.1) - 10.5).abs() < 1e-12);
        assert!((spec.open_circuit_v(0.0) - 9.0).abs() < 1e-12);
        assert!(spec.open_circuit_v(0.09) < spec.open_circuit_v(0.11));
    }

    #[test]
    fn beyond_its_capacity_a_cell_loses_half_a_volt_a_percent() {
        let spec = Airframe::iris().battery;
        assert!((spec.open_circuit_v(-0.02) - 6.0).abs() < 1e-12);
        assert_eq!(spec.open_circuit_v(-0.5), 0.0);
        assert_eq!(spec.under_load(0.0, 40.0), (0.0, 0.0));
    }

    #[test]
    fn only_a_pack_that_runs_out_dies() {
        for (runs_out, least_v, most_v) in [(true, 0.0, 0.0), (false, 8.0, 9.0)] {
            let mut battery = Battery::full(Airframe::iris().battery);
            for _ in 0..800 {
                battery.draw(40.0, BatteryFaults::default(), runs_out, 10.0);
            }
            assert!((least_v..=most_v).contains(&battery.voltage_v), "{}", battery.voltage_v);
            assert!(battery.charge_left() < 0.0);
        }
    }

    #[test]
    fn a_load_beyond_the_pack_is_cut_to_half_the_voltage() {
        let spec = Airframe::iris().battery;
        let (voltage, current) = spec.under_load(12.0, 1e9);
        assert!((voltage - 6.0).abs() < 1e-12);
        assert!((current - 200.0).abs() < 1e-9);
    }

    #[test]
    fn an_hour_at_one_ampere_is_one_ampere_hour() {
        let mut battery = Battery::full(Airframe::iris().battery);
        for _ in 0..360 {
            battery.draw(12.0 - BASE_LOAD_W, BatteryFaults::default(), false, 10.0);
        }
        assert!((battery.drawn_wh - 12.0).abs() < 1e-9);
        assert!((battery.drawn_mah - 1000.0).abs() < 60.0);
    }
}
