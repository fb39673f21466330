//! The choice of graphs without a screen.

use super::{Answered, list};
use crate::ui::acts::named_signal::Named;
use crate::ui::app_state::AppState;
use crate::ui::model::graphs::PLOTS;
use crate::ui::panel::graphs::choices;
use crate::ui::popup::signal_list;

/// The greatest number of signals listed for a word.
const MOST: usize = 12;

fn shown(is_shown: bool) -> &'static str {
    if is_shown { ", shown" } else { "" }
}

/// Returns the list of plots. The differences of two flights come after them.
pub(super) fn plots(state: &AppState) -> Vec<String> {
    let names = PLOTS.iter().map(|plot| plot.name.to_owned());
    let names = names.chain(PLOTS.iter().map(|plot| format!("difference of {}", plot.name)));
    let rows = names.take(choices(&state.shared)).enumerate();
    let rows = rows.map(|(at, name)| format!("{} {name}{}", at + 1, shown(state.shared.graphs.is_shown(at))));
    list("Which graph to show or hide?".to_owned(), rows)
}

/// Shows or hides the plot with a number.
pub(super) fn choose_plot(state: &mut AppState, line: &str) -> Result<Answered, String> {
    let count = choices(&state.shared);
    let at = line.parse::<usize>().ok().and_then(|number| number.checked_sub(1)).filter(|at| *at < count);
    let at = at.ok_or_else(|| format!("Answer a number from 1 to {count}."))?;
    state.shared.graphs.toggle(at);
    state.popups.pop();
    Ok(Answered::default())
}

/// Returns the signals that are shown by name, and how to choose one.
pub(super) fn signals(state: &AppState) -> Vec<String> {
    let graphs = &state.shared.graphs;
    let all = Named::all(&state.shared).into_iter();
    let shown: Vec<&str> = all.map(Named::name).filter(|name| graphs.shows_series(name)).collect();
    let shown = if shown.is_empty() { "none".to_owned() } else { shown.join(", ") };
    vec![
        format!("Signals shown by name: {shown}."),
        "Type a name to show or hide a signal, part of a name or description to list matches, or an empty line to finish."
            .to_owned(),
    ]
}

/// Shows or hides the signal with this name.
///
/// # Errors
/// Returns the signals that match if none has the name.
pub(super) fn choose_signal(state: &mut AppState, line: &str) -> Result<Answered, String> {
    let shared = &mut state.shared;
    if let Some(name) = Named::find(shared, line).map(|named| named.name().to_owned()) {
        shared.graphs.toggle_series(&name);
        return Ok(Answered::default());
    }
    let found = signal_list::found(shared, line);
    if found.is_empty() {
        return Err(format!("No signal matches {line}; fewer letters find more."));
    }
    let rows = found.iter().take(MOST).map(|named| match named.help(shared) {
        Some(help) => format!("{} ({help})", named.name()),
        None => named.name().to_owned(),
    });
    let more = found.len().saturating_sub(MOST);
    let more = if more > 0 { format!(", {more} more") } else { String::new() };
    Err(format!("Signals with {line}: {}{more}.", rows.collect::<Vec<_>>().join(", ")))
}
