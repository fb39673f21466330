//! The terminal: one state, messages in, picture out.
//!
//! ```text
//!   keys, mouse, paste ─┐                          ┌─► Effect ─► run ─► session, terminal
//!   snapshots, events ──┼─► Msg ─► update(AppState)┘
//!   replies, signals ───┘                │
//!                                  draw(&AppState) ─► Frame
//! ```
//!
//! * `update` alone changes [`AppState`]. It has no access to a clock (time comes as [`Msg::Clock`]), the terminal or
//!   a channel, and returns [`Effect`]s, which are data.
//! * [`Shared`] is the part of the state that every panel, popup and sentence may read: the picture of the session, the
//!   editor, theme, units, keys, size and time. The state of a single panel and the popups are beside it in
//!   [`AppState`], which only `update`, `draw` and `prompt` know.
//! * `draw` only reads. [`layout`] computes everything that depends on the screen size; both use it.
//! * A panel reads [`Shared`] and its own state, and returns requests. `update` alone carries them out.
//! * Every key is a named [`action`]: keymap, hint bar, help, palette and the `:` line are read from one table. A
//!   [`command`] takes an argument and returns requests, which `update` carries out.
//! * `panel` has one file per panel, `popup` the windows over them, `keymap` the keys of the configuration file.
//!   `transmitter` is the user's virtual RC transmitter, `stick_recording` records its sticks, `forecast` holds the
//!   results of flights flown ahead of time, `survey` those of many flights of the plan, `diff` puts two versions of a plan
//!   or of the settings beside each other, `settings` holds those of the craft, `graphs` the history of the graphs' signals,
//!   `ground` the elevation tiles, `flights` is the library of recorded flights, `past_flight` shows a recorded flight at
//!   once, `other_flight` a second one beside it,
//!   `map_point` the places on the map, `viewport` its window, `map_edit` the edits on it, `backdrop` the files under it,
//!   and `timeline` the timeline of the recording.
//! * `run` is the shell around it: it waits for the terminal, the session and the clock, and carries out the effects.
//!
//! `editor` holds the open plans. `update` handles messages, one file per subject. `prompt` asks the questions of the
//! popups line by line in `--plain` mode, which has no screen. `status_bar` draws the two lines at the top and says them in
//! words. `permission` asks before a real craft is changed, and
//! `status_message` suggests the next step.
//!
//! At most five files import each other, not counting parent and child; `tests/house/rooms` measures it.
//!
//! May use: ratatui, crossterm, the session's snapshots, events and commands, and plans. Never firmware internals,
//! the simulator or sockets.

pub mod action;
mod app_state;
mod arming_hint;
mod ascii;
mod axis;
pub mod backdrop;
pub mod command;
mod completion;
mod config;
mod console;
mod curve;
mod diff;
mod draw;
mod drawing;
pub mod editor;
mod event_log;
mod files_link;
pub mod flights;
mod forecast;
mod formatting;
mod fuzzy;
mod graphs;
mod ground;
mod hint_bar;
mod history;
mod kept_screen;
pub mod keymap;
mod knobs;
pub mod layout;
mod log_view;
mod map_edit;
mod map_point;
mod map_state;
mod message;
mod named_signal;
mod notice;
mod other_flight;
mod panel;
mod panel_bar;
mod past_flight;
mod permission;
mod popup;
mod prompt;
mod raster;
mod run;
mod search;
pub mod settings;
mod shared;
mod status_bar;
pub mod status_message;
mod stick_recording;
mod survey;
mod terminal;
mod text_field;
mod text_wrap;
pub mod theme;
mod timeline;
mod track;
mod transitions;
mod transmitter;
mod tutorial;
pub mod units;
mod update;
mod viewport;
mod world_history;

pub use app_state::AppState;
pub use config::{GroundConfig, UiConfig};
pub use console::CliHelp;
pub use draw::draw;
pub use editor::OpenPlan;
pub use event_log::Severity;
pub use files_link::FilesLink;
pub use history::{EnteredLines, LineField};
pub use kept_screen::{KeptOf, KeptPlace, KeptScreen, KeptScreens, KeptTexts, Unread};
pub use layout::SavedLayouts;
pub use map_state::MapMode;
pub use message::{Effect, FlightForm, Msg};
pub use panel::{Panel, Panels};
pub use popup::{CommandLine, FlightsList, Palette, Popup, SignalList};
pub use run::{Ending, OtherReceiver, SessionLink, run, run_plain};
pub use shared::{Notice, Shared};
pub use terminal::{Tui, restore_terminal_modes};
pub use text_field::TextField;
pub use theme::Theme;
pub use units::Units;
pub use update::{run_line, update};
