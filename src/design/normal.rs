//! The normal distribution, the same to the last bit on every machine.

/// Halvings of the bracket of a quantile. It then has no number inside.
const HALVINGS: u32 = 80;
/// The standard deviations to the left of which nothing is drawn.
const FARTHEST: f64 = -40.0;

/// Returns the probability that a unit normal deviate is at most `x`.
pub fn normal_cdf(x: f64) -> f64 {
    0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
}

/// Returns the number that a unit normal deviate exceeds with the probability 1 − `unit`.
pub fn normal_quantile(unit: f64) -> f64 {
    if unit > 0.5 {
        return -normal_quantile(1.0 - unit);
    }
    let (mut low, mut high) = (FARTHEST, 0.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if normal_cdf(middle) < unit {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (unit, expected) in [
            (0.5, 0.0),
            (0.975, 1.959_963_984_540_054),
            (0.025, -1.959_963_984_540_054),
            (0.95, 1.644_853_626_951_472_8),
            (0.995, 2.575_829_303_548_9),
            (1e-10, -6.361_340_902_404_056),
        ] {
            let found = normal_quantile(unit);
            assert!((found - expected).abs() < 1e-12, "{unit}: {found}");
        }
    }

    #[test]
    fn a_quantile_undoes_the_probability() {
        for step in -70..70 {
            let x = f64::from(step) / 10.0;
            let unit = normal_cdf(x);
            // Near 1 the probability has few digits left.
            let tolerance = 1e-12 + 1e-15 / (-0.5 * x * x).exp();
            assert!((normal_quantile(unit) - x).abs() < tolerance, "{x}");
        }
    }
}
