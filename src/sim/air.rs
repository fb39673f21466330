//! The air at the craft: mean wind with its height profile, gusts, turbulence, density.
//!
//! Everything is computed on air ticks of 10 ms, one tick ahead, and interpolated linearly between them, so that the
//! air is the same for every step rate. A change of a setting therefore takes effect from the next tick on.

use nalgebra::Vector3;

use crate::math;
use crate::signals::SimTime;
use crate::telemetry::Turbulence;

use super::atmosphere;
use super::body::AirSample;
use super::switches::{AirDensity, Switches, WindProfile};
use crate::sim::config::WorldConfig;
use crate::sim::wind::Wind;

mod gust;
mod turbulence;

use gust::Gusts;
pub use gust::one_minus_cosine;
pub(super) use gust::usual_length_s;
pub use turbulence::DrydenScales;
use turbulence::TurbulenceFilter;

/// The length of an air tick, µs.
pub const AIR_TICK_US: u64 = 10_000;
/// The length of an air tick, s.
const AIR_TICK_S: f64 = 0.01;
/// The time that the mean wind takes to change, s.
const WIND_RAMP_S: f64 = 2.0;
/// The height from which the stated wind applies, m.
const PROFILE_TOP_M: f64 = 10.0;
/// The lowest height of the profile and the roughness length of short grass, m.
const PROFILE_BOTTOM_M: f64 = 0.3;
const ROUGHNESS_M: f64 = 0.03;

/// The air of a world.
#[derive(Debug, Clone)]
pub(super) struct Air {
    /// The wind that was set, and the wind of a fault that replaces it.
    wind: Wind,
    wind_fault: Option<Wind>,
    ramp: Ramp,
    /// The wind that the program adds, ENU, m/s.
    pub added: Vector3<f64>,
    pub gusts: Gusts,
    pub turbulence: TurbulenceFilter,
    calm_axis_from_deg: f64,
    ground_amsl_m: f64,
    from: Vector3<f64>,
    to: Vector3<f64>,
    density_ratio: f64,
}

/// A change of the mean wind.
#[derive(Debug, Clone, Copy)]
struct Ramp {
    from: Vector3<f64>,
    to: Vector3<f64>,
    start: SimTime,
}

impl Ramp {
    fn at(&self, time: SimTime) -> Vector3<f64> {
        self.from.lerp(&self.to, (time.seconds_since(self.start) / WIND_RAMP_S).min(1.0))
    }
}

impl Air {
    /// Returns the air at boot around a craft at the given height above ground, m.
    pub(super) fn new(config: &WorldConfig, height_m: f64) -> Self {
        let velocity = config.wind.velocity_enu();
        let mut air = Self {
            wind: config.wind,
            wind_fault: None,
            ramp: Ramp { from: velocity, to: velocity, start: SimTime::ZERO },
            added: Vector3::zeros(),
            gusts: Gusts::new(config.seed, config.gust_mps),
            turbulence: TurbulenceFilter::new(config.seed, config.turbulence),
            calm_axis_from_deg: config.home.heading_deg,
            ground_amsl_m: config.home.alt_amsl_m,
            from: Vector3::zeros(),
            to: Vector3::zeros(),
            density_ratio: 1.0,
        };
        // The first tick fills `to`, the second one moves it to `from`.
        air.to = air.wind_at(SimTime::ZERO, height_m, &config.switches);
        air.tick(SimTime::ZERO, height_m, 0.0, Vector3::zeros(), &config.switches);
        air
    }

    /// Returns the air at a time after the last tick.
    // Inlined, because the result would otherwise be copied through memory in every step.
    #[inline(always)]
    pub(super) fn sample(&self, time: SimTime) -> AirSample {
        let part = (time.0 % AIR_TICK_US) as f64 * (1.0 / AIR_TICK_US as f64);
        AirSample { wind_enu: self.from + (self.to - self.from) * part, density_ratio: self.density_ratio }
    }

    /// Advances to the air tick at `now`, for a craft at an altitude above home (m) with a velocity (ENU, m/s), over
    /// ground with this elevation above home, m.
    pub(super) fn tick(
        &mut self,
        now: SimTime,
        altitude_m: f64,
        ground_m: f64,
        vel_enu: Vector3<f64>,
        switches: &Switches,
    ) {
        let height_m = altitude_m - ground_m;
        // The airspeed is relative to the mean air, since turbulence does not carry itself along.
        let mean = self.ramp.at(now) * profile(switches.wind_profile, height_m) + self.added;
        let airspeed = (vel_enu - mean).norm();
        self.from = self.to;
        self.gusts.advance(now, self.settled_wind(), switches.gust_rise_s);
        self.turbulence.advance(height_m, airspeed, AIR_TICK_S);
        let next = SimTime(now.0 + AIR_TICK_US);
        self.to = self.wind_at(next, height_m, switches);
        self.density_ratio = match switches.air_density {
            AirDensity::Isa => atmosphere::density_ratio(self.ground_amsl_m + altitude_m),
            AirDensity::Reference => 1.0,
        };
    }

