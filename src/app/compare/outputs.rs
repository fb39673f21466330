//! The outputs of a comparison.

use crate::app::output_file::FinalOutput;
use crate::app::{AppError, error, setup};
use crate::args::{CompareArgs, OutputFile};
use crate::report::compare::Comparison;

/// The outputs of a comparison.
#[derive(Debug)]
pub(super) struct Outputs {
    /// `true` if JSON goes to standard output instead of the table.
    json_on_stdout: bool,
    json: Option<FinalOutput>,
    svg: Option<FinalOutput>,
}

impl Outputs {
    /// Checks that the files can be written, so that no flight is wasted. The files stay unchanged.
    pub(super) fn prepare(args: &CompareArgs) -> Result<Self, AppError> {
        let json = match &args.json {
            Some(OutputFile::File(path)) => Some(path),
            Some(OutputFile::Stdout) | None => None,
        };
        let mut kept = setup::kept_files(&args.flight, Some(&args.plan));
        for (option, path) in [("--json", json), ("--svg", args.svg.as_ref())] {
            path.map_or(Ok(()), |path| kept.claim(option, path))?;
        }
        Ok(Self {
            json_on_stdout: args.json == Some(OutputFile::Stdout),
            json: json.map(|path| FinalOutput::prepare(path)).transpose()?,
            svg: args.svg.as_deref().map(FinalOutput::prepare).transpose()?,
        })
    }

    /// Writes all outputs, even if one of them fails.
    pub(super) fn write(self, comparison: &Comparison) -> Result<(), AppError> {
        let json = format!("{}\n", comparison.json());
        let shown = match self.json_on_stdout {
            true => error::write_stdout(json.as_bytes()),
            false => error::print(&comparison.text()),
        };
        let to =
            |file: Option<FinalOutput>, text: &str| file.map_or(Ok(()), |file| file.write(text.as_bytes()));
        let written = [to(self.json, &json), to(self.svg, &comparison.svg())];
        shown?;
        written.into_iter().collect()
    }
}
