//! Reads the exchanges of `cli.md` and compares replies with them.

/// One line of an expected reply.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Line {
    /// The text, in which `{word}` matches anything.
    pub(crate) text: String,
    /// The line end.
    pub(crate) end: &'static str,
}

/// A typed line and its reply.
#[derive(Debug, Clone)]
pub(crate) struct Exchange {
    pub(crate) number: usize,
    /// The line that is typed.
    pub(crate) input: String,
    /// The lines of the reply.
    pub(crate) lines: Vec<Line>,
}

/// The text in place of lines that are left out.
const GAP: &str = "<…>";

/// Returns all exchanges in order.
pub(crate) fn exchanges(document: &str) -> Vec<Exchange> {
    let mut found = Vec::new();
    let mut lines = document.lines();
    while let Some(line) = lines.next() {
        let Some(title) = line.strip_prefix("### ") else { continue };
        let (number, rest) = title.split_once(" `").expect("a number and an input");
        let (input, _mark) = rest.rsplit_once("` — ").expect("an input and a mark");
        lines.by_ref().find(|line| *line == "```text").expect("a block");
        let body = lines.by_ref().take_while(|line| *line != "```").filter(|line| *line != "<CLOSED>");
        let lines = body.filter(|line| *line != "<NOTHING>").map(parse_line).collect();
        found.push(Exchange { number: number.parse().expect("a number"), input: input.to_owned(), lines });
    }
    found
}

fn parse_line(line: &str) -> Line {
    let (line, end) = if let Some(line) = line.strip_suffix("<NOEOL>") {
        (line, "")
    } else if let Some(line) = line.strip_suffix("<LF>") {
        (line, "\n")
    } else {
        (line, "\r\n")
    };
    let text = line.strip_suffix("<SP>").map_or_else(|| line.to_owned(), |line| format!("{line} "));
    Line { text, end }
}

/// Panics unless a reply matches the expected one.
#[track_caller]
pub(crate) fn assert_matches(expected: &Exchange, reply: &str) {
    let actual = split(reply);
    let mut wanted = expected.lines.iter().peekable();
    let mut found = actual.iter().peekable();
    while let Some(line) = wanted.next() {
        if line.text == GAP {
            let Some(next) = wanted.peek() else { return };
            while found.peek().is_some_and(|line| !line_matches(next, line)) {
                found.next();
            }
            continue;
        }
        let actual = found.next();
        assert!(
            actual.is_some_and(|actual| line_matches(line, actual)),
            "exchange {} `{}`: wanted {line:?}, found {actual:?} in\n{reply}",
            expected.number,
            expected.input
        );
    }
    let left = found.next();
    assert!(left.is_none(), "exchange {} `{}`: unexpected {left:?}", expected.number, expected.input);
}

fn split(reply: &str) -> Vec<Line> {
    reply
        .split_inclusive('\n')
        .map(|line| {
            let (text, end) = match (line.strip_suffix("\r\n"), line.strip_suffix('\n')) {
                (Some(text), _) => (text, "\r\n"),
                (None, Some(text)) => (text, "\n"),
                (None, None) => (line, ""),
            };
            Line { text: text.to_owned(), end }
        })
        .collect()
}

fn line_matches(wanted: &Line, actual: &Line) -> bool {
    if wanted.end != actual.end {
        return false;
    }
    // Measured figures of the scheduler: only their columns must match.
    if ["Check Functions", "Total  "].iter().any(|head| wanted.text.starts_with(head)) {
        let mask =
            |text: &str| text.chars().map(|c| if c.is_ascii_digit() { '0' } else { c }).collect::<String>();
        return mask(&wanted.text) == mask(&actual.text);
    }
    let mut rest = actual.text.as_str();
    let mut parts = wanted.text.split('{');
    let Some(first) = parts.next() else { return false };
    let Some(after) = rest.strip_prefix(first) else { return false };
    rest = after;
    for part in parts {
        let Some((_, literal)) = part.split_once('}') else { return wanted.text == actual.text };
        if literal.is_empty() {
            return true;
        }
        let Some(at) = rest.find(literal) else { return false };
        rest = &rest[at + literal.len()..];
    }
    rest.is_empty()
}
