//! The page of a programme of flights on two builds of a firmware.

use askama::Template;

use super::page::Page;
use super::{bounded, text};
use crate::report::flight::{Detail, Verdict};
use crate::report::lab::Lab;

/// A row of the changed measures.
#[derive(Debug)]
struct Row {
    kind: String,
    title: String,
    unit: &'static str,
    before: String,
    after: String,
    difference: String,
    flights: String,
    command: String,
}

/// A property that was broken.
#[derive(Debug)]
struct Property {
    text: String,
    command: String,
}

#[derive(Debug, Template)]
#[template(path = "report/lab.html")]
struct Body {
    rows: Vec<Row>,
    properties: Vec<Property>,
}

/// Returns the page of a programme. `program` is the name of this program with its version.
pub fn lab_page(lab: &Lab, command: Option<&str>, program: &str) -> String {
    let verdict = Verdict {
        passed: Some(!lab.is_worse()),
        word: if lab.is_worse() { "worse" } else { "not worse" }.to_owned(),
        reason: text::line(&format!("{} {}.", lab.verdict(), lab.flown())),
    };
    let title = text::line(&lab.title());
    bounded(Detail::WHOLE, |detail| {
        let shell =
            |open: Option<String>| open.as_deref().and_then(text::command).unwrap_or_default().to_owned();
        let rows = lab.findings().iter().take(detail.rows).map(|finding| Row {
            kind: finding.kind.to_string(),
            title: text::line(&finding.measure.title),
            unit: finding.measure.unit,
            before: format!("{:.2}", finding.typical[0]),
            after: format!("{:.2}", finding.typical[1]),
            difference: format!("{:+.2}", finding.difference),
            flights: format!("{} of {}", finding.agreeing, finding.differing),
            command: shell(lab.open(finding)),
        });
        let properties = lab.shown().take(detail.rows).map(|broken| Property {
            text: text::line(&lab.broken_line(broken)),
            command: shell(lab.open_broken(broken)),
        });
        let body = Body { rows: rows.collect(), properties: properties.collect() };
        // Writing to a string does not fail.
        let body = body.render().unwrap_or_default();
        let mut page =
            Page::new("A programme of flights on a firmware by betadeck", &title, &verdict, &body, program);
        page.command = command.and_then(text::command);
        page.note = "Measured from truth, in simulated time. Before: the median of the flights that differ; after: that with the difference.";
        page.html()
    })
}
