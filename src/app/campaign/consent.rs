//! The consent to start an executable that the file of a run names. A file is data: it starts no program by itself.

use std::path::Path;

use crate::app::AppError;
use crate::args::FirmwareChoice;

/// The consent on the command line.
#[derive(Debug, Clone, Copy)]
pub(in crate::app) struct Consent<'a> {
    /// The option `--firmware`.
    pub(in crate::app) firmware: Option<&'a FirmwareChoice>,
    /// The option `--yes`.
    pub(in crate::app) yes: bool,
}

impl Consent<'_> {
    /// Checks that the executable in the options of a run's firmware may be started. They are empty for the embedded one.
    ///
    /// # Errors
    /// Returns a sentence with the executable, its options and the way to allow it.
    pub(in crate::app) fn check(&self, file: &Path, options: &[String]) -> Result<(), AppError> {
        let Some(executable) = options.get(1).filter(|_| !self.yes) else { return Ok(()) };
        match self.firmware {
            Some(FirmwareChoice::Executable(given)) if is_same(given, Path::new(executable)) => Ok(()),
            _ => Err(AppError::input(format!(
                "{} names an executable, {}: a file starts no program by itself; add --firmware {executable} if it is \
                 yours, or --yes to start what the file names",
                file.display(),
                options.join(" ")
            ))),
        }
    }
}

/// Returns `true` if two paths lead to the same file.
fn is_same(a: &Path, b: &Path) -> bool {
    a == b || a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_executable_of_a_file_is_started_only_if_it_is_named_again_or_allowed() {
        let words: Vec<String> =
            ["--firmware", "./evil.elf", "--fdm-dialect", "iris"].map(str::to_owned).into();
        let check = |firmware: Option<&FirmwareChoice>, yes, words: &[String]| {
            Consent { firmware, yes }.check(Path::new("run.jsonl"), words).map_err(|error| error.to_string())
        };
        let refusal = check(None, false, &words).expect_err("refused");
        assert!(
            refusal.contains("run.jsonl names an executable, --firmware ./evil.elf --fdm-dialect iris"),
            "{refusal}"
        );
        assert!(check(Some(&FirmwareChoice::Executable("other.elf".into())), false, &words).is_err());
        assert!(check(Some(&FirmwareChoice::Executable("./evil.elf".into())), false, &words).is_ok());
        assert!(check(None, true, &words).is_ok());
        assert!(check(None, false, &[]).is_ok(), "the embedded firmware");
    }
}
