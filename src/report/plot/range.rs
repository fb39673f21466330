//! Ranges of axes, and round lengths.

use super::Point;

/// The greatest number on an axis.
const GREATEST: f64 = 1e7;

/// Returns a range that contains all finite values with a margin, and that is at least `least` wide.
pub(super) fn around(values: impl Iterator<Item = f64>, least: f64) -> (f64, f64) {
    let finite = values.filter(|value| value.is_finite()).map(|value| value.clamp(-GREATEST, GREATEST));
    let (low, high) = finite
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return (0.0, least);
    }
    let margin = (0.06 * (high - low)).max((least - (high - low)) / 2.0);
    // A chart of values that never fall below zero does not go below it.
    let bottom = if low >= 0.0 { (low - margin).max(0.0) } else { low - margin };
    (bottom, (high + margin).max(bottom + least))
}

/// Returns the multiples of 1, 2, 5, 10 … inside a range with the smallest step of which there are at most `most`.
pub(super) fn ticks((low, high): Point, most: usize) -> Vec<f64> {
    let power = 10_f64.powf((high - low).log10().floor() - 2.0);
    let steps = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0].map(|factor| factor * power);
    let ends = |step: f64| ((low / step).ceil(), (high / step).floor());
    let count = |step: &f64| ends(*step).1 - ends(*step).0 + 1.0;
    let Some(step) = steps.into_iter().find(|step| count(step) <= most as f64) else { return Vec::new() };
    (0..count(&step) as usize).map(|index| (ends(step).0 + index as f64) * step).collect()
}

/// Returns the longest length of 1, 2, 5, 10, 20, 50 … that is at most `most`.
pub(super) fn round_length(most: f64) -> f64 {
    let power = 10_f64.powf(most.max(1.0).log10().floor());
    [5.0, 2.0].into_iter().map(|factor| factor * power).find(|length| *length <= most).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_have_round_lengths() {
        for (most, length) in [(0.3, 1.0), (1.0, 1.0), (4.9, 2.0), (6.0, 5.0), (99.0, 50.0), (100.0, 100.0)] {
            assert!((round_length(most) - length).abs() < 1e-9, "{most}");
        }
    }

    #[test]
    fn ticks_are_round_numbers_inside() {
        assert_eq!(ticks((-14.0, 225.0), 9), [0.0, 50.0, 100.0, 150.0, 200.0]);
        assert_eq!(ticks((-3.9, 5.9), 5), [-2.0, 0.0, 2.0, 4.0]);
        assert_eq!(ticks((1180.0, 1221.0), 3), [1180.0, 1200.0, 1220.0]);
        assert_eq!(ticks((3.0, 3.0), 5), [0.0; 0]);
        assert_eq!(ticks((0.0, 1.0), 0), [0.0; 0]);
    }

    #[test]
    fn a_range_contains_its_values_and_is_never_empty() {
        for values in [&[3.0, 3.0][..], &[], &[f64::NAN, -5.0, 9.0], &[f64::INFINITY, 0.0], &[1e300, -1e300]]
        {
            let (low, high) = around(values.iter().copied(), 2.0);
            assert!(low.is_finite() && high.is_finite() && high - low >= 2.0, "{values:?}: {low} {high}");
            for value in values.iter().filter(|value| value.is_finite() && value.abs() < 1e7) {
                assert!((low..=high).contains(value), "{values:?}: {low} {high}");
            }
        }
        assert_eq!(around([0.0, 100.0].into_iter(), 1.0), (0.0, 106.0), "not below zero");
    }
}
