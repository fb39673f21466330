//! The recorded flight that a session shows.

use std::sync::Arc;

use crate::replay::Overview;

/// The recorded flight that is shown.
#[derive(Debug, Clone, Default)]
pub struct ReplayView {
    /// The name of the file, safe to print.
    pub file: Arc<str>,
    /// The number of the flight in the file, from zero, and the number of all.
    pub number: usize,
    pub count: usize,
    /// While the file is read: the share that was read, 0…1.
    pub reading: Option<f64>,
    /// The whole flight. Another flight has another overview.
    pub overview: Arc<Overview>,
    /// The values of all series at the shown instant; NaN for an unknown one.
    pub values: Arc<Vec<f64>>,
}
