//! The configuration file that the program writes, and the source of the value of each option.

use clap::{Arg, CommandFactory as _};

use super::layers::{FLYING, options};
use super::{Cli, Layers};

/// The number of columns for the text of a comment.
const WIDTH: usize = 96;

/// Commands for the configuration file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::Subcommand)]
pub enum ConfigCommand {
    /// Writes a configuration file that contains every option and key as a comment
    Init {
        /// Replaces an existing file
        #[arg(long)]
        force: bool,
    },
    /// Prints the value of every option with its source
    Show,
    /// Prints the path of the configuration file
    Path,
}

/// An action with keys, for the explanation in the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyHelp {
    /// Name of the action.
    pub name: &'static str,
    /// Default keys.
    pub keys: &'static [&'static str],
    /// The effect of the action.
    pub help: &'static str,
}

/// The value of an option, and its source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// Name of the option.
    pub name: String,
    /// The value; for a default the text of the help.
    pub value: String,
    /// `default`, or the variable or file.
    pub source: String,
}

/// Returns the options that a layer can give, each once, in the order of the help.
fn all_options(command: &clap::Command) -> Vec<&Arg> {
    let mut found: Vec<&Arg> = Vec::new();
    for name in FLYING {
        for option in options(command.find_subcommand(name).unwrap_or(command)) {
            if !found.iter().any(|other| other.get_long() == option.get_long()) {
                found.push(option);
            }
        }
    }
    found
}

/// Returns the help of an option without its default, and the default.
fn help_and_default(option: &Arg) -> (String, Option<String>) {
    let help = option.get_help().map(ToString::to_string).unwrap_or_default();
    match help.split_once(" [default: ") {
        Some((text, default)) => (text.to_owned(), default.strip_suffix(']').map(str::to_owned)),
        None => (help, None),
    }
}

/// Returns a configuration file that contains every option and every key as a comment with its default.
pub fn template(keys: &[KeyHelp]) -> String {
    let mut command = Cli::command();
    command.build();
    let mut text = String::from(
        "# Configuration of betadeck. Each line that begins with a name is an option: take the # away and change it.\n\
         # The command line overrides the environment (BETADECK_WIND), which overrides this file.\n",
    );
    for option in all_options(&command) {
        let Some(long) = option.get_long() else { continue };
        let (help, default) = help_and_default(option);
        let form = option.get_value_names().map_or_else(|| "true".to_owned(), |names| names.join(" "));
        text.push('\n');
        comment(&mut text, &help);
        if let Some(default) = &default {
            comment(&mut text, &format!("Default: {default}"));
        }
        let is_list = matches!(option.get_action(), clap::ArgAction::Append);
        let value = match (option.get_value_names(), is_list) {
            (None, _) => "true".to_owned(),
            (Some(_), true) => format!("[\"{form}\"]"),
            (Some(_), false) => format!("\"{form}\""),
        };
        text.push_str(&format!("#{long} = {value}\n"));
    }
    text.push_str(
        "\n# Keys that replace the default ones. Several in a list, none with \"\". Names: a letter, space, tab,\n\
         # enter, esc, up, home, pageup, f1, delete, with ctrl-, alt- or shift- in front.\n[keys]\n",
    );
    for key in keys {
        text.push('\n');
        comment(&mut text, key.help);
        let all: Vec<String> = key.keys.iter().map(|key| toml::Value::from(*key).to_string()).collect();
        let value = if let [single] = &all[..] { single.clone() } else { format!("[{}]", all.join(", ")) };
        text.push_str(&format!("#\"{}\" = {value}\n", key.name));
    }
    text
}

/// Adds a comment in lines of a readable width.
fn comment(text: &mut String, words: &str) {
    let mut line = String::from("#");
    for word in words.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > WIDTH {
            text.push_str(&line);
            text.push('\n');
            line = String::from("#");
        }
        line.push(' ');
        line.push_str(word);
    }
    text.push_str(&line);
    text.push('\n');
}

/// Returns the value of every option that a layer can give, with its source.
///
/// # Errors
/// Returns a sentence about a value that is not valid for its option.
pub fn origins(layers: &Layers) -> Result<Vec<Origin>, String> {
    let mut command = Cli::command();
    command.build();
    let origin = |option: &Arg| {
        let name = option.get_long()?.to_owned();
        let found = match layers.find(&name) {
            Ok(found) => found,
            Err(problem) => return Some(Err(problem)),
        };
        let (source, value) = match found {
            Some((source, values)) => (source, values.join(", ")),
            None => ("default".to_owned(), help_and_default(option).1.unwrap_or_else(|| "—".to_owned())),
        };
        Some(Ok(Origin { name, value, source }))
    };
    all_options(&command).into_iter().filter_map(origin).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    const KEY: KeyHelp = KeyHelp { name: "flight.arm", keys: &["a", "\\"], help: "Arm" };

    #[test]
    fn the_template_is_a_valid_file_in_which_nothing_is_set() {
        let text = template(&[KEY]);
        let table: toml::Table = text.parse().expect("TOML");
        assert_eq!(table.keys().collect::<Vec<_>>(), ["keys"]);
        for part in
            ["#wind = \"SPEED@FROM\"", "#theme = \"NAME\"", "# Default: metric", "#\"flight.arm\" = ["]
        {
            assert!(text.contains(part), "{part}\n{text}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= 110), "{text}");
    }

    #[test]
    fn uncommented_the_template_names_options_that_exist() {
        let text: String = template(&[KEY])
            .lines()
            .map(|line| line.strip_prefix('#').filter(|rest| !rest.starts_with(' ')).unwrap_or(line))
            .map(|line| format!("{line}\n"))
            .collect();
        let mut table: toml::Table = text.parse().unwrap_or_else(|error| panic!("{error}\n{text}"));
        table.remove("keys");
        let mut command = Cli::command();
        command.build();
        let layers = Layers { file: table, ..Layers::default() };
        assert_eq!(layers.without_unknown(&command).1, Vec::<String>::new());
    }

    #[test]
    fn each_value_says_where_it_comes_from() {
        let layers = Layers {
            environment: BTreeMap::from([("BETADECK_SEED".to_owned(), "7".to_owned())]),
            file_name: "config.toml".to_owned(),
            file: "seed = 3\nwind = \"5@270\"".parse().expect("TOML"),
        };
        let origins = origins(&layers).expect("no problem");
        let of = |name: &str| {
            let origin = origins.iter().find(|origin| origin.name == name).expect(name);
            (origin.value.as_str(), origin.source.as_str())
        };
        assert_eq!(of("seed"), ("7", "environment variable BETADECK_SEED"));
        assert_eq!(of("wind"), ("5@270", "config.toml: wind"));
        assert_eq!(of("units"), ("metric", "default"));
        assert_eq!(origins.iter().filter(|origin| origin.name == "seed").count(), 1);
    }
}
