//! The turbulence of the air.

/// The level of turbulence after MIL-F-8785C. `Display` gives its name on the command line.
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
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "lowercase")]
pub enum Turbulence {
    /// No turbulence.
    #[default]
    None,
    /// That of a wind of 15 kt at 20 ft.
    Light,
    /// That of a wind of 30 kt at 20 ft.
    Moderate,
    /// That of a wind of 45 kt at 20 ft.
    Severe,
}
