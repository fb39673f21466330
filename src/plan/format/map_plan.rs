//! Plans from the features of a map: our own waypoints, plain points, or one chosen line.

use super::bounds::{Reference, altitude_m};
use super::long::hint;
use super::loss::{Finding, LossReport, Place, Severity};
use super::map_choice::Candidate;
use super::map_data::{self, HOME, VERSION};
use super::map_file::{self, Altitudes, Collector, MapFeature, MapKind, Properties, Skipped};
use super::thinned::thinned;
use super::{HomePosition, PlanFile, Problems, ReadOptions, setting_line};
use crate::geo::distance_bearing;
use crate::plan::feature::{Shape, Vertex};
use crate::plan::{Altitude, MAX_WAYPOINTS, Waypoint, WaypointType};

/// The altitude above home of a point without one, m.
const DEFAULT_ALTITUDE_M: f64 = 10.0;

/// The largest difference of an altitude in a shape from the one in our data, m. Vertices have single precision.
const SAME_ALTITUDE_M: f64 = 0.02;

/// The largest distance of two homes at the same place, m.
const SAME_PLACE_M: f64 = 1.0;

/// The contents of a map.
#[derive(Debug, Default)]
pub(super) struct Map {
    pub(super) features: Vec<MapFeature>,
    name: String,
    description: String,
    properties: Properties,
    skipped: Vec<Skipped>,
}

impl Map {
    /// Reads a text.
    pub(super) fn read(kind: MapKind, text: &str, problems: &mut Problems<'_>) -> Self {
        let mut map = Self::default();
        let mut take = |feature| map.features.push(feature);
        let mut collector = Collector::new(problems, map_file::PLAN, &mut take);
        kind.read(text, &mut collector);
        let Collector { name, description, properties, skipped, .. } = collector;
        Self { name, description, properties, skipped, ..map }
    }
}

/// A point of a plan in its file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot<'m> {
    /// The number of the item, as the format counts.
    pub(super) item: usize,
    pub(super) place: Option<&'m Place>,
    /// The first byte in the text.
    pub(super) at: usize,
    pub(super) properties: &'m Properties,
    pub(super) vertex: Option<(Vertex, Altitudes)>,
}

/// Makes a plan.
pub(super) struct Builder<'m, 'p, 'a> {
    pub(super) map: &'m Map,
    pub(super) options: &'m ReadOptions,
    pub(super) problems: &'p mut Problems<'a>,
    /// `true` if an altitude of 0 means that no altitude is given.
    pub(super) zero_is_missing: bool,
    /// The home in the file.
    home: Option<HomePosition>,
    waypoints: Vec<Waypoint>,
    losses: LossReport,
    needs_amsl: bool,
    has_own: bool,
    /// A point does not say how it is passed.
    has_plain: bool,
    /// The waypoints are the points of a line that was simplified.
    is_simplified: bool,
}

impl<'m, 'p, 'a> Builder<'m, 'p, 'a> {
    /// Begins a plan with the home in the file.
    pub(super) fn new(
        map: &'m Map,
        options: &'m ReadOptions,
        problems: &'p mut Problems<'a>,
        zero_is_missing: bool,
    ) -> Self {
        let mut builder = Self {
            map,
            options,
            problems,
            zero_is_missing,
            home: None,
            waypoints: Vec::new(),
            losses: LossReport::default(),
            needs_amsl: false,
            has_own: false,
            has_plain: false,
            is_simplified: false,
        };
        for skipped in &map.skipped {
            let why = "it is not a line or a point, and nothing is fetched";
            let finding = Finding::new(Severity::Info, skipped.name, why);
            let line = builder.problems.line_at(skipped.at);
            builder.losses.add(finding.place(Place::Line { line }).values(skipped.count.to_string(), ""));
        }
        let home = map.features.iter().find(|feature| feature.properties.get("type") == Some(HOME));
        if let Some(home) = home {
            builder.read_home(home);
        }
        builder
    }

    /// Returns `true` if our data in the file are of a version that is read.
    pub(super) fn reads_own_data(&mut self) -> bool {
        let version = self.map.properties.get("betadeck");
        if let Some(version) = version.filter(|version| *version != VERSION) {
            let why = "data of another version of betadeck are not read";
            let finding = Finding::new(Severity::Assumed, "betadeck data", why);
            if !self.losses.findings.iter().any(|finding| finding.field == "betadeck data") {
                self.losses.add(finding.values(format!("version {version}"), ""));
            }
            return false;
        }
        true
    }

    /// Returns `true` if the file has our data for the whole plan.
    pub(super) fn is_own_file(&self) -> bool {
        self.map.properties.get("betadeck") == Some(VERSION)
    }