    /// Returns the wind at a time and height above ground.
    fn wind_at(&self, time: SimTime, height_m: f64, switches: &Switches) -> Vector3<f64> {
        let wind = self.settled_wind();
        let axis_from_deg = if wind.speed_mps > 0.0 { wind.from_deg } else { self.calm_axis_from_deg };
        self.ramp.at(time) * profile(switches.wind_profile, height_m)
            + self.gusts.velocity_enu(time)
            + self.turbulence.velocity_enu(axis_from_deg) * switches.turbulence_scale
            + self.added
    }

    /// Returns the wind after the end of all ramps: that of a fault, or the one that was set.
    pub(super) fn settled_wind(&self) -> Wind {
        self.wind_fault.unwrap_or(self.wind)
    }

    /// Returns the wind that was set, whatever a fault makes of it.
    pub(super) fn wind_that_was_set(&self) -> Wind {
        self.wind
    }

    /// Sets the mean wind, which changes over two seconds.
    pub(super) fn change_wind(&mut self, wind: Wind, now: SimTime) {
        self.wind = wind;
        self.start_ramp(now);
    }

    /// Replaces the set wind with the wind of a fault, or restores it.
    pub(super) fn change_wind_fault(&mut self, wind: Option<Wind>, now: SimTime) {
        if wind != self.wind_fault {
            self.wind_fault = wind;
            self.start_ramp(now);
        }
    }

    fn start_ramp(&mut self, now: SimTime) {
        self.ramp = Ramp { from: self.ramp.at(now), to: self.settled_wind().velocity_enu(), start: now };
    }

    pub(super) fn set_turbulence(&mut self, level: Turbulence) {
        self.turbulence.level = level;
    }
}

/// Returns the share of the stated wind at a height above ground.
fn profile(profile: WindProfile, height_m: f64) -> f64 {
    match profile {
        WindProfile::Log if height_m < PROFILE_TOP_M => {
            math::ln(height_m.max(PROFILE_BOTTOM_M) / ROUGHNESS_M) / math::ln(PROFILE_TOP_M / ROUGHNESS_M)
        }
        WindProfile::Log | WindProfile::Flat => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn windy(wind: &str) -> WorldConfig {
        WorldConfig { wind: wind.parse().unwrap(), ..WorldConfig::default() }
    }

    #[test]
    fn the_profile_is_logarithmic_below_ten_metres() {
        assert!((profile(WindProfile::Log, 1.0) - 0.604).abs() < 5e-4);
        assert_eq!(profile(WindProfile::Log, 10.0), 1.0);
        assert_eq!(profile(WindProfile::Log, 0.0), profile(WindProfile::Log, 0.3));
        assert_eq!(profile(WindProfile::Flat, 0.0), 1.0);
    }

    #[test]
    fn a_new_wind_takes_two_seconds() {
        let config = windy("4@270");
        let mut air = Air::new(&config, 20.0);
        assert_eq!(air.sample(SimTime::ZERO).wind_enu, config.wind.velocity_enu());
        air.change_wind("8@270".parse().unwrap(), SimTime::ZERO);
        let mut seen = Vec::new();
        for tick in 1..=300 {
            let now = SimTime(tick * AIR_TICK_US);
            air.tick(now, 20.0, 0.0, Vector3::zeros(), &config.switches);
            seen.push(air.sample(now).wind_enu.x);
        }
        assert!((seen[98] - 5.98).abs() < 0.05, "half way after a second: {}", seen[98]);
        assert!((seen[299] - 8.0).abs() < 1e-12);
        assert!(seen.windows(2).all(|pair| pair[1] >= pair[0]));
    }

    #[test]
    fn turbulence_in_calm_air_does_not_hurry_itself_along() {
        let gust_of_a_hover = |turbulence_scale| {
            let switches = Switches { turbulence_scale, ..Switches::default() };
            let config = WorldConfig { turbulence: Turbulence::Severe, switches, ..WorldConfig::default() };
            let mut air = Air::new(&config, 20.0);
            for tick in 1..=2000 {
                air.tick(SimTime(tick * AIR_TICK_US), 20.0, 0.0, Vector3::zeros(), &config.switches);
            }
            air.sample(SimTime(2000 * AIR_TICK_US)).wind_enu
        };
        // At the same airspeed, air four times as rough gives four times the gust.
        assert!((gust_of_a_hover(4.0) - 4.0 * gust_of_a_hover(1.0)).norm() < 1e-9);
    }

    #[test]
    fn the_end_of_a_wind_fault_brings_the_set_wind_back() {
        let config = windy("4@270");
        let mut air = Air::new(&config, 20.0);
        air.change_wind_fault(Some("9@0".parse().unwrap()), SimTime::ZERO);
        assert_eq!(air.settled_wind().speed_mps, 9.0);
        air.change_wind_fault(None, SimTime(5_000_000));
        assert_eq!(air.settled_wind(), config.wind);
    }
}
