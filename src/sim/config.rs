//! What a world is made of at boot, with the parsers of the command-line values.

use std::str::FromStr;

use nalgebra::Vector3;
use strum::VariantNames;

use super::airframe::Airframe;
use super::fault::{FaultLink, ScheduledFault};
use super::parse::{ParseError, number, number_in};
use super::switches::Switches;
use crate::did_you_mean;
use crate::telemetry::FaultKind;

/// Step rates that a world accepts, Hz. Each divides a hundredth of a second into whole steps.
pub const STEP_RATES_HZ: [u32; 6] = [400, 500, 1000, 2000, 4000, 8000];

/// Everything a [`World`](super::World) needs to know at boot.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldConfig {
    /// What flies.
    pub airframe: Airframe,
    /// Where it stands.
    pub home: Home,
    /// Steps per second, one of [`STEP_RATES_HZ`].
    pub rate_hz: u32,
    /// Seed of all randomness.
    pub seed: u64,
    /// Whether the sensors err.
    pub noise: Noise,
    /// Mean wind.
    pub wind: Wind,
    /// Size of random gusts, m/s; 0 for none.
    pub gust_mps: f64,
    /// Level of turbulence.
    pub turbulence: Turbulence,
    /// Rare switches.
    pub switches: Switches,
    /// Faults that will happen.
    pub faults: Vec<ScheduledFault>,
    /// Whether there is an external link that link faults can act on.
    pub link: FaultLink,
}

impl Default for WorldConfig {
    /// An `iris` in calm air at the default home, 1 kHz, seed 1, real noise.
    fn default() -> Self {
        Self {
            airframe: Airframe::iris(),
            home: Home::default(),
            rate_hz: 1000,
            seed: 1,
            noise: Noise::Real,
            wind: Wind::CALM,
            gust_mps: 0.0,
            turbulence: Turbulence::None,
            switches: Switches::default(),
            faults: Vec::new(),
            link: FaultLink::Embedded,
        }
    }
}

/// Why a world cannot be built or a command cannot be carried out.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// A step rate that is too slow to be stable.
    #[error(
        "a rate of {0} Hz is a step longer than 2.5 ms, and the physics is not stable with longer steps; \
         choose 400, 500, 1000, 2000, 4000 or 8000 Hz"
    )]
    StepTooLong(u32),
    /// A step rate that does not fit the clock.
    #[error("a rate of {0} Hz does not fit the clock; choose 400, 500, 1000, 2000, 4000 or 8000 Hz")]
    OddRate(u32),
    /// An airframe that cannot fly.
    #[error("airframe {0}: {1}")]
    Airframe(String, String),
    /// A home that is no place.
    #[error("home {0} {1} is out of range; allowed are {2} to {3}")]
    Home(&'static str, f64, f64, f64),
    /// A fault of the external link in a world without one.
    #[error(
        "fault {0} acts on the link to an external simulator, and this flight has none; leave it out, or use betadeck serve --physics external"
    )]
    NeedsLink(FaultKind),
    /// A fault of the craft or the air when a simulator outside has both.
    #[error(
        "fault {0} is up to the simulator that moves the craft: make it there; here there are rx-loss, gps-loss, stall, fdm-loss, fdm-late, fdm-dup and fdm-jitter"
    )]
    OutsideFault(FaultKind),
    /// A change of the air, the sensors or the craft's place when a simulator outside has them.
    #[error(
        "the simulator makes the air and places the craft: change that there; here there are faults of the links (fault=NAME, end=NAME)"
    )]
    Outside,
    /// More faults than can be kept.
    #[error("there can be at most {0} faults, waiting and active ones together")]
    TooManyFaults(usize),
    /// A fault or a switch with a value that is not allowed.
    #[error(transparent)]
    Value(#[from] ParseError),
    /// A number that is not allowed.
    #[error("{name} {value} is out of range; allowed are {min} to {max}")]
    OutOfRange {
        /// What the number is.
        name: &'static str,
        /// The number.
        value: f64,
        /// Least allowed.
        min: f64,
        /// Greatest allowed.
        max: f64,
    },
}

