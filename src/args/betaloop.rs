//! The file of the betaloop launcher, `config.txt`, which names the SITL executable of its users.

use configparser::ini::{Ini, IniDefault};

/// The section of the launcher.
const SECTION: &str = "Betaloop";
/// The key of the executable. Upper and lower case of keys count as equal.
const EXECUTABLE: &str = "betaflightelf";

/// The contents of the launcher's section.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Betaloop {
    /// The executable as it is written; it may begin with `~`.
    pub executable: String,
    /// Keys of the section that have no effect here.
    pub unused: Vec<String>,
}

/// The reason why a file is not one of the launcher.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BetaloopError {
    /// It does not have the form of such files.
    #[error("it is not a file of sections, names and values: {0}")]
    Form(String),
    /// It belongs to another program.
    #[error("it has no section [{SECTION}]")]
    NoSection,
    /// It names no executable.
    #[error("[{SECTION}] has no BetaflightElf: add BetaflightElf=/path/to/betaflight_SITL.elf")]
    NoExecutable,
    /// It names two executables, with keys that differ only in case.
    #[error("[{SECTION}] has two lines {first} and {second}: keep the right one")]
    TwoExecutables {
        /// One of the keys.
        first: String,
        /// The other.
        second: String,
    },
}

impl Betaloop {
    /// Reads the text of the launcher's file.
    ///
    /// # Errors
    /// Returns the reason why it is not such a file.
    pub fn read(text: &str) -> Result<Self, BetaloopError> {
        // This follows the launcher: exact names of sections, and no comment after a value.
        let mut form = IniDefault::default();
        form.enable_inline_comments = false;
        form.case_sensitive = true;
        let sections = Ini::new_from_defaults(form).read(text.to_owned()).map_err(BetaloopError::Form)?;
        let section = sections.get(SECTION).ok_or(BetaloopError::NoSection)?;
        let mut executable = None;
        let mut unused = Vec::new();
        let mut named: Vec<&String> =
            section.keys().filter(|key| key.eq_ignore_ascii_case(EXECUTABLE)).collect();
        named.sort_unstable();
        if let [first, second, ..] = named.as_slice() {
            let (first, second) = ((*first).clone(), (*second).clone());
            return Err(BetaloopError::TwoExecutables { first, second });
        }
        for (key, value) in section {
            let value = value.as_deref().map(str::trim).filter(|value| !value.is_empty());
            if key.eq_ignore_ascii_case(EXECUTABLE) {
                executable = value.map(str::to_owned);
            } else {
                unused.push(key.clone());
            }
        }
        unused.sort_unstable();
        executable.map(|executable| Self { executable, unused }).ok_or(BetaloopError::NoExecutable)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_launchers_file() {
        let text = "; mine\n[Betaloop]\nAeroloopGazeboHome=~/aeroloop_gazebo\nWorld = demo.sdf\n\
                    BetaflightElf = ~/my build #3/betaflight_SITL.elf\n[Other]\nx=1\n";
        assert_eq!(
            Betaloop::read(text),
            Ok(Betaloop {
                executable: "~/my build #3/betaflight_SITL.elf".to_owned(),
                unused: vec!["AeroloopGazeboHome".to_owned(), "World".to_owned()],
            })
        );
        let colons = "[Betaloop]\r\nbetaflightelf: ./sitl.elf\r\n";
        assert_eq!(Betaloop::read(colons).map(|file| file.executable), Ok("./sitl.elf".to_owned()));
    }

    #[test]
    fn other_files_are_recognized() {
        assert_eq!(Betaloop::read(""), Err(BetaloopError::NoSection));
        assert_eq!(Betaloop::read("[betaloop]\nBetaflightElf=x"), Err(BetaloopError::NoSection));
        assert_eq!(Betaloop::read("set ap_max_angle = 25\nsave\n"), Err(BetaloopError::NoSection));
        assert_eq!(Betaloop::read("[Betaloop]\nWorld=x"), Err(BetaloopError::NoExecutable));
        assert_eq!(Betaloop::read("[Betaloop]\nBetaflightElf="), Err(BetaloopError::NoExecutable));
        assert!(matches!(Betaloop::read("[Betaloop\nBetaflightElf=x"), Err(BetaloopError::Form(_))));
    }

    #[test]
    fn a_file_that_names_two_executables_starts_neither() {
        // The order of the keys differs from run to run.
        let text = "[Betaloop]\nBetaflightElf=/a\nBETAFLIGHTELF=/b\n";
        let refusal = Betaloop::read(text).map_err(|error| error.to_string());
        let wanted = "[Betaloop] has two lines BETAFLIGHTELF and BetaflightElf: keep the right one";
        assert_eq!(refusal, Err(wanted.to_owned()));
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_it_panic(text in "(\\[Betaloop\\]\n)?(.{0,12}[=:\n]){0,6}") {
            // Every file that can be read names an executable.
            if let Ok(file) = Betaloop::read(&text) {
                proptest::prop_assert!(!file.executable.trim().is_empty());
            }
        }
    }
}
