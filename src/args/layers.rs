//! The layers below the command line: environment and configuration file.
//!
//! Every long option of a command that flies is a key in the file (`wind = "5@270"`) and a variable in the
//! environment (`BETADECK_WIND`). For `check` and `campaign` these are the options of the firmware, for `open` and
//! `replay` those of the screen, for `flights` the state directory, for `plan show` all options. A value from a layer for an option that no
//! higher layer gave is parsed by the option's own parser, as if someone typed it.

use std::collections::BTreeMap;
use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, FromArgMatches as _};

use super::{Cli, repeat};
use crate::text::did_you_mean;

/// The start of the names of environment variables.
pub const ENVIRONMENT_PREFIX: &str = "BETADECK_";

/// The options outside the command line.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Layers {
    /// The environment; variables without [`ENVIRONMENT_PREFIX`] are ignored.
    pub environment: BTreeMap<String, String>,
    /// Name of the configuration file, for messages.
    pub file_name: String,
    /// Contents of the configuration file.
    pub file: toml::Table,
}

/// The source of values, and the values.
type Found = (String, Vec<String>);

/// Commands with options from all layers; the empty name is the terminal user interface.
pub(super) const FLYING: [&str; 5] = ["", "fly", "compare", "serve", "sitl"];
/// The commands that take only the firmware from all layers. The scenario, or the command line of a campaign, gives the
/// rest of a flight.
const FIRMWARE_ONLY: [&str; 2] = ["check", "campaign"];
/// The commands that take only the options of the screen from all layers: their files say the rest.
const SCREEN_ONLY: [&str; 2] = ["open", "replay"];
/// The command that takes only the state directory from all layers, and the option for it.
const STATE_ONLY: (&str, &str) = ("flights", "state-dir");
/// The command and the subcommand that judge a plan without a flight.
const PLAN_SHOW: (&str, &str) = ("plan", "show");
/// The heading of the options for the choice of the firmware.
const FIRMWARE: &str = "Firmware";
/// The heading of the options of the screen.
const SCREEN: &str = "Screen";

/// Parses the command line again with the additions from the layers.
pub(super) fn apply(
    layers: &Layers,
    mut arguments: Vec<OsString>,
    matches: &ArgMatches,
    command: &mut clap::Command,
) -> Result<Cli, clap::Error> {
    command.build();
    let (name, typed) = matches.subcommand().unwrap_or(("", matches));
    let mut sources = BTreeMap::new();
    let nested = typed.subcommand().filter(|(nested, _)| (name, *nested) == PLAN_SHOW);
    // Merging the parts of a campaign flies nothing.
    let is_firmware_only = FIRMWARE_ONLY.contains(&name) && typed.subcommand().is_none();
    let is_partial = is_firmware_only || SCREEN_ONLY.contains(&name) || name == STATE_ONLY.0;
    if FLYING.contains(&name) || is_partial || nested.is_some() {
        let unknown = layers.unknown_keys(command);
        if !unknown.is_empty() {
            return Err(problem(&unknown.join("\n")));
        }
        let definition = command.find_subcommand(name).unwrap_or(command);
        let (definition, typed) = match nested {
            Some((nested, typed)) => (definition.find_subcommand(nested).unwrap_or(definition), typed),
            None => (definition, typed),
        };
        let added = layers.additions(definition, typed, &mut sources).map_err(|text| problem(&text))?;
        // After all typed words, but before a `--` that ends the options.
        let end = arguments.iter().position(|argument| argument == "--").unwrap_or(arguments.len());
        arguments.splice(end..end, added);
    }
    let matches =
        command.try_get_matches_from_mut(arguments).map_err(|error| name_source(error, &sources))?;
    let cli = Cli::from_arg_matches(&matches)?;
    Ok(Cli { repeat: repeat::words(&matches, command), ..cli })
}

