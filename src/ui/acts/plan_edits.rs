//! The actions of the plan editor.

use crossterm::event::{KeyCode, KeyEvent};
use nalgebra::Vector2;

use super::findings;
use crate::geo::{GroundPlane, LatLon, distance_bearing};
use crate::plan::differences::differences;
use crate::plan::edit::PlanDocument;
use crate::plan::format::{NoteKind, PlanFile};
use crate::plan::{Altitude, FlightPlan, HoldPattern, Seconds, Waypoint, WaypointType};
use crate::ui::model::action::{Action, EditAction};
use crate::ui::model::editor::{Browser, Column, EditorPopup, Form, FormKind, Purpose, Question};
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::files::FileRequest;
use crate::ui::model::plan_id::PlanId;
use crate::ui::shared::Shared;

/// The distance from the last waypoint to a new one, m.
const NEXT_LEG_M: f64 = 50.0;
/// The altitude of the first waypoint, m.
const FIRST_ALT_M: f64 = 20.0;

/// Handles a key while a cell is typed.
pub(in crate::ui) fn field_key(state: &mut Shared, event: KeyEvent) -> Vec<Effect> {
    match event.code {
        KeyCode::Enter => return state.editor.end_typing(state.units),
        KeyCode::Esc => {
            state.editor.cancel();
        }
        KeyCode::Tab | KeyCode::BackTab => {
            let effects = state.editor.end_typing(state.units);
            if state.editor.field().is_none() {
                state.editor.move_cursor(0, if event.code == KeyCode::Tab { 1 } else { -1 });
                state.editor.begin_typing(state.units).ok();
            }
            return effects;
        }
        _ => {
            if let Some(field) = state.editor.field_mut() {
                field.text.key(event);
                field.problem = None;
            }
        }
    }
    Vec::new()
}

fn insert_key(state: &Shared) -> String {
    state.key(Action::Edit(EditAction::Insert))
}

/// Handles Enter on a cell: chooses the next name, or begins typing a number.
pub(in crate::ui) fn edit_cell(state: &mut Shared) -> Vec<Effect> {
    match state.editor.column() {
        Column::Type | Column::Pattern => nudge(state, 1),
        _ => {
            if state.plan().waypoints.is_empty() {
                let text = format!("There is no waypoint to edit: `{}` inserts one.", insert_key(state));
                state.notify(Severity::Warn, text);
            } else if let Err(sentence) = state.editor.begin_typing(state.units) {
                state.notify(Severity::Warn, sentence);
            }
            Vec::new()
        }
    }
}

pub(in crate::ui) fn nudge(state: &mut Shared, steps: i32) -> Vec<Effect> {
    let column = state.editor.column();
    let kind = state.editor.document().plan.waypoints.get(state.editor.row()).map(|wp| wp.kind);
    match kind {
        Some(kind) if !column.is_used(kind) => {
            state.only_notify(Severity::Warn, format!("A {kind} has no {}.", column.name()))
        }
        _ => state.editor.nudge(steps, state.units),
    }
}

/// Returns the waypoint that `i` inserts: like the one under the cursor, one leg farther on.
pub(in crate::ui) fn next_waypoint(state: &Shared) -> Option<Waypoint> {
    let waypoints = &state.editor.document().plan.waypoints;
    let row = state.editor.row();
    let placed = |wp: &&Waypoint| wp.kind.uses_position();
    let at = waypoints.get(..=row).and_then(|before| before.iter().rposition(|wp| placed(&wp)));
    let Some((at, last)) = at.and_then(|at| Some((at, waypoints.get(at)?))) else {
        let home = findings::home(state)?;
        return Some(Waypoint {
            position: home,
            altitude: Altitude::above_home(FIRST_ALT_M),
            ..Waypoint::default()
        });
    };
    let from =
        waypoints[..at].iter().rev().find(placed).map(|wp| wp.position).or_else(|| findings::home(state));
    let bearing = from.map_or(0.0, |from| distance_bearing(from, last.position).1);
    let onward = Vector2::new(bearing.cos(), bearing.sin()) * NEXT_LEG_M;
    let kind = if last.kind == WaypointType::Flyby { WaypointType::Flyby } else { WaypointType::Flyover };
    Some(Waypoint {
        position: GroundPlane::new(last.position).to_position(onward),
        duration: Seconds::default(),
        pattern: HoldPattern::None,
        kind,
        ..*last
    })
}

pub(in crate::ui) fn insert(state: &mut Shared) -> Vec<Effect> {
    match next_waypoint(state) {
        Some(waypoint) => insert_waypoint(state, waypoint),
        None => state
            .only_notify(Severity::Warn, "Home is not known yet: wait for the GPS fix, or paste a waypoint."),
    }
}