    fn read_home(&mut self, feature: &MapFeature) {
        let Some((Shape::Point(vertex), altitudes)) =
            feature.pieces.first().map(|piece| (&piece.shape, piece.altitudes))
        else {
            return;
        };
        let mut amsl_m = match map_data::home_amsl(&feature.properties) {
            Ok(amsl_m) => amsl_m,
            Err(error) => {
                self.problem(feature.at, feature.place.as_ref(), error.message, &error.hint);
                None
            }
        };
        let shown = (f64::from(vertex.altitude_m) * 100.0).round() / 100.0;
        let is_amsl = altitudes == Altitudes::AboveSeaLevel && shown.is_finite();
        if amsl_m.is_none() && is_amsl {
            // Another program dropped our data, and kept the point.
            amsl_m = super::home::amsl_m(&shown.to_string()).ok();
        } else if let Some(own) = amsl_m
            && is_amsl
            && (own - shown).abs() > SAME_ALTITUDE_M
        {
            let why = "another program changed the altitude of home, the point counts";
            let finding = Finding::new(Severity::Assumed, "home", why);
            self.losses.add(finding.values(format!("{own} m"), format!("{shown} m")));
            amsl_m = super::home::amsl_m(&shown.to_string()).ok();
        }
        self.home = Some(HomePosition { position: vertex.position, amsl_m });
    }

    /// Adds a problem at a place of the file.
    pub(super) fn problem(&mut self, at: usize, place: Option<&Place>, message: String, hint: &str) {
        let message = match place {
            Some(Place::Pointer { pointer }) => format!("{pointer}: {message}"),
            _ => message,
        };
        self.problems.add(at..at + 1, message, hint);
    }

    /// Adds a finding for the file.
    pub(super) fn finding(&mut self, finding: Finding) {
        self.losses.add(finding);
    }

    fn find(&self, spot: &Spot<'_>, severity: Severity, field: &str, why: &str) -> Finding {
        let finding = Finding::new(severity, field, why).at(self.waypoints.len()).item(spot.item);
        Finding { place: spot.place.cloned(), ..finding }
    }

    /// Returns the home whose altitude above sea level is known, if there is one.
    fn amsl_home(&self) -> Option<HomePosition> {
        self.home.filter(|home| home.amsl_m.is_some()).or(self.options.home)
    }

    /// Adds a waypoint of our own data. A place and an altitude that another program changed count.
    pub(super) fn own(&mut self, spot: &Spot<'_>, kind: WaypointType) {
        self.has_own = true;
        let place = spot.vertex.map(|(vertex, _)| vertex.position);
        let record = match map_data::record(spot.properties, kind, place) {
            Ok(record) => record,
            Err(error) => {
                self.problem(spot.at, spot.place, error.message, &error.hint);
                return;
            }
        };
        let mut waypoint = Waypoint::from(record);
        if kind.capability().altitude && spot.properties.get("alt_m").is_none() {
            waypoint.altitude = self.altitude(spot);
        } else if let Some(shown_m) = self.shown_altitude(spot)
            && (shown_m - waypoint.altitude.above_home_m()).abs() > SAME_ALTITUDE_M
        {
            let why = "another program changed the altitude of the point, the point counts";
            let finding = self.find(spot, Severity::Assumed, "altitude", why);
            let shown = Altitude::above_home(shown_m);
            let metres = |altitude: Altitude| format!("{} m", map_data::metres(altitude.above_home_m()));
            self.losses.add(finding.values(metres(waypoint.altitude), metres(shown)));
            waypoint.altitude = shown;
        }
        self.push(waypoint);
    }

    /// Returns the altitude of a point above home, if it says it.
    fn shown_altitude(&self, spot: &Spot<'_>) -> Option<f64> {
        if let Some(text) = spot.properties.get("altitudeRelative") {
            return text.parse().ok().filter(|&metres| altitude_m(metres).is_ok());
        }
        let (vertex, altitudes) = spot.vertex?;
        let metres = Some(f64::from(vertex.altitude_m)).filter(|metres| metres.is_finite())?;
        match altitudes {
            Altitudes::Clamped => None,
            Altitudes::AboveGround => Some(metres),
            Altitudes::AboveSeaLevel => Some(metres - self.amsl_home()?.amsl_m?),
        }
    }

    /// Adds a point of a file of another program that does not say how it is passed.
    pub(super) fn plain(&mut self, spot: &Spot<'_>) {
        self.has_plain |= spot.vertex.is_some();
        self.point(spot, self.options.waypoint_as);
    }

