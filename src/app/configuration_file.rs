//! The text of the configuration file: values of options, and the keys under `[keys]`.

use super::keys;
use crate::process::error::AppError;
use crate::ui::keymap::KeyLine;

/// The contents of a configuration file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ConfigurationFile {
    /// The values of options, by their names.
    pub options: toml::Table,
    /// The keys defined by the user.
    pub keys: Vec<KeyLine>,
}

impl ConfigurationFile {
    /// Reads the text of a configuration file; messages call it `file_name`.
    ///
    /// # Errors
    /// Returns the mistake and its place.
    pub fn read(file_name: &str, text: &str) -> Result<Self, AppError> {
        let mut options: toml::Table = text.parse().map_err(|error: toml::de::Error| {
            AppError::input(format!("{file_name}: {error}").trim_end().to_owned())
        })?;
        let keys = keys::read(file_name, text)?;
        options.remove("keys");
        Ok(Self { options, keys })
    }
}
