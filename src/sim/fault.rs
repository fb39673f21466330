//! Faults, with their times and durations.
//!
//! `NAME@T[,FOR][,VALUE]`: T and FOR in simulated seconds, T from engagement or, as `boot+T`, from boot. Without FOR
//! the fault lasts to the end. The name ends at the first `@`; VALUE may contain more of them, and commas.

use std::fmt;

use nalgebra::Vector3;

use super::airframe::ROTORS;
use super::switches::Switches;
use crate::sim::error::WorldError;
use crate::sim::wind::Wind;
use crate::telemetry::{FaultKind, FaultValue};

mod effects;
mod parse;
mod schedule;

pub(super) use effects::Effects;
pub(super) use effects::GpsFaults;
pub use effects::LinkFaults;
pub(super) use parse::MAX_TIME_S;
pub use parse::{FAULTS, FaultInfo};
pub(in crate::sim) use schedule::ActiveFault;
pub use schedule::MAX_FAULTS;
pub(super) use schedule::{FaultChange, FaultSchedule};

/// A motor by its number, 1…4.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MotorNumber(u8);

impl MotorNumber {
    /// Returns the motor with this number, or `None` unless it is 1…4.
    pub fn new(number: u8) -> Option<Self> {
        (1..=ROTORS as u8).contains(&number).then_some(Self(number))
    }

    /// Returns the index in arrays of motors, 0…3.
    pub fn index(self) -> usize {
        usize::from(self.0 - 1)
    }
}

impl fmt::Display for MotorNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

/// The six directions of a push.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    strum::Display,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantNames,
    strum::EnumIter,
)]
#[strum(serialize_all = "lowercase")]
pub enum Direction {
    /// To the north.
    North,
    /// To the east.
    East,
    /// To the south.
    South,
    /// To the west.
    West,
    /// Upwards.
    Up,
    /// Downwards.
    Down,
}

impl Direction {
    /// Returns the unit vector, ENU.
    pub fn enu(self) -> Vector3<f64> {
        match self {
            Self::North => Vector3::y(),
            Self::East => Vector3::x(),
            Self::South => -Vector3::y(),
            Self::West => -Vector3::x(),
            Self::Up => Vector3::z(),
            Self::Down => -Vector3::z(),
        }
    }
}

/// The effect of a battery fault.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BatteryFault {
    /// Changes the open-circuit voltage by this much, V.
    Offset(f64),
    /// One cell fails short.
    CellOut,
}