    /// Adds a point of a file of another program.
    pub(super) fn point(&mut self, spot: &Spot<'_>, kind: WaypointType) {
        let Some((vertex, _)) = spot.vertex else { return };
        let altitude = self.altitude(spot);
        self.push(Waypoint { position: vertex.position, altitude, kind, ..Waypoint::default() });
    }

    /// Adds a landing of MAVLink. Its altitude is that of the ground; ours is that of the approach.
    pub(super) fn land(&mut self, spot: &Spot<'_>) {
        let Some((vertex, _)) = spot.vertex else { return };
        let before = self.waypoints.iter().rev().find(|waypoint| waypoint.kind.capability().altitude);
        let level = before.map(|waypoint| waypoint.altitude);
        let theirs_m = self.shown_altitude(spot);
        let is_wrong = theirs_m.is_none() && spot.properties.get("altitudeRelative").is_some();
        let altitude = match level {
            Some(level) if !is_wrong => level,
            _ => self.altitude(spot),
        };
        if level.is_some() && theirs_m.map(Altitude::above_home) != Some(altitude) {
            let why = "the altitude of a MAVLink LAND is that of the ground";
            let finding = self.find(spot, Severity::Changed, "altitude", why);
            let text = |metres| format!("{} m", map_data::metres(metres));
            self.losses
                .add(finding.values(theirs_m.map_or_else(String::new, text), text(altitude.above_home_m())));
        }
        let kind = WaypointType::Land;
        self.push(Waypoint { position: vertex.position, altitude, kind, ..Waypoint::default() });
    }

    /// Adds a point that has the word of a type of ours and not the data that the type needs.
    pub(super) fn without_data(&mut self, spot: &Spot<'_>, kind: WaypointType) {
        let plain = self.options.waypoint_as;
        let finding = self.find(spot, Severity::Lost, "type", "the data of the point are missing");
        self.losses.add(finding.values(kind.to_string(), plain.to_string()));
        self.point(spot, plain);
    }

    fn push(&mut self, waypoint: Waypoint) {
        self.waypoints.push(waypoint);
        self.losses.items += 1;
    }

    /// Returns the altitude of a point of another program above home.
    fn altitude(&mut self, spot: &Spot<'_>) -> Altitude {
        if let Some(text) = spot.properties.get("altitudeRelative") {
            let read = text.parse::<f64>().map_err(|_| format!("altitudeRelative {text} is not a number"));
            return match read.and_then(altitude_m) {
                Ok(metres) => Altitude::above_home(metres),
                Err(message) => {
                    self.problem(spot.at, spot.place, message, "write the altitude above home, m");
                    Altitude::default()
                }
            };
        }
        let (metres, altitudes) = spot
            .vertex
            .map_or((f64::NAN, Altitudes::Clamped), |(vertex, mode)| (f64::from(vertex.altitude_m), mode));
        let reference = match altitudes {
            _ if metres.is_nan() || (self.zero_is_missing && metres == 0.0) => None,
            Altitudes::Clamped => None,
            Altitudes::AboveGround => Some(Reference::Ground),
            Altitudes::AboveSeaLevel => Some(Reference::SeaLevel),
        };
        let Some(reference) = reference else {
            if let Some(metres) = self.options.altitude_m {
                return Altitude::above_home(metres);
            }
            let why = "the point has no altitude: set it with --altitude";
            let finding = self.find(spot, Severity::Assumed, "altitude", why);
            self.losses.add(finding.values("", format!("{DEFAULT_ALTITUDE_M} m")));
            return Altitude::above_home(DEFAULT_ALTITUDE_M);
        };
        // Vertices have single precision; a file has centimetres.
        let metres = (metres * 100.0).round() / 100.0;
        match reference.above_home(metres, self.amsl_home(), self.options.flat) {
            Ok((altitude, finding)) => {
                if let Some(finding) = finding
                    && !self.losses.findings.contains(&finding)
                {
                    self.losses.add(finding);
                }
                altitude
            }
            Err(message) => {
                // One problem for the file: all its points lack the same home.
                if !std::mem::replace(&mut self.needs_amsl, true) {
                    self.problem(spot.at, spot.place, message, "the file gives altitudes above sea level");
                }
                Altitude::default()
            }
        }
    }

