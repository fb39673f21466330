//! Finds the commands that a page shows: in its blocks and in its inline code.

/// A command of a page.
#[derive(Debug, Clone)]
pub(super) struct Shown {
    /// The page, the number of the line, and the command: for messages.
    pub(super) place: String,
    /// The command as the page has it.
    pub(super) text: String,
    /// `true` in a block, where its exit code is 0 unless the comment beside it says otherwise.
    pub(super) in_block: bool,
}

/// README.md, the page about plans, and every page in `docs/`.
pub(super) fn pages() -> Vec<String> {
    let root = test_support::path("");
    let docs = std::fs::read_dir(root.join("docs")).expect("the pages");
    let names = docs.map(|entry| entry.expect("a file").file_name().to_string_lossy().into_owned());
    let mut pages: Vec<String> =
        names.filter(|name| name.ends_with(".md")).map(|name| format!("docs/{name}")).collect();
    pages.extend(["README.md".to_owned(), "plans/README.md".to_owned()]);
    pages.sort();
    pages
}

/// Returns the commands of a page for a shell and for the screen, in their order.
pub(super) fn commands(page: &str) -> Vec<Shown> {
    let all = read(page, &text_of(page));
    all.into_iter().filter(|shown| shown.in_block || is_command(&shown.text)).collect()
}

/// Returns the inline code of all pages.
pub(super) fn spans() -> Vec<Shown> {
    let all = pages().into_iter().flat_map(|page| read(&page, &text_of(&page)));
    all.filter(|shown| !shown.in_block).collect()
}

fn text_of(page: &str) -> String {
    let path = test_support::path(page);
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{page}: {error}"))
}

/// Returns the commands in the blocks of a page, and all of its inline code.
fn read(page: &str, text: &str) -> Vec<Shown> {
    let mut found = Vec::new();
    let mut language: Option<&str> = None;
    // The inline code that is open, which may go on in the next line, and where it began.
    let mut span: Option<(usize, String)> = None;
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let mut push = |number: usize, text: &str, in_block| {
            let place = format!("{page}:{number}: {text}");
            found.push(Shown { place, text: text.to_owned(), in_block });
        };
        if let Some(fence) = line.trim_start().strip_prefix("```") {
            language = if language.is_some() { None } else { Some(fence.trim()) };
            span = None;
        } else if let Some(language) = language {
            if let Some(command) = of_block(language, line.trim()) {
                push(number, command, true);
            }
        } else if line.trim().is_empty() {
            span = None;
        } else {
            for (part, text) in line.split('`').enumerate() {
                if part > 0 {
                    span = match span.take() {
                        None => Some((number, String::new())),
                        Some((began, code)) => {
                            push(began, &code, false);
                            None
                        }
                    };
                }
                if let Some((began, code)) = &mut span {
                    if *began != number && part == 0 {
                        code.push(' ');
                    }
                    code.push_str(text.trim_start_matches(if part == 0 { ' ' } else { '\0' }));
                }
            }
        }
    }
    found
}

/// The command in a line of a block.
fn of_block<'a>(language: &str, line: &'a str) -> Option<&'a str> {
    match language {
        _ if line.is_empty() => None,
        "sh" => Some(line),
        "console" if line.starts_with("$ ") => Some(&line[2..]),
        "yaml" if line.contains("run:") => line.split_once("run:").map(|(_, command)| command.trim()),
        _ => {
            let line = line.trim_start_matches(['#', '$', ' ']);
            (line.starts_with("betadeck ") || is_screen(line)).then_some(line)
        }
    }
}

fn is_command(code: &str) -> bool {
    code.starts_with("betadeck ") || is_screen(code)
}

/// A line that is entered behind `:` on the screen.
pub(super) fn is_screen(code: &str) -> bool {
    code.strip_prefix(':').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_alphabetic()))
}

#[test]
fn commands_are_found_in_blocks_in_spans_and_across_lines() {
    let page = "`:wind 5@270` and `betadeck\nopen x` or `q`: `betadeck`\n\n```sh\ncargo x\n```\n\
                ```yaml\n  - run: betadeck check\n```\n```console\n$ betadeck a\n  betadeck b\nsays\n```\n`:`\n";
    let found = read("p", page).into_iter().filter(|shown| shown.in_block || is_command(&shown.text));
    let found: Vec<String> = found.map(|shown| shown.place).collect();
    assert_eq!(
        found,
        [
            "p:1: :wind 5@270",
            "p:1: betadeck open x",
            "p:5: cargo x",
            "p:8: betadeck check",
            "p:11: betadeck a",
            "p:12: betadeck b",
        ]
    );
}