/// Returns the options of a command that the layers can give; a hidden option does not belong to the command.
pub(super) fn options(command: &clap::Command) -> impl Iterator<Item = &Arg> {
    let only = match command.get_name() {
        name if FIRMWARE_ONLY.contains(&name) => Some(FIRMWARE),
        name if SCREEN_ONLY.contains(&name) => Some(SCREEN),
        _ => None,
    };
    let of_state_only = command.get_name() == STATE_ONLY.0;
    command
        .get_arguments()
        .filter(|arg| !arg.is_positional() && !arg.is_hide_set())
        .filter(|arg| !matches!(arg.get_long(), Some("help" | "version")))
        .filter(move |arg| only.is_none() || arg.get_help_heading() == only)
        .filter(move |arg| !of_state_only || arg.get_long() == Some(STATE_ONLY.1))
}

fn is_typed(matches: &ArgMatches, option: &Arg) -> bool {
    matches.value_source(option.get_id().as_str()) == Some(ValueSource::CommandLine)
}

/// Returns `--wind=5@270` for each value; a plain flag for `true`, nothing for `false`.
fn flags(option: &Arg, long: &str, source: &str, values: &[String]) -> Result<Vec<OsString>, String> {
    match option.get_action() {
        ArgAction::SetTrue => match values.first().map(|value| value.to_ascii_lowercase()).as_deref() {
            Some("true" | "on" | "yes" | "1") => Ok(vec![format!("--{long}").into()]),
            Some("false" | "off" | "no" | "0" | "") | None => Ok(Vec::new()),
            Some(other) => Err(format!("{source}: {other} is neither true nor false")),
        },
        ArgAction::Append => Ok(values.iter().map(|value| format!("--{long}={value}").into()).collect()),
        _ if values.len() > 1 => Err(format!("{source}: one value is expected, not {}", values.len())),
        _ => Ok(values.iter().map(|value| format!("--{long}={value}").into()).collect()),
    }
}

impl Layers {
    /// Returns the additions of the layers to the typed options, the environment first. An option that conflicts with
    /// one of a higher layer is left out. `sources` gets the source of each added option.
    fn additions(
        &self,
        definition: &clap::Command,
        typed: &ArgMatches,
        sources: &mut BTreeMap<String, String>,
    ) -> Result<Vec<OsString>, String> {
        // Also options that no layer can give: `check --list` silences the ports of a firmware.
        let mut given: Vec<&Arg> =
            definition.get_arguments().filter(|option| is_typed(typed, option)).collect();
        let mut decided = given.clone();
        let mut added = Vec::new();
        for layer in [Self::in_environment, Self::in_file] {
            let mut here = Vec::new();
            for option in options(definition) {
                let clash = |other: &&Arg| {
                    definition.get_arg_conflicts_with(option).contains(other)
                        || definition.get_arg_conflicts_with(other).contains(&option)
                };
                let blocked = decided.contains(&option) || given.iter().any(clash);
                let Some(long) = option.get_long().filter(|_| !blocked) else { continue };
                let Some((source, values)) = layer(self, long)? else { continue };
                let values = flags(option, long, &source, &values)?;
                decided.push(option);
                if !values.is_empty() {
                    here.push(option);
                }
                added.extend(values);
                sources.insert(long.to_owned(), source);
            }
            given.append(&mut here);
        }
        Ok(added)
    }

    /// Returns the first source of an option, and its values.
    pub(super) fn find(&self, long: &str) -> Result<Option<Found>, String> {
        match self.in_environment(long)? {
            Some(found) => Ok(Some(found)),
            None => self.in_file(long),
        }
    }

    /// Returns the option's source in the environment, and its value.
    fn in_environment(&self, long: &str) -> Result<Option<Found>, String> {
        let variable = format!("{ENVIRONMENT_PREFIX}{}", long.to_ascii_uppercase().replace('-', "_"));
        let value = self.environment.get(&variable).filter(|value| !value.is_empty());
        Ok(value.map(|value| (format!("environment variable {variable}"), vec![value.clone()])))
    }

