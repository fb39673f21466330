//! Writes a flight from the screen as a scenario.

use std::path::{Path, PathBuf};

use crate::files::named_file::{Kind, stem};
use crate::scenario::Draft;
use crate::timeline::RecordedFlight;

const SCENARIO: Kind = Kind { extension: "toml", command: "scenario" };

/// Makes a scenario of the flight, flies it again, and writes it to `file`, or to a new file named after the plan.
/// Never replaces an existing file. Returns a sentence with the name of the file, or with the reason for a failure.
pub(super) fn write(file: Option<PathBuf>, plan: &str, flight: RecordedFlight) -> Result<String, String> {
    let name = file
        .as_deref()
        .and_then(Path::file_stem)
        .map_or_else(|| stem(plan), |name| name.to_string_lossy().into_owned());
    let text = Draft::from_recorded(&name, flight)?.finish()?;
    let path = SCENARIO.write(file, plan, text.as_bytes())?;
    let shown = path.display();
    Ok(format!("The flight is written as {shown}: `betadeck check {shown}` flies and judges it."))
}
