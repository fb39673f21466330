//! The goals of a campaign as a JUnit file: one testcase for each.

use super::Reported;
use super::sentences::{found, success};
use crate::campaign::GoalOutcome;
use crate::report::xml::escaped;

/// Returns the file. Without goals it has one testcase: every flight meets its expectations.
pub fn answer_junit(reported: &Reported<'_>) -> String {
    let answer = reported.answer;
    let cases: Vec<(String, Option<String>)> = if answer.goals.is_empty() {
        let problem = (!answer.is_met()).then(|| success(reported));
        vec![("every flight".to_owned(), problem)]
    } else {
        let case = |judged: &crate::campaign::JudgedGoal| {
            let problem = (judged.outcome != GoalOutcome::Met).then(|| found(judged));
            (judged.goal.label.clone(), problem)
        };
        answer.goals.iter().map(case).collect()
    };
    let failures = cases.iter().filter(|(_, problem)| problem.is_some()).count();
    let count = cases.len();
    let name = escaped(reported.name);
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"betadeck\" tests=\"{count}\" failures=\"{failures}\">\n  <testsuite name=\"{name}\" tests=\"{count}\" failures=\"{failures}\">\n"
    );
    for (label, problem) in cases {
        let head = format!("    <testcase classname=\"{name}\" name=\"{}\"", escaped(&label));
        match problem {
            None => text.push_str(&format!("{head}/>\n")),
            Some(problem) => text.push_str(&format!(
                "{head}>\n      <failure message=\"{}\"/>\n    </testcase>\n",
                escaped(&problem)
            )),
        }
    }
    text.push_str("  </testsuite>\n</testsuites>\n");
    text
}