/// Inserts a waypoint after the cursor.
pub(in crate::ui) fn insert_waypoint(state: &mut Shared, waypoint: Waypoint) -> Vec<Effect> {
    let inserted = state.editor.insert("insert a waypoint", &[waypoint]);
    reported(state, inserted)
}

pub(in crate::ui) fn duplicate(state: &mut Shared) -> Vec<Effect> {
    let Some(waypoint) = state.editor.document().plan.waypoints.get(state.editor.row()).copied() else {
        return Vec::new();
    };
    let inserted = state.editor.insert("duplicate", &[waypoint]);
    reported(state, inserted)
}

pub(in crate::ui) fn copy(state: &mut Shared) -> Vec<Effect> {
    let Some((count, text)) = state.editor.copy() else { return Vec::new() };
    let noun = if count == 1 { "waypoint" } else { "waypoints" };
    let paste = state.key(Action::Edit(EditAction::Paste));
    state.notify(Severity::Info, format!("Copied {count} {noun} as CLI lines; `{paste}` inserts them."));
    vec![Effect::Copy(text)]
}

pub(in crate::ui) fn paste_copied(state: &mut Shared) -> Vec<Effect> {
    if !state.editor.has_copy() {
        let copy = state.key(Action::Edit(EditAction::Copy));
        return state.only_notify(
            Severity::Warn,
            format!("Nothing was copied: `{copy}` copies the selected waypoints."),
        );
    }
    let pasted = state.editor.paste_copied();
    reported(state, pasted)
}

/// Inserts text pasted by the terminal.
pub(in crate::ui) fn paste_text(state: &mut Shared, text: &str) -> Vec<Effect> {
    // A block of lines is no value of a field.
    let is_value = text.trim().lines().count() <= 1;
    if let Some(field) = state.editor.field_mut().filter(|_| is_value) {
        field.text.insert(text.trim());
        return Vec::new();
    }
    let before = state.plan().waypoints.len();
    match state.editor.paste_text(text) {
        Ok((pasted, effects)) => {
            let undo = state.key(Action::Edit(EditAction::Undo));
            let count = pasted.file.plan.waypoints.len();
            let done = if pasted.replaces {
                state.map.revision_at = Some(state.now);
                format!(
                    "Replaced the {before} waypoints of the plan by {count} pasted ones (`waypoint clear`); `{undo}` brings \
                     them back."
                )
            } else {
                format!("Pasted {count} waypoints; `{undo}` removes them again.")
            };
            let text = [done].into_iter().chain(skipped(state, &pasted.file)).collect::<Vec<_>>().join(" ");
            state.notify(Severity::Good, text);
            effects
        }
        Err(sentence) => state.only_notify(Severity::Warn, sentence),
    }
}

/// Returns sentences about the lines of a pasted text that the plan does not take. Writes the differences of a plan file
/// into the log.
fn skipped(state: &mut Shared, file: &PlanFile) -> Vec<String> {
    let mut sentences = Vec::new();
    for note in &file.notes {
        match &note.kind {
            NoteKind::Comment => {}
            NoteKind::Setting => {
                let lines = if note.count == 1 { "line" } else { "lines" };
                sentences
                    .push(format!("Skipped {} `set` {lines}: they belong into the CLI panel.", note.count));
            }
            _ => sentences.push(format!("{note}.")),
        }
    }
    for difference in &file.losses.findings {
        state.log_only(Severity::Warn, difference.to_string());
    }
    if !file.losses.findings.is_empty() {
        sentences.push("The log has the differences from the file.".to_owned());
    }
    sentences
}

fn reported(state: &mut Shared, done: Result<Vec<Effect>, String>) -> Vec<Effect> {
    done.unwrap_or_else(|sentence| state.only_notify(Severity::Warn, sentence))
}

pub(in crate::ui) fn undo(state: &mut Shared, redo: bool) -> Vec<Effect> {
    let done = if redo { state.editor.redo() } else { state.editor.undo() };
    let Some((label, effect)) = done else {
        let nothing = if redo { nothing_to_redo(state) } else { "Nothing to undo.".to_owned() };
        return state.only_notify(Severity::Info, nothing);
    };
    state.map.revision_at = Some(state.now);
    let verb = if redo { "Redone" } else { "Undone" };
    state.notify(Severity::Info, format!("{verb}: {label}."));
    vec![effect]
}

fn nothing_to_redo(state: &Shared) -> String {
    let history = state.editor.plan().history();
    let beside = history.newest_beside().and_then(|beside| Some((beside, history.label(beside)?)));
    let Some((beside, label)) = beside else { return "Nothing to redo.".to_owned() };
    let is_earlier = beside < history.at();
    let action = if is_earlier { EditAction::Earlier } else { EditAction::Later };
    let (key, way) = (state.key(Action::Edit(action)), if is_earlier { "back" } else { "on" });
    format!(
        "Nothing to redo here. Revision {beside} is another branch: {label}. `{key}` goes {way} to it in time."
    )
}

