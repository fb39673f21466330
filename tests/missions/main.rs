//! Whole missions by the scripted pilot, judged by the truth.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::needless_pass_by_value,
    reason = "helpers of tests fail and show as tests do"
)]

mod dice;
mod mission;
mod oracle;
mod outages;
mod random;
mod steep;
mod takeoff;
mod thrust;
