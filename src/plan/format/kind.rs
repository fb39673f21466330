//! The table of the plan formats: names, extensions, what each carries, and how a file shows its format.

use strum::IntoEnumIterator as _;

use super::loss::{Finding, Severity};
use super::map_file::{MapKind, is_geojson, kmz, root_element};
use super::{csv_plan, inav, litchi, native_read, qgc_csv, qgc_plan, qgc_wpl};

/// A file format for plans. `Display` and `FromStr` use the names of `convert --from` and `--to`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::EnumString, strum::EnumIter)]
#[strum(ascii_case_insensitive)]
pub enum Format {
    /// The project's own format.
    #[strum(serialize = "toml")]
    Toml,
    /// Betaflight CLI text.
    #[strum(serialize = "txt")]
    CliText,
    /// QGroundControl's JSON.
    #[strum(serialize = "plan")]
    QgcPlan,
    /// QGroundControl's and Mission Planner's text, version 110.
    #[strum(serialize = "wpl")]
    QgcWpl,
    /// QGroundControl's table.
    #[strum(serialize = "qgc-csv")]
    QgcCsv,
    /// KML, as Google Earth writes it.
    #[strum(serialize = "kml")]
    Kml,
    /// KML in a ZIP archive.
    #[strum(serialize = "kmz")]
    Kmz,
    /// GPX, as hand-held receivers and maps write it.
    #[strum(serialize = "gpx")]
    Gpx,
    /// GeoJSON.
    #[strum(serialize = "geojson")]
    GeoJson,
    /// Missions of INAV as XML.
    #[strum(serialize = "mw-xml")]
    MwXml,
    /// Missions of INAV as CLI text.
    #[strum(serialize = "inav")]
    InavCli,
    /// Missions of Litchi.
    #[strum(serialize = "litchi")]
    Litchi,
    /// The waypoints as a table.
    #[strum(serialize = "csv")]
    Csv,
}

/// The row of a format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FormatInfo {
    /// The format in words.
    pub title: &'static str,
    /// The extensions that give this format when a file is written.
    pub extensions: &'static [&'static str],
    /// Further extensions of files that may be in this format. Their contents decide.
    pub also: &'static [&'static str],
    /// `true` if plans are written in it, too.
    pub writes: bool,
    /// The parts of a plan that it carries, for `convert --list`.
    pub carries: &'static str,
}

impl Format {
    /// Returns the row of the format.
    pub const fn info(self) -> FormatInfo {
        match self {
            Self::Toml => FormatInfo {
                title: "betadeck plan",
                extensions: &["toml"],
                also: &[],
                writes: true,
                carries: "everything",
            },
            Self::CliText => FormatInfo {
                title: "Betaflight CLI text",
                extensions: &["txt"],
                also: &[],
                writes: true,
                carries: "the waypoints; not name, home and settings",
            },
            Self::QgcPlan => FormatInfo {
                title: "QGroundControl plan",
                extensions: &["plan"],
                also: &["json"],
                writes: true,
                carries: "everything for betadeck; others do not know settings, FIGURE8 and YAW_RATE",
            },
            Self::QgcWpl => FormatInfo {
                title: "MAVLink waypoint file",
                extensions: &["waypoints"],
                also: &["txt", "mission"],
                writes: true,
                carries: "home and the waypoints as items; not name, settings, FIGURE8 and the altitude of LAND",
            },
            Self::QgcCsv => FormatInfo {
                title: "QGroundControl table",
                extensions: &[],
                also: &["csv"],
                writes: false,
                carries: "home and the waypoints as items",
            },
            Self::Kml => FormatInfo {
                title: "KML",
                extensions: &["kml"],
                also: &["xml"],
                writes: true,
                carries: "everything; other programs see points, the path and the fence",
            },
            Self::Kmz => FormatInfo {
                title: "KMZ (packed KML)",
                extensions: &["kmz"],
                also: &[],
                writes: true,
                carries: "everything; other programs see points, the path and the fence",
            },
            Self::Gpx => FormatInfo {
                title: "GPX",
                extensions: &["gpx"],
                also: &["xml"],
                writes: true,
                carries: "everything; other programs see a route, with altitudes if that of home is known",
            },
            Self::GeoJson => FormatInfo {
                title: "GeoJSON",
                extensions: &["geojson"],
                also: &["json"],
                writes: true,
                carries: "everything; other programs see points, the path and the fence",
            },
            Self::MwXml => FormatInfo {
                title: "MW-XML mission (INAV, mwp)",
                extensions: &["mission"],
                also: &["xml"],
                writes: true,
                carries: "points, holds, landings and home; the rest as private data",
            },
            Self::InavCli => FormatInfo {
                title: "INAV CLI text",
                extensions: &[],
                also: &["txt"],
                writes: true,
                carries: "points, holds and landings; the rest as private data",
            },
            Self::Litchi => FormatInfo {
                title: "Litchi mission",
                extensions: &[],
                also: &["csv"],
                writes: false,
                carries: "points and timed holds",
            },
            Self::Csv => FormatInfo {
                title: "table of waypoints",
                extensions: &["csv"],
                also: &[],
                writes: true,
                carries: "the waypoints; not name, home and settings",
            },
        }
    }

