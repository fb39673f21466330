//! The ICAO standard atmosphere below 11 km.

use super::airframe::REFERENCE_DENSITY;
use crate::math;

const SEA_LEVEL_K: f64 = 288.15;
const SEA_LEVEL_PA: f64 = 101_325.0;
/// The decrease of temperature per metre, K/m.
const LAPSE_K_PER_M: f64 = 0.0065;
/// The exponent of the pressure law, g·M/(R·lapse).
const PRESSURE_EXPONENT: f64 = 5.255_879_8;
/// The specific gas constant of dry air, J/(kg·K).
const GAS_CONSTANT: f64 = 287.052_87;
/// The range of altitudes in which the law holds, m. Values outside are limited to it.
const VALID_M: std::ops::RangeInclusive<f64> = -5_000.0..=11_000.0;

/// Returns the air temperature at an altitude above mean sea level (m), K.
pub fn temperature_k(alt_amsl_m: f64) -> f64 {
    SEA_LEVEL_K - LAPSE_K_PER_M * alt_amsl_m.clamp(*VALID_M.start(), *VALID_M.end())
}

/// Returns the static pressure at an altitude above mean sea level (m), Pa.
pub fn pressure_pa(alt_amsl_m: f64) -> f64 {
    SEA_LEVEL_PA * math::powf(temperature_k(alt_amsl_m) / SEA_LEVEL_K, PRESSURE_EXPONENT)
}

/// Returns the air density at an altitude above mean sea level (m), kg/m³.
pub fn density(alt_amsl_m: f64) -> f64 {
    pressure_pa(alt_amsl_m) / (GAS_CONSTANT * temperature_k(alt_amsl_m))
}

/// Returns the density over the density for which the coefficients of an airframe are given.
pub fn density_ratio(alt_amsl_m: f64) -> f64 {
    density(alt_amsl_m) / REFERENCE_DENSITY
}
