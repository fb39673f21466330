//! `betadeck config`: writes the configuration file with comments, shows each value with its source, prints its path.

use std::fmt::Write as _;
use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write as _};

use super::layers::{self, Outside};
use crate::args::{self, ConfigCommand, KeyHelp};
use crate::files::directories;
use crate::process::error;
use crate::process::error::AppError;
use crate::ui::action::ACTIONS;

/// Runs the command.
pub(super) fn run(command: ConfigCommand) -> Result<u8, AppError> {
    match command {
        ConfigCommand::Init { force } => init(force),
        ConfigCommand::Show => show(),
        ConfigCommand::Path => {
            let path = directories::directories()?.config_file();
            error::print(&format!("{}\n", path.display()))
        }
    }
}

/// Writes the file. An existing file may be the work of the user, so it is replaced only on request.
fn init(force: bool) -> Result<u8, AppError> {
    let path = directories::directories()?.config_file();
    let problem = |error| AppError::environment(format!("cannot write {}: {error}", path.display()));
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(problem)?;
    }
    let mut options = OpenOptions::new();
    let options = if force { options.create(true).truncate(true) } else { options.create_new(true) };
    let mut file = options.write(true).open(&path).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            AppError::environment(format!("{} exists: edit it, or replace it with --force", path.display()))
        }
        _ => problem(error),
    })?;
    let keys: Vec<KeyHelp> =
        ACTIONS.iter().map(|spec| KeyHelp { name: spec.name, keys: spec.keys, help: spec.help }).collect();
    file.write_all(args::template(&keys).as_bytes()).map_err(problem)?;
    error::print(&format!("{}\n", path.display()))
}

/// Prints every value and its source, then the keys that differ from the default.
fn show() -> Result<u8, AppError> {
    let Outside { layers, keys } = layers::read()?;
    let origins = args::origins(&layers).map_err(AppError::input)?;
    let name_width = origins.iter().map(|origin| origin.name.len()).max().unwrap_or(0);
    let value_width = origins.iter().map(|origin| origin.value.chars().count()).max().unwrap_or(0).min(40);
    let mut text = String::new();
    for args::Origin { name, value, source } in &origins {
        let _ = writeln!(text, "{name:<name_width$}  {value:<value_width$}  {source}");
    }
    for line in &keys {
        let place = format!("{}:{}", layers.file_name, line.line);
        let name = format!("keys.{}", line.action);
        let _ = writeln!(text, "{name:<name_width$}  {:<value_width$}  {place}", line.keys.join(" "));
    }
    error::print(&text)
}
