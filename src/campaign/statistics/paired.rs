//! Comparisons of two sides that flew the same inputs.

use super::Significance;
use super::binomial::at_most;
use super::ranks::ranks;
use crate::design::normal_cdf;
use crate::math;

/// The most pairs for which the distribution of the ranks is counted. Beyond, the normal distribution is as good.
const COUNTED: usize = 50;

/// Returns McNemar's exact test: of the pairs in which only one side succeeded, how many were won by each.
pub fn mcnemar(only_a: u64, only_b: u64) -> Significance {
    Significance { p: sign(only_a, only_b), test: "McNemar" }
}

/// Returns Wilcoxon's signed-rank test of the differences of the pairs: exact for few pairs, else by the normal
/// distribution. `None` if all pairs are equal.
pub fn signed_rank(differences: &[f64]) -> Option<Significance> {
    let differences: Vec<f64> = differences
        .iter()
        .copied()
        .filter(|difference| difference.is_finite() && *difference != 0.0)
        .collect();
    if differences.is_empty() {
        return None;
    }
    let sizes: Vec<f64> = differences.iter().map(|difference| difference.abs()).collect();
    let ranks = ranks(&sizes);
    let n = ranks.len() as f64;
    let of_positive = std::iter::zip(&differences, &ranks).filter(|(difference, _)| **difference > 0.0);
    let positive: f64 = of_positive.map(|(_, rank)| rank).sum();
    let p = if ranks.len() <= COUNTED { counted(&ranks, positive) } else { approximate(sizes, n, positive) };
    Some(Significance { p: p.min(1.0), test: "Wilcoxon" })
}

/// Returns the probability of a sum of positive ranks at least as far from its mean, if each sign is as likely.
fn counted(ranks: &[f64], positive: f64) -> f64 {
    // Equal sizes share halves of ranks, so doubled ranks are whole.
    let doubled: Vec<usize> = ranks.iter().map(|rank| (2.0 * rank).round() as usize).collect();
    let all: usize = doubled.iter().sum();
    // `ways[sum]` is the probability of a doubled sum.
    let mut ways = vec![0.0; all + 1];
    ways[0] = 1.0;
    for rank in doubled {
        for sum in (0..ways.len()).rev() {
            let with = sum.checked_sub(rank).map_or(0.0, |without| ways[without]);
            ways[sum] = f64::midpoint(ways[sum], with);
        }
    }
    let low = ((2.0 * positive).round() as usize).min(all - (2.0 * positive).round() as usize);
    2.0 * ways.iter().take(low + 1).sum::<f64>()
}

/// Returns the same by the normal distribution.
fn approximate(mut sizes: Vec<f64>, n: f64, positive: f64) -> f64 {
    let mean = n * (n + 1.0) / 4.0;
    // Equal sizes share their rank, which takes a part of the variance.
    sizes.sort_by(f64::total_cmp);
    let groups = sizes.chunk_by(|a, b| a == b);
    let ties: f64 = groups.map(|group| math::powi(group.len() as f64, 3) - group.len() as f64).sum();
    let variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0;
    let z = (positive - mean) / variance.sqrt();
    2.0 * normal_cdf(-z.abs())
}

/// Returns the probability of counts at least as different, if both are as likely.
fn sign(a: u64, b: u64) -> f64 {
    (2.0 * at_most(a.min(b), a + b, 0.5)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mcnemars_test_is_a_binomial_test() {
        // 2 · (C(10,0) + C(10,1) + C(10,2)) / 2¹⁰
        assert!((mcnemar(2, 8).p - 112.0 / 1024.0).abs() < 1e-12);
        assert!((mcnemar(5, 5).p - 1.0).abs() < 1e-12);
        assert!((mcnemar(0, 0).p - 1.0).abs() < 1e-12);
        assert!(mcnemar(5, 41).is_real());
    }

    #[test]
    fn the_ranks_of_few_differences_are_counted() {
        // All of 12 differences are positive: 2 of 2¹² signs.
        let differences: Vec<f64> = (1..=12).map(f64::from).collect();
        assert!((signed_rank(&differences).unwrap().p - 2.0 / 4096.0).abs() < 1e-15);
        // 1 and 2 of five are negative, 3 in all: {}, {1}, {2}, {3} and {1, 2} have at most that, of 32.
        let found = signed_rank(&[-0.1, -0.2, 0.3, 0.0, 0.4, 0.5]).unwrap();
        assert!((found.p - 10.0 / 32.0).abs() < 1e-15);
        // Equal sizes share the ranks 1.5: {} and the two of one of them have at most 1.5, of 8.
        assert!((signed_rank(&[-2.0, 2.0, 5.0]).unwrap().p - 6.0 / 8.0).abs() < 1e-15);
        assert_eq!(signed_rank(&[0.0, 0.0, f64::NAN]), None);
    }

    #[test]
    fn both_distributions_agree_where_they_meet() {
        let differences: Vec<f64> =
            (1..=50).map(|size| if size % 3 == 0 { -f64::from(size) } else { f64::from(size) }).collect();
        let ranks: Vec<f64> = (1..=50).map(f64::from).collect();
        let positive: f64 = differences.iter().filter(|difference| **difference > 0.0).sum();
        let (exact, normal) = (counted(&ranks, positive), approximate(ranks.clone(), 50.0, positive));
        assert!((exact - normal).abs() < 1e-3, "{exact} {normal}");
    }
}
