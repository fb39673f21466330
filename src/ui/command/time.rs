//! Commands about time.

use crate::runner::SPEED_RANGE;
use crate::session::policy::{self, Facts, Intent};
use crate::ui::model::message::Request;
use crate::ui::shared::Shared;

/// Runs `speed 4` or `speed max`.
pub(super) fn speed(state: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    policy::check(&Facts::from(&state.view), Intent::Time).map_err(|refusal| refusal.to_string())?;
    let (slowest, fastest) = SPEED_RANGE.into_inner();
    let factor =
        match argument.trim_end_matches(['x', '×']) {
            "ma" | "max" => f64::INFINITY,
            text => text.parse().ok().filter(|factor| SPEED_RANGE.contains(factor)).ok_or_else(|| {
                format!("Write a factor from {slowest} to {fastest} times real time, or max.")
            })?,
        };
    state.say_speed_in_pause(factor);
    Ok(vec![state.request_speed(factor).into()])
}

pub(super) fn complete_speed(_: &Shared, _: &str, typed: &str) -> Vec<String> {
    let usual = ["0.1", "0.25", "0.5", "1", "2", "4", "8", "16", "64", "max"];
    usual.into_iter().filter(|factor| factor.starts_with(typed)).map(str::to_owned).collect()
}
