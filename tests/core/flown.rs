//! Whole flights through forecasts, sweeps and recordings, and the scenarios written of them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may stop and say what it expects")]

mod battery;
mod drafts;
mod forecasts;
mod sessions;
mod sweeps;
