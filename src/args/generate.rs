//! Completion scripts and the manual page, from the definition of the command line.

use std::io::{self, Write};

use clap::builder::PossibleValuesParser;
use clap::{Arg, Command, CommandFactory as _};
use clap_complete::Shell;
use strum::VariantNames as _;

use super::Cli;
use crate::plan::builtin::PLANS;
use crate::scenario::SCENARIOS;
use crate::sim::Noise;
use crate::telemetry::Turbulence;

/// Returns the completion script of a shell.
pub fn completions(shell: Shell) -> Vec<u8> {
    let mut script = Vec::new();
    let mut command = Cli::command();
    // Bash offers file names, too, if no word matches. The other shells would offer the words only.
    if shell == Shell::Bash {
        command = with_words(command);
    }
    let name = command.get_name().to_owned();
    clap_complete::generate(shell, &mut command, name, &mut script);
    script
}

/// Returns a command whose arguments name the words that they take.
fn with_words(command: Command) -> Command {
    let named = command.mut_args(|arg| {
        let words = words(&arg);
        if words.is_empty() { arg } else { arg.value_parser(PossibleValuesParser::new(words)) }
    });
    named.mut_subcommands(with_words)
}

/// Returns the words that an argument takes: levels, built-in plans and scenarios.
fn words(arg: &Arg) -> Vec<&'static str> {
    let plans = || PLANS.iter().map(|plan| plan.name);
    let scenarios = || SCENARIOS.iter().map(|scenario| scenario.name);
    let value = arg.get_value_names().and_then(|names| names.first()).map_or("", |name| name.as_str());
    match (arg.get_long(), value) {
        (Some("turbulence"), _) => Turbulence::VARIANTS.to_vec(),
        (Some("noise"), _) => Noise::VARIANTS.to_vec(),
        (None, "PLAN") => plans().collect(),
        (None, "FILE|PLAN") => plans().chain(scenarios()).collect(),
        (None, "NAME|FILE|DIR|-" | "SCENARIO|RUN:N|RECORDING") => scenarios().collect(),
        _ => Vec::new(),
    }
}

/// Returns the manual page with all commands, in roff.
///
/// # Errors
///
/// Returns an error if the page cannot be rendered.
pub fn man_page() -> io::Result<Vec<u8>> {
    let mut command = Cli::command();
    command.build();
    let mut page = Vec::new();
    let man = clap_mangen::Man::new(command.clone());
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    sections(&command, &mut page)?;
    for leaf in leaves(&command) {
        let name = leaf.get_bin_name().unwrap_or_default().to_uppercase();
        writeln!(page, ".SH \"{name}\"")?;
        let mut own = Vec::new();
        sections(leaf, &mut own)?;
        // One level below the command.
        page.extend(String::from_utf8_lossy(&own).replace(".SH ", ".SS ").into_bytes());
    }
    Ok(page)
}

/// Writes synopsis, description, options, notes and examples of a command.
fn sections(command: &clap::Command, page: &mut Vec<u8>) -> io::Result<()> {
    let man = clap_mangen::Man::new(command.clone());
    man.render_synopsis_section(page)?;
    man.render_description_section(page)?;
    if command.get_arguments().next().is_some() {
        man.render_options_section(page)?;
    }
    if let Some(notes) = command.get_after_help() {
        writeln!(page, ".SH NOTES\n.nf\n{}\n.fi", escaped(&notes.to_string()))?;
    }
    if let Some(examples) = command.get_before_help() {
        let examples = examples.to_string();
        let lines = examples.strip_prefix("Examples:\n").unwrap_or(&examples);
        writeln!(page, ".SH EXAMPLES\n.nf\n{}\n.fi", escaped(lines))?;
    }
    Ok(())
}

/// Returns a text for roff in which no line is a request and no character is an escape.
fn escaped(text: &str) -> String {
    let text = text.replace('\\', "\\e").replace('-', "\\-");
    let lines = text.lines().map(|line| match line.as_bytes().first() {
        Some(b'.' | b'\'') => format!("\\&{line}"),
        _ => line.to_owned(),
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Returns the commands that have an effect, without `help`.
fn leaves(command: &clap::Command) -> Vec<&clap::Command> {
    let own = command.get_subcommands().filter(|sub| !sub.is_hide_set() && sub.get_name() != "help");
    own.flat_map(|sub| if sub.has_subcommands() { leaves(sub) } else { vec![sub] }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{Parser as _, ValueEnum as _};

    #[test]
    fn every_shell_gets_a_script() {
        for shell in clap_complete::Shell::value_variants() {
            let script = String::from_utf8(completions(*shell)).unwrap();
            for word in ["rx-loss-at", "firmware-arg", "compare"] {
                assert!(script.contains(word), "{shell} {word}");
            }
        }
    }

    #[test]
    fn bash_offers_levels_plans_and_scenarios_that_the_command_line_takes() {
        let script = String::from_utf8(completions(Shell::Bash)).unwrap();
        for offered in ["compgen -W \"none light moderate severe\"", "compgen -W \"real none\""] {
            assert!(script.contains(offered), "{offered}");
        }
        let command = with_words(Cli::command());
        let of = |name: &str| {
            let sub = command.find_subcommand(name).unwrap_or(&command);
            let offered = sub.get_positionals().flat_map(Arg::get_possible_values);
            offered.map(|word| word.get_name().to_owned()).collect::<Vec<_>>()
        };
        assert!(of("fly").contains(&"square".to_owned()) && of("check").contains(&"guide-1".to_owned()));
        for (name, word) in ["fly", "check", "campaign", "open"]
            .into_iter()
            .flat_map(|name| of(name).into_iter().map(move |word| (name, word)))
        {
            assert!(Cli::try_parse_from(["betadeck", name, &word]).is_ok(), "{name} {word}");
        }
        for (option, words) in [("--noise", Noise::VARIANTS), ("--turbulence", Turbulence::VARIANTS)] {
            for word in words {
                assert!(Cli::try_parse_from(["betadeck", "fly", "square", option, word]).is_ok(), "{word}");
            }
        }
        let words = script.split("betadeck__subcmd__fly)").last().unwrap_or_default();
        assert!(words.lines().nth(1).is_some_and(|line| line.contains(" square ")), "{words}");
    }

    #[test]
    fn the_manual_page_has_every_command_and_its_options() {
        let page = String::from_utf8(man_page().unwrap()).unwrap();
        assert!(page.starts_with(".ie") && page.contains(".TH betadeck 1"), "{page}");
        for word in [
            "\"BETADECK FLY\"",
            "\"BETADECK COMPARE\"",
            "fdm\\-stamps",
            "\"BETADECK PLAN SHOW\"",
            "rx\\-loss\\-at",
            "state\\-dir",
            "Exit codes: 0",
            "betadeck fly square",
        ] {
            assert!(page.contains(word), "{word}");
        }
        assert!(!page.contains("(1)"), "it refers to pages that do not exist");
    }
}
