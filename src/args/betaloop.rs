//! The file of the betaloop launcher, `config.txt`: which SITL executable its users fly.

use configparser::ini::{Ini, IniDefault};

/// The section of the launcher.
const SECTION: &str = "Betaloop";
/// The key of the executable; keys are told apart without regard to case.
const EXECUTABLE: &str = "betaflightelf";

/// What the launcher's section says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Betaloop {
    /// The executable as it is written, perhaps from `~` on.
    pub executable: String,
    /// Keys of the section that mean nothing here.
    pub unused: Vec<String>,
}

/// Why a file is none of the launcher.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BetaloopError {
    /// Not in the form of such files.
    #[error("it is not a file of sections, names and values: {0}")]
    Form(String),
    /// Of another program.
    #[error("it has no section [{SECTION}]")]
    NoSection,
    /// It names no executable.
    #[error("[{SECTION}] has no BetaflightElf: add BetaflightElf=/path/to/betaflight_SITL.elf")]
    NoExecutable,
    /// It names two executables, by keys that differ in case only.
    #[error("[{SECTION}] has two lines {first} and {second}: keep the one that is meant")]
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
    /// Why it is none.
    pub fn read(text: &str) -> Result<Self, BetaloopError> {
        // As the launcher reads it: sections by their exact name, no comment behind a value.
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
    fn other_files_are_told_apart() {
        assert_eq!(Betaloop::read(""), Err(BetaloopError::NoSection));
        assert_eq!(Betaloop::read("[betaloop]\nBetaflightElf=x"), Err(BetaloopError::NoSection));
        assert_eq!(Betaloop::read("set ap_max_angle = 25\nsave\n"), Err(BetaloopError::NoSection));
        assert_eq!(Betaloop::read("[Betaloop]\nWorld=x"), Err(BetaloopError::NoExecutable));
        assert_eq!(Betaloop::read("[Betaloop]\nBetaflightElf="), Err(BetaloopError::NoExecutable));
        assert!(matches!(Betaloop::read("[Betaloop\nBetaflightElf=x"), Err(BetaloopError::Form(_))));
    }

    #[test]
    fn a_file_that_names_two_executables_starts_neither() {
        // The order in which the keys are found differs from run to run.
        let text = "[Betaloop]\nBetaflightElf=/a\nBETAFLIGHTELF=/b\n";
        let refusal = Betaloop::read(text).map_err(|error| error.to_string());
        let wanted = "[Betaloop] has two lines BETAFLIGHTELF and BetaflightElf: keep the one that is meant";
        assert_eq!(refusal, Err(wanted.to_owned()));
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_it_panic(text in "(\\[Betaloop\\]\n)?(.{0,12}[=:\n]){0,6}") {
            // Whatever is read, an executable has a name.
            if let Ok(file) = Betaloop::read(&text) {
                proptest::prop_assert!(!file.executable.trim().is_empty());
            }
        }
    }
}
