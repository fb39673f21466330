//! The plan without a screen: the table with its legs, every finding with its fix, the differences from the craft, the
//! estimate.

use super::{nothing_planned, table};
use crate::plan::edit::fix::fix;
use crate::ui::acts::{estimate_line, findings};
use crate::ui::model::action::{Action, EditAction, spec_of};
use crate::ui::panel::in_words::{WIDTH, drawn};
use crate::ui::shared::Shared;

/// Returns the plan as lines of text.
pub(super) fn lines(state: &Shared) -> Vec<String> {
    let waypoints = &state.plan().waypoints;
    if waypoints.is_empty() {
        return nothing_planned(state).to_vec();
    }
    let findings = findings::findings(state);
    let rows = u16::try_from(waypoints.len()).unwrap_or(u16::MAX).saturating_add(1);
    let mut lines = drawn(state, rows, |area, buffer| {
        table::draw(state, &findings, area, buffer);
    });
    let home = findings::home(state);
    let name = spec_of(Action::Edit(EditAction::Fix)).map_or("", |spec| spec.name);
    for finding in &findings {
        let mark = if finding.is_refusal() { "✗" } else { "▲" };
        let fix = home.and_then(|home| fix(state.editor.document(), finding, home));
        let fix = fix.map(|fix| format!(" — {name} on its row: {}", fix.title)).unwrap_or_default();
        lines.push(state.units.in_sentence(format!("{mark} {finding}{fix}")));
    }
    lines.extend((0..waypoints.len()).filter_map(|index| table::difference(state, index)));
    lines.extend(estimate_line::lines(state, WIDTH).iter().map(|line| line.to_string().trim().to_owned()));
    lines
}
