//! The mathematics of an answer: intervals, distributions, correlations, splits and paired comparisons.

mod binomial;
mod interval;
mod paired;
mod ranks;
mod split;
mod summary;

pub(super) use binomial::order_bound;
pub use interval::wilson;
pub use paired::{mcnemar, signed_rank};
pub(super) use ranks::{Correlation, spearman};
pub use split::{Rule, Split};
pub(super) use split::{best_split, best_word_split};
pub use summary::Summary;

/// The probability of a difference that is at least as great as the one seen, if there is none in truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Significance {
    pub p: f64,
    /// The name of the test.
    pub test: &'static str,
}

impl Significance {
    /// The probability below which a difference counts as real.
    pub const LEVEL: f64 = 0.05;

    /// Returns `true` if chance hardly explains the difference.
    pub fn is_real(&self) -> bool {
        self.p < Self::LEVEL
    }
}
