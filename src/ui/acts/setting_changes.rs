//! Changes settings of the craft, and undoes changes.

use super::setting_reading;
use crate::fc::CraftSetting;
use crate::session::command::CliOutput;
use crate::text::printable;
use crate::ui::acts::forecasts;
use crate::ui::model::action::{Action, EditAction};
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::settings::steps::{Done, DoneStep};
use crate::ui::model::settings::{Assignment, SettingsChange, SettingsState, Step, name_of};
use crate::ui::shared::Shared;

/// Carries out a change.
pub(in crate::ui) fn change(state: &mut Shared, change: SettingsChange) -> Vec<Effect> {
    match change {
        SettingsChange::Set(step) => set(state, step),
        SettingsChange::Undo => undo(state, false),
        SettingsChange::Redo => undo(state, true),
        SettingsChange::Read => setting_reading::read_again(state),
        SettingsChange::Try(assignment) => forecasts::ask_setting_change(state, assignment),
        SettingsChange::IntoPlan(assignments) => into_plan(state, &assignments),
    }
}

fn set(state: &mut Shared, Step { label, assignments }: Step) -> Vec<Effect> {
    let settings = &mut state.settings;
    let mut values = Vec::new();
    let mut changed = Vec::new();
    for assignment in assignments {
        let Some(setting) = settings.find(&assignment.name) else { continue };
        if setting.value == assignment.value {
            continue;
        }
        values.push(Done {
            name: setting.name.clone(),
            profile: setting.profile.clone(),
            before: setting.value.clone(),
            after: assignment.value.clone(),
        });
        changed.push(assignment);
    }
    if changed.is_empty() {
        return Vec::new();
    }
    settings.steps.remember(DoneStep { label, values });
    let effects = send(settings, changed);
    state.forecast.forget_tried();
    effects
}

/// Shows the values at once, and sends the first of them.
fn send(settings: &mut SettingsState, assignments: Vec<Assignment>) -> Vec<Effect> {
    for assignment in &assignments {
        if let Some(setting) = settings.craft.as_mut().and_then(|craft| craft.find_mut(&assignment.name)) {
            setting.value.clone_from(&assignment.value);
        }
    }
    settings.steps.queue(assignments);
    next(settings)
}

fn next(settings: &mut SettingsState) -> Vec<Effect> {
    let line = settings.steps.next().map(|assignment| format!("set {}", assignment.line()));
    line.map(Effect::Set).into_iter().collect()
}

fn undo(state: &mut Shared, redo: bool) -> Vec<Effect> {
    let Some(step) = state.settings.steps.go_back(redo) else {
        let verb = if redo { "redo" } else { "undo" };
        return state.only_notify(Severity::Info, format!("No change of a setting to {verb}."));
    };
    let other = step.values.iter().find(|done| {
        let now = state.settings.find(&done.name).map(|setting| &setting.profile);
        now.is_some_and(|profile| *profile != done.profile)
    });
    if let Some(Done { name, profile, .. }) = other {
        let text = format!("{name} was changed in {profile}, which is not the active profile now.");
        state.settings.steps.put_back(redo);
        return state.only_notify(Severity::Warn, text);
    }
    let value = |done: Done| if redo { done.after } else { done.before };
    let assignments =
        step.values.into_iter().map(|done| Assignment { name: done.name.clone(), value: value(done) });
    let effects = send(&mut state.settings, assignments.collect());
    let verb = if redo { "Redone" } else { "Undone" };
    state.notify(Severity::Info, format!("{verb}: {}.", step.label));
    effects
}

