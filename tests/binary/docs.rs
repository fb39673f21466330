//! Every command that a page shows is run, or read by the same parser where it needs what a test does not have.

mod extract;

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

use betadeck::args::{self, Layers};
use clap::error::ErrorKind;

use self::extract::{Shown, commands, is_screen, pages};
use crate::support::{PROGRAM, Sandbox, plan};

/// Words of the pages that stand for something else, and an example of it.
const PLACEHOLDERS: [(&str, &str); 8] = [
    ("COMMAND", "fly"),
    ("FILE", "my-test.toml"),
    ("NEW", "new.elf"),
    ("OLD", "old.elf"),
    ("PATH", "outside.elf"),
    ("PLACE", "tcp:127.0.0.1:5761"),
    ("PLAN", "square"),
    ("…", "tcp:127.0.0.1:5761"),
];

/// Programs of other people, which are not run here.
const OTHERS: [(&str, &str); 2] =
    [("cargo", "builds and tests this program"), ("cat", "hands a report to the CI service")];

/// Files for a firmware outside, which only have to be there.
const OUTSIDE: [&str; 3] = ["outside.elf", "new.elf", "old.elf"];

/// Commands that are only read, because they do not end by themselves or need what is not here.
fn why_only_read(words: &[String]) -> Option<&'static str> {
    let has = |name: &str| words.iter().any(|word| word == name);
    match words.get(1).map(String::as_str) {
        _ if has("--help") || has("--version") => None,
        _ if has("--firmware") || has("--betaloop") => Some("needs a firmware outside"),
        Some("serve" | "sitl") => Some("runs until it is ended, at fixed ports"),
        Some("open") => Some("needs a terminal"),
        Some("doctor") => Some("its exit code depends on the ports of this computer"),
        Some("check") if words.len() == 2 => Some("tests/scenarios flies all built-in scenarios"),
        Some("fly" | "plan" | "convert" | "completions" | "man" | "check" | "config" | "compare") => None,
        _ => Some("the screen, which needs a terminal"),
    }
}

/// A command as a shell takes it: without its comment, with examples in the place of placeholders.
fn filled_in(shown: &Shown) -> Result<String, String> {
    let text = shown.text.split(" #").next().unwrap_or_default().trim();
    let filled: Vec<String> = text
        .split(' ')
        .map(|word| {
            let is_placeholder =
                word == "…" || (!word.is_empty() && word.chars().all(|c| c.is_ascii_uppercase() || c == '_'));
            match PLACEHOLDERS.iter().find(|(name, _)| *name == word) {
                Some((_, example)) => Ok((*example).to_owned()),
                None if is_placeholder => Err(format!(
                    "{}: {word} stands for something; add an example of it to PLACEHOLDERS",
                    shown.place
                )),
                None => Ok(word.to_owned()),
            }
        })
        .collect::<Result<_, _>>()?;
    Ok(filled.join(" "))
}

/// The words of a line up to a redirection; single quotes hold words together.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (part, text) in line.split('\'').enumerate() {
        if part % 2 == 1 {
            words.push(text.to_owned());
        } else {
            words.extend(text.split_whitespace().map(str::to_owned));
        }
    }
    let end = words.iter().position(|word| ["<", ">", ">>", "|"].contains(&word.as_str()));
    words.truncate(end.unwrap_or(words.len()));
    words
}

/// The files that the pages name.
fn prepare(sandbox: &Sandbox) {
    let guide = std::fs::read_to_string(plan("guide-square.txt")).expect("the guide's block");
    for file in ["my-plan.txt", "diff.txt"] {
        sandbox.write(file, &guide);
    }
    let square = std::fs::read_to_string(plan("square.toml")).expect("the square");
    let scenario = sandbox.run(&["check", "--new", "my-plan.txt"]).exits(0).out;
    for folder in ["flight-tests", "tests", "obj/main"] {
        std::fs::create_dir_all(sandbox.path(folder)).expect("a writable directory");
    }
    for file in ["my-test.toml", "flight-tests/one.toml", "tests/one.toml"] {
        sandbox.write(file, &scenario.replace("my-plan.txt", &plan("guide-square.txt")));
    }
    for file in OUTSIDE {
        sandbox.write(file, "");
    }
    sandbox.write("my-plan.toml", &square);
}

/// Runs a command line in a shell, and says when it does not end as the page tells.
fn run(sandbox: &Sandbox, shown: &Shown, line: &str) -> Result<(), String> {
    // Pages name `config init` more than once, and it never replaces a file unasked.
    std::fs::remove_dir_all(sandbox.path(".config")).ok();
    // `convert` writes it, and never replaces a file unasked.
    if line.contains("convert ") && line.ends_with(" my-plan.toml") {
        std::fs::remove_file(sandbox.path("my-plan.toml")).ok();
    }
    let folder = Path::new(PROGRAM).parent().expect("a folder");
    let output = Command::new("/bin/sh")
        .args(["-c", line])
        .env_clear()
        .envs(sandbox.environment())
        .env("PATH", folder)
        .current_dir(sandbox.path("."))
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("{}: {error}", shown.place))?;
    let told = shown.text.split_once("exit code ").and_then(|(_, rest)| rest.get(..1)?.parse().ok());
    let code = output.status.code();
    if code == Some(told.unwrap_or(0)) || (!shown.in_block && code == Some(1)) {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    Err(format!("{}: exit code {code:?}\n{said}", shown.place))
}

