//! What a message does to the state, and what it asks for.

use std::time::Duration;

use crossterm::event::{Event as TerminalEvent, KeyCode, KeyEvent, KeyEventKind};
use tui_input::backend::crossterm::EventHandler as _;

use crate::session::{Command, SessionView};

use super::action::{self, Action};
use super::hands;
use super::keymap::KeyPress;
use super::layout;
use super::log::Level;
use super::map::{self, MapMode, Viewport};
use super::message::{Effect, Msg};
use super::panel;
use super::quantity::within;
use super::state::{AppState, Layer, Pane};
use super::track::TrackPoint;

mod mouse;

/// Two Ctrl-C within this time quit.
const TWICE_WITHIN: Duration = Duration::from_secs(2);
/// A zoom step of the map.
const ZOOM_STEP: f64 = 1.5;
/// The speeds `[` and `]` go through.
const SPEEDS: [f64; 12] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, f64::INFINITY];

/// Takes a message in and says what is to be done.
pub fn update(state: &mut AppState, msg: Msg) -> Vec<Effect> {
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
            Vec::new()
        }
        Msg::Event(event) => {
            state.hear(&event);
            Vec::new()
        }
        Msg::CliReply(output) => {
            state.cli.answer(output.as_ref());
            run_cli(state)
        }
        Msg::UploadReply(result) => uploaded(state, result),
        Msg::Busy => {
            state.notify(Level::Warn, "The simulator does not keep up: the last key was dropped.");
            Vec::new()
        }
    }
}

fn take_view(state: &mut AppState, view: SessionView) {
    if view.vehicle.time < state.view.vehicle.time {
        state.track.clear();
    }
    if state.sticks_sent.is_some_and(|(frame, _)| frame == view.sticks) {
        state.sticks_sent = None;
    }
    state.view = view;
    if let Some(place) = map::craft(&state.view) {
        let engaged = state.view.vehicle.nav.engaged;
        let time_s = state.view.vehicle.time.as_secs_f64();
        if !state.view.vehicle.craft.armed {
            state.track.disarmed_at(place.n, place.e);
        }
        state.track.push(TrackPoint { n: place.n, e: place.e, time_s, engaged });
    }
}

fn key(state: &mut AppState, event: KeyEvent) -> Vec<Effect> {
    let press = KeyPress::of(&event);
    let found = state.keymap.action(press, state.focus);
    if found != Some(Action::Cancel) {
        state.cancelled = None;
    }
    state.notice = None;
    match state.layers.last().copied() {
        _ if found == Some(Action::Cancel) => cancel(state),
        Some(Layer::Quit) => match event.code {
            KeyCode::Char('y' | 'Y' | 'q') | KeyCode::Enter => vec![Effect::Quit],
            KeyCode::Char('n' | 'N') | KeyCode::Esc => {
                state.layers.pop();
                Vec::new()
            }
            _ => Vec::new(),
        },
        Some(Layer::Help { scroll }) => {
            let to = match event.code {
                KeyCode::Up | KeyCode::Char('k') => Some(scroll.saturating_sub(1)),
                KeyCode::Down | KeyCode::Char('j') => Some(scroll + 1),
                KeyCode::PageUp => Some(scroll.saturating_sub(10)),
                KeyCode::PageDown | KeyCode::Char(' ') => Some(scroll + 10),
                _ => None,
            };
            state.layers.pop();
            match to {
                Some(scroll) => {
                    state.layers.push(Layer::Help { scroll: scroll.min(action::ACTIONS.len()) });
                    Vec::new()
                }
                // Any other key closes the help and does what it does, so that keys can be tried as they are read.
                None if matches!(found, Some(Action::Help | Action::Back | Action::Quit)) => Vec::new(),
                None => found.map_or_else(Vec::new, |action| act(state, action)),
            }
        }
        None => match found {
            Some(action) => act(state, action),
            None if state.focus == Pane::Cli => cli_key(state, event),
            None => Vec::new(),
        },
    }
}

/// Ctrl-C: once cancels, twice quits.
fn cancel(state: &mut AppState) -> Vec<Effect> {
    if state.cancelled.is_some_and(|at| within(state.now, at, TWICE_WITHIN)) {
        return vec![Effect::Quit];
    }
    state.cancelled = Some(state.now);
    let popup = state.layers.pop().is_some();
    let input = state.focus == Pane::Cli && state.cli.cancel();
    let upload = std::mem::take(&mut state.fly_after_upload);
    let what = if popup || input || upload { "Cancelled. " } else { "" };
    state.notify(Level::Info, format!("{what}Ctrl-C again within 2 s quits."));
    Vec::new()
}

