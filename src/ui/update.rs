//! Applies a message to the state and returns the requested effects.

use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind};

use crate::session::{Command, SessionView};
use crate::telemetry::InFlightCommand;

use super::action::{self, Action, EditAction};
use super::app_state::AppState;
use super::editor::{FormKind, findings};
use super::event_log::Severity;
use super::forecast;
use super::formatting::within;
use super::graphs;
use super::keymap::KeyPress;
use super::knobs;
use super::log_view;
use super::map_point;
use super::message::{Effect, Msg};
use super::panel::Panel;
use super::permission;
use super::popup::{Palette, Popup};
use super::stick_recording;
use super::track::TrackPoint;
use super::transmitter;
use super::tutorial;
use super::viewport::MapMode;

mod cli;
mod fields;
mod flight;
mod map_edit;
mod map_menu;
mod mouse;
mod plan;
mod plan_popup;
mod popup;
mod timeline;
mod view;

use cli::{cli_key, paste};
use flight::{ask_where_to_go, fly, speed, upload, uploaded};
use view::{ZOOM_STEP, follow, neighbour, scroll, zoom_map};

pub(super) use cli::run_cli;
pub(super) use plan::{write_scenario, write_shown as write_plan};
pub(super) use view::focus;

/// The time within which a second press of a key confirms the first.
pub(super) const TWICE_WITHIN: Duration = Duration::from_secs(2);

/// Processes a message and returns its effects.
pub fn update(state: &mut AppState, msg: Msg) -> Vec<Effect> {
    // These messages have no effects: the loop would not carry them out.
    let is_followed = !matches!(msg, Msg::Clock(_) | Msg::Resize(..));
    let is_picture = matches!(msg, Msg::View(_));
    let connection = permission::real_craft(state).map(|remote| remote.connection);
    let effects = take(state, msg);
    let mut effects = permission::hold(state, effects);
    permission::follow(state, connection);
    if is_followed {
        tutorial::follow(state);
        effects.extend(forecast::follow_plan(state));
        state.editor.follow_generator(findings::home(state));
    }
    if is_picture {
        effects.extend(forecast::repeat(state));
    }
    effects
}

fn take(state: &mut AppState, msg: Msg) -> Vec<Effect> {
    match msg {
        Msg::Clock(now) => {
            state.now = now;
            Vec::new()
        }
        Msg::Key(event) if event.kind == KeyEventKind::Release => Vec::new(),
        Msg::Key(event) => key(state, event),
        Msg::Mouse(event) => mouse::update(state, event),
        Msg::Paste(text) => paste(state, &text),
        Msg::Resize(columns, rows) => {
            state.size = (columns, rows);
            Vec::new()
        }
        Msg::View(view) => {
            take_view(state, view);
            if state.is_rewound() {
                return Vec::new();
            }
            graphs::record(state);
            stick_recording::advance(state)
        }
        Msg::Event(event) => {
            state.take_event(&event);
            Vec::new()
        }
        Msg::CliReply(output) => {
            if let Some((severity, text)) = state.cli.answer(output.as_ref()) {
                state.notify(severity, text);
            }
            state.forecast.settings_changed();
            run_cli(state)
        }
        Msg::WorldReply { line, result } => {
            match result {
                // The log gets the faults from the craft itself.
                Ok(()) => state.say(Severity::Good, format!("World: {line}.")),
                Err(sentence) => {
                    let sentence = state.keymap.in_force(&sentence);
                    state.notify(Severity::Fault, sentence);
                }
            }
            Vec::new()
        }
        Msg::UploadReply { id, count, result } => uploaded(state, id, count, result),
        Msg::Forecast(reply) => {
            forecast::take_answer(state, reply);
            Vec::new()
        }
        Msg::DownloadReply { id, result } => plan::downloaded(state, id, result),
        Msg::ScenarioReply(result) => plan::scenario_written(state, result),
        Msg::SaveReply(result) => plan::saved_to_flash(state, result),
        Msg::Files(reply) => plan_popup::answered(state, reply),
        Msg::Busy => {
            state.notify(Severity::Warn, "The simulator does not keep up: the last key was dropped.");
            Vec::new()
        }
    }
}

