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
//! * `draw` only reads. [`acts::screen_layout`] computes everything that depends on the screen size; both use it.
//! * A panel reads [`Shared`] and its own state, and returns requests. `update` alone carries them out.
//! * Every key is a named [`action`]: keymap, hint bar, help, palette and the `:` line are read from one table. A
//!   [`command`] takes an argument and returns requests, which `update` carries out.
//!
//! The modules, from the ground up. None uses one further down, but that a popup draws a map as its panel does:
//!
//! 1. Drawing without the state: `drawing`, `area`, `curve`, `raster`, `axis`, `theme`, `units`, `formatting`,
//!    `text_field`, `text_wrap` and the like.
//! 2. `model`: the state in parts, as plain data. `model::message` are the inputs and requests, `model::effect` the
//!    requests to the shell, `model::panel_table` the panels, [`action`] the actions of keys.
//! 3. `shared`: the part of the state that all panels see, put together from the model.
//! 4. `acts`: functions over it: what keys, clock and session do to it, and what is derived from it, such as findings
//!    about the plan, the next step, the window of the map and the layout of the screen.
//! 5. `panel` has one file per panel, `popup` the windows over them. Both use `command`, `knobs`, `log_view`, `notice` and
//!    `transitions`.
//! 6. `app_state`, `update` and `draw`: the whole state, its changes, its drawing. Around the panels are `status_bar`,
//!    `panel_bar`, `hint_bar`, `timeline` and `survey_strip`. `permission` asks before a real craft is changed.
//!    `prompt` asks the questions of the popups line by line in `--plain` mode, which has no screen.
//! 7. `run` and `terminal` are the shell around it: they wait for the terminal, the session and the clock, and carry out
//!    the effects.
//!
//! `tests/house/rooms` checks that at most two modules use each other.
//!
//! May use: ratatui, crossterm, the session's snapshots, events and commands, and plans. Never firmware internals,
//! the simulator or sockets.

mod acts;
mod app_state;
mod area;
mod ascii;
mod axis;
pub mod command;
mod completion;
mod curve;
mod draw;
mod drawing;
mod files_link;
mod formatting;
mod fuzzy;
mod hint_bar;
mod knobs;
mod log_view;
mod model;
mod notice;
mod panel;
mod panel_bar;
mod permission;
mod popup;
mod prompt;
mod raster;
mod run;
mod search;
mod shared;
mod status_bar;
mod survey_strip;
mod terminal;
mod text_field;
mod text_wrap;
pub mod theme;
mod timeline;
mod transitions;
mod tutorial;
pub mod units;
mod update;

pub use acts::availability::enabled;
pub use acts::{screen_layout, status_message};
pub use app_state::AppState;
pub use draw::draw;
pub use files_link::FilesLink;
pub use model::config::{GroundConfig, UiConfig};
pub use model::console::CliHelp;
pub use model::editor::OpenPlan;
pub use model::effect::{Effect, FlightForm};
pub use model::event_log::Severity;
pub use model::history::{EnteredLines, LineField};
pub use model::kept_screen::{KeptOf, KeptPlace, KeptScreen, KeptScreens, KeptTexts, Unread};
pub use model::layout::SavedLayouts;
pub use model::map_state::MapMode;
pub use model::message::Msg;
pub use model::panel_table::Panel;
pub use model::plan_id::PlanId;
pub use model::{action, backdrop, editor, files, flights, keymap, settings};
pub use panel::Panels;
pub use popup::{CommandLine, FlightsList, Palette, Popup, SignalList};
pub use run::{Ending, OtherReceiver, SessionLink, run, run_plain};
pub use shared::{Notice, Shared};
pub use terminal::{Tui, restore_terminal_modes};
pub use text_field::TextField;
pub use theme::Theme;
pub use units::Units;
pub use update::{run_line, update};
