//! Campaigns: many flights of one scenario, and the answer that they give together.
//!
//! ```text
//! Scenario ── Campaign ──▶ CampaignFlight: the case, the air and the inputs of flight 1234
//!                              │ flown and judged elsewhere
//!                              ▼
//!                           Record ── AnswerBuilder ──▶ Answer: success, distributions, causes, worst flights, goals
//! ```
//!
//! A flight needs only its number, so it can be made alone, on any machine, and again. The answer takes records one at a
//! time and keeps a bounded part of them. `statistics` has the mathematics. [`Shard`] divides the flights among machines.

mod answer;
mod draw;
mod flights;
mod forecast;
mod record;
mod shard;
mod statistics;
mod weather;

pub use answer::{
    Answer, AnswerBuilder, Cause, Causes, Distribution, FailureClass, GoalOutcome, JudgedGoal,
    MetricDifference, Scatter, ScatterPoint, Success, Values, Versus, Worst,
};
pub use flights::{Campaign, CampaignFlight};
pub use forecast::{Forecast, ForecastAnswer};
pub use record::{InputValue, Instant, Record, Side, Standing};
pub use shard::{Shard, ShardError};
pub use statistics::{Rule, Significance, Split, Summary, mcnemar, signed_rank, wilson};
pub use weather::wind_around;

#[cfg(test)]
mod tests;