/// Defines the faults with their values. Each is of the kind of the same name.
macro_rules! faults {
    ($($(#[$doc:meta])* $variant:ident $(($($value:ty),+))?;)*) => {
        /// One fault with its value. `Display` shows the value as it is written on the command line.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum Fault {
            $($(#[$doc])* $variant $(($($value),+))?,)*
        }

        impl Fault {
            /// Returns the kind of the fault.
            pub fn kind(&self) -> FaultKind {
                match self {
                    $(Self::$variant { .. } => FaultKind::$variant,)*
                }
            }
        }
    };
}

faults! {
    /// No RC frame arrives.
    RxLoss;
    /// This fraction of RC frames is lost at random.
    RxJitter(f64);
    /// No solution and no satellites.
    GpsLoss;
    /// The position is shifted by metres along a bearing (degrees from north). The velocity stays true.
    GpsGlitch(f64, f64);
    /// The same solution is repeated.
    GpsFreeze;
    /// Solutions arrive later by this many seconds, and state their usual age.
    GpsDelay(f64);
    /// All GPS errors are multiplied by this factor.
    GpsNoise(f64);
    /// The pressure drifts by this many Pa/s.
    BaroDrift(f64);
    /// One sample per second is off by this many Pa.
    BaroSpike(f64);
    /// The same pressure is repeated.
    BaroFreeze;
    /// The magnetometer gives no data.
    MagOff;
    /// The measured heading is off by this many degrees, clockwise positive.
    MagBias(f64);
    /// Step on the gyro's x axis, °/s.
    GyroBias(f64);
    /// Step on the accelerometer's x axis, m/s².
    AccBias(f64);
    /// The last inertial sample is repeated.
    ImuFreeze;
    /// Thrust and torque of a motor are multiplied by an efficiency, 0…1.
    Motor(MotorNumber, f64);
    /// A motor's command is frozen, 0…1.
    MotorStuck(MotorNumber, f64);
    /// An unbalanced propeller: rotating acceleration of this size at hover speed, m/s².
    PropImbalance(MotorNumber, f64);
    /// Accelerometer vibration at hover speed, m/s² rms per axis.
    Vibration(f64);
    /// The battery is weak.
    Battery(BatteryFault);
    /// One gust. It lasts four seconds unless a time is given.
    Gust(Wind);
    /// Another mean wind.
    Wind(Wind);
    /// An impulse, N·s.
    Push(f64, Direction);
    /// Moves the craft by metres north, east, up; the velocity stays.
    Teleport([f64; 3]);
    /// Hangs a weight below the craft, kg.
    Payload(f64);
    /// External link: the simulator stops sending.
    Stall;
    /// External link: this fraction of packets is lost.
    FdmLoss(f64);
    /// External link: packets are late by this many ms.
    FdmLate(f64);
    /// External link: this fraction of packets comes twice.
    FdmDup(f64);
    /// External link: packets are late by up to this many ms at random.
    FdmJitter(f64);
}

/// The longest delay of GPS solutions, s.
pub(in crate::sim) const MAX_GPS_DELAY_S: f64 = 2.0;

impl Fault {
    /// Returns the name on the command line.
    pub fn name(&self) -> &'static str {
        self.kind().into()
    }

    /// Returns the value for display.
    pub fn value(&self) -> FaultValue {
        match *self {
            Self::RxLoss
            | Self::GpsLoss
            | Self::GpsFreeze
            | Self::BaroFreeze
            | Self::MagOff
            | Self::ImuFreeze
            | Self::Stall => FaultValue::None,
            Self::RxJitter(value)
            | Self::GpsDelay(value)
            | Self::GpsNoise(value)
            | Self::BaroDrift(value)
            | Self::BaroSpike(value)
            | Self::MagBias(value)
            | Self::GyroBias(value)
            | Self::AccBias(value)
            | Self::Vibration(value)
            | Self::Payload(value)
            | Self::FdmLoss(value)
            | Self::FdmLate(value)
            | Self::FdmDup(value)
            | Self::FdmJitter(value)
            | Self::Battery(BatteryFault::Offset(value)) => FaultValue::Number(value),
            Self::Battery(BatteryFault::CellOut) => FaultValue::CellOut,
            Self::GpsGlitch(size, deg) => FaultValue::Bearing { size, deg },
            Self::Motor(motor, value)
            | Self::MotorStuck(motor, value)
            | Self::PropImbalance(motor, value) => FaultValue::Motor { motor: motor.0, value },
            Self::Gust(wind) | Self::Wind(wind) => {
                FaultValue::Bearing { size: wind.speed_mps, deg: wind.from_deg }
            }
            Self::Push(impulse, direction) => FaultValue::Push { impulse, direction: direction.into() },
            Self::Teleport(offset) => FaultValue::Offset(offset),
        }
    }

    /// Returns `true` if the fault acts at once and has no end.
    pub fn is_instant(&self) -> bool {
        matches!(self, Self::Push(..) | Self::Teleport(_))
    }

    /// Returns `true` if the fault acts on the link to an external simulator.
    pub fn needs_link(&self) -> bool {
        matches!(
            self,
            Self::Stall | Self::FdmLoss(_) | Self::FdmLate(_) | Self::FdmDup(_) | Self::FdmJitter(_)
        )
    }

    /// Returns `true` if the fault can act while an external simulator moves the craft. Such a fault acts on the way
    /// into the firmware.
    pub fn is_on_the_way_in(&self) -> bool {
        self.needs_link() || matches!(self, Self::RxLoss | Self::GpsLoss)
    }

    /// Returns `true` if the fault has an effect on a remote flight controller. That controller gets motion,
    /// position, pressure and RC, but neither the magnetic field nor the battery. The battery can act only by weak
    /// motors.
    pub fn acts_on_remote_controller(&self, switches: &Switches) -> bool {
        match self {
            Self::MagOff | Self::MagBias(_) => false,
            Self::Battery(_) => switches.battery_sag,
            _ => true,
        }
    }

    /// Returns the key that distinguishes faults that can be active together. A later fault replaces an earlier one
    /// with the same key.
    pub fn key(&self) -> FaultKey {
        FaultKey { kind: self.kind(), motor: self.motor() }
    }

    fn motor(&self) -> Option<MotorNumber> {
        match *self {
            Self::Motor(motor, _) | Self::MotorStuck(motor, _) | Self::PropImbalance(motor, _) => Some(motor),
            _ => None,
        }
    }
}

/// A kind of fault, for motor faults optionally of one motor only.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultKey {
    kind: FaultKind,
    motor: Option<MotorNumber>,
}

impl FaultKey {
    /// Returns `true` if a fault is of this kind. A key without a motor covers the faults of all motors.
    pub fn covers(&self, fault: &Fault) -> bool {
        self.kind == fault.kind() && (self.motor.is_none() || self.motor == fault.motor())
    }
}

impl fmt::Display for FaultKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.kind)?;
        self.motor.map_or(Ok(()), |motor| write!(f, ":{motor}"))
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value().fmt(f)
    }
}

/// The beginning of a fault.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FaultStart {
    /// Seconds after the first engagement of the autopilot since boot or reset.
    Engagement(f64),
    /// This many seconds after boot.
    Boot(f64),
}

/// A fault with its time. `Display` gives the text that parses back to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScheduledFault {
    /// The fault.
    pub fault: Fault,
    /// Its begin.
    pub start: FaultStart,
    /// Duration in seconds; `None` lasts to the end.
    pub for_s: Option<f64>,
}

impl fmt::Display for ScheduledFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@", self.fault.name())?;
        match self.start {
            FaultStart::Engagement(t) => write!(f, "{t}")?,
            FaultStart::Boot(t) => write!(f, "boot+{t}")?,
        }
        if let Some(for_s) = self.for_s {
            write!(f, ",{for_s}")?;
        }
        let value = self.fault.to_string();
        match (value.is_empty(), self.for_s) {
            (true, _) => Ok(()),
            (false, Some(_)) => write!(f, ",{value}"),
            (false, None) => write!(f, ",,{value}"),
        }
    }
}

/// The link to an external simulator that moves the craft, if there is one for faults to act on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FaultLink {
    /// Everything is embedded, so link faults are refused.
    Embedded,
    /// An external simulator moves the craft. Only faults on the way into the firmware are allowed; the rest of the
    /// world belongs to the simulator.
    External,
}

impl FaultLink {
    /// Checks that a fault has something to act on.
    pub(super) fn allows(self, fault: &Fault) -> Result<(), WorldError> {
        match self {
            Self::Embedded if fault.needs_link() => Err(WorldError::NeedsLink(fault.kind())),
            Self::External if !fault.is_on_the_way_in() => Err(WorldError::OutsideFault(fault.kind())),
            Self::Embedded | Self::External => Ok(()),
        }
    }
}