/// Goes to the revision made before the shown one, or after it, in any branch.
pub(in crate::ui) fn go_in_time(state: &mut Shared, later: bool) -> Vec<Effect> {
    let effect = state.editor.go_in_time(later);
    let history = state.editor.plan().history();
    let (at, count) = (history.at(), history.len());
    let text = match (&effect, history.label(at)) {
        (None, _) if count == 0 => "The plan was not edited yet.".to_owned(),
        (None, _) if later => format!("This is the newest of {count} revisions."),
        (None, _) | (Some(_), None) => format!("The plan as it was opened; {count} revisions follow."),
        (Some(_), Some(label)) => format!("Revision {at} of {count}: {label}."),
    };
    if effect.is_some() {
        state.map.revision_at = Some(state.now);
    }
    // Each step replaces the sentence about the one before.
    state.say(Severity::Info, text);
    effect.into_iter().collect()
}

/// Applies the offered fix of the shown finding.
pub(in crate::ui) fn take_fix(state: &mut Shared) -> Vec<Effect> {
    let found = findings::findings(state);
    match findings::shown(state, &found) {
        None => state.only_notify(Severity::Good, "Nothing is wrong with this plan."),
        Some((finding, None)) => state.only_notify(Severity::Warn, format!("No edit fixes this: {finding}.")),
        Some((_, Some(fix))) => state.editor.replace_document(&fix.title, fix.document),
    }
}

pub(in crate::ui) fn open_form(state: &mut Shared, kind: FormKind) -> Vec<Effect> {
    let document = state.editor.document();
    if kind == FormKind::Bulk && document.plan.waypoints.is_empty() {
        let text = format!("There is no waypoint to change: `{}` inserts one.", insert_key(state));
        return state.only_notify(Severity::Warn, text);
    }
    state.editor.popup = Some(EditorPopup::Form(Form::of(kind, document, state.units)));
    state.editor.follow_generator(findings::home(state));
    Vec::new()
}

pub(in crate::ui) fn open_browser(state: &mut Shared) -> Vec<Effect> {
    state.editor.popup = Some(EditorPopup::Browser(Browser::new(Purpose::Open, "")));
    let beside = state.editor.plan().file().and_then(std::path::Path::parent).map(std::path::Path::to_owned);
    vec![Effect::Files(FileRequest::List(beside))]
}

/// Opens the browser for a file to put under the plan on the map.
pub(in crate::ui) fn choose_backdrop(state: &mut Shared) -> Vec<Effect> {
    let plan = state.editor.plan();
    let (id, shown) = (plan.id(), plan.backdrop().last().map(|layer| layer.path.as_path()));
    let beside = shown.or(plan.file()).and_then(std::path::Path::parent).map(std::path::Path::to_owned);
    state.editor.popup = Some(EditorPopup::Browser(Browser::new(Purpose::Backdrop(id), "")));
    vec![Effect::Files(FileRequest::List(beside))]
}

pub(in crate::ui) fn remove_backdrop(state: &mut Shared) -> Vec<Effect> {
    match state.editor.remove_backdrop() {
        Some(effect) => {
            state.notify(Severity::Info, "Nothing is under the plan any more.");
            vec![effect]
        }
        None => state.only_notify(Severity::Info, "Nothing is under the plan."),
    }
}

/// Saves the plan in its file. Asks for a name if it has none.
pub(in crate::ui) fn save(state: &mut Shared) -> Vec<Effect> {
    let plan = state.editor.plan();
    match plan.file().map(std::path::Path::to_owned) {
        Some(path) => vec![state.editor.write(state.editor.plan().id(), path, false, false)],
        None => save_as(state),
    }
}

pub(in crate::ui) fn save_as(state: &mut Shared) -> Vec<Effect> {
    let plan = state.editor.plan();
    let name = plan.title();
    let name = if plan.file().is_some() { name } else { format!("{}.toml", name.replace(['/', ' '], "-")) };
    let beside = plan.file().and_then(std::path::Path::parent).map(std::path::Path::to_owned);
    state.editor.popup = Some(EditorPopup::Browser(Browser::new(Purpose::Save(plan.id()), &name)));
    vec![Effect::Files(FileRequest::List(beside))]
}

pub(in crate::ui) fn new_plan(state: &mut Shared) -> Vec<Effect> {
    let effect = state.editor.open_new(PlanDocument { name: "new".to_owned(), ..PlanDocument::default() });
    let [insert, generate, back] = [EditAction::Insert, EditAction::Generate, EditAction::PreviousPlan]
        .map(|action| state.key(Action::Edit(action)));
    let text = format!(
        "A new plan: `{insert}` inserts a waypoint, `{generate}` generates a pattern, `{back}` goes back."
    );
    state.notify(Severity::Info, text);
    vec![effect]
}

