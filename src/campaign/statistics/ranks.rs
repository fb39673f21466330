//! Rank correlation.

use statrs::function::beta::beta_reg;

/// A rank correlation with its significance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::campaign) struct Correlation {
    /// Spearman's coefficient, −1…1.
    pub(in crate::campaign) rho: f64,
    /// The probability of one at least as great, if there is none in truth.
    pub(in crate::campaign) p: f64,
}

/// Returns the ranks of values, from 1; equal values share the mean of their ranks.
pub(super) fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for group in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let mean = first as f64 + (group.len() as f64 + 1.0) / 2.0;
        group.iter().for_each(|&at| ranks[at] = mean);
        first += group.len();
    }
    ranks
}

/// Returns Spearman's rank correlation of pairs of finite values; `None` if one side has only one value.
pub(in crate::campaign) fn spearman(a: &[f64], b: &[f64]) -> Option<Correlation> {
    let (a, b): (Vec<f64>, Vec<f64>) =
        std::iter::zip(a, b).filter(|(a, b)| a.is_finite() && b.is_finite()).unzip();
    let n = a.len() as f64;
    if a.len() < 3 {
        return None;
    }
    let (a, b) = (ranks(&a), ranks(&b));
    let mean = (n + 1.0) / 2.0;
    let sum = |x: &[f64], y: &[f64]| std::iter::zip(x, y).map(|(x, y)| (x - mean) * (y - mean)).sum::<f64>();
    let scale = (sum(&a, &a) * sum(&b, &b)).sqrt();
    if scale <= 0.0 {
        return None;
    }
    let rho = (sum(&a, &b) / scale).clamp(-1.0, 1.0);
    Some(Correlation { rho, p: two_sided_t(rho, n - 2.0) })
}

/// Returns the probability of a correlation at least as great in both directions, by Student's distribution.
fn two_sided_t(rho: f64, freedom: f64) -> f64 {
    // With t² = ρ² · f / (1 − ρ²), f / (f + t²) is 1 − ρ².
    match 1.0 - rho * rho {
        rest if rest <= 0.0 => 0.0,
        rest => beta_reg(freedom / 2.0, 0.5, rest),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_share_their_rank() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0]), [3.5, 1.0, 3.5, 2.0]);
        assert_eq!(ranks(&[]), [0.0; 0]);
    }

    #[test]
    fn without_ties_it_is_the_sum_of_the_squared_differences() {
        let a = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let b = [2.0, 1.0, 4.0, 3.0, 7.0, 5.0, 6.0];
        // 1 − 6 · Σd² / (n (n² − 1)) with Σd² = 1+1+1+1+4+1+1 = 10.
        let found = spearman(&a, &b).unwrap();
        assert!((found.rho - (1.0 - 60.0 / 336.0)).abs() < 1e-12);
        // t = ρ √(f / (1 − ρ²)) = 3.2223 with 5 degrees of freedom.
        assert!((found.p - 0.0234).abs() < 1e-3, "{}", found.p);
    }

    #[test]
    fn a_monotone_relation_is_perfect_and_a_constant_has_none() {
        let a: Vec<f64> = (1..50).map(f64::from).collect();
        let cubes: Vec<f64> = a.iter().map(|x| x.powi(3)).collect();
        let found = spearman(&a, &cubes).unwrap();
        assert!((found.rho - 1.0).abs() < 1e-12 && found.p < 1e-12);
        assert_eq!(spearman(&a, &[2.0; 49]), None);
        assert_eq!(spearman(&[1.0, f64::NAN, 2.0], &[1.0, 2.0, 3.0]), None, "two pairs are too few");
    }
}