    /// Adds the points of a line.
    pub(super) fn line(&mut self, candidate: &Candidate<'m>) {
        let line = candidate.vertices();
        let Candidate { feature, piece, .. } = *candidate;
        let (at, place) = (feature.at, feature.place.as_ref());
        let tolerance_m = self.options.simplify_m;
        let kept = match tolerance_m {
            None => (0..line.len()).collect(),
            Some(tolerance_m) => {
                let most = if self.options.long { line.len() } else { MAX_WAYPOINTS + 1 };
                thinned(line, tolerance_m, most).kept
            }
        };
        if kept.len() > MAX_WAYPOINTS && !self.options.long {
            let count = line.len();
            let remain = match tolerance_m {
                Some(metres) => format!(", more than {MAX_WAYPOINTS} remain with --simplify {metres}"),
                None => String::new(),
            };
            // One digit more than needed, so that the rounded tolerance suffices.
            let enough_m = (thinned(line, 0.0, MAX_WAYPOINTS).distance_m * 10.0).floor() / 10.0 + 0.1;
            let message =
                format!("the line has {count} points{remain}, a plan holds at most {MAX_WAYPOINTS}");
            let hint = format!(
                "`betadeck convert` with --simplify {enough_m:.1} (metres) leaves out enough points near the line, with \
                 --split it writes several plans"
            );
            self.problem(at, place, message, &hint);
            return;
        }
        if kept.len() < line.len() {
            let why = "points near the line are left out (--simplify)";
            let finding = Finding::new(Severity::Changed, "points", why);
            let finding = Finding { place: place.cloned(), ..finding };
            self.losses.add(finding.values(line.len().to_string(), kept.len().to_string()));
        }
        self.wrapped(feature);
        let unknown = Properties::default();
        for &index in &kept {
            let detail = feature.details.get(index);
            let properties = detail.map_or(&unknown, |detail| &detail.properties);
            let at = detail.map_or(at, |detail| detail.at);
            let vertex = Some((line[index], piece.altitudes));
            let spot = Spot { item: index + 1, place, at, properties, vertex };
            self.plain(&spot);
        }
        self.losses.items = line.len();
        self.is_simplified = true;
    }

    /// Notes that longitudes of a feature were wrapped.
    pub(super) fn wrapped(&mut self, feature: &MapFeature) {
        if feature.is_wrapped {
            let why = "longitudes beyond 180 degrees are wrapped";
            let finding = Finding::new(Severity::Changed, "longitude", why);
            self.losses.add(Finding { place: feature.place.clone(), ..finding });
        }
    }

    /// Returns the plan with name, description, home and settings of the file.
    pub(super) fn finish(mut self) -> PlanFile {
        let count = self.waypoints.len();
        if count > MAX_WAYPOINTS && !self.options.long {
            let message = format!("the file has {count} waypoints, a plan holds at most {MAX_WAYPOINTS}");
            self.problem(0, None, message, &hint());
        }
        if count == 0 && self.problems.is_empty() && !self.is_own_file() {
            self.problem(
                0,
                None,
                "the file has no points of a plan".to_owned(),
                "a plan is a line or points",
            );
        }
        if self.has_plain {
            let why = "the file does not say how a point is passed: set it with --waypoint-as";
            let finding = Finding::new(Severity::Assumed, "type", why);
            self.losses.add(finding.values("", self.options.waypoint_as.to_string()));
        }
        if self.has_own && self.map.properties.get("betadeck").is_none() {
            let why =
                "the data of the whole plan are missing: another program wrote the file without its settings";
            self.losses.add(Finding::new(Severity::Assumed, "settings", why));
        }
        let settings = if self.reads_own_data() { self.settings() } else { Vec::new() };
        let mut file = PlanFile {
            name: self.map.name.clone(),
            description: self.map.description.clone(),
            home: self.home.map(|home| self.with_amsl(home)),
            settings,
            losses: self.losses,
            ..PlanFile::default()
        };
        file.take(self.waypoints);
        if let Some(tolerance_m) = self.options.simplify_m.filter(|_| !self.is_simplified) {
            file.simplify(tolerance_m);
        }
        file
    }

    /// Returns a home of the file, with the altitude of that of the user if both are at the same place.
    fn with_amsl(&self, home: HomePosition) -> HomePosition {
        let is_near =
            |given: &HomePosition| distance_bearing(home.position, given.position).0 <= SAME_PLACE_M;
        let given = self.options.home.filter(is_near).and_then(|given| given.amsl_m);
        HomePosition { amsl_m: home.amsl_m.or(given), ..home }
    }

    fn settings(&mut self) -> Vec<String> {
        let mut settings = Vec::new();
        for line in self.map.properties.all("setting") {
            let setting = setting_line(line);
            let fault = match setting.as_deref().and_then(|setting| setting.split_once(" = ")) {
                Some((name, value)) => (self.options.check)(name, value).err(),
                None => {
                    self.problems.add(0..0, format!("{line} is not a setting"), "write NAME = VALUE");
                    None
                }
            };
            if let Some(fault) = fault {
                self.problems.add(0..0, fault.message, fault.hint);
            }
            settings.extend(setting);
        }
        settings
    }
}
