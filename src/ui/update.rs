//! Applies a message to the state and returns the requested effects.

use crate::ui::acts::{
    availability, findings, forecasts, ground_under, past_flight, plan_edits as plan, setting_changes,
    setting_reading, surveys, transmitter, zones,
};
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind};

use crate::session::{Command, SessionView};
use crate::telemetry::InFlightCommand;
use crate::vehicle::VehicleCommand;

use super::app_state::AppState;
use super::formatting::within;
use super::popup::{GoTo, Help, Palette, Popup};
use super::{command, tutorial};
use crate::ui::acts::map_edit::actions as map_edit;
use crate::ui::acts::stick_keys::advance;
use crate::ui::acts::transmitter::TWICE_WITHIN;
use crate::ui::model::action::{Action, Context, EditAction};
use crate::ui::model::editor::FormKind;
use crate::ui::model::effect::{Effect, FlightForm};
use crate::ui::model::event_log::Severity;
use crate::ui::model::keymap::KeyPress;
use crate::ui::model::message::{Msg, Request};
use crate::ui::model::panel_table::Panel;
use crate::ui::model::track::TrackPoint;
use crate::ui::model::{action, map_point};

mod arrange;
mod change;
mod diff;
mod flight;
mod flights;
mod kept;
mod map_menu;
mod mouse;
mod other_flight;
mod paste;
mod permission;
mod plan_popup;
mod popup;
mod series;
mod shown_keys;
mod timeline;
mod typed_digit;
mod view;
mod waiting_keys;
mod world_changes;

use change::change;
use flight::{fly, speed, upload, uploaded};
use paste::paste;
use view::{focus, focus_neighbour, scroll};

pub(super) use diff::compare;
pub(super) use kept::{follow as follow_screen, keep, restore};
pub(super) use permission::hold;

/// The time of a step in a recorded flight, µs.
const STEP_US: u64 = 10_000;

/// Processes a message and returns its effects.
pub fn update(state: &mut AppState, msg: Msg) -> Vec<Effect> {
    // These messages have no effects: the loop would not carry them out.
    let is_followed = !matches!(msg, Msg::Clock(_) | Msg::Resize(..));
    let is_picture = matches!(msg, Msg::View(_));
    let connection = state.shared.real_craft().map(|remote| remote.connection);
    let effects = take(state, msg);
    let mut effects = permission::hold(state, effects);
    permission::follow(state, connection);
    if is_followed {
        tutorial::follow(&mut state.tutorial, &mut state.shared);
        effects.extend(forecasts::follow_plan(&mut state.shared));
        effects.extend(surveys::follow(&mut state.shared));
        effects.extend(ground_under::follow_plan(&mut state.shared));
        effects.extend(series::follow(&mut state.shared));
        ground_under::follow_clearance(&mut state.shared);
        state.shared.editor.follow_generator(findings::home(&state.shared));
        zones::follow(&mut state.shared);
    }
    if is_picture {
        effects.extend(forecasts::repeat(&mut state.shared));
        let reads = setting_reading::follow(&mut state.shared);
        effects.extend(permission::hold(state, reads.into_iter().collect()));
    }
    if effects.iter().any(|effect| matches!(effect, Effect::Quit)) {
        // Before the end, which drops what comes after it.
        effects.splice(0..0, kept::keep(state));
    } else if is_followed {
        effects.extend(kept::follow(state));
    }
    effects
}

