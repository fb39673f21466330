//! Whole missions by the scripted pilot, judged by the truth.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::needless_pass_by_value,
    reason = "helpers of tests fail and show as tests do"
)]

mod mission;
mod random;
mod takeoff;
mod thrust;
