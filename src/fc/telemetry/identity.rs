//! The identity of the flight controller: firmware, version, board and build.

use super::reader::{Reader, text};

/// The build option of waypoint missions.
pub const FLIGHT_PLAN_OPTION: u16 = 16_427;
/// From this first byte on, a version is a year and comes with its text.
const FIRST_YEAR: u8 = 10;
/// The bytes of date, time and revision.
const BUILD_TEXTS: [usize; 3] = [11, 8, 7];
/// The bytes of a board's signature.
const SIGNATURE: usize = 32;

/// `API_VERSION`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ApiVersion {
    /// Changes with incompatible releases.
    pub major: u8,
    /// Changes when messages grow.
    pub minor: u8,
}

impl ApiVersion {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        reader.u8()?; // version of the protocol
        Some(Self { major: reader.u8()?, minor: reader.u8()? })
    }
}

impl std::fmt::Display for ApiVersion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}

/// `FC_VARIANT`: `BTFL` is Betaflight.
pub fn variant(payload: &[u8]) -> Option<String> {
    Reader::new(payload).text(4)
}

/// Decodes `FC_VERSION`. Returns the version as users write it.
pub fn version(payload: &[u8]) -> Option<String> {
    let mut reader = Reader::new(payload);
    let [major, minor, patch] = [reader.u8()?, reader.u8()?, reader.u8()?];
    if major < FIRST_YEAR {
        return Some(format!("{major}.{minor}.{patch}"));
    }
    let text = reader.prefixed_text().filter(|text| !text.is_empty());
    Some(text.unwrap_or_else(|| format!("{}.{minor}.{patch}", 2000 + u16::from(major))))
}

/// `BOARD_INFO`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BoardInfo {
    pub identifier: String,
    /// The target that the firmware was built for.
    pub target: Option<String>,
    /// The name of the board, if it has one.
    pub name: Option<String>,
    /// `true` if the board was configured.
    pub configured: Option<bool>,
    /// The rate of the gyro loop, Hz.
    pub gyro_hz: Option<u16>,
}

impl BoardInfo {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let mut info = Self { identifier: reader.text(4)?, ..Self::default() };
        reader.bytes(4); // hardware revision, OSD chip, capabilities
        let given = |name: &String| !name.is_empty();
        info.target = reader.prefixed_text().filter(given);
        info.name = reader.prefixed_text().filter(given);
        reader.prefixed_text(); // manufacturer
        reader.bytes(SIGNATURE + 1); // signature, processor
        info.configured = reader.u8().map(|state| state == 1);
        info.gyro_hz = reader.u16();
        Some(info)
    }
}

/// `BUILD_INFO`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BuildInfo {
    /// The day of the build.
    pub date: String,
    /// The time of the build.
    pub time: String,
    /// The revision of the source.
    pub revision: String,
    /// The build options; `None` in releases that do not report them.
    pub options: Option<Vec<u16>>,
}

impl BuildInfo {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let [date, time, revision] = BUILD_TEXTS.map(|count| reader.bytes(count).map(text));
        let options: Vec<u16> = std::iter::from_fn(|| reader.u16()).collect();
        let options = (!options.is_empty()).then_some(options);
        Some(Self { date: date?, time: time?, revision: revision?, options })
    }

    /// Returns `true` if the build includes waypoint missions; `None` if it does not report its options.
    pub fn has_flight_plan(&self) -> Option<bool> {
        self.options.as_ref().map(|options| options.contains(&FLIGHT_PLAN_OPTION))
    }
}
