//! Campaigns as text: the lines of a run's file, and the answer as sentences, JSON, Markdown, JUnit and CSV.

mod csv;
mod forecast;
mod header;
mod json;
mod junit;
mod line;
mod markdown;
pub(super) mod sentences;
pub(super) mod shown;

use crate::campaign::{Answer, Shard};

pub use csv::CsvTable;
pub use forecast::{forecast_json, forecast_notice, forecast_reason, forecast_sentence};
pub use header::{Contents, Definition, OtherSide, RunHeader};
pub use json::answer_json;
pub use junit::answer_junit;
pub use line::{LineError, read_record, record_line};
pub use markdown::answer_markdown;
pub use sentences::answer_sentences;

/// The answer of a campaign with what its reports need beside it.
#[derive(Debug, Clone)]
pub struct Reported<'a> {
    pub answer: &'a Answer,
    /// The name of the scenario or plan.
    pub name: &'a str,
    /// The version of the program.
    pub version: &'a str,
    /// The design; `None` if the flights are those that `check` flies.
    pub design: Option<String>,
    /// The file of the flights, for the commands that open them.
    pub run: Option<&'a str>,
    /// The names of the two sides of a comparison.
    pub sides: Option<[String; 2]>,
    /// The part of the campaign that was flown, if it is not the whole.
    pub shard: Option<Shard>,
}
