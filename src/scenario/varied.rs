//! The inputs that differ from flight to flight of a campaign, and their effect on a flight.

use super::air::WindText;
use crate::design::{Distribution, WindTable};
use crate::sim::{Airframe, Fault, FaultStart, Noise, ScheduledFault, Wind};
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
}
