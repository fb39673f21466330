//! The PLAN argument: a built-in plan, a file, or standard input.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::plan::builtin::{BuiltinPlan, PLANS};
use crate::plan::format::Format;
use crate::plan::format::loss::Finding;

/// The source of a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PlanArg {
    /// A plan of the executable.
    Builtin(BuiltinPlan),
    /// Standard input in a format; `None` = the format of the contents.
    Stdin(Option<Format>),
    /// A file or a pipe in a format; `None` = the format of the contents.
    File(PathBuf, Option<Format>),
}

/// Returns `true` if a path names an open descriptor of this process. Shells write pipes in this way.
pub fn is_descriptor(path: &Path) -> bool {
    let Some(text) = path.to_str() else { return false };
    let number = text.strip_prefix("/dev/fd/").or_else(|| text.strip_prefix("/proc/self/fd/"));
    let is_number = |digits: &str| !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
    text == "/dev/stdin" || number.is_some_and(is_number)
}

/// The reason why a text is not a plan.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "it is neither a built-in plan nor a file extension in {extensions}{guess} (built in: {builtin})",
    extensions = Format::extensions(),
    builtin = PLANS.iter().map(|plan| plan.name).collect::<Vec<_>>().join(", ")
)]
pub struct PlanArgError {
    guess: String,
}

impl FromStr for PlanArg {
    type Err = PlanArgError;

    fn from_str(text: &str) -> Result<Self, PlanArgError> {
        if text == "-" {
            return Ok(Self::Stdin(None));
        }
        if let Some(plan) = BuiltinPlan::find(text) {
            return Ok(Self::Builtin(plan));
        }
        if Format::is_plan_name(text) || is_descriptor(Path::new(text)) {
            return Ok(Self::File(text.into(), None));
        }
        let guess = BuiltinPlan::suggest(text);
        Err(PlanArgError { guess: guess.map_or_else(String::new, |name| format!("; did you mean {name}?")) })
    }
}

impl PlanArg {
    /// Returns the format of `contents`, which were read from this source, and a finding if the extension of the file
    /// names another one.
    pub fn format(&self, contents: &[u8]) -> (Format, Option<Finding>) {
        match self {
            Self::Builtin(_) => (Format::Toml, None),
            Self::Stdin(Some(format)) | Self::File(_, Some(format)) => (*format, None),
            Self::Stdin(None) => (Format::from_contents(contents), None),
            Self::File(path, None) => Format::detect(&path.to_string_lossy(), contents),
        }
    }

    /// Returns the path, if the plan comes from a file.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::File(path, _) => Some(path),
            Self::Builtin(_) | Self::Stdin(_) => None,
        }
    }

    /// Returns the name for messages: the file as given, `-`, or the built-in plan's name.
    pub fn display_name(&self) -> String {
        match self {
            Self::Builtin(plan) => plan.name.to_owned(),
            Self::Stdin(_) => "-".to_owned(),
            Self::File(path, _) => path.display().to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_files_and_standard_input() {
        assert!(matches!("square".parse(), Ok(PlanArg::Builtin(plan)) if plan.name == "square"));
        assert_eq!("-".parse(), Ok(PlanArg::Stdin(None)));
        assert_eq!(PlanArg::Stdin(None).format(b"name = 'x'").0, Format::Toml);
        assert_eq!(PlanArg::Stdin(Some(Format::CliText)).format(b"name = 'x'").0, Format::CliText);
        assert_eq!("./square.txt".parse(), Ok(PlanArg::File("./square.txt".into(), None)));
        assert_eq!("square.txt".parse::<PlanArg>().unwrap().display_name(), "square.txt");
    }

    #[test]
    fn the_pipes_of_a_shell_are_plans_in_the_format_of_their_text() {
        for (path, is) in [
            ("/dev/stdin", true),
            ("/dev/fd/63", true),
            ("/proc/self/fd/3", true),
            ("/dev/fd/", false),
            ("/dev/fd/../zero", false),
            ("/dev/zero", false),
        ] {
            assert_eq!(path.parse() == Ok(PlanArg::File(path.into(), None)), is, "{path}");
        }
        assert_eq!(PlanArg::File("/dev/fd/63".into(), None).format(b"name = 'x'").0, Format::Toml);
    }

    #[test]
    fn anything_else_is_refused_with_a_guess() {
        let error = "sqare".parse::<PlanArg>().unwrap_err().to_string();
        assert!(
            error.contains(".toml, .txt")
                && error.contains("did you mean square? (built in: square, flyover"),
            "{error}"
        );
        assert!("plan.doc".parse::<PlanArg>().is_err());
    }
}
