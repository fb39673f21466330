//! Plan files: one submodule for each file format. Each converts text or bytes ↔ [`PlanFile`].
//!
//! * [`Format::Toml`] is the project's own format. It holds all of a [`PlanFile`], with units in the key names.
//! * [`Format::CliText`] is Betaflight CLI text: the `waypoint` lines of a hand-written list or of a whole `diff all`.
//! * The others are formats of other programs. [`Format`] has their table, [`loss`] the report of what differs there.
//!
//! A reader reports every problem of a file with its place and changes nothing. Readers and writers report each part
//! that the other side cannot hold.

mod bounds;
mod cli_lines;
mod cli_text;
mod csv_plan;
mod csv_table;
mod dropped;
mod encoding;
mod field;
mod geojson;
mod gpx;
mod home;
mod inav;
mod json;
mod json_place;
mod kind;
mod kml;
#[cfg(test)]
mod law;
mod litchi;
mod long;
pub mod loss;
mod map_choice;
mod map_data;
mod map_file;
mod map_plan;
mod mission_item;
mod native_read;
mod native_write;
mod note;
mod number;
mod options;
mod problem;
mod qgc_csv;
mod qgc_plan;
mod qgc_wpl;
mod setting;
mod table;
mod thinned;
mod toml_table;
mod xml;

use std::borrow::Cow;

use super::{FlightPlan, Waypoint};
use loss::{LossReport, Severity};

pub use cli_lines::{plan_lines, record_lines, upload_lines};
pub use encoding::decode as decode_text;
pub use field::degrees_e7;
pub use home::{HomeError, HomePosition};
pub use kind::{Format, FormatInfo};
pub use map_file::read_features;
pub use note::{Note, NoteKind};
pub use options::{ReadOptions, WriteOptions};
pub use problem::{PlanError, Problems, report};
pub use qgc_plan::qgc_fences;
pub use qgc_wpl::item_sources;
pub use setting::{SettingCheck, SettingFault, SettingPart, setting_line};
pub use table::table;
pub use toml_table::{TomlTable, Value};

/// A plan and the other contents of its file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanFile {
    /// The name of the plan, or the file's name without its extension if the file gives none.
    pub name: String,
    /// A description for people; may be empty.
    pub description: String,
    /// The place of the craft at boot, if the plan gives one.
    pub home: Option<HomePosition>,
    /// The settings for the plan, as `name = value`, in the order in which they are applied.
    pub settings: Vec<String>,
    /// The plan.
    pub plan: FlightPlan,
    /// The waypoints for which a plan has no room. A plan that is flown has none.
    pub rest: Vec<Waypoint>,
    /// The lines that the reader skipped.
    pub notes: Vec<Note>,
    /// The differences between the file and this plan.
    pub losses: LossReport,
}

impl PlanFile {
    /// Returns sentences about the skipped parts of the file and the differences between it and this plan.
    pub fn notices(&self) -> Vec<String> {
        let differences = self.losses.findings.iter().map(ToString::to_string);
        self.notes.iter().map(ToString::to_string).chain(differences).collect()
    }
}

/// A written file and its differences from the plan.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Written {
    /// The bytes of the file; empty if the plan is refused.
    pub contents: Vec<u8>,
    /// The differences between the plan and the text.
    pub losses: LossReport,
}

impl Written {
    /// Returns the contents as text.
    pub fn text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.contents)
    }

    /// Creates a refusal of the whole plan.
    fn refused(why: impl Into<String>) -> Self {
        let mut losses = LossReport::default();
        losses.add(loss::Finding::new(Severity::Refused, "format", why));
        Self { contents: Vec::new(), losses }
    }

    /// Returns `true` if the format cannot take the plan at all. The findings give the reason.
    pub fn is_refused(&self) -> bool {
        self.losses.worst() == Some(Severity::Refused)
    }
}

/// The largest TOML plan, bytes. The syntax tree takes a hundred times as much memory.
const MAX_TOML: usize = 512 << 10;

/// Reads a plan file with any settings: see [`read`].
///
/// # Errors
///
/// Returns all problems of the file, in the order of their places.
pub fn parse(name: &str, text: &str, format: Format) -> Result<PlanFile, Vec<PlanError>> {
    parse_checked(name, text, format, |_, _| Ok(()))
}

/// Reads a plan file and checks its settings with `check`: see [`read`].
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
    read(name, text.as_bytes(), format, &ReadOptions { check, ..ReadOptions::default() })
}

