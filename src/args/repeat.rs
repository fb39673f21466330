//! The command line that gives a run again.

use clap::parser::ValueSource;
use clap::{ArgAction, ArgMatches};

/// The heading of the options for files of results.
const OUTPUT: &str = "Output";

/// Returns the words after the program's name that give the same run, without its outputs. The values of all layers are
/// among them, because they are parsed as if someone typed them.
pub(super) fn words(matches: &ArgMatches, command: &clap::Command) -> Vec<String> {
    let (name, typed) = matches.subcommand().unwrap_or(("", matches));
    let Some(definition) = command.find_subcommand(name) else { return Vec::new() };
    if typed.subcommand().is_some() {
        return std::iter::once(name.to_owned()).chain(words(typed, definition)).collect();
    }
    let mut parts: Vec<(usize, Vec<String>)> = Vec::new();
    for option in definition.get_arguments() {
        let id = option.get_id().as_str();
        let is_typed = matches!(typed.value_source(id), Some(ValueSource::CommandLine));
        if !is_typed || option.get_help_heading() == Some(OUTPUT) {
            continue;
        }
        let (Some(indices), values) = (typed.indices_of(id), typed.get_raw(id)) else { continue };
        let values = values.into_iter().flatten().map(|value| value.to_string_lossy().into_owned());
        let is_flag = matches!(option.get_action(), ArgAction::SetTrue);
        for (index, value) in indices.zip(values) {
            let words = match option.get_long() {
                None => vec![value],
                Some(long) if is_flag => vec![format!("--{long}")],
                Some(long) if value.starts_with('-') => vec![format!("--{long}={value}")],
                Some(long) => vec![format!("--{long}"), value],
            };
            parts.push((index, words));
        }
    }
    parts.sort_by_key(|(index, _)| *index);
    std::iter::once(name.to_owned()).chain(parts.into_iter().flat_map(|(_, words)| words)).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::ffi::OsString;

    use super::super::{Layers, parse};

    fn repeated(line: &[&str]) -> Vec<String> {
        let layers = Layers {
            environment: BTreeMap::from([("BETADECK_GUST".to_owned(), "2".to_owned())]),
            ..Layers::default()
        };
        let line = ["betadeck"].iter().chain(line).map(OsString::from);
        parse(line, &layers).expect("a command").repeat
    }

    #[test]
    fn the_same_run_needs_no_outputs_but_the_values_of_all_layers() {
        assert_eq!(
            repeated(&[
                "fly",
                "--json=-",
                "square",
                "--wind",
                "5@270",
                "--set",
                "a=1",
                "--csv",
                "x.csv",
                "--set=b=2",
                "--fresh",
                "--heading=-20",
                "--report",
                "r.html",
            ]),
            [
                "fly",
                "square",
                "--wind",
                "5@270",
                "--set",
                "a=1",
                "--set",
                "b=2",
                "--fresh",
                "--heading=-20",
                "--gust",
                "2"
            ]
        );
        assert_eq!(
            repeated(&["check", "guide-1", "a b.toml", "--seeds", "1..3", "--junit", "x.xml"]),
            ["check", "guide-1", "a b.toml", "--seeds", "1..3"]
        );
        assert_eq!(repeated(&["doctor"]), ["doctor"]);
        assert_eq!(
            repeated(&[
                "campaign",
                "merge",
                "a.jsonl",
                "b.jsonl",
                "--out",
                "run.jsonl",
                "--report",
                "r.html"
            ]),
            ["campaign", "merge", "a.jsonl", "b.jsonl"]
        );
    }
}