/// Checks a command of a shell.
fn check_in_shell(sandbox: &Sandbox, shown: &Shown) -> Result<bool, String> {
    let mut line = filled_in(shown)?;
    let is_variable = |word: &String| {
        word.split_once('=').is_some_and(|(name, _)| name.chars().all(|c| c.is_ascii_uppercase() || c == '_'))
    };
    let words: Vec<String> = words(&line).into_iter().skip_while(is_variable).collect();
    let program = words.first().map(String::as_str).unwrap_or_default();
    if OTHERS.iter().any(|(name, _)| *name == program) {
        return Ok(false);
    }
    if program != "betadeck" {
        return Err(format!("{}: {program} is no program of OTHERS, and not betadeck", shown.place));
    }
    if !words.iter().any(|word| word == "--help" || word == "--version") {
        let arguments: Vec<OsString> = words.iter().map(OsString::from).collect();
        match args::parse(arguments, &Layers::default()) {
            Ok(_) => {}
            // In a sentence a command is named without its arguments; its help shows them.
            Err(error) if !shown.in_block && error.kind() == ErrorKind::MissingRequiredArgument => {
                line.push_str(" --help");
            }
            Err(error) => return Err(format!("{}: {error}", shown.place)),
        }
    }
    if !line.ends_with(" --help") && why_only_read(&words).is_some() {
        return Ok(false);
    }
    run(sandbox, shown, &line).map(|()| true)
}

#[test]
fn every_command_of_the_pages_is_understood_and_those_that_end_do_as_told() {
    let sandbox = Sandbox::new();
    prepare(&sandbox);
    let mut ran = 0;
    let mut wrong = Vec::new();
    for shown in pages().iter().flat_map(|page| commands(page)).filter(|shown| !is_screen(&shown.text)) {
        match check_in_shell(&sandbox, &shown) {
            Ok(was_run) => ran += usize::from(was_run),
            Err(problem) => wrong.push(problem),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(ran >= 30, "only {ran} commands");
}

/// Commands of the screen that a craft that stands disarmed refuses, and the words with which it does.
const REFUSED_ON_THE_GROUND: [(&str, &str); 2] = [
    (":flight.home", "Nothing to bring home: the craft is disarmed."),
    (":allow-changes", "The craft is simulated: changes need no permission."),
];

/// What was printed in answer to a line, without the events of the flight and the question at the end.
fn answer(sandbox: &Sandbox, line: &str) -> String {
    let input = format!("{line}\nquit\ny\n");
    let ran = sandbox.run_with(&["--plain", "--fresh", "--no-ports", "--speed=max"], &input);
    let is_event =
        |line: &str| line.split_once(" s  ").is_some_and(|(time, _)| time.trim().parse::<f64>().is_ok());
    let lines: Vec<&str> = ran.out.lines().chain(ran.err.lines()).filter(|line| !is_event(line)).collect();
    lines.join("\n")
}

/// Says why an answer is no consent to the command.
fn refusal<'a>(name: &str, answer: &'a str) -> Option<&'a str> {
    let refused_words = ["There is no ", "takes no argument", "###ERROR", "Write ", "more than one command"];
    let is_refusal = refused_words.iter().any(|word| answer.contains(word))
        // A wrong value of the world is answered with the word and the value in quotes.
        || answer.lines().any(|line| line.starts_with(&format!("{name} \"")));
    is_refusal.then_some(answer)
}

#[test]
fn every_command_of_the_pages_for_the_screen_is_taken() {
    let sandbox = Sandbox::new();
    let mut entered: Vec<String> = Vec::new();
    let mut wrong = Vec::new();
    for shown in pages().iter().flat_map(|page| commands(page)).filter(|shown| is_screen(&shown.text)) {
        if entered.contains(&shown.text) {
            continue;
        }
        entered.push(shown.text.clone());
        let line = match filled_in(&shown) {
            Ok(line) => line,
            Err(problem) => {
                wrong.push(problem);
                continue;
            }
        };
        let answer = answer(&sandbox, &line);
        let name = line.trim_start_matches(':').split([' ', '=']).next().unwrap_or_default();
        let expected = REFUSED_ON_THE_GROUND.iter().find(|(command, _)| *command == line);
        match (refusal(name, &answer), expected) {
            (_, Some((_, words))) if answer.contains(words) => {}
            (None, None) => {}
            _ => wrong.push(format!("{}: {answer}", shown.place)),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(entered.len() >= 10, "only {entered:?}");
}

#[test]
fn a_refused_line_of_the_screen_is_noticed() {
    let sandbox = Sandbox::new();
    for line in
        [":nonsense", ":wind 5@27x", ":set ap_l1_enabel=OFF", ":speed fast", ":fault teleport,90,90,0"]
    {
        let answer = answer(&sandbox, line);
        let name = line.trim_start_matches(':').split([' ', '=']).next().unwrap_or_default();
        assert!(refusal(name, &answer).is_some(), "{line}: {answer}");
    }
}