/// Reads a plan file.
///
/// `name` is the file's name as the user gave it. It begins the error messages, and it names a plan that has no name of
/// its own.
///
/// # Errors
///
/// Returns all problems of the file, in the order of their places.
pub fn read(
    name: &str,
    contents: &[u8],
    format: Format,
    options: &ReadOptions,
) -> Result<PlanFile, Vec<PlanError>> {
    let refused = |message: String| {
        let mut problems = Problems::new(name, "");
        problems.add(0..0, message, format!("a {} file is expected", format.title()));
        problems.into_errors()
    };
    let unpacked = match format {
        Format::Kmz => Cow::Owned(map_file::unpacked_plan(contents).map_err(refused)?),
        _ => Cow::Borrowed(contents),
    };
    let text = encoding::decode(&unpacked).map_err(refused)?;
    let text = text.as_ref();
    let mut problems = Problems::new(name, text);
    let mut file = match format {
        Format::Toml if text.len() > MAX_TOML => {
            let message =
                format!("the file has {} KiB, a TOML plan at most {} KiB", text.len() >> 10, MAX_TOML >> 10);
            let hint =
                format!("a plan has at most {} waypoints: is this the right file?", super::MAX_WAYPOINTS);
            problems.add(0..0, message, if options.long { String::new() } else { hint });
            PlanFile::default()
        }
        Format::Toml => native_read::read(text, options, &mut problems),
        Format::CliText => {
            if let Some(other) = foreign(text) {
                let hint = format!("the formats of plans are {}", Format::names(false));
                problems.add(0..0, format!("this is {other}, but not a plan"), hint);
            }
            cli_text::read(text, options.long, &mut problems)
        }
        Format::QgcPlan => qgc_plan::read(text, options, &mut problems),
        Format::QgcWpl => qgc_wpl::read(text, options, &mut problems),
        Format::QgcCsv => qgc_csv::read(text, options, &mut problems),
        Format::Kml | Format::Kmz => kml::read(text, options, &mut problems),
        Format::Gpx => gpx::read(text, options, &mut problems),
        Format::GeoJson => geojson::read(text, options, &mut problems),
        Format::MwXml => inav::mw_xml::read(text, options, &mut problems),
        Format::InavCli => inav::cli::read(text, options, &mut problems),
        Format::Litchi => litchi::read(text, options, &mut problems),
        Format::Csv => csv_plan::read(text, options, &mut problems),
    };
    let errors = problems.into_errors();
    if !errors.is_empty() {
        return Err(errors);
    }
    if file.name.is_empty() {
        file.name = stem(name);
    }
    // A map is simplified when it is read: its lines may have many points.
    let is_map = matches!(format, Format::Kml | Format::Kmz | Format::Gpx | Format::GeoJson);
    if let Some(tolerance_m) = options.simplify_m.filter(|_| !is_map) {
        file.simplify(tolerance_m);
    }
    if file.losses.items > 0 {
        file.losses.waypoints = file.plan.waypoints.len() + file.rest.len();
    }
    Ok(file)
}

/// Returns the kind of a text that is no command line.
fn foreign(text: &str) -> Option<&'static str> {
    match text.trim_start().chars().next()? {
        '{' => Some("JSON"),
        '<' => Some("XML or HTML"),
        _ => None,
    }
}

/// Writes a plan file in its canonical form: see [`write_with`].
pub fn write(file: &PlanFile, format: Format) -> Written {
    write_with(file, format, &WriteOptions::default())
}

/// Writes a plan file in its canonical form. Reading it gives the same plan but for the fields of the findings, and
/// writing that plan gives the same bytes.
pub fn write_with(file: &PlanFile, format: Format, options: &WriteOptions) -> Written {
    if !file.rest.is_empty() {
        let count = file.plan.waypoints.len() + file.rest.len();
        return Written::refused(format!("the file has {count} waypoints, {}", long::hint()));
    }
    let mut written = match format {
        Format::Toml => native_write::write(file),
        Format::CliText => cli_text::write(file),
        Format::QgcPlan => qgc_plan::write(file),
        Format::QgcWpl => qgc_wpl::write(file),
        Format::Kml => kml::write(file, options),
        Format::Kmz => kml::write_archive(file, options),
        Format::Gpx => gpx::write(file),
        Format::GeoJson => geojson::write(file),
        Format::MwXml => inav::mw_xml::write(file),
        Format::InavCli => inav::cli::write(file),
        Format::Csv => csv_plan::write(file),
        Format::QgcCsv | Format::Litchi => {
            Written::refused(format!("{} files are only read", format.title()))
        }
    };
    written.losses.waypoints = file.plan.waypoints.len();
    written
}

/// Returns the file's name without folders and extension; `plan` for standard input.
fn stem(name: &str) -> String {
    let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = base.rsplit_once('.').map_or(base, |(stem, _)| stem);
    if stem.is_empty() || stem == "-" { "plan".to_owned() } else { stem.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_file_is_not_taken_for_an_empty_plan() {
        for (text, is) in [("{\n \"name\": \"x\"\n}", "this is JSON"), ("\u{feff}\n <html>", "this is XML")] {
            let errors = parse("-", text, Format::from_contents(text.as_bytes())).unwrap_err();
            let reported = report(&errors);
            assert!(reported.contains(is) && reported.contains("toml, txt"), "{reported}");
        }
    }

    #[test]
    fn stem_names_a_nameless_plan() {
        assert_eq!(stem("plans/guide-square.txt"), "guide-square");
        assert_eq!(stem("-"), "plan");
        assert_eq!(stem(".toml"), "plan");
    }
}
