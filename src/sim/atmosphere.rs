//! The ICAO standard atmosphere below 11 km.

use super::airframe::REFERENCE_DENSITY;

const SEA_LEVEL_K: f64 = 288.15;
const SEA_LEVEL_PA: f64 = 101_325.0;
/// Temperature falls by this much per metre, K/m.
const LAPSE_K_PER_M: f64 = 0.0065;
/// g·M/(R·lapse): exponent of the pressure law.
const PRESSURE_EXPONENT: f64 = 5.255_879_8;
/// Specific gas constant of dry air, J/(kg·K).
const GAS_CONSTANT: f64 = 287.052_87;
/// The law holds in this range of altitudes, m; values outside are taken at its ends.
const VALID_M: std::ops::RangeInclusive<f64> = -5_000.0..=11_000.0;

/// Air temperature at an altitude above mean sea level (m), K.
pub fn temperature_k(alt_amsl_m: f64) -> f64 {
    SEA_LEVEL_K - LAPSE_K_PER_M * alt_amsl_m.clamp(*VALID_M.start(), *VALID_M.end())
}

/// Static pressure at an altitude above mean sea level (m), Pa.
pub fn pressure_pa(alt_amsl_m: f64) -> f64 {
    SEA_LEVEL_PA * (temperature_k(alt_amsl_m) / SEA_LEVEL_K).powf(PRESSURE_EXPONENT)
}

/// Air density at an altitude above mean sea level (m), kg/m³.
pub fn density(alt_amsl_m: f64) -> f64 {
    pressure_pa(alt_amsl_m) / (GAS_CONSTANT * temperature_k(alt_amsl_m))
}

/// Density over the density at which an airframe's coefficients are stated.
pub fn density_ratio(alt_amsl_m: f64) -> f64 {
    density(alt_amsl_m) / REFERENCE_DENSITY
}
