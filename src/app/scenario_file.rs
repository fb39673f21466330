//! Writes a flight from the screen as a scenario.

use std::fs::File;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use crate::scenario::Draft;
use crate::timeline::RecordedFlight;

/// The most files with numbers after the plan's name.
const MOST: u32 = 999;

/// Makes a scenario of the flight, flies it again, and writes it to `file`, or to a new file named after the plan.
/// Never replaces an existing file. Returns a sentence with the name of the file, or with the reason for a failure.
pub(super) fn write(file: Option<PathBuf>, plan: &str, flight: RecordedFlight) -> Result<String, String> {
    let stem = stem(plan);
    let name = file
        .as_deref()
        .and_then(Path::file_stem)
        .map_or(stem.clone(), |name| name.to_string_lossy().into_owned());
    let text = Draft::of_recorded(&name, flight)?.finish()?;
    let path = match file {
        Some(path) => create(&path, &text).map(|()| path)?,
        None => create_numbered(&stem, &text)?,
    };
    let shown = path.display();
    Ok(format!("The flight is written as {shown}: `betadeck check {shown}` flies and judges it."))
}

/// Returns the start of the file's name, with only those characters that need no quotes in a shell.
fn stem(plan: &str) -> String {
    let kept: String =
        plan.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).take(40).collect();
    let kept = kept.trim_matches('-');
    if kept.is_empty() { "flight".to_owned() } else { kept.to_owned() }
}

fn create_numbered(stem: &str, text: &str) -> Result<PathBuf, String> {
    for number in 1..=MOST {
        let path = PathBuf::from(format!("{stem}-flight-{number}.toml"));
        if !path.exists() {
            return create(&path, text).map(|()| path);
        }
    }
    Err(format!(
        "{stem}-flight-1.toml to {stem}-flight-{MOST}.toml exist already: name a file, `:scenario FILE`."
    ))
}

fn create(path: &Path, text: &str) -> Result<(), String> {
    let written = File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            format!("{} exists already: name another file, `:scenario FILE`.", path.display())
        }
        _ => format!("{} cannot be written: {error}.", path.display()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_name_has_nothing_that_a_shell_minds() {
        assert_eq!(stem("square"), "square");
        assert_eq!(stem("../my plan; rm -rf"), "my-plan--rm--rf");
        assert_eq!(stem("…"), "flight");
    }

    #[test]
    fn a_file_that_is_there_is_never_replaced() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("mine.toml");
        assert_eq!(create(&path, "one"), Ok(()));
        assert!(create(&path, "two").expect_err("there already").contains("exists already"));
        assert_eq!(std::fs::read_to_string(&path).expect("readable"), "one");
    }
}
