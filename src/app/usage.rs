//! Messages about a command line: help and errors.

use std::ffi::OsString;
use std::path::Path;

use crate::args::{self, Layers};
use crate::process::error;
use crate::text::printable;

/// Makes the name of the program printable, because every usage line shows it.
pub(super) fn with_printable_name(mut arguments: Vec<OsString>) -> Vec<OsString> {
    if let Some(name) = arguments.first_mut() {
        let own = Path::new(&*name).file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !is_printable(&own) {
            *name = printable::name(&own).into();
        }
    }
    arguments
}

/// Prints help on standard output and errors on standard error, with colours if requested. An error is shown for the
/// same command line without terminal control sequences, because the parser mixes its own colours with the texts.
pub(super) fn print(error: &clap::Error, arguments: &[OsString], layers: &Layers) {
    let shown: Vec<OsString> =
        arguments.iter().map(|argument| shown(&argument.to_string_lossy()).into()).collect();
    let shown_layers = printable_layers(layers);
    if !error.use_stderr() || (arguments == shown && *layers == shown_layers) {
        drop(error.print());
        return;
    }
    match args::parse(shown, &shown_layers) {
        Err(error) if error.use_stderr() => drop(error.print()),
        // Without colours, and without terminal control sequences.
        Ok(_) | Err(_) => error::tell(error.render().to_string().trim_end()),
    }
}

/// Returns the layers without terminal control sequences.
pub(super) fn printable_layers(layers: &Layers) -> Layers {
    let environment = layers.environment.iter().map(|(name, value)| (shown(name), shown(value)));
    let file = layers.file.iter().map(|(key, value)| (shown(key), printable_value(value)));
    Layers { environment: environment.collect(), file_name: shown(&layers.file_name), file: file.collect() }
}

fn printable_value(value: &toml::Value) -> toml::Value {
    match value {
        toml::Value::String(text) => shown(text).into(),
        toml::Value::Array(values) => toml::Value::Array(values.iter().map(printable_value).collect()),
        toml::Value::Table(table) => table
            .iter()
            .map(|(key, value)| (shown(key), printable_value(value)))
            .collect::<toml::Table>()
            .into(),
        other => other.clone(),
    }
}

fn is_printable(text: &str) -> bool {
    text.chars().all(printable::is_printable)
}

/// Returns the text without terminal control sequences. A long text stays long: the parser may need all of it.
fn shown(text: &str) -> String {
    if is_printable(text) { text.to_owned() } else { printable::line(text).into_owned() }
}