fn take(state: &mut AppState, msg: Msg) -> Vec<Effect> {
    match msg {
        Msg::Clock(now) => {
            state.shared.now = now;
            state.shared.follow_notices();
        }
        Msg::Key(event) if event.kind == KeyEventKind::Release => {}
        Msg::Key(event) => {
            state.shared.pressed_at = Some(state.shared.now);
            return key(state, event);
        }
        Msg::Mouse(event) => return mouse::update(state, event),
        Msg::Paste(text) => return paste(state, &text),
        Msg::Resize(columns, rows) => state.shared.size = (columns, rows),
        Msg::View(view) => {
            take_view(state, view);
            if !state.shared.is_rewound() && state.shared.view.replay.is_none() {
                state.shared.graphs.record(&state.shared.view.vehicle);
                return advance(&mut state.shared);
            }
        }
        Msg::Event(event) => state.take_event(&event),
        Msg::OtherFlight { name, result } => other_flight::take(&mut state.shared, name, result),
        Msg::Curves { request, result } => series::take(&mut state.shared, request, result),
        Msg::SettingsReply(reply) => return waiting_keys::take_settings(state, reply),
        Msg::SetReply { line, output } => {
            state.panels.cli.console.record(line, output.as_ref());
            return setting_changes::take_answer(&mut state.shared, output.as_ref());
        }
        Msg::CliReply(output) => {
            if state.panels.cli.console.changes_craft() {
                state.shared.settings.outdate();
            }
            if let Some((severity, text)) = state.panels.cli.console.answer(output.as_ref()) {
                state.shared.notify(severity, text);
            }
            state.shared.forecast.settings_changed();
            return state.panels.cli.console.next_effect().into_iter().collect();
        }
        // The log gets the faults from the craft itself.
        Msg::WorldReply { line, result: Ok(()) } => {
            state.shared.say(Severity::Good, format!("World: {line}."));
        }
        Msg::WorldReply { result: Err(sentence), .. } => {
            let sentence = state.shared.keymap.in_force(&sentence);
            state.shared.notify(Severity::Fault, sentence);
        }
        Msg::UploadReply { id, count, result } => {
            state.shared.settings.outdate();
            return uploaded(&mut state.shared, id, count, result);
        }
        Msg::Forecast(reply) => forecasts::take_answer(&mut state.shared, reply),
        Msg::Survey(reply) => surveys::take_reply(&mut state.shared, reply, state.go_sentence),
        Msg::DownloadReply { id, result } => return plan::downloaded(&mut state.shared, id, result),
        Msg::FlightWritten { what, result } => plan::flight_written(&mut state.shared, what, result),
        Msg::Flights(list) => return flights::listed(state, list),
        Msg::FlightDeleted { file, result } => return flights::deleted(state, &file, result),
        Msg::FlightsShown(result) => return flights::shown(state, result),
        Msg::SaveReply(result) => plan::saved_to_flash(&mut state.shared, result),
        Msg::Files(reply) => return plan_popup::answered(&mut state.shared, reply),
        Msg::Busy => {
            state.shared.notify(Severity::Warn, "The simulator does not keep up: the last key was dropped.");
        }
    }
    Vec::new()
}

fn take_view(state: &mut AppState, mut view: SessionView) {
    state.shared.keep_requested_speed(&mut view);
    if state.shared.sticks_sent.is_some_and(|(frame, _)| frame == view.sticks) {
        state.shared.sticks_sent = None;
    }
    let left = timeline::follow_branch(&mut state.shared, &view);
    if !left && !view.is_rewound() && view.vehicle.time < state.shared.view.vehicle.time {
        let ended = state.shared.track.clear();
        state.shared.past_flights.keep_flight(ended);
    }
    if view.vehicle.origin != state.shared.view.vehicle.origin {
        state.shared.past_flights.forget();
    }
    let before = std::mem::replace(&mut state.shared.view, view);
    if !left
        && !state.shared.is_rewound()
        && !before.is_rewound()
        && let (Some(was), Some(now)) =
            (&before.vehicle.stored_plan, state.shared.view.vehicle.stored_plan.clone())
        && *was != now
        && !state.shared.editor.has_uploaded(&now)
        && !state.panels.cli.console.waiting
    {
        plan::craft_plan_changed(&mut state.shared, was, &now);
    }
    if !state.shared.is_rewound() && !before.is_rewound() {
        world_changes::follow(&mut state.shared, &before.vehicle.world);
    }
    state.shared.forecast.take_view();
    past_flight::follow(&mut state.shared);
    other_flight::follow(&mut state.shared);
    if let Some(replay) = &state.shared.view.replay {
        state.step_ticks = replay.overview.frames_in(STEP_US);
    }
    if state.shared.is_rewound() || state.shared.view.replay.is_some() {
        return;
    }
    if let Some(place) = map_point::craft(&state.shared.view) {
        let vehicle = &state.shared.view.vehicle;
        let engaged = vehicle.is_engaged();
        let time_s = vehicle.time.as_secs_f64();
        let alt_m =
            vehicle.truth.as_ref().map(|truth| truth.alt).or(vehicle.estimate.alt).unwrap_or_default();
        let wp = vehicle.nav.as_ref().filter(|_| state.shared.flies_stored_plan()).map(|nav| nav.wp);
        if state.shared.view.vehicle.craft.armed == Some(false) {
            let ended = state.shared.track.disarmed_at(place.n, place.e);
            state.shared.past_flights.keep_flight(ended);
        }
        let point = TrackPoint { n: place.n, e: place.e, alt_m, time_s, engaged, wp };
        let ended = state.shared.track.push(point);
        state.shared.past_flights.keep_flight(ended);
    }
}

