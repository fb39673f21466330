//! How the user interface shows things.

use clap::ValueEnum;

/// Colours, characters and units.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct DisplayArgs {
    /// Colours: dark, light, high-contrast, 16, mono; NO_COLOR wins [default: what the terminal can show]
    #[arg(long, value_name = "NAME", hide_possible_values = true, help_heading = "Screen")]
    pub theme: Option<ThemeChoice>,

    /// Characters: auto, unicode, ascii [default: auto]
    #[arg(long, value_name = "SET", hide_possible_values = true, help_heading = "Screen")]
    pub charset: Option<CharsetChoice>,

    /// Units of what is shown, not of what is stored: metric, imperial [default: metric]
    #[arg(long, value_name = "UNITS", hide_possible_values = true, help_heading = "Screen")]
    pub units: Option<UnitsChoice>,
}

/// Colours by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ThemeChoice {
    /// For a dark background.
    Dark,
    /// For a light background.
    Light,
    /// Far from each other and from a dark background.
    HighContrast,
    /// The terminal's own sixteen.
    #[value(name = "16")]
    Sixteen,
    /// None.
    Mono,
}

/// Characters that the terminal shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CharsetChoice {
    /// As the environment says.
    Auto,
    /// Box drawing, arrows, Braille.
    Unicode,
    /// Seven bits.
    Ascii,
}

/// Units of lengths and speeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum UnitsChoice {
    /// Metres and metres a second.
    Metric,
    /// Feet and miles an hour.
    Imperial,
}
