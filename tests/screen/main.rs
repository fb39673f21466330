//! The user interface on a terminal in memory: keys in, screen out.

mod ui;
mod vehicle_seams;
