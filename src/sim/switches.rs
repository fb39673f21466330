//! The plant's rare switches: `--world NAME=VALUE`.

use std::str::FromStr;

use super::surface::{MAX_RISE_M, Surface};
use crate::sim::error::{WorldError, in_range};
use crate::sim::gps_grade::GpsGrade;
use crate::sim::value_text::{ParseError, number, on_off};
use crate::text::did_you_mean;

/// The declination of the field of Betaflight's SITL, degrees east.
pub const SITL_DECLINATION_DEG: f64 = 2.000_675_735_167_871_2;

/// The change of the mean wind with height.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum WindProfile {
    /// The stated speed from 10 m up, less below it (logarithmic law over short grass).
    #[default]
    Log,
    /// The stated speed at every height.
    Flat,
}

/// The change of air density with height.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum AirDensity {
    /// Density of the standard atmosphere at the altitude of the craft.
    #[default]
    Isa,
    /// The density for which the airframe's coefficients are given, everywhere.
    Reference,
}

/// The rare switches of a world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Switches {
    /// Mean wind over height.
    pub wind_profile: WindProfile,
    /// `true` if battery voltage limits rotor speed.
    pub battery_sag: bool,
    /// Battery capacity instead of the airframe's, A·h.
    pub battery_capacity_ah: Option<f64>,
    /// `true` if rotors gain thrust near the ground.
    pub ground_effect: bool,
    /// The shape of the ground.
    pub ground: Surface,
    /// Factor on the turbulence velocities.
    pub turbulence_scale: f64,
    /// Rise and fall time of a gust, s.
    pub gust_rise_s: f64,
    /// Air density over height.
    pub air_density: AirDensity,
    /// Vibration that the accelerometer measures at hover speed, m/s² rms per axis.
    pub vibration_mps2: f64,
    /// `true` if the inertial sensors have turn-on bias and drift, and the barometer drifts.
    pub sensor_bias: bool,
    /// Declination of the magnetic field, degrees east.
    pub declination_deg: f64,
    /// Quality of the GPS, with real noise.
    pub gps: GpsGrade,
}

impl Default for Switches {
    fn default() -> Self {
        Self {
            wind_profile: WindProfile::Log,
            battery_sag: false,
            battery_capacity_ah: None,
            ground_effect: false,
            ground: Surface::Flat,
            turbulence_scale: 1.0,
            gust_rise_s: 1.0,
            air_density: AirDensity::Isa,
            vibration_mps2: 0.0,
            sensor_bias: true,
            declination_deg: crate::sim::switches::SITL_DECLINATION_DEG,
            gps: GpsGrade::Open,
        }
    }
}

/// One switch: name, allowed values, meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SwitchInfo {
    /// Name before the `=`.
    pub name: &'static str,
    /// Allowed values, for people.
    pub values: &'static str,
    /// A description for people.
    pub help: &'static str,
}

/// Defines the switches, each with its name, its field, its values, its meaning, and the way to read and write it.
macro_rules! switches {
    ($($name:literal $field:ident $values:literal $help:literal = $read:expr, $write:expr;)*) => {
        /// All switches, for help and completion.
        pub const SWITCHES: [SwitchInfo; [$($name),*].len()] =
            [$(SwitchInfo { name: $name, values: $values, help: $help }),*];

        impl Switches {
            fn assign(&mut self, name: &str, value: &str) -> Result<(), String> {
                match name {
                    $($name => self.$field = $read(value)?,)*
                    _ => {}
                }
                Ok(())
            }

            /// Returns the switches that differ from the default, in the form that [`Self::set`] takes.
            pub fn changed(&self) -> Vec<String> {
                let usual = Self::default();
                let all = [$((self.$field != usual.$field, format!("{}={}", $name, $write(&self.$field)))),*];
                all.into_iter().filter(|(differs, _)| *differs).map(|(_, text)| text).collect()
            }
        }
    };
}

switches! {
    "wind_profile" wind_profile "log, flat"
        "wind grows with height up to 10 m, or is the same everywhere" = word("wind_profile"), ToString::to_string;
    "battery_sag" battery_sag "on, off" "battery voltage limits rotor speed" = on_off, on_or_off;
    "battery_capacity" battery_capacity_ah "0.01 to 100" "capacity in A·h instead of the airframe's"
        = |value: &str| within(0.01, 100.0)(value).map(Some), |capacity: &Option<f64>| capacity.unwrap_or_default();
    "ground_effect" ground_effect "on, off" "rotors gain thrust near the ground" = on_off, on_or_off;
    "ground" ground "flat, slope,RISE,BEARING (RISE 0 to 40, BEARING 0 to 360), terrain"
        "level ground, a plane through home that rises by RISE m in 100 m towards BEARING degrees, or the elevation tiles"
        = Surface::parse, ToString::to_string;
    "turbulence_scale" turbulence_scale "0 to 10" "multiplies the turbulence"
        = within(0.0, 10.0), ToString::to_string;
    "gust_rise" gust_rise_s "0.05 to 30" "rise and fall time of a gust, s"
        = within(0.05, 30.0), ToString::to_string;
    "air_density" air_density "isa, reference" "standard atmosphere, or 1.225 kg/m³ everywhere"
        = word("air_density"), ToString::to_string;
    "vibration" vibration_mps2 "0 to 50" "accelerometer vibration at hover speed, m/s² rms per axis"
        = within(0.0, 50.0), ToString::to_string;
    "sensor_bias" sensor_bias "on, off" "turn-on bias and drift of gyro, accelerometer and barometer"
        = on_off, on_or_off;
    "declination" declination_deg "-180 to 180" "magnetic declination, degrees east"
        = within(-180.0, 180.0), ToString::to_string;
    "gps" gps "rtk, open, consumer, urban"
        "how well the GPS measures: centimetres, open sky, single band, among buildings"
        = word("gps"), ToString::to_string;
}

