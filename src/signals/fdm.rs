//! How an external simulator speaks: what options choose and the link to it (FDM, flight dynamics model) carries out.

/// What the numbers of a simulator's state datagram mean.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::EnumString, strum::IntoStaticStr,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Dialect {
    /// What a current SITL executable decodes right: rates (ωx, −ωy, +ωz), negated specific force on FLU axes,
    /// quaternion (z, y, x, w) of FLU → ENU, position mirrored about the first one.
    SitlGz,
    /// What the public Gazebo plugin sends: rates and acceleration FRD, gravity not in the acceleration, quaternion
    /// (w, x, −y, −z) of FLU → ENU, position mirrored about the world's origin.
    GzPlugin,
    /// Builds without the Gazebo bridge (X-Plane, RealFlight): rates FRD, negated specific force on FLU axes,
    /// quaternion of FLU → north-west-up, true position, pressure.
    Legacy,
}

/// Whether a simulator's positions are mirrored about the first one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum Mirror {
    /// As the dialect does, until the motion shows otherwise.
    #[default]
    Auto,
    On,
    Off,
}

/// In which order a simulator's model expects the motors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum MotorOrder {
    /// M1, M2, M3, M4, as current models expect.
    #[default]
    Native,
    /// M2, M3, M4, M1, as models from before spring 2026 expect.
    Legacy,
}

/// What the stamps are of the packets that feed a SITL executable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum Stamps {
    /// The same in every packet, so that the executable's clock is the wall clock.
    #[default]
    Constant,
    /// Simulated time, for an executable that is patched to follow it.
    Sim,
}
