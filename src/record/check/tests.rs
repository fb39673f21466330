//! The four forms of a checked run.
