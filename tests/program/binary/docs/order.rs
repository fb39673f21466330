//! The files of the commands of a page, from `betadeck examples` on and in the order printed.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use super::extract::{commands, is_screen, pages};
use super::filled_in;
use super::shell::words;
use crate::binary::support::Sandbox;

/// Options whose value is a file that the command writes.
const OUTPUTS: [&str; 14] = [
    "--json",
    "--csv",
    "--gpx",
    "--kml",
    "--geojson",
    "--record",
    "--report",
    "--markdown",
    "--blackbox",
    "--junit",
    "--svg",
    "--out",
    "--tlog",
    ">",
];

/// The extensions of files that a command reads.
const EXTENSIONS: [&str; 9] = ["toml", "txt", "plan", "bbl", "BFL", "flight", "jsonl", "geojson", "csv"];

/// Files that only their owner has.
const OF_THE_USER: [&str; 1] = ["~/betaloop/config.txt"];

/// Returns the folder with the files of `betadeck examples`, which is made once.
pub(super) fn examples() -> &'static Path {
    static MADE: OnceLock<Sandbox> = OnceLock::new();
    let sandbox = MADE.get_or_init(|| {
        let sandbox = Sandbox::new();
        sandbox.run(&["examples", "try"]).exits(0);
        sandbox
    });
    // A static is never dropped, and this one is small.
    static PATH: OnceLock<PathBuf> = OnceLock::new();
    PATH.get_or_init(|| sandbox.path("try"))
}

/// Returns the paths of all files in a folder, relative to it, and of its folders with a slash.
pub(super) fn files(folder: &Path) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for entry in std::fs::read_dir(folder).expect("a readable folder") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            found.extend(files(&entry.path()).into_iter().map(|file| format!("{name}/{file}")));
            found.insert(format!("{name}/"));
        } else {
            found.insert(name);
        }
    }
    found
}

/// Returns what is wrong with the files of a command, and adds those that it writes to `there`.
fn missing(words: &[String], there: &mut BTreeSet<String>) -> Vec<String> {
    let mut wrong = Vec::new();
    let mut written = Vec::new();
    let is_convert = words.get(1).is_some_and(|word| word == "convert");
    let mut places = 0;
    for (index, word) in words.iter().enumerate().skip(1) {
        let before = words[index - 1].as_str();
        places += usize::from(!word.starts_with('-') && !before.starts_with("--"));
        if OUTPUTS.contains(&before) {
            written.push(word.clone());
        } else if is_convert && places == 3 && !before.starts_with("--") && word.contains('.') {
            if there.contains(word) && !words.iter().any(|word| word == "--force") {
                wrong.push(format!("{word} exists, and convert replaces no file"));
            }
            written.push(word.clone());
        } else if let Some(file) = read_file(word) {
            let is_there = match file.split_once('*') {
                Some((start, end)) => there.iter().any(|name| name.starts_with(start) && name.ends_with(end)),
                None => there.contains(file),
            };
            if !is_there && !OF_THE_USER.contains(&file) {
                wrong.push(format!("nothing before has written {file}"));
            }
        }
    }
    there.extend(written);
    wrong
}

/// Returns the file or folder that a word of a command names.
fn read_file(word: &str) -> Option<&str> {
    // A flight of a campaign is named with its number.
    let file = word.split_once(".jsonl:").map_or(word, |(name, _)| &word[..name.len() + ".jsonl".len()]);
    let extension = file.rsplit_once('.').map_or("", |(_, extension)| extension);
    let is_folder = file.ends_with('/') && !file.starts_with('-');
    (!file.contains('=') && (is_folder || EXTENSIONS.contains(&extension))).then_some(file)
}

#[test]
fn the_files_of_each_command_are_there_when_a_page_is_read_from_its_top() {
    let mut wrong = Vec::new();
    let mut seen = 0;
    for page in pages() {
        let mut there = files(examples());
        for shown in commands(&page).into_iter().filter(|shown| !is_screen(&shown.text)) {
            let line = filled_in(&shown).unwrap_or_else(|problem| panic!("{problem}"));
            let words = words(&line.replace('<', " ").replace('>', " > "));
            if !words.iter().any(|word| word == "betadeck") {
                continue;
            }
            seen += 1;
            let problems = missing(&words, &mut there);
            wrong.extend(problems.into_iter().map(|problem| format!("{}: {problem}", shown.place)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen > 100, "only {seen} commands");
}

#[test]
fn the_examples_are_what_the_pages_print_and_no_file_is_replaced() {
    let example = |name: &str| std::fs::read_to_string(examples().join(name)).expect("an example");
    for (page, name) in [("docs/scenarios.md", "my-test.toml"), ("docs/campaigns.md", "my-campaign.toml")] {
        let path = test_support::path(page);
        let page_text = std::fs::read_to_string(path).expect("a page");
        assert!(page_text.contains(&example(name)), "{page} prints another {name}");
    }
    let sandbox = Sandbox::new();
    sandbox.write("my-plan.toml", "mine");
    let ran = sandbox.run(&["examples"]).exits(3);
    assert!(ran.err.contains("has my-plan.toml already, and no file is replaced"), "{}", ran.err);
    assert_eq!((sandbox.read("my-plan.toml"), sandbox.names().len()), ("mine".to_owned(), 1));
}

#[test]
fn a_file_that_nothing_wrote_is_missed() {
    let line = |text: &str| words(&text.replace('>', " > "));
    let mut there = BTreeSet::from(["a.toml".to_owned(), "tests/".to_owned()]);
    for (text, problems) in [
        ("betadeck fly b.toml --csv c.csv", 1),
        ("betadeck check tests/ tests/x/", 1),
        ("betadeck convert a.toml b.txt", 0),
        ("betadeck convert a.toml b.txt", 1),
        ("betadeck check --new b.txt > d.toml", 0),
        ("betadeck campaign d.toml --out r.jsonl", 0),
        ("betadeck open r.jsonl:17", 0),
        ("betadeck campaign merge q-*.jsonl --out s.jsonl", 1),
    ] {
        assert_eq!(missing(&line(text), &mut there).len(), problems, "{text}");
    }
}
