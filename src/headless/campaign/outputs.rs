//! The outputs of a campaign: the table of its flights, and the answer in all its forms.

use std::path::{Path, PathBuf};

use crate::args::{CampaignOutputArgs, OutputFile};
use crate::campaign::{Answer, AnswerBuilder, Record, Shard, Standing};
use crate::files::output_file::{FinalOutput, KeptFiles, StreamedOutput};
use crate::headless::campaign::loaded::Loaded;
use crate::headless::{report, setup};
use crate::process::error;
use crate::process::error::AppError;
use crate::report::campaign::{
    CsvTable, Reported, answer_json, answer_junit, answer_markdown, answer_sentences,
};
use crate::report::html::{CampaignPage, campaign_page};
use crate::scenario::Metric;
use strum::IntoEnumIterator as _;

/// The outputs.
pub(super) struct Outputs {
    builder: AnswerBuilder,
    csv: Option<Table>,
    json: Option<Json>,
    junit: Option<FinalOutput>,
    markdown: Option<FinalOutput>,
    report: Option<FinalOutput>,
    /// The number of flights that failed.
    failed: u64,
}

struct Table {
    table: CsvTable,
    output: StreamedOutput,
}

enum Json {
    Stdout,
    File(FinalOutput),
}

/// The names that an answer needs.
pub(super) struct Titles<'a> {
    pub(super) loaded: &'a Loaded,
    /// The file of the flights.
    pub(super) run: Option<&'a Path>,
    pub(super) shard: Shard,
    /// The command that gives the answer again.
    pub(super) command: &'a str,
}

/// Checks that no output replaces an input, another output, or a file of the program.
pub(super) fn claim(
    args: &CampaignOutputArgs,
    out: Option<&Path>,
    inputs: &[PathBuf],
) -> Result<(), AppError> {
    let mut kept = KeptFiles::default();
    for input in inputs {
        kept.keep("a file of the campaign", input);
    }
    setup::keep_own_files(&mut kept);
    let json = match &args.json {
        Some(OutputFile::File(path)) => Some(path.as_path()),
        Some(OutputFile::Stdout) | None => None,
    };
    [
        ("--out", out),
        ("--csv", args.csv.as_deref()),
        ("--json", json),
        ("--junit", args.junit.as_deref()),
        ("--markdown", args.markdown.as_deref()),
        ("--report", args.report.as_deref()),
    ]
    .into_iter()
    .filter_map(|(option, path)| Some((option, path?)))
    .try_for_each(|(option, path)| kept.claim(option, path))
}

impl Outputs {
    /// Opens the outputs. The results of an earlier run are removed.
    pub(super) fn begin(args: &CampaignOutputArgs, loaded: &Loaded, shard: Shard) -> Result<Self, AppError> {
        let begin = |path: &Option<PathBuf>| path.as_deref().map(FinalOutput::begin).transpose();
        let json = match &args.json {
            None => None,
            Some(OutputFile::Stdout) => Some(Json::Stdout),
            Some(OutputFile::File(path)) => Some(Json::File(FinalOutput::begin(path)?)),
        };
        let wanted = shard.flights(loaded.header.flights).count() as u64;
        let has_two_sides = loaded.header.sides() > 1;
        let builder = AnswerBuilder::new(loaded.campaign.scenario(), wanted, has_two_sides);
        let csv = args.csv.as_ref().map(|path| Table::begin(path, loaded)).transpose()?;
        let (junit, markdown, report) = (begin(&args.junit)?, begin(&args.markdown)?, begin(&args.report)?);
        Ok(Self { builder, csv, json, junit, markdown, report, failed: 0 })
    }

    /// Adds a flight, old or new.
    pub(super) fn add(&mut self, record: &Record) -> Result<(), AppError> {
        self.failed += u64::from(record.standing == Standing::Failed);
        self.builder.add(record);
        self.csv.as_mut().map_or(Ok(()), |csv| csv.write(&csv.table.line(record)))
    }

    /// Returns the number of flights that failed.
    pub(super) fn failed(&self) -> u64 {
        self.failed
    }

    /// Writes the answer of the flights so far, and returns it.
    pub(super) fn finish(self, titles: &Titles<'_>) -> Result<Answer, AppError> {
        let mut answer = self.builder.answer();
        if titles.shard != Shard::WHOLE {
            // The goals are about all flights.
            answer.goals.clear();
        }
        let header = &titles.loaded.header;
        let run = titles.run.map(|path| path.display().to_string());
        let sides = header.definition.versus.as_ref().map(|side| [name_of_a(header), name_of_b(side)]);
        let reported = Reported {
            answer: &answer,
            name: &header.name,
            version: &header.version,
            design: titles.loaded.campaign.design().map(|design| design.to_string()),
            run: run.as_deref(),
            sides,
            shard: (titles.shard != Shard::WHOLE).then_some(titles.shard),
        };
        let json = match self.json {
            None => error::print(&(answer_sentences(&reported).join("\n") + "\n")).map(drop),
            Some(Json::Stdout) => error::write_stdout((answer_json(&reported) + "\n").as_bytes()).map(drop),
            Some(Json::File(file)) => {
                let printed = error::print(&(answer_sentences(&reported).join("\n") + "\n")).map(drop);
                printed.and(file.write((answer_json(&reported) + "\n").as_bytes()))
            }
        };
        let to = |file: Option<FinalOutput>, text: &dyn Fn() -> String| {
            file.map_or(Ok(()), |file| file.write(text().as_bytes()))
        };
        // Each file is written, even if another one fails.
        let written = [
            json,
            self.csv.map_or(Ok(()), |csv| csv.output.finish()),
            to(self.junit, &|| answer_junit(&reported)),
            to(self.markdown, &|| answer_markdown(&reported)),
            to(self.report, &|| page(&reported, titles.command)),
        ];
        written.into_iter().collect::<Result<(), AppError>>()?;
        Ok(answer)
    }
}

fn page(reported: &Reported<'_>, command: &str) -> String {
    let page = CampaignPage { kind: "Campaign by betadeck", reported, verdict: None, command: Some(command) };
    campaign_page(&page, &report::program())
}

fn name_of_a(header: &crate::report::campaign::RunHeader) -> String {
    header.definition.firmware.get(1).map_or_else(|| "as given".to_owned(), Clone::clone)
}

fn name_of_b(side: &crate::report::campaign::OtherSide) -> String {
    let mut parts = side.settings.clone();
    if side.has_firmware {
        parts.push(side.firmware.get(1).map_or_else(|| "the embedded firmware".to_owned(), Clone::clone));
    }
    parts.join(", ")
}

impl Table {
    fn begin(path: &Path, loaded: &Loaded) -> Result<Self, AppError> {
        let inputs = loaded.campaign.flight(1).map(|flight| flight.inputs).unwrap_or_default();
        let mut inputs: Vec<String> = inputs.into_iter().map(|(name, _)| name).collect();
        inputs.sort();
        let measures = loaded.campaign.scenario().cases.iter().flat_map(|case| &case.measures);
        let mut metrics: Vec<String> = Metric::iter().map(|metric| metric.to_string()).collect();
        for measure in measures {
            if !metrics.contains(&measure.name) {
                metrics.push(measure.name.clone());
            }
        }
        let table = CsvTable::new(inputs, metrics);
        let mut csv = Self { output: StreamedOutput::begin(path)?, table };
        csv.write(&csv.table.head())?;
        Ok(csv)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), AppError> {
        self.output.add(bytes)
    }
}
