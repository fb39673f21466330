//! The arguments of `convert`.

use std::path::Path;

use crate::plan::format::Format;

use super::value::{self, OutputFile};
use super::{PlanArg, PlanArgError};

/// The options of `convert`.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct ConvertArgs {
    /// Plan to read: a built-in plan's name, a file, or - for standard input
    #[arg(value_name = "IN")]
    input: String,

    /// File to write, or - for standard output
    #[arg(value_name = "OUT")]
    pub output: OutputFile,

    /// Format of IN: toml, txt [default: by its ending; of standard input: by its text]
    #[arg(long, value_name = "FORMAT", value_parser = value::format)]
    from: Option<Format>,

    /// Format of OUT: toml, txt [default: by its ending]
    #[arg(long, value_name = "FORMAT", value_parser = value::format)]
    to: Option<Format>,

    /// Replaces an existing OUT
    #[arg(long)]
    pub force: bool,
}

impl ConvertArgs {
    /// Returns the source. With `--from`, every name is the name of a file.
    ///
    /// # Errors
    ///
    /// Returns an error if the name is not a plan. This cannot happen after [`super::parse`], which checks it.
    pub fn source(&self) -> Result<PlanArg, PlanArgError> {
        match self.from {
            Some(format) if self.input == "-" => Ok(PlanArg::Stdin(Some(format))),
            Some(format) => Ok(PlanArg::File(self.input.clone().into(), Some(format))),
            None => self.input.parse(),
        }
    }

    /// Returns the format of the output.
    ///
    /// # Errors
    ///
    /// Returns an error if neither `--to` nor the ending of OUT gives it. This cannot happen after [`super::parse`],
    /// which checks it.
    pub fn target(&self) -> Result<Format, String> {
        let by_ending = |path: &Path| Format::from_file_name(&path.to_string_lossy());
        let found = self.to.or_else(|| match &self.output {
            OutputFile::Stdout => None,
            OutputFile::File(path) => by_ending(path),
        });
        found.ok_or_else(|| match &self.output {
            OutputFile::Stdout => {
                "the format of standard output is not given: add --to toml or --to txt".to_owned()
            }
            OutputFile::File(path) => format!(
                "{} has none of the endings {}: add --to toml or --to txt",
                path.display(),
                Format::endings()
            ),
        })
    }

    /// Checks the combination of the typed options.
    pub(super) fn check(&self) -> Result<(), String> {
        self.source().map_err(|error| format!("{}: {error}", self.input))?;
        self.target().map(drop)
    }
}