/// Takes the answer to the line that set a value; `None` if the firmware went away.
pub(in crate::ui) fn take_answer(state: &mut Shared, output: Option<&CliOutput>) -> Vec<Effect> {
    let refusal = match output {
        None => Some("the firmware went away".to_owned()),
        Some(output) => output.text.contains("###ERROR").then(|| complaint(output)),
    };
    let Some((Assignment { name, value }, count)) = state.settings.steps.answered(refusal.is_none()) else {
        return Vec::new();
    };
    state.settings.outdate();
    if let Some(why) = refusal {
        let dropped = state.settings.steps.give_up();
        let more = if dropped > 0 { format!(" {dropped} more were not set.") } else { String::new() };
        let text = format!("{name} was not set to {value}: {}.{more}", why.trim_end_matches('.'));
        let text = state.keymap.in_force(&text);
        state.notify(Severity::Warn, text);
        return Vec::new();
    }
    state.forecast.settings_changed();
    let next = next(&mut state.settings);
    if next.is_empty() {
        let advice = output.and_then(|output| output.advice.clone());
        let text =
            if count > 1 { format!("{count} settings were set.") } else { format!("{name} = {value}.") };
        let save = state.key(Action::Edit(EditAction::SaveToFlash));
        let then = advice.unwrap_or_else(|| format!("`{save}` keeps it in the craft's flash."));
        state.notify(Severity::Good, format!("{text} {then}"));
    }
    next
}

/// Gives up the values that wait, because the user does not permit them.
pub(in crate::ui) fn take_back(state: &mut Shared) {
    state.settings.steps.give_up();
    state.settings.outdate();
}

/// Returns the refusal in the words of the firmware or, better, of this program.
fn complaint(output: &CliOutput) -> String {
    if let Some(advice) = &output.advice {
        return advice.clone();
    }
    let said = output.text.lines().map(|line| line.trim().trim_matches('#')).filter(|line| !line.is_empty());
    printable::line(&said.collect::<Vec<_>>().join(", ")).into_owned()
}

/// Returns the request to give all changed settings their defaults.
pub(in crate::ui) fn reset_all(state: &Shared) -> SettingsChange {
    let changed = state.settings.craft().into_iter().flat_map(|craft| &craft.all);
    let default = |setting: &CraftSetting| {
        let value = setting.default.clone().filter(|_| setting.is_changed())?;
        Some(Assignment { name: setting.name.clone(), value })
    };
    let assignments: Vec<Assignment> = changed.filter_map(default).collect();
    SettingsChange::Set(Step {
        label: format!("{} settings to their defaults", assignments.len()),
        assignments,
    })
}

/// Returns the reason if no setting can get its default, a sentence.
pub(in crate::ui) fn nothing_to_reset(state: &Shared) -> Option<&'static str> {
    match (state.settings.craft(), changed_count(state)) {
        (None, _) => Some("The settings of the craft are not read yet."),
        (Some(_), 0) => Some("Every setting has its default, so there is nothing to reset."),
        (Some(_), _) => None,
    }
}

/// Returns the number of settings that differ from their defaults.
fn changed_count(state: &Shared) -> usize {
    let settings = state.settings.craft().into_iter().flat_map(|craft| &craft.all);
    settings.filter(|setting| setting.is_changed()).count()
}

/// Returns the question before all settings get their defaults, a sentence.
pub(in crate::ui) fn reset_question(state: &Shared) -> String {
    let count = changed_count(state);
    let settings = if count == 1 { "setting" } else { "settings" };
    format!("This changes {count} {settings} of the craft, and can be undone.")
}

/// Writes settings into the open plan, in place of its own values for them.
fn into_plan(state: &mut Shared, assignments: &[Assignment]) -> Vec<Effect> {
    let label = match assignments {
        [] => return state.only_notify(Severity::Info, "No setting is chosen, so the plan stays as it is."),
        [one] => format!("{} of the plan", one.name),
        more => format!("{} settings of the plan", more.len()),
    };
    let effects = state.editor.edit(&label, |document| {
        for assignment in assignments {
            document.settings.retain(|line| !name_of(line).eq_ignore_ascii_case(&assignment.name));
            document.settings.push(assignment.line());
        }
    });
    let title = state.editor.plan().title();
    let text = match (effects.is_empty(), assignments) {
        (true, _) => format!("{title} has it already."),
        (false, [one]) => format!("{title} sets {} at its upload.", one.line()),
        (false, more) => format!("{title} sets {} settings at its upload.", more.len()),
    };
    state.notify(Severity::Good, text);
    effects
}
