//! Text for people: suggestions for mistyped words, parts of long lines, and text that is safe on a terminal.

pub mod did_you_mean;
pub mod printable;
pub mod source_snippet;