/// Length of a step in microseconds at a rate.
///
/// # Errors
/// When the rate is not one of [`STEP_RATES_HZ`].
pub fn step_us(rate_hz: u32) -> Result<u64, WorldError> {
    if STEP_RATES_HZ.contains(&rate_hz) {
        Ok(1_000_000 / u64::from(rate_hz))
    } else if rate_hz < STEP_RATES_HZ[0] {
        Err(WorldError::StepTooLong(rate_hz))
    } else {
        Err(WorldError::OddRate(rate_hz))
    }
}

/// Where the craft stands at boot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Home {
    /// Latitude, degrees.
    pub lat_deg: f64,
    /// Longitude, degrees.
    pub lon_deg: f64,
    /// Altitude of the ground above mean sea level, m.
    pub alt_amsl_m: f64,
    /// Heading of the nose, degrees clockwise from north.
    pub heading_deg: f64,
}

impl Default for Home {
    fn default() -> Self {
        Self { lat_deg: 40.4635, lon_deg: -79.5182, alt_amsl_m: 300.0, heading_deg: 0.0 }
    }
}

impl Home {
    /// Allowed altitudes of the ground, m above mean sea level.
    const ALTITUDE_M: (f64, f64) = (-500.0, 9000.0);

    pub(super) fn check(&self) -> Result<(), WorldError> {
        let (low, high) = Self::ALTITUDE_M;
        for (name, value, min, max) in [
            ("latitude", self.lat_deg, -90.0, 90.0),
            ("longitude", self.lon_deg, -180.0, 180.0),
            ("altitude", self.alt_amsl_m, low, high),
            ("heading", self.heading_deg, -360.0, 360.0),
        ] {
            if !(min..=max).contains(&value) {
                return Err(WorldError::Home(name, value, min, max));
            }
        }
        Ok(())
    }
}

impl FromStr for Home {
    type Err = ParseError;

    /// `LAT,LON[,AMSL]`: degrees, degrees, metres above sea level (300 when left out); faces north.
    fn from_str(text: &str) -> Result<Self, ParseError> {
        let error = |problem: String| {
            ParseError::new(
                "home",
                text,
                format!("{problem}; write LAT,LON[,AMSL], for example 40.4635,-79.5182,300"),
            )
        };
        let (low, high) = Self::ALTITUDE_M;
        let parts: Vec<&str> = text.split(',').collect();
        let (lat, lon, alt) = match parts[..] {
            [lat, lon] => (lat, lon, None),
            [lat, lon, alt] => (lat, lon, Some(alt)),
            _ => return Err(error("a place has two or three numbers".to_owned())),
        };
        let default = Self::default();
        Ok(Self {
            lat_deg: number_in("latitude", lat, -90.0, 90.0).map_err(error)?,
            lon_deg: number_in("longitude", lon, -180.0, 180.0).map_err(error)?,
            alt_amsl_m: match alt {
                Some(alt) => number_in("altitude", alt, low, high).map_err(error)?,
                None => default.alt_amsl_m,
            },
            heading_deg: default.heading_deg,
        })
    }
}

/// Whether sensors err.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display, strum::EnumString, strum::VariantNames,
)]
#[strum(serialize_all = "lowercase")]
pub enum Noise {
    /// Noise, bias, drift, latency and acquisition as in ordinary parts.
    #[default]
    Real,
    /// Exact values without delay.
    None,
}

impl Noise {
    /// The level with this name.
    ///
    /// # Errors
    /// When there is none.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        text.parse().map_err(|_| one_of("noise", text, Self::VARIANTS))
    }
}

/// Level of turbulence; the wind at 20 ft that MIL-F-8785C gives each is 15, 30 and 45 kt.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Hash,
    strum::Display,
    strum::EnumString,
    strum::VariantNames,
    strum::EnumIter,
    strum::IntoStaticStr,
)]
#[strum(serialize_all = "lowercase")]
pub enum Turbulence {
    /// Smooth air.
    #[default]
    None,
    /// Light.
    Light,
    /// Moderate.
    Moderate,
    /// Severe.
    Severe,
}

impl Turbulence {
    /// The level with this name.
    ///
    /// # Errors
    /// When there is none.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        text.parse().map_err(|_| one_of("turbulence", text, Self::VARIANTS))
    }

    /// Wind at 20 ft that stands for the level, kt.
    #[must_use]
    pub fn wind_at_20ft_kt(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Light => 15.0,
            Self::Moderate => 30.0,
            Self::Severe => 45.0,
        }
    }
}

