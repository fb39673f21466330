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
//! * Every key is a named [`action`]: keymap, hint bar, help, palette and the `:` line are read from one table. What
//!   takes an argument is a [`command`].
//! * `panel` has a file a panel, `popup` what lies over them, `keymap` the keys of the configuration file; `transmitter` is
//!   the RC transmitter in the user's hand, `forecast` what is known of flights flown ahead of
//!   time, `graphs` the history of its signals, `timeline` the row of the recording.
//! * [`run`] is the shell around it: it waits for the terminal, the session and the clock, and carries effects out.
//!
//! Inside: `action` is what keys can do, `keymap` which key means what, `command` what can be typed behind `:`; `editor` holds the open plans;
//! `update` is what messages do, one file a subject; `panel` draws, one file a panel, `popup` what lies over them, which `prompt` asks line by line where there is no screen;
//! `transmitter` moves the virtual sticks, `permission` asks before a real craft is changed, `status_message` says what to do next.
//!
//! May use: ratatui, crossterm, the session's snapshots, events and commands, and plans. Never firmware internals,
//! the simulator or sockets.

pub mod action;
mod app_state;
mod ascii;
pub mod command;
mod completion;
mod console;
mod draw;
mod drawing;
pub mod editor;
mod event_log;
mod files_link;
mod forecast;
mod formatting;
mod fuzzy;
mod graphs;
mod hint_bar;
mod history;
pub mod keymap;
mod knobs;
pub mod layout;
mod log_view;
mod map_edit;
mod map_point;
mod message;
mod notice;
mod panel;
mod panel_bar;
mod permission;
mod popup;
mod prompt;
mod run;
mod status_bar;
pub mod status_message;
mod stick_recording;
mod terminal;
mod text_field;
mod text_wrap;
pub mod theme;
mod timeline;
mod track;
mod transmitter;
mod tutorial;
pub mod units;
mod update;
mod viewport;

pub use app_state::{AppState, UiConfig};
pub use console::CliHelp;
pub use draw::draw;
pub use editor::OpenPlan;
pub use event_log::Severity;
pub use files_link::FilesLink;
pub use history::{EnteredLines, LineField};
pub use message::{Effect, Msg};
pub use panel::Panel;
pub use popup::{CommandLine, Palette, Popup};
pub use run::{Ending, SessionLink, run, run_plain};
pub use terminal::{Tui, restore_terminal_modes};
pub use text_field::TextField;
pub use theme::Theme;
pub use units::Units;
pub use update::update;
pub use viewport::MapMode;
