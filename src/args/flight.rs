//! The craft, its position and the air: the options that all flying commands share.

use std::path::PathBuf;

use crate::plan::format::HomePosition;
use crate::sim::{self, Noise, Switches, Wind};
use crate::telemetry::{FirmwareProfile, Turbulence};

use super::help;
use super::terrain::TerrainArgs;
use super::value::{self, AttitudeChoice, OnOff, Speed};

/// The options that all flying commands share; `None` = the command's default.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct FlightArgs {
    /// Place of the craft at boot: degrees, degrees, metres above sea level [default: the plan's home, else
    /// 40.4635,-79.5182,300]
    ///
    /// If neither you nor the plan gives a home and the first waypoint is more than 10 km from the default, the craft
    /// starts at that waypoint.
    #[arg(long, value_name = "LAT,LON[,AMSL]", allow_hyphen_values = true, help_heading = "Craft")]
    pub home: Option<HomePosition>,

    /// Heading of the nose at boot, degrees clockwise from north [default: 0]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = value::heading, help_heading = "Craft")]
    pub heading: Option<f64>,

    /// Airframe: iris, five-inch, or a TOML file [default: iris]
    #[arg(long, value_name = "NAME|FILE", help_heading = "Craft")]
    pub airframe: Option<String>,

    /// CLI lines that are applied at boot as if typed: a `diff all`, a `dump`, a hand-written list
    ///
    /// Later sources win: the stored configuration, the plan's settings, this file, --set.
    #[arg(long, value_name = "FILE", help_heading = "Craft")]
    pub settings: Option<PathBuf>,

    /// Laws of the embedded autopilot: guide, master [default: the stored configuration's, else guide]
    #[arg(long, value_name = "NAME", hide_possible_values = true, value_parser = value::profile, help_heading = "Craft")]
    pub profile: Option<FirmwareProfile>,

    /// Directory of the craft's configuration and logs [default: the user's state directory; fly: none, as --fresh]
    #[arg(long, value_name = "DIR", conflicts_with = "fresh", help_heading = "Craft")]
    pub state_dir: Option<PathBuf>,

    /// Starts from defaults; writes only the files named on the command line
    #[arg(long, help_heading = "Craft")]
    pub fresh: bool,

    /// Source of the attitude: estimated, truth [default: estimated; external simulator: truth]
    #[arg(long, value_name = "SOURCE", hide_possible_values = true, help_heading = "Craft")]
    pub attitude: Option<AttitudeChoice>,

    /// Lets a script arm that holds the ARM switch on from its first packet: on, off [default: on; fly, compare: off]
    #[arg(long, value_name = "SWITCH", hide_possible_values = true, help_heading = "Craft")]
    pub arm_assist: Option<OnOff>,

    /// Mean wind: m/s and the direction it blows from in degrees, such as 5@270 [default: calm]
    #[arg(long, value_name = "SPEED@FROM", allow_hyphen_values = true, help_heading = "Air")]
    pub wind: Option<Wind>,

    /// Strength of random gusts, m/s [default: 0]
    #[arg(long, value_name = "SPEED", allow_negative_numbers = true, value_parser = value::gust, help_heading = "Air")]
    pub gust: Option<f64>,

    /// Turbulence: none, light, moderate, severe [default: none]
    #[arg(long, value_name = "LEVEL", value_parser = value::turbulence, help_heading = "Air")]
    pub turbulence: Option<Turbulence>,

    /// Sensor noise, bias and latency: real, none [default: real]
    #[arg(long, value_name = "LEVEL", value_parser = value::noise, help_heading = "Air")]
    pub noise: Option<Noise>,

    /// A rare switch of the simulated world, such as battery_sag=on; repeatable
    #[arg(long, value_name = "NAME=VALUE", value_parser = value::world_switch, long_help = help::world_switches(), help_heading = "Air")]
    pub world: Vec<String>,

    /// The elevation tiles.
    #[command(flatten)]
    pub terrain: TerrainArgs,

    /// Seed of all randomness [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value::seed, help_heading = "Time")]
    pub seed: Option<u64>,

    /// Steps of physics and control a second: 400, 500, 1000, 2000, 4000, 8000 [default: 1000]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, value_parser = value::rate, help_heading = "Time")]
    pub rate: Option<u32>,

    /// Speed as a multiple of real time, or max for as fast as the machine allows [default: 1; fly: max]
    #[arg(long, value_name = "X|max", allow_negative_numbers = true, help_heading = "Time")]
    pub speed: Option<Speed>,
}

impl FlightArgs {
    /// Returns the switches of the world; later ones win.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Switches::set`]. Values from a parsed command line have none.
    pub fn switches(&self) -> Result<Switches, sim::ParseError> {
        let mut switches = Switches::default();
        for text in &self.world {
            switches.set(text)?;
        }
        Ok(switches)
    }

    /// Returns the number of control steps a second.
    pub fn rate_hz(&self) -> u32 {
        self.rate.unwrap_or(1000)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn later_switches_win() {
        let flight = FlightArgs {
            world: vec!["battery_sag=on".to_owned(), "battery_sag=off".to_owned()],
            ..FlightArgs::default()
        };
        assert_eq!(flight.switches(), Ok(Switches::default()));
    }
}
