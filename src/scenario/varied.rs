//! The inputs that differ from flight to flight of a campaign, and their effect on a flight.

use super::air::{WindProblem, WindText};
use super::case::{Air, Case, OWN_LINES};
use crate::design::{Distribution, WindTable};
use crate::flight::setup::BootLines;
use crate::sim::{Airframe, Fault, FaultStart, Noise, ScheduledFault, Switches, Wind};
use crate::telemetry::Turbulence;

/// An input that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct VariedInput {
    /// The name in results and the key of its random numbers, such as `mass_pct` or `ap_max_velocity`.
    pub name: String,
    /// Its values.
    pub spread: Spread,
}

/// The values of an input.
#[derive(Debug, Clone, PartialEq)]
pub enum Spread {
    /// One of these, all as often.
    Choice(Vec<Choice>),
    /// A number with a distribution.
    Number(NumberInput, Distribution),
    /// A wind with a speed and a direction.
    Wind {
        /// Speed, m/s.
        speed: Distribution,
        /// The direction from which it blows, degrees clockwise from north.
        from: Distribution,
    },
    /// A wind of a table.
    Table(WindTable),
}

/// One of several values.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The value for people.
    pub shown: String,
    /// The change of the flight.
    pub change: Change,
}

/// An input whose value is a number.
#[derive(Debug, Clone, PartialEq)]
pub enum NumberInput {
    /// Size of random gusts, m/s.
    Gust,
    /// Altitude of the pilot's climb, m.
    Takeoff,
    /// Heading at boot, degrees.
    Heading,
    /// A property of the airframe, per cent of its nominal value.
    Tolerance(Tolerance),
    /// A switch of the world.
    World(String),
    /// A setting of the firmware, whole numbers.
    Setting(String),
    /// The time of a fault, s after the engagement.
    FaultTime(Fault, Option<f64>),
}

/// A property of the airframe that differs from its nominal value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumIter)]
pub enum Tolerance {
    /// The mass.
    Mass,
    /// The thrust of the motors.
    Thrust,
    /// The drag.
    Drag,
    /// The moments of inertia.
    Inertia,
    /// The capacity of the battery.
    Battery,
}

/// A value of an input in one flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Change {
    /// Another airframe.
    Airframe(Box<Airframe>),
    /// A difference of the airframe, per cent.
    Tolerance(Tolerance, f64),
    /// A wind as text, which may contain the seed.
    Wind(WindText),
    /// A wind.
    WindIs(Wind),
    /// m/s.
    Gust(f64),
    /// Level of turbulence.
    Turbulence(Turbulence),
    /// Sensor errors on or off.
    Noise(Noise),
    /// A switch of the world, as `NAME=VALUE`.
    World(String),
    /// m.
    Takeoff(f64),
    /// Degrees.
    Heading(f64),
    /// Hz.
    Rate(u32),
    /// `name = value`.
    Setting(String),
    /// A fault.
    Fault(ScheduledFault),
}

impl Tolerance {
    /// Returns the key in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Mass => "mass_pct",
            Self::Thrust => "thrust_pct",
            Self::Drag => "drag_pct",
            Self::Inertia => "inertia_pct",
            Self::Battery => "battery_pct",
        }
    }

    /// Changes the airframe by so many per cent.
    pub(super) fn apply(self, percent: f64, airframe: &mut Airframe, switches: &mut Switches) {
        let factor = 1.0 + percent / 100.0;
        match self {
            Self::Mass => airframe.mass_kg *= factor,
            Self::Thrust => airframe.thrust_coeff *= factor,
            Self::Drag => {
                airframe.body_drag *= factor;
                airframe.rotor_drag_coeff *= factor;
            }
            Self::Inertia => airframe.inertia_kgm2 *= factor,
            Self::Battery => {
                airframe.battery.capacity_ah *= factor;
                if let Some(capacity) = &mut switches.battery_capacity_ah {
                    *capacity *= factor;
                }
            }
        }
    }
}

impl NumberInput {
    /// Returns the change for a drawn value.
    pub fn change(&self, value: f64) -> Change {
        match self {
            Self::Gust => Change::Gust(value),
            Self::Takeoff => Change::Takeoff(value),
            Self::Heading => Change::Heading(value),
            Self::Tolerance(of) => Change::Tolerance(*of, value),
            Self::World(name) => Change::World(format!("{name}={value}")),
            Self::Setting(name) => Change::Setting(format!("{name} = {value}")),
            Self::FaultTime(fault, for_s) => Change::Fault(ScheduledFault {
                fault: *fault,
                start: FaultStart::Engagement(value),
                for_s: *for_s,
            }),
        }
    }

    /// Returns `true` if only whole numbers are values.
    pub fn is_whole(&self) -> bool {
        matches!(self, Self::Setting(_))
    }
}

impl Change {
    /// Returns the order of the changes of a flight: the airframe comes before the differences from it.
    pub fn phase(&self) -> u8 {
        match self {
            Self::Airframe(_) => 0,
            Self::World(_) => 1,
            _ => 2,
        }
    }

    /// Changes the case and the air of a flight. The air has its seed.
    ///
    /// # Errors
    /// Returns a sentence if the value does not fit this flight.
    pub fn apply(&self, case: &mut Case, air: &mut Air) -> Result<(), String> {
        let world = &mut case.setup.world;
        match self {
            Self::Airframe(airframe) => world.airframe.clone_from(airframe),
            Self::Tolerance(of, percent) => of.apply(*percent, &mut world.airframe, &mut world.switches),
            Self::Wind(text) => {
                air.wind = text.of_seed(air.seed).map_err(|WindProblem { message, .. }| message)?;
            }
            Self::WindIs(wind) => air.wind = *wind,
            Self::Gust(gust_mps) => air.gust_mps = *gust_mps,
            Self::Turbulence(turbulence) => air.turbulence = *turbulence,
            Self::Noise(noise) => air.noise = *noise,
            Self::World(text) => {
                world.switches.set(text).map_err(|error| error.problem().to_owned())?;
            }
            Self::Takeoff(takeoff_m) => case.options.takeoff_m = *takeoff_m,
            Self::Heading(heading_deg) => world.home.heading_deg = *heading_deg,
            Self::Rate(rate_hz) => world.rate_hz = *rate_hz,
            Self::Setting(setting) => set(&mut case.setup.boot_lines, setting),
            Self::Fault(fault) => world.faults.push(*fault),
        }
        Ok(())
    }
}

/// Adds a setting to those of the scenario itself.
fn set(boot_lines: &mut Vec<BootLines>, setting: &str) {
    let line = format!("set {setting}\n");
    match boot_lines.iter_mut().find(|lines| lines.source == OWN_LINES[0]) {
        Some(own) => own.text.push_str(&line),
        None => boot_lines.push(BootLines { source: OWN_LINES[0].to_owned(), text: line }),
    }
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator as _;

    use super::*;

    #[test]
    fn every_built_in_craft_takes_every_tolerance_of_twenty_per_cent() {
        for name in crate::sim::BUILTIN_NAMES {
            for (of, percent) in Tolerance::iter().flat_map(|of| [(of, -20.0), (of, 20.0)]) {
                let airframe = name.parse().unwrap();
                let mut world = crate::sim::WorldConfig { airframe, ..Default::default() };
                of.apply(percent, &mut world.airframe, &mut world.switches);
                for rate_hz in [400, 500, 1000, 8000] {
                    world.rate_hz = rate_hz;
                    assert_eq!(world.check(), Ok(()), "{name} {} {percent} {rate_hz}", of.key());
                }
            }
        }
    }
}
