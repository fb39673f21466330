//! The help: all commands by topic, or one topic with a sentence for each of its commands.

use crate::text::did_you_mean;
use crate::ui::command::{self, short_name};
use crate::ui::model::action::{ACTIONS, Spec};

/// Returns the topic of a line that asks for help; empty for all.
pub(super) fn topic(line: &str) -> Option<&str> {
    let line = line.trim().trim_start_matches(':').trim_start();
    let (word, topic) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    matches!(word, "help" | "app.help").then_some(topic.trim())
}

/// Returns all topics with their commands, or the commands of one topic: a command, or the word before the dot.
pub(super) fn lines(topic: &str) -> Vec<String> {
    if topic.is_empty() {
        return overview();
    }
    let is_meant = |spec: &&Spec| spec.name == topic || group(spec) == topic || short_name(spec) == topic;
    let with_value = command::with_value(topic);
    let with_value = with_value.map(|known| format!("{} {} — {}", known.name, known.argument, known.help));
    let actions = ACTIONS.iter().filter(is_meant).map(|spec| format!("{} — {}", spec.name, spec.help));
    let found: Vec<String> = with_value.into_iter().chain(actions).collect();
    if !found.is_empty() {
        return found;
    }
    let words = command::all().map(|known| known.name);
    let words = words.chain(ACTIONS.iter().flat_map(|spec| [spec.name, group(spec), short_name(spec)]));
    let close = did_you_mean::closest(topic, words);
    let close = close.map_or_else(String::new, |close| format!("; did you mean {close}?"));
    vec![format!("There is no command or topic {topic}{close}"), "help lists all.".to_owned()]
}

fn overview() -> Vec<String> {
    let mut groups: Vec<&str> = ACTIONS.iter().map(group).collect();
    groups.sort_unstable();
    groups.dedup();
    let topics = groups.into_iter().map(|name| {
        let here = ACTIONS.iter().filter(|spec| group(spec) == name);
        format!("{name}: {}.", here.map(short_name).collect::<Vec<_>>().join(", "))
    });
    let with_value = command::all().map(|known| known.name).collect::<Vec<_>>().join(", ");
    topics
        .chain([
            format!("Commands with a value: {with_value}."),
            "A name is written whole, flight.fly, or as its last word, fly, where only one command has it."
                .to_owned(),
            "help NAME explains one of them: help flight, help fly, help wind.".to_owned(),
        ])
        .collect()
}

fn group(spec: &Spec) -> &'static str {
    spec.name.split_once('.').map_or(spec.name, |(group, _)| group)
}
