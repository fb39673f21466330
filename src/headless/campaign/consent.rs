//! The consent to start an executable that the file of a run names. A file is data: it starts no program by itself.

use std::path::Path;

use crate::args::FirmwareChoice;
use crate::headless::campaign::definition::executable_of;
use crate::process::error::AppError;

/// The consent on the command line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Consent<'a> {
    /// The option `--firmware`.
    pub(crate) firmware: Option<&'a FirmwareChoice>,
    /// The option `--yes`.
    pub(crate) yes: bool,
}

impl Consent<'_> {
    /// Checks that the executable in the options of a run's firmware may be started. They are empty for the embedded one.
    /// `print` is the fingerprint of the executable: without one, only `--yes` allows it.
    ///
    /// # Errors
    /// Returns a sentence with the executable, its options and the way to allow it.
    pub(crate) fn check(&self, file: &Path, options: &[String], print: Option<&str>) -> Result<(), AppError> {
        let Some(executable) = executable_of(options)?.filter(|_| !self.yes) else { return Ok(()) };
        match self.firmware {
            Some(FirmwareChoice::Executable(given)) if print.is_some() && is_same(given, &executable) => {
                Ok(())
            }
            _ => Err(AppError::input(format!(
                "{} names an executable, {}: a file starts no program by itself; add --firmware {} if it is yours, or \
                 --yes to start what the file names",
                file.display(),
                options.join(" "),
                executable.display()
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

    fn check(given: Option<&str>, yes: bool, words: &[&str], print: Option<&str>) -> Result<(), String> {
        let firmware = given.map(|path| FirmwareChoice::Executable(path.into()));
        let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
        let consent = Consent { firmware: firmware.as_ref(), yes };
        consent.check(Path::new("run.jsonl"), &words, print).map_err(|error| error.to_string())
    }

    #[test]
    fn an_executable_of_a_file_is_started_only_if_it_is_named_again_or_allowed() {
        let print = Some("0123456789abcdef");
        for words in [
            &["--firmware", "./evil.elf"][..],
            &["--firmware=./evil.elf"],
            &["--firmware-arg", "./mine.elf", "--firmware=./evil.elf"],
            &["--firmware", "./evil.elf", "--firmware-arg=--ip"],
        ] {
            let refusal = check(None, false, words, print).expect_err("refused");
            assert!(
                refusal.contains("run.jsonl names an executable") && refusal.contains("evil.elf"),
                "{refusal}"
            );
            assert!(check(Some("./mine.elf"), false, words, print).is_err(), "{words:?}");
            assert!(check(Some("./evil.elf"), false, words, None).is_err(), "no fingerprint: {words:?}");
            assert_eq!(check(Some("./evil.elf"), false, words, print), Ok(()));
            assert_eq!(check(None, true, words, None), Ok(()));
        }
        assert_eq!(check(None, false, &[], None), Ok(()), "the embedded firmware");
    }

    #[test]
    fn options_that_no_campaign_writes_are_refused_also_with_yes() {
        for words in [
            &["--betaloop=/x/bl.txt"][..],
            &["--firmware=attach", "--tcp-port=5761"],
            &["--firmware", "./evil.elf", "--yes"],
            &["--firmware", "./evil.elf", "--clock", "real"],
        ] {
            let refusal = check(Some("./evil.elf"), true, words, Some("print")).expect_err("refused");
            assert!(refusal.contains(words[0]), "{refusal}");
        }
    }
}
