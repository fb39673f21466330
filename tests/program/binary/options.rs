//! The help texts as a user sees them, 100 columns wide.

use betadeck::args::Cli;
use clap::CommandFactory as _;

/// Returns the help of a command, short (`-h`) or long (`--help`).
fn help(path: &[&str], long: bool) -> String {
    let mut root = Cli::command().term_width(100);
    root.build();
    let mut command = &mut root;
    for name in path {
        command = command.find_subcommand_mut(name).expect("a command");
    }
    let text = if long { command.render_long_help() } else { command.render_help() };
    text.to_string().lines().map(str::trim_end).collect::<Vec<_>>().join("\n")
}

#[test]
fn short_help() {
    insta::assert_snapshot!("betadeck_short", help(&[], false));
    insta::assert_snapshot!("fly_short", help(&["fly"], false));
}

#[test]
fn long_help() {
    insta::assert_snapshot!("fly_long", help(&["fly"], true));
    insta::assert_snapshot!("compare_long", help(&["compare"], true));
    insta::assert_snapshot!("convert_long", help(&["convert"], true));
    insta::assert_snapshot!("plan_show_long", help(&["plan", "show"], true));
}

#[test]
fn every_command_and_option_is_explained() {
    let mut root = Cli::command();
    root.build();
    let mut commands = vec![root];
    while let Some(command) = commands.pop() {
        let name = command.get_name().to_owned();
        assert!(command.get_about().is_some(), "{name} has no description");
        for argument in command.get_arguments() {
            let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
            let id = argument.get_id();
            assert!(!help.is_empty() && !help.ends_with('.'), "{name}: {id}: {help:?}");
        }
        for line in help_lines(&command) {
            assert!(line.chars().count() <= 100, "{name}: {line}");
        }
        commands.extend(command.get_subcommands().cloned());
    }
}

fn help_lines(command: &clap::Command) -> Vec<String> {
    let text = command.clone().term_width(100).render_long_help().to_string();
    text.lines().map(str::to_owned).collect()
}

#[test]
fn missing_features_are_not_advertised() {
    let fly = help(&["fly"], true);
    assert!(!fly.contains("--physics") && !fly.contains("fdm-loss"), "a headless flight has its own world");
    for command in [&[][..], &["serve"]] {
        assert!(
            help(command, true).contains("fdm-loss (fraction 0 to 1; 0.2): external link"),
            "{command:?}"
        );
    }
    assert!(!help(&["sitl"], true).contains("--fault"));
}