    /// Returns the format in words.
    pub fn title(self) -> &'static str {
        self.info().title
    }

    /// Returns the format that a file of this name is written in, by its extension.
    pub fn from_file_name(name: &str) -> Option<Self> {
        let extension = extension(name)?;
        Self::iter().find(|format| has(format.info().extensions, extension))
    }

    /// Returns `true` if a file of this name may be a plan.
    pub fn is_plan_name(name: &str) -> bool {
        extension(name).is_some_and(|extension| {
            Self::iter()
                .any(|format| has(format.info().extensions, extension) || has(format.info().also, extension))
        })
    }

    /// Returns the format of a file. If the extension and the contents differ, the contents decide, with a finding.
    pub fn detect(name: &str, contents: &[u8]) -> (Self, Option<Finding>) {
        let of_contents = Self::from_contents(contents);
        let Some(extension) = extension(name) else { return (of_contents, None) };
        let by_name = Self::from_file_name(name);
        let info = of_contents.info();
        match by_name {
            Some(by_name) if by_name == of_contents => (of_contents, None),
            // A text without a mark of its own may be a plan of the extension, with a fault in its first line.
            Some(by_name) if of_contents == Self::CliText => (by_name, None),
            _ if has(info.extensions, extension) || has(info.also, extension) => (of_contents, None),
            None => (of_contents, None),
            Some(by_name) => {
                let why = "the extension of the file and its contents differ, the contents decide";
                let finding = Finding::new(Severity::Assumed, "format", why);
                (of_contents, Some(finding.values(by_name.title(), of_contents.title())))
            }
        }
    }

    /// Returns the format of contents without a file name. A text is TOML if its first line that is not a comment
    /// begins a table or gives a key of a plan file. A text without the mark of any format is CLI text.
    pub fn from_contents(contents: &[u8]) -> Self {
        if kmz::is_archive(contents) {
            return Self::Kmz;
        }
        let Ok(text) = super::encoding::decode(contents) else { return Self::CliText };
        if let Some(format) = of_mark(text.trim_start()) {
            return format;
        }
        match MapKind::from_text(&text) {
            Some(MapKind::Kml) => return Self::Kml,
            Some(MapKind::Gpx) => return Self::Gpx,
            Some(MapKind::GeoJson) if is_geojson(&text) => return Self::GeoJson,
            Some(MapKind::GeoJson) | None => {}
        }
        let first = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'));
        let is_toml = first.is_some_and(|line| {
            let key = line.split_once('=').map_or("", |(key, _)| key.trim());
            line.starts_with('[') || native_read::FILE_KEYS.contains(&key)
        });
        match text.as_ref() {
            _ if is_toml => Self::Toml,
            text if root_element(text).is_some_and(inav::mw_xml::is_root) => Self::MwXml,
            text if litchi::is_header(text) => Self::Litchi,
            text if csv_plan::is_header(text) => Self::Csv,
            text if inav::cli::is_mission(text) => Self::InavCli,
            _ => Self::CliText,
        }
    }

    /// Returns `true` if contents have the mark of a plan: that of their format, or in TOML and CLI text, whose forms other
    /// files have, too, a waypoint.
    pub fn is_recognised(contents: &[u8]) -> bool {
        let has_line = |starts: &[&str]| {
            let text = super::encoding::decode(contents).unwrap_or_default();
            text.lines().any(|line| starts.iter().any(|start| line.trim_start().starts_with(start)))
        };
        match Self::from_contents(contents) {
            Self::Toml => has_line(&["[[waypoint", "waypoint =", "waypoint=", "waypoints"]),
            Self::CliText => has_line(&["waypoint "]),
            _ => true,
        }
    }

    /// Returns the extensions that can be written, for messages: `.toml, .txt`.
    pub fn extensions() -> String {
        let extensions =
            Self::iter().filter(|format| format.info().writes).flat_map(|format| format.info().extensions);
        extensions.map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(", ")
    }

    /// Returns the names of the formats for messages: `toml, txt`. With `written`, of those that can be written.
    pub fn names(written: bool) -> String {
        let formats = Self::iter().filter(|format| format.info().writes || !written);
        formats.map(|format| format.to_string()).collect::<Vec<_>>().join(", ")
    }
}

