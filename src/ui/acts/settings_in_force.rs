//! The settings with which the open plan would be flown: those of the craft, changed by those that the plan sets at its upload.

use crate::plan::edit::PlanDocument;
use crate::plan::estimate::{Assumptions, SettingSource};
use crate::ui::model::settings::name_of;
use crate::ui::shared::Shared;

/// The setting of what happens at the fence.
const FENCE_ACTION: &str = "ap_geofence_action";

/// Returns the lines of the plan that its upload would set. A craft that has the plan is flown without another upload: only
/// the lines edited since this editor uploaded it, or opened it, are left.
pub(crate) fn to_upload<'a>(state: &Shared, document: &'a PlanDocument) -> Vec<&'a str> {
    if !state.plan_is_on_craft() {
        return document.settings.iter().map(String::as_str).collect();
    }
    let editor = &state.editor;
    let sent = editor.uploaded_settings(state.plan()).unwrap_or_else(|| editor.plan().settings_at_opening());
    document.settings.iter().filter(|line| !sent.contains(line)).map(String::as_str).collect()
}

/// Returns `true` if the craft has the open plan, but not the latest edits of its settings.
pub(crate) fn has_settings_to_upload(state: &Shared) -> bool {
    state.plan_is_on_craft() && !to_upload(state, state.editor.document()).is_empty()
}

/// Returns `true` if the craft does not have the open plan with its latest edits. An empty plan is none.
pub(crate) fn craft_has_another(state: &Shared) -> bool {
    !state.plan().waypoints.is_empty() && (!state.plan_is_on_craft() || has_settings_to_upload(state))
}

/// Returns the limits the plan is judged by, and whose the fence among them is.
pub(crate) fn assumptions(state: &Shared, document: &PlanDocument) -> Assumptions {
    let max_alt_m = Some(state.max_altitude_m);
    let Some(settings) = &state.view.vehicle.settings else {
        return Assumptions { max_alt_m, ..Assumptions::from_settings(&document.settings) };
    };
    let craft = Assumptions { max_alt_m, ..settings.assumptions() };
    let uploaded = craft.with_settings(&to_upload(state, document));
    let planned = craft.with_settings(&document.settings);
    let fence_from = if uploaded.fence_m != craft.fence_m {
        SettingSource::Plan
    } else if uploaded.fence_m != planned.fence_m || !sets_a_fence(document) {
        SettingSource::Craft
    } else {
        SettingSource::Unsaid
    };
    Assumptions { fence_from, ..uploaded }
}

/// Returns the limits by which the craft judges the plan that it stores; `None` if its settings are unknown.
pub(crate) fn of_the_craft(state: &Shared) -> Option<Assumptions> {
    let settings = state.view.vehicle.settings.as_ref()?;
    Some(Assumptions { fence_from: SettingSource::Craft, ..settings.assumptions() })
}

/// Returns `true` if the plan has a fence of its own.
pub(crate) fn sets_a_fence(document: &PlanDocument) -> bool {
    document.settings.iter().any(|line| line.trim_start().starts_with("ap_max_distance_from_home"))
}

/// Returns the settings of a plan on the craft for which the craft has another value. Lines that the firmware refused at the
/// upload are not among them: the answer to the upload named them.
pub(crate) fn differing(state: &Shared, document: &PlanDocument) -> Vec<String> {
    let Some(craft) = state.view.vehicle.settings.map(|settings| settings.assumptions()) else {
        return Vec::new();
    };
    if !state.plan_is_on_craft() {
        return Vec::new();
    }
    let edited = to_upload(state, document);
    let lines = document.settings.iter().enumerate().filter(|(at, line)| {
        // Of a setting that is there twice the last line counts.
        let name = name_of(line);
        !document.settings[at + 1..].iter().any(|later| name_of(later) == name)
            && !edited.contains(&line.as_str())
            && !state.editor.refused_settings(&document.plan).iter().any(|refused| name_of(refused) == name)
    });
    let differs = |line: &String| craft.with_settings(&[line]) != craft;
    lines.map(|(_, line)| line).filter(|line| differs(line)).cloned().collect()
}

/// Returns sentences if the upload of the plan changes the fence of the craft, or its action.
pub(crate) fn replaced_fence(state: &Shared, document: &PlanDocument) -> Option<String> {
    let craft = state.view.vehicle.settings.as_ref()?.assumptions();
    let (old_m, new_m) = (craft.fence_m, craft.with_settings(&document.settings).fence_m);
    let length = |metres: f64| state.units.length_text(metres, 0);
    let radius = match (old_m, new_m) {
        (Some(old_m), Some(new_m)) if old_m != new_m => {
            Some(format!("The plan sets the fence to {} (it was {}).", length(new_m), length(old_m)))
        }
        (Some(old_m), None) => Some(format!("The plan switches the fence off (it was {}).", length(old_m))),
        (None, Some(new_m)) => Some(format!("The plan sets a fence of {} (there was none).", length(new_m))),
        _ => None,
    };
    let sentences: Vec<String> = radius.into_iter().chain(replaced_fence_action(state, document)).collect();
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

/// Returns a sentence if the plan sets another action of the fence than the craft is known to have.
fn replaced_fence_action(state: &Shared, document: &PlanDocument) -> Option<String> {
    let own = document.settings.iter().rev().find(|line| name_of(line) == FENCE_ACTION)?;
    let new = own.split_once('=')?.1.trim();
    match state.settings.find(FENCE_ACTION).map(|setting| setting.value.as_str()) {
        Some(old) if old.eq_ignore_ascii_case(new) => None,
        Some(old) => Some(format!("The plan sets the action of the fence to {new} (it was {old}).")),
        None => Some(format!("The plan sets the action of the fence to {new}.")),
    }
}
