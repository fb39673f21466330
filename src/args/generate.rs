//! Completion scripts and the manual page, from the definition of the command line.

use std::io::{self, Write};

use clap::CommandFactory as _;

use super::Cli;

/// Returns the completion script of a shell.
pub fn completions(shell: clap_complete::Shell) -> Vec<u8> {
    let mut script = Vec::new();
    let mut command = Cli::command();
    let name = command.get_name().to_owned();
    clap_complete::generate(shell, &mut command, name, &mut script);
    script
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
    use clap::ValueEnum as _;

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
