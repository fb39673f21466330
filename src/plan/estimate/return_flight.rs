//! The altitude at which a GPS rescue returns home.

/// The choice of the altitude: `gps_rescue_alt_mode`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum ReturnMode {
    /// Above the highest altitude of the flight.
    #[default]
    Highest,
    /// At a fixed altitude.
    Fixed,
    /// Above the present altitude.
    Present,
}

/// The altitude of the return flight.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ReturnFlight {
    /// The choice of the altitude.
    pub mode: ReturnMode,
    /// `gps_rescue_initial_climb`, m.
    pub climb_m: f64,
    /// `gps_rescue_return_alt`, m above home.
    pub fixed_m: f64,
}

impl Default for ReturnFlight {
    fn default() -> Self {
        Self { mode: ReturnMode::Highest, climb_m: 10.0, fixed_m: 30.0 }
    }
}

impl ReturnFlight {
    /// Returns the altitude of a return that begins at `now_m`, after a flight up to `highest_m`, m above home.
    pub fn altitude_m(&self, highest_m: f64, now_m: f64) -> f64 {
        match self.mode {
            ReturnMode::Highest => highest_m.max(now_m) + self.climb_m,
            ReturnMode::Fixed => self.fixed_m,
            ReturnMode::Present => now_m + self.climb_m,
        }
    }

    /// Changes it by the value of a setting.
    pub(super) fn set(&mut self, name: &str, value: &str) {
        let number = value.parse::<u16>().map(f64::from);
        match (name, number) {
            ("gps_rescue_alt_mode", _) => {
                self.mode = match value.to_ascii_uppercase().as_str() {
                    "FIXED_ALT" => ReturnMode::Fixed,
                    "CURRENT_ALT" => ReturnMode::Present,
                    _ => ReturnMode::Highest,
                }
            }
            ("gps_rescue_initial_climb", Ok(metres)) => self.climb_m = metres,
            ("gps_rescue_return_alt", Ok(metres)) => self.fixed_m = metres,
            _ => {}
        }
    }
}
