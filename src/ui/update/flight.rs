//! The flight as a whole: the scripted pilot, the upload of the plan, the speed of the simulation.

use crate::fc::UploadReport;
use crate::plan::review::Finding;
use crate::session::Command;
use crate::ui::acts::{findings, settings_in_force};
use crate::ui::model::action::{Action, EditAction};
use crate::ui::model::editor::{EditorPopup, OpenPlan, Question};
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::panel_table::Panel;
use crate::ui::model::plan_id::PlanId;
use crate::ui::shared::Shared;
use crate::vehicle::VehicleCommand;

mod moved_target;

/// The setting of the fence.
const FENCE_SETTING: &str = "ap_max_distance_from_home";

/// The speeds `[` and `]` go through.
const SPEEDS: [f64; 12] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, f64::INFINITY];

/// Starts or stops the scripted pilot. A craft without a plan gets the open one first; if it has another, the user is
/// asked which one to fly.
pub(super) fn fly(state: &mut Shared) -> Vec<Effect> {
    if state.view.pilot.is_some() {
        return vec![Effect::Send(Command::Vehicle(VehicleCommand::StopPilot))];
    }
    if state.view.paused {
        let text = format!("The simulation is paused: {} goes on.", state.key(Action::Pause));
        state.notify(Severity::Info, text);
    }
    if state.view.vehicle.stored_plan.as_ref().is_some_and(|plan| !plan.waypoints.is_empty()) {
        let Some(difference) = difference_from_the_craft(state) else { return fly_stored(state) };
        let id = state.editor.plan().id();
        state.editor.popup = Some(EditorPopup::Question(Question::FliesWhich { id, difference }));
        return Vec::new();
    }
    if state.plan().waypoints.is_empty() {
        let insert = state.key(Action::Edit(EditAction::Insert));
        let (panel, open) = (state.key(Action::Show(Panel::Plan)), state.key(Action::Edit(EditAction::Open)));
        let text = format!(
            "There is no plan to fly: `{insert}` in the Plan panel ({panel}) inserts a waypoint, \
             `{open}` opens a file."
        );
        return state.only_notify(Severity::Warn, text);
    }
    upload_and_fly(state)
}

/// Returns the difference of the open plan from the one that the craft stores; `None` if there is none, or no open plan.
fn difference_from_the_craft(state: &Shared) -> Option<String> {
    if !settings_in_force::craft_has_another(state) {
        return None;
    }
    let title = state.editor.plan().title();
    let difference = if settings_in_force::has_settings_to_upload(state) {
        format!("Settings of {title} that you changed are not on the craft.")
    } else if state.editor.uploaded_last() == Some(state.editor.plan().id()) {
        format!("{title} was edited since its upload: the craft has the older plan.")
    } else {
        format!("The plan in the craft is not {title}.")
    };
    let fence = settings_in_force::replaced_fence(state, state.editor.document());
    Some(fence.map_or_else(|| difference.clone(), |fence| format!("{difference} {fence}")))
}

/// Starts the scripted pilot on the plan that the craft stores.
pub(super) fn fly_stored(state: &mut Shared) -> Vec<Effect> {
    if let Some(refusal) = findings::refusal_of_the_stored(state) {
        return not_flown(state, &refusal);
    }
    vec![Effect::Send(Command::StartPilot)]
}

/// Uploads the open plan, and starts the scripted pilot on it when the craft has it.
pub(super) fn upload_and_fly(state: &mut Shared) -> Vec<Effect> {
    let limits = settings_in_force::assumptions(state, state.editor.document());
    if let Some(refusal) = findings::refusal(state, state.plan(), &limits) {
        return not_flown(state, &refusal);
    }
    state.editor.fly_after_upload = Some(state.editor.plan().id());
    vec![upload_now(state)]
}

/// Keeps the craft on the ground: the autopilot would refuse the plan after the climb.
fn not_flown(state: &mut Shared, refusal: &Finding) -> Vec<Effect> {
    let by_hand = [Action::Arm, Action::Throttle].map(|action| state.key(action)).join(" and ");
    let text = format!("Not flown, the autopilot would refuse: {}. By hand: {by_hand}.", refusal.reason());
    state.only_notify(Severity::Warn, text)
}

