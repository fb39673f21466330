//! The wind to come around the present one.

use crate::sim::Wind;

/// The standard deviation of the speed as a share of it, and its least value, m/s.
const SPREAD: (f64, f64) = (0.25, 1.0);
/// The standard deviation of the direction, degrees.
const TURN_DEG: f64 = 20.0;

/// Returns the distribution of a wind around the present one, in the form of `[vary]`: `8+-2@250+-20`. Speed and direction
/// are normally distributed. A calm may become a wind from anywhere.
pub fn wind_around(mean: Wind) -> String {
    let Wind { speed_mps, from_deg } = mean;
    let (share, least_mps) = SPREAD;
    let deviation_mps = (share * speed_mps).max(least_mps);
    let from = if speed_mps < least_mps { "0..360".to_owned() } else { format!("{from_deg}+-{TURN_DEG}") };
    format!("{speed_mps}+-{deviation_mps}@{from}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wind_is_spread_around_the_present_one() {
        let around = |speed_mps, from_deg| wind_around(Wind { speed_mps, from_deg });
        assert_eq!(around(8.0, 250.0), "8+-2@250+-20");
        assert_eq!(around(2.5, 359.5), "2.5+-1@359.5+-20");
        assert_eq!(around(0.0, 90.0), "0+-1@0..360", "a calm has no direction");
    }
}