fn key(state: &mut AppState, event: KeyEvent) -> Vec<Effect> {
    let press = KeyPress::of(&event);
    let found = state.shared.keymap.action(press, state.shared.focus);
    if found != Some(Action::Cancel) {
        state.cancelled = None;
    }
    // A fault must be read, however busy the user is; only Esc clears it.
    if event.code == KeyCode::Esc
        || state.shared.notice.as_ref().is_some_and(|notice| notice.severity != Severity::Fault)
    {
        state.shared.notice = None;
    }
    if waiting_keys::hold(state, event, found) {
        return Vec::new();
    }
    let focused = state.shared.focus;
    let types = state.panels.of_mut(focused).field().is_some();
    // Esc first closes an open popup or field.
    let is_open = !state.popups.is_empty() || state.shared.editor.takes_text() || types;
    if event.code == KeyCode::Esc && !is_open && !state.shared.pinned.is_empty() {
        state.shared.pinned.remove(0);
    }
    match state.popups.last() {
        _ if found == Some(Action::Cancel) => cancel(state),
        _ if found == Some(Action::Redraw) => view::redraw(state),
        Some(_) => popup::key(state, event, found),
        None if state.shared.editor.popup.is_some() => {
            let compared =
                matches!(event.code, KeyCode::Char('v' | 'V')).then(|| diff::instead_of_question(state));
            compared.flatten().unwrap_or_else(|| plan_popup::key(&mut state.shared, event))
        }
        None if state.shared.focus == Panel::Plan && state.shared.editor.field().is_some() => {
            plan::field_key(&mut state.shared, event)
        }
        None if types && takes_as_text(found) => type_key(state, event),
        None => typed_digit::take(state, event, found).unwrap_or_else(|| match found {
            Some(action) => act(state, action),
            None if focused.takes_text() => type_key(state, event),
            None => Vec::new(),
        }),
    }
}

/// Passes a key to the focused panel as text.
fn type_key(state: &mut AppState, event: KeyEvent) -> Vec<Effect> {
    let requests = state.panels.of_mut(state.shared.focus).key(&state.shared, event);
    carry_out(state, requests)
}

/// Returns `true` if an open text field gets a key with this action. Keys that leave the field do not belong to it.
fn takes_as_text(found: Option<Action>) -> bool {
    !matches!(found, Some(Action::Palette | Action::Redraw | Action::Suspend | Action::Previous))
}

/// Handles Ctrl-C: the first press cancels, the second quits.
fn cancel(state: &mut AppState) -> Vec<Effect> {
    if state.cancelled.is_some_and(|at| within(state.shared.now, at, TWICE_WITHIN)) {
        return vec![Effect::Quit];
    }
    state.cancelled = Some(state.shared.now);
    let popup = state.popups.pop().is_some();
    let focused = state.panels.of_mut(state.shared.focus);
    let field = focused.field().is_some();
    if field {
        focused.close_field();
    }
    let input = field || state.shared.focus == Panel::Cli && state.panels.cli.console.cancel();
    let upload = state.shared.editor.fly_after_upload.take().is_some();
    let edit = state.shared.editor.cancel() | map_edit::leave(&mut state.shared);
    let survey = surveys::dismiss(&mut state.shared);
    let what = if popup || input || upload || edit || survey.is_some() { "Cancelled. " } else { "" };
    state.shared.notify(Severity::Info, format!("{what}Ctrl-C again within 2 s quits."));
    survey.into_iter().collect()
}

