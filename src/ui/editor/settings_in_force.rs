//! The settings with which the open plan would be flown: those of the craft, changed by those that the plan sets at its upload.

use crate::plan::edit::PlanDocument;
use crate::plan::estimate::{Assumptions, SettingSource};
use crate::ui::app_state::AppState;

/// Returns the lines of the plan that its upload would set before it is flown. A craft that has the plan already is flown
/// without another upload, so that only the lines edited since then are left.
pub(crate) fn to_upload<'a>(state: &AppState, document: &'a PlanDocument) -> Vec<&'a str> {
    let sent = sent(state);
    document.settings.iter().filter(|line| !sent.contains(line)).map(String::as_str).collect()
}

/// Returns the limits the plan is judged by, and whose the fence among them is.
pub(crate) fn assumptions(state: &AppState, document: &PlanDocument) -> Assumptions {
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

/// Returns whether the plan has a fence of its own.
pub(crate) fn sets_a_fence(document: &PlanDocument) -> bool {
    document.settings.iter().any(|line| line.trim_start().starts_with("ap_max_distance_from_home"))
}

/// Returns the lines of the plan that the craft got at the upload and does not follow any more.
pub(crate) fn differing<'a>(
    state: &'a AppState,
    document: &'a PlanDocument,
) -> impl Iterator<Item = String> + 'a {
    let craft = state.view.vehicle.settings.map(|settings| settings.assumptions());
    let sent = document.settings.iter().filter(|line| sent(state).contains(line));
    sent.filter(move |line| craft.is_some_and(|craft| craft.with_settings(&[line]) != craft)).cloned()
}

/// The settings that the craft got with the open plan, while it has it.
fn sent(state: &AppState) -> &[String] {
    if state.plan_is_on_craft() { state.editor.uploaded_settings(state.plan()) } else { &[] }
}
