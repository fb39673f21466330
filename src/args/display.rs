//! The display options of the user interface.

use clap::ValueEnum;

/// Colours, characters and units.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct DisplayArgs {
    /// Colours: dark, light, high-contrast, 16, mono; NO_COLOR wins [default: the terminal's capabilities]
    #[arg(long, value_name = "NAME", hide_possible_values = true, help_heading = "Screen")]
    pub theme: Option<ThemeChoice>,

    /// Characters: auto, unicode, ascii [default: auto]
    #[arg(long, value_name = "SET", hide_possible_values = true, help_heading = "Screen")]
    pub charset: Option<CharsetChoice>,

    /// Units on the screen, not in files: metric, imperial [default: metric]
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
    /// The terminal's own sixteen colours.
    #[value(name = "16")]
    Sixteen,
    /// No colours.
    Mono,
}

/// Characters that the terminal shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CharsetChoice {
    /// The choice of the environment.
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
