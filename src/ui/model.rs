//! The state of the screen, as plain data: no file here knows the whole of it.

pub mod action;
pub mod backdrop;
pub(in crate::ui) mod config;
pub(in crate::ui) mod console;
pub mod editor;
pub(in crate::ui) mod effect;
pub(in crate::ui) mod event_log;
pub mod files;
pub mod flights;
pub(in crate::ui) mod forecast;
pub(in crate::ui) mod graphs;
pub(in crate::ui) mod ground;
pub(in crate::ui) mod history;
pub(in crate::ui) mod kept_screen;
pub mod keymap;
pub(in crate::ui) mod layout;
pub(in crate::ui) mod map_point;
pub(in crate::ui) mod map_state;
pub(in crate::ui) mod message;
pub(in crate::ui) mod other_flight;
pub(in crate::ui) mod panel_table;
pub(in crate::ui) mod plan_id;
pub mod settings;
pub(in crate::ui) mod stick_recording;
pub(in crate::ui) mod survey;
pub(in crate::ui) mod track;
pub(in crate::ui) mod world_history;
