//! The frame of all pages.

use askama::Template;

use super::text;
use crate::report::flight::Verdict;
use crate::report::plot::Colour;

/// The stylesheet, without the colours of the pictures.
const STYLE: &str = include_str!("../../../templates/report/style.css");

/// The custom properties of the stylesheet on a dark page.
const DARK: &str = "--paper: #0d1117; --card: #161b22; --ink: #e6edf3; --quiet: #9da7b3; --line: #30363d; --good: #56d364; \
                    --good-paper: #12261e; --bad: #ff9a93; --bad-paper: #2d1214; --plain-paper: #21262d; --code: #161b22;";

/// A page.
#[derive(Debug, Template)]
#[template(path = "report/page.html")]
pub(super) struct Page<'a> {
    /// The kind of the report in a few words.
    pub(super) kind: &'a str,
    pub(super) title: &'a str,
    pub(super) verdict: &'a Verdict,
    pub(super) facts: Vec<Fact>,
    /// The content as HTML.
    pub(super) body: &'a str,
    pub(super) command: Option<&'a str>,
    /// The heading of the command.
    pub(super) again: &'static str,
    /// A sentence below the content.
    pub(super) note: &'a str,
    pub(super) program: &'a str,
    style: String,
}

/// A fact at the top of a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fact {
    pub(super) name: String,
    pub(super) value: String,
}

impl<'a> Page<'a> {
    /// Creates a page without facts, command and note.
    pub(super) fn new(
        kind: &'a str,
        title: &'a str,
        verdict: &'a Verdict,
        body: &'a str,
        program: &'a str,
    ) -> Self {
        Self {
            kind,
            title,
            verdict,
            facts: Vec::new(),
            body,
            command: None,
            again: "Fly it again",
            note: "",
            program,
            style: style(),
        }
    }

    /// Returns the document.
    pub(super) fn html(&self) -> String {
        // Writing to a string does not fail.
        self.render().unwrap_or_default()
    }
}

/// Returns facts for a page.
pub(super) fn facts(facts: &[(String, String)]) -> Vec<Fact> {
    let fact = |(name, value): &(String, String)| Fact { name: text::line(name), value: text::line(value) };
    facts.iter().map(fact).collect()
}

/// Returns the stylesheet with the colours of the pictures on a dark page. On paper they stay as they are.
fn style() -> String {
    let mut style = STYLE.to_owned();
    style.push_str("@media screen and (prefers-color-scheme: dark) {\n  :root { ");
    style.push_str(DARK);
    style.push_str(" }\n");
    for colour in Colour::ALL {
        let (light, dark) = (colour.light(), colour.dark());
        style.push_str(&format!(
            "  svg [fill=\"{light}\"] {{ fill: {dark}; }} svg [stroke=\"{light}\"] {{ stroke: {dark}; }}\n"
        ));
    }
    style.push_str("}\n");
    style
}

/// Returns a verdict of printable texts.
pub(super) fn printable_verdict(verdict: &Verdict) -> Verdict {
    Verdict { passed: verdict.passed, word: text::line(&verdict.word), reason: text::line(&verdict.reason) }
}