/// Uploads the open plan; in flight it asks before the waypoint that is flown to moves far.
pub(super) fn upload(state: &mut Shared) -> Vec<Effect> {
    if let Some(change) = moved_target::question(state) {
        let id = state.editor.plan().id();
        state.editor.popup = Some(EditorPopup::Question(Question::MovesTarget { id, change }));
        return Vec::new();
    }
    vec![upload_now(state)]
}

/// Returns the upload of the open plan.
pub(super) fn upload_now(state: &mut Shared) -> Effect {
    state.editor.replaced_fence = settings_in_force::replaced_fence(state, state.editor.document());
    state.editor.remember_upload();
    Effect::Upload {
        id: state.editor.plan().id(),
        name: state.editor.document().name.clone(),
        plan: Box::new(state.plan().clone()),
        settings: state.editor.document().settings.clone(),
    }
}

/// The craft answered the upload of a plan of `count` waypoints, which need not be shown any more.
pub(super) fn uploaded(
    state: &mut Shared,
    id: PlanId,
    count: usize,
    result: Result<UploadReport, String>,
) -> Vec<Effect> {
    let fly = state.editor.fly_after_upload.take_if(|asked| *asked == id).is_some();
    let open = state.editor.plan_of(id);
    let title = open.map_or_else(|| "a plan that is closed now".to_owned(), OpenPlan::title);
    match result {
        Ok(report) => {
            let flies = open.is_some_and(|open| state.flies(&open.document().plan));
            // The next picture shows the new plan; whether another one flies is known already.
            let then = match state.flies_stored_plan() && !flies {
                false => String::new(),
                true if state.view.remote.is_some() => " It takes effect at the next engagement.".to_owned(),
                true => {
                    let key = state.key(Action::GoTo);
                    format!(" It takes effect at the next engagement; `{key}` continues on it now.")
                }
            };
            let converted = report.remark().map_or_else(String::new, |sentence| format!(" {sentence}"));
            let is_refused = report.refused.iter().any(|line| line.contains(FENCE_SETTING));
            let fence = state.editor.replaced_fence.take().filter(|_| !is_refused);
            let fence = fence.map_or_else(String::new, |sentence| format!(" {sentence}"));
            let text = format!("Uploaded {title}: {count} waypoints.{fence}{converted}{then}");
            state.editor.remember_refused(id, report.refused);
            state.notify(Severity::Good, text);
            if fly { vec![Effect::Send(Command::StartPilot)] } else { Vec::new() }
        }
        Err(sentence) => {
            forget_upload(state, id);
            state.only_notify(
                Severity::Fault,
                format!("Uploading {title} failed: {}", state.keymap.in_force(&sentence)),
            )
        }
    }
}

/// Forgets an upload that failed or was declined, and the flight that was to follow it.
pub(super) fn forget_upload(state: &mut Shared, id: PlanId) {
    state.editor.forget_upload(id);
    state.editor.fly_after_upload.take_if(|asked| *asked == id);
    state.editor.replaced_fence = None;
}

/// Steps through the speeds; 0 = real time.
pub(super) fn speed(state: &mut Shared, step: i32) -> Vec<Effect> {
    let wanted = state.view.speed_wanted;
    let next = match step {
        0 => Some(1.0),
        1.. => SPEEDS.into_iter().find(|&speed| speed > wanted * 1.01),
        _ => SPEEDS.into_iter().rev().find(|&speed| speed < wanted * 0.99),
    };
    let Some(next) = next else {
        let text = if step > 0 { "This is the fastest speed." } else { "This is the slowest speed." };
        state.say(Severity::Info, text);
        return Vec::new();
    };
    if step != 0 {
        state.say_speed_in_pause(next);
    }
    let mut effects = vec![state.request_speed(next)];
    if step == 0 && state.view.paused {
        effects.push(Effect::Send(Command::Pause(false)));
    }
    effects
}
