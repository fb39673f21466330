//! The arguments of `convert`.

use std::path::Path;

use crate::plan::WaypointType;
use crate::plan::format::{Format, HomePosition, ReadOptions, WriteOptions};

use super::value::{self, OutputFile};
use super::{PlanArg, PlanArgError};

/// The options of `convert`.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(override_usage = "betadeck convert [OPTIONS] <IN> <OUT>\n       betadeck convert --list")]
pub struct ConvertArgs {
    /// Plan to read: a built-in plan's name, a file, or - for standard input
    #[arg(value_name = "IN", required_unless_present = "list")]
    input: Option<String>,

    /// File to write, or - for standard output
    #[arg(value_name = "OUT", required_unless_present = "list")]
    output: Option<OutputFile>,

    /// Format of IN; --list names them [default: by its extension and its contents]
    #[arg(long, value_name = "FORMAT", value_parser = value::format)]
    from: Option<Format>,

    /// Format of OUT; --list names them [default: by its extension]
    #[arg(long, value_name = "FORMAT", value_parser = value::format)]
    to: Option<Format>,

    /// Replaces an existing OUT
    #[arg(long)]
    pub force: bool,

    /// Lists the formats, their extensions, and what each carries
    #[arg(long, exclusive = true)]
    pub list: bool,

    /// Ends with 1 if OUT is not the same plan: a finding lost, changed or assumed
    #[arg(long)]
    pub strict: bool,

    /// Prints the report as one JSON object
    #[arg(long)]
    pub json: bool,

    /// Home for a file without one, or without its altitude above sea level
    #[arg(long, value_name = "LAT,LON[,AMSL]", allow_hyphen_values = true)]
    home: Option<HomePosition>,

    /// Mission of a file with several, from 1
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    mission: u16,

    /// Line or route of a file with several: its number from 1, or its name
    #[arg(long, value_name = "N|NAME")]
    feature: Option<String>,

    /// Takes the outer ring of a polygon as the plan
    #[arg(long = "as", value_name = "SHAPE")]
    shape: Option<Shape>,

    /// How a plain waypoint is passed in a file that does not say it
    #[arg(long, value_name = "TYPE", default_value = "flyby")]
    waypoint_as: PassAs,

    /// Altitude above home for points without one, m
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, value_parser = value::altitude)]
    altitude: Option<f64>,

    /// Leaves out the points that are nearer than this to the line without them, m
    #[arg(long, value_name = "METRES", value_parser = value::spacing)]
    simplify: Option<f64>,

    /// Writes several plans if the waypoints do not fit into one: OUT with -1, -2 and so on before its extension
    ///
    /// Each part begins with the waypoint with which the one before ends.
    #[arg(long)]
    pub split: bool,

    /// The ground is flat: an altitude above ground is one above home
    #[arg(long)]
    flat: bool,

    /// Writes altitudes above sea level where the format also has those above ground
    #[arg(long)]
    absolute: bool,
}

/// A shape that becomes a plan on request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Shape {
    Ring,
}

/// The type of a plain waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum PassAs {
    Flyby,
    Flyover,
}

impl ConvertArgs {
    /// Returns the source. With `--from`, every name is the name of a file.
    ///
    /// # Errors
    ///
    /// Returns an error if the name is not a plan. This cannot happen after [`super::parse`], which checks it.
    pub fn source(&self) -> Result<PlanArg, PlanArgError> {
        let input = self.input.as_deref().unwrap_or("-");
        match self.from {
            Some(format) if input == "-" => Ok(PlanArg::Stdin(Some(format))),
            Some(format) => Ok(PlanArg::File(input.into(), Some(format))),
            None => input.parse(),
        }
    }

    /// Returns the output.
    pub fn output(&self) -> OutputFile {
        self.output.clone().unwrap_or(OutputFile::Stdout)
    }

    /// Returns the format of the output.
    ///
    /// # Errors
    ///
    /// Returns an error if neither `--to` nor the extension of OUT gives a format that can be written. This cannot happen
    /// after [`super::parse`], which checks it.
    pub fn target(&self) -> Result<Format, String> {
        let by_extension = |path: &Path| Format::from_file_name(&path.to_string_lossy());
        let output = self.output();
        let found = self.to.or_else(|| match &output {
            OutputFile::Stdout => None,
            OutputFile::File(path) => by_extension(path),
        });
        let names = Format::names(true);
        let format = found.ok_or_else(|| match &output {
            OutputFile::Stdout => {
                format!("the format of standard output is not given: add --to with one of {names}")
            }
            OutputFile::File(path) => format!(
                "{} has none of the extensions {}: add --to with one of {names}",
                path.display(),
                Format::extensions()
            ),
        })?;
        if !format.info().writes {
            return Err(format!("{format} is only read: write one of {names}"));
        }
        Ok(format)
    }

    /// Returns the choices for reading.
    pub fn read_options(&self) -> ReadOptions {
        ReadOptions {
            home: self.home,
            mission: usize::from(self.mission),
            feature: self.feature.clone(),
            ring: self.shape == Some(Shape::Ring),
            waypoint_as: match self.waypoint_as {
                PassAs::Flyby => WaypointType::Flyby,
                PassAs::Flyover => WaypointType::Flyover,
            },
            altitude_m: self.altitude,
            simplify_m: self.simplify,
            flat: self.flat,
            long: true,
            ..ReadOptions::default()
        }
    }

    /// Returns the choices for writing.
    pub fn write_options(&self) -> WriteOptions {
        WriteOptions { absolute: self.absolute }
    }

    /// Checks the combination of the typed options.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.list {
            return Ok(());
        }
        let input = self.input.as_deref().unwrap_or("-");
        self.source().map_err(|error| format!("{input}: {error}"))?;
        if self.split && self.output() == OutputFile::Stdout {
            return Err("--split writes several files: name a file as OUT".to_owned());
        }
        self.target().map(drop)
    }
}
