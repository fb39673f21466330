//! Plan files: one submodule for each file format. Each converts pure text ↔ [`PlanFile`].
//!
//! * [`Format::Toml`] is the project's own format. It holds all of a [`PlanFile`], with units in the key names.
//! * [`Format::CliText`] is Betaflight CLI text: the `waypoint` lines of a hand-written list or of a whole `diff all`.
//!
//! A reader reports every problem of a file with its place and changes nothing. A writer reports the parts that it
//! lost.

mod cli_text;
mod field;
mod home;
mod native_read;
mod native_write;
mod note;
mod problem;
mod record;
mod setting;
mod table;
mod toml_table;

use strum::IntoEnumIterator as _;

use super::FlightPlan;

pub use field::degrees_e7;
pub use home::{HomeError, HomePosition};
pub use note::{Note, NoteKind};
pub use problem::{PlanError, Problems, report};
pub use record::{Records, WaypointRecord};
pub use setting::{SettingCheck, SettingFault, SettingPart, setting_line};
pub use table::table;
pub use toml_table::{TomlTable, Value};

/// A file format for plans. `Display` and `FromStr` use the names of `convert --from` and `--to`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::EnumString, strum::EnumIter)]
#[strum(ascii_case_insensitive)]
pub enum Format {
    /// The project's own format, `*.toml`.
    #[strum(serialize = "toml")]
    Toml,
    /// Betaflight CLI text, `*.txt`.
    #[strum(serialize = "txt")]
    CliText,
}

impl Format {
    /// Returns the format for a file name, by its ending.
    pub fn from_file_name(name: &str) -> Option<Self> {
        let (stem, ending) = name.rsplit_once('.')?;
        if stem.is_empty() || ending.contains(['/', '\\']) {
            return None;
        }
        ending.parse().ok()
    }

    /// Returns the format of a text without a file name. The text is TOML if its first line that is not a comment
    /// begins a table or gives a key of a plan file; otherwise it is CLI text.
    pub fn of_text(text: &str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let first = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'));
        let is_toml = first.is_some_and(|line| {
            let key = line.split_once('=').map_or("", |(key, _)| key.trim());
            line.starts_with('[') || native_read::FILE_KEYS.contains(&key)
        });
        if is_toml { Self::Toml } else { Self::CliText }
    }

    /// Returns the format in words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Toml => "betadeck plan",
            Self::CliText => "Betaflight CLI text",
        }
    }

    /// Returns the known file endings for messages: `.toml, .txt`.
    pub fn endings() -> String {
        Self::iter().map(|format| format!(".{format}")).collect::<Vec<_>>().join(", ")
    }
}

/// A plan and the other contents of its file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanFile {
    /// The name of the plan, or the file's name without its ending if the file gives none.
    pub name: String,
    /// A description for people; may be empty.
    pub description: String,
    /// The place of the craft at boot, if the plan gives one.
    pub home: Option<HomePosition>,
    /// The settings for the plan, as `name = value`, in the order in which they are applied.
    pub settings: Vec<String>,
    pub plan: FlightPlan,
    /// The lines that the reader skipped.
    pub notes: Vec<Note>,
}

/// A written file and the parts of the plan that it lost.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Written {
    /// The text of the file.
    pub text: String,
    /// One sentence for each part that the format cannot hold.
    pub lost: Vec<String>,
}

/// Reads a plan file with any settings: see [`parse_checked`].
///
/// # Errors
///
/// Returns all problems of the file, in the order of their places.
pub fn parse(name: &str, text: &str, format: Format) -> Result<PlanFile, Vec<PlanError>> {
    parse_checked(name, text, format, |_, _| Ok(()))
}

/// The largest TOML plan, bytes. The syntax tree takes a hundred times as much memory.
const MAX_TOML: usize = 512 << 10;

