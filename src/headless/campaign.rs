//! `betadeck campaign`: many flights of a scenario or a plan on all processors, and their answer.

mod consent;
mod definition;
mod fly;
mod forecast;
mod loaded;
mod merge;
mod of_plan;
mod outputs;
mod progress;
mod run_file;
mod shard;
mod sources;
mod sweep;

use crate::args::{CampaignArgs, CampaignCommand, ForecastArgs};
use crate::process::build::Build;
use crate::process::error::AppError;
pub(crate) use consent::Consent;
pub(crate) use loaded::{OneFlight, open_flight};

/// Flies, or merges the parts of a campaign. `repeat` has the words that give the run again. The exit code is 0 if every
/// expectation was met.
pub(crate) fn run(args: &CampaignArgs, repeat: &[String]) -> Result<u8, AppError> {
    match &args.command {
        Some(CampaignCommand::Merge(args)) => merge::run(args, repeat),
        None => match args.sweep {
            Some(fault) => sweep::run(args, fault, repeat),
            None => fly::run(args, repeat),
        },
    }
}

/// Flies a plan in the weather to come. The exit code is 0 if the answer is go.
pub(crate) fn forecast(args: &ForecastArgs, repeat: &[String]) -> Result<u8, AppError> {
    forecast::run(args, repeat)
}

/// Returns the version that flies, which is in every line.
fn version() -> String {
    format!("{} {}", env!("CARGO_PKG_VERSION"), Build::get().revision)
}
