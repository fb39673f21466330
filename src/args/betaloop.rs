//! The file of the betaloop launcher, `config.txt`, which names the SITL executable of its users.

use std::collections::BTreeMap;

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
        let section = section(text)?;
        let mut named = section.keys().filter(|key| key.eq_ignore_ascii_case(EXECUTABLE));
        if let (Some(&first), Some(&second)) = (named.next(), named.next()) {
            return Err(BetaloopError::TwoExecutables { first: first.to_owned(), second: second.to_owned() });
        }
        let (mut executable, mut unused) = (None, Vec::new());
        for (key, value) in section {
            if key.eq_ignore_ascii_case(EXECUTABLE) {
                executable = Some(value.to_owned()).filter(|value| !value.is_empty());
            } else {
                unused.push(key.to_owned());
            }
        }
        executable.map(|executable| Self { executable, unused }).ok_or(BetaloopError::NoExecutable)
    }
}

/// Returns the keys and values of the launcher's section. Like the launcher, it takes the names of sections as they are
/// written, knows no comment after a value, and takes the last of equal keys.
fn section(text: &str) -> Result<BTreeMap<&str, &str>, BetaloopError> {
    let (mut section, mut is_inside) = (None, false);
    for (line, number) in text.lines().map(str::trim).zip(1..) {
        if let Some(name) = line.strip_prefix('[') {
            let what = format!("line {number}: the name of a section begins with [ and has no ]");
            is_inside = name.rsplit_once(']').ok_or(BetaloopError::Form(what))?.0.trim() == SECTION;
            if is_inside {
                section.get_or_insert_with(BTreeMap::new);
            }
        } else if !line.is_empty() && !line.starts_with([';', '#']) {
            let (key, value) = line.split_once(['=', ':']).unwrap_or((line, ""));
            if key.trim().is_empty() {
                return Err(BetaloopError::Form(format!("line {number}: the value has no name")));
            }
            if let Some(section) = section.as_mut().filter(|_| is_inside) {
                section.insert(key.trim(), value.trim());
            }
        }
    }
    section.ok_or(BetaloopError::NoSection)
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
