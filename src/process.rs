//! The process: its exit codes, its streams, the signals that end it, its threads and its build.

pub(crate) mod build;
pub(crate) mod error;
pub(crate) mod interrupt;
pub(crate) mod parallel;
pub(crate) mod patient_output;
pub(crate) mod runtime;
pub(crate) mod stop_signal;

pub use build::Build;