/// Returns the format of a text that begins with the mark of one.
fn of_mark(text: &str) -> Option<Format> {
    if text.starts_with(qgc_wpl::MARK) {
        Some(Format::QgcWpl)
    } else if qgc_plan::is_plan(text) {
        Some(Format::QgcPlan)
    } else if qgc_csv::is_header(text.lines().next().unwrap_or_default()) {
        Some(Format::QgcCsv)
    } else {
        None
    }
}

/// Returns the extension of a file name without its dot.
fn extension(name: &str) -> Option<&str> {
    let (stem, extension) = name.rsplit_once('.')?;
    (!stem.is_empty() && !extension.contains(['/', '\\'])).then_some(extension)
}

fn has(extensions: &[&str], extension: &str) -> bool {
    extensions.iter().any(|known| known.eq_ignore_ascii_case(extension))
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
        assert!(Format::extensions().starts_with(".toml, .txt"));
        assert_eq!(Format::from_file_name("a.mission"), Some(Format::MwXml));
        assert_eq!(Format::from_file_name("a.csv"), Some(Format::Csv));
    }

    #[test]
    fn a_nameless_text_shows_its_format() {
        for text in ["name = \"x\"", "\u{feff}# mine\n\n[[waypoint]]", "waypoint = [{type='LAND'}]"] {
            assert_eq!(Format::from_contents(text.as_bytes()), Format::Toml, "{text}");
        }
        let litchi = "latitude,longitude,altitude(m),heading(deg)\n1,2,3,4";
        for (text, format, name) in [
            ("<?xml version='1.0'?>\n<mission/>", Format::MwXml, "a.mission"),
            ("<MISSION>", Format::MwXml, "a.xml"),
            ("# INAV/MATEK\nfeature GPS\n# wp 0 valid\n", Format::InavCli, "a.txt"),
            ("wp 0 1 404640000 -795175000 5000 0 0 0 165\n", Format::InavCli, "a.txt"),
            (litchi, Format::Litchi, "a.csv"),
            ("type;lat_deg;lon_deg;alt_m\r\n", Format::Csv, "a.csv"),
        ] {
            assert_eq!(Format::detect(name, text.as_bytes()), (format, None), "{text}");
        }
        for text in ["", "# dump\nbatch start", "waypoint insert 0 1 2", "set name = x", "=", "x = 1"] {
            assert_eq!(Format::from_contents(text.as_bytes()), Format::CliText, "{text}");
        }
    }

    #[test]
    fn a_file_of_another_kind_is_not_recognised_as_a_plan() {
        for text in
            ["[default]\nkey = SECRET", "TOKEN=SECRET", "root:x:0:0", "{\"a\": 1}", "<a/>", "a,b\n1,2", ""]
        {
            assert!(!Format::is_recognised(text.as_bytes()), "{text}");
        }
        for text in ["name = 'x'\n[[waypoint]]\n", "# mine\nwaypoint insert 0 1 2", "QGC WPL 110\n", "<kml/>"]
        {
            assert!(Format::is_recognised(text.as_bytes()), "{text}");
        }
    }

    #[test]
    fn maps_show_their_format() {
        for (text, format) in [
            ("<?xml version='1.0'?>\n<kml xmlns='x'>", Format::Kml),
            ("\u{feff}<gpx version='1.1'>", Format::Gpx),
            ("PK\u{3}\u{4}", Format::Kmz),
            (" { \"type\" : \"Feature\" }", Format::GeoJson),
            ("{\"features\":[{\"type\":\"Feature\"}]}", Format::GeoJson),
            ("{\"fileType\":\"Plan\",\"type\":\"Feature\"}", Format::QgcPlan),
            ("{\"type\":\"SimpleItem\"}", Format::CliText),
            ("<html>", Format::CliText),
        ] {
            assert_eq!(Format::from_contents(text.as_bytes()), format, "{text}");
        }
        assert_eq!(Format::detect("a.json", b"{\"type\":\"Point\"}"), (Format::GeoJson, None));
        let (format, finding) = Format::detect("a.kml", b"PK\x03\x04");
        assert_eq!(
            (format, finding.map(|finding| finding.to)),
            (Format::Kmz, Some("KMZ (packed KML)".to_owned()))
        );
    }
}