fn on_or_off(on: &bool) -> &'static str {
    if *on { "on" } else { "off" }
}

/// Returns the reader of a number within bounds.
fn within(min: f64, max: f64) -> impl Fn(&str) -> Result<f64, String> {
    move |value| match number("value", value)? {
        number if (min..=max).contains(&number) => Ok(number),
        _ => Err(format!("{value} is out of range")),
    }
}

/// Returns the reader of a word of the switch `name`.
fn word<T: FromStr>(name: &str) -> impl Fn(&str) -> Result<T, String> {
    move |value| value.parse().map_err(|_| format!("{value} is not a value of {name}"))
}

impl Switches {
    /// Sets one switch from `NAME=VALUE`.
    ///
    /// # Errors
    /// Fails if the name is unknown or the value is not allowed.
    pub fn set(&mut self, text: &str) -> Result<(), ParseError> {
        let error = |problem: String| ParseError::new("world switch", text, problem);
        let Some((name, value)) = text.split_once('=') else {
            return Err(error(format!(
                "write NAME=VALUE with a name of {}",
                SWITCHES.map(|s| s.name).join(", ")
            )));
        };
        let (name, value) = (name.trim(), value.trim());
        let Some(info) = SWITCHES.iter().find(|info| info.name == name) else {
            let hint = did_you_mean::suffix(name, SWITCHES.iter().map(|s| s.name));
            return Err(error(format!(
                "there is no switch {name}{hint}; there are {}",
                SWITCHES.map(|s| s.name).join(", ")
            )));
        };
        self.assign(name, value).map_err(|problem| error(format!("{problem}; allowed are {}", info.values)))
    }

    /// Checks that all numbers are in the ranges of [`SWITCHES`].
    pub(super) fn check(&self) -> Result<(), WorldError> {
        let (rise_m, bearing_deg) = self.ground.numbers();
        in_range("rise of the ground", rise_m, 0.0, MAX_RISE_M)?;
        in_range("bearing of the ground's rise", bearing_deg, 0.0, 360.0)?;
        in_range("turbulence_scale", self.turbulence_scale, 0.0, 10.0)?;
        in_range("gust_rise", self.gust_rise_s, 0.05, 30.0)?;
        in_range("vibration", self.vibration_mps2, 0.0, 50.0)?;
        in_range("declination", self.declination_deg, -180.0, 180.0)?;
        self.battery_capacity_ah
            .map_or(Ok(()), |capacity| in_range("battery_capacity", capacity, 0.01, 100.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::surface::Slope;

    #[test]
    fn switches_are_set_by_name() {
        let mut switches = Switches::default();
        for text in [
            "wind_profile=flat",
            "battery_sag=on",
            "battery_capacity=0.5",
            "ground_effect=on",
            "ground=slope,8,90",
            "turbulence_scale=0.5",
            "gust_rise=2",
            "air_density=reference",
            "vibration=0.3",
            "sensor_bias=off",
            "declination=-9.5",
            "gps=urban",
        ] {
            switches.set(text).unwrap();
        }
        let expected = Switches {
            wind_profile: WindProfile::Flat,
            battery_sag: true,
            battery_capacity_ah: Some(0.5),
            ground_effect: true,
            ground: Surface::Slope(Slope::new(8.0, 90.0)),
            turbulence_scale: 0.5,
            gust_rise_s: 2.0,
            air_density: AirDensity::Reference,
            vibration_mps2: 0.3,
            sensor_bias: false,
            declination_deg: -9.5,
            gps: GpsGrade::Urban,
        };
        assert_eq!(switches, expected);
        let mut again = Switches::default();
        for text in switches.changed() {
            again.set(&text).unwrap();
        }
        assert_eq!(again, expected);
        assert!(Switches::default().changed().is_empty());
    }

    #[test]
    fn every_listed_switch_is_known_to_the_parser() {
        for info in SWITCHES {
            let error = Switches::default().set(&format!("{}=banana", info.name)).unwrap_err().to_string();
            assert!(error.contains(info.values), "{error}");
        }
    }

    #[test]
    fn errors_name_the_switch_and_the_way_out() {
        let error = |text| Switches::default().set(text).unwrap_err().to_string();
        assert!(error("wind_profil=flat").contains("did you mean wind_profile?"));
        assert!(error("wind_profile").contains("NAME=VALUE"));
        assert!(error("turbulence_scale=11").contains("allowed are 0 to 10"));
        assert_eq!(
            error("ground=slope,41,90"),
            "world switch \"ground=slope,41,90\": the rise 41 is out of range; allowed are flat, \
             slope,RISE,BEARING (RISE 0 to 40, BEARING 0 to 360), terrain"
        );
    }

    #[test]
    fn a_ground_that_no_text_could_describe_is_refused() {
        let on = |rise_m, bearing_deg| {
            Switches { ground: Surface::Slope(Slope::new(rise_m, bearing_deg)), ..Switches::default() }
                .check()
        };
        assert_eq!(on(8.0, 90.0), Ok(()));
        for (rise_m, bearing_deg) in [(41.0, 90.0), (-1.0, 90.0), (f64::NAN, 90.0), (8.0, 361.0), (8.0, -1.0)]
        {
            assert!(on(rise_m, bearing_deg).is_err(), "{rise_m} m towards {bearing_deg}°");
        }
    }
}
