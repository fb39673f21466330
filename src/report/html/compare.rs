//! The page of a comparison: of two firmwares, or of a log and its simulation.

use askama::Template;

use super::page::Page;
use super::{bounded, text};
use crate::geo::LocalFrame;
use crate::plan::feature::Feature;
use crate::report::compare::{Comparison, TableRow};
use crate::report::flight::{Detail, Figure, Verdict, ground};

#[derive(Debug, Template)]
#[template(path = "report/compare.html")]
struct Body {
    figures: Vec<Figure>,
    caption: String,
    names: [String; 2],
    rows: Vec<TableRow>,
    incomplete: Vec<String>,
}

/// Returns the page of a comparison, with a map under the tracks. `program` is the name of this program with its
/// version.
pub fn compare_page(
    comparison: &Comparison,
    backdrop: (&[Feature], &LocalFrame),
    command: Option<&str>,
    program: &str,
) -> String {
    let title = text::line(&comparison.title());
    let complete = comparison.is_complete();
    let verdict = Verdict {
        passed: Some(complete),
        word: match (comparison.has_log(), complete) {
            (false, true) => "both complete",
            (true, true) => "simulation complete",
            (_, false) => "not complete",
        }
        .to_owned(),
        reason: text::line(&comparison.flights()),
    };
    bounded(Detail::WHOLE, |detail| {
        let incomplete = comparison.incomplete();
        let body = Body {
            figures: comparison.figures(ground(backdrop.0, backdrop.1), detail),
            caption: comparison.notes(),
            names: comparison.names().map(text::line),
            rows: comparison.table().into_iter().take(detail.rows).collect(),
            incomplete: incomplete.iter().take(detail.rows).map(|line| text::line(line)).collect(),
        };
        // Writing to a string does not fail.
        let body = body.render().unwrap_or_default();
        let (subject, note) = if comparison.has_log() {
            (
                "A log and its simulation by betadeck",
                "Times are seconds after the AUTOPILOT switch. Places and altitudes of the log are as the craft measured them.",
            )
        } else {
            (
                "Two firmwares on one plan by betadeck",
                "Times are simulated seconds after the pilot switched the autopilot on. Places and altitudes are true.",
            )
        };
        let mut page = Page::new(subject, &title, &verdict, &body, program);
        page.command = command.and_then(text::command);
        page.note = note;
        page.html()
    })
}
