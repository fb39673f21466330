//! What flies with whole vehicles and is judged: forecasts, sweeps, recordings, drafts of scenarios.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may stop and say what it expects")]

mod battery;
mod drafts;
mod forecasts;
mod sessions;
mod sweeps;