/// Closes the shown plan. Asks first if it has unsaved edits.
pub(in crate::ui) fn close(state: &mut Shared) -> Vec<Effect> {
    let id = state.editor.plan().id();
    if state.editor.plan().is_unsaved() {
        state.editor.popup = Some(EditorPopup::Question(Question::Unsaved { id, quits: false }));
        return Vec::new();
    }
    state.editor.close(id)
}

pub(in crate::ui) fn show_other(state: &mut Shared, step: isize) -> Vec<Effect> {
    if state.editor.plans().len() == 1 {
        let [open, new] = [EditAction::Open, EditAction::New].map(|action| state.key(Action::Edit(action)));
        let text = format!("One plan is open: `{open}` opens another, `{new}` makes a new one.");
        state.notify(Severity::Info, text);
    } else {
        state.editor.show_other(step);
    }
    Vec::new()
}

/// Puts the downloaded plan of the craft into the open plan that requested it, as one edit.
pub(in crate::ui) fn downloaded(
    state: &mut Shared,
    id: PlanId,
    result: Result<Box<FlightPlan>, String>,
) -> Vec<Effect> {
    let Some(open) = state.editor.plan_of(id) else {
        return state
            .only_notify(Severity::Warn, "Not downloaded: the plan that was to receive it is closed.");
    };
    let elsewhere = Some(open.title()).filter(|_| id != state.editor.plan().id());
    match result {
        Err(sentence) => state
            .only_notify(Severity::Fault, format!("Not downloaded: {}", state.keymap.in_force(&sentence))),
        Ok(held) if *held == open.document().plan => {
            state.only_notify(Severity::Info, "The craft has the same plan.")
        }
        Ok(held) => {
            let count = held.waypoints.len();
            let effects = state.editor.replace_waypoints(id, "download from the craft", *held);
            let undo = state.key(Action::Edit(EditAction::Undo));
            let text = match elsewhere {
                Some(title) => format!("Downloaded {count} waypoints into {title}."),
                None => format!("Downloaded {count} waypoints; `{undo}` brings the others back."),
            };
            state.notify(Severity::Good, text);
            effects.unwrap_or_default()
        }
    }
}

/// Reports that somebody else changed the plan in the craft: the App, a script, a line of the CLI.
pub(in crate::ui) fn craft_plan_changed(state: &mut Shared, before: &FlightPlan, now: &FlightPlan) {
    let differs = differences(before, now);
    // A client inserts the waypoints of a plan one after another, so a list of these says nothing.
    for difference in differs.iter().filter(|difference| difference.field != "waypoint") {
        state.log_only(Severity::Warn, format!("Changed in the craft: {difference}."));
    }
    let mut waypoints: Vec<usize> = differs.iter().map(|difference| difference.waypoint).collect();
    waypoints.dedup();
    let common = before.waypoints.len().min(now.waypoints.len());
    let mut parts: Vec<String> =
        waypoints.iter().filter(|&&index| index < common).map(|index| format!("WP{index}")).collect();
    match now.waypoints.len() as i64 - before.waypoints.len() as i64 {
        0 => {}
        more @ 1.. => parts.push(format!("{more} more")),
        fewer => parts.push(format!("{} fewer", -fewer)),
    }
    let text = format!(
        "The plan in the craft was changed: {}. `{}` loads it into the editor.",
        parts.join(", "),
        state.key(Action::Edit(EditAction::Download))
    );
    state.notify(Severity::Warn, text);
}

/// Moves a waypoint to a place, as one edit.
pub(in crate::ui) fn place_waypoint(state: &mut Shared, index: usize, position: LatLon) -> Vec<Effect> {
    state.editor.edit(&format!("move WP{index}"), |document| {
        if let Some(wp) = document.plan.waypoints.get_mut(index).filter(|wp| wp.kind.uses_position()) {
            wp.position = position;
        }
    })
}

/// Reports that the craft saved its configuration, or the reason for a failure.
pub(in crate::ui) fn saved_to_flash(state: &mut Shared, result: Result<(), String>) {
    match result {
        Ok(()) => {
            let stored = state.view.vehicle.stored_plan.as_ref().map_or(0, |plan| plan.waypoints.len());
            let text = format!("Saved in the craft's flash: {stored} waypoints and the settings.");
            state.notify(Severity::Good, text);
        }
        Err(sentence) => state.notify(Severity::Fault, state.keymap.in_force(&sentence)),
    }
}

pub(in crate::ui) fn flight_written(state: &mut Shared, what: &str, result: Result<String, String>) {
    match result {
        Ok(sentence) => state.notify(Severity::Good, sentence),
        Err(sentence) => {
            let sentence = state.keymap.in_force(&sentence);
            state.notify(Severity::Fault, format!("No {what} was written: {sentence}"));
        }
    }
}