    /// Returns the option's source in the file, and its values.
    fn in_file(&self, long: &str) -> Result<Option<Found>, String> {
        let Some((key, value)) = self.file.iter().find(|(key, _)| option_name(key) == long) else {
            return Ok(None);
        };
        let source = format!("{}: {key}", self.file_name);
        let texts = match value {
            toml::Value::Array(values) => values.iter().map(scalar).collect(),
            single => scalar(single).map(|text| vec![text]),
        };
        match texts {
            Some(texts) => Ok(Some((source, texts))),
            None => Err(format!("{source}: a {} is not a value of --{long}", value.type_str())),
        }
    }

    /// Returns the layers without names that are not options, and a sentence for each such name.
    pub(super) fn without_unknown(&self, command: &clap::Command) -> (Self, Vec<String>) {
        let names = all_names(command);
        let mut problems = self.unknown_keys(command);
        let mut known = self.clone();
        known.file.retain(|key, _| names.contains(&option_name(key)));
        for variable in self.environment.keys() {
            let Some(name) = variable.strip_prefix(ENVIRONMENT_PREFIX) else { continue };
            let name = option_name(&name.to_ascii_lowercase());
            if !names.contains(&name) {
                let guess = did_you_mean::closest(&name, names.iter().map(String::as_str)).map_or_else(
                    String::new,
                    |name| {
                        format!(
                            "; did you mean {ENVIRONMENT_PREFIX}{}?",
                            name.to_ascii_uppercase().replace('-', "_")
                        )
                    },
                );
                problems.push(format!("environment variable {variable} is not an option{guess}"));
            }
        }
        (known, problems)
    }

    /// Returns one layer for each variable and each key.
    pub(super) fn singles(&self) -> impl Iterator<Item = Self> + '_ {
        let empty = || Self { file_name: self.file_name.clone(), ..Self::default() };
        let variables = self.environment.iter().map(move |(name, value)| Self {
            environment: BTreeMap::from([(name.clone(), value.clone())]),
            ..empty()
        });
        let keys = self.file.iter().map(move |(key, value)| Self {
            file: toml::Table::from_iter([(key.clone(), value.clone())]),
            ..empty()
        });
        variables.chain(keys)
    }

    /// Returns a sentence for each key of the file that is not an option.
    fn unknown_keys(&self, command: &clap::Command) -> Vec<String> {
        let names = all_names(command);
        let unknown = self.file.keys().filter(|key| !names.contains(&option_name(key)));
        unknown
            .map(|key| {
                let guess = did_you_mean::closest(&option_name(key), names.iter().map(String::as_str));
                let guess = guess.map_or_else(String::new, |name| format!("; did you mean {name}?"));
                format!("{}: {key} is not an option{guess}", self.file_name)
            })
            .collect()
    }
}

/// Returns the names of all options that a layer can give.
fn all_names(command: &clap::Command) -> Vec<String> {
    FLYING
        .iter()
        .flat_map(|name| options(command.find_subcommand(name).unwrap_or(command)))
        .filter_map(Arg::get_long)
        .map(str::to_owned)
        .collect()
}

/// Returns the option for a key. Keys may also be written with `_`.
fn option_name(key: &str) -> String {
    key.replace('_', "-")
}

/// Returns a value in its typed form.
fn scalar(value: &toml::Value) -> Option<String> {
    match value {
        toml::Value::String(text) => Some(text.clone()),
        toml::Value::Integer(number) => Some(number.to_string()),
        toml::Value::Float(number) => Some(number.to_string()),
        toml::Value::Boolean(true) => Some("on".to_owned()),
        toml::Value::Boolean(false) => Some("off".to_owned()),
        toml::Value::Datetime(_) | toml::Value::Array(_) | toml::Value::Table(_) => None,
    }
}

fn problem(text: &str) -> clap::Error {
    super::usage_error(ErrorKind::InvalidValue, text)
}

/// Adds the source of a value that an option's parser refused.
fn name_source(mut error: clap::Error, sources: &BTreeMap<String, String>) -> clap::Error {
    let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg) else { return error };
    let long = option.trim_start_matches('-').split([' ', '=']).next().unwrap_or_default();
    if let Some(source) = sources.get(long) {
        let place = format!("--{long}, from {source}");
        error.insert(ContextKind::InvalidArg, ContextValue::String(place));
    }
    error
}
