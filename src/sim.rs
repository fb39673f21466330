//! The plant: one quadcopter, the air, the ground, the sensors and their faults.
//!
//! The plant depends only on its configuration, a seed and the motor commands: no I/O, no clock, no threads. Each
//! call of [`World::step`] takes the motor commands of the present instant and computes the next one:
//!
//! ```text
//!  MotorCommand ─► motors ─► forces and torques ─► motion ─► ground ─► sensors ─► SensorFrame
//!     0…1           Ω, lag     rotors, drag,        p v q ω      contact,   noise, rate,
//!                              wind, battery                     events     latency, faults
//! ```
//!
//! | part | interval |
//! | --- | --- |
//! | rotors, body, ground, inertial sensors | every step (125 µs … 2.5 ms) |
//! | air (mean wind, gusts, turbulence, density), battery, magnetometer | 10 ms |
//! | barometer, battery readings | 20 ms |
//! | GPS | 100 ms (1 to 20 Hz) |
//!
//! World axes are ENU (x east, y north, z up) with the origin on the ground at home; body axes are FLU (x forward, y
//! left, z up); attitudes turn body into world. [`Truth`] and [`SensorFrame`](crate::signals::SensorFrame) are
//! different types, so that true and measured values cannot be mixed up. `docs/physics.md` has the equations.

mod air;
mod airframe;
mod atmosphere;
mod battery;
mod body;
mod clock;
mod command;
mod config;
mod endurance;
mod error;
mod event;
mod fault;
mod gps_grade;
mod ground;
mod landform;
mod motors;
mod plant;
mod random;
mod sensors;
mod surface;
mod switches;
mod touchdown;
mod truth;
mod value_text;
mod wind;
mod world;

pub use air::{AIR_TICK_US, DrydenScales, one_minus_cosine};
pub use airframe::{
    Airframe, AirframeFileError, AirframeProblem, BUILTIN_NAMES, MAX_LEGS, REFERENCE_DENSITY, ROTORS,
    UnknownAirframe,
};
pub use atmosphere::{density, density_ratio, pressure_pa, temperature_k};
pub use battery::{BatterySpec, motor_power_w};
pub use body::{AirSample, BodyState, Loads, lever_arm_acceleration};
pub use clock::Clock;
pub use command::{COMMAND_WORDS, CommandWord, WorldCommand};
pub use config::{Home, Noise, STEP_RATES_HZ, WorldConfig, step_us};
pub use error::WorldError;
pub use event::{WorldEvent, WorldEventKind};
pub use fault::{
    BatteryFault, Direction, FAULTS, Fault, FaultInfo, FaultKey, FaultStart, LinkFaults, MAX_FAULTS,
    MotorNumber, ScheduledFault,
};
pub use gps_grade::GpsGrade;
pub use ground::{Ground, GroundContact};
pub use plant::{Craft, Plant, Present, ground_effect_factor};
pub use random::{Stream, StreamRng};
pub use sensors::magnetic_field_enu;
pub use surface::{Slope, Surface, TangentPlane};
pub use switches::{AirDensity, SITL_DECLINATION_DEG, SWITCHES, SwitchInfo, Switches, WindProfile};
pub use truth::{BatteryTruth, Truth, attitude, level_attitude};
pub use value_text::ParseError;
pub use wind::Wind;
pub use world::{World, WorldStatus};
