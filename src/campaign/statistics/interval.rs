//! Intervals for shares.

use crate::design::normal_quantile;

/// Returns Wilson's score interval for a share: `hits` of `count`, with this confidence on both sides together. Without
/// flights it is 0 to 1.
pub fn wilson(hits: u64, count: u64, confidence: f64) -> (f64, f64) {
    if count == 0 {
        return (0.0, 1.0);
    }
    let z = normal_quantile(0.5 + confidence / 2.0);
    let (n, share) = (count as f64, hits as f64 / count as f64);
    let z2n = z * z / n;
    let middle = (share + z2n / 2.0) / (1.0 + z2n);
    let half = z / (1.0 + z2n) * (share * (1.0 - share) / n + z2n / (4.0 * n)).sqrt();
    let low = if hits == 0 { 0.0 } else { (middle - half).max(0.0) };
    let high = if hits == count { 1.0 } else { (middle + half).min(1.0) };
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_the_closed_form() {
        // The roots of (p − share)² = z² · p · (1 − p) / n.
        for (hits, count, confidence) in [(15, 20, 0.95), (987, 1000, 0.95), (1, 40, 0.99), (500, 1000, 0.9)]
        {
            let (low, high) = wilson(hits, count, confidence);
            let z = normal_quantile(0.5 + confidence / 2.0);
            let (n, share) = (count as f64, hits as f64 / count as f64);
            for root in [low, high] {
                let left = (root - share).powi(2);
                let right = z * z * root * (1.0 - root) / n;
                assert!((left - right).abs() < 1e-12, "{hits} of {count}: {root}");
            }
            assert!(low < share && share < high);
        }
    }

    #[test]
    fn all_or_none_still_have_an_interval() {
        // n / (n + z²)
        let (low, high) = wilson(100, 100, 0.95);
        assert!((low - 100.0 / (100.0 + 1.959_963_984_540_054_f64.powi(2))).abs() < 1e-12);
        assert!((high - 1.0).abs() < 1e-15);
        let (low, high) = wilson(0, 100, 0.95);
        // z² / (n + z²)
        let z2 = 1.959_963_984_540_054_f64.powi(2);
        assert!(low.abs() < 1e-15 && (high - z2 / (100.0 + z2)).abs() < 1e-12, "{high}");
        assert_eq!(wilson(0, 0, 0.95), (0.0, 1.0));
    }
}