fn take_view(state: &mut AppState, view: SessionView) {
    if state.sticks_sent.is_some_and(|(frame, _)| frame == view.sticks) {
        state.sticks_sent = None;
    }
    let left = timeline::follow_branch(state, &view);
    if !left && !view.is_rewound() && view.vehicle.time < state.view.vehicle.time {
        state.track.clear();
    }
    let before = std::mem::replace(&mut state.view, view);
    if !left
        && !state.is_rewound()
        && !before.is_rewound()
        && let (Some(was), Some(now)) = (&before.vehicle.stored_plan, state.view.vehicle.stored_plan.clone())
        && *was != now
        && !state.editor.has_uploaded(&now)
        && !state.cli.waiting
    {
        plan::craft_plan_changed(state, was, &now);
    }
    state.forecast.take_view();
    if state.is_rewound() {
        return;
    }
    if let Some(place) = map_point::craft(&state.view) {
        let vehicle = &state.view.vehicle;
        let engaged = vehicle.is_engaged();
        let time_s = vehicle.time.as_secs_f64();
        let alt_m =
            vehicle.truth.as_ref().map(|truth| truth.alt).or(vehicle.estimate.alt).unwrap_or_default();
        let wp = vehicle.nav.as_ref().filter(|_| state.flies_stored_plan()).map(|nav| nav.wp);
        if state.view.vehicle.craft.armed == Some(false) {
            state.track.disarmed_at(place.n, place.e);
        }
        state.track.push(TrackPoint { n: place.n, e: place.e, alt_m, time_s, engaged, wp });
    }
}

fn key(state: &mut AppState, event: KeyEvent) -> Vec<Effect> {
    let press = KeyPress::of(&event);
    let found = state.keymap.action(press, state.focus);
    if found != Some(Action::Cancel) {
        state.cancelled = None;
    }
    // A fault must be read, however busy the user is; only Esc clears it.
    if event.code == KeyCode::Esc
        || state.notice.as_ref().is_some_and(|notice| notice.severity != Severity::Fault)
    {
        state.notice = None;
    }
    let types = fields::open(state).is_some();
    // Esc first closes an open popup or field.
    let is_open = !state.popups.is_empty() || state.editor.takes_text() || types;
    if event.code == KeyCode::Esc && !is_open && !state.pinned.is_empty() {
        state.pinned.remove(0);
    }
    match state.popups.last() {
        _ if found == Some(Action::Cancel) => cancel(state),
        Some(_) => popup::key(state, event, found),
        None if state.editor.popup.is_some() => plan_popup::key(state, event),
        None if state.focus == Panel::Plan && state.editor.field().is_some() => plan::field_key(state, event),
        None if types && takes_as_text(found) => fields::key(state, event),
        None => match found {
            Some(action) => act(state, action),
            None if state.focus == Panel::Cli => cli_key(state, event),
            None => Vec::new(),
        },
    }
}

/// Returns `true` if an open text field gets a key with this action. Keys that leave the field do not belong to it.
fn takes_as_text(found: Option<Action>) -> bool {
    !matches!(found, Some(Action::Palette | Action::Suspend | Action::Previous))
}

/// Handles Ctrl-C: the first press cancels, the second quits.
fn cancel(state: &mut AppState) -> Vec<Effect> {
    if state.cancelled.is_some_and(|at| within(state.now, at, TWICE_WITHIN)) {
        return vec![Effect::Quit];
    }
    state.cancelled = Some(state.now);
    let popup = state.popups.pop().is_some();
    let field = fields::close(state);
    let input = field || state.focus == Panel::Cli && state.cli.cancel();
    let upload = state.fly_after_upload.take().is_some();
    let edit = state.editor.cancel() | map_edit::leave(state);
    let what = if popup || input || upload || edit { "Cancelled. " } else { "" };
    state.notify(Severity::Info, format!("{what}Ctrl-C again within 2 s quits."));
    Vec::new()
}