/// Carries an action out, or says why not.
fn act(state: &mut AppState, action: Action) -> Vec<Effect> {
    if let Err(reason) = action::enabled(state, action) {
        state.notify(Level::Warn, reason);
        return Vec::new();
    }
    match action {
        Action::Fly => fly(state),
        Action::Arm => hands::toggle_arm(state),
        Action::Throttle => hands::move_throttle(state),
        Action::Autopilot => hands::toggle_autopilot(state),
        Action::ReturnHome => hands::toggle_return(state),
        Action::CutRc => vec![Effect::Send(Command::CutRc(!state.view.rc_cut))],
        Action::Upload => vec![upload(state)],
        Action::ResetCraft => {
            state.track.await_reset();
            state.sticks_sent = None;
            vec![Effect::Send(Command::ResetCraft)]
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
        Action::Slower => speed(state, -1),
        Action::Faster => speed(state, 1),
        Action::RealTime => speed(state, 0),
        Action::Show(pane) => focus(state, pane),
        Action::Next => focus(state, neighbour(state, 1)),
        Action::Previous => focus(state, neighbour(state, -1)),
        Action::Zoom => {
            state.zoomed = !state.zoomed;
            Vec::new()
        }
        Action::Help => {
            state.layers.push(Layer::Help { scroll: 0 });
            Vec::new()
        }
        Action::Back => {
            // Out of the text first: keys pressed next must not be typed.
            if state.focus.takes_text() {
                focus(state, Pane::Map);
            } else {
                state.zoomed = false;
            }
            Vec::new()
        }
        Action::Quit if state.view.vehicle.craft.armed => {
            state.layers.push(Layer::Quit);
            Vec::new()
        }
        Action::Quit => vec![Effect::Quit],
        Action::Cancel => cancel(state),
        Action::Suspend => vec![Effect::Suspend],
        Action::PanUp => pan(state, 0.0, -1.0),
        Action::PanDown => pan(state, 0.0, 1.0),
        Action::PanLeft => pan(state, -1.0, 0.0),
        Action::PanRight => pan(state, 1.0, 0.0),
        Action::ZoomIn => zoom_map(state, 1.0 / ZOOM_STEP),
        Action::ZoomOut => zoom_map(state, ZOOM_STEP),
        Action::Follow => {
            if let Some(view) = viewport(state) {
                state.map.mode = MapMode::Follow(view.scale);
            }
            Vec::new()
        }
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
        Action::Lower => hands::nudge(state, state.channel, -10),
        Action::Raise => hands::nudge(state, state.channel, 10),
        Action::LowerMuch => hands::nudge(state, state.channel, -100),
        Action::RaiseMuch => hands::nudge(state, state.channel, 100),
        Action::Flip => hands::flip(state, state.channel),
        Action::ScrollUp => scroll(state, -1),
        Action::ScrollDown => scroll(state, 1),
        Action::PageUp => scroll(state, -10),
        Action::PageDown => scroll(state, 10),
        Action::Top => scroll(state, isize::MIN),
        Action::Bottom => scroll(state, isize::MAX),
    }
}

/// Starts or stops the scripted pilot; a craft without a plan gets the open one first.
fn fly(state: &mut AppState) -> Vec<Effect> {
    if state.view.pilot.is_some() {
        return vec![Effect::Send(Command::Pilot(false))];
    }
    if state.view.paused {
        state.notify(Level::Info, "The simulation is paused: Space goes on.");
    }
    if !state.view.vehicle.stored_plan.waypoints.is_empty() {
        if !state.plan.plan.waypoints.is_empty() && !state.plan_is_on_craft() {
            let text =
                format!("Flying the plan in the craft, which is not {}: U uploads it.", state.plan.name);
            state.notify(Level::Info, text);
        }
        return vec![Effect::Send(Command::Pilot(true))];
    }
    if state.plan.plan.waypoints.is_empty() {
        state.notify(Level::Warn, "There is no plan to fly: `waypoint insert …` in the CLI (5) adds one.");
        return Vec::new();
    }
    state.fly_after_upload = true;
    vec![upload(state)]
}

fn upload(state: &AppState) -> Effect {
    Effect::Upload { plan: Box::new(state.plan.plan.clone()), settings: state.plan.settings.clone() }
}

fn uploaded(state: &mut AppState, result: Result<(), String>) -> Vec<Effect> {
    let fly = std::mem::take(&mut state.fly_after_upload);
    match result {
        Ok(()) => {
            let text =
                format!("Uploaded {}: {} waypoints.", state.plan.name, state.plan.plan.waypoints.len());
            state.notify(Level::Good, text);
            if fly { vec![Effect::Send(Command::Pilot(true))] } else { Vec::new() }
        }
        Err(sentence) => {
            state.notify(Level::Fault, format!("The craft refused the plan: {sentence}"));
            Vec::new()
        }
    }
}

/// Steps through the speeds; 0 = real time.
fn speed(state: &mut AppState, step: i32) -> Vec<Effect> {
    let wanted = state.view.speed_wanted;
    let next = match step {
        0 => Some(1.0),
        1.. => SPEEDS.into_iter().find(|&speed| speed > wanted * 1.01),
        _ => SPEEDS.into_iter().rev().find(|&speed| speed < wanted * 0.99),
    };
    let Some(next) = next else { return Vec::new() };
    // Until the session confirms, so that a second press counts from here.
    state.view.speed_wanted = next;
    let mut effects = vec![Effect::Send(Command::Speed(next))];
    if step == 0 && state.view.paused {
        effects.push(Effect::Send(Command::Pause(false)));
    }
    effects
}

fn focus(state: &mut AppState, pane: Pane) -> Vec<Effect> {
    state.focus = pane;
    state.slots.visit(pane);
    Vec::new()
}

/// The panel before or after the focused one in the order of numbers.
fn neighbour(state: &AppState, step: isize) -> Pane {
    let count = Pane::ALL.len();
    let at = Pane::ALL.iter().position(|&pane| pane == state.focus).unwrap_or(0);
    Pane::ALL[(at + count).wrapping_add_signed(step) % count]
}

/// The window of the map as it is on the screen.
fn viewport(state: &AppState) -> Option<Viewport> {
    let area = layout::screen(state)?.pane(Pane::Map)?;
    Some(Viewport::of(state, layout::inner(area)))
}

/// Moves the map by an eighth of its size.
fn pan(state: &mut AppState, columns: f64, rows: f64) -> Vec<Effect> {
    if let Some(view) = viewport(state) {
        let (width, height) = (f64::from(view.area.width), f64::from(view.area.height));
        state.map.mode = view.panned(columns * (width / 8.0).ceil(), rows * (height / 8.0).ceil());
    }
    Vec::new()
}

fn zoom_map(state: &mut AppState, factor: f64) -> Vec<Effect> {
    if let Some(view) = viewport(state) {
        state.map.mode = match state.map.mode {
            MapMode::Follow(scale) => MapMode::Follow(scale * factor),
            MapMode::Fit | MapMode::Free { .. } => view.zoomed(factor, view.centre),
        };
    }
    Vec::new()
}

fn scroll(state: &mut AppState, by: isize) -> Vec<Effect> {
    scroll_pane(state, state.focus, by);
    Vec::new()
}

/// Scrolls a panel by lines, as far as it has some.
fn scroll_pane(state: &mut AppState, pane: Pane, by: isize) {
    let Some(area) = layout::screen(state).and_then(|screen| screen.pane(pane)).map(layout::inner) else {
        return;
    };
    let (at, by, last) = match pane {
        Pane::State => {
            let last = state.transitions.len().saturating_sub(1);
            (&mut state.scrolls.transitions, by, last)
        }
        Pane::Log => {
            let last = panel::log::last_scroll(state, area);
            (&mut state.scrolls.log, by, last)
        }
        Pane::Plan => {
            let last = panel::plan::last_scroll(state, area);
            (&mut state.scrolls.plan, by, last)
        }
        // The newest line of the CLI is below, so up is forwards in its own count.
        Pane::Cli => {
            let last = panel::cli::last_scroll(state, area);
            (&mut state.cli.scroll, by.saturating_neg(), last)
        }
        Pane::Map | Pane::Rc => return,
    };
    *at = (*at).min(last).saturating_add_signed(by).min(last);
}

/// A key while the CLI has the focus.
fn cli_key(state: &mut AppState, event: KeyEvent) -> Vec<Effect> {
    match event.code {
        KeyCode::Enter => {
            state.cli.enter();
            return run_cli(state);
        }
        KeyCode::Tab => {
            if state.cli.input.value().is_empty() {
                return focus(state, neighbour(state, 1));
            }
            state.cli.complete(state.cli_help);
        }
        KeyCode::Up => state.cli.older(),
        KeyCode::Down => state.cli.newer(),
        KeyCode::PageUp => scroll_pane(state, Pane::Cli, -10),
        KeyCode::PageDown => scroll_pane(state, Pane::Cli, 10),
        _ => {
            if state.cli.input.handle_event(&TerminalEvent::Key(event)).is_some() {
                state.cli.candidates.clear();
                state.cli.scroll = 0;
            }
        }
    }
    Vec::new()
}

fn paste(state: &mut AppState, text: &str) -> Vec<Effect> {
    if state.focus != Pane::Cli || !state.layers.is_empty() {
        state.notify(Level::Info, "Pasted text goes to the CLI: press 5 first.");
        return Vec::new();
    }
    state.cli.paste(text);
    run_cli(state)
}

fn run_cli(state: &mut AppState) -> Vec<Effect> {
    state.cli.next_to_run().map(Effect::Cli).into_iter().collect()
}
