//! Designs of experiments: the values that the inputs of many flights get.
//!
//! ```text
//! name of an input, index of a flight, seed ── Points ──▶ a number between 0 and 1
//!                                                          │ Distribution, WindTable
//!                                                          ▼
//!                                                       the value of the input
//! ```
//!
//! Each input has a stream of random numbers of its own, keyed by its name. Adding an input does not change the values of
//! the others. The value of a flight needs no other flight, so any flight can be made alone, in any order and on any
//! machine. The numbers are the same to the last bit everywhere: they come from integers, and from `libm` where a
//! distribution needs a function.

mod distribution;
mod latin;
mod normal;
mod points;
mod sobol;
mod stream;
mod wind_table;

pub use distribution::{Distribution, DistributionError};
pub use normal::{normal_cdf, normal_quantile};
pub use points::{Design, Points};
pub use sobol::DIMENSIONS;
pub use stream::{Stream, fingerprint};
pub use wind_table::{DrawnWind, Forecast, Rose, WindTable};