/// Carries out an action of the plan editor.
fn edit(state: &mut AppState, action: EditAction) -> Vec<Effect> {
    match action {
        EditAction::Undo => plan::undo(state, false),
        EditAction::Redo => plan::undo(state, true),
        EditAction::Open => plan::open_browser(state),
        EditAction::Save => plan::save(state),
        EditAction::SaveAs => plan::save_as(state),
        EditAction::New => plan::new_plan(state),
        EditAction::Close => plan::close(state),
        EditAction::NextPlan => plan::show_other(state, 1),
        EditAction::PreviousPlan => plan::show_other(state, -1),
        EditAction::Download => vec![Effect::Download(state.editor.plan().id())],
        EditAction::SaveToFlash => vec![Effect::SaveToFlash],
        EditAction::Left => moved(state, -1),
        EditAction::Right => moved(state, 1),
        EditAction::Cell => plan::edit_cell(state),
        EditAction::Raise => plan::nudge(state, 1),
        EditAction::Lower => plan::nudge(state, -1),
        EditAction::RaiseMuch => plan::nudge(state, 10),
        EditAction::LowerMuch => plan::nudge(state, -10),
        EditAction::Insert => plan::insert(state),
        EditAction::Duplicate => plan::duplicate(state),
        EditAction::Delete => state.editor.delete(),
        EditAction::MoveUp => state.editor.move_waypoints(false),
        EditAction::MoveDown => state.editor.move_waypoints(true),
        EditAction::Select => {
            state.editor.toggle_selection();
            Vec::new()
        }
        EditAction::SelectAll => {
            state.editor.select_all();
            Vec::new()
        }
        EditAction::Copy => plan::copy(state),
        EditAction::Paste => plan::paste_copied(state),
        EditAction::Bulk => plan::open_form(state, FormKind::Bulk),
        EditAction::Generate => plan::open_form(state, FormKind::Generate),
        EditAction::Properties => plan::open_form(state, FormKind::Properties),
        EditAction::Fix => plan::take_fix(state),
        EditAction::OnMap => map_edit::toggle(state),
        EditAction::Pick => map_edit::pick(state),
        EditAction::AddOnMap => map_edit::add(state),
        EditAction::DeleteOnMap => map_edit::delete(state),
    }
}

fn moved(state: &mut AppState, columns: isize) -> Vec<Effect> {
    state.editor.move_cursor(0, columns);
    Vec::new()
}

/// Carries out an action, or notifies the user of the reason for its refusal.
fn act(state: &mut AppState, action: Action) -> Vec<Effect> {
    if let Err(reason) = action::enabled(state, action) {
        state.notify(Severity::Warn, reason);
        return Vec::new();
    }
    perform(state, action)
}