/// Carries out an action of the plan editor.
fn edit(state: &mut AppState, action: EditAction) -> Vec<Effect> {
    match action {
        EditAction::Undo => plan::undo(&mut state.shared, false),
        EditAction::Redo => plan::undo(&mut state.shared, true),
        EditAction::Earlier => plan::go_in_time(&mut state.shared, false),
        EditAction::Later => plan::go_in_time(&mut state.shared, true),
        EditAction::Compare => diff::open(state),
        EditAction::Open => plan::open_browser(&mut state.shared),
        EditAction::Save => plan::save(&mut state.shared),
        EditAction::SaveAs => plan::save_as(&mut state.shared),
        EditAction::New => plan::new_plan(&mut state.shared),
        EditAction::Close => plan::close(&mut state.shared),
        EditAction::NextPlan => plan::show_other(&mut state.shared, 1),
        EditAction::PreviousPlan => plan::show_other(&mut state.shared, -1),
        EditAction::Download => vec![Effect::Download(state.shared.editor.plan().id())],
        EditAction::SaveToFlash => vec![Effect::SaveToFlash],
        EditAction::Left => moved(state, -1),
        EditAction::Right => moved(state, 1),
        EditAction::Cell => plan::edit_cell(&mut state.shared),
        EditAction::Raise => plan::nudge(&mut state.shared, 1),
        EditAction::Lower => plan::nudge(&mut state.shared, -1),
        EditAction::RaiseMuch => plan::nudge(&mut state.shared, 10),
        EditAction::LowerMuch => plan::nudge(&mut state.shared, -10),
        EditAction::Insert => plan::insert(&mut state.shared),
        EditAction::Duplicate => plan::duplicate(&mut state.shared),
        EditAction::Delete => state.shared.editor.delete(),
        EditAction::MoveUp => state.shared.editor.move_waypoints(false),
        EditAction::MoveDown => state.shared.editor.move_waypoints(true),
        EditAction::Select => {
            state.shared.editor.toggle_selection();
            Vec::new()
        }
        EditAction::SelectAll => {
            state.shared.editor.select_all();
            Vec::new()
        }
        EditAction::Copy => plan::copy(&mut state.shared),
        EditAction::Paste => plan::paste_copied(&mut state.shared),
        EditAction::Bulk => plan::open_form(&mut state.shared, FormKind::Bulk),
        EditAction::Generate => plan::open_form(&mut state.shared, FormKind::Generate),
        EditAction::Properties => plan::open_form(&mut state.shared, FormKind::Properties),
        EditAction::Fix => plan::take_fix(&mut state.shared),
        EditAction::OnMap => map_edit::toggle(&mut state.shared),
        EditAction::Pick => map_edit::pick(&mut state.shared),
        EditAction::AddOnMap => map_edit::add(&mut state.shared),
        EditAction::DeleteOnMap => map_edit::delete(&mut state.shared),
    }
}

fn moved(state: &mut AppState, columns: isize) -> Vec<Effect> {
    state.shared.editor.move_cursor(0, columns);
    Vec::new()
}

/// Carries out an action, or notifies the user of the reason for its refusal.
fn act(state: &mut AppState, action: Action) -> Vec<Effect> {
    if let Err(reason) = availability::enabled(&state.shared, action) {
        state.shared.notify(Severity::Warn, reason);
        return Vec::new();
    }
    typed_digit::follow(state, action);
    perform(state, action)
}

/// Runs a line of the `:` line.
///
/// # Errors
/// Returns the reason for a refusal, in a sentence.
pub fn run_line(state: &mut AppState, line: &str) -> Result<Vec<Effect>, String> {
    let requests = command::run(&mut state.shared, line)?;
    Ok(carry_out(state, requests))
}

/// Carries out the requests of a panel or a command. Returns the effects.
fn carry_out(state: &mut AppState, requests: Vec<Request>) -> Vec<Effect> {
    let mut effects = Vec::new();
    for request in requests {
        match request {
            Request::Act(action) => effects.extend(perform(state, action)),
            Request::Effect(effect) => effects.push(effect),
            Request::Change(requested) => effects.extend(change(&mut state.shared, requested)),
            Request::Open(popup) => state.popups.push(popup.into()),
            Request::Chosen => state.has_chosen = true,
            Request::Type(text) => popup::open_command_line(state, &text),
            Request::Cli { line, is_reported } => {
                state.panels.cli.console.queue(line, is_reported);
                effects.extend(state.panels.cli.console.next_effect());
            }
        }
    }
    effects
}

