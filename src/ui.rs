//! The terminal: one state, messages in, picture out.
//!
//! ```text
//!   keys, mouse, paste ─┐                          ┌─► Effect ─► run ─► session, terminal
//!   snapshots, events ──┼─► Msg ─► update(AppState)┘
//!   replies, signals ───┘                │
//!                                  draw(&AppState) ─► Frame
//! ```
//!
//! * [`update`] is the only thing that changes [`AppState`]; it sees no clock (time comes as [`Msg::Clock`]), no
//!   terminal and no channel, and answers with [`Effect`]s, which are data.
//! * [`draw`] only reads. What depends on the size of the screen is computed by [`layout`], which both use.
//! * Every key is a named [`action`]: keymap, hint bar and help are read from one table.
//! * [`run`] is the shell around it: it waits for the terminal, the session and the clock, and carries effects out.
//!
//! May use: ratatui, crossterm, the session's snapshots, events and commands, and plans. Never firmware internals,
//! the simulator or sockets.

pub mod action;
pub mod advice;
mod ascii;
mod cli;
mod draw;
mod hands;
pub mod keymap;
pub mod layout;
mod log;
mod map;
mod message;
mod panel;
pub mod picture;
mod quantity;
mod run;
mod state;
mod status;
mod terminal;
pub mod theme;
mod track;
mod update;

pub use cli::CliHelp;
pub use draw::draw;
pub use log::Level;
pub use map::MapMode;
pub use message::{Effect, Msg};
pub use run::{Ending, SessionLink, run};
pub use state::{AppState, Layer, OpenPlan, Pane, UiConfig};
pub use terminal::Tui;
pub use theme::Theme;
pub use update::update;
