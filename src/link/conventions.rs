//! The conventions of an external simulator. Options choose them and the link to it (FDM, flight dynamics
//! model) implements them.

/// The meaning of the numbers in a simulator's state datagram.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::EnumString, strum::IntoStaticStr,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Dialect {
    /// The dialect that a current SITL executable decodes correctly: rates (ωx, −ωy, +ωz), negated specific
    /// force on FLU axes, quaternion (z, y, x, w) of FLU → ENU, position mirrored about the first one.
    SitlGz,
    /// The dialect of the public Gazebo plugin: rates and acceleration FRD, gravity not in the acceleration,
    /// quaternion (w, x, −y, −z) of FLU → ENU, position mirrored about the world's origin.
    GzPlugin,
    /// The dialect of builds without the Gazebo bridge (X-Plane, RealFlight): rates FRD, negated specific
    /// force on FLU axes, quaternion of FLU → north-west-up, true position, pressure.
    Legacy,
}

/// The handling of positions that may be mirrored about the first one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum Mirror {
    /// Follows the dialect until the motion shows otherwise.
    #[default]
    Auto,
    On,
    Off,
}

/// The order in which a simulator's model expects the motors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum MotorOrder {
    /// M1, M2, M3, M4, as current models expect.
    #[default]
    Native,
    /// M2, M3, M4, M1, as models from before spring 2026 expect.
    Legacy,
}

/// The clock of a SITL executable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum FirmwareClock {
    /// Simulated time, step by step with the craft.
    Sim,
    /// The wall clock.
    Real,
}

/// The kind of stamps in the packets to a SITL executable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum Stamps {
    /// The same stamp in every packet, so that the executable's clock is the wall clock.
    #[default]
    Constant,
    /// Simulated time, for an executable that is patched to follow it.
    Sim,
}
