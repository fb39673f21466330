//! Reads the options outside the command line: environment variables and the configuration file.
#![allow(clippy::disallowed_methods, reason = "the composition root reads the environment")]

use std::collections::BTreeMap;

use super::configuration_file::ConfigurationFile;
use crate::args::{ENVIRONMENT_PREFIX, Layers};
use crate::files::directories::directories;
use crate::files::input_file;
use crate::process::error::AppError;
use crate::ui::keymap::KeyLine;

/// The options outside the command line.
#[derive(Debug, Clone, Default)]
pub(super) struct Outside {
    /// The values of options.
    pub layers: Layers,
    /// The keys defined by the user.
    pub keys: Vec<KeyLine>,
}

/// Reads the environment and the configuration file, which may be missing.
pub(super) fn read() -> Result<Outside, AppError> {
    let environment: BTreeMap<String, String> = std::env::vars_os()
        .filter_map(|(name, value)| Some((name.into_string().ok()?, value.into_string().ok()?)))
        .filter(|(name, _)| name.starts_with(ENVIRONMENT_PREFIX))
        .collect();
    // Without a home directory there is no configuration file, either.
    let Ok(directories) = directories() else {
        return Ok(Outside { layers: Layers { environment, ..Layers::default() }, keys: Vec::new() });
    };
    let path = directories.config_file();
    let file_name = path.display().to_string();
    let text = input_file::read_if_there(&path)?.unwrap_or_default();
    let ConfigurationFile { options, keys } = ConfigurationFile::read(&file_name, &text)?;
    Ok(Outside { layers: Layers { environment, file_name, file: options }, keys })
}