/// Carries out an action that is enabled.
pub(super) fn perform(state: &mut AppState, action: Action) -> Vec<Effect> {
    match action {
        Action::Fly => return fly(&mut state.shared),
        Action::Arm => return transmitter::arm_key(&mut state.shared),
        Action::Throttle => return transmitter::move_throttle(&mut state.shared),
        Action::Autopilot => return transmitter::toggle_autopilot(&mut state.shared),
        Action::ReturnHome => return transmitter::toggle_return(&mut state.shared),
        Action::GoTo => {
            let vehicle = &state.shared.view.vehicle;
            let current = vehicle.nav.as_ref().map_or(0, |nav| nav.wp);
            let question = vehicle.stored_plan.as_ref().map(|stored| GoTo::new(stored, current));
            state.popups.extend(question.map(Popup::GoTo));
        }
        Action::HoldHere => return vec![VehicleCommand::InFlight(InFlightCommand::HoldHere).into()],
        Action::Resume => return vec![VehicleCommand::InFlight(InFlightCommand::Resume).into()],
        Action::CutRc => {
            let mut effects: Vec<Effect> = vec![VehicleCommand::CutRc(!state.shared.view.rc_cut).into()];
            // At real time the user can read the countdown of the failsafe.
            if !state.shared.view.rc_cut
                && state.shared.view.speed_wanted > 1.0
                && state.shared.view.vehicle.craft.is_armed()
            {
                effects.push(Effect::Send(Command::Speed(1.0)));
            }
            return effects;
        }
        Action::Upload => return upload(&mut state.shared),
        Action::Edit(action) => return edit(state, action),
        Action::ResetCraft => return transmitter::reset_key(&mut state.shared),
        Action::Layout => state.popups.push(Popup::Layout),
        Action::LookAhead => {
            let survey = surveys::dismiss(&mut state.shared);
            return survey.into_iter().chain(forecasts::toggle_look_ahead(&mut state.shared)).collect();
        }
        Action::WhatIf => state.popups.push(Popup::WhatIf { selected: 0 }),
        Action::WhereMay => return surveys::toggle_sweep(&mut state.shared),
        Action::GoNoGo => return surveys::ask_go_no_go(&mut state.shared),
        Action::Pause => return vec![Effect::Send(Command::Pause(!state.shared.view.paused))],
        Action::Step => return timeline::step(&state.shared, state.step_ticks),
        Action::Tick => return timeline::step(&state.shared, 1),
        Action::EventBack
        | Action::EventForward
        | Action::StateBack
        | Action::StateForward
        | Action::Earlier
        | Action::Later
        | Action::FlyOn
        | Action::Newest
        | Action::NextFlight
        | Action::PreviousFlight => return timeline::act(&state.shared, action),
        Action::ShiftEarlier => other_flight::shift(&mut state.shared, -1),
        Action::ShiftLater => other_flight::shift(&mut state.shared, 1),
        Action::Slower => return speed(&mut state.shared, -1),
        Action::Faster => return speed(&mut state.shared, 1),
        Action::RealTime => return speed(&mut state.shared, 0),
        Action::Show(panel) => return view::show(state, panel),
        Action::Next => return focus_neighbour(state, 1),
        Action::Previous => return focus_neighbour(state, -1),
        Action::Zoom => state.shared.zoomed = !state.shared.zoomed,
        Action::WriteScenario => return vec![state.shared.write_flight(FlightForm::Scenario, None)],
        Action::WriteLog => return vec![state.shared.write_flight(FlightForm::Log, None)],
        Action::WriteRecording => return vec![state.shared.write_recording(None)],
        Action::Flights => return flights::open(state),
        Action::Tutorial => tutorial::toggle(&mut state.tutorial, &mut state.shared),
        Action::Help => state.popups.push(Popup::Help(Help::default())),
        Action::CommandLine => popup::open_command_line(state, ""),
        Action::Palette => state.popups.push(Popup::Palette(Palette::default())),
        Action::Back => {
            // Leave the text first, so that the next keys are not typed.
            let focus_now = state.shared.focus;
            if focus_now.takes_text() {
                focus(state, state.before_text);
            } else if state.panels.of_mut(focus_now).field().is_some() {
                // Esc goes to the field itself, but a command of the palette comes here.
                state.panels.of_mut(focus_now).close_field();
            } else if let Some(requests) = state.panels.of_mut(focus_now).go_back(&state.shared) {
                return carry_out(state, requests);
            } else if let Some(effect) = surveys::dismiss(&mut state.shared) {
                return vec![effect];
            } else if !state.shared.forecast.dismiss()
                && !state.shared.editor.cancel()
                && !map_edit::leave(&mut state.shared)
            {
                state.shared.zoomed = false;
            }
        }
        Action::AllowChanges => permission::ask(state),
        // A real craft flies on without this program.
        Action::Quit if state.shared.view.is_armed_now() && state.shared.real_craft().is_none() => {
            state.popups.push(Popup::Quit);
        }
        Action::Quit => return plan_popup::quit(&mut state.shared),
        Action::Cancel => return cancel(state),
        Action::Redraw => return view::redraw(state),
        Action::Suspend => return vec![Effect::Suspend],
        Action::Panel(own) => {
            let panel = match action::spec_of(action).map(|spec| spec.context) {
                Some(Context::In(panel)) => panel,
                _ => state.shared.focus,
            };
            let requests = state.panels.of_mut(panel).act(&state.shared, own);
            return carry_out(state, requests);
        }
        Action::ScrollUp => return scroll(state, -1),
        Action::ScrollDown => return scroll(state, 1),
        Action::PageUp => return scroll(state, -10),
        Action::PageDown => return scroll(state, 10),
        Action::Top => return scroll(state, isize::MIN),
        Action::Bottom => return scroll(state, isize::MAX),
    }
    Vec::new()
}
