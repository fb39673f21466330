//! Completion scripts and the manual page, from the definition of the command line.

use std::io::{self, Write};

use clap::CommandFactory as _;

use super::Cli;

/// The completion script of a shell.
#[must_use]
pub fn completions(shell: clap_complete::Shell) -> Vec<u8> {
    let mut script = Vec::new();
    let mut command = Cli::command();
    let name = command.get_name().to_owned();
    clap_complete::generate(shell, &mut command, name, &mut script);
    script
}

/// The manual page with all commands, in roff.
///
/// # Errors
///
/// When the page cannot be rendered.
pub fn man_page() -> io::Result<Vec<u8>> {
    let mut page = Vec::new();
    let mut command = Cli::command();
    command.build();
    clap_mangen::Man::new(command.clone()).render(&mut page)?;
    for subcommand in visible(&command) {
        writeln!(page, ".SH \"COMMAND: {}\"", subcommand.to_uppercase())?;
        let Some(definition) = command.find_subcommand(&subcommand) else { continue };
        let man = clap_mangen::Man::new(definition.clone());
        man.render_description_section(&mut page)?;
        man.render_synopsis_section(&mut page)?;
        if definition.get_arguments().next().is_some() {
            man.render_options_section(&mut page)?;
        }
    }
    Ok(page)
}

fn visible(command: &clap::Command) -> Vec<String> {
    command.get_subcommands().filter(|sub| !sub.is_hide_set()).map(|sub| sub.get_name().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::ValueEnum as _;

    #[test]
    fn every_shell_gets_a_script() {
        for shell in clap_complete::Shell::value_variants() {
            let script = String::from_utf8(completions(*shell)).unwrap();
            assert!(script.contains("rx-loss-at"), "{shell}");
        }
    }

    #[test]
    fn the_manual_page_has_every_command_and_its_options() {
        let page = String::from_utf8(man_page().unwrap()).unwrap();
        assert!(page.starts_with(".ie") && page.contains(".TH betadeck 1"), "{page}");
        for word in ["COMMAND: FLY", "COMMAND: CONVERT", "rx\\-loss\\-at", "state\\-dir"] {
            assert!(page.contains(word), "{word}");
        }
    }
}
