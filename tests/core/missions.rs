//! Whole missions flown by the scripted pilot and judged by the true path.

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