/// Reads a plan file and checks its settings with `check`.
///
/// `name` is the file's name as the user gave it. It begins the error messages, and it names a plan that has no name of
/// its own.
///
/// # Errors
///
/// Returns all problems of the file, in the order of their places.
pub fn parse_checked(
    name: &str,
    text: &str,
    format: Format,
    check: SettingCheck,
) -> Result<PlanFile, Vec<PlanError>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut problems = Problems::new(name, text);
    if format == Format::CliText
        && let Some(other) = foreign_format(text)
    {
        let message = format!("this is {other}, which is not a plan that can be read");
        let hint =
            format!("plans are {}; the waypoint lines of a CLI can be pasted into them", Format::endings());
        problems.add(0..0, message, hint);
        return Err(problems.into_errors());
    }
    let mut file = match format {
        Format::Toml if text.len() > MAX_TOML => {
            let message =
                format!("the file has {} KiB, a TOML plan at most {} KiB", text.len() >> 10, MAX_TOML >> 10);
            problems.add(0..0, message, "a plan has at most 30 waypoints: is this the right file?");
            PlanFile::default()
        }
        Format::Toml => native_read::read(text, check, &mut problems),
        Format::CliText => cli_text::read(text, &mut problems),
    };
    let errors = problems.into_errors();
    if !errors.is_empty() {
        return Err(errors);
    }
    if file.name.is_empty() {
        file.name = stem(name);
    }
    Ok(file)
}

/// Returns the format of a text that begins like neither a plan nor a command line.
fn foreign_format(text: &str) -> Option<&'static str> {
    let text = text.trim_start();
    match text.chars().next()? {
        '{' => Some("JSON, such as a QGroundControl plan"),
        '<' => Some("XML, such as a GPX or KML file"),
        _ if text.starts_with("QGC WPL") => Some("a waypoint file of QGroundControl or Mission Planner"),
        _ => None,
    }
}

/// Writes a plan file in its canonical form. Reading it gives the same plan, and writing that plan gives the same text.
pub fn write(file: &PlanFile, format: Format) -> Written {
    match format {
        Format::Toml => native_write::write(file),
        Format::CliText => cli_text::write(file),
    }
}

/// Returns the file's name without folders and ending; `plan` for standard input.
fn stem(name: &str) -> String {
    let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = base.rsplit_once('.').map_or(base, |(stem, _)| stem);
    if stem.is_empty() || stem == "-" { "plan".to_owned() } else { stem.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_choose_the_format() {
        assert_eq!(Format::from_file_name("a/b.TOML"), Some(Format::Toml));
        assert_eq!(Format::from_file_name("b.txt"), Some(Format::CliText));
        assert_eq!(Format::from_file_name("-"), None);
        assert_eq!(Format::from_file_name("square"), None);
        assert_eq!(Format::from_file_name("dir.txt/square"), None);
        assert_eq!(Format::from_file_name(".txt"), None);
        assert_eq!(Format::endings(), ".toml, .txt");
    }

    #[test]
    fn a_nameless_text_shows_its_format() {
        for text in ["name = \"x\"", "\u{feff}# mine\n\n[[waypoint]]", "waypoint = [{type='LAND'}]"] {
            assert_eq!(Format::of_text(text), Format::Toml, "{text}");
        }
        for text in ["", "# dump\nbatch start", "waypoint insert 0 1 2", "set name = x", "=", "x = 1"] {
            assert_eq!(Format::of_text(text), Format::CliText, "{text}");
        }
    }

    #[test]
    fn a_plan_of_another_program_is_not_taken_for_an_empty_one() {
        for (text, is) in [
            ("{\n \"fileType\": \"Plan\"\n}", "this is JSON"),
            ("\u{feff}\n <?xml version=\"1.0\"?>", "this is XML"),
            ("QGC WPL 110\n0 1 0 16", "this is a waypoint file"),
        ] {
            let format = Format::of_text(text);
            let errors = parse("-", text, format).unwrap_err();
            let reported = report(&errors);
            assert!(reported.contains(is) && reported.contains(".toml, .txt"), "{reported}");
        }
    }

    #[test]
    fn stem_names_a_nameless_plan() {
        assert_eq!(stem("plans/guide-square.txt"), "guide-square");
        assert_eq!(stem("-"), "plan");
        assert_eq!(stem(".toml"), "plan");
    }
}
