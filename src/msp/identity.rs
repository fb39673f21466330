//! The identity of the flight controller: firmware, version, board and build.

use super::wire::{Reader, Writer, text};

/// `FC_VARIANT` of Betaflight.
pub const BETAFLIGHT: &[u8] = b"BTFL";
/// The build option of waypoint missions.
pub const FLIGHT_PLAN_OPTION: u16 = 16_427;
/// From this first byte on, a version is a year and comes with its text.
const FIRST_YEAR: u8 = 10;
/// The bytes of date, time and revision.
const BUILD_TEXTS: [usize; 3] = [11, 8, 7];
/// The bytes of a board's identifier.
const IDENTIFIER: usize = 4;
/// The bytes of a board's signature.
const SIGNATURE: usize = 32;
/// The code of a processor that another message names.
pub const PROCESSOR_NAMED: u8 = 0xfe;

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

    pub fn encode(&self, writer: &mut Writer) {
        writer.bytes(&[0, self.major, self.minor]);
    }
}

impl std::fmt::Display for ApiVersion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}

/// `FC_VERSION`. `Display` gives the version as users write it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FcVersion {
    /// Major, minor and patch, or year since 2000, month and patch.
    pub numbers: [u8; 3],
    /// The version in words, in releases that report it.
    pub text: Option<String>,
}

impl FcVersion {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let numbers = [reader.u8()?, reader.u8()?, reader.u8()?];
        Some(Self { numbers, text: reader.prefixed_text().filter(|text| !text.is_empty()) })
    }

    pub fn encode(&self, writer: &mut Writer) {
        writer.bytes(&self.numbers);
        writer.prefixed(self.text.as_deref().unwrap_or_default());
    }
}

impl std::fmt::Display for FcVersion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [major, minor, patch] = self.numbers;
        match &self.text {
            _ if major < FIRST_YEAR => write!(f, "{major}.{minor}.{patch}"),
            Some(text) => f.write_str(text),
            None => write!(f, "{}.{minor}.{patch}", 2000 + u16::from(major)),
        }
    }
}

/// `BOARD_INFO`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BoardInfo {
    pub identifier: String,
    /// The target that the firmware was built for.
    pub target: Option<String>,
    /// The name of the board, if it has one.
    pub name: Option<String>,
    pub manufacturer: Option<String>,
    /// `true` if the board was configured.
    pub configured: Option<bool>,
    /// The rate of the gyro loop, Hz.
    pub gyro_hz: Option<u16>,
}

impl BoardInfo {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let mut info = Self { identifier: reader.text(IDENTIFIER)?, ..Self::default() };
        reader.bytes(4); // hardware revision, OSD chip, capabilities
        let given = |name: &String| !name.is_empty();
        info.target = reader.prefixed_text().filter(given);
        info.name = reader.prefixed_text().filter(given);
        info.manufacturer = reader.prefixed_text().filter(given);
        reader.bytes(SIGNATURE + 1); // signature, processor
        info.configured = reader.u8().map(|state| state == 1);
        info.gyro_hz = reader.u16();
        Some(info)
    }

    pub fn encode(&self, writer: &mut Writer) {
        writer.padded(&self.identifier, IDENTIFIER);
        // Hardware revision, OSD chip (configurators stop polling if it is neither 0 nor 2), capabilities.
        writer.zeros(4);
        for text in [&self.target, &self.name, &self.manufacturer] {
            writer.prefixed(text.as_deref().unwrap_or_default());
        }
        writer.zeros(SIGNATURE);
        writer.u8(PROCESSOR_NAMED);
        writer.u8(u8::from(self.configured == Some(true)));
        writer.u16(self.gyro_hz.unwrap_or_default());
        writer.zeros(6); // problems, SPI and I2C devices
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

    pub fn encode(&self, writer: &mut Writer) {
        for (text, size) in [&self.date, &self.time, &self.revision].into_iter().zip(BUILD_TEXTS) {
            writer.padded(text, size);
        }
        for option in self.options.iter().flatten() {
            writer.u16(*option);
        }
    }

    /// Returns `true` if the build includes waypoint missions; `None` if it does not report its options.
    pub fn has_flight_plan(&self) -> Option<bool> {
        self.options.as_ref().map(|options| options.contains(&FLIGHT_PLAN_OPTION))
    }
}
