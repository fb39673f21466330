//! The built executable, run as a user runs it: flights, plans, the command line, and the user interface in a
//! pseudo-terminal.

#[cfg(unix)]
mod all_commands;
mod by_mouse;
mod campaign;
mod cases;
mod check;
mod cli;
mod compare;
#[cfg(unix)]
mod connect;
mod csv;
#[cfg(unix)]
mod docs;
mod documents;
#[cfg(unix)]
mod editor;
mod exchange;
mod first_walk;
mod fly;
mod forecast;
#[cfg(unix)]
mod hostile;
mod inputs;
#[cfg(unix)]
mod kept_place;
mod kept_screen;
#[cfg(unix)]
mod library;
#[cfg(unix)]
mod limits;
mod lines;
#[cfg(unix)]
mod logs;
mod options;
mod plain;
mod plans;
mod portable;
mod profile;
#[cfg(unix)]
pub(crate) mod pty;
#[cfg(unix)]
mod recordings;
#[cfg(unix)]
mod replay;
mod replayed_recordings;
#[cfg(unix)]
mod reports;
#[cfg(target_os = "linux")]
mod reproducible;
#[cfg(unix)]
mod settings;
mod signals;
#[cfg(unix)]
mod state_files;
#[cfg(unix)]
mod streams;
mod support;
mod survey;
mod sweep;
#[cfg(unix)]
mod terminal;
#[cfg(unix)]
mod timeline;
#[cfg(unix)]
mod typed_ahead;
mod verdict;