pub(super) fn one_of(what: &'static str, text: &str, names: &[&'static str]) -> ParseError {
    let hint = did_you_mean::suffix(text, names.iter().copied());
    ParseError::new(what, text, format!("allowed are {}{hint}", names.join(", ")))
}

/// A steady horizontal wind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wind {
    /// Speed, m/s.
    pub speed_mps: f64,
    /// Direction it blows from, degrees clockwise from north.
    pub from_deg: f64,
}

impl Wind {
    /// No wind.
    pub const CALM: Self = Self { speed_mps: 0.0, from_deg: 0.0 };

    /// The strongest wind that can be asked for, m/s.
    pub const MAX_MPS: f64 = 60.0;

    /// Velocity of the air, ENU, m/s: the direction it blows to.
    #[must_use]
    pub fn velocity_enu(&self) -> Vector3<f64> {
        let (east, north) = self.from_deg.to_radians().sin_cos();
        Vector3::new(-self.speed_mps * east, -self.speed_mps * north, 0.0)
    }
}

impl Default for Wind {
    fn default() -> Self {
        Self::CALM
    }
}

impl FromStr for Wind {
    type Err = ParseError;

    /// `SPEED@FROM_DEG`, or `calm`.
    fn from_str(text: &str) -> Result<Self, ParseError> {
        if text == "calm" {
            return Ok(Self::CALM);
        }
        let error = |problem: String| {
            ParseError::new(
                "wind",
                text,
                format!(
                    "{problem}; write SPEED@FROM, for example 5@270: 5 m/s blowing from the west, or calm"
                ),
            )
        };
        let (speed, from) =
            text.split_once('@').ok_or_else(|| error("the direction it blows from is missing".to_owned()))?;
        let speed_mps = number_in("speed", speed, 0.0, Self::MAX_MPS).map_err(error)?;
        let from_deg = number("direction", from).map_err(error)?.rem_euclid(360.0);
        Ok(Self { speed_mps, from_deg })
    }
}

impl std::fmt::Display for Wind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}@{}", self.speed_mps, self.from_deg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wind_from_the_west_blows_east() {
        let wind: Wind = "5@270".parse().unwrap();
        assert!((wind.velocity_enu() - Vector3::new(5.0, 0.0, 0.0)).norm() < 1e-12);
        assert_eq!(wind.to_string(), "5@270");
        assert_eq!("calm".parse(), Ok(Wind::CALM));
        assert_eq!("3@-90".parse(), Ok(Wind { speed_mps: 3.0, from_deg: 270.0 }));
    }

    #[test]
    fn wind_errors_say_what_to_write() {
        for (text, part) in [
            ("5", "the direction it blows from is missing"),
            ("5@", "the direction is missing"),
            ("x@3", "speed x is not a number"),
            ("-1@3", "out of range; allowed are 0 to 60"),
            ("NaN@3", "not a number"),
            ("1@inf", "not a number"),
        ] {
            let error = text.parse::<Wind>().unwrap_err().to_string();
            assert!(error.contains(part) && error.contains("5@270"), "{error}");
        }
    }

    #[test]
    fn levels_are_suggested() {
        assert_eq!(Turbulence::parse("light"), Ok(Turbulence::Light));
        let error = Turbulence::parse("sever").unwrap_err().to_string();
        assert_eq!(
            error,
            "turbulence \"sever\": allowed are none, light, moderate, severe; did you mean severe?"
        );
        assert_eq!(Noise::parse("none"), Ok(Noise::None));
    }

    #[test]
    fn home_reads_two_or_three_numbers() {
        let home: Home = "-27.5,153.0,30".parse().unwrap();
        assert_eq!((home.lat_deg, home.lon_deg, home.alt_amsl_m), (-27.5, 153.0, 30.0));
        assert_eq!("1,2".parse::<Home>().unwrap().alt_amsl_m, 300.0);
        let error = "91,2".parse::<Home>().unwrap_err().to_string();
        assert!(error.contains("latitude 91 is out of range; allowed are -90 to 90"), "{error}");
    }

    #[test]
    fn long_steps_are_refused_with_the_reason() {
        assert_eq!(step_us(8000), Ok(125));
        assert!(step_us(399).unwrap_err().to_string().contains("2.5 ms"));
        assert!(step_us(1500).unwrap_err().to_string().contains("choose 400, 500, 1000"));
    }
}
