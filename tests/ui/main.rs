//! The user interface: keys in, screen out.

mod altitudes;
mod commands;
mod connect;
mod conversions;
mod editor;
mod first_minutes;
mod fixture;
mod forecast;
mod four_sizes;
mod hands;
mod in_flight;
mod keys;
mod live_settings;
mod map_edit;
mod map_tools;
mod mistyped;
mod orientation;
mod panels;
mod plan_panel;
mod remapped;
mod replay;
mod rewind;
mod screens;
mod session_rig;
mod terrain;
mod uploads;
