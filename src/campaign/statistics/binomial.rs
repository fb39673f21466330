//! The binomial distribution, and the bounds of quantiles that follow from it.

use statrs::function::beta::beta_reg;

/// Returns the probability of at most `hits` of `count` with a probability of `share` each.
pub(super) fn at_most(hits: u64, count: u64, share: f64) -> f64 {
    if hits >= count {
        return 1.0;
    }
    if share <= 0.0 {
        return 1.0;
    }
    if share >= 1.0 {
        return 0.0;
    }
    beta_reg((count - hits) as f64, hits as f64 + 1.0, 1.0 - share)
}

/// Returns the rank, from 1, of the value in an ordered sample that is an upper bound of a quantile with this confidence;
/// `None` if the sample is too small for one. A lower bound is the upper one of the complement, counted from the other end.
pub(in crate::campaign) fn order_bound(count: u64, quantile: f64, confidence: f64) -> Option<u64> {
    // The rank r is a bound if at least so many samples as the confidence says have fewer than r values below the quantile.
    let (mut low, mut high) = (1, count);
    let is_bound = |rank: u64| at_most(rank - 1, count, quantile) >= confidence;
    if count == 0 || !is_bound(count) {
        return None;
    }
    while low < high {
        let middle = low + (high - low) / 2;
        if is_bound(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    Some(low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_are_sums_of_the_terms() {
        for (count, share) in [(10_u64, 0.3), (25, 0.5), (40, 0.95)] {
            let mut sum = 0.0;
            for hits in 0..=count {
                let ways: f64 = (1..=hits).map(|k| (count + 1 - k) as f64 / k as f64).product();
                sum += ways * f64::powi(share, hits as i32) * f64::powi(1.0 - share, (count - hits) as i32);
                let found = at_most(hits, count, share);
                assert!((found - sum).abs() < 1e-10, "{hits} of {count}: {found} {sum}");
            }
        }
    }

    #[test]
    fn a_bound_of_a_quantile_is_an_order_statistic() {
        // The greatest of 59 values exceeds the 95th percentile with 95 %: 1 − 0.95⁵⁹ = 0.9515.
        assert_eq!(order_bound(58, 0.95, 0.95), None);
        assert_eq!(order_bound(59, 0.95, 0.95), Some(59));
        // The median of 10: P(at most 7 below) = 0.9453, P(at most 8 below) = 0.9893.
        assert_eq!(order_bound(10, 0.5, 0.95), Some(9));
        assert_eq!(order_bound(0, 0.5, 0.95), None);
        let rank = order_bound(1_000_000, 0.95, 0.95).unwrap();
        // Mean and 1.645 standard deviations.
        assert!((rank as f64 - (950_000.0 + 1.645 * 217.94)).abs() < 3.0, "{rank}");
    }
}
