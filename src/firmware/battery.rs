//! The battery as the firmware sees it: cell count and charge state from the voltage.

use crate::msp::BatteryState;
use crate::signals::BatterySample;

/// The voltage below which no battery counts as connected, V.
const PRESENT_V: f64 = 2.0;
/// The margin above its threshold at which a warning ends, V per cell.
const HYSTERESIS_V: f64 = 0.01;
/// The time constant of the smoothing before the voltage is judged, s.
const SMOOTHING_S: f64 = 0.5;
/// The interval of samples, s.
const SAMPLE_S: f64 = 0.02;

/// The thresholds of the active battery profile, V per cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BatteryConfig {
    /// The highest voltage of a full cell. It decides the number of cells.
    pub max_cell_v: f64,
    pub warning_cell_v: f64,
    pub min_cell_v: f64,
    /// The number of cells; 0 = detected.
    pub cells: u8,
}

impl Default for BatteryConfig {
    fn default() -> Self {
        Self { max_cell_v: 4.3, warning_cell_v: 3.5, min_cell_v: 3.3, cells: 0 }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Battery {
    sample: Option<BatterySample>,
    smooth_v: f64,
    cells: u8,
    state: BatteryState,
}

impl Battery {
    /// Takes a sample. Returns the new state if it changed.
    pub fn receive(&mut self, config: &BatteryConfig, sample: BatterySample) -> Option<BatteryState> {
        let first = self.sample.replace(sample).is_none();
        if first || self.state == BatteryState::NotPresent {
            self.smooth_v = sample.voltage_v;
            self.cells = match config.cells {
                // One more than the whole full cells, limited to a count that exists in practice.
                0 => ((sample.voltage_v / config.max_cell_v).floor().clamp(0.0, 23.0) as u8) + 1,
                forced => forced,
            };
        }
        self.smooth_v += (sample.voltage_v - self.smooth_v) * (SAMPLE_S / SMOOTHING_S);
        let state = self.judge(config);
        let was = std::mem::replace(&mut self.state, state);
        (was != state).then_some(state)
    }

    fn judge(&self, config: &BatteryConfig) -> BatteryState {
        if self.smooth_v < PRESENT_V {
            return BatteryState::NotPresent;
        }
        let cell_v = self.cell_v();
        let below = |limit: f64, already: bool| cell_v < limit + if already { HYSTERESIS_V } else { 0.0 };
        let critical = self.state == BatteryState::Critical;
        if below(config.min_cell_v, critical) {
            BatteryState::Critical
        } else if below(config.warning_cell_v, critical || self.state == BatteryState::Warning) {
            BatteryState::Warning
        } else {
            BatteryState::Ok
        }
    }

    pub fn sample(&self) -> Option<&BatterySample> {
        self.sample.as_ref()
    }

    /// Returns the number of cells in series; 0 while unknown.
    pub fn cells(&self) -> u8 {
        self.cells
    }

    /// Returns the smoothed voltage per cell, V.
    pub fn cell_v(&self) -> f64 {
        self.smooth_v / f64::from(self.cells.max(1))
    }

    /// Returns `true` if the battery is at its warning voltage or below.
    pub fn is_low(&self) -> bool {
        matches!(self.state, BatteryState::Warning | BatteryState::Critical)
    }

    pub fn state(&self) -> BatteryState {
        self.state
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(voltage_v: f64, battery: &mut Battery) -> BatteryState {
        for _ in 0..500 {
            battery
                .receive(&BatteryConfig::default(), BatterySample { voltage_v, ..BatterySample::default() });
        }
        battery.state()
    }

    #[test]
    fn state_follows_the_voltage_a_cell() {
        let mut battery = Battery::default();
        assert_eq!(battery.state(), BatteryState::Init);
        assert_eq!(after(16.8, &mut battery), BatteryState::Ok);
        assert_eq!(battery.cells(), 4);
        assert_eq!(after(13.9, &mut battery), BatteryState::Warning);
        assert_eq!(after(14.02, &mut battery), BatteryState::Warning, "hysteresis");
        assert_eq!(after(13.1, &mut battery), BatteryState::Critical);
        assert_eq!(after(14.8, &mut battery), BatteryState::Ok);
        assert_eq!(after(0.0, &mut battery), BatteryState::NotPresent);
    }

    #[test]
    fn forced_cell_count_wins() {
        let mut battery = Battery::default();
        let config = BatteryConfig { cells: 6, ..BatteryConfig::default() };
        battery.receive(&config, BatterySample { voltage_v: 16.8, ..BatterySample::default() });
        assert_eq!(battery.cells(), 6);
    }
}