/// Carries out an action that is enabled.
pub(super) fn perform(state: &mut AppState, action: Action) -> Vec<Effect> {
    match action {
        Action::Fly => fly(state),
        Action::Arm => transmitter::arm_key(state),
        Action::Throttle => transmitter::move_throttle(state),
        Action::Autopilot => transmitter::toggle_autopilot(state),
        Action::ReturnHome => transmitter::toggle_return(state),
        Action::GoTo => ask_where_to_go(state),
        Action::HoldHere => vec![Effect::Send(Command::InFlight(InFlightCommand::HoldHere))],
        Action::Resume => vec![Effect::Send(Command::InFlight(InFlightCommand::Resume))],
        Action::CutRc => {
            let mut effects = vec![Effect::Send(Command::CutRc(!state.view.rc_cut))];
            // At real time the user can read the countdown of the failsafe.
            if !state.view.rc_cut && state.view.speed_wanted > 1.0 && state.view.vehicle.craft.is_armed() {
                effects.push(Effect::Send(Command::Speed(1.0)));
            }
            effects
        }
        Action::Upload => upload(state),
        Action::Edit(action) => edit(state, action),
        Action::ResetCraft => {
            state.track.await_reset();
            state.sticks_sent = None;
            vec![Effect::Send(Command::ResetCraft)]
        }
        Action::LookAhead => forecast::toggle_look_ahead(state),
        Action::WhatIf => {
            state.popups.push(Popup::WhatIf { selected: 0 });
            Vec::new()
        }
        Action::ExplainGuards => {
            state.popups.push(Popup::Guards { selected: 0 });
            Vec::new()
        }
        Action::Pause => vec![Effect::Send(Command::Pause(!state.view.paused))],
        Action::Step => {
            let mut effects = Vec::new();
            if !state.view.paused {
                effects.push(Effect::Send(Command::Pause(true)));
            }
            effects.push(Effect::Send(Command::Step(state.step_ticks)));
            effects
        }
        Action::Tick
        | Action::EventBack
        | Action::EventForward
        | Action::StateBack
        | Action::StateForward
        | Action::Earlier
        | Action::Later
        | Action::FlyOn
        | Action::Newest => timeline::act(state, action),
        Action::Slower => speed(state, -1),
        Action::Faster => speed(state, 1),
        Action::RealTime => speed(state, 0),
        Action::Show(panel) => focus(state, panel),
        Action::Next => focus(state, neighbour(state, 1)),
        Action::Previous => focus(state, neighbour(state, -1)),
        Action::Zoom => {
            state.zoomed = !state.zoomed;
            Vec::new()
        }
        Action::WriteScenario => plan::write_scenario(state, None),
        Action::Tutorial => {
            tutorial::toggle(state);
            Vec::new()
        }
        Action::Help => {
            state.popups.push(Popup::Help { scroll: 0 });
            Vec::new()
        }
        Action::CommandLine => {
            popup::open_command_line(state, "");
            Vec::new()
        }
        Action::Palette => {
            state.popups.push(Popup::Palette(Palette::default()));
            Vec::new()
        }
        Action::Back => {
            // Leave the text first, so that the next keys are not typed.
            if state.focus.takes_text() {
                focus(state, Panel::Map);
            } else if state.focus == Panel::Graphs && state.graphs.leave_cursor() {
                // Leaving the cursor was the step.
            } else if state.focus == Panel::Log && !state.log_view.search.is_empty() {
                log_view::end_search(state);
            } else if !state.forecast.dismiss() && !state.editor.cancel() && !map_edit::leave(state) {
                state.zoomed = false;
            }
            Vec::new()
        }
        Action::AllowChanges => {
            permission::ask(state);
            Vec::new()
        }
        // A real craft flies on without this program.
        Action::Quit if state.view.is_armed_now() && permission::real_craft(state).is_none() => {
            state.popups.push(Popup::Quit);
            Vec::new()
        }
        Action::Quit => plan_popup::quit(state),
        Action::Cancel => cancel(state),
        Action::Suspend => vec![Effect::Suspend],
        Action::PanUp => map_edit::arrow(state, 0.0, -1.0),
        Action::PanDown => map_edit::arrow(state, 0.0, 1.0),
        Action::PanLeft => map_edit::arrow(state, -1.0, 0.0),
        Action::PanRight => map_edit::arrow(state, 1.0, 0.0),
        Action::ZoomIn => zoom_map(state, 1.0 / ZOOM_STEP),
        Action::ZoomOut => zoom_map(state, ZOOM_STEP),
        Action::Follow => follow(state),
        Action::Fit => {
            state.map.mode = MapMode::Fit;
            Vec::new()
        }
        Action::ChannelUp => {
            state.channel = state.channel.saturating_sub(1);
            Vec::new()
        }
        Action::ChannelDown => {
            state.channel = (state.channel + 1).min(crate::signals::RC_CHANNELS - 1);
            Vec::new()
        }
        Action::Lower => transmitter::nudge(state, state.channel, -10),
        Action::Raise => transmitter::nudge(state, state.channel, 10),
        Action::LowerMuch => transmitter::nudge(state, state.channel, -100),
        Action::RaiseMuch => transmitter::nudge(state, state.channel, 100),
        Action::Flip => transmitter::flip(state, state.channel),
        Action::Record => stick_recording::toggle_recording(state),
        Action::Play => stick_recording::toggle_playing(state),
        Action::CursorBack => {
            state.graphs.move_cursor(-1.0);
            Vec::new()
        }
        Action::CursorOn => {
            state.graphs.move_cursor(1.0);
            Vec::new()
        }
        Action::SpanLess => {
            state.graphs.change_span(-1);
            Vec::new()
        }
        Action::SpanMore => {
            state.graphs.change_span(1);
            Vec::new()
        }
        Action::ChoosePlots => {
            state.popups.push(Popup::Plots { selected: 0 });
            Vec::new()
        }
        Action::CursorOff => {
            state.graphs.leave_cursor();
            Vec::new()
        }
        Action::KnobUp => {
            state.knobs.selected = state.knobs.selected.saturating_sub(1);
            Vec::new()
        }
        Action::KnobDown => {
            let last = knobs::knobs(state).len().saturating_sub(1);
            state.knobs.selected = (state.knobs.selected + 1).min(last);
            Vec::new()
        }
        Action::KnobLess => knobs::turn(state, -1),
        Action::KnobMore => knobs::turn(state, 1),
        Action::KnobEnter => knobs::enter(state),
        Action::KnobEdit => knobs::edit(state),
        Action::KnobDefault => knobs::reset(state),
        Action::Search => {
            focus(state, Panel::Log);
            log_view::begin_search(state)
        }
        Action::NextMatch => log_view::next_match(state, false),
        Action::PreviousMatch => log_view::next_match(state, true),
        Action::Filter => log_view::cycle_filter(state),
        Action::ScrollUp => scroll(state, -1),
        Action::ScrollDown => scroll(state, 1),
        Action::PageUp => scroll(state, -10),
        Action::PageDown => scroll(state, 10),
        Action::Top => scroll(state, isize::MIN),
        Action::Bottom => scroll(state, isize::MAX),
    }
}
