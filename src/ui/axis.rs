//! The round numbers of scales and axes: 1, 2 and 5 times a power of ten.

/// The most ticks of an axis.
const MAX_TICKS: usize = 64;

/// Returns the longest round length not above `most`.
pub(super) fn round_length(most: f64) -> f64 {
    let decade = 10_f64.powf(most.max(1e-3).log10().floor());
    [5.0, 2.0].into_iter().map(|step| step * decade).find(|&length| length <= most).unwrap_or(decade)
}

/// Returns the shortest round step not below `least`.
pub(super) fn round_step(least: f64) -> f64 {
    let least = least.max(1e-9);
    let decade = 10_f64.powf(least.log10().floor());
    let steps = [1.0, 2.0, 5.0].map(|step| step * decade);
    steps.into_iter().find(|step| *step >= least * (1.0 - 1e-9)).unwrap_or(10.0 * decade)
}

/// Returns the multiples of a round step from `low` to `high`, at most `most` and at least one step apart from each
/// other. Empty if there is none, or if a limit is not finite.
pub(super) fn ticks(low: f64, high: f64, most: usize) -> Vec<f64> {
    let range = high - low;
    if !(range.is_finite() && range > 0.0) || most == 0 {
        return Vec::new();
    }
    let most = most.min(MAX_TICKS);
    let mut step = round_step(range / most as f64);
    loop {
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        let count = last - first + 1.0;
        if count <= most as f64 {
            // Adding zero turns −0 into 0.
            return (0..count.max(0.0) as usize).map(|tick| (first + tick as f64) * step + 0.0).collect();
        }
        step = round_step(step * 1.5);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn lengths_and_steps_are_round() {
        for (most, length) in [(34.0, 20.0), (50.0, 50.0), (999.0, 500.0), (1.2, 1.0)] {
            assert!((round_length(most) - length).abs() < 1e-9, "{most}");
        }
        for (least, step) in [(0.0011, 0.002), (0.002, 0.002), (0.3, 0.5), (7.0, 10.0)] {
            assert!((round_step(least) / step - 1.0).abs() < 1e-9, "{least}");
        }
    }

    #[test]
    fn the_ticks_of_an_axis_are_round_and_few() {
        assert_eq!(ticks(-2.2, 6.3, 5), [-2.0, 0.0, 2.0, 4.0, 6.0]);
        assert_eq!(ticks(0.0, 50.0, 3), [0.0, 20.0, 40.0]);
        assert_eq!(ticks(0.0, 50.0, 2), [0.0, 50.0]);
        assert_eq!(ticks(3.0, 3.0, 4), [0.0; 0]);
        assert_eq!(ticks(f64::NAN, 3.0, 4), [0.0; 0]);
        assert_eq!(ticks(-1.0, f64::INFINITY, 4), [0.0; 0]);
    }

    proptest! {
        #[test]
        fn ticks_are_inside_their_axis(low in -1e6..1e6_f64, range in 1e-3..1e6_f64, most in 1..20_usize) {
            let high = low + range;
            let ticks = ticks(low, high, most);
            prop_assert!(ticks.len() <= most);
            let margin = range * 1e-6;
            prop_assert!(ticks.iter().all(|tick| (low - margin..=high + margin).contains(tick)));
            prop_assert!(ticks.windows(2).all(|pair| pair[0] < pair[1]));
            prop_assert!(most < 4 || !ticks.is_empty());
        }
    }
}
