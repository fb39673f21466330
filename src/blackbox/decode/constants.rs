//! The numbers of a header to which predictors add.

/// The header's numbers to which predictors add.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Constants {
    pub(super) min_throttle: i32,
    pub(super) vbat_reference: i32,
    pub(super) min_motor: i32,
}
