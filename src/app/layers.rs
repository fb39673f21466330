//! Reads the options outside the command line: environment variables and the configuration file.
#![allow(clippy::disallowed_methods, reason = "the composition root reads the environment")]

use std::collections::BTreeMap;

use etcetera::BaseStrategy as _;

use super::AppError;
use super::configuration_file::ConfigurationFile;
use super::input_file;
use crate::args::{ENVIRONMENT_PREFIX, Layers};
use crate::ui::keymap::KeyLine;

/// The name of the program's folder in the user's directories.
const FOLDER: &str = "betadeck";

/// The user's directories for this program.
#[derive(Debug, Clone)]
pub(super) struct Directories {
    /// The folder of `config.toml`.
    pub config: std::path::PathBuf,
    /// The folder of the stored configuration of the craft.
    pub state: std::path::PathBuf,
    /// The folder of the user's own data.
    pub data: std::path::PathBuf,
}

impl Directories {
    pub(super) fn config_file(&self) -> std::path::PathBuf {
        self.config.join("config.toml")
    }

    /// Returns the folder of elevation tiles, which may be missing.
    pub(super) fn terrain(&self) -> std::path::PathBuf {
        self.data.join("terrain")
    }
}

/// Finds the user's directories.
pub(super) fn directories() -> Result<Directories, AppError> {
    let strategy = etcetera::choose_base_strategy()
        .map_err(|error| AppError::environment(format!("cannot find your home directory: {error}")))?;
    Ok(Directories {
        config: strategy.config_dir().join(FOLDER),
        state: strategy.state_dir().unwrap_or_else(|| strategy.data_dir()).join(FOLDER),
        data: strategy.data_dir().join(FOLDER),
    })
}

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
