//! The files that the screen reads and writes: plans with their journals, maps, layouts, entered lines, and the kept screen.

pub(crate) mod backdrop_file;
pub mod entered_lines;
pub(crate) mod layout_file;
pub(crate) mod line_history;
pub(crate) mod plan_files;
pub(crate) mod screen_file;
