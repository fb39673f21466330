//! The choice of the physics, and the link to an external simulator.

use std::str::FromStr;

use super::{FlightArgs, help, value};
use crate::link::conventions::{Dialect, Mirror, MotorOrder};
use crate::sim::ScheduledFault;

/// A choice of the physics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum PhysicsChoice {
    /// The world inside this program.
    #[default]
    Embedded,
    /// An external simulator, over UDP.
    External,
}

/// The choice of the physics, and its faults.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct PhysicsArgs {
    /// Physics: embedded, or external: a simulator such as Gazebo over UDP [default: embedded]
    ///
    /// For an external simulator betadeck acts like the SITL executable: the simulator's state comes to UDP 9003,
    /// motors go to 9002 and 9001 (--udp-ports), and its stamps are the time. The options of the embedded world
    /// (--wind, --airframe, --speed …) then have no effect.
    #[arg(long, value_name = "WHERE", hide_possible_values = true, help_heading = "Simulator")]
    pub physics: Option<PhysicsChoice>,

    /// The packets of the simulator.
    #[command(flatten)]
    pub simulator: SimulatorArgs,

    /// Something goes wrong at T, such as motor@10,,2:0.8 or gps-loss@boot+60,6; repeatable
    #[arg(long, value_name = "NAME@T[,FOR][,VALUE]", value_parser = value::fault, long_help = help::faults_with_link(), help_heading = "Faults")]
    pub fault: Vec<ScheduledFault>,
}

/// The packets of an external simulator.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
pub struct SimulatorArgs {
    /// Meaning of the simulator's packets: auto, sitl-gz, gz-plugin or legacy [default: auto]
    #[arg(long, value_name = "DIALECT", help_heading = "Simulator")]
    pub fdm_dialect: Option<FdmDialect>,

    /// Mirrored positions in the simulator's packets: auto, on or off [default: auto]
    #[arg(long, value_name = "auto|on|off", help_heading = "Simulator")]
    pub fdm_mirror: Option<Mirror>,

    /// Order of the motors in the simulator's model: native, or legacy (before spring 2026) [default: native]
    #[arg(long, value_name = "native|legacy", help_heading = "Simulator")]
    pub motor_order: Option<MotorOrder>,
}

impl PhysicsArgs {
    /// Returns `true` if an external simulator moves the craft.
    pub fn is_external(&self) -> bool {
        self.physics == Some(PhysicsChoice::External)
    }

    /// Returns a sentence about options that were given but have no effect with this physics and firmware.
    pub fn idle_options(&self, flight: &FlightArgs, remote_firmware: bool) -> Option<String> {
        let mirror = ("--fdm-mirror", self.simulator.fdm_mirror.is_some());
        let (names, why) = if self.is_external() {
            let given = [
                ("--home", flight.home.is_some()),
                ("--heading", flight.heading.is_some()),
                ("--airframe", flight.airframe.is_some()),
                ("--wind", flight.wind.is_some()),
                ("--gust", flight.gust.is_some()),
                ("--turbulence", flight.turbulence.is_some()),
                ("--noise", flight.noise.is_some()),
                ("--world", !flight.world.is_empty()),
                ("--speed", flight.speed.is_some()),
            ];
            (given.to_vec(), "the external simulator decides that")
        } else if remote_firmware {
            let given = [
                mirror,
                ("--profile", flight.profile.is_some()),
                ("--attitude", flight.attitude.is_some()),
                ("--arm-assist", flight.arm_assist.is_some()),
            ];
            (given.to_vec(), "the remote firmware decides that")
        } else {
            let simulator = &self.simulator;
            let given = [
                ("--fdm-dialect", simulator.fdm_dialect.is_some()),
                mirror,
                ("--motor-order", simulator.motor_order.is_some()),
            ];
            (given.to_vec(), "firmware and physics are embedded (--firmware PATH, --physics external)")
        };
        without_effect(&names, why)
    }
}

/// Returns a sentence about the options of `names` that were given but have no effect.
pub(super) fn without_effect(names: &[(&str, bool)], why: &str) -> Option<String> {
    let given: Vec<&str> = names.iter().filter(|(_, given)| *given).map(|(name, _)| *name).collect();
    let has = if given.len() == 1 { "has" } else { "have" };
    (!given.is_empty()).then(|| format!("{} {has} no effect: {why}.", given.join(", ")))
}

/// A dialect by name, or `auto`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FdmDialect(pub Option<Dialect>);

impl FromStr for FdmDialect {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Ok(Self(None));
        }
        let known = || format!("{text} is not a dialect; use auto, sitl-gz, gz-plugin or legacy");
        text.parse().map(|dialect| Self(Some(dialect))).map_err(|_| known())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{AttitudeChoice, Speed};

    #[test]
    fn options_without_effect_are_named() {
        let flight =
            FlightArgs { wind: "5@270".parse().ok(), speed: Some(Speed(2.0)), ..FlightArgs::default() };
        let embedded = PhysicsArgs::default();
        assert_eq!(embedded.idle_options(&flight, false), None);
        let external = PhysicsArgs { physics: Some(PhysicsChoice::External), ..PhysicsArgs::default() };
        assert_eq!(external.idle_options(&FlightArgs::default(), false), None);
        let sentence = external.idle_options(&flight, false).unwrap();
        assert_eq!(sentence, "--wind, --speed have no effect: the external simulator decides that.");
        let simulator = SimulatorArgs { motor_order: Some(MotorOrder::Legacy), ..SimulatorArgs::default() };
        let ordered = PhysicsArgs { simulator, ..embedded };
        assert_eq!(
            ordered.idle_options(&flight, false).unwrap(),
            "--motor-order has no effect: firmware and physics are embedded (--firmware PATH, --physics external)."
        );
        assert_eq!(ordered.idle_options(&flight, true), None, "it orders the motors of the remote firmware");
        let attitude = FlightArgs { attitude: Some(AttitudeChoice::Truth), ..flight };
        assert_eq!(
            ordered.idle_options(&attitude, true).unwrap(),
            "--attitude has no effect: the remote firmware decides that."
        );
    }
}
