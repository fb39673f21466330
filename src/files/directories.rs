//! The user's directories.

use etcetera::BaseStrategy as _;

use crate::process::error::AppError;

/// The name of the program's folder in the user's directories.
const FOLDER: &str = "betadeck";

/// The user's directories for this program.
#[derive(Debug, Clone)]
pub(crate) struct Directories {
    /// The folder of `config.toml`.
    pub config: std::path::PathBuf,
    /// The folder of the stored configuration of the craft.
    pub state: std::path::PathBuf,
    /// The folder of the user's own data.
    pub data: std::path::PathBuf,
}

impl Directories {
    pub(crate) fn config_file(&self) -> std::path::PathBuf {
        self.config.join("config.toml")
    }

    /// Returns the folder of elevation tiles, which may be missing.
    pub(crate) fn terrain(&self) -> std::path::PathBuf {
        self.data.join("terrain")
    }
}

/// Finds the user's directories.
pub(crate) fn directories() -> Result<Directories, AppError> {
    let strategy = etcetera::choose_base_strategy()
        .map_err(|error| AppError::environment(format!("cannot find your home directory: {error}")))?;
    Ok(Directories {
        config: strategy.config_dir().join(FOLDER),
        state: strategy.state_dir().unwrap_or_else(|| strategy.data_dir()).join(FOLDER),
        data: strategy.data_dir().join(FOLDER),
    })
}
