//! The page of a campaign: its answer with pictures.

mod figures;
mod rows;

use askama::Template;

use super::page::{self, Page};
use super::{bounded, text};
use crate::campaign::Answer;
use crate::report::campaign::{Reported, sentences};
use crate::report::flight::{Detail, Figure, Verdict};
use rows::{CauseRow, DistributionRow, GoalRow, WorstRow};

/// A page about the flights of a campaign.
#[derive(Debug, Clone)]
pub struct CampaignPage<'a> {
    /// The kind of the page in a few words.
    pub kind: &'a str,
    pub reported: &'a Reported<'a>,
    /// The verdict, if it is another than that of the expectations.
    pub verdict: Option<Verdict>,
    /// The command that gives the answer again.
    pub command: Option<&'a str>,
}

#[derive(Debug, Template)]
#[template(path = "report/campaign.html")]
struct Body {
    goals: Vec<GoalRow>,
    sentences: Vec<String>,
    causes: Vec<CauseRow>,
    /// The pictures of the failures.
    explained: Vec<Figure>,
    rows: Vec<DistributionRow>,
    rows_note: String,
    distributions: Vec<Figure>,
    versus: Vec<String>,
    worst: Vec<WorstRow>,
    worst_title: &'static str,
    worst_note: &'static str,
}

/// Returns the page. `program` is the name of this program with its version.
pub fn campaign_page(campaign: &CampaignPage<'_>, program: &str) -> String {
    let CampaignPage { kind, reported, .. } = campaign;
    let title = text::line(reported.name);
    let verdict = campaign.verdict.clone().unwrap_or_else(|| verdict(reported.answer));
    let verdict = page::printable_verdict(&verdict);
    bounded(Detail::WHOLE, |detail| {
        // Writing to a string does not fail.
        let body = body(reported, detail).render().unwrap_or_default();
        let mut page = Page::new(kind, &title, &verdict, &body, program);
        page.facts = page::facts(&facts(reported));
        page.command = campaign.command.and_then(text::command);
        page.again = "Answer it again";
        page.note = "Each flight has its inputs and its seed from its number alone. Metrics are true values. \
                     docs/campaigns.md explains the statistics.";
        page.html()
    })
}

fn body(reported: &Reported<'_>, detail: Detail) -> Body {
    let answer = reported.answer;
    let lines = |lines: Vec<String>| -> Vec<String> {
        let lines = lines.iter().map(|line| text::line(line.trim())).filter(|line| !line.is_empty());
        lines.take(detail.rows).collect()
    };
    let versus = answer.versus.as_ref().map(|versus| sentences::comparison(reported, versus));
    let all_passed = answer.worst.iter().all(|worst| worst.has_passed);
    Body {
        goals: rows::goals(answer, detail.rows),
        sentences: lines(said(answer)),
        causes: rows::causes(answer),
        explained: figures::of_failures(answer, detail),
        rows: rows::distributions(answer, detail.rows),
        rows_note: rows::distributions_note(answer),
        distributions: figures::of_distributions(answer, detail),
        versus: lines(versus.unwrap_or_default()),
        worst: rows::worst(reported),
        worst_title: if all_passed { "The tightest flights" } else { "The worst flights" },
        worst_note: match reported.run {
            Some(_) => "The command flies the flight again and shows it on the screen.",
            None => {
                "The flights were not kept. With --out RUN.jsonl, betadeck open RUN.jsonl:N shows flight N."
            }
        },
    }
}

/// Returns the sentences of the answer that no table has.
fn said(answer: &Answer) -> Vec<String> {
    let mut said = vec![format!("{}.", sentences::share(&answer.success))];
    said.extend(sentences::results(answer));
    said.extend(sentences::not_flown(answer));
    said.extend(sentences::touchdown(answer));
    // The causes are a table, the sentence that there is none is not.
    let is_explained = answer.causes.of_failures.iter().any(|cause| cause.is_real);
    let causes = sentences::causes(&answer.causes);
    said.extend(
        causes
            .into_iter()
            .filter(|line| !(is_explained && (line.starts_with("What explains") || line.starts_with("  ")))),
    );
    said
}

fn verdict(answer: &Answer) -> Verdict {
    let passed = (answer.success.judged > 0).then(|| answer.is_met() && answer.is_whole());
    let word = match (passed, answer.goals.is_empty(), answer.is_whole()) {
        (None, ..) => "nothing was judged",
        (Some(true), true, _) => "every flight succeeded",
        (Some(true), false, _) => "as expected",
        (Some(false), _, false) => "not finished",
        (Some(false), ..) if answer.success.not_flown > 0 => "some flights could not be flown",
        (Some(false), true, _) => "some flights failed",
        (Some(false), false, _) => "not as expected",
    };
    Verdict { passed, word: word.to_owned(), reason: sentences::share(&answer.success) }
}

fn facts(reported: &Reported<'_>) -> Vec<(String, String)> {
    let answer = reported.answer;
    let flights = match answer.wanted {
        wanted if wanted == answer.flown => wanted.to_string(),
        wanted => format!("{} of {wanted}", answer.flown),
    };
    let mut facts = vec![("flights", flights)];
    facts.extend(reported.design.clone().map(|design| ("design", design)));
    facts.extend(reported.shard.map(|shard| ("shard", shard.to_string())));
    facts.push(("simulated", format!("{:.0} s", answer.flown_s)));
    facts.push(("flown by", format!("betadeck {}", reported.version)));
    facts.extend(reported.run.map(|run| ("file of the flights", run.to_owned())));
    if let Some([a, b]) = &reported.sides {
        facts.extend([("side A", a.clone()), ("side B", b.clone())]);
    }
    facts.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

#[cfg(test)]
mod tests;
